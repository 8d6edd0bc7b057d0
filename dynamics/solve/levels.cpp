#include <algorithm>
#include <array>
#include <cmath>

#include <dynamics/solve/levels.hpp>

namespace kreisel::detail {

namespace {

/// One row for each method that takes steps. A new method needs a row, and a run in run_maker.cpp.
constexpr std::array<MethodTraits, 5> methods{{
    // method, order, finer by, first, finest, rounding, digits lost, growth, near rounding, checkpoints
    {Method::verner98, 0, rules::times_finer_verner98, rules::first_below_tolerance,
     rules::finest_verner98, rules::rounding_of_step, 1, true, false, true},
    {Method::taylor, 0, rules::times_finer, rules::first_below_tolerance_taylor,
     rules::finest_taylor, rules::rounding_of_step, 2.5, true, false, true},
    {Method::radau13, 0, rules::times_finer, rules::first_below_tolerance, rules::finest_radau13,
     rules::rounding_of_radau13, 4, false, false, true},
    {Method::gauss16, 16, rules::times_finer, 1, 0, rules::rounding_of_step, 1, false, true, true},
    {Method::splitting, 8, rules::times_finer, 1, 0, rules::rounding_of_step, 1, false, false,
     false},
}};

}  // namespace

const MethodTraits& traits_of(Method method) {
  const auto* const row =
      std::find_if(methods.begin(), methods.end(),
                   [method](const MethodTraits& traits) { return traits.method == method; });
  if (row == methods.end()) refuse_task("method ", name(method), " takes no steps");
  return *row;
}

Levels::Levels(const SolveOptions& options, Method method)
    : options_(&options), traits_(&traits_of(method)), finest_(traits_->finest) {}

Levels::Levels(const SolveOptions& options, Method method, const StepLengths& lengths)
    : options_(&options),
      traits_(&traits_of(method)),
      finest_(std::pow(lengths.shortest / lengths.first, traits_->order)),
      first_length_(lengths.first) {}

double Levels::first() const {
  return adapts() ? allowed(options_->tolerance / traits_->first_below_tolerance) : 1;
}

double Levels::finer(double accuracy) const {
  const double finer = accuracy / traits_->finer_by;
  return adapts() ? std::max(finer, finest_ / 4) : finer;
}

double Levels::finer_by(double accuracy) const {
  // If the shortest equal steps still have an error, its cause is rounding or an undeclared jump:
  // neither decreases with the method's order.
  if (!adapts()) return last(accuracy) ? 2 : traits_->finer_by;
  return accuracy / finer(accuracy);
}

double Levels::between(double accuracy, double part) const {
  return accuracy * std::pow(finer(accuracy) / accuracy, part);
}

double Levels::tightened(double accuracy, double ratio) const {
  if (adapts()) {
    return allowed(accuracy *
                   std::clamp(ratio, rules::greatest_tightening, rules::least_tightening));
  }
  const double greatest = std::pow(rules::greatest_shortening, traits_->order);
  const double least = std::pow(rules::least_shortening, traits_->order);
  return std::max(accuracy * std::clamp(ratio, greatest, least), finest_);
}

bool Levels::goes_on(double accuracy) const {
  return adapts() && finer(accuracy) > rules::near_rounding;
}

bool Levels::follows_its_order(double accuracy) const {
  return !adapts() || accuracy <= rules::follows_its_order;
}

bool Levels::may_be_rounding(double accuracy) const {
  if (!adapts()) return false;
  // With radau13 at finer tolerances a third run would estimate ten times too great an error for
  // stiff bearings.
  if (!traits_->shows_growth && digits_off(*options_) == 0) return false;
  constexpr double fine = 5e-14;
  return accuracy <= fine && accuracy < options_->tolerance / rules::amplifies;
}

double Levels::length(double accuracy) const {
  return first_length_ * std::pow(accuracy, 1.0 / traits_->order);
}

double Levels::rounding() const {
  constexpr double last_digits = 1e-13;
  if (method() == Method::verner98 && options_->tolerance <= last_digits) {
    return rules::rounding_of_verner98_at_last_digits;
  }
  return traits_->rounding;
}

double Levels::digits_lost(double accuracy, double steps) const {
  constexpr double fine = 1e-13;
  if (adapts() && accuracy > fine) return 0;
  return traits_->digits_lost * (rules::digits_per_root_of_steps * std::sqrt(steps));
}

bool Levels::perturbs() const { return traits_->shows_growth && digits_off(*options_) > 0; }

double Levels::pair_digits() const { return std::min(100.0, options_->tolerance / 1e-11); }

double Levels::of_pair(double rounding) const {
  return perturbs() ? pair_digits() / rules::digits_rounded * rounding : 0;
}

bool Levels::can_look_for_rounding(double accuracy, bool missed) const {
  const bool pays =
      traits_->shows_growth && options_->tolerance <= rules::greatest_tolerance_of_growth;
  return pays && (missed || !last(accuracy));
}

double Levels::cheap(double accuracy) const {
  return std::min(rules::error_of_cheap_runs / options_->tolerance * accuracy,
                  rules::coarsest_cheap_accuracy);
}

bool Levels::may_round_too_much(double grown_to) const {
  return grown_to > rules::no_growth && rules::growth_uncertainty * grown_to > options_->tolerance;
}

bool Levels::round_less() {
  if (method() != Method::taylor || options_->method != Method::automatic) return false;
  traits_ = &traits_of(Method::verner98);
  finest_ = traits_->finest;
  return true;
}

/// The accuracy, or the finest at once if a pair would differ by little more than rounding.
double Levels::allowed(double accuracy) const {
  return accuracy > rules::near_rounding ? accuracy : finest_;
}

}  // namespace kreisel::detail
