#pragma once

#include <optional>
#include <type_traits>

#include <dynamics/load/load.hpp>
#include <dynamics/signal/signal.hpp>

namespace kreisel {

/// The frame on whose axes a load is given.
enum class LoadAxes { body, guide, inertial };

/// A load with a Taylor series. Force and torque are functions of time on fixed axes. A magnet in a
/// field on the same axes and a linear drag relative to the guide add to them:
///
///   F = force - L v,   M = torque + moment x field + point x F - A w
///
/// Units  : N, N m, metre (point: body axes), A m^2 (moment: body axes), T, N s/m (L: body axes),
///          N m s (A: body axes)
struct AnalyticLoad {
  LoadAxes axes = LoadAxes::guide;
  Signal<Vector3<double>> force = {};
  Signal<Vector3<double>> torque = {};  ///< beside that of the force
  Vector3<double> point = Vector3<double>::Zero();
  Vector3<double> moment = Vector3<double>::Zero();
  Signal<Vector3<double>> field = {};
  Matrix3<double> linear = Matrix3<double>::Zero();
  Matrix3<double> angular = Matrix3<double>::Zero();

  [[nodiscard]] bool is_drag() const { return !linear.isZero(0) || !angular.isZero(0); }

  /// True if the series exists: signals have no spline, and a drag has a guide at rest.
  [[nodiscard]] bool is_analytic(bool guide_rests) const {
    return force.is_analytic() && torque.is_analytic() && field.is_analytic() &&
           (guide_rests || !is_drag());
  }
};

namespace detail {

template <class A>
inline constexpr LoadAxes load_axes = std::is_same_v<A, Body>    ? LoadAxes::body
                                      : std::is_same_v<A, Guide> ? LoadAxes::guide
                                                                 : LoadAxes::inertial;

template <class L>
requires requires(const L& load) { load.analytic(); }
[[nodiscard]] std::optional<AnalyticLoad> analytic(const L& load) { return load.analytic(); }

template <class A>
[[nodiscard]] std::optional<AnalyticLoad> analytic(const ConstantLoad<A>& load) {
  return AnalyticLoad{load_axes<A>, load.force, load.torque, load.point};
}

}  // namespace detail

}  // namespace kreisel
