#pragma once

#include <cmath>
#include <concepts>
#include <limits>
#include <type_traits>

/// Numbers of twice the digits of double, by the operations of double alone.
///
/// A compiler may contract a * b + c to one rounding where the processor has such an instruction.
/// That would lose the second half of a number without a message. Here every product whose
/// rounding matters is therefore itself such an instruction, which nothing can be contracted with.

#if defined(__FP_FAST_FMA) || defined(__FMA__) || defined(__aarch64__) || defined(__s390x__) || \
    defined(__powerpc64__) || defined(__ARM_FEATURE_FMA) || defined(__riscv_d)
#define KREISEL_HAS_FMA 1
#else
#define KREISEL_HAS_FMA 0
#endif

namespace kreisel {

namespace detail {

/// A number and the rounding error of its computation.
struct WithError {
  double value;
  double error;
};

/// a + b and its error (Knuth).
[[nodiscard, gnu::always_inline]] constexpr WithError exact_sum(double a, double b) {
  const double sum = a + b;
  const double of_b = sum - a;
  return {sum, (a - (sum - of_b)) + (b - of_b)};
}

/// As exact_sum(), for |a| >= |b| or a = 0 (Dekker).
[[nodiscard, gnu::always_inline]] constexpr WithError exact_sum_of_ordered(double a, double b) {
  const double sum = a + b;
  return {sum, b - (sum - a)};
}

/// a b, in halves of 26 digits, whose products are exact (Dekker, Veltkamp); |a|, |b| < 2^995.
[[nodiscard, gnu::always_inline]] constexpr WithError exact_product_by_halves(double a, double b) {
  constexpr double splitter = 0x1p27 + 1;
  const double scaled_a = splitter * a;
  const double scaled_b = splitter * b;
  const double a1 = scaled_a - (scaled_a - a);
  const double b1 = scaled_b - (scaled_b - b);
  const double a2 = a - a1;
  const double b2 = b - b1;
  const double product = a * b;
  return {product, a2 * b2 - (((product - a1 * b1) - a2 * b1) - a1 * b2)};
}

/// a b and its error.
[[nodiscard, gnu::always_inline]] constexpr WithError exact_product(double a, double b) {
#if KREISEL_HAS_FMA
  if (!std::is_constant_evaluated()) {
    const double product = __builtin_fma(a, b, -0.0);
    return {product, __builtin_fma(a, b, -product)};
  }
#endif
  return exact_product_by_halves(a, b);
}

}  // namespace detail

/// A number as an unevaluated sum hi + lo of two doubles, with 106 bits.
///
/// It serves phases after 1e4 periods, differences that decide a whole motion, coefficients of
/// integrators, and second computations that show the error of a first. It has the same digits on
/// every processor.
///
/// Source : T. J. Dekker 1971, D. E. Knuth TAOCP 4.2.2: the rounding error of a sum and of a
///          product is itself a floating-point number
/// Error  : 2^-102 relative for + - * / and sqrt, for a sum relative to its terms; functions see
///          double_double_functions.hpp. Numbers below 1e-291 keep the digits of double
///          (tests/motor/double_double.cpp)
/// Limits : sums and products of infinities, and products above 2^995, are NaN; quotients by 0 are
///          infinite
/// Cost   : in benchmarks/report.md, kernels
struct DoubleDouble {
  double hi;
  double lo;

  DoubleDouble() = default;                           // any number, as a double without a value
  constexpr DoubleDouble(double x) : hi(x), lo(0) {}  // implicit: every double is one
  constexpr DoubleDouble(std::integral auto n) : DoubleDouble(of_integer(n)) {}
  constexpr DoubleDouble(long double x)
      : hi(static_cast<double>(x)), lo(static_cast<double>(x - static_cast<long double>(hi))) {}
  explicit constexpr DoubleDouble(const detail::WithError& x) : hi(x.value), lo(x.error) {}

  template <class T>
  requires std::is_arithmetic_v<T>
  explicit constexpr operator T() const {
    if constexpr (std::is_floating_point_v<T> && sizeof(T) <= sizeof(double)) {
      return static_cast<T>(hi);  // lo is below its last digit
    } else {
      return static_cast<T>(hi) + static_cast<T>(lo);
    }
  }

  constexpr DoubleDouble& operator+=(const DoubleDouble& b) { return *this = *this + b; }
  constexpr DoubleDouble& operator-=(const DoubleDouble& b) { return *this = *this - b; }
  constexpr DoubleDouble& operator*=(const DoubleDouble& b) { return *this = *this * b; }
  constexpr DoubleDouble& operator/=(const DoubleDouble& b) { return *this = *this / b; }

