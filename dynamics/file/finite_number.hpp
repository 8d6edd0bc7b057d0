#pragma once

#include <cmath>
#include <cstdlib>
#include <string>
#include <type_traits>

#include <dynamics/file/printable.hpp>
#include <motor/error.hpp>

namespace kreisel {

/// The number that a text is. `what` names it in the message.
///
/// Throws : InvalidInput unless the whole text is a finite number
template <class Real = double>
[[nodiscard]] Real finite_number(const std::string& what, const std::string& text) {
  char* end = nullptr;
  Real value = 0;
  if constexpr (std::is_same_v<Real, long double>) {
    value = std::strtold(text.c_str(), &end);
  } else {
    value = std::strtod(text.c_str(), &end);
  }
  if (text.empty() || end != text.c_str() + text.size() || !std::isfinite(value)) {
    throw InvalidInput(printable(what) + " = '" + printable(text, 100) +
                       "' is not a finite number");
  }
  return value;
}

}  // namespace kreisel
