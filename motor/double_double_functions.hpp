#pragma once

#include <Eigen/Core>

#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <ostream>
#include <utility>

#include <motor/double_double.hpp>

/// Functions of DoubleDouble, under the names of the standard library, for code that is written on
/// a number type and for Eigen.
///
/// Error : <= 2^-74 relative, of sine and cosine besides 2^-105 of the angle, of log 2^-74
///         absolute where it is below 1. std::numeric_limits states these digits, not the 106 of
///         the operations                               (tests/motor/double_double.cpp)

template <>
struct std::numeric_limits<kreisel::DoubleDouble> : std::numeric_limits<double> {
  static constexpr int digits = 73;
  static constexpr int digits10 = 21;
  static constexpr int max_digits10 = 23;
  static constexpr bool is_iec559 = false;
  static constexpr kreisel::DoubleDouble epsilon() { return 0x1p-72; }
  static constexpr kreisel::DoubleDouble min() { return std::numeric_limits<double>::min(); }
  static constexpr kreisel::DoubleDouble max() { return 0x1p990; }  // its products have errors
  static constexpr kreisel::DoubleDouble lowest() { return -0x1p990; }
  static constexpr kreisel::DoubleDouble infinity() {
    return std::numeric_limits<double>::infinity();
  }
  static constexpr kreisel::DoubleDouble quiet_NaN() {
    return std::numeric_limits<double>::quiet_NaN();
  }
};

template <>
inline constexpr kreisel::DoubleDouble std::numbers::pi_v<kreisel::DoubleDouble>{
    kreisel::detail::WithError{0x1.921fb54442d18p+1, 0x1.1a62633145c07p-53}};

