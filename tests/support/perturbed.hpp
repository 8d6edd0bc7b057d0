#pragma once

#include <cmath>
#include <limits>

namespace kreisel::test {

/// Root mean square deviation of steps perturbed by 10 digits, after 100, 200 ... 1600 seconds. The
/// unit is the length of the random walk at a rate of 1. made(digits) gives steps at their start.
template <class Made>
[[nodiscard]] double perturbed_deviation(const Made& made) {
  constexpr double digits = 10;
  constexpr int times = 16;
  auto unperturbed = made(0.0);
  auto perturbed = made(digits);
  double squares = 0;
  for (int i = 1; i <= times; ++i) {
    const double t = 100 * i;
    const double off = (perturbed.advance_to(t) - unperturbed.advance_to(t)).norm();
    const double steps = unperturbed.effort().steps;
    const double of_a_step = digits * std::numeric_limits<double>::epsilon() * t / steps;
    squares += off * off / (of_a_step * of_a_step * steps);
  }
  return std::sqrt(squares / times);
}

}  // namespace kreisel::test
