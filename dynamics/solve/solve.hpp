#pragma once

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <dynamics/solve/closed_form.hpp>
#include <dynamics/solve/report.hpp>
#include <dynamics/step/advance.hpp>
#include <motor/error.hpp>

namespace kreisel {

/// How a run is computed.
enum class Method {
  automatic,  ///< the closed form where the scene has one, else steps
  steps       ///< Verner98, ExplicitSteps
};

/// What is asked of a run.
struct Task {
  double begin = 0;
  std::vector<double> times;  ///< of output, in order, forwards or backwards; the last is the end
  std::vector<double> jumps = {};  ///< when guide or loads jump: steps end there
  double tolerance = 1e-10;        ///< of the global error; see RunReport::error_estimate

  Method method = Method::automatic;

  /// A part of the state smaller than this (SI) counts as being so large.
  double smallest = 1e-3;

  /// Called at every output with the time; false cancels the run. What was computed is kept.
  std::function<bool(double t)> progress = nullptr;
};

namespace detail {

/// The distance of two states in the measure of RunReport::error_estimate.
///
/// Attitudes (blocks of four) by the angle between them, whatever their norms; q and -q are one.
template <class Scene>
class ErrorMeasure {
  using Vector = typename Scene::Vector;

 public:
  explicit ErrorMeasure(double smallest) { size_.fill(smallest); }

  double operator()(const Vector& a, const Vector& b) {
    double worst = 0;
    int begin = 0;
    for (std::size_t i = 0; i < Scene::blocks.size(); ++i) {
      const int n = Scene::blocks[i];
      const bool attitude = n == 4;
      if (attitude) {
        const Eigen::Vector4d p = part<4>(a, begin);
        const Eigen::Vector4d q = part<4>(b, begin);
        // |p -+ q| / 2 of unit quaternions is the sine of a quarter of the angle between.
        const Eigen::Vector4d unit_p = p / p.norm();
        const Eigen::Vector4d unit_q = q / (p.dot(q) < 0 ? -q.norm() : q.norm());
        worst = worse(worst, 4 * std::asin(std::min(1.0, (unit_p - unit_q).norm() / 2)));
      } else {
        double difference2 = 0;
        double size2 = 0;
        for (int k = begin; k < begin + n; ++k) {
          difference2 += (a[k] - b[k]) * (a[k] - b[k]);
          size2 += b[k] * b[k];
        }
        size_[i] = std::max(size_[i], std::sqrt(size2));
        worst = worse(worst, difference2 == 0 ? 0 : std::sqrt(difference2) / size_[i]);
      }
      begin += n;
    }
    return worst;
  }

 private:
  /// The greater; a NaN stays.
  [[nodiscard]] static double worse(double a, double b) { return b <= a || a != a ? a : b; }

  template <int n>
  [[nodiscard]] static Eigen::Matrix<double, n, 1> part(const Vector& v, int begin) {
    Eigen::Matrix<double, n, 1> result;
    for (int k = 0; k < n; ++k) result[k] = v[begin + k];
    return result;
  }

  std::array<double, Scene::blocks.size()> size_;
};

template <class... Words>
[[noreturn]] void refuse_task(const Words&... words) {
  std::ostringstream text;
  text.precision(17);
  (text << ... << words);
  throw InvalidInput(text.str());
}

inline void check(const Task& task) {
  if (!(task.tolerance >= 1e-15 && task.tolerance <= 1e-2)) {
    refuse_task("tolerance = ", task.tolerance,
                " lies outside [1e-15, 1e-2], what double precision can promise");
  }
  if (!(task.smallest >= 0)) refuse_task("smallest = ", task.smallest, " must be 0 or above");
  if (task.times.empty()) refuse_task("no output times are given");
  const double direction = task.times.back() < task.begin ? -1 : 1;
  double before = task.begin;
  if (!std::isfinite(before)) refuse_task("the time of the beginning is not finite");
  for (const double t : task.times) {
    if (!std::isfinite(t)) refuse_task("an output time is not finite");
    if (direction * (t - before) < 0) {
      refuse_task("output times turn round: t = ", t, " s comes after ", before, " s");
    }
    before = t;
  }
}

/// Keeps the largest drift of what a scene says is conserved.
template <class Scene>
class InvariantWatch {
 public:
  explicit InvariantWatch(const Scene& scene) : scene_(scene) {}

  void note(double t, const typename Scene::State& state) {
    if constexpr (requires { scene_.conserved(t, state); }) {
      const auto now = scene_.conserved(t, state);
      if (drifts_.empty()) {
        for (const auto& [name, value] : now) drifts_.push_back({name, value, 0});
      }
      for (std::size_t i = 0; i < now.size(); ++i) {
        drifts_[i].largest =
            std::max(drifts_[i].largest, std::abs(now[i].second - drifts_[i].start));
      }
    }
  }

  [[nodiscard]] const std::vector<InvariantDrift>& drifts() const { return drifts_; }

