#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <complex>
#include <cstddef>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <sstream>
#include <stop_token>
#include <type_traits>
#include <utility>
#include <vector>

#include <dynamics/model/closed_form.hpp>
#include <dynamics/rigid/euler_top.hpp>
#include <dynamics/solve/adaptive_runs.hpp>
#include <dynamics/solve/fixed_runs.hpp>
#include <dynamics/solve/missed.hpp>
#include <dynamics/solve/run.hpp>
#include <dynamics/solve/splitting_runs.hpp>
#include <dynamics/solve/switching_run.hpp>
#include <dynamics/step/checkpoint.hpp>
#include <motor/error.hpp>

namespace kreisel::detail {

[[nodiscard]] inline std::span<const double> components_of(const Eigen::VectorXd& y) {
  return {y.data(), static_cast<std::size_t>(y.size())};
}

/// The mean length of 20 steps of Verner98 at accuracy 1e-14, once the steps no longer grow.
[[nodiscard]] double pace(const SteppedScene& scene, const SolveOptions& options,
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

/// The runs of gauss16. `once` is the length of a step of Verner98 at 1e-14; steps with 16 Gauss
/// points can be about twice as long.
[[nodiscard]] FixedRuns gauss_runs(double once) {
  return {Method::gauss16, 16, 2 * once, once / 2};
}

[[nodiscard]] std::unique_ptr<SteppedRun> run(const AdaptiveRuns& runs, double setting,
                                              const SteppedScene& scene,
                                              const SolveOptions& options,
                                              const Eigen::VectorXd& start, bool moved,
                                              double shaken = 0) {
  const bool other = moved && scene.has_other();
  const Accuracy accuracy{setting, options.absolute_scale, options.max_evaluations, shaken};
  if (runs.method() == Method::radau13) {
    return std::make_unique<RadauRun>(scene, other, options, start, accuracy);
  }
  if (options.method == Method::automatic) {
    return std::make_unique<SwitchingRun>(scene, other, options, runs.method(), start, accuracy);
  }
  if (runs.method() == Method::taylor) return scene.taylor_run(options, start, accuracy, other);
  return scene.explicit_run(options, start, accuracy, other);
}

[[nodiscard]] std::unique_ptr<Run> run(const FixedRuns& runs, const EqualLength& length,
                                       const SteppedScene& scene, const SolveOptions& options,
                                       const Eigen::VectorXd& start, bool moved,
                                       double /*shaken*/ = 0) {
  const bool other = moved && scene.has_other();
  if (runs.method() == Method::gauss16) return scene.gauss_run(options, start, length, other);
  return std::make_unique<SplittingRun>(
      *scene.top(), options, EulerTop::from_vector(vector_of<EulerTop::Vector>(start)), length);
}

/// Records the largest drift of each conserved quantity of a scene.
class InvariantWatch {
 public:
  explicit InvariantWatch(const SteppedScene& scene) : scene_(scene) {}

  void note(double t, std::span<const double> y) { scene_.note_invariants(t, y, drifts_); }

  /// The least error of the state that explains the drifts: |drift| / sum of |change of the
  /// invariant| for changes of the state's components by their sizes. 0 if rounding explains the
  /// drifts.
  ///
  /// sizes : of blocks
  [[nodiscard]] double least_error(double t, std::span<const double> y,
                                   std::span<const double> sizes) const;

  template <class Checkpoint>
  void pass(Checkpoint& checkpoint) {
    for (InvariantDrift& drift : drifts_) checkpoint(drift.start, drift.largest);
  }

  [[nodiscard]] const std::vector<InvariantDrift>& drifts() const { return drifts_; }

 private:
  const SteppedScene& scene_;
  std::vector<InvariantDrift> drifts_;
};

inline double InvariantWatch::least_error(double t, std::span<const double> y,
                                          std::span<const double> sizes) const {
  if (drifts_.empty()) return 0;
  const auto invariants_at = [&](std::span<const double> state) {
    std::vector<InvariantDrift> values;
    scene_.note_invariants(t, state, values);
    return values;
  };
  const std::vector<InvariantDrift> here = invariants_at(y);
  std::vector<double> range(here.size(), 0);
  std::vector<double> moved(y.begin(), y.end());
  const std::vector<int> blocks = scene_.blocks();
  std::size_t i = 0;
  for (std::size_t k = 0; k < blocks.size(); ++k) {
    const double size = blocks[k] == 4 ? 1 : sizes[k];  // quaternions
    for (const std::size_t end = i + static_cast<std::size_t>(blocks[k]); i < end; ++i) {
      // A change by a part of the size gives the effect of small errors. Where they have no effect,
      // the change by the whole size counts.
      moved[i] = y[i] + size;
      const std::vector<InvariantDrift> far = invariants_at(moved);
      constexpr double part = 1e-6;
      moved[i] = y[i] + part * size;
      const std::vector<InvariantDrift> near = invariants_at(moved);
      moved[i] = y[i];
      for (std::size_t m = 0; m < here.size(); ++m) {
        range[m] += std::max(std::abs(far[m].start - here[m].start),
                             std::abs(near[m].start - here[m].start) / part);
      }
    }
  }
  double least = 0;
  for (std::size_t m = 0; m < here.size(); ++m) {
    constexpr double rounding = 1e-13;
    const double error = drifts_[m].largest / range[m];
    if (error > rounding) least = std::max(least, error);
  }
  return least;
}

using Clock = std::chrono::steady_clock;

[[nodiscard]] double seconds_since(const Clock::time_point& begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

void cancel(RunReport& report, const char* who, double last_output) {
  report.status = RunStatus::cancelled;
  std::ostringstream text;
  text.precision(17);
  text << "stopped by " << who << "; the last output is that of t = " << last_output << " s";
  report.message = text.str();
}

/// Passes a state to on_output; true if the run continues.
[[nodiscard]] bool show(const OnComponents& on_output, double t, std::span<const double> state,
                        RunReport& report) {
  if (!on_output || on_output(t, state) == OutputAction::proceed) return true;
  cancel(report, "on_output", t);
  return false;
}

/// Records a state and its error for the output time t; true if the run continues.
[[nodiscard]] bool output(Trajectory<double>& result, InvariantWatch& watch,
                          const OnComponents& on_output, double t, std::span<const double> state,
                          double error) {
  result.times.push_back(t);
  result.states.insert(result.states.end(), state.begin(), state.end());
  result.errors.push_back(error);
  watch.note(t, state);
  return show(on_output, t, state, result.report);
}

/// Shows the outputs of a run that nobody has watched, up to where the watcher stops it.
void show_all(Trajectory<double>& run, const OnComponents& on_output) {
  if (run.times.empty()) return;
  const std::size_t components = run.states.size() / run.times.size();
  const std::span<const double> all = run.states;
  for (std::size_t i = 0; i < run.times.size(); ++i) {
    if (show(on_output, run.times[i], all.subspan(i * components, components), run.report)) {
      continue;
    }
    run.times.resize(i + 1);
    run.states.resize((i + 1) * components);
    run.errors.resize(i + 1);
  }
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

/// A run with its outputs so far, which can be read again.
class RunSoFar {
 public:
  /// stop  : a time before the end at which a step ends, whatever the outputs are; or the end
  RunSoFar(std::unique_ptr<Run> run, Eigen::Index components, double stop)
      : run_(std::move(run)), components_(static_cast<std::size_t>(components)), stop_(stop) {}

  /// The state at the i-th output, valid until the next call. Outputs must be read in order, each
  /// time from the first one on.
  [[nodiscard]] std::span<const double> at_output(std::size_t i, double t, double end) {
    if (i == first_ + known_) advance_to(t, end);
    return {states_.data() + (i - first_) * components_, components_};
  }

  /// True if the run has its outputs from the first one on; false if a checkpoint began it.
  [[nodiscard]] bool knows_all() const { return first_ == 0; }

  /// Replaces this run by another, which takes over cost and stop.
  void replace_by(RunSoFar other) {
    other.spent_before_ = spent();
    other.stop_ = stop_;
    *this = std::move(other);
  }

  /// The number of evaluations so far.
  [[nodiscard]] double spent() const { return std::max(spent_before_, effort().evaluations); }

  [[nodiscard]] IntegrationStatistics effort() const { return run_->effort(); }
  [[nodiscard]] double noise() const { return run_->noise(); }
  [[nodiscard]] std::span<const double> sizes() const { return run_->sizes(); }
  [[nodiscard]] std::string changes() const { return run_->changes(); }
  [[nodiscard]] std::optional<Method> changed_to() const { return run_->changed_to(); }

  /// Passes all numbers from which the run continues after the first `done` outputs.
  void pass(std::size_t done, Checkpoint& checkpoint) {
    if (known_ == 0) first_ = done;
    run_->pass(checkpoint);
    checkpoint(spent_before_, stop_, has_stopped_);
    std::size_t ahead = first_ + known_ - done;
    checkpoint(ahead);
    for (std::size_t i = done; i < done + ahead; ++i) {
      double* const y =
          i == first_ + known_ ? next_state() : states_.data() + (i - first_) * components_;
      for (std::size_t k = 0; k < components_; ++k) checkpoint(y[k]);
    }
  }

 private:
  /// Takes steps to t and keeps the state there. If the stop lies ahead, a step ends at it.
  void advance_to(double t, double end) {
    const bool before = stop_ == end || (t < stop_) == (stop_ < end);
    if (!before && !has_stopped_) {
      std::vector<double> y(components_);
      run_->on_the_way(stop_, stop_, y.data());
      has_stopped_ = true;
    }
    run_->on_the_way(t, has_stopped_ ? end : stop_, next_state());
  }

  [[nodiscard]] double* next_state() {
    known_ += 1;
    states_.resize(known_ * components_);
    return states_.data() + (known_ - 1) * components_;
  }

  std::unique_ptr<Run> run_;
  std::size_t components_;
  double stop_;
  bool has_stopped_ = false;
  std::size_t first_ = 0;       ///< output that is kept
  std::size_t known_ = 0;       ///< number of outputs kept
  std::vector<double> states_;  ///< one after another
  double spent_before_ = 0;     ///< a lower bound of spent()
};

/// The growth of rounding, estimated by three runs with the same steps, coarse and cheap. Two of
/// them are perturbed, in different ways, because one alone may miss the direction that grows. Runs
/// with different steps would differ by the errors of these steps. Near a separatrix the growth may
/// far exceed the errors of steps, which cancel there.
class RoundingGrowth {
 public:
  RoundingGrowth(const AdaptiveRuns& runs, double accuracy, const SteppedScene& scene,
                 const SolveOptions& options, const Eigen::VectorXd& start)
      : runs_(runs),
        stop_(options.stop),
        calm_(run(runs, accuracy, scene, options, start, false)),
        calm_state_(start),
        shaken_state_(start),
        distance_(scene.blocks(), options.absolute_scale) {
    double digits = AdaptiveRuns::shaken_digits;
    for (auto& shaken : shaken_) {
      shaken = run(runs, accuracy, scene, options, start, false, digits);
      digits += 1;  // other digits, another direction
    }
  }

  /// The size of rounding at t, in the measure of RunReport::error_estimate. Times must be given in
  /// order. 0 if such coarse steps fail.
  [[nodiscard]] double at(double t, double end) {
    if (gave_up_) return 0;
    try {
      while (!calm_->covers(t)) {
        stop_if_requested(stop_);
        calm_->step_towards(end, t);
        for (const auto& shaken : shaken_) shaken->follow(*calm_);
      }
      calm_->read(t, calm_state_.data());
      double off = 0;
      for (const auto& shaken : shaken_) {
        shaken->read(t, shaken_state_.data());
        off = max_or_nan(off, distance_(components_of(calm_state_), components_of(shaken_state_)));
      }
      gave_up_ = !std::isfinite(off);
      return gave_up_ ? 0 : AdaptiveRuns::rounding_of(off);
    } catch (const StopRequested&) {
      throw;
    } catch (...) {  // an exception of a load or guide here must not end the run
      gave_up_ = true;
      return 0;
    }
  }

  [[nodiscard]] bool may_be_too_much(double grown_to) const {
    return runs_.may_round_too_much(grown_to);
  }

  [[nodiscard]] double evaluations() const {
    double sum = calm_->effort().evaluations;
    for (const auto& shaken : shaken_) sum += shaken->effort().evaluations;
    return sum;
  }

  void pass(Checkpoint& checkpoint) {
    checkpoint(distance_, gave_up_);
    calm_->pass(checkpoint);
    for (const auto& shaken : shaken_) shaken->pass(checkpoint);
  }

 private:
  const AdaptiveRuns& runs_;
  std::stop_token stop_;
  std::unique_ptr<SteppedRun> calm_;
  std::array<std::unique_ptr<SteppedRun>, 2> shaken_;
  Eigen::VectorXd calm_state_;
  Eigen::VectorXd shaken_state_;
  BlockDistance distance_;
  bool gave_up_ = false;
};

/// The times at which two runs are compared: the output times and, if these are few, others in
/// between. The error estimate then does not depend on the outputs requested.
class ComparisonTimes {
 public:
  ComparisonTimes(const SolveOptions& options, bool adds) {
    constexpr int least = 16;
    const double end = options.output_times.back();
    const bool forwards = end > options.begin;
    const auto before = [&](double a, double b) { return forwards ? a < b : a > b; };
    const int added =
        adds && options.output_times.size() < least && end != options.begin ? least - 1 : 0;
    int next = 1;
    for (const double t : options.output_times) {
      for (; next <= added; ++next) {
        const double between = options.begin + next * ((end - options.begin) / least);
        if (!before(between, t)) break;
        times_.push_back({between, false});
      }
      times_.push_back({t, true});
    }
  }

  [[nodiscard]] std::size_t size() const { return times_.size(); }
  [[nodiscard]] double operator[](std::size_t i) const { return times_[i].t; }
  [[nodiscard]] bool is_output(std::size_t i) const { return times_[i].is_output; }

  /// The last output time before the i-th time; `begin` if there is none.
  [[nodiscard]] double last_output(std::size_t i, double begin) const {
    while (i > 0) {
      if (times_[--i].is_output) return times_[i].t;
    }
    return begin;
  }

 private:
  struct Time {
    double t;
    bool is_output;
  };
  std::vector<Time> times_;
};

/// The expected error at the end, from the error at time t: proportional to time, at most tenfold.
[[nodiscard]] double forecast(const SolveOptions& options, double t, double error) {
  const double ahead = (options.output_times.back() - options.begin) / (t - options.begin);
  return error * (ahead < 10 ? ahead : 10);
}

/// The cost of all runs of one call of solve().
struct Account {
  double spent = 0;  ///< evaluations
};

/// The result of the coarser of two runs, with the error that the pair shows.
///
/// The error of the finer run is many times smaller. One run starts a last digit away, or as many
/// digits as rounding changes by the end. The pair then also shows the growth of these digits: near
/// a separatrix, steps of any length round the same digits away. If the error exceeds the
/// tolerance, or is about to, the finer run takes the coarser run's place beside a still finer one.
/// If that does not suffice, both begin again, until rounding leaves nothing to gain.
///
/// Where rounding grows to the tolerance, two runs may agree by chance.
/// - Explicit steps: one run of the first pair is perturbed by more digits than are rounded. If the
///   pair does not agree to a part of the tolerance, RoundingGrowth estimates the growth of
///   rounding. Both runs then continue, the perturbed one anew if its perturbation is the cause. If
///   rounding may exceed the tolerance, or the error does not decrease with the steps, the finest
///   steps are taken at once.
/// - Other steps: to try pairs until two agree would prove nothing. After a miss, a third run is
///   compared if steps are so fine that their error may be rounding. An error that decreases much
///   faster than the steps counts as rounding too. The finest runs are four, or six where rounding
///   grows to more than the tolerance.
///
/// Throws : InvalidInput for a checkpoint of other runs; an empty one stands for the start
template <class Runs>
[[nodiscard]] Trajectory<double> solve_in_pairs(const SteppedScene& scene, Runs runs,
                                                const Eigen::VectorXd& start,
                                                const SolveOptions& options,
                                                const std::vector<double>& checkpoint,
                                                Account& account, const OnComponents& on_output) {
  const Clock::time_point clock = Clock::now();

  Trajectory<double> result;
  const double end = options.output_times.back();
  const ComparisonTimes times(options, std::is_same_v<Runs, AdaptiveRuns>);
  double digits = digits_off(options);
  double grown_to = 0;  // by rounding, in any try: the greatest
  CheapSteps cheap;     // to estimate it
  double known = 0;     // error at this setting, from a try with fewer digits
  auto setting = runs.first();
  Missed<decltype(setting)> missed{setting};
  // A scene with a perturbed copy is compared with the copy: cheap steps cannot estimate the effect
  // of stiff springs.
  bool pair_is_shaken = runs.shakes() && !scene.has_other();
  bool looks_for_rounding = !runs.shakes() && !scene.has_other();
  const auto run_with = [&](const auto& s, double moved, double stop) {
    Eigen::VectorXd from = start;
    if (moved != 0) move_last_digits(from, moved);
    const double shaken = pair_is_shaken && moved > 0 ? runs.pair_digits() : 0;
    return RunSoFar(run(runs, s, scene, options, from, moved != 0, shaken), start.size(), stop);
  };
  // A step of a finer run ends between start and end, so that a short run is not the same single
  // step in both runs. The time differs from run to run, because the runs may continue side by
  // side. Equal steps do not need it.
  const auto finer_run_with = [&](const auto& s, double moved) {
    const double part = moved > 0 ? 1.0 / 2 : moved < 0 ? 2.0 / 5 : 1.0 / 3;
    const double stop = options.begin + part * (end - options.begin);
    return run_with(s, moved, std::is_same_v<Runs, AdaptiveRuns> ? stop : end);
  };
  std::optional<Checkpoint> from;
  if (!checkpoint.empty()) from.emplace(checkpoint);
  // Implicit steps round more.
  const auto rounding_of = [&](const RunSoFar& run) {
    return run.changed_to() ? AdaptiveRuns::rounding_of_radau : runs.rounding();
  };
  bool coarse_starts_off = false;
  const bool has_checkpoints = runs.method() != Method::splitting;
  const auto pass_setting = [&](Checkpoint& numbers) {
    auto own = static_cast<double>(runs.method());
    numbers(own, setting, missed, digits, account.spent, coarse_starts_off, pair_is_shaken,
            looks_for_rounding, cheap);
    if (own == static_cast<double>(Method::verner98)) (void)runs.round_less();
    if (own != static_cast<double>(runs.method()))
      refuse_task("the checkpoint is of another method");
  };
  if (from) pass_setting(*from);
  std::optional<RunSoFar> coarse;
  std::optional<RunSoFar> fine;
  while (true) {
    result = {};
    const bool last_try = runs.last(setting);
    RunReport& report = result.report;
    report.method = name(runs.method());
    report.tolerance = options.tolerance;
    report.error_estimate = known;
    InvariantWatch watch(scene);
    BlockDistance distance(scene.blocks(), options.absolute_scale);
    // If only rounding is left, a start one digit away is a sample of its effect.
    if (last_try) digits = std::max(digits, 3 * digits_off(options));
    if (!coarse) coarse.emplace(run_with(setting, coarse_starts_off ? digits : 0, end));
    if (!fine) {
      fine.emplace(finer_run_with(runs.finer(setting), coarse_starts_off ? 0 : digits));
    }
    std::optional<RoundingGrowth> rounding;
    if constexpr (std::is_same_v<Runs, AdaptiveRuns>) {
      if (looks_for_rounding && runs.can_look_for_rounding(setting, missed.error > 0)) {
        rounding.emplace(runs, cheap.beside(runs, setting), scene, options, start);
      }
    }
    // If only rounding is left, two runs may agree by chance; more runs, each with steps of its
    // own, do so less often. Steps that begin near rounding and miss remain near it in every later
    // try.
    const bool near_rounding = last_try || (runs.begins_near_rounding() && missed.error > 0);
    const bool may_be_rounding =
        runs.begins_near_rounding() || (missed.error > 0 && runs.may_be_rounding(setting));
    const bool grown = last_try && digits_off(options) > 0;  // rounding, to far more than its size
    const int more_alone = grown ? 4 : near_rounding ? 2 : may_be_rounding ? 1 : 0;
    const int more = rounding ? (last_try ? 1 : 0) : more_alone;
    // An error that begins near rounding and comes near the tolerance is rounding that has grown.
    // Three runs agree on it by chance more often than four.
    const bool surprises = runs.begins_near_rounding() && !near_rounding;
    const double enough = surprises ? options.tolerance / 10 : options.tolerance;
    std::vector<RunSoFar> others;
    for (int i = 1; i <= more; ++i) {
      others.push_back(finer_run_with(runs.between(setting, double(i) / (more + 1)), -digits));
    }
    watch.note(options.begin, components_of(start));
    std::size_t done = 0;
    const auto spend_on_others = [&] {
      for (const RunSoFar& other : others) account.spent += other.spent();
      if (rounding) account.spent += rounding->evaluations();
    };
    const auto pass_run = [&](Checkpoint& numbers) {
      if (!has_checkpoints) return;
      numbers(done, report.error_estimate, grown_to, distance, watch);
      coarse->pass(done, numbers);
      fine->pass(done, numbers);
      for (RunSoFar& other : others) other.pass(done, numbers);
      if (rounding) rounding->pass(numbers);
    };
    const auto checkpoint_here = [&] {
      Checkpoint numbers;
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
    bool rounds_too_much = false;
    bool too_coarse = false;
    std::span<const double> state = components_of(start);
    try {
      while (done < times.size()) {
        const double t = times[done];
        const std::span<const double> reached = coarse->at_output(done, t, end);
        distance.note_sizes(coarse->sizes());
        // A run that was moved by last digits does not begin with the given ones.
        state = t == options.begin ? components_of(start) : reached;
        double off = 0;
        const auto hold_beside = [&](RunSoFar& run) {
          off = max_or_nan(off, distance(state, run.at_output(done, t, end)));
        };
        hold_beside(*fine);
        for (RunSoFar& other : others) hold_beside(other);
        double noise = coarse->noise();
        // Coarse steps of a stiff motion diverge when perturbed, without any growth of rounding.
        if (rounding && !coarse->changed_to()) {
          const double now = rounding->at(t, end);
          noise = max_or_nan(noise, now);
          grown_to = max_or_nan(grown_to, now);
          rounds_too_much = rounding->may_be_too_much(grown_to);
        }
        const double error = error_of_pair(off, runs.finer_by(setting), rounding_of(*coarse),
                                           coarse->effort().steps, noise);
        if (last_try && !std::isfinite(error)) {
          stop_integration(t, "the state has grown beyond the range of numbers");
        }
        report.error_estimate = max_or_nan(report.error_estimate, error);
        missed.note(done, report.error_estimate);
        expected = forecast(options, t, report.error_estimate);
        too_coarse = !last_try &&
                     (report.error_estimate > enough || expected > 4 * enough || rounds_too_much);
        if (too_coarse) break;
        const bool is_output = times.is_output(done);
        if (is_output && !output(result, watch, on_output, t, state, error)) break;
        ++done;
        const bool offers =
            is_output && has_checkpoints && options.offer_checkpoint && done < times.size();
        if (offers) options.offer_checkpoint(std::cref(checkpoint_here));
      }
    } catch (const StopRequested&) {
      cancel(report, "request", times.last_output(done, options.begin));
    } catch (const ComputationFailed& error) {
      report.status = RunStatus::failed;
      // An exception of a load or a guide contains no time.
      const double last_good = times.last_output(done, options.begin);
      std::ostringstream text;
      text.precision(17);
      text << error.what() << "; the last output is that of t = " << last_good << " s";
      report.message = text.str();
    }
    spend_on_others();
    const bool complete = report.status == RunStatus::complete;
    const bool implicit = coarse->changed_to().has_value();
    const bool unsure = !implicit && pair_is_shaken && !looks_for_rounding &&
                        report.error_estimate > options.tolerance / 8 &&
                        runs.can_look_for_rounding(setting, missed.error > 0);
    // The perturbation itself causes a third of the error or more.
    const bool shaken_too_much = !implicit && pair_is_shaken && !rounds_too_much &&
                                 runs.of_pair(grown_to) > report.error_estimate / 3;
    bool asks_again = false;
    if constexpr (std::is_same_v<Runs, AdaptiveRuns>) {
      asks_again = complete && rounds_too_much && !last_try && cheap.refine(grown_to, setting);
    }
    if (asks_again) grown_to = 0;
    if (complete && (unsure || shaken_too_much || asks_again)) {
      looks_for_rounding = true;
      known = 0;
      if (shaken_too_much) {
        pair_is_shaken = false;
        std::optional<RunSoFar>& shaken = coarse_starts_off ? coarse : fine;
        account.spent += shaken->spent();
        shaken.reset();
      }
      const auto begin_again = [&](std::optional<RunSoFar>& from_output, auto at, double moved) {
        if (from_output && !from_output->knows_all())
          from_output->replace_by(run_with(at, moved, end));
      };
      begin_again(coarse, setting, coarse_starts_off ? digits : 0);
      begin_again(fine, runs.finer(setting), coarse_starts_off ? 0 : digits);
      continue;
    }
    account.spent += coarse->spent();
    // Rounding in a long run has more effect than a start one digit away.
    const bool rounding_is_known = rounding && !last_try;
    const double lost = rounding_is_known ? 0 : runs.digits_lost(setting, coarse->effort().steps);
    const bool too_close = lost > 2 * std::max(digits, 1.0);
    if (too_close) digits = lost;
    const bool is_fine = runs.is_fine(setting);
    const bool by_chance = !rounding && !too_coarse && !last_try && complete && is_fine &&
                           missed.falls_by_chance(runs, setting);
    // The error of implicit steps decreases more slowly than the error of explicit steps.
    const bool only_rounds =
        rounds_too_much || (!implicit && is_fine && missed.stays(runs, setting));
    const bool stays = by_chance || (too_coarse && only_rounds);
    if (too_coarse && missed.error == 0) missed = {setting, done, report.error_estimate};
    const bool finer_will_do = !stays && expected < runs.finer_by(setting) * options.tolerance &&
                               digits <= 1 && !scene.has_other();
    if (too_coarse && finer_will_do && runs.goes_on(setting)) {
      setting = runs.finer(setting);
      coarse_starts_off = !coarse_starts_off;
      known = 0;
      if (!fine->knows_all()) {
        fine->replace_by(run_with(setting, coarse_starts_off ? digits : 0, end));
        for (std::size_t i = 0; i <= done; ++i) (void)fine->at_output(i, times[i], end);
      }
      coarse.emplace(std::move(*fine));
      fine.reset();
      continue;
    }
    account.spent += fine->spent();
    if (stays && runs.round_less()) {
      setting = runs.first();
      missed = {setting};
      digits = digits_off(options);
      grown_to = 0;
      cheap = {};
      known = 0;
      coarse_starts_off = false;
      coarse.reset();
      fine.reset();
      continue;
    }
    // The growth of the digits may hide the error of the steps.
    if (too_coarse || by_chance || (too_close && complete)) {
      known = too_coarse || by_chance ? 0 : report.error_estimate;
      if (too_coarse || by_chance) {
        setting =
            stays ? runs.finest() : runs.tightened(setting, options.tolerance / (2 * expected));
      }
      coarse_starts_off = false;
      pair_is_shaken = pair_is_shaken && !looks_for_rounding && !runs.last(setting);
      coarse.reset();
      fine.reset();
      continue;
    }
    report.error_estimate = max_or_nan(report.error_estimate, grown_to);
    if (complete && done > 0) {
      const double shown = watch.least_error(times[done - 1], state, distance.sizes());
      report.error_estimate = max_or_nan(report.error_estimate, shown);
    }
    report.method = name(coarse->changed_to().value_or(runs.method()));
    report.changes = coarse->changes();
    report.sizes = distance.sizes();
    report.effort = coarse->effort();
    report.all_evaluations = account.spent;
    report.tolerance_kept =
        report.status != RunStatus::failed && report.error_estimate <= options.tolerance;
    report.invariants = watch.drifts();
    report.run_time = seconds_since(clock);
    return result;
  }
}

/// The start for the steps. Quaternions, whose norm has no meaning, are scaled to a norm near 1,
/// because errors are relative to size.
///
/// Throws : InvalidInput if the state is so small that products of its components underflow
[[nodiscard]] Eigen::VectorXd start_of_steps(const SteppedScene& scene,
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

Trajectory<double> solve_by_steps(const SteppedScene& scene, const Eigen::VectorXd& given,
                                  const SolveOptions& options, const OnComponents& on_output) try {
  const Clock::time_point clock = Clock::now();
  const Eigen::VectorXd start = start_of_steps(scene, given, options.absolute_scale);
  const bool automatic = options.method == Method::automatic;
  Account account;
  const OnComponents nobody;
  const OnComponents* watcher = &on_output;
  const auto go_on = [&](const auto& runs, const SolveOptions& asked,
                         const std::vector<double>& checkpoint) {
    auto result = solve_in_pairs(scene, runs, start, asked, checkpoint, account, *watcher);
    result.report.run_time = seconds_since(clock);
    return result;
  };
  const auto with = [&](const auto& runs) { return go_on(runs, options, options.checkpoint); };
  // Steps that are too long for a later part of the motion do not converge there.
  const auto by_gauss = [&](const SolveOptions& asked, const std::vector<double>& checkpoint) {
    const double once = pace(scene, asked, start);
    auto result = go_on(gauss_runs(once), asked, checkpoint);
    constexpr int most_tries = 4;
    for (int i = 1; i <= most_tries && result.report.status == RunStatus::failed; ++i) {
      if (result.report.all_evaluations > asked.max_evaluations) break;
      result = go_on(gauss_runs(once * std::pow(0.25, i)), asked, checkpoint);
    }
    return result;
  };

  if (const EulerTop* const top = scene.top()) {
    const auto state = EulerTop::from_vector(vector_of<EulerTop::Vector>(start));
    const bool pays = automatic && splits(*top) && is_fast(*top, state);
    if (pays || options.method == Method::splitting)
      return with(splitting_runs(*top, options, state));
  }
  if (options.method == Method::radau13) return with(AdaptiveRuns(options, Method::radau13));
  if (options.method == Method::gauss16) return by_gauss(options, options.checkpoint);
  const auto explicitly = [&](const SolveOptions& asked, const std::vector<double>& checkpoint) {
    const bool by_series = scene.knows_series() && asked.method != Method::verner98;
    const Method method = by_series ? Method::taylor : Method::verner98;
    return go_on(AdaptiveRuns(asked, method), asked, checkpoint);
  };
  auto result = explicitly(options, options.checkpoint);
  if (!automatic) return result;
  const bool stiff = !result.report.changes.empty();

  // If the tolerance was missed, another method may come nearer to it.
  const auto missed = [&] {
    const RunReport& report = result.report;
    return report.status == RunStatus::complete && !report.tolerance_kept;
  };
  const auto or_by = [&](Method method, const auto& run) {
    SolveOptions alone = options;  // a checkpoint lacks the other trajectory
    alone.offer_checkpoint = nullptr;
    alone.method = method;
    watcher = &nobody;  // until the other run has proved better
    auto other = run(alone);
    if (other.report.status == RunStatus::complete &&
        other.report.error_estimate < result.report.error_estimate) {
      result = std::move(other);
      show_all(result, on_output);
    }
  };
  const auto by_steps = [&](const SolveOptions& asked) { return explicitly(asked, {}); };
  if (missed() && stiff) {
    // The cost of explicit steps, as short as stability requires; their last digits are better.
    const double rate = std::abs(dominant_eigenvalue(scene, false, options.begin, start));
    const double evaluations = 5 * rate * std::abs(options.output_times.back() - options.begin);
    if (evaluations < 10 * account.spent) {
      or_by(scene.knows_series() ? Method::taylor : Method::verner98, by_steps);
    }
  } else if (missed() && result.report.method == name(Method::taylor)) {
    // Many stages average the rounding of the field.
    or_by(Method::verner98, by_steps);
  }
  // With fixed symmetric steps errors grow with time, with adaptive steps with its square.
  if (missed() && !stiff && result.report.effort.steps > 1e5 && options.discontinuities.empty()) {
    or_by(Method::gauss16, [&](const SolveOptions& asked) { return by_gauss(asked, {}); });
  }
  return result;
} catch (const StopRequested&) {  // before the first step of a run
  Trajectory<double> none;
  none.report.method = name(options.method);
  none.report.tolerance = options.tolerance;
  cancel(none.report, "request", options.begin);
  return none;
}

/// Throws : InvalidInput if a quaternion of the start is 0, which steps would neither correct nor
///          report
void check_start(const SteppedScene& scene, const Eigen::VectorXd& start) {
  int begin = 0;
  for (const int components : scene.blocks()) {
    if (components == 4 && norm(start, begin, components) == 0) {
      refuse_task("the attitude at the start is a quaternion of norm 0");
    }
    begin += components;
  }
}

/// Throws : InvalidInput if the requested method does not fit the scene
void check_method(const SteppedScene& scene, const SolveOptions& options) {
  const auto refuse = [&](const char* why) {
    refuse_task("method ", name(options.method), " does not apply: ", why);
  };
  const bool fixed_steps = options.method == Method::gauss16 || options.method == Method::splitting;
  if (fixed_steps && !options.discontinuities.empty())
    refuse("its equal steps cannot end at the jumps");
  if (options.method == Method::taylor && !scene.knows_series()) {
    refuse("this scene does not know its series");
  }
  if (options.method != Method::splitting) return;
  if (scene.top() && splits(*scene.top())) return;
  refuse("it is for an EulerTop with two equal moments, under weight and without rotor");
}

void check(const SteppedScene& scene, const Eigen::VectorXd& start, const SolveOptions& options) {
  check(options);
  check_method(scene, options);
  check_start(scene, start);
}

void refuse_closed_form() {
  refuse_task("method closed form does not apply: this scene has none that is known");
}

}  // namespace kreisel::detail
