#pragma once

#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <dynamics/file/joints.hpp>
#include <dynamics/law/relative.hpp>
#include <dynamics/model/terms.hpp>
#include <dynamics/solve/report.hpp>
#include <dynamics/solve/solve_options.hpp>

namespace kreisel {

/// The system of a scene, whatever its guide. One virtual call for each run or row, none for each
/// evaluation.
class SceneSolver {
 public:
  using OnOutput = std::function<OutputAction(double t, const JointState& state)>;

  virtual ~SceneSolver() = default;

  /// As kreisel::solve(), which calls a function at outputs, unless that is empty.
  [[nodiscard]] virtual Trajectory<JointState> solve(const SolveOptions& options,
                                                     const JointState& start,
                                                     const OnOutput& on_output = nullptr) const = 0;

  /// How far its equations themselves were off in the latest run; 0 for the exact ones.
  [[nodiscard]] virtual double model_error() const { return 0; }

  [[nodiscard]] virtual const BodyTree& tree() const = 0;
  [[nodiscard]] virtual JointReactions reactions(double t, const JointState& state) const = 0;
  [[nodiscard]] virtual ForceParts<Body> terms(double t, const JointState& state,
                                               int body) const = 0;
  /// The terms of the equation that is computed; they do not depend on the state.
  [[nodiscard]] virtual Terms equation_terms() const = 0;
  [[nodiscard]] virtual std::vector<std::pair<std::string, double>> conserved(
      double t, const JointState& state) const = 0;
  /// How all bodies move, and what their joints carry.
  [[nodiscard]] virtual SystemKinematics kinematics(double t, const JointState& state) const = 0;
  /// The body in the guide.
  [[nodiscard]] virtual Pose<double> pose(double t, const JointState& state, int body) const = 0;
};

/// Throws : InvalidInput
[[nodiscard]] std::unique_ptr<SceneSolver> make_model(const SceneFile& scene);

/// The options that a scene file gives in [solve]. Without output times the end is the only one.
[[nodiscard]] SolveOptions options_of(const SceneFile& scene);

/// Computes the motion of a scene file, by its model and its options.
///
/// Throws : InvalidInput. A failure on the way is in RunReport::status and message
[[nodiscard]] Trajectory<JointState> run_scene(const SceneFile& scene);

/// The two that make_model() chooses from, compiled apart.
[[nodiscard]] std::unique_ptr<SceneSolver> make_resting_model(const SceneFile& scene);
[[nodiscard]] std::unique_ptr<SceneSolver> make_moving_model(const SceneFile& scene);

}  // namespace kreisel