 private:
  const Scene& scene_;
  std::vector<InvariantDrift> drifts_;
};

}  // namespace detail

namespace detail {

using Clock = std::chrono::steady_clock;

[[nodiscard]] inline double seconds_since(const Clock::time_point& begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

/// Notes a state for the output time t; says whether the run is to go on.
template <class Scene>
[[nodiscard]] bool output(Trajectory<typename Scene::State>& result, InvariantWatch<Scene>& watch,
                          const Task& task, double t, const typename Scene::State& state) {
  result.times.push_back(t);
  result.states.push_back(state);
  watch.note(t, state);
  if (!task.progress || task.progress(t)) return true;
  result.report.status = RunStatus::cancelled;
  return false;
}

template <class Scene>
[[nodiscard]] Trajectory<typename Scene::State> solve_closed(
    const Scene& scene, const typename Scene::State& start, const Task& task,
    const ClosedForm<typename Scene::State>& motion) {
  const Clock::time_point clock = Clock::now();
  Trajectory<typename Scene::State> result;
  RunReport& report = result.report;
  InvariantWatch<Scene> watch(scene);
  watch.note(task.begin, start);
  for (const double t : task.times) {
    report.error_estimate = std::max(report.error_estimate, motion.error(t));
    if (!output(result, watch, task, t, motion.at(t))) break;
  }
  report.method = motion.name;
  report.tolerance = task.tolerance;
  report.tolerance_kept = report.error_estimate <= task.tolerance;
  report.invariants = watch.drifts();
  report.run_time = seconds_since(clock);
  return result;
}

/// Two integrations run side by side, one whose steps are held 30 times more exact than the
/// other's. Their distance is, to a thirtieth, the error of the coarser one, which is returned; the
/// estimate is 1.3 times that and a random walk of rounding, 2.5 u a step. Where it exceeds the
/// tolerance the run begins again with shorter steps, until rounding stops it.
template <class Scene>
[[nodiscard]] Trajectory<typename Scene::State> solve_by_steps(const Scene& scene,
                                                               const typename Scene::State& start,
                                                               const Task& task) {
  constexpr double finer = 30;
  constexpr double caution = 1.3;
  constexpr double least = 1e-16;  // of the steps' accuracy
  constexpr double unit_roundoff = std::numeric_limits<double>::epsilon() / 2;
  const Clock::time_point clock = Clock::now();

  Trajectory<typename Scene::State> result;
  // The finer run ends at the middle first, lest a short run be one and the same step in both.
  const double end = task.times.back();
  const double middle = (task.begin + end) / 2;
  double spent = 0;
  double accuracy = std::max(task.tolerance / 10, 4 * least);
  while (true) {
    result = {};
    RunReport& report = result.report;
    report.method = "verner98";
    report.tolerance = task.tolerance;
    InvariantWatch<Scene> watch(scene);
    ErrorMeasure<Scene> distance(task.smallest);
    const bool last_try = accuracy <= 4 * least;
    Advance coarse(scene, task.begin, start, {accuracy, task.smallest});
    Advance fine(scene, task.begin, start, {std::max(accuracy / finer, least), task.smallest});
    coarse.stop_at(task.jumps);
    fine.stop_at(task.jumps);
    watch.note(task.begin, start);
    bool too_coarse = false;
    try {
      for (const double t : task.times) {
        const typename Scene::State state = coarse.on_the_way(t, end);
        const typename Scene::State better =
            fine.on_the_way(t, (t < middle) == (end > task.begin) ? middle : end);
        const double off = distance(Scene::to_vector(state), Scene::to_vector(better));
        const double rounding = 2.5 * unit_roundoff * std::sqrt(coarse.effort().steps);
        report.error_estimate = std::max(report.error_estimate, caution * off + rounding);
        too_coarse = report.error_estimate > task.tolerance && !last_try;
        if (too_coarse) break;
        if (!output(result, watch, task, t, state)) break;
      }
    } catch (const ComputationFailed& error) {
      report.status = RunStatus::failed;
      report.message = error.what();
    }
    spent += coarse.effort().evaluations + fine.effort().evaluations;
    if (too_coarse) {
      const double wanted =
          accuracy * std::clamp(task.tolerance / (3 * report.error_estimate), 1e-4, 0.2);
      accuracy = std::max(wanted, 4 * least);
      continue;
    }
    report.effort = coarse.effort();
    report.all_evaluations = spent;
    report.tolerance_kept = report.error_estimate <= task.tolerance;
    report.invariants = watch.drifts();
    report.run_time = seconds_since(clock);
    return result;
  }
}

}  // namespace detail

/// Solves a scene to a tolerance of the GLOBAL error, and says how far the result is off.
///
/// Scene  : has State, Vector, blocks, to_vector, from_vector and rates(t, y); with conserved(t,
///          state) its invariants are watched, with a closed_form() it is computed by that
/// Error  : by steps true error / estimate lies in [0.1, 1] in 99 % of 200 runs and never above 1
///          (tests/dynamics/solve/solve.cpp). Where the tolerance cannot be reached the best is
///          returned and RunReport::tolerance_kept is false
/// Cost   : by steps 2.5 times the integration alone, reported as all_evaluations
/// Throws : InvalidInput for a task that is none. What fails on the way is told by the report, with
///          the trajectory up to there
template <class Scene>
[[nodiscard]] Trajectory<typename Scene::State> solve(const Scene& scene,
                                                      const typename Scene::State& start,
                                                      const Task& task) {
  detail::check(task);
  if constexpr (requires { closed_form(scene, task.begin, start); }) {
    const auto motion = closed_form(scene, task.begin, start);
    if (motion && task.method == Method::automatic) {
      return detail::solve_closed(scene, start, task, *motion);
    }
  }
  return detail::solve_by_steps(scene, start, task);
}

}  // namespace kreisel
