#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <dynamics/file/joints.hpp>
#include <dynamics/law/relative.hpp>
#include <dynamics/model/terms.hpp>
#include <dynamics/solve/report.hpp>
#include <dynamics/solve/solve_options.hpp>

namespace kreisel {

/// The system of a scene with any guide. It makes one virtual call for each run or row, and none
/// for each evaluation.
class SceneSolver {
 public:
  using OnOutput = std::function<OutputAction(double t, const JointState& state)>;

  virtual ~SceneSolver() = default;

  /// Computes a run as kreisel::solve() does. on_output is called at outputs if it is not empty.
  [[nodiscard]] virtual Trajectory<JointState> solve(const SolveOptions& options,
                                                     const JointState& start,
                                                     const OnOutput& on_output = nullptr) const = 0;

  /// The bound of the error of the model's equations in the latest run; 0 for the exact equations.
  [[nodiscard]] virtual double model_error() const { return 0; }
  /// The distance from the exact motion in that run, if it was compared.
  [[nodiscard]] virtual std::optional<double> model_distance() const { return std::nullopt; }

  [[nodiscard]] virtual const BodyTree& tree() const = 0;
  [[nodiscard]] virtual JointReactions reactions(double t, const JointState& state) const = 0;
  /// Force and torque of each element on its second body about its end, on the first body's axes.
  [[nodiscard]] virtual std::vector<Motor<>> element_forces(double t,
                                                            const JointState& state) const = 0;
  /// The same of each constraint, about its point of the second body.
  [[nodiscard]] virtual std::vector<Motor<>> constraint_forces(double t,
                                                               const JointState& state) const = 0;
  [[nodiscard]] virtual ForceParts<Body> terms(double t, const JointState& state,
                                               int body) const = 0;
  /// The terms of the equation that is computed; they do not depend on the state.
  [[nodiscard]] virtual Terms equation_terms() const = 0;
  [[nodiscard]] virtual std::vector<std::pair<std::string, double>> conserved(
      double t, const JointState& state) const = 0;
  /// The motion of all bodies, the reactions of their joints, and the rates of the state by the
  /// exact equations.
  [[nodiscard]] virtual SystemKinematics kinematics(double t, const JointState& state) const = 0;
  /// The same from a state after the samples of controllers at its time.
  [[nodiscard]] virtual SystemKinematics kinematics_after_samples(double t,
                                                                  const JointState& state) const {
    return kinematics(t, state);
  }
  /// The number of memory components of all controllers.
  [[nodiscard]] virtual int memory() const { return 0; }
  /// The times in (begin, end] at which controllers are sampled, and the state after samples.
  [[nodiscard]] virtual std::vector<double> sample_times(double /*begin*/, double /*end*/) const {
    return {};
  }
  [[nodiscard]] virtual JointState sampled(double /*t*/, const JointState& state) const {
    return state;
  }
  /// The pose of a body relative to the guide.
  [[nodiscard]] virtual Pose<double> pose(double t, const JointState& state, int body) const = 0;
};

/// Throws : InvalidInput
[[nodiscard]] std::unique_ptr<SceneSolver> make_model(const SceneFile& scene);

/// The options in [solve] of a scene file. Without output times the end is the only output.
[[nodiscard]] SolveOptions options_of(const SceneFile& scene);

/// Computes the motion of a scene file with its model and its options.
///
/// Throws : InvalidInput. A failure during the run is in RunReport::status and message
[[nodiscard]] Trajectory<JointState> run_scene(const SceneFile& scene);

/// The functions that make_model() chooses from, compiled separately.
[[nodiscard]] std::unique_ptr<SceneSolver> make_resting_model(const SceneFile& scene);
[[nodiscard]] std::unique_ptr<SceneSolver> make_moving_model(const SceneFile& scene);
[[nodiscard]] std::unique_ptr<SceneSolver> make_controlled_model(const SceneFile& scene);

}  // namespace kreisel
