#pragma once

#include <optional>
#include <type_traits>

#include <dynamics/load/analytic_load.hpp>
#include <dynamics/load/load.hpp>
#include <dynamics/signal/signal.hpp>

namespace kreisel {

/// A ConstantLoad whose force and torque change with time. The user announces their jumps to the
/// solver.
///
/// Units  : N, N m, metre (point: body axes)
template <class A>
struct SignalLoad {
  static constexpr const char* kind = "load that changes with time";
  static constexpr bool ignores_guide = !std::is_same_v<A, Inertial>;

  Signal<Vector3<double>> force = {};
  Signal<Vector3<double>> torque = {};
  Vector3<double> point = Vector3<double>::Zero();

  template <class N>
  [[nodiscard]] Force<Body, N> operator()(const LoadContext<N>& s) const {
    const Vector3<N> f = s.template on_body_axes<A>(force(s.t));
    return {{f, s.template on_body_axes<A>(torque(s.t)) + point.template cast<N>().cross(f)}};
  }

  [[nodiscard]] std::optional<AnalyticLoad> analytic() const {
    return AnalyticLoad{detail::load_axes<A>, force, torque, point};
  }
};

}  // namespace kreisel
