#pragma once

#include <cstddef>

namespace kreisel::detail {

/// The first try that erred by too much, and what has become of its error at that output since.
///
/// Setting : of the steps, as the kinds of runs have it (runs.hpp)
template <class Setting>
struct Missed {
  Setting setting;
  std::size_t output = 0;
  double error = 0;  ///< 0 if there is none
  double now = 0;

  void note(std::size_t done, double error_there) {
    if (done <= output) now = error_there;
  }

  /// Whether finer steps err by much more than their share of it: then by rounding, of which even
  /// finer ones make no less. An error as great as the motion tells nothing.
  template <class Runs>
  [[nodiscard]] bool stays(const Runs& runs, const Setting& at) const {
    return error > 0 && now < 0.1 && now > 10 * error * runs.falls(setting, at);
  }

  /// Whether they seem to err by much less: then it was rounding too, and two runs agree by chance.
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
