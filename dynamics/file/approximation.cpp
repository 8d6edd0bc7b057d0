#include <unsupported/Eigen/MatrixFunctions>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include <dynamics/file/approximation.hpp>
#include <dynamics/file/gimbal_motion.hpp>
#include <dynamics/file/measured.hpp>
#include <dynamics/file/steady_motions.hpp>
#include <dynamics/solve/error_measure.hpp>
#include <dynamics/solve/output_times.hpp>
#include <motor/error.hpp>

namespace kreisel {

using Eigen::VectorXd;

namespace {

/// States of the linear equations about a steady motion, at times since the start.
class LinearMotion {
 public:
  static constexpr const char* method = "matrix exponential";

  explicit LinearMotion(const SceneFile& scene) : system_(scene) {
    const VectorXd start = joined(start_of(scene));
    const Steady steady = steady_motion::find_steady(system_, scene, start);
    if (!steady.exists()) {
      throw InvalidInput("model 'linear': no steady motion to be linear about: " + steady.reason);
    }
    about_ = steady_motion::linearized(system_, system_.begin(), steady.state);
  }

  /// Throws : ComputationFailed if the states overflow
  [[nodiscard]] std::vector<VectorXd> states(const VectorXd& start,
                                             const std::vector<double>& times) const {
    const Tangent tangent = steady_motion::tangent_of(system_, about_.state);
    VectorXd eta = tangent.between(about_.state, start);
    double before = 0;
    std::vector<VectorXd> result;
    for (const double t : times) {
      eta = ((t - before) * about_.A).exp() * eta;
      before = t;
      const VectorXd steady = tangent.moved(about_.state, VectorXd(t * about_.rate));
      result.push_back(tangent.moved(steady, eta));
      if (!result.back().allFinite()) {
        throw ComputationFailed("model 'linear': the motion grows beyond all numbers");
      }
    }
    return result;
  }

 private:
  StudySystem system_;
  steady_motion::Linearization about_;
};

/// States of the precession equations, at times since the start.
class PrecessionMotion {
 public:
  static constexpr const char* method = "technical equations, verner98";

  explicit PrecessionMotion(const SceneFile& scene) : system_(scene) {}

  /// Throws : InvalidInput, ComputationFailed
  [[nodiscard]] std::vector<VectorXd> states(const VectorXd& start,
                                             const std::vector<double>& times) const {
    return system_.technical(start, times);
  }

 private:
  StudySystem system_;
};

template <class Motion>
class Approximation final : public SceneSolver {
 public:
  Approximation(const SceneFile& scene, std::unique_ptr<SceneSolver> exact)
      : exact_(std::move(exact)), motion_(scene) {}

  [[nodiscard]] Trajectory<JointState> solve(const SolveOptions& options, const JointState& start,
                                             const OnOutput& on_output) const override {
    const auto clock = std::chrono::steady_clock::now();
    Trajectory<JointState> result = exact_->solve(options, start);
    if (result.report.status != RunStatus::complete) return result;
    std::vector<double> since = result.times;
    for (double& t : since) t -= options.begin;
    const std::vector<VectorXd> states = motion_.states(joined(start), since);
    ErrorMeasure<Measured> distance({tree().blocks()}, options.absolute_scale);
    // Relative to the sizes of the whole exact run: an approximation may start with other rates.
    distance.note_sizes(result.report.sizes);
    if (result.report.sizes.empty()) note_way(distance, options, result.times.back(), start);
    RunReport& report = result.report;
    report.method = Motion::method;
    const auto at_start = conserved(options.begin, start);
    for (auto& invariant : report.invariants) invariant.largest = 0;
    const Eigen::Index coordinates = tree().coordinates();
    std::size_t done = 0;
    model_error_ = 0;
    for (; done < states.size() && report.status == RunStatus::complete; ++done) {
      JointState& state = result.states[done];
      const VectorXd exact = joined(state);
      VectorXd y = states[done];
      for (const auto& rotor : tree().rotors()) y[rotor.link.q] = exact[rotor.link.q];
      const double off = distance(y, exact);
      result.errors[done] += off;
      model_error_ = std::max(model_error_, off);
      report.error_estimate = std::max(report.error_estimate, result.errors[done]);
      state = {y.head(coordinates), y.tail(tree().rates())};
      const double t = result.times[done];
      const auto now = conserved(t, state);
      for (std::size_t k = 0; k < report.invariants.size(); ++k) {
        double& largest = report.invariants[k].largest;
        largest = std::max(largest, std::abs(now[k].second - at_start[k].second));
      }
      if (on_output && on_output(t, state) == OutputAction::stop) {
        report.status = RunStatus::cancelled;
        report.message = "stopped by on_output";
      }
    }
    if (done < result.times.size() && report.status == RunStatus::complete) {
      report.status = RunStatus::failed;
      report.message =
          "the motion is no longer slow against the nutations, which the precession "
          "equations leave out";
    }
    result.times.resize(done);
    result.states.resize(done);
    result.errors.resize(done);
    report.tolerance_kept = report.error_estimate <= options.tolerance;
    report.run_time =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - clock).count();
    return result;
  }

