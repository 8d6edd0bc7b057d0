#pragma once

#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include <dynamics/scene/felt_motion.hpp>
#include <dynamics/scene/load.hpp>
#include <dynamics/scene/read_out.hpp>

namespace kreisel::detail {

/// Whether a load on a guide of the kind M has a potential that the guide carries along and does
/// nothing else. A load of the user's says so by a member keeps_energy() beside its potential().
template <class M, class L>
[[nodiscard]] bool keeps_energy(const L& load) {
  if constexpr (is_without<L> || std::is_same_v<L, UniformGravity<Guide>>) {
    return true;
  } else if constexpr (std::is_same_v<L, UniformGravity<Inertial>>) {
    return decltype(std::declval<const M&>().steady().u)::absent;
  } else if constexpr (requires { load.keeps_energy(); }) {
    return load.keeps_energy();
  } else {
    return false;
  }
}

/// Jacobi's integral of a body in a guide that moves steadily, its energy where the guide rests:
///
///   H = V'.(T V')/2 - u.(Theta u)/2 + m a.r_s + potential
///
/// Theta and r_s about the guide's origin, whose inertial acceleration is a. Nothing, where the
/// guide moves otherwise or a load does other work.
///
/// Units  : J
template <class M, class... Loads>
[[nodiscard]] std::vector<std::pair<const char*, double>> kept_energy(const M& guide,
                                                                      const Situation<double>& s,
                                                                      const Loads&... loads) {
  if constexpr (SteadyGuide<M>) {
    if (!(keeps_energy<M>(loads) && ...) || vanishes<CentrifugalForce, Axis::x, Loads...>)
      return {};
    const auto motion = guide.steady();
    const Velocity<Guide, Inertial, Guide> turning{
        {vector<double>(motion.u), Vector3<double>::Zero()}};
    const Motor<> u = (s.X.inverse() * turning).value;
    const Motor<>& V = s.V_rel.value;
    const Inertia<double>& T = s.inertia.value;
    const Vector3<double> first_moment =
        T.mass * s.X.value.translation + s.X.value.rotation * T.first_moment;
    const double H = (reciprocal(T * V, V) - reciprocal(T * u, u)) / 2 +
                     vector<double>(motion.origin_acceleration).dot(first_moment) +
                     (0.0 + ... + potential(s, loads));
    constexpr bool rests =
        decltype(motion.u)::absent && decltype(motion.origin_acceleration)::absent;
    return {{rests ? "energy" : "Jacobi integral", H}};
  } else {
    return {};
  }
}

}  // namespace kreisel::detail
