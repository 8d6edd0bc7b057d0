#pragma once

#include <cmath>

namespace kreisel::exact {

/// A number as an unevaluated sum hi + lo of two long doubles, 128 bits where those have 64: for
/// the few differences on which a whole motion hangs, as L^2 - 2 E B near the separatrix.
///
/// Source : T. J. Dekker 1971, D. E. Knuth TAOCP 4.2.2: the rounding error of a sum and of a
///          product is itself a floating-point number
/// Error  : some 2^-125 relative of each operation, of a sum relative to its terms
struct Twofold {
  long double hi = 0;
  long double lo = 0;

  Twofold(long double x) : hi(x) {}  // implicit: every number is one
  Twofold(long double h, long double l) : hi(h + l), lo(l - (hi - h)) {}

  friend Twofold operator-(const Twofold& a) { return {-a.hi, -a.lo}; }

  friend Twofold operator+(const Twofold& a, const Twofold& b) {
    const long double sum = a.hi + b.hi;
    const long double of_b = sum - a.hi;
    const long double error = (a.hi - (sum - of_b)) + (b.hi - of_b);
    return {sum, error + a.lo + b.lo};
  }
  friend Twofold operator-(const Twofold& a, const Twofold& b) { return a + -b; }

  friend Twofold operator*(const Twofold& a, const Twofold& b) {
    const long double product = a.hi * b.hi;
    const long double error = std::fma(a.hi, b.hi, -product);
    return {product, error + (a.hi * b.lo + a.lo * b.hi)};
  }
};

}  // namespace kreisel::exact
