#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#include "reference_guide.hpp"

namespace differential::reference {

/// A function of time by its Taylor coefficients of order 0 to 3.
class Jet {
 public:
  static constexpr std::size_t size = 4;

  Jet(Real constant = 0) { c_[0] = constant; }  // NOLINT: numbers are constants
  explicit Jet(const std::array<Real, size>& coefficients) : c_(coefficients) {}

  [[nodiscard]] Real operator[](std::size_t k) const { return c_[k]; }
  Real& operator[](std::size_t k) { return c_[k]; }

  [[nodiscard]] Jet rate() const { return Jet({c_[1], 2 * c_[2], 3 * c_[3], 0}); }

  friend Jet operator+(const Jet& a, const Jet& b) {
    Jet sum;
    for (std::size_t k = 0; k < size; ++k) sum[k] = a[k] + b[k];
    return sum;
  }
  friend Jet operator*(const Jet& a, const Jet& b) {
    Jet product;
    for (std::size_t k = 0; k < size; ++k) {
      for (std::size_t j = 0; j <= k; ++j) product[k] += a[j] * b[k - j];
    }
    return product;
  }
  friend Jet operator-(const Jet& a, const Jet& b) { return a + Jet(-1) * b; }
  friend Jet operator/(const Jet& a, const Jet& b) {
    Jet ratio;
    for (std::size_t k = 0; k < size; ++k) {
      ratio[k] = a[k];
      for (std::size_t j = 0; j < k; ++j) ratio[k] -= ratio[j] * b[k - j];
      ratio[k] /= b[0];
    }
    return ratio;
  }
  friend Jet sqrt(const Jet& a) {
    const Real root = std::sqrt(a[0]);
    return a.with(root, 1 / (2 * root), -1 / (4 * root * a[0]), 3 / (8 * root * a[0] * a[0]));
  }
  friend Jet sin(const Jet& a) {
    return a.with(std::sin(a[0]), std::cos(a[0]), -std::sin(a[0]), -std::cos(a[0]));
  }
  friend Jet cos(const Jet& a) {
    return a.with(std::cos(a[0]), -std::sin(a[0]), -std::cos(a[0]), std::sin(a[0]));
  }

 private:
  /// A function of this one, by its first derivatives at the value.
  [[nodiscard]] Jet with(Real f, Real df, Real ddf, Real dddf) const {
    const Jet step = *this - Jet(c_[0]);
    return Jet(f) + step * (Jet(df) + step * (Jet(ddf / 2) + step * Jet(dddf / 6)));
  }

  std::array<Real, size> c_{};
};

}  // namespace differential::reference
