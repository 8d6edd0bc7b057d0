#include <algorithm>
#include <cmath>
#include <cstddef>
#include <variant>

#include <dynamics/file/contacts.hpp>

namespace kreisel {

namespace {

/// A force of rounding alone counts as none.
constexpr double rounding = 1e-12;

}  // namespace

std::vector<PullingContact> pulling_contacts(const SceneFile& scene, const SceneSolver& model,
                                             const Trajectory<JointState>& run) {
  std::vector<PullingContact> found;
  const auto is_known = [&found](const std::string& name) {
    return std::any_of(found.begin(), found.end(), [&name](const PullingContact& contact) {
      return contact.constraint == name;
    });
  };
  const bool rolls = std::any_of(
      scene.constraints.begin(), scene.constraints.end(), [](const Constraint& constraint) {
        return std::holds_alternative<constraint::Rolling>(constraint.kind);
      });
  for (std::size_t i = 0; rolls && i < run.times.size(); ++i) {
    const std::vector<Motor<>> forces = model.constraint_forces(run.times[i], run.states[i]);
    for (std::size_t k = 0; k < forces.size(); ++k) {
      const Constraint& constraint = scene.constraints[k];
      const auto* const contact = std::get_if<constraint::Rolling>(&constraint.kind);
      if (contact == nullptr || is_known(constraint.name)) continue;
      const Vector3<double>& force = forces[k].resultant;
      const double along = force.dot(contact->normal.normalized());
      if (along < -rounding * force.norm()) found.push_back({constraint.name, run.times[i], along});
    }
  }
  return found;
}

}  // namespace kreisel
