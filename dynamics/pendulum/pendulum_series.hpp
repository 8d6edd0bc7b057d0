#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#include <dynamics/guide/series.hpp>
#include <motor/simd.hpp>

namespace kreisel::detail {

/// The Taylor series of the motion of an undamped pendulum on a steady guide, for TaylorSteps:
///
///   phi'' = -(e sin phi + f cos phi + k sin 2phi + h cos 2phi + drive)
///
/// Each coefficient follows from those before it, because  x = (sin phi, cos phi, sin 2phi, cos
/// 2phi) obeys an equation of products of series:
///
///   x' = phi' y,   y = (x_2, -x_1, 2 x_4, -2 x_3)
///
/// Source : recurrences of sine and cosine: E. Hairer, S. P. Norsett, G. Wanner, Solving Ordinary
///          Differential Equations I, I.8
class PendulumSeries {
 public:
  static constexpr int most_order = most_series_order;

  /// The constructor takes moments and ou_z over Theta_C.
  PendulumSeries(double e, double f, double k, double h, double drive)
      : moments_(e, f, k, h), drive_(drive) {}

  /// Fills the columns 1 to `order` of c with the coefficients of (phi; phi') in powers of
  /// (time - t)/h, for the motion that has column 0 at t.
  template <class Coefficients>
  void operator()(double /*t*/, double h, int order, Coefficients& c) const {
    std::array<double, most_order> turned;     // h phi'
    std::array<Vec4d, most_order> quarter_on;  // y
    Vec4d x = waves(c(0, 0));
    double drive = drive_;
    for (int k = 0;; ++k) {
      const auto at = static_cast<std::size_t>(k);
      const double weight = h / (k + 1);
      const Vec4d moment = moments_ * x;
      c(0, k + 1) = weight * c(1, k);
      c(1, k + 1) = -weight * ((moment[0] + moment[1]) + (moment[2] + moment[3]) + drive);
      if (k + 1 == order) return;
      drive = 0;
      turned[at] = h * c(1, k);
      quarter_on[at] = Vec4d(x[1], -x[0], 2 * x[3], -2 * x[2]);
      // Two sums, so that a term does not wait for the one before; the newest coefficients last.
      Vec4d even(0, 0, 0, 0);
      Vec4d odd(0, 0, 0, 0);
      std::size_t i = 1;
      for (; i + 2 < at; i += 2) {
        even += turned[i] * quarter_on[at - i];
        odd += turned[i + 1] * quarter_on[at - i - 1];
      }
      for (; i < at; ++i) even += turned[i] * quarter_on[at - i];
      if (k > 0) odd += turned[at] * quarter_on[0];
      x = 1.0 / (k + 1) * ((even + odd) + turned[0] * quarter_on[at]);
    }
  }

 private:
  [[nodiscard]] static Vec4d waves(double angle) {
    const double s = std::sin(angle);
    const double c = std::cos(angle);
    return {s, c, 2 * s * c, (c - s) * (c + s)};
  }

  Vec4d moments_;
  double drive_;
};

}  // namespace kreisel::detail
