#pragma once

#include <type_traits>

#include <dynamics/load/load.hpp>
#include <dynamics/signal/signal.hpp>

namespace kreisel {

/// A load whose force and torque depend on time alone, on the axes of the guide or of the body. Such
/// a load has a Taylor series.
///
/// Units  : N, N m, metre (point: body axes)
struct TimedLoad {
  bool on_body_axes = false;
  Signal<Vector3<double>> force = {};
  Signal<Vector3<double>> torque = {};  ///< beside that of the force
  Vector3<double> point = Vector3<double>::Zero();

  [[nodiscard]] bool is_analytic() const { return force.is_analytic() && torque.is_analytic(); }
};

namespace detail {

template <class L>
requires requires(const L& load) { load.in_time(); }
[[nodiscard]] TimedLoad in_time(const L& load) { return load.in_time(); }

template <class A>
requires(!std::is_same_v<A, Inertial>) [[nodiscard]] TimedLoad
    in_time(const ConstantLoad<A>& load) {
  return {std::is_same_v<A, Body>, load.force, load.torque, load.point};
}

}  // namespace detail

}  // namespace kreisel
