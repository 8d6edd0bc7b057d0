#pragma once

#include <algorithm>
#include <cmath>

#include <dynamics/solve/error_measure.hpp>
#include <dynamics/solve/task.hpp>
#include <dynamics/step/accuracy.hpp>

namespace kreisel::detail {

/// The settings of steps that adapt themselves: an accuracy.
class AdaptiveRuns {
 public:
  static constexpr bool begins_near_rounding = false;

  /// Ten times finer for 1.29 times the steps of an explicit method of order 9. What the coarser errs
  /// by is 10/9 of what the two are apart, times 0.84 to 1.23 in 95 % of 835 runs at 1e-6 to 1e-2, and
  /// 0.94 to 1.07 at finer ones.
  ///
  /// finest : beyond which rounding leaves nothing to gain, even over a long way
  explicit AdaptiveRuns(const Task& task, double finer_by = 10, double finest = 1e-16)
      : task_(task), finer_by_(finer_by), finest_(finest) {}

  [[nodiscard]] double first() const { return allowed(task_.tolerance / 10); }
  [[nodiscard]] double finer(double accuracy) const {
    return std::max(accuracy / finer_by_, finest() / 4);
  }
  [[nodiscard]] double between(double accuracy, double part) const {
    return accuracy * std::pow(finer(accuracy) / accuracy, part);
  }
  [[nodiscard]] double finer_by(double accuracy) const { return accuracy / finer(accuracy); }
  [[nodiscard]] bool goes_on(double accuracy) const { return finer(accuracy) > near_rounding; }
  [[nodiscard]] static double digits_lost(double accuracy, double steps) {
    return accuracy <= 1e-13 ? 0.02 * std::sqrt(steps) : 0;
  }
  [[nodiscard]] double finest() const { return finest_; }
  [[nodiscard]] bool last(double accuracy) const { return accuracy <= finest(); }

  /// Where steps have to be so much finer than the tolerance, the motion makes much of what they err
  /// by, and as much of rounding.
  [[nodiscard]] bool may_be_rounding(double accuracy) const {
    return accuracy <= 5e-14 && accuracy < task_.tolerance / 50;
  }

  [[nodiscard]] static double falls(double from, double to) { return to / from; }
  [[nodiscard]] double tightened(double accuracy, double ratio) const {
    return allowed(accuracy * std::clamp(ratio, 1e-4, 0.2));
  }

  [[nodiscard]] Accuracy accuracy(double relative) const {
    return {relative, task_.smallest, task_.most_evaluations};
  }

 protected:
  [[nodiscard]] const Task& task() const { return task_; }

  /// Where a pair of runs would differ by little more than rounding, the finest is taken at once.
  [[nodiscard]] double allowed(double accuracy) const {
    return accuracy > near_rounding ? accuracy : finest();
  }

 private:
  static constexpr double near_rounding = 4e-16;

  const Task& task_;
  double finer_by_;
  double finest_;
};

}  // namespace kreisel::detail
