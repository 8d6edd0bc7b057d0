#pragma once

#include <algorithm>
#include <cmath>

#include <dynamics/solve/error_measure.hpp>
#include <dynamics/solve/run.hpp>
#include <dynamics/solve/solve_options.hpp>

namespace kreisel::detail {

/// The runs with fixed steps, of gauss16 or splitting; their setting is the step length. `order` is
/// the order of the method.
class FixedRuns {
 public:
  FixedRuns(Method method, int order, double first, double shortest)
      : method_(method), root_(1.0 / order), first_{first}, shortest_(shortest) {}

  [[nodiscard]] Method method() const { return method_; }
  [[nodiscard]] static bool round_less() { return false; }
  [[nodiscard]] static double rounding() { return 2.5; }
  [[nodiscard]] bool begins_near_rounding() const { return method_ == Method::gauss16; }

  [[nodiscard]] EqualLength first() const { return first_; }
  [[nodiscard]] EqualLength finer(const EqualLength& step) const {
    return {step.longest * std::pow(times_finer, -root_), step.longest};
  }
  [[nodiscard]] EqualLength between(const EqualLength& step, double part) const {
    return {step.longest * std::pow(times_finer, -root_ * part), step.longest};
  }

  /// If the shortest steps still have an error, its cause is rounding or an undeclared jump:
  /// neither decreases with the method's order.
  [[nodiscard]] double finer_by(const EqualLength& step) const {
    return last(step) ? 2 : times_finer;
  }

  [[nodiscard]] static bool goes_on(const EqualLength& /*step*/) { return false; }
  [[nodiscard]] static double digits_lost(const EqualLength& /*step*/, double steps) {
    return 0.02 * std::sqrt(steps);
  }
  [[nodiscard]] EqualLength finest() const { return {shortest_}; }
  [[nodiscard]] static bool may_be_rounding(const EqualLength& /*step*/) { return false; }
  [[nodiscard]] static bool shakes() { return false; }
  [[nodiscard]] static double pair_digits() { return 0; }
  [[nodiscard]] static double of_pair(double /*rounding*/) { return 0; }
  [[nodiscard]] static bool can_look_for_rounding(const EqualLength& /*step*/, bool /*missed*/) {
    return false;
  }
  [[nodiscard]] static bool is_fine(const EqualLength& /*step*/) { return true; }
  [[nodiscard]] bool last(const EqualLength& step) const { return step.longest <= shortest_; }
  [[nodiscard]] double falls(const EqualLength& from, const EqualLength& to) const {
    return std::pow(to.longest / from.longest, 1 / root_);
  }
  [[nodiscard]] EqualLength tightened(const EqualLength& step, double ratio) const {
    return {std::max(step.longest * std::clamp(std::pow(ratio, root_), 0.2, 0.9), shortest_)};
  }

 private:
  Method method_;
  double root_;
  EqualLength first_;
  double shortest_;
};

}  // namespace kreisel::detail