namespace kreisel {

[[nodiscard]] constexpr DoubleDouble abs(const DoubleDouble& x) { return x.hi < 0 ? -x : x; }
[[nodiscard]] constexpr DoubleDouble fabs(const DoubleDouble& x) { return abs(x); }

/// x times a power of 2, which is exact.
[[nodiscard, gnu::always_inline]] constexpr DoubleDouble scaled(const DoubleDouble& x,
                                                                double power) {
  DoubleDouble result = x;
  result.hi *= power;
  result.lo *= power;
  return result;
}

[[nodiscard]] inline bool isfinite(const DoubleDouble& x) { return std::isfinite(x.hi); }
[[nodiscard]] inline bool isnan(const DoubleDouble& x) { return std::isnan(x.hi); }
[[nodiscard]] inline bool isinf(const DoubleDouble& x) { return std::isinf(x.hi); }
[[nodiscard]] inline bool signbit(const DoubleDouble& x) { return std::signbit(x.hi); }

[[nodiscard]] inline DoubleDouble copysign(const DoubleDouble& x, const DoubleDouble& sign) {
  return std::signbit(x.hi) == std::signbit(sign.hi) ? x : -x;
}

[[nodiscard, gnu::always_inline]] inline DoubleDouble sqrt(const DoubleDouble& x) {
  const double root = std::sqrt(x.hi);
  if (!(root > 0)) return root;
  const double rest = (x - DoubleDouble(detail::exact_product(root, root))).hi;
  return DoubleDouble(detail::exact_sum_of_ordered(root, rest * (0.5 / root)));
}

[[nodiscard]] inline DoubleDouble hypot(const DoubleDouble& x, const DoubleDouble& y) {
  const double size = std::max(std::abs(x.hi), std::abs(y.hi));
  if (!(size > 0) || std::isinf(size)) return size + (x.hi + y.hi);
  int exponent = 0;
  std::frexp(size, &exponent);
  exponent = std::max(exponent, -1000);
  const double down = std::ldexp(1.0, -exponent);
  const DoubleDouble a = scaled(x, down);
  const DoubleDouble b = scaled(y, down);
  return scaled(sqrt(a * a + b * b), std::ldexp(1.0, exponent));
}

/// The greatest integer that is not above x.
[[nodiscard]] inline DoubleDouble floor(const DoubleDouble& x) {
  const double whole = std::floor(x.hi);
  if (whole != x.hi) return whole;
  return DoubleDouble(detail::exact_sum_of_ordered(whole, std::floor(x.lo)));
}
[[nodiscard]] inline DoubleDouble ceil(const DoubleDouble& x) { return -floor(-x); }
[[nodiscard]] inline DoubleDouble trunc(const DoubleDouble& x) {
  return x.hi < 0 ? ceil(x) : floor(x);
}
/// The nearest integer; halves away from 0.
[[nodiscard]] inline DoubleDouble round(const DoubleDouble& x) {
  return x.hi < 0 ? ceil(x - 0.5) : floor(x + 0.5);
}

namespace detail {

/// Sine and cosine of one angle.
struct WideSineCosine {
  DoubleDouble sine;
  DoubleDouble cosine;
};

/// Sine and cosine of sixteenths, 0 to 13/16.
inline constexpr std::array<WideSineCosine, 14> sixteenths = [] {
  constexpr double digits[14][4] = {
      {0x0.0p+0, 0x0.0p+0, 0x1p+0, 0x0.0p+0},
      {0x1.ffaaaeeed4edbp-5, -0x1.2d16d32684b69p-59, 0x1.ff0015549f4d3p-1, 0x1.328387b99426fp-55},
      {0x1.feaaeee86ee36p-4, -0x1.afcb2bcc6f03bp-59, 0x1.fc015527d5bd3p-1, 0x1.b68f35094efb8p-55},
      {0x1.7dc102fbaf2b5p-3, 0x1.5ab50e23c97c3p-59, 0x1.f706bdf9ece1cp-1, -0x1.698c80c36dcb4p-55},
      {0x1.faaeed4f31577p-3, -0x1.15d88508e32b8p-57, 0x1.f01549f7deea1p-1, 0x1.d3c1e99e5cafdp-55},
      {0x1.3ad129769d3d8p-2, 0x1.03d550487839ap-63, 0x1.e733ea0193d40p-1, -0x1.6428b3546ce13p-55},
      {0x1.7710255764214p-2, -0x1.6ead7314bb6cep-57, 0x1.dc6b7eb995912p-1, 0x1.4b364776dcd35p-58},
      {0x1.b1d8305321617p-2, -0x1.ae242cb99f519p-56, 0x1.cfc6cfa52ad9fp-1, 0x1.8b5b5508f2a0dp-55},
      {0x1.eaee8744b05f0p-2, -0x1.789b43c9b027dp-58, 0x1.c1528065b7d50p-1, -0x1.892111312e828p-55},
      {0x1.110d0c4b69c3bp-1, 0x1.d918998809981p-55, 0x1.b11d04162a4c6p-1, 0x1.1dd561efbc0c2p-56},
      {0x1.2b91dea88421ep-1, -0x1.fa371db216ab0p-55, 0x1.9f368ed912f85p-1, -0x1.1d200c5791606p-55},
      {0x1.44eb381cf386bp-1, -0x1.3ed6c1e6a5505p-55, 0x1.8bb105a5dc900p-1, 0x1.863e03e9474c1p-55},
      {0x1.5cffc16bf8f0dp-1, 0x1.96cb370eb578ap-55, 0x1.769fec655211fp-1, -0x1.827d5cf8c68c5p-57},
      {0x1.73b7680dea578p-1, -0x1.2248306dc12a2p-56, 0x1.6018526f563dfp-1, 0x1.46ca5e0e432d0p-55},
  };
  std::array<WideSineCosine, 14> all;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const auto& [s, s_rest, c, c_rest] = digits[i];
    all[i] = {DoubleDouble(WithError{s, s_rest}), DoubleDouble(WithError{c, c_rest})};
  }
  return all;
}();

/// As sine_cosine(), for |x| <= 0.8: by the nearest sixteenth and the series of the rest.
[[nodiscard]] inline WideSineCosine sine_cosine_near_0(const DoubleDouble& x) {
  const double nearest = std::nearbyint(16 * std::abs(x.hi));
  const DoubleDouble t = (x.hi < 0 ? -x : x) - nearest / 16;
  const DoubleDouble z = t * t;
  const double y = z.hi;
  constexpr DoubleDouble sixth = DoubleDouble(1) / 6;
  const double late_sine =
      y * y * (1 / 120.0 - y * (1 / 5040.0 - y * (1 / 362880.0 - y / 39916800.0)));
  const double late_cosine =
      y * y * (1 / 24.0 - y * (1 / 720.0 - y * (1 / 40320.0 - y / 3628800.0)));
  const DoubleDouble sine = t + t * (late_sine - sixth * z);
  const DoubleDouble less = late_cosine - 0.5 * z;  // cos t - 1
  const auto& [s, c] = sixteenths[static_cast<std::size_t>(nearest)];
  const DoubleDouble sum = s + (s * less + c * sine);
  return {x.hi < 0 ? -sum : sum, c + (c * less - s * sine)};
}

/// The rest of x after the nearest multiple of pi/2, and that multiple.
struct QuarterTurns {
  DoubleDouble rest;
  double count;
};
[[nodiscard]] inline QuarterTurns quarter_turns(const DoubleDouble& x) {
  constexpr double pi_2[] = {0x1.921fb54442d18p+0, 0x1.1a62633145c07p-54, -0x1.f1976b7ed8fbcp-110};
  const double count = std::nearbyint(x.hi / pi_2[0]);
  if (count == 0) return {x, 0};
  const DoubleDouble rest = x - DoubleDouble(exact_product(count, pi_2[0]));
  return {rest - DoubleDouble(exact_product(count, pi_2[1])) - count * pi_2[2], count};
}

/// Sine and cosine of x, together in the time of one of them.
[[nodiscard]] inline WideSineCosine sine_cosine(const DoubleDouble& x) {
  if (!(std::abs(x.hi) < 0x1p52)) {
    // An angle whose last digit is above 1 rad, infinite or NaN.
    return {std::sin(x.hi), std::cos(x.hi)};
  }
  const auto [rest, count] = quarter_turns(x);
  const auto [s, c] = sine_cosine_near_0(rest);
  switch (static_cast<long long>(count) & 3) {
    case 0: return {s, c};
    case 1: return {c, -s};
    case 2: return {-s, -c};
    default: return {-c, s};
  }
}

/// exp(x) - 1 for |x| <= 0.35: the series of x/256, doubled eight times.
[[nodiscard]] inline DoubleDouble exp_less_1_near_0(const DoubleDouble& x) {
  const DoubleDouble t = x / 256;
  constexpr DoubleDouble sixth = DoubleDouble(1) / 6;
  const double late =
      t.hi * t.hi * t.hi * (1 / 24.0 + t.hi * (1 / 120.0 + t.hi * (1 / 720.0 + t.hi / 5040.0)));
  DoubleDouble p = t + t * t * (0.5 + t * sixth) + late * t;
  for (int i = 0; i < 8; ++i) p = 2 * p + p * p;
  return p;
}

}  // namespace detail

