#pragma once

#include <optional>
#include <type_traits>

#include <dynamics/load/analytic_load.hpp>
#include <dynamics/load/load.hpp>

namespace kreisel {

/// Drag of a medium that moves with the guide, on a point of the body and on its rotation:
///
///   F = -(L v + Q |v| v),   M = -A w
///
/// v is the velocity of the point and w the angular velocity, relative to the guide. F acts at the
/// point. The matrices are on body axes and take energy from the body if their symmetric parts have
/// no negative eigenvalue.
///
/// Units  : N s/m (L), N s^2/m^2 (Q), N m s/rad (A), metre (point: body axes)
template <class S = double>
struct Drag {
  static constexpr const char* kind = "drag";
  static constexpr bool ignores_guide = true;

  Matrix3<S> linear = Matrix3<S>::Zero();     ///< L
  Matrix3<S> quadratic = Matrix3<S>::Zero();  ///< Q
  Matrix3<S> angular = Matrix3<S>::Zero();    ///< A
  Vector3<S> point = Vector3<S>::Zero();

  template <class N>
  [[nodiscard]] Force<Body, N> operator()(const LoadContext<N>& s) const {
    const Vector3<N> arm = point.template cast<N>();
    const Vector3<N> v = s.velocity(arm);
    Vector3<N> f = -(linear.template cast<N>() * v);
    // |v| has no derivative at 0, but |v| v has: 0.
    if (!(v.squaredNorm() == N(0))) f -= v.norm() * (quadratic.template cast<N>() * v);
    return {{f, arm.cross(f) - angular.template cast<N>() * s.V_rel.value.resultant}};
  }

  /// |v| v has no Taylor series where v reverses.
  [[nodiscard]] std::optional<AnalyticLoad> analytic() const requires(std::is_same_v<S, double>) {
    if (!quadratic.isZero(0)) return std::nullopt;
    return AnalyticLoad{
        .axes = LoadAxes::body, .point = point, .linear = linear, .angular = angular};
  }
};

}  // namespace kreisel