  [[nodiscard]] double model_error() const override { return model_error_; }

  [[nodiscard]] const BodyTree& tree() const override { return exact_->tree(); }
  [[nodiscard]] JointReactions reactions(double t, const JointState& state) const override {
    return exact_->reactions(t, state);
  }
  [[nodiscard]] std::vector<Motor<>> element_forces(double t,
                                                    const JointState& state) const override {
    return exact_->element_forces(t, state);
  }
  [[nodiscard]] std::vector<Motor<>> constraint_forces(double t,
                                                       const JointState& state) const override {
    return exact_->constraint_forces(t, state);
  }
  [[nodiscard]] ForceParts<Body> terms(double t, const JointState& state, int body) const override {
    return exact_->terms(t, state, body);
  }
  [[nodiscard]] Terms equation_terms() const override { return exact_->equation_terms(); }
  [[nodiscard]] std::vector<std::pair<std::string, double>> conserved(
      double t, const JointState& state) const override {
    return exact_->conserved(t, state);
  }
  [[nodiscard]] SystemKinematics kinematics(double t, const JointState& state) const override {
    return exact_->kinematics(t, state);
  }
  [[nodiscard]] Pose<double> pose(double t, const JointState& state, int body) const override {
    return exact_->pose(t, state, body);
  }

 private:
  /// Records the sizes at evenly spaced times from begin to end. A closed form reports no sizes.
  void note_way(ErrorMeasure<Measured>& distance, SolveOptions options, double end,
                const JointState& start) const {
    options.output_times = linspace(options.begin, end, 65);
    options.t_end.reset();
    options.output_step.reset();
    for (const JointState& state : exact_->solve(options, start).states) {
      distance(joined(state), joined(state));
    }
  }

  std::unique_ptr<SceneSolver> exact_;
  Motion motion_;
  mutable double model_error_ = 0;
};

}  // namespace

std::unique_ptr<SceneSolver> make_approximation(const SceneFile& scene,
                                                std::unique_ptr<SceneSolver> exact) {
  if (scene.model != SceneModel::exact && !scene.discontinuities.empty()) {
    throw InvalidInput("model '" + std::string(name(scene.model)) +
                       "' is for forces that do not jump; take model 'exact'");
  }
  if (scene.model != SceneModel::exact && !scene.constraints.empty()) {
    throw InvalidInput("model '" + std::string(name(scene.model)) +
                       "' is for scenes without constraints; take model 'exact'");
  }
  switch (scene.model) {
    case SceneModel::linear:
      return std::make_unique<Approximation<LinearMotion>>(scene, std::move(exact));
    case SceneModel::precession:
      return std::make_unique<Approximation<PrecessionMotion>>(scene, std::move(exact));
    case SceneModel::foeppl:
    case SceneModel::fuchs_weigand:
      return std::make_unique<Approximation<GimbalMotion>>(scene, std::move(exact));
    case SceneModel::exact: break;
  }
  return exact;
}

}  // namespace kreisel
