#pragma once

#include <cmath>

namespace kreisel {

/// A complex number of any number type: std::complex is defined for the built-in types alone.
template <class S>
struct ComplexOf {
  S re = S(0);
  S im = S(0);

  ComplexOf() = default;
  ComplexOf(const S& real) : re(real) {}  // implicit: every real number is one
  ComplexOf(const S& real, const S& imaginary) : re(real), im(imaginary) {}

  [[nodiscard]] const S& real() const { return re; }
  [[nodiscard]] const S& imag() const { return im; }

  ComplexOf& operator+=(const ComplexOf& b) { return *this = *this + b; }
  ComplexOf& operator-=(const ComplexOf& b) { return *this = *this - b; }
  ComplexOf& operator/=(const ComplexOf& b) { return *this = *this / b; }

  friend ComplexOf operator-(const ComplexOf& a) { return {-a.re, -a.im}; }
  friend ComplexOf operator+(const ComplexOf& a, const ComplexOf& b) {
    return {a.re + b.re, a.im + b.im};
  }
  friend ComplexOf operator-(const ComplexOf& a, const ComplexOf& b) {
    return {a.re - b.re, a.im - b.im};
  }
  friend ComplexOf operator*(const ComplexOf& a, const ComplexOf& b) {
    return {a.re * b.re - a.im * b.im, a.re * b.im + a.im * b.re};
  }
  friend ComplexOf operator*(const ComplexOf& a, const S& b) { return {a.re * b, a.im * b}; }
  friend ComplexOf operator*(const S& a, const ComplexOf& b) { return b * a; }
  friend ComplexOf operator/(const ComplexOf& a, const S& b) { return {a.re / b, a.im / b}; }
  friend ComplexOf operator/(const ComplexOf& a, const ComplexOf& b) {
    return a * conj(b) / norm(b);
  }

  friend ComplexOf conj(const ComplexOf& a) { return {a.re, -a.im}; }
  /// |a|^2
  friend S norm(const ComplexOf& a) { return a.re * a.re + a.im * a.im; }
  friend S abs(const ComplexOf& a) {
    using std::hypot;
    return hypot(a.re, a.im);
  }
};

}  // namespace kreisel
