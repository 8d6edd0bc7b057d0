#pragma once

#include <limits>

namespace kreisel::exact {

/// A number as an unevaluated sum hi + lo of two long doubles, 128 bits where those have 64.
///
/// It serves the few differences that decide a whole motion, such as L^2 - 2 E B near the
/// separatrix.
///
/// Source : T. J. Dekker 1971, D. E. Knuth TAOCP 4.2.2: the rounding error of a sum and of a
///          product is itself a floating-point number
/// Error  : about 2^-125 relative for each operation, for a sum relative to its terms
struct DoubleDouble {
  long double hi = 0;
  long double lo = 0;

  DoubleDouble(long double x) : hi(x) {}  // implicit: every number is one
  DoubleDouble(long double h, long double l) : hi(h + l), lo(l - (hi - h)) {}

  friend DoubleDouble operator-(const DoubleDouble& a) { return {-a.hi, -a.lo}; }

  friend DoubleDouble operator+(const DoubleDouble& a, const DoubleDouble& b) {
    const long double sum = a.hi + b.hi;
    const long double of_b = sum - a.hi;
    const long double error = (a.hi - (sum - of_b)) + (b.hi - of_b);
    return {sum, error + a.lo + b.lo};
  }
  friend DoubleDouble operator-(const DoubleDouble& a, const DoubleDouble& b) { return a + -b; }

  friend DoubleDouble operator*(const DoubleDouble& a, const DoubleDouble& b) {
    const long double product = a.hi * b.hi;
    const Halves p = halves(a.hi);
    const Halves q = halves(b.hi);
    const long double error =
        p.low * q.low - (((product - p.high * q.high) - p.low * q.high) - p.high * q.low);
    return {product, error + (a.hi * b.lo + a.lo * b.hi)};
  }

 private:
  /// The leading and the last digits of x, whose products are exact. fma() of long double would
  /// take as long as the rest of a top's constructor.
  struct Halves {
    long double high, low;
  };
  [[nodiscard]] static Halves halves(long double x) {
    constexpr long double splitter =
        static_cast<long double>(1ULL << (std::numeric_limits<long double>::digits + 1) / 2) + 1;
    const long double scaled = splitter * x;
    const long double high = scaled - (scaled - x);
    return {high, x - high};
  }
};

}  // namespace kreisel::exact
