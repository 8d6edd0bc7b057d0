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
#include <utility>
#include <vector>

#include <dynamics/solve/closed_form.hpp>
#include <dynamics/solve/error_measure.hpp>
#include <dynamics/solve/missed.hpp>
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
        drifts_[i].largest = worse(drifts_[i].largest, std::abs(now[i].second - drifts_[i].start));
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

using Clock = std::chrono::steady_clock;

[[nodiscard]] inline double seconds_since(const Clock::time_point& begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

/// Notes a state and its error for the output time t; says whether the run is to go on.
template <class Scene>
[[nodiscard]] bool output(Trajectory<typename Scene::State>& result, InvariantWatch<Scene>& watch,
                          const Task& task, double t, const typename Scene::State& state,
                          double error) {
  result.times.push_back(t);
  result.states.push_back(state);
  result.errors.push_back(error);
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
    const double error = motion.error(t, task.smallest);
    report.error_estimate = worse(report.error_estimate, error);
    if (!output(result, watch, task, t, motion.at(t), error)) break;
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

/// A run with what it has given so far, so that it can be asked again.
template <class Scene, class Run>
class RunSoFar {
 public:
  RunSoFar(Run run, double moved) : run_(std::move(run)), moved_(moved) {}

  /// The state at the i-th output; they are asked for in turn, each time from the first one on.
  [[nodiscard]] const typename Scene::State& at_output(std::size_t i, double t, double end) {
    if (i == first_ + states_.size()) states_.push_back(run_.on_the_way(t, end));
    return states_[i - first_];
  }

  /// By how many last digits its start is moved.
  [[nodiscard]] double moved() const { return moved_; }

  /// Whether it knows its outputs from the first one on: not if it was begun by a bookmark.
  [[nodiscard]] bool knows_all() const { return first_ == 0; }

  [[nodiscard]] bool stiff() const {
    if constexpr (requires { run_.stiff(); }) {
      return run_.stiff();
    } else {
      return false;
    }
  }
  [[nodiscard]] const Effort& effort() const { return run_.effort(); }

  /// What rounding in the field has made by now, where the run knows that; else 0.
  [[nodiscard]] double noise() const {
    if constexpr (requires { run_.noise(); }) {
      return run_.noise();
    } else {
      return 0;
    }
  }

  /// What it goes on from behind the first `done` outputs.
  template <class Bookmark>
  requires requires(Run& run, Bookmark& bookmark) { run.pass(bookmark); }
  void pass(const Scene& scene, std::size_t done, Bookmark& bookmark) {
    if (states_.empty()) first_ = done;
    run_.pass(bookmark);
    std::size_t ahead = first_ + states_.size() - done;
    bookmark(ahead);
    for (std::size_t i = done; i < done + ahead; ++i) {
      const bool known = i < first_ + states_.size();
      typename Scene::Vector y;
      if (known) y = scene.to_vector(states_[i - first_]);
      bookmark(y);
      if (!known) states_.push_back(scene.from_vector(y));
    }
  }

 private:
  Run run_;
  double moved_;
  std::size_t first_ = 0;  ///< output it knows
  std::vector<typename Scene::State> states_;
};

/// How great the error may be at the end, if that at time t is so great: in proportion to time, up to
/// tenfold.
[[nodiscard]] inline double forecast(const Task& task, double t, double error) {
  const double ahead = (task.times.back() - task.begin) / (t - task.begin);
  return error * (ahead < 10 ? ahead : 10);
}

/// Two integrations run side by side, the steps of one held many times more exact than the other's;
/// the coarser one is returned, with the error that the pair tells of. One of them starts a last
/// digit away, or as many as rounding has taken by the end, so that the pair also tells what that
/// grows to: near a separatrix steps of any length round the same digits away. Where the error
/// exceeds the tolerance, or is on its way to, the finer run takes the coarser's place beside one
/// finer still; or both begin again, where that would not do; until rounding stops it. Pairs that
/// are tried until two agree by chance would tell nothing: a third is held beside them where, after a
/// miss, steps are so fine that what they err by may be rounding; and where the error does not fall as
/// the steps do, the finest are taken at once, and four of them; or six, where rounding grows to more
/// than the tolerance.
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
  const double end = task.times.back();
  const std::optional<Scene> changed = off_by_last_digits(scene);
  double digits = digits_off(task);
  double known = 0;  // of the error at this setting, from a try with fewer digits
  auto setting = runs.first();
  Missed<decltype(setting)> missed{setting};
  const auto run_with = [&](const auto& s, double moved) {
    using Run = decltype(runs.run(s, scene, start));
    if (moved == 0) return RunSoFar<Scene, Run>(runs.run(s, scene, start), 0);
    return RunSoFar<Scene, Run>(
        runs.run(s, changed ? *changed : scene, off_by_last_digits(scene, start, moved)), moved);
  };
  // The finer run ends somewhere on the way, lest a short run be one and the same step in both; and
  // somewhere else than the others, beside which it may go on.
  const auto better_at_output = [&](auto& fine, std::size_t i) -> const typename Scene::State& {
    const double t = task.times[i];
    const double part = fine.moved() > 0 ? 1.0 / 2 : fine.moved() < 0 ? 2.0 / 5 : 1.0 / 3;
    const double stop = task.begin + part * (end - task.begin);
    return fine.at_output(i, t, (t < stop) == (end > task.begin) ? stop : end);
  };
  std::optional<Bookmark> from;
  if (!bookmark.empty()) from.emplace(bookmark);
  bool coarse_starts_off = false;
  const auto kind = static_cast<double>(Runs::method);
  const auto pass_setting = [&](Bookmark& numbers) {
    double own = kind;
    numbers(own, setting, missed, digits, spent, coarse_starts_off);
    if (own != kind) refuse_task("the bookmark is of another method");
  };
  if (from) pass_setting(*from);
  std::optional coarse = run_with(setting, coarse_starts_off ? digits : 0);
  while (true) {
    result = {};
    RunReport& report = result.report;
    report.method = name(Runs::method);
    report.tolerance = task.tolerance;
    report.error_estimate = known;
    InvariantWatch<Scene> watch(scene);
    ErrorMeasure<Scene> distance(scene, task.smallest);
    const bool last_try = runs.last(setting);
    // Where rounding is all that is left, a start one digit away is a sample of what it does.
    if (last_try) digits = std::max(digits, 3 * digits_off(task));
    std::optional fine = run_with(runs.finer(setting), coarse_starts_off ? 0 : digits);
    // Where rounding is all that is left, two runs may agree by chance: more do so less, each with
    // steps of its own. Steps that begin near rounding and miss are near it in every later try.
    const bool near_rounding = last_try || (Runs::begins_near_rounding && missed.error > 0);
    const bool may_be_rounding =
        Runs::begins_near_rounding || (missed.error > 0 && runs.may_be_rounding(setting));
    const bool grown = last_try && digits_off(task) > 0;  // to far more than it is made by
    const int more = grown ? 4 : near_rounding ? 2 : may_be_rounding ? 1 : 0;
    // What begins near rounding and comes near the tolerance is rounding that has grown: three runs
    // agree on that by chance more often than four.
    const bool surprises = Runs::begins_near_rounding && !near_rounding;
    const double enough = surprises ? task.tolerance / 10 : task.tolerance;
    std::vector<RunSoFar<Scene, decltype(runs.run(setting, scene, start))>> others;
    for (int i = 1; i <= more; ++i) {
      others.push_back(run_with(runs.between(setting, double(i) / (more + 1)), -digits));
    }
    watch.note(task.begin, start);
    std::size_t done = 0;
    const auto pass_run = [&](Bookmark& numbers) {
      if constexpr (requires { coarse->pass(scene, done, numbers); }) {
        numbers(done, report.error_estimate, distance, watch);
        coarse->pass(scene, done, numbers);
        fine->pass(scene, done, numbers);
        for (auto& other : others) other.pass(scene, done, numbers);
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
    double expected = 0;
    bool too_coarse = false;
    try {
      while (done < task.times.size()) {
        const double t = task.times[done];
        const typename Scene::State& reached = coarse->at_output(done, t, end);
        // One that was moved by last digits begins with others than were given.
        const typename Scene::State& state = t == task.begin ? start : reached;
        if (coarse->stiff()) {
          spent += coarse->effort().evaluations + fine->effort().evaluations;
          for (const auto& other : others) spent += other.effort().evaluations;
          return std::nullopt;
        }
        const typename Scene::State& better = better_at_output(*fine, done);
        double off = distance(scene.to_vector(state), scene.to_vector(better));
        for (auto& other : others) {
          const typename Scene::State& beside = better_at_output(other, done);
          off = worse(off, distance(scene.to_vector(state), scene.to_vector(beside)));
        }
        const double error = error_of_pair(off, runs.finer_by(setting), Runs::rounding,
                                           coarse->effort().steps, coarse->noise());
        report.error_estimate = worse(report.error_estimate, error);
        missed.note(done, report.error_estimate);
        expected = forecast(task, t, report.error_estimate);
        too_coarse = !last_try && (report.error_estimate > enough || expected > 4 * enough);
        if (too_coarse) break;
        if (!output(result, watch, task, t, state, error)) break;
        ++done;
        if constexpr (requires(Bookmark & numbers) { coarse->pass(scene, done, numbers); }) {
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
    spent += coarse->effort().evaluations;
    for (const auto& other : others) spent += other.effort().evaluations;
    // Rounding on a long way does more than to move the start by a digit.
    const double lost = runs.digits_lost(setting, coarse->effort().steps);
    const bool too_close = lost > 2 * std::max(digits, 1.0);
    if (too_close) digits = lost;
    const bool stays = too_coarse && missed.stays(runs, setting);
    if (too_coarse && missed.error == 0) missed = {setting, done, report.error_estimate};
    const bool finer_will_do =
        !stays && expected < runs.finer_by(setting) * task.tolerance && digits <= 1 && !changed;
    if (too_coarse && finer_will_do && runs.goes_on(setting)) {
      setting = runs.finer(setting);
      coarse_starts_off = !coarse_starts_off;
      known = 0;
      if (!fine->knows_all()) {
        fine.emplace(run_with(setting, coarse_starts_off ? digits : 0));
        for (std::size_t i = 0; i <= done; ++i) better_at_output(*fine, i);
      }
      coarse.emplace(std::move(*fine));
      continue;
    }
    spent += fine->effort().evaluations;
    // What the digits grow to may hide what the steps err by.
    if (too_coarse || (too_close && report.status == RunStatus::complete)) {
      known = too_coarse ? 0 : report.error_estimate;
      if (too_coarse) {
        setting = stays ? runs.finest() : runs.tightened(setting, task.tolerance / (2 * expected));
      }
      coarse_starts_off = false;
      coarse.emplace(run_with(setting, 0));
      continue;
    }
    report.effort = coarse->effort();
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
  const auto explicitly = [&] {
    if constexpr (knows_series<Scene>) {
      if (automatic || task.method == Method::taylor) return with(TaylorRuns<Scene>(task));
    }
    return with(VernerRuns<Scene>(task));
  }();
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
  if (task.method == Method::taylor && !knows_series<Scene>) {
    refuse("this scene does not know its series");
  }
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
///          state) its invariants are watched, with a closed_form() it is computed by that, with
///          series() by those
/// Error  : by steps true error / estimate lies in [0.1, 1] in 97 % of 400 runs and never above 1.1
///          (tests/dynamics/solve/solve.cpp); docs/promises.md tells where that ends. Where the
///          tolerance cannot be reached the best is returned and RunReport::tolerance_kept is false
/// Cost   : by steps 2.3 times the integration alone, 3.4 times by gauss16, reported as
///          all_evaluations; 2.8 to 3.1 times where the first pair of runs errs too much, more than
///          5 in 1 % of 1620 runs at 1e-12 and above; twice that where so many steps near the last
///          digits are taken that rounding outgrows them. Outputs take ten evaluations in each step
///          that has some, by series none
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
