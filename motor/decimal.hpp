#pragma once

#include <cmath>
#include <cstdint>
#include <string_view>

#include <motor/double_double.hpp>

namespace kreisel {

namespace detail {

/// 10^exponent, exponent >= 0.
[[nodiscard]] constexpr DoubleDouble power_of_10(int exponent) {
  DoubleDouble power = 1;
  for (DoubleDouble square = 10; exponent > 0; exponent /= 2, square *= square) {
    if (exponent % 2 == 1) power *= square;
  }
  return power;
}

[[nodiscard]] constexpr bool is_digit(char c) { return c >= '0' && c <= '9'; }

}  // namespace detail

/// The number that a decimal text is, such as -0.25, 3 or 1.5e-3, without a check of its syntax.
///
/// Error  : <= 2^-98 relative from 1e-270 to 1e270, for up to 30 digits  (tests/motor/decimal.cpp)
[[nodiscard]] constexpr DoubleDouble decimal(std::string_view text) {
  DoubleDouble value = 0;
  std::uint64_t digits = 0;  // of at most 15 digits, exact in a double
  int count = 0;
  int exponent = 0;
  bool fraction = false;
  std::size_t i = 0;
  const auto take_digits = [&] {
    value = value * detail::power_of_10(count) + static_cast<double>(digits);
    digits = 0;
    count = 0;
  };
  const bool negative = !text.empty() && text[0] == '-';
  if (!text.empty() && (text[0] == '-' || text[0] == '+')) ++i;
  for (; i < text.size() && (detail::is_digit(text[i]) || text[i] == '.'); ++i) {
    if (text[i] == '.') {
      fraction = true;
      continue;
    }
    digits = 10 * digits + static_cast<std::uint64_t>(text[i] - '0');
    if (++count == 15) take_digits();
    if (fraction) --exponent;
  }
  take_digits();
  if (i < text.size() && (text[i] == 'e' || text[i] == 'E')) {
    const bool down = ++i < text.size() && text[i] == '-';
    if (i < text.size() && (text[i] == '-' || text[i] == '+')) ++i;
    int written = 0;
    for (; i < text.size() && written < 10000; ++i) written = 10 * written + (text[i] - '0');
    exponent += down ? -written : written;
  }
  if (exponent < 0) value /= detail::power_of_10(-exponent);
  if (exponent > 0) value *= detail::power_of_10(exponent);
  return negative ? -value : value;
}

/// A decimal literal with the digits of DoubleDouble, as 0.1_dd.
[[nodiscard]] consteval DoubleDouble operator""_dd(const char* text) { return decimal(text); }

}  // namespace kreisel
