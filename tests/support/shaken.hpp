#pragma once

#include <cmath>
#include <limits>

namespace kreisel::test {

/// What steps that are shaken by 10 digits are off by at `end`, in lengths of the random walk that
/// those make where the rate is 1. made(digits) gives steps at their start.
template <class Made>
[[nodiscard]] double shaken_off(const Made& made, double end) {
  constexpr double digits = 10;
  auto calm = made(0.0);
  auto shaken = made(digits);
  const double off = (shaken.advance_to(end) - calm.advance_to(end)).norm();
  const double steps = calm.effort().steps;
  const double of_a_step = digits * std::numeric_limits<double>::epsilon() * end / steps;
  return off / (of_a_step * std::sqrt(steps));
}

}  // namespace kreisel::test
