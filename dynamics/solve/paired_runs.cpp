#include <algorithm>
#include <cmath>
#include <functional>
#include <sstream>
#include <utility>

#include <dynamics/solve/outputs.hpp>
#include <dynamics/solve/paired_runs.hpp>
#include <motor/error.hpp>

namespace kreisel::detail {

PairedRuns::PairedRuns(const RunMaker& maker, const Levels& levels, const OnComponents& on_output,
                       double& spent)
    : maker_(maker),
      options_(maker.options()),
      on_output_(on_output),
      spent_(spent),
      end_(options_.output_times.back()),
      times_(options_, levels.adapts()),
      refinement_(options_, levels, maker.scene().has_other()) {}

Trajectory<double> PairedRuns::solve(const std::vector<double>& checkpoint) {
  std::optional<Checkpoint> from;
  if (!checkpoint.empty()) from.emplace(checkpoint);
  if (from) pass_setting(*from);
  while (true) {
    begin_try();
    if (from) continue_from(*from);
    from.reset();
    compare();
    spent_ += spent_beside();
    const Next next = refinement_.next(summary());
    if (next == Next::accept) return finish();
    prepare(next);
  }
}

/// A run whose start is moved upwards is also perturbed.
RunSoFar PairedRuns::made(RunRequest request) const {
  const Levels& levels = refinement_.levels();
  if (refinement_.pair_is_perturbed() && request.moved > 0) {
    request.perturbed = levels.pair_digits();
  }
  return {maker_.run(levels, request), maker_.start().size(), request.stops_at};
}

RunSoFar PairedRuns::coarse_run() const {
  const double moved = refinement_.coarse_starts_off() ? refinement_.digits() : 0;
  return made({.accuracy = refinement_.accuracy(), .moved = moved, .stops_at = coarse_stops_at_});
}

/// Steps of a finer run end between two discontinuities, so that a short way is not the same single
/// step in both runs. The place differs from run to run, because the runs may continue side by side.
/// Equal steps do not need it.
RunSoFar PairedRuns::finer_run(double accuracy, double moved) const {
  const double part = moved > 0 ? 1.0 / 2 : moved < 0 ? 2.0 / 5 : 1.0 / 3;
  return made(
      {.accuracy = accuracy, .moved = moved, .beside = refinement_.accuracy(), .stops_at = part});
}

RunSoFar PairedRuns::finer_run() const {
  const double moved = refinement_.coarse_starts_off() ? 0 : refinement_.digits();
  return finer_run(refinement_.levels().finer(refinement_.accuracy()), moved);
}

void PairedRuns::begin_try() {
  refinement_.begin_try();
  const Levels& levels = refinement_.levels();
  const double accuracy = refinement_.accuracy();
  const double digits = refinement_.digits();
  try_.emplace(maker_);
  RunReport& report = try_->result.report;
  report.method = name(levels.method());
  report.tolerance = options_.tolerance;
  report.raise(refinement_.known());
  if (!coarse_) coarse_.emplace(coarse_run());
  if (!fine_) fine_.emplace(finer_run());
  if (refinement_.looks_for_rounding()) {
    try_->growth.emplace(maker_, levels, refinement_.cheap_accuracy());
  }
  const int more = refinement_.more_runs();
  for (int i = 1; i <= more; ++i) {
    try_->others.push_back(finer_run(levels.between(accuracy, double(i) / (more + 1)), -digits));
  }
  try_->watch.note(options_.begin, components_of(maker_.start()));
  try_->state = components_of(maker_.start());
}

void PairedRuns::compare() {
  RunReport& report = try_->result.report;
  const auto last_output = [&] { return times_.last_output(try_->done, options_.begin); };
  try {
    while (try_->done < times_.size() && compare_at_next_time()) {
    }
  } catch (const StopRequested&) {
    cancel(report, "request", last_output());
  } catch (const ComputationFailed& error) {
    report.status = RunStatus::failed;
    // An exception of a load or a guide contains no time.
    std::ostringstream text;
    text.precision(15);
    text << error.what() << "; the last output is that of t = " << last_output() << " s";
    report.message = text.str();
  }
}

/// Compares the runs at the next time; false if the try ends there.
bool PairedRuns::compare_at_next_time() {
  const double t = times_[try_->done];
  const std::span<const double> reached = coarse_->at_output(try_->done, t, end_);
  try_->distance.note_sizes(coarse_->sizes());
  // A run that was moved by last digits does not begin with the given ones.
  const bool is_start = t == options_.begin;
  try_->state = is_start ? components_of(maker_.start_after_samples()) : reached;
  const ErrorParts error = error_at(t);
  if (is_start) try_->state = components_of(maker_.start());
  if (refinement_.is_last() && !std::isfinite(error.sum())) {
    stop_integration(t, "the state has grown beyond the range of numbers");
  }
  note_error(error, t);
  if (try_->too_coarse) return false;
  return finish_output(t, error.sum());
}

ErrorParts PairedRuns::error_at(double t) {
  double off = 0;
  const auto hold_beside = [&](RunSoFar& run) {
    off = max_or_nan(off, try_->distance(try_->state, run.at_output(try_->done, t, end_)));
  };
  hold_beside(*fine_);
  for (RunSoFar& other : try_->others) hold_beside(other);
  const Levels& levels = refinement_.levels();
  const double rounding = coarse_->changed_to() ? rules::rounding_of_radau13 : levels.rounding();
  return error_of_pair(off, levels.finer_by(refinement_.accuracy()), rounding,
                       coarse_->effort().steps, noise_at(t));
}

/// The rounding that the steps and the growth of perturbations show.
double PairedRuns::noise_at(double t) {
  const double of_steps = coarse_->noise();
  // Coarse steps of a stiff motion diverge when perturbed, without any growth of rounding.
  if (!try_->growth || coarse_->changed_to()) return of_steps;
  const double now = try_->growth->at(t, end_);
  refinement_.note_growth(now);
  try_->rounds_too_much = refinement_.levels().may_round_too_much(refinement_.grown_to());
  return max_or_nan(of_steps, now);
}

void PairedRuns::note_error(const ErrorParts& error, double t) {
  RunReport& report = try_->result.report;
  report.raise(error);
  refinement_.note(try_->done, report.error_estimate);
  try_->expected = forecast(options_, t, report.error_estimate);
  try_->too_coarse =
      refinement_.is_too_coarse(report.error_estimate, try_->expected, try_->rounds_too_much);
}

/// Records the time as done, and its output if it is one; false if the run ends there.
bool PairedRuns::finish_output(double t, double error) {
  const bool is_output = times_.is_output(try_->done);
  if (is_output && !output(try_->result, try_->watch, on_output_, t, try_->state, error)) {
    return false;
  }
  ++try_->done;
  if (is_output && has_checkpoints() && options_.offer_checkpoint && try_->done < times_.size()) {
    const auto here = [this] { return checkpoint(); };
    options_.offer_checkpoint(std::cref(here));
  }
  return true;
}

TryResult PairedRuns::summary() const {
  const RunReport& report = try_->result.report;
  return {.complete = report.status == RunStatus::complete,
          .too_coarse = try_->too_coarse,
          .is_implicit = coarse_->changed_to().has_value(),
          .knows_growth = try_->growth.has_value(),
          .rounds_too_much = try_->rounds_too_much,
          .error = report.error_estimate,
          .error_parts = report.error_parts,
          .expected = try_->expected,
          .steps = coarse_->effort().steps,
          .output = try_->done};
}

void PairedRuns::prepare(Next next) {
  if (next == Next::look_for_rounding) return look_for_rounding();
  if (next == Next::shift) return shift();
  spent_ += coarse_->spent() + fine_->spent();
  coarse_stops_at_ = 0;
  coarse_.reset();
  fine_.reset();
}

/// Both runs are read again from the start; one that a checkpoint began does not know it.
void PairedRuns::look_for_rounding() {
  if (refinement_.drops_perturbed()) {
    std::optional<RunSoFar>& perturbed = refinement_.coarse_starts_off() ? coarse_ : fine_;
    spent_ += perturbed->spent();
    perturbed.reset();
  }
  if (coarse_ && !coarse_->knows_all()) coarse_->replace_by(coarse_run());
  if (fine_ && !fine_->knows_all()) fine_->replace_by(finer_run());
}

void PairedRuns::shift() {
  spent_ += coarse_->spent();
  coarse_stops_at_ = fine_->stops_at();
  if (!fine_->knows_all()) {
    fine_->replace_by(coarse_run());
    for (std::size_t i = 0; i <= try_->done; ++i) (void)fine_->at_output(i, times_[i], end_);
  }
  coarse_.emplace(std::move(*fine_));
  fine_.reset();
}

Trajectory<double> PairedRuns::finish() {
  spent_ += coarse_->spent() + fine_->spent();
  RunReport& report = try_->result.report;
  report.raise({0, refinement_.grown_to()});
  if (report.status == RunStatus::complete && try_->done > 0) {
    const double shown =
        try_->watch.least_error(times_[try_->done - 1], try_->state, try_->distance.sizes());
    report.raise({shown, 0});
  }
  report.method = name(coarse_->changed_to().value_or(refinement_.levels().method()));
  report.changes = coarse_->changes();
  report.sizes = try_->distance.sizes();
  report.effort = coarse_->effort();
  report.all_evaluations = spent_;
  report.tolerance_kept =
      report.status != RunStatus::failed && report.error_estimate <= options_.tolerance;
  report.invariants = try_->watch.drifts();
  return std::move(try_->result);
}

bool PairedRuns::has_checkpoints() const { return refinement_.levels().traits().has_checkpoints; }

double PairedRuns::spent_beside() const {
  double sum = try_->growth ? try_->growth->evaluations() : 0;
  for (const RunSoFar& other : try_->others) sum += other.spent();
  return sum;
}

void PairedRuns::pass_setting(Checkpoint& numbers) {
  refinement_.pass(numbers);
  numbers(spent_, coarse_stops_at_);
}

void PairedRuns::pass_runs(Checkpoint& numbers) {
  if (!has_checkpoints()) return;
  Try& t = *try_;
  RunReport& report = t.result.report;
  numbers(t.done, report.error_estimate, report.error_parts.truncation, report.error_parts.rounding,
          t.distance, t.watch);
  coarse_->pass(t.done, numbers);
  fine_->pass(t.done, numbers);
  for (RunSoFar& other : t.others) other.pass(t.done, numbers);
  if (t.growth) t.growth->pass(numbers);
}

void PairedRuns::continue_from(Checkpoint& numbers) {
  pass_runs(numbers);
  numbers.finish();
}

std::vector<double> PairedRuns::checkpoint() {
  Checkpoint numbers;
  pass_setting(numbers);
  pass_runs(numbers);
  return numbers.numbers();
}

}  // namespace kreisel::detail
