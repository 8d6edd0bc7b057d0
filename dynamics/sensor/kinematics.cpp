#include <dynamics/sensor/kinematics.hpp>
#include <dynamics/tree/constraints.hpp>
#include <dynamics/tree/elements.hpp>
#include <dynamics/tree/passes.hpp>
#include <dynamics/tree/rotor_forces.hpp>

namespace kreisel::detail {

/// Sets the forces of the elements. Needs poses and positions in w.
inline void add_elements(const BodyTree& tree, const Surroundings& now, const Eigen::VectorXd& y,
                         const BodyWorkspace& w, std::vector<ElementLoad>& result) {
  std::vector<Motor<>> forces;
  const double* const v = y.data() + tree.coordinates();
  element_forces(tree, now.t, y.data(), v, now.outside, w, forces);
  for (std::size_t k = 0; k < forces.size(); ++k) {
    const auto& [first, second] = tree.element_places()[k].body;
    result.push_back({first, second, second_point(tree.elements()[k]), forces[k]});
  }
}

/// Appends the forces of the constraints. Needs the multipliers and the motions in w.
inline void add_constraints(const BodyTree& tree, BodyWorkspace& w,
                            std::vector<ElementLoad>& result) {
  const auto reactions = constraint_reactions(tree, w);
  for (std::size_t k = 0; k < reactions.size(); ++k) {
    const ConstraintLink& link = tree.constraints()[k];
    result.push_back({tree.links()[link.first].body, tree.links()[link.second].body,
                      reactions[k].at, reactions[k].on_second});
  }
}

SystemKinematics kinematics(const BodyTree& tree, const Surroundings& now, const Eigen::VectorXd& y,
                            const BodyLoad* gravitation, BodyWorkspace& w) {
  SystemKinematics result{
      {now.t, now.guide, now.guide, {field(now.gravity, now.guide), gravitation}}};
  reactions(tree, now, y, result.reactions, w);
  const double* const v = y.data() + tree.coordinates();
  const double* const dv = w.acceleration.data();
  result.rates.resize(y.size());
  set_coordinate_rates(tree, y.data(), v, result.rates.data());
  result.rates.tail(tree.rates()) = w.acceleration;
  set_motions(tree, LinkMotion<>{}, v, dv, w);
  set_places(tree, v, w);
  set_rotor_places(tree, y.data(), v, w);
  set_rotor_motions(tree, v, dv, w);
  for (int i = 0; i < static_cast<int>(tree.bodies().size()); ++i) {
    const std::size_t link = tree.link(i);
    const auto& [x, V] = w.place[link];
    const LinkMotion<>& motion = w.motion[link];
    result.bodies.push_back({w.pose[link].R, x, V.resultant, V.moment, motion.dw, motion.a});
  }
  if (!tree.elements().empty()) add_elements(tree, now, y, w, result.elements);
  if (!tree.constraints().empty()) add_constraints(tree, w, result.elements);
  return result;
}

}  // namespace kreisel::detail
