#pragma once

#include <cmath>
#include <cstdlib>
#include <string>
#include <type_traits>

#include <dynamics/file/printable.hpp>
#include <motor/decimal.hpp>
#include <motor/error.hpp>

namespace kreisel {

/// The number that a text is, in double or DoubleDouble. `what` names it in the message.
///
/// Throws : InvalidInput unless the whole text is a finite number
template <class Real = double>
[[nodiscard]] Real finite_number(const std::string& what, const std::string& text) {
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  if (text.empty() || end != text.c_str() + text.size() || !std::isfinite(value)) {
    throw InvalidInput(printable(what) + " = '" + printable(text, 100) +
                       "' is not a finite number");
  }
  if constexpr (std::is_same_v<Real, DoubleDouble>) {
    // Beyond these sizes, and for hexadecimal digits, the digits of double.
    const bool middle = std::abs(value) > 1e-270 && std::abs(value) < 1e270;
    const bool is_decimal = text.find_first_not_of("+-.0123456789eE") == std::string::npos;
    const DoubleDouble exact = middle && is_decimal ? decimal(text) : DoubleDouble(value);
    if (std::isfinite(exact.hi)) return exact;
  }
  return value;
}

}  // namespace kreisel
