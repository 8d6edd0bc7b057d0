#include <cstddef>
#include <optional>

#include <dynamics/file/greatest_terms.hpp>
#include <dynamics/file/scene_system.hpp>

namespace kreisel {

using Eigen::VectorXd;

std::optional<FrameTerms> greatest_terms(const SceneFile& scene, const SceneSolver& model,
                                         const Trajectory<JointState>& run) {
  const FrameTermsOf terms(scene.bodies);
  if (!terms.has_rotors()) return std::nullopt;
  const SceneGuide guide = make_guide(scene);
  const VectorXd none = VectorXd::Zero(terms.tree().rates());
  FrameTerms greatest{none, none, none, none, none, none, none};
  for (std::size_t i = 0; i < run.states.size(); ++i) {
    const double t = run.times[i];
    const JointState& state = run.states[i];
    const VectorXd rates = model.kinematics(t, state).rates;
    const VectorXd accelerations = rates.segment(state.coordinates.size(), none.size());
    const FrameTerms now = terms(turning(guide, t), state.coordinates, state.rates, accelerations);
    for (VectorXd FrameTerms::*kind :
         {&FrameTerms::inertia, &FrameTerms::gyroscopic, &FrameTerms::restraint,
          &FrameTerms::guide_change, &FrameTerms::guide_inertia, &FrameTerms::guide_gyroscopic,
          &FrameTerms::left_out}) {
      greatest.*kind = (greatest.*kind).cwiseMax((now.*kind).cwiseAbs());
    }
  }
  return greatest;
}

}  // namespace kreisel
