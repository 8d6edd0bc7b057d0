#pragma once

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <limits>

#include <motor/static_zero.hpp>

namespace kreisel {

/// The greatest order of Taylor series that is used.
inline constexpr int most_series_order = 24;

/// The angular velocity and apparent gravity at a guide's origin, on guide axes, as series in
/// powers of (time - t)/h. Apparent gravity is gravity less the origin's inertial acceleration.
///
/// Units  : rad/s, m/s^2
struct GuideSeries {
  using Coefficients = std::array<detail::Components<double>, most_series_order + 1>;

  Coefficients u = {};
  Coefficients g = {};
};

/// A guide whose motion is analytic. It returns the coefficients up to `order` at t, for the
/// uniform gravity g on inertial axes. Needed are the coefficients of u up to `order` and those of
/// g below `order`.
template <class M>
concept AnalyticGuide = requires(const M& guide, double t, const detail::Components<double>& g) {
  { guide.series(t, t, 0, g) } -> std::same_as<GuideSeries>;
};

namespace detail {

/// True if a guide has series; some kinds decide at run time.
template <class M>
[[nodiscard]] bool has_series(const M& guide) {
  if constexpr (requires { guide.knows_series(); }) {
    return guide.knows_series();
  } else {
    return true;
  }
}

/// The reach of a series of order n, in units of its time: the time at which its last two terms are
/// 1e-17 of the first.
[[nodiscard]] inline double reached(const GuideSeries::Coefficients& c, int n) {
  const auto size = [&c](int k) {
    const Components<double>& a = c[std::size_t(k)];
    return std::hypot(a.x, a.y, a.z);
  };
  double reach = std::numeric_limits<double>::infinity();
  for (int k = n - 1; k <= n; ++k) {
    if (size(k) > 0) reach = std::min(reach, std::pow(1e-17 * size(0) / size(k), 1.0 / k));
  }
  return reach;
}

/// The series up to `order` about another point, `by` units of time later, in a unit of time that
/// is `unit` times the old one. By Horner's scheme.
[[nodiscard]] inline GuideSeries shifted(const GuideSeries& s, double by, double unit, int order) {
  using Six = Eigen::Array<double, 6, 1>;
  std::array<Six, most_series_order + 1> c;
  for (std::size_t k = 0; k < c.size(); ++k) {
    c[k] << s.u[k].x, s.u[k].y, s.u[k].z, s.g[k].x, s.g[k].y, s.g[k].z;
  }
  if (by != 0) {
    for (std::size_t i = 0; i + 1 < c.size(); ++i) {
      for (std::size_t k = c.size() - 1; k-- > i;) c[k] += by * c[k + 1];
    }
  }
  GuideSeries result;
  double power = 1;
  for (std::size_t k = 0; k <= std::size_t(order); ++k) {
    const Six a = power * c[k];
    result.u[k] = {a[0], a[1], a[2]};
    result.g[k] = {a[3], a[4], a[5]};
    power *= unit;
  }
  return result;
}

}  // namespace detail

}  // namespace kreisel
