#pragma once

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <optional>
#include <sstream>
#include <type_traits>
#include <vector>

#include <dynamics/solve/closed_form.hpp>
#include <dynamics/solve/error_measure.hpp>
#include <dynamics/solve/report.hpp>
#include <dynamics/solve/runs.hpp>
#include <dynamics/solve/task.hpp>
#include <dynamics/step/bookmark.hpp>
#include <motor/error.hpp>

namespace kreisel {

namespace detail {

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

  template <class Bookmark>
  void pass(Bookmark& bookmark) {
    for (InvariantDrift& drift : drifts_) bookmark(drift.start, drift.largest);
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

/// The scene that a run is held against: the same but for last digits of parameters of which so
/// little makes much, if it has such.
template <class Scene>
[[nodiscard]] std::optional<Scene> off_by_last_digits(const Scene& scene) {
  if constexpr (requires { scene.off_by_last_digits(); }) {
    return scene.off_by_last_digits();
  } else {
    return std::nullopt;
  }
}

/// Two integrations run side by side, one whose steps are held 30 times more exact than the
/// other's; the coarser one is returned, with the error that the pair tells of. The finer one starts
/// a last digit away, or as many as rounding has taken by the end, so that the pair also tells what
/// that grows to: near a separatrix steps of any length round the same digits away. Where the error
/// exceeds the tolerance the run begins again with shorter steps, until rounding stops it.
///
/// Nothing is returned where the field proved stiff and the runs' kind is not made for that.
///
/// Throws : InvalidInput for a bookmark that is none of these runs; an empty one is of their begin
template <class Scene, class Runs>
[[nodiscard]] std::optional<Trajectory<typename Scene::State>> solve_in_pairs(
    const Scene& scene, const Runs& runs, const typename Scene::State& start, const Task& task,
    const std::vector<double>& bookmark, double& spent) {
  const Clock::time_point clock = Clock::now();

  Trajectory<typename Scene::State> result;
  // The finer run ends at the middle first, lest a short run be one and the same step in both.
  const double end = task.times.back();
  const double middle = (task.begin + end) / 2;
  const std::optional<Scene> changed = off_by_last_digits(scene);
  double digits = digits_off(task);
  double known = 0;  // of the error at this setting, from a try with fewer digits
  auto setting = runs.first();
  std::optional<Bookmark> from;
  if (!bookmark.empty()) from.emplace(bookmark);
  const auto kind = static_cast<double>(Runs::method);
  const auto pass_setting = [&](Bookmark& numbers) {
    double own = kind;
    numbers(own, setting, digits, spent);
    if (own != kind) refuse_task("the bookmark is of another method");
  };
  if (from) pass_setting(*from);
  while (true) {
    result = {};
    RunReport& report = result.report;
    report.method = name(Runs::method);
    report.tolerance = task.tolerance;
    report.error_estimate = known;
    InvariantWatch<Scene> watch(scene);
    ErrorMeasure<Scene> distance(scene, task.smallest);
    const bool last_try = runs.last(setting);
    auto coarse = runs.run(setting, scene, start);
    // Where rounding is all that is left, a start one digit away is a sample of what it does.
    if (last_try) digits = std::max(digits, 3 * digits_off(task));
    auto fine = runs.run(runs.finer(setting), changed ? *changed : scene,
                         off_by_last_digits(scene, start, digits));
    watch.note(task.begin, start);
    std::size_t done = 0;
    const auto pass_run = [&](Bookmark& numbers) {
      if constexpr (requires { coarse.pass(numbers); }) {
        numbers(done, report.error_estimate, distance, watch, coarse, fine);
      }
    };
    const auto bookmark_here = [&] {
      Bookmark numbers;
      pass_setting(numbers);
      pass_run(numbers);
      return numbers.numbers();
    };
    if (from) {
      pass_run(*from);
      from->finish();
      from.reset();
    }
    bool too_coarse = false;
    try {
      while (done < task.times.size()) {
        const double t = task.times[done];
        const typename Scene::State state = coarse.on_the_way(t, end);
        if constexpr (requires { coarse.stiff(); }) {
          if (coarse.stiff()) {
            spent += coarse.effort().evaluations + fine.effort().evaluations;
            return std::nullopt;
          }
        }
        const typename Scene::State better =
            fine.on_the_way(t, (t < middle) == (end > task.begin) ? middle : end);
        const double off = distance(scene.to_vector(state), scene.to_vector(better));
        report.error_estimate = std::max(
            report.error_estimate,
            error_of_pair(off, runs.finer_by(setting), Runs::rounding, coarse.effort().steps));
        too_coarse = report.error_estimate > task.tolerance && !last_try;
        if (too_coarse) break;
        if (!output(result, watch, task, t, state)) break;
        ++done;
        if constexpr (requires(Bookmark & numbers) { coarse.pass(numbers); }) {
          const bool offers = task.offer_bookmark && done < task.times.size();
          if (offers) task.offer_bookmark(std::cref(bookmark_here));
        }
      }
    } catch (const ComputationFailed& error) {
      report.status = RunStatus::failed;
      // What a load or a guide throws knows no time.
      const double last_good = done == 0 ? task.begin : task.times[done - 1];
      std::ostringstream text;
      text.precision(17);
      text << error.what() << "; the last output is that of t = " << last_good << " s";
      report.message = text.str();
    }
    spent += coarse.effort().evaluations + fine.effort().evaluations;
    // Rounding on a long way does more than to move the start by a digit.
    const double lost = runs.digits_lost(setting, coarse.effort().steps);
    const bool too_close = lost > 2 * std::max(digits, 1.0);
    if (too_close) digits = lost;
    if (too_coarse) {
      setting = runs.tightened(setting, task.tolerance / (3 * report.error_estimate));
      known = 0;
      continue;
    }
    if (too_close && report.status == RunStatus::complete) {
      // What the digits grow to may hide what the steps err by.
      known = report.error_estimate;
      continue;
    }
    report.effort = coarse.effort();
    report.all_evaluations = spent;
    report.tolerance_kept =
        report.status != RunStatus::failed && report.error_estimate <= task.tolerance;
    report.invariants = watch.drifts();
    report.run_time = seconds_since(clock);
    return result;
  }
}

/// The start as steps take it: quaternions, whose norm means nothing, brought near the norm 1, for
/// it is by size that errors are measured.
///
/// Throws : where the state is so small that products of its components underflow
template <class Scene>
[[nodiscard]] typename Scene::State start_of_steps(const Scene& scene,
                                                   const typename Scene::State& start,
                                                   double smallest) {
  using Limits = std::numeric_limits<double>;
  const double least = std::sqrt(Limits::min() / Limits::epsilon());
  typename Scene::Vector y = scene.to_vector(start);
  int begin = 0;
  for (const int components : blocks_of(scene)) {
    const double size = norm(y, begin, components);
    const bool attitude = components == 4;
    if (attitude && std::isfinite(size) && std::abs(std::ilogb(size)) > 4) {
      const int power = std::ilogb(size);  // of two, lest anything be rounded
      for (int i = begin; i < begin + components; ++i) y[i] = std::ldexp(y[i], -power);
    } else if (size > 0 && size < least && smallest < least) {
      refuse_task("a part of the state is ", size, " at the start, and below ", least,
                  " products of it underflow: take other units, or a `smallest` above that");
    }
    begin += components;
  }
  return scene.from_vector(y);
}

template <class Scene>
[[nodiscard]] Trajectory<typename Scene::State> solve_by_steps(const Scene& scene,
                                                               const typename Scene::State& given,
                                                               const Task& task) {
  const Clock::time_point clock = Clock::now();
  const typename Scene::State start = start_of_steps(scene, given, task.smallest);
  const bool automatic = task.method == Method::automatic;
  double spent = 0;
  const auto go_on = [&](const auto& runs, const Task& asked, const std::vector<double>& bookmark) {
    auto result = solve_in_pairs(scene, runs, start, asked, bookmark, spent);
    if (result) result->report.run_time = seconds_since(clock);
    return result;
  };
  const auto with = [&](const auto& runs) { return go_on(runs, task, task.bookmark); };

  if constexpr (std::is_same_v<Scene, EulerTop>) {
    const bool pays = automatic && splits(scene) && is_fast(scene, start);
    if (pays || task.method == Method::splitting) return *with(SplittingRuns(scene, task, start));
  }
  if (task.method == Method::radau13) return *with(RadauRuns<Scene>(task));
  if (task.method == Method::gauss16) return *with(GaussRuns(scene, task, start));
  const bool was_stiff = automatic && !task.bookmark.empty() &&
                         task.bookmark.front() == static_cast<double>(Method::radau13);
  if (was_stiff) return *with(RadauRuns<Scene>(task));
  const auto explicitly = with(VernerRuns<Scene>(task));
  if (!explicitly) return *go_on(RadauRuns<Scene>(task), task, {});
  // Fixed symmetric steps let errors grow with time where adaptive ones let them with its square.
  const RunReport& report = explicitly->report;
  const bool long_run = report.status == RunStatus::complete && report.effort.steps > 1e5;
  if (automatic && long_run && !report.tolerance_kept && task.jumps.empty()) {
    Task alone = task;  // a bookmark would not know the other trajectory
    alone.offer_bookmark = nullptr;
    auto fixed = go_on(GaussRuns(scene, alone, start), alone, {});
    if (fixed->report.status == RunStatus::complete &&
        fixed->report.error_estimate < report.error_estimate) {
      return *fixed;
    }
  }
  return *explicitly;
}

/// Throws where a quaternion of the start turns nothing, which no step would mend or tell.
template <class Scene>
void check_start(const Scene& scene, const typename Scene::State& start) {
  const typename Scene::Vector y = scene.to_vector(start);
  int begin = 0;
  for (const int components : blocks_of(scene)) {
    if (components == 4 && norm(y, begin, components) == 0) {
      refuse_task("the attitude at the start is a quaternion of norm 0");
    }
    begin += components;
  }
}

/// Throws what is wrong with the method asked for, for this scene.
template <class Scene>
void check_method(const Scene& scene, const Task& task) {
  const auto refuse = [&](const char* why) {
    refuse_task("method ", name(task.method), " does not apply: ", why);
  };
  const bool fixed_steps = task.method == Method::gauss16 || task.method == Method::splitting;
  if (fixed_steps && !task.jumps.empty()) refuse("its equal steps cannot end at the jumps");
  if (task.method != Method::splitting) return;
  if constexpr (std::is_same_v<Scene, EulerTop>) {
    if (splits(scene)) return;
  }
  refuse("it is for an EulerTop with two equal moments, under weight and without rotor");
}

}  // namespace detail

/// Solves a scene to a tolerance of the GLOBAL error, and says how far the result is off.
///
/// Scene  : has State, Vector, blocks, to_vector, from_vector and rates(t, y); with conserved(t,
///          state) its invariants are watched, with a closed_form() it is computed by that
/// Error  : by steps true error / estimate lies in [0.1, 1] in 98 % of 200 runs and never above 1
///          (tests/dynamics/solve/solve.cpp); docs/promises.md tells where that ends. Where the
///          tolerance cannot be reached the best is returned and RunReport::tolerance_kept is false
/// Cost   : by steps 2.5 times the integration alone, reported as all_evaluations; twice that where
///          so many steps near the last digits are taken that rounding outgrows them
/// Throws : InvalidInput for a task that is none or a method that does not fit the scene. What
///          fails on the way is told by the report, with the trajectory up to there
template <class Scene>
[[nodiscard]] Trajectory<typename Scene::State> solve(const Scene& scene,
                                                      const typename Scene::State& start,
                                                      const Task& task) {
  detail::check(task);
  detail::check_method(scene, task);
  detail::check_start(scene, start);
  const bool closed_wanted = task.method == Method::closed_form || task.method == Method::automatic;
  if constexpr (requires { closed_form(scene, task.begin, start); }) {
    if (closed_wanted) {
      const auto motion = closed_form(scene, task.begin, start);
      if (motion) return detail::solve_closed(scene, start, task, *motion);
    }
  }
  if (task.method == Method::closed_form) {
    detail::refuse_task("method closed form does not apply: this scene has none that is known");
  }
  return detail::solve_by_steps(scene, start, task);
}

}  // namespace kreisel
