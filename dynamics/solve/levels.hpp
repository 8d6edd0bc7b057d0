#pragma once

#include <dynamics/solve/error_rules.hpp>
#include <dynamics/solve/solve_options.hpp>
#include <motor/api.hpp>

namespace kreisel::detail {

/// The runs of a method: their order, their finest accuracy, and their rounding.
struct MethodTraits {
  Method method;
  int order;                     ///< of equal steps; 0 for steps that adapt
  double finer_by;               ///< ratio of the accuracies of a pair
  double first_below_tolerance;  ///< tolerance over the first accuracy
  double finest;                 ///< accuracy
  double rounding;               ///< of one step, in units of 2^-53
  double digits_lost;            ///< relative to verner98, as digits_per_root_of_steps
  bool shows_growth;             ///< perturbed runs show the growth of rounding
  bool starts_near_rounding;     ///< the first error is little more than rounding
  bool has_checkpoints;
};

/// The row of a method that takes steps.
KREISEL_API [[nodiscard]] const MethodTraits& traits_of(Method method);

/// The lengths of equal steps.
struct StepLengths {
  double first;
  double shortest;
};

/// The accuracies at which one method runs. The global error is proportional to the accuracy. For
/// steps that adapt it bounds the error of one step. For equal steps of order p it is
/// (length / first length)^p.
class KREISEL_API Levels {
 public:
  /// For verner98, taylor or radau13.
  explicit Levels(const SolveOptions& options, Method method = Method::verner98);

  /// For equal steps.
  Levels(const SolveOptions& options, Method method, const StepLengths& lengths);

  [[nodiscard]] Method method() const { return traits_->method; }
  [[nodiscard]] bool adapts() const { return traits_->order == 0; }
  [[nodiscard]] const MethodTraits& traits() const { return *traits_; }

  [[nodiscard]] double first() const;
  [[nodiscard]] double finest() const { return finest_; }
  /// True if rounding leaves nothing to gain beyond this accuracy.
  [[nodiscard]] bool last(double accuracy) const { return accuracy <= finest_; }
  /// The accuracy of the finer run beside a run, and how much finer it is.
  [[nodiscard]] double finer(double accuracy) const;
  [[nodiscard]] double finer_by(double accuracy) const;
  /// An accuracy between both, for further runs whose steps differ from those of both.
  [[nodiscard]] double between(double accuracy, double part) const;
  /// The accuracy whose error is `ratio` < 1 times as great, within bounds.
  [[nodiscard]] double tightened(double accuracy, double ratio) const;
  /// True if the finer run may become the coarser one of the next pair.
  [[nodiscard]] bool goes_on(double accuracy) const;
  /// True if the error follows the order of the method. If it does not, it may be rounding.
  [[nodiscard]] bool follows_its_order(double accuracy) const;
  /// True if an error above the tolerance may be amplified rounding. Steps much finer than the
  /// tolerance that still miss it are amplified by the motion, and rounding as much.
  [[nodiscard]] bool may_be_rounding(double accuracy) const;

  /// The length of an equal step.
  [[nodiscard]] double length(double accuracy) const;

  /// The rounding error of a step without growth, in units of 2^-53.
  [[nodiscard]] double rounding() const;
  /// The effect of rounding in n steps on the state, in last digits: a random walk. 0 where the error
  /// of the method is greater.
  [[nodiscard]] double digits_lost(double accuracy, double steps) const;

  /// True if one run of a pair is perturbed by pair_digits() a step. They exceed the rounding of
  /// steps: two runs then hardly ever agree by chance where rounding grows to the tolerance. Where
  /// nothing grows they have no effect.
  [[nodiscard]] bool perturbs() const;
  [[nodiscard]] double pair_digits() const;
  /// The difference to which pair_digits() grow, from what rounding grows to.
  [[nodiscard]] double of_pair(double rounding) const;

  /// True if RoundingGrowth can estimate the growth of rounding. `missed`: after a try whose error was
  /// too great.
  [[nodiscard]] bool can_look_for_rounding(double accuracy, bool missed) const;
  /// The accuracy of its runs.
  [[nodiscard]] double cheap(double accuracy) const;
  /// The amplified rounding, from the difference to which perturbed_digits have grown.
  [[nodiscard]] static double rounding_of(double off) {
    return rules::digits_rounded / rules::perturbed_digits * off;
  }
  /// True if rounding that is estimated to grow so far may exceed the tolerance.
  [[nodiscard]] bool may_round_too_much(double grown_to) const;

  /// Changes from taylor to verner98 if the choice of the method is free; true if it changed. Many
  /// stages average the rounding of the field; the terms of a series may amplify it.
  [[nodiscard]] bool round_less();

 private:
  [[nodiscard]] double allowed(double accuracy) const;

  const SolveOptions* options_;
  const MethodTraits* traits_;
  double finest_;
  double first_length_ = 0;
};

}  // namespace kreisel::detail
