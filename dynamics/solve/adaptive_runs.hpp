#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include <dynamics/solve/error_measure.hpp>
#include <dynamics/solve/solve_options.hpp>
#include <dynamics/step/accuracy.hpp>

/// Runs as solve() sets them, AdaptiveRuns and FixedRuns (fixed_runs.hpp): each kind has one setting,
/// an accuracy or a step, which can be made finer by ten or thirty times in the error, and
///   method()
///   round_less()           goes over to a method that rounds less, if there is one
///   first()                the setting to begin with
///   finer(x)               of the run beside
///   between(x, part)       of more runs, where rounding is all that is left: other steps than of both
///   tightened(x, ratio)    a setting whose error is `ratio` < 1 of this one's
///   finest(), last(x)      the setting beyond which rounding leaves nothing to gain; whether x is it
///   falls(x, y)            what the error of steps at y is of that at x
///   may_be_rounding(x)     whether what steps at x err by, after others that erred by too much, may be
///                          rounding that has grown
///   is_fine(x)             whether an error that does not fall as the steps do may be rounding
///   begins_near_rounding() whether the first setting errs by little more than rounding
///   shakes()               whether one of a pair is shaken, by pair_digits()
///   of_pair(r)             what it is off by for that, where rounding grows to r
///   can_look_for_rounding(x, missed)  whether RoundingGrowth can tell r
///   rounding()             of one step where nothing grows, in units of 2^-53
///   finer_by(x)            how many times finer that is
///   goes_on(x)             whether the finer run may become the coarser one of the next pair
///   digits_lost(x, n)      what rounding in n steps does to the state, in units of its last digit: a
///                          random walk; 0 where the method errs by more

namespace kreisel::detail {

/// The settings of steps that adapt themselves: an accuracy.
class AdaptiveRuns {
 public:
  /// Of verner98, taylor or radau13.
  explicit AdaptiveRuns(const SolveOptions& options, Method method = Method::verner98)
      : task_(options), method_(method) {}

  [[nodiscard]] Method method() const { return method_; }

  /// Goes over from taylor to verner98, if the method is free; says whether it did. Many
  /// stages average the rounding of the field, and the terms of a series may enlarge it.
  [[nodiscard]] bool round_less() {
    if (method_ != Method::taylor || task_.method != Method::automatic) return false;
    method_ = Method::verner98;
    return true;
  }

  static constexpr double rounding_of_radau = 24;

  /// Of radau13 also where Newton's iterations stop, and of stiff springs. Of verner98 half as much
  /// where nothing but the last digits is asked for; over 1e5 periods to 1e-9 that would be too little.
  [[nodiscard]] double rounding() const {
    const bool last_digits = method_ == Method::verner98 && task_.tolerance <= 1e-13;
    return method_ == Method::radau13 ? rounding_of_radau : last_digits ? 1.25 : 2.5;
  }

  [[nodiscard]] static bool begins_near_rounding() { return false; }

  /// Of taylor finer than of the others: a tenth more of steps, where a second try would double them.
  [[nodiscard]] double first() const {
    const double first = allowed(task_.tolerance / 10);
    return method_ == Method::taylor ? allowed(first / 3) : first;
  }
  [[nodiscard]] double finer(double accuracy) const {
    return std::max(accuracy / beside(), finest() / 4);
  }
  [[nodiscard]] double between(double accuracy, double part) const {
    return accuracy * std::pow(finer(accuracy) / accuracy, part);
  }
  [[nodiscard]] double finer_by(double accuracy) const { return accuracy / finer(accuracy); }
  [[nodiscard]] bool goes_on(double accuracy) const { return finer(accuracy) > near_rounding; }

  /// Longer steps round more.
  [[nodiscard]] double digits_lost(double accuracy, double steps) const {
    const double more = method_ == Method::radau13 ? 4 : method_ == Method::taylor ? 2.5 : 1;
    return accuracy <= 1e-13 ? more * (0.02 * std::sqrt(steps)) : 0;
  }

  /// Beyond which rounding leaves nothing to gain, even over a long way. To go down to 1e-18 costs
  /// taylor a tenth more than 4e-16, and over 1e5 s it errs by up to 200 times less.
  [[nodiscard]] double finest() const {
    return method_ == Method::radau13 ? 4e-16 : method_ == Method::taylor ? 1e-18 : 1e-16;
  }
  [[nodiscard]] bool last(double accuracy) const { return accuracy <= finest(); }

