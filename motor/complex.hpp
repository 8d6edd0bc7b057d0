#pragma once

#include <cmath>

namespace kreisel {

/// A complex number of any number type: std::complex is defined for the built-in types alone.
template <class S>
struct Complex {
  S re = S(0);
  S im = S(0);

  Complex() = default;
  Complex(const S& real) : re(real) {}  // implicit: every real number is one
  Complex(const S& real, const S& imaginary) : re(real), im(imaginary) {}

  [[nodiscard]] const S& real() const { return re; }
  [[nodiscard]] const S& imag() const { return im; }

  Complex& operator+=(const Complex& b) { return *this = *this + b; }
  Complex& operator-=(const Complex& b) { return *this = *this - b; }
  Complex& operator/=(const Complex& b) { return *this = *this / b; }

  friend Complex operator-(const Complex& a) { return {-a.re, -a.im}; }
  friend Complex operator+(const Complex& a, const Complex& b) {
    return {a.re + b.re, a.im + b.im};
  }
  friend Complex operator-(const Complex& a, const Complex& b) {
    return {a.re - b.re, a.im - b.im};
  }
  friend Complex operator*(const Complex& a, const Complex& b) {
    return {a.re * b.re - a.im * b.im, a.re * b.im + a.im * b.re};
  }
  friend Complex operator*(const Complex& a, const S& b) { return {a.re * b, a.im * b}; }
  friend Complex operator*(const S& a, const Complex& b) { return b * a; }
  friend Complex operator/(const Complex& a, const S& b) { return {a.re / b, a.im / b}; }
  friend Complex operator/(const Complex& a, const Complex& b) { return a * conj(b) / norm(b); }

  friend Complex conj(const Complex& a) { return {a.re, -a.im}; }
  /// |a|^2
  friend S norm(const Complex& a) { return a.re * a.re + a.im * a.im; }
  friend S abs(const Complex& a) {
    using std::hypot;
    return hypot(a.re, a.im);
  }
};

}  // namespace kreisel
