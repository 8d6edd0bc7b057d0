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
  explicit AdaptiveRuns(const Task& task, double finer_by = 10)
      : task_(task), finer_by_(finer_by) {}

  [[nodiscard]] double first() const { return std::max(task_.tolerance / 10, finest()); }
  [[nodiscard]] double finer(double accuracy) const {
    return std::max(accuracy / finer_by_, least);
  }
  [[nodiscard]] double between(double accuracy, double part) const {
    return accuracy * std::pow(finer(accuracy) / accuracy, part);
  }
  [[nodiscard]] double finer_by(double accuracy) const { return accuracy / finer(accuracy); }
  [[nodiscard]] bool goes_on(double accuracy) const { return finer(accuracy) > finest(); }
  [[nodiscard]] static double digits_lost(double accuracy, double steps) {
    return accuracy <= 1e-13 ? 0.08 * std::sqrt(steps) : 0;
  }
  [[nodiscard]] static double finest() { return 4 * least; }
  [[nodiscard]] static bool last(double accuracy) { return accuracy <= finest(); }
  [[nodiscard]] static double falls(double from, double to) { return to / from; }
  [[nodiscard]] static double tightened(double accuracy, double ratio) {
    return std::max(accuracy * std::clamp(ratio, 1e-4, 0.2), finest());
  }

  [[nodiscard]] Accuracy accuracy(double relative) const {
    return {relative, task_.smallest, task_.most_evaluations};
  }

 protected:
  [[nodiscard]] const Task& task() const { return task_; }

 private:
  static constexpr double least = 1e-16;

  const Task& task_;
  double finer_by_;
};

}  // namespace kreisel::detail
