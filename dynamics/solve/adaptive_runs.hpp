#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include <dynamics/solve/error_measure.hpp>
#include <dynamics/solve/solve_options.hpp>
#include <dynamics/step/accuracy.hpp>

/// The two kinds of runs of solve() are AdaptiveRuns and FixedRuns (fixed_runs.hpp). A run has one
/// setting, an accuracy or a step length. The finer run of a pair has a setting with ten or thirty
/// times less error. Both kinds have these members:
///
///   method()               current method
///   round_less()           changes to a method with less rounding, if there is one
///   first()                first setting
///   finer(x)               setting of the finer run beside a run with x
///   tightened(x, ratio)    setting whose error is `ratio` < 1 times the error at x
///   between(x, part)       settings of additional runs where only rounding is left: their steps
///                          differ from the steps of both runs
///   finest(), last(x)      setting beyond which rounding leaves nothing to gain; true if x is it
///   falls(x, y)            expected error at y over error at x
///   may_be_rounding(x)     true if the error at x may be amplified rounding, after a setting with
///                          too great an error
///   is_fine(x)             true if an error that does not decrease with the steps may be rounding
///   begins_near_rounding() true if the error of the first setting is little more than rounding
///   shakes()               true if one run of a pair is perturbed, by pair_digits()
///   of_pair(r)             effect of this perturbation where rounding grows to r
///   can_look_for_rounding(x, missed)  true if RoundingGrowth can estimate r
///   rounding()             rounding error of one step without growth, in units of 2^-53
///   finer_by(x)            factor by which finer(x) is finer than x
///   goes_on(x)             true if the finer run may become the coarser one of the next pair
///   digits_lost(x, n)      effect of rounding in n steps on the state, in units of its last digit:
///                          a random walk; 0 where the error of the method is greater

namespace kreisel::detail {

/// The runs with adaptive steps; their setting is an accuracy.
class AdaptiveRuns {
 public:
  /// `method` is verner98, taylor or radau13.
  explicit AdaptiveRuns(const SolveOptions& options, Method method = Method::verner98)
      : task_(options), method_(method) {}

  [[nodiscard]] Method method() const { return method_; }

  /// Changes from taylor to verner98 if the choice of the method is free; true if it changed. Many
  /// stages average the rounding of the field; the terms of a series may amplify it.
  [[nodiscard]] bool round_less() {
    if (method_ != Method::taylor || task_.method != Method::automatic) return false;
    method_ = Method::verner98;
    return true;
  }

  static constexpr double rounding_of_radau = 24;

  /// The rounding error of a step, for radau13 with the end of Newton's iterations and stiff
  /// springs. For verner98 it is halved at tolerances of 1e-13 and finer; over 1e5 periods at 1e-9
  /// half would be too little.
  [[nodiscard]] double rounding() const {
    const bool last_digits = method_ == Method::verner98 && task_.tolerance <= 1e-13;
    return method_ == Method::radau13 ? rounding_of_radau : last_digits ? 1.25 : 2.5;
  }

  [[nodiscard]] static bool begins_near_rounding() { return false; }

  /// The first accuracy is finer for taylor: this costs a tenth more steps, while a second try
  /// would double them.
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

  /// The accuracy beyond which rounding leaves nothing to gain, even in a long run. For taylor
  /// 1e-18 costs a tenth more than 4e-16, and its error over 1e5 s is up to 200 times smaller.
  [[nodiscard]] double finest() const {
    return method_ == Method::radau13 ? 4e-16 : method_ == Method::taylor ? 1e-18 : 1e-16;
  }
  [[nodiscard]] bool last(double accuracy) const { return accuracy <= finest(); }

  /// If steps have to be so much finer than the tolerance, the motion amplifies their errors, and
  /// rounding as much. With radau13 at finer tolerances a third run would estimate ten times too
  /// great an error for stiff bearings.
  [[nodiscard]] bool may_be_rounding(double accuracy) const {
    if (method_ == Method::radau13 && digits_off(task_) == 0) return false;
    return accuracy <= 5e-14 && accuracy < task_.tolerance / 50;
  }

