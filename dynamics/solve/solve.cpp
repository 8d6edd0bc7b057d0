#include <Eigen/Core>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <functional>
#include <iterator>
#include <limits>
#include <utility>
#include <vector>

#include <dynamics/model/closed_form.hpp>
#include <dynamics/rigid/euler_top.hpp>
#include <dynamics/signal/same_time.hpp>
#include <dynamics/solve/outputs.hpp>
#include <dynamics/solve/paired_runs.hpp>
#include <dynamics/solve/run.hpp>
#include <dynamics/solve/splitting_run.hpp>
#include <dynamics/solve/switching_run.hpp>
#include <motor/error.hpp>

namespace kreisel::detail {

using Clock = std::chrono::steady_clock;

[[nodiscard]] static double seconds_since(const Clock::time_point& begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

Trajectory<double> solve_closed(const SteppedScene& scene, const Eigen::VectorXd& start,
                                const SolveOptions& options,
                                const ClosedForm<Eigen::VectorXd>& motion,
                                const OnComponents& on_output) {
  const Clock::time_point clock = Clock::now();
  Trajectory<double> result;
  RunReport& report = result.report;
  InvariantWatch watch(scene);
  watch.note(options.begin, components_of(start));
  double last_output = options.begin;
  for (const double t : options.output_times) {
    if (options.stop.stop_requested()) {
      cancel(report, "request", last_output);
      break;
    }
    const double error = motion.error(t, options.absolute_scale);
    report.error_estimate = max_or_nan(report.error_estimate, error);
    report.error_parts.rounding = report.error_estimate;
    const Eigen::VectorXd state = motion.at(t);
    if (!output(result, watch, on_output, t, components_of(state), error)) break;
    last_output = t;
  }
  report.method = motion.name;
  report.tolerance = options.tolerance;
  report.tolerance_kept = report.error_estimate <= options.tolerance;
  report.invariants = watch.drifts();
  report.run_time = seconds_since(clock);
  return result;
}

/// The mean length of 20 steps of Verner98 at accuracy 1e-14, once the steps no longer grow.
[[nodiscard]] static double pace(const SteppedScene& scene, const SolveOptions& options,
                                 const Eigen::VectorXd& start) {
  const auto steps = scene.explicit_run(options, start, {1e-14, options.absolute_scale}, false);
  const double end = options.output_times.back();
  double t = options.begin;
  const auto go = [&] {
    const double from = t;
    const double before = steps->effort().steps;
    for (int i = 0; i < 20 && t != end; ++i) {
      stop_if_requested(options.stop);
      steps->step_towards(end, end);
      t = steps->t();
    }
    const double taken = steps->effort().steps - before;
    return taken > 0 ? std::abs(t - from) / taken : 0;
  };
  double pace = go();
  for (int i = 0; i < 30; ++i) {
    const double next = go();
    if (next < 1.2 * pace) break;
    pace = next;
  }
  return std::max(pace, std::numeric_limits<double>::min());
}

/// The start for the steps. Quaternions, whose norm has no meaning, are scaled to a norm near 1,
/// because errors are relative to size.
///
/// Throws : InvalidInput if the state is so small that products of its components underflow
[[nodiscard]] static Eigen::VectorXd start_of_steps(const SteppedScene& scene,
                                                    const Eigen::VectorXd& start, double smallest) {
  using Limits = std::numeric_limits<double>;
  const double least = std::sqrt(Limits::min() / Limits::epsilon());
  Eigen::VectorXd y = start;
  int begin = 0;
  for (const int components : scene.blocks()) {
    const double size = norm(y, begin, components);
    const bool attitude = components == 4;
    if (attitude && std::isfinite(size) && std::abs(std::ilogb(size)) > 4) {
      const int power = std::ilogb(size);  // of two, so that nothing is rounded
      for (int i = begin; i < begin + components; ++i) y[i] = std::ldexp(y[i], -power);
    } else if (size > 0 && size < least && smallest < least) {
      refuse_task("a part of the state is ", size, " at the start, and below ", least,
                  " products of it underflow: take other units, or a `smallest` above that");
    }
    begin += components;
  }
  return y;
}

namespace {

/// The motion of a scene by the method requested, or by the one that suits it.
class ByMethod {
 public:
  ByMethod(const SteppedScene& scene, const Eigen::VectorXd& start, const SolveOptions& options,
           const OnComponents& on_output)
      : scene_(scene), start_(start), options_(options), on_output_(on_output) {}

  [[nodiscard]] Trajectory<double> solve() {
    const bool automatic = options_.method == Method::automatic;
    if (const EulerTop* const top = scene_.top()) {
      const auto state = EulerTop::from_vector(vector_of<EulerTop::Vector>(start_));
      const bool pays = automatic && splits(*top) && is_fast(*top, state);
      if (pays || options_.method == Method::splitting) {
        return in_pairs({options_, Method::splitting, splitting_lengths(*top, options_, state)},
                        options_, on_output_);
      }
    }
    if (options_.method == Method::radau13) {
      return in_pairs(Levels(options_, Method::radau13), options_, on_output_);
    }
    if (options_.method == Method::gauss16) return by_gauss(options_, on_output_);
    auto result = explicitly(options_, on_output_);
    if (automatic) try_others(result);
    return result;
  }

 private:
  [[nodiscard]] Trajectory<double> in_pairs(const Levels& levels, const SolveOptions& options,
                                            const OnComponents& on_output) {
    const RunMaker maker(scene_, options, start_);
    auto result = PairedRuns(maker, levels, on_output, spent_).solve(options.checkpoint);
    result.report.run_time = seconds_since(clock_);
    return result;
  }

  [[nodiscard]] Method explicit_method(const SolveOptions& options) const {
    const bool by_series = scene_.knows_series() && options.method != Method::verner98;
    return by_series ? Method::taylor : Method::verner98;
  }

  /// By taylor if the scene has series, else by verner98.
  [[nodiscard]] Trajectory<double> explicitly(const SolveOptions& options,
                                              const OnComponents& on_output) {
    return in_pairs(Levels(options, explicit_method(options)), options, on_output);
  }

  /// By gauss16. Steps with 16 Gauss points can be about twice as long as those of Verner98 at
  /// 1e-14. Steps that are too long for a later part of the motion do not converge there.
  [[nodiscard]] Trajectory<double> by_gauss(const SolveOptions& options,
                                            const OnComponents& on_output) {
    constexpr int most_tries = 12;
    double once = pace(scene_, options, start_);
    for (int i = 1;; ++i, once /= 4) {
      auto result = in_pairs({options, Method::gauss16, {2 * once, once / 2}}, options, on_output);
      const RunReport& report = result.report;
      if (report.status != RunStatus::failed || i == most_tries) return result;
      if (report.all_evaluations > options.max_evaluations) return result;
    }
  }

  [[nodiscard]] static bool missed(const RunReport& report) {
    return report.status == RunStatus::complete && !report.tolerance_kept;
  }

  /// If the tolerance was missed, another method may come nearer to it.
  void try_others(Trajectory<double>& result) {
    const bool stiff = !result.report.changes.empty();
    if (missed(result.report) && stiff) {
      if (explicit_steps_are_cheap()) by_another(explicit_method(options_), result);
    } else if (missed(result.report) && result.report.method == name(Method::taylor)) {
      // Many stages average the rounding of the field.
      by_another(Method::verner98, result);
    }
    // With fixed symmetric steps errors grow with time, with adaptive steps with its square.
    constexpr double many = 1e5;
    if (missed(result.report) && !stiff && result.report.effort.steps > many &&
        options_.discontinuities.empty()) {
      by_another(Method::gauss16, result);
    }
  }

  /// True if explicit steps, as short as stability requires, cost less than ten times what was
  /// spent; their last digits are better.
  [[nodiscard]] bool explicit_steps_are_cheap() const {
    const double rate = std::abs(dominant_eigenvalue(scene_, false, options_.begin, start_));
    const double duration = std::abs(options_.output_times.back() - options_.begin);
    return 5 * rate * duration < 10 * spent_;
  }

  /// Solves by another method, and keeps the better result.
  void by_another(Method method, Trajectory<double>& result) {
    SolveOptions alone = options_;  // a checkpoint lacks the other trajectory
    alone.offer_checkpoint = nullptr;
    alone.checkpoint.clear();
    alone.method = method;
    const OnComponents nobody;  // until the other run has proved better
    auto other = method == Method::gauss16 ? by_gauss(alone, nobody) : explicitly(alone, nobody);
    if (other.report.status != RunStatus::complete) return;
    if (!(other.report.error_estimate < result.report.error_estimate)) return;
    result = std::move(other);
    show_all(result, on_output_);
  }

  const SteppedScene& scene_;
  const Eigen::VectorXd& start_;
  const SolveOptions& options_;
  const OnComponents& on_output_;
  Clock::time_point clock_ = Clock::now();
  double spent_ = 0;  ///< evaluations of all runs
};

}  // namespace

/// The options with the times of samples among the discontinuities. A sample time that differs only
/// by rounding from a discontinuity or an output time is taken as that time: no step fits between
/// them.
[[nodiscard]] static SolveOptions with_sample_times(const SteppedScene& scene,
                                                    SolveOptions options) {
  if (!scene.has_samples()) return options;
  std::vector<double> given = options.discontinuities;
  given.insert(given.end(), options.output_times.begin(), options.output_times.end());
  std::sort(given.begin(), given.end());
  for (double t : scene.sample_times(options.begin, options.output_times.back())) {
    const auto next = std::lower_bound(given.begin(), given.end(), t);
    if (next != given.end() && is_same_time(*next, t)) t = *next;
    if (next != given.begin() && is_same_time(*std::prev(next), t)) t = *std::prev(next);
    options.discontinuities.push_back(t);
  }
  return options;
}

Trajectory<double> solve_by_steps(const SteppedScene& scene, const Eigen::VectorXd& given,
                                  const SolveOptions& all, const OnComponents& on_output) try {
  const SolveOptions options = with_sample_times(scene, all);
  const Eigen::VectorXd start = start_of_steps(scene, given, options.absolute_scale);
  return ByMethod(scene, start, options, on_output).solve();
} catch (const StopRequested&) {  // before the first step of a run
  Trajectory<double> none;
  none.report.method = name(all.method);
  none.report.tolerance = all.tolerance;
  cancel(none.report, "request", all.begin);
  return none;
}

/// Throws : InvalidInput if a quaternion of the start is 0, which steps would neither correct nor
///          report
static void check_start(const SteppedScene& scene, const Eigen::VectorXd& start) {
  int begin = 0;
  for (const int components : scene.blocks()) {
    if (components == 4 && norm(start, begin, components) == 0) {
      refuse_task("the attitude at the start is a quaternion of norm 0");
    }
    begin += components;
  }
}

/// Throws : InvalidInput if the requested method does not fit the scene
static void check_method(const SteppedScene& scene, const SolveOptions& options) {
  const auto refuse = [&](const char* why) {
    refuse_task("method ", name(options.method), " does not apply: ", why);
  };
  const bool fixed_steps = options.method == Method::gauss16 || options.method == Method::splitting;
  if (fixed_steps && (!options.discontinuities.empty() || scene.has_samples())) {
    refuse("its equal steps cannot end at the jumps");
  }
  if (options.method == Method::taylor && !scene.knows_series()) {
    refuse("this scene does not know its series");
  }
  if (options.method != Method::splitting) return;
  if (scene.top() && splits(*scene.top())) return;
  refuse("it is for an EulerTop with two equal moments, under weight and without rotor");
}

/// Throws : InvalidInput for a run backwards in time, if the scene has samples
static void check_direction(const SteppedScene& scene, const SolveOptions& options) {
  if (!scene.has_samples() || options.output_times.back() >= options.begin) return;
  refuse_task(
      "the run goes backwards in time, but a sampled controller does not: take an end after "
      "t = ",
      options.begin, " s");
}

void check(const SteppedScene& scene, const Eigen::VectorXd& start, const SolveOptions& options) {
  check(options);
  check_direction(scene, options);
  check_method(scene, options);
  check_start(scene, start);
}

void refuse_closed_form() {
  refuse_task("method closed form does not apply: this scene has none that is known");
}

}  // namespace kreisel::detail
