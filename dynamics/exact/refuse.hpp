#pragma once

#include <cmath>
#include <sstream>

#include <motor/error.hpp>

namespace kreisel::exact::detail {

/// Throws : InvalidInput "key = value rule"
[[noreturn]] inline void refuse(const char* key, double value, const char* rule) {
  std::ostringstream text;
  text.precision(17);
  text << key << " = " << value << ' ' << rule;
  throw InvalidInput(text.str());
}

inline void require_finite(const char* key, double value) {
  if (!std::isfinite(value)) refuse(key, value, "must be finite");
}

inline void require_positive(const char* key, double value) {
  if (!(value > 0 && std::isfinite(value))) refuse(key, value, "must be a finite number above 0");
}

}  // namespace kreisel::exact::detail
