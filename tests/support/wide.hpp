#pragma once

#include <motor/double_double.hpp>

namespace kreisel::test {

/// A coefficient with the digits in which a test forms its sums.
[[nodiscard]] inline long double wide(const DoubleDouble& x) { return static_cast<long double>(x); }

}  // namespace kreisel::test
