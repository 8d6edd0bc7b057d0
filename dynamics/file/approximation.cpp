#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <dynamics/file/approximation.hpp>
#include <dynamics/file/measured.hpp>
#include <dynamics/file/model_motion.hpp>
#include <dynamics/solve/error_measure.hpp>
#include <dynamics/study/model_bound.hpp>
#include <motor/error.hpp>

namespace kreisel {

using Eigen::VectorXd;

namespace {

/// The part of the tolerance below which the error of a model need not be resolved.
constexpr double unresolved = 0.01;

class Approximation final : public SceneSolver {
 public:
  Approximation(const SceneFile& scene, std::unique_ptr<SceneSolver> exact)
      : exact_(std::move(exact)),
        system_(scene),
        approximation_(approximation_of(scene, system_)),
        discontinuities_(scene.discontinuities),
        compares_(scene.compare) {}

  [[nodiscard]] Trajectory<JointState> solve(const SolveOptions& given, const JointState& start,
                                             const OnOutput& on_output) const override {
    const auto clock = std::chrono::steady_clock::now();
    const SolveOptions options = detail::with_output_times(given);
    const VectorXd y = joined(start);
    const ModelMotion motion = approximation_.motion(y, options.output_times);
    Trajectory<JointState> result;
    RunReport& report = result.report;
    report.method = approximation_.method;
    report.tolerance = options.tolerance;
    report.message = motion.message;
    result.errors = bounds(motion, y, options, report);
    model_error_ = 0;
    for (std::size_t i = 0; i < result.errors.size(); ++i) {
      model_error_ = std::max(model_error_, result.errors[i]);
      result.errors[i] += motion.integration_error;
      result.times.push_back(options.output_times[i]);
      result.states.push_back(system_.joints_of(motion.states[i]));
    }
    report.error_estimate = model_error_ + motion.integration_error;
    report.error_parts.truncation = motion.integration_error;
    report.tolerance_kept = report.error_estimate <= options.tolerance;
    if (!report.message.empty()) report.status = RunStatus::failed;
    note_invariants(result, options.begin, start);
    show(result, on_output);
    distance_ = compares_ ? distance(result, options, start) : std::nullopt;
    report.run_time =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - clock).count();
    return result;
  }

  [[nodiscard]] double model_error() const override { return model_error_; }
  [[nodiscard]] std::optional<double> model_distance() const override { return distance_; }

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
  /// The bounds of the model's error at the outputs, as far as they are known.
  [[nodiscard]] std::vector<double> bounds(const ModelMotion& motion, const VectorXd& start,
                                           const SolveOptions& options, RunReport& report) const {
    std::vector<double> times = options.output_times;
    times.resize(motion.states.size());
    if (times.empty() || !motion.samples) return std::vector<double>(times.size(), 0);
    std::vector<double> stops = motion.stops;
    stops.insert(stops.end(), discontinuities_.begin(), discontinuities_.end());
    const ModelBound bound(system_, options.begin, motion.begin, system_.blocks());
    ModelDistance found = bound.run(
        start, motion.samples, times, motion.states, stops,
        {.tolerance = unresolved * options.tolerance, .absolute_scale = options.absolute_scale});
    if (!found.message.empty()) report.message = found.message;
    report.effort.evaluations = found.evaluations;
    report.all_evaluations = found.evaluations;
    report.sizes = std::move(found.sizes);
    return std::move(found.bounds);
  }

  void note_invariants(Trajectory<JointState>& run, double begin, const JointState& start) const {
    for (const auto& [name, value] : conserved(begin, start)) {
      run.report.invariants.push_back({name, value, 0});
    }
    for (std::size_t i = 0; i < run.states.size(); ++i) {
      const auto now = conserved(run.times[i], run.states[i]);
      for (std::size_t k = 0; k < now.size(); ++k) {
        InvariantDrift& drift = run.report.invariants[k];
        drift.largest = std::max(drift.largest, std::abs(now[k].second - drift.start));
      }
    }
  }

  /// Calls on_output, which may end the run.
  static void show(Trajectory<JointState>& run, const OnOutput& on_output) {
    if (!on_output) return;
    for (std::size_t i = 0; i < run.states.size(); ++i) {
      if (on_output(run.times[i], run.states[i]) == OutputAction::proceed) continue;
      run.times.resize(i + 1);
      run.states.resize(i + 1);
      run.errors.resize(i + 1);
      run.report.status = RunStatus::cancelled;
      run.report.message = "stopped by on_output";
      return;
    }
  }

  /// The greatest distance from the exact motion, which is computed; nothing if its run ends early.
  [[nodiscard]] std::optional<double> distance(const Trajectory<JointState>& run,
                                               const SolveOptions& options,
                                               const JointState& start) const {
    SolveOptions plain = options;
    plain.offer_checkpoint = nullptr;  // those of a file of rows belong to the approximation
    const Trajectory<JointState> exact = exact_->solve(plain, start);
    if (exact.report.status != RunStatus::complete) return std::nullopt;
    ErrorMeasure<Measured> measure({system_.blocks()}, options.absolute_scale);
    measure.note_sizes(run.report.sizes);
    double result = 0;
    const std::size_t count = std::min(run.states.size(), exact.states.size());
    for (std::size_t i = 0; i < count; ++i) {
      result = std::max(result, measure(joined(run.states[i]), joined(exact.states[i])));
    }
    return result;
  }

  std::unique_ptr<SceneSolver> exact_;
  StudySystem system_;
  SceneApproximation approximation_;
  std::vector<double> discontinuities_;
  bool compares_;
  mutable double model_error_ = 0;
  mutable std::optional<double> distance_;
};

[[noreturn]] void refuse(const SceneFile& scene, const char* what) {
  throw InvalidInput("model '" + std::string(name(scene.model)) + "' is for " + what +
                     "; take model 'small' or 'exact'");
}

}  // namespace

std::unique_ptr<SceneSolver> make_approximation(const SceneFile& scene,
                                                std::unique_ptr<SceneSolver> exact) {
  if (scene.model == SceneModel::exact) return exact;
  if (scene.model != SceneModel::small) {
    if (!scene.discontinuities.empty()) refuse(scene, "forces that do not jump");
    if (!scene.constraints.empty()) refuse(scene, "scenes without constraints");
    if (!scene.controllers.empty()) refuse(scene, "scenes without controllers");
  }
  const auto is_sampled = [](const Controller& controller) { return controller.period > 0; };
  if (std::any_of(scene.controllers.begin(), scene.controllers.end(), is_sampled)) {
    throw InvalidInput(
        "model 'small' is for continuous controllers, and one has a period; take model 'exact'");
  }
  return std::make_unique<Approximation>(scene, std::move(exact));
}

}  // namespace kreisel
