#pragma once

#include <cstddef>

namespace kreisel::detail {

/// The first try with too great an error, and the error of later tries at the same output.
///
/// Setting : the setting of the runs (adaptive_runs.hpp)
template <class Setting>
struct Missed {
  Setting setting;
  std::size_t output = 0;
  double error = 0;  ///< 0 if there is none
  double now = 0;

  void note(std::size_t done, double error_there) {
    if (done <= output) now = error_there;
  }

  /// True if the error at finer steps is more than ten times the expected one. It is then rounding,
  /// which even finer steps do not reduce. An error as great as the motion proves nothing.
  template <class Runs>
  [[nodiscard]] bool stays(const Runs& runs, const Setting& at) const {
    return error > 0 && now < 0.1 && now > 10 * error * runs.falls(setting, at);
  }

  /// True if the error at finer steps is less than a tenth of the expected one. It was rounding
  /// then, and two runs agree by chance.
  template <class Runs>
  [[nodiscard]] bool falls_by_chance(const Runs& runs, const Setting& at) const {
    return error > 0 && now < 0.1 * error * runs.falls(setting, at);
  }

  template <class Checkpoint>
  void pass(Checkpoint& checkpoint) {
    checkpoint(setting, output, error, now);
  }
};

}  // namespace kreisel::detail