[[nodiscard]] inline DoubleDouble sin(const DoubleDouble& x) { return detail::sine_cosine(x).sine; }
[[nodiscard]] inline DoubleDouble cos(const DoubleDouble& x) {
  return detail::sine_cosine(x).cosine;
}
[[nodiscard]] inline DoubleDouble tan(const DoubleDouble& x) {
  const auto [s, c] = detail::sine_cosine(x);
  return s / c;
}

/// The angle of (x, y): that of double, corrected by its distance from (x, y).
[[nodiscard]] inline DoubleDouble atan2(const DoubleDouble& y, const DoubleDouble& x) {
  const double nearly = std::atan2(y.hi, x.hi);
  const double size = std::max(std::abs(x.hi), std::abs(y.hi));
  if (!(size > 0 && size < 0x1p990) || nearly == 0) return nearly;
  const double up = size < 0x1p-500 ? 0x1p500 : 1;
  const auto [s, c] = detail::sine_cosine(nearly);
  const DoubleDouble across = (up * y) * c - (up * x) * s;
  const DoubleDouble along = (up * x) * c + (up * y) * s;
  return nearly + across / along;
}
[[nodiscard]] inline DoubleDouble atan(const DoubleDouble& x) { return atan2(x, 1); }
[[nodiscard]] inline DoubleDouble asin(const DoubleDouble& x) {
  return atan2(x, sqrt((1 - x) * (1 + x)));
}
[[nodiscard]] inline DoubleDouble acos(const DoubleDouble& x) {
  return atan2(sqrt((1 - x) * (1 + x)), x);
}