  [[gnu::always_inline]] friend constexpr DoubleDouble operator+(const DoubleDouble& a) {
    return a;
  }
  [[gnu::always_inline]] friend constexpr DoubleDouble operator-(const DoubleDouble& a) {
    return joined(-a.hi, -a.lo);
  }

  [[gnu::always_inline]] friend constexpr DoubleDouble operator+(const DoubleDouble& a,
                                                                 const DoubleDouble& b) {
    const auto [sum, error] = detail::exact_sum(a.hi, b.hi);
    return ordered(sum, error + (a.lo + b.lo));
  }
  [[gnu::always_inline]] friend constexpr DoubleDouble operator+(const DoubleDouble& a, double b) {
    const auto [sum, error] = detail::exact_sum(a.hi, b);
    return ordered(sum, error + a.lo);
  }
  [[gnu::always_inline]] friend constexpr DoubleDouble operator+(double a, const DoubleDouble& b) {
    return b + a;
  }
  [[gnu::always_inline]] friend constexpr DoubleDouble operator-(const DoubleDouble& a,
                                                                 const DoubleDouble& b) {
    return a + -b;
  }
  [[gnu::always_inline]] friend constexpr DoubleDouble operator-(const DoubleDouble& a, double b) {
    return a + -b;
  }
  [[gnu::always_inline]] friend constexpr DoubleDouble operator-(double a, const DoubleDouble& b) {
    return -b + a;
  }

  [[gnu::always_inline]] friend constexpr DoubleDouble operator*(const DoubleDouble& a,
                                                                 const DoubleDouble& b) {
    const auto [product, error] = detail::exact_product(a.hi, b.hi);
    return ordered(product, error + (a.hi * b.lo + a.lo * b.hi));
  }
  [[gnu::always_inline]] friend constexpr DoubleDouble operator*(const DoubleDouble& a, double b) {
    const auto [product, error] = detail::exact_product(a.hi, b);
    return ordered(product, error + a.lo * b);
  }
  [[gnu::always_inline]] friend constexpr DoubleDouble operator*(double a, const DoubleDouble& b) {
    return b * a;
  }

  [[gnu::always_inline]] friend constexpr DoubleDouble operator/(const DoubleDouble& a,
                                                                 const DoubleDouble& b) {
    const double q = a.hi / b.hi;
    return quotient(q, (a - b * q).hi * (1 / b.hi));
  }
  [[gnu::always_inline]] friend constexpr DoubleDouble operator/(const DoubleDouble& a, double b) {
    const double q = a.hi / b;
    return quotient(q, (a - DoubleDouble(detail::exact_product(q, b))).hi * (1 / b));
  }
  [[gnu::always_inline]] friend constexpr DoubleDouble operator/(double a, const DoubleDouble& b) {
    return DoubleDouble(a) / b;
  }

  friend constexpr bool operator==(const DoubleDouble& a, const DoubleDouble& b) {
    return a.hi == b.hi && a.lo == b.lo;
  }
  friend constexpr bool operator<(const DoubleDouble& a, const DoubleDouble& b) {
    return a.hi < b.hi || (a.hi == b.hi && a.lo < b.lo);
  }
  friend constexpr bool operator>(const DoubleDouble& a, const DoubleDouble& b) { return b < a; }
  friend constexpr bool operator<=(const DoubleDouble& a, const DoubleDouble& b) {
    return a.hi < b.hi || (a.hi == b.hi && a.lo <= b.lo);
  }
  friend constexpr bool operator>=(const DoubleDouble& a, const DoubleDouble& b) { return b <= a; }

 private:
  template <class Integer>
  [[nodiscard]] static constexpr detail::WithError of_integer(Integer n) {
    if constexpr (std::numeric_limits<Integer>::digits <= std::numeric_limits<double>::digits) {
      return {static_cast<double>(n), 0};
    } else {
      const Integer low = n % (Integer(1) << 32);
      return detail::exact_sum_of_ordered(static_cast<double>(n - low), static_cast<double>(low));
    }
  }

  [[nodiscard]] static constexpr DoubleDouble joined(double hi, double lo) {
    DoubleDouble result(hi);
    result.lo = lo;
    return result;
  }
  /// hi + lo for |hi| >= |lo|
  [[nodiscard, gnu::always_inline]] static constexpr DoubleDouble ordered(double hi, double lo) {
    return DoubleDouble(detail::exact_sum_of_ordered(hi, lo));
  }
  /// The quotient q, corrected by the rest of the division; without it where q is infinite or 0.
  [[nodiscard, gnu::always_inline]] static constexpr DoubleDouble quotient(double q, double rest) {
    return rest - rest == 0 ? ordered(q, rest) : DoubleDouble(q);
  }
};

}  // namespace kreisel
