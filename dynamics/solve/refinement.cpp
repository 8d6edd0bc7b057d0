#include <algorithm>

#include <dynamics/solve/refinement.hpp>

namespace kreisel::detail {

double forecast(const SolveOptions& options, double t, double error) {
  const double ahead = (options.output_times.back() - options.begin) / (t - options.begin);
  return error * (ahead < rules::greatest_forecast ? ahead : rules::greatest_forecast);
}

Refinement::Refinement(const SolveOptions& options, const Levels& levels, bool has_other)
    : options_(&options),
      levels_(levels),
      has_other_(has_other),
      accuracy_(levels.first()),
      missed_{accuracy_},
      digits_(digits_off(options)),
      pair_is_perturbed_(levels.perturbs() && !has_other),
      looks_for_rounding_(!levels.perturbs() && !has_other) {}

Refinement Refinement::of_lanes(const SolveOptions& options, const Levels& levels) {
  Refinement result(options, levels, false);
  result.pair_is_perturbed_ = false;
  result.looks_for_rounding_ = true;
  result.may_shift_ = false;
  return result;
}

bool Refinement::is_too_coarse(double error, double expected, bool rounds_too_much) const {
  if (is_last()) return false;
  // An error that begins near rounding and comes near the tolerance is rounding that has grown.
  // Three runs agree on it by chance more often than four.
  const bool surprises = levels_.traits().starts_near_rounding && missed_.error == 0;
  const double enough = surprises ? options_->tolerance / rules::departs : options_->tolerance;
  return error > enough || expected > rules::hopeless * enough || rounds_too_much;
}

void Refinement::begin_try() {
  if (is_last()) digits_ = std::max(digits_, 3 * digits_off(*options_));
}

bool Refinement::looks_for_rounding() const {
  return looks_for_rounding_ && levels_.can_look_for_rounding(accuracy_, missed_.error > 0);
}

int Refinement::more_runs() const {
  if (looks_for_rounding()) return is_last() ? 1 : 0;
  const bool starts_near = levels_.traits().starts_near_rounding;
  const bool grown = is_last() && digits_off(*options_) > 0;  // rounding, to far more than its size
  if (grown) return 4;
  // Steps that begin near rounding and miss remain near it in every later try.
  if (is_last() || (starts_near && missed_.error > 0)) return 2;
  return starts_near || (missed_.error > 0 && levels_.may_be_rounding(accuracy_)) ? 1 : 0;
}

bool Refinement::looks_again(const TryResult& tried) {
  drops_perturbed_ = false;
  if (!tried.complete) return false;
  const bool perturbed = !tried.is_implicit && pair_is_perturbed_;
  const bool unsure = perturbed && !looks_for_rounding_ &&
                      tried.error > rules::agrees_well * options_->tolerance &&
                      levels_.can_look_for_rounding(accuracy_, missed_.error > 0);
  constexpr double great_part = 1.0 / 3;
  drops_perturbed_ =
      perturbed && !tried.rounds_too_much && levels_.of_pair(grown_to_) > great_part * tried.error;
  const bool asks_again =
      tried.rounds_too_much && !is_last() && cheap_.refine(grown_to_, accuracy_);
  if (asks_again) grown_to_ = 0;
  return unsure || drops_perturbed_ || asks_again;
}

bool Refinement::is_by_chance(const TryResult& tried) const {
  const double power = is_implicit(tried) ? rules::power_of_implicit_steps : 1;
  return !tried.knows_growth && !tried.too_coarse && !is_last() && tried.complete &&
         levels_.follows_its_order(accuracy_) && missed_.falls_by_chance(accuracy_, power);
}

bool Refinement::is_implicit(const TryResult& tried) const {
  return tried.is_implicit || levels_.method() == Method::radau13;
}

/// Finer steps than those of a try whose error fell by more than expected. Where implicit steps pass
/// over an oscillation, and finer ones resolve it, this is no chance.
void Refinement::confirm(const TryResult& tried) {
  missed_ = {accuracy_, tried.output, tried.error};
  accuracy_ = levels_.tightened(accuracy_, rules::confirms);
  known_ = {};
  coarse_starts_off_ = false;
}

bool Refinement::only_rounds(const TryResult& tried) const {
  // The error of implicit steps decreases more slowly than the error of explicit steps.
  const bool follows = !tried.is_implicit && levels_.follows_its_order(accuracy_);
  return tried.rounds_too_much || (follows && missed_.stays(accuracy_));
}

void Refinement::begin_with_another_method() {
  accuracy_ = levels_.first();
  missed_ = {accuracy_};
  digits_ = digits_off(*options_);
  grown_to_ = 0;
  known_ = {};
  cheap_ = {};
  coarse_starts_off_ = false;
}

Next Refinement::next(const TryResult& tried) {
  if (looks_again(tried)) {
    looks_for_rounding_ = true;
    known_ = {};
    if (drops_perturbed_) pair_is_perturbed_ = false;
    return Next::look_for_rounding;
  }
  // Rounding in a long run has more effect than a start one digit away.
  const double lost =
      tried.knows_growth && !is_last() ? 0 : levels_.digits_lost(accuracy_, tried.steps);
  const bool too_close = lost > 2 * std::max(digits_, 1.0);
  if (too_close) digits_ = lost;
  const bool by_chance = is_by_chance(tried);
  if (by_chance && is_implicit(tried)) {
    confirm(tried);
    return Next::begin_again;
  }
  const bool stays = by_chance || (tried.too_coarse && only_rounds(tried));
  if (tried.too_coarse && missed_.error == 0) missed_ = {accuracy_, tried.output, tried.error};

  const bool finer_will_do = may_shift_ && !stays &&
                             tried.expected < levels_.finer_by(accuracy_) * options_->tolerance &&
                             digits_ <= 1 && !has_other_;
  if (tried.too_coarse && finer_will_do && levels_.goes_on(accuracy_)) {
    accuracy_ = levels_.finer(accuracy_);
    coarse_starts_off_ = !coarse_starts_off_;
    known_ = {};
    return Next::shift;
  }
  if (stays && levels_.round_less()) {
    begin_with_another_method();
    return Next::begin_again;
  }
  const bool misses = tried.too_coarse || by_chance;
  // The growth of the digits may hide the error of the steps.
  if (!misses && !(too_close && tried.complete)) return Next::accept;
  known_ = misses ? ErrorParts{} : tried.error_parts;
  if (misses) {
    accuracy_ = stays ? levels_.finest()
                      : levels_.tightened(accuracy_, options_->tolerance / (2 * tried.expected));
  }
  coarse_starts_off_ = false;
  pair_is_perturbed_ = pair_is_perturbed_ && !looks_for_rounding_ && !is_last();
  return Next::begin_again;
}

}  // namespace kreisel::detail
