#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

namespace kreisel::detail {

/// True if two times differ by no more than the rounding of a multiple of a step. The steps began
/// at a time of the given size.
template <class S>
[[nodiscard]] bool is_same_time(const S& a, const S& b, const S& size = S(0)) {
  using std::abs;
  const S scale = std::max({S(abs(a)), S(abs(b)), size});
  return abs(a - b) <= S(4) * std::numeric_limits<S>::epsilon() * scale;
}

}  // namespace kreisel::detail