  /// The error of coarser steps may decrease more slowly than their accuracy, without rounding.
  [[nodiscard]] static bool is_fine(double accuracy) { return accuracy <= 1e-9; }

  [[nodiscard]] static double falls(double from, double to) { return to / from; }
  [[nodiscard]] double tightened(double accuracy, double ratio) const {
    return allowed(accuracy * std::clamp(ratio, 1e-4, 0.2));
  }

  /// True if one run of a pair is perturbed; pair_digits() is the size. It exceeds the rounding of
  /// steps, so that two runs hardly ever agree by chance where rounding grows to the tolerance. It
  /// is small enough to have no effect where nothing grows.
  [[nodiscard]] bool shakes() const { return method_ != Method::radau13 && digits_off(task_) > 0; }
  [[nodiscard]] double pair_digits() const { return std::min(100.0, task_.tolerance / 1e-11); }

  /// True if three more runs, two of them perturbed, can estimate how far rounding grows. Their
  /// errors are some 1e-2, so they cost little and take about the same path. At tolerances above
  /// 1e-7 they would cost most, and the error estimate is hardly ever wrong without them.
  [[nodiscard]] bool can_look_for_rounding(double accuracy, bool missed) const {
    const bool pays = method_ != Method::radau13 && task_.tolerance <= 1e-7;
    return pays && (missed || !last(accuracy));
  }
  [[nodiscard]] double cheap(double accuracy) const {
    return std::min(1e-2 / task_.tolerance * accuracy, 1e-3);
  }

  /// A perturbation in last digits, far above the rounding of steps and far below their error.
  static constexpr double shaken_digits = 1000;

  /// The amplified rounding, from the difference `off` to which shaken_digits have grown. Rounding
  /// changes a step by 0.2 to 0.7 digits.
  [[nodiscard]] static double rounding_of(double off) {
    return rounding_digits / shaken_digits * off;
  }
  /// The difference to which pair_digits() grow, from what rounding grows to.
  [[nodiscard]] double of_pair(double rounding) const {
    return pair_digits() / rounding_digits * rounding;
  }

  /// True if rounding may exceed the tolerance. The estimate and rounding are both random: one may
  /// be 12 times the other.
  [[nodiscard]] bool may_round_too_much(double grown_to) const {
    constexpr double not_at_all = 1e-13;
    return grown_to > not_at_all && 12 * grown_to > task_.tolerance;
  }

 private:
  static constexpr double rounding_digits = 0.5;

  static constexpr double near_rounding = 4e-16;

  /// The ratio of the accuracies of a pair. For an explicit method of order 9 it is ten, at 1.29
  /// times the steps. The coarser run's error is 10/9 of the difference, times 0.84 to 1.23 in 95 %
  /// of 835 runs at 1e-6 to 1e-2, and 0.94 to 1.07 at finer ones.
  [[nodiscard]] double beside() const { return method_ == Method::verner98 ? 10 : times_finer; }

  /// The accuracy, or the finest at once if a pair of runs would differ by little more than
  /// rounding.
  [[nodiscard]] double allowed(double accuracy) const {
    return accuracy > near_rounding ? accuracy : finest();
  }

  const SolveOptions& task_;
  Method method_;
};

/// The accuracy of the cheap runs that estimate the growth of rounding, from one try to the next.
///
/// Coarse steps limited by stability diverge when perturbed, without any growth of rounding. If
/// rounding seems to grow too much, finer steps are tried, as long as they find much less.
class CheapSteps {
 public:
  /// The accuracy beside runs at `setting`; it never becomes coarser again.
  [[nodiscard]] double beside(const AdaptiveRuns& runs, double setting) {
    accuracy_ = std::min(accuracy_, runs.cheap(setting));
    return accuracy_;
  }

  /// Makes the steps finer if rounding seems to grow to `suspected`; true if finer steps may find
  /// less.
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
  double suspected_ = 0;  ///< by coarser steps
};

}  // namespace kreisel::detail