  /// Where steps have to be so much finer than the tolerance, the motion makes much of what they err
  /// by, and as much of rounding. Of radau13 a third run to finer tolerances would tell ten times too
  /// great an error of stiff bearings.
  [[nodiscard]] bool may_be_rounding(double accuracy) const {
    if (method_ == Method::radau13 && digits_off(task_) == 0) return false;
    return accuracy <= 5e-14 && accuracy < task_.tolerance / 50;
  }

  /// The error of coarser steps may fall slower than their accuracy without rounding.
  [[nodiscard]] static bool is_fine(double accuracy) { return accuracy <= 1e-9; }

  [[nodiscard]] static double falls(double from, double to) { return to / from; }
  [[nodiscard]] double tightened(double accuracy, double ratio) const {
    return allowed(accuracy * std::clamp(ratio, 1e-4, 0.2));
  }

  /// Whether pairs are shaken, and by how many digits: more than steps are rounded, so that two runs
  /// hardly ever agree by chance where rounding grows to the tolerance; and so few that it does not
  /// count where nothing grows.
  [[nodiscard]] bool shakes() const { return method_ != Method::radau13 && digits_off(task_) > 0; }
  [[nodiscard]] double pair_digits() const { return std::min(100.0, task_.tolerance / 1e-11); }

  /// True if three more runs, two of them shaken, can tell how far rounding grows. They err by some
  /// 1e-2, so that they cost little and take about the same way. Who asks for less than 1e-7 would pay
  /// most, and is hardly ever led astray.
  [[nodiscard]] bool can_look_for_rounding(double accuracy, bool missed) const {
    const bool pays = method_ != Method::radau13 && task_.tolerance <= 1e-7;
    return pays && (missed || !last(accuracy));
  }
  [[nodiscard]] double cheap(double accuracy) const {
    return std::min(1e-2 / task_.tolerance * accuracy, 1e-3);
  }

  /// By far more digits than steps are rounded, and far less than they err by.
  static constexpr double shaken_digits = 1000;

  /// What rounding, which makes a step wrong by 0.2 to 0.7 digits, grows to, of what those grow to; and
  /// what a pair that is shaken is off by, of what rounding grows to.
  [[nodiscard]] static double rounding_of(double off) {
    return rounding_digits / shaken_digits * off;
  }
  [[nodiscard]] double of_pair(double rounding) const {
    return pair_digits() / rounding_digits * rounding;
  }

  /// Whether that says too little of it: both are random, and one may be so many times the other.
  [[nodiscard]] bool may_round_too_much(double grown_to) const {
    constexpr double not_at_all = 1e-13;
    return grown_to > not_at_all && 12 * grown_to > task_.tolerance;
  }

 private:
  static constexpr double rounding_digits = 0.5;

  static constexpr double near_rounding = 4e-16;

  /// Of an explicit method of order 9 ten times, for 1.29 times the steps. What the coarser errs by is
  /// 10/9 of what the two are apart, times 0.84 to 1.23 in 95 % of 835 runs at 1e-6 to 1e-2, and 0.94
  /// to 1.07 at finer ones.
  [[nodiscard]] double beside() const { return method_ == Method::verner98 ? 10 : times_finer; }

  /// Where a pair of runs would differ by little more than rounding, the finest is taken at once.
  [[nodiscard]] double allowed(double accuracy) const {
    return accuracy > near_rounding ? accuracy : finest();
  }

  const SolveOptions& task_;
  Method method_;
};

/// The cheap steps that tell what rounding grows to, from one try to the next.
///
/// Coarse steps that stability keeps short go ways of their own when shaken, and that is no growth:
/// where rounding seems to grow too much finer ones are asked, as long as those find much less.
class CheapSteps {
 public:
  /// Their accuracy beside runs at `setting`; it does not become coarser again.
  [[nodiscard]] double beside(const AdaptiveRuns& runs, double setting) {
    accuracy_ = std::min(accuracy_, runs.cheap(setting));
    return accuracy_;
  }

  /// Makes them finer where rounding seems to grow to `suspected`; says whether that may find less.
  [[nodiscard]] bool refine(double suspected, double setting) {
    const bool falls = suspected_ == 0 || suspected < suspected_ / 100;
    if (!falls || accuracy_ <= setting) return false;
    accuracy_ = std::max(accuracy_ * 1e-3, setting);
    suspected_ = suspected;
    return true;
  }

  template <class Checkpoint>
  void pass(Checkpoint& checkpoint) {
    checkpoint(accuracy_, suspected_);
  }

 private:
  double accuracy_ = std::numeric_limits<double>::max();
  double suspected_ = 0;  ///< by coarser ones
};

}  // namespace kreisel::detail