namespace detail {

/// exp(x) = 2^count (1 + p)
struct PowerOf2 {
  DoubleDouble p;
  double scale;  ///< 2^count
};
[[nodiscard]] inline PowerOf2 power_of_2(const DoubleDouble& x) {
  constexpr double ln_2[] = {0x1.62e42fefa39efp-1, 0x1.abc9e3b39803fp-56};
  const double count = std::nearbyint(x.hi / ln_2[0]);
  const DoubleDouble rest = x - DoubleDouble(exact_product(count, ln_2[0])) - count * ln_2[1];
  return {exp_less_1_near_0(rest), std::ldexp(1.0, static_cast<int>(count))};
}

}  // namespace detail

[[nodiscard]] inline DoubleDouble exp(const DoubleDouble& x) {
  if (!(std::abs(x.hi) < 700)) return std::exp(x.hi);
  const auto [p, scale] = detail::power_of_2(x);
  return scale * (1 + p);
}
[[nodiscard]] inline DoubleDouble expm1(const DoubleDouble& x) {
  if (!(std::abs(x.hi) < 700)) return std::expm1(x.hi);
  const auto [p, scale] = detail::power_of_2(x);
  return scale * p + (DoubleDouble(scale) - 1);
}

[[nodiscard]] inline DoubleDouble cosh(const DoubleDouble& x) {
  if (!(std::abs(x.hi) < 700)) return std::cosh(x.hi);
  const DoubleDouble e = exp(abs(x));
  return (e + 1 / e) / 2;
}
[[nodiscard]] inline DoubleDouble sinh(const DoubleDouble& x) {
  if (!(std::abs(x.hi) < 700)) return std::sinh(x.hi);
  const DoubleDouble p = expm1(x);
  return (p + p / (1 + p)) / 2;
}
[[nodiscard]] inline DoubleDouble tanh(const DoubleDouble& x) {
  if (std::abs(x.hi) > 40) return std::copysign(1.0, x.hi);
  const DoubleDouble p = expm1(2 * x);
  return p / (p + 2);
}

/// By one step of Newton from the logarithm of double.
[[nodiscard]] inline DoubleDouble log(const DoubleDouble& x) {
  const double nearly = std::log(x.hi);
  if (!std::isfinite(nearly)) return nearly;
  const DoubleDouble less = x * exp(DoubleDouble(-nearly)) - 1;
  return nearly + (less - less * less / 2);
}
[[nodiscard]] inline DoubleDouble log1p(const DoubleDouble& x) {
  const double nearly = std::log1p(x.hi);
  if (!std::isfinite(nearly) || nearly == 0) return nearly;
  const DoubleDouble less = x + (1 + x) * expm1(DoubleDouble(-nearly));
  return nearly + (less - less * less / 2);
}
[[nodiscard]] inline DoubleDouble atanh(const DoubleDouble& x) {
  const double nearly = std::atanh(x.hi);
  if (!std::isfinite(nearly) || nearly == 0) return nearly;
  const DoubleDouble t = tanh(DoubleDouble(nearly));
  // atanh x - atanh t = atanh((x - t)/(1 - x t))
  return nearly + (x - t) / (1 - x * t);
}

/// The remainder of x/y after the nearest integer, and of x/y truncated.
[[nodiscard]] inline DoubleDouble remainder(const DoubleDouble& x, const DoubleDouble& y) {
  return x - round(x / y) * y;
}
[[nodiscard]] inline DoubleDouble fmod(const DoubleDouble& x, const DoubleDouble& y) {
  return x - trunc(x / y) * y;
}

/// Prints the leading double.
inline std::ostream& operator<<(std::ostream& out, const DoubleDouble& x) { return out << x.hi; }

}  // namespace kreisel

namespace Eigen {

template <>
struct NumTraits<kreisel::DoubleDouble> : GenericNumTraits<kreisel::DoubleDouble> {
  using Real = kreisel::DoubleDouble;
  using NonInteger = kreisel::DoubleDouble;
  using Nested = kreisel::DoubleDouble;
  using Literal = kreisel::DoubleDouble;
  enum {
    IsComplex = 0,
    IsInteger = 0,
    IsSigned = 1,
    RequireInitialization = 0,
    ReadCost = 2,
    AddCost = 11,
    MulCost = 24
  };
};

}  // namespace Eigen
