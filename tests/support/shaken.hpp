#pragma once

#include <cmath>
#include <limits>

namespace kreisel::test {

/// Root mean square deviation of steps perturbed by 10 digits, after 100, 200 ... 1600 seconds. The
/// unit is the length of the random walk at a rate of 1. made(digits) gives steps at their start.
template <class Made>
[[nodiscard]] double shaken_off(const Made& made) {
  constexpr double digits = 10;
  constexpr int times = 16;
  auto calm = made(0.0);
  auto shaken = made(digits);
  double squares = 0;
  for (int i = 1; i <= times; ++i) {
    const double t = 100 * i;
    const double off = (shaken.advance_to(t) - calm.advance_to(t)).norm();
    const double steps = calm.effort().steps;
    const double of_a_step = digits * std::numeric_limits<double>::epsilon() * t / steps;
    squares += off * off / (of_a_step * of_a_step * steps);
  }
  return std::sqrt(squares / times);
}

}  // namespace kreisel::test
