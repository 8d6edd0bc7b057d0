#pragma once

#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include <dynamics/guide/resting.hpp>
#include <dynamics/load/load.hpp>
#include <dynamics/rigid/apparent_field.hpp>
#include <dynamics/rigid/body_outputs.hpp>

namespace kreisel::detail {

/// True if a load on a guide of the type M is conservative, with a potential that moves with the
/// guide.
template <class M, class L>
[[nodiscard]] bool keeps_energy(const L& load) {
  if constexpr (is_without<L> || std::is_same_v<L, UniformGravity<Guide>>) {
    return true;
  } else if constexpr (std::is_same_v<L, UniformGravity<Inertial>>) {
    return decltype(std::declval<const M&>().steady().u)::static_zero;
  } else if constexpr (requires { L::rests_inertially; }) {
    return is_resting<M>;
  } else if constexpr (requires { load.keeps_energy(); }) {
    return load.keeps_energy();
  } else {
    return false;
  }
}

/// Jacobi's integral of a body in a guide that moves steadily; the energy if the guide rests:
///
///   H = V'.(T V')/2 - u.(Theta u)/2 + m a.r_s + potential
///
/// Theta and r_s are about the guide's origin, whose inertial acceleration is a. Nothing, if the
/// guide moves otherwise or a load does other work.
///
/// Units  : J
template <class M, class... Loads>
[[nodiscard]] std::vector<std::pair<const char*, double>> kept_energy(const M& guide,
                                                                      const LoadContext<double>& s,
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
        decltype(motion.u)::static_zero && decltype(motion.origin_acceleration)::static_zero;
    return {{rests ? "energy" : "Jacobi integral", H}};
  } else {
    return {};
  }
}

/// True if a load is uniform gravity, or no load.
template <class L>
inline constexpr bool is_uniform = is_without<L> || std::is_same_v<L, UniformGravity<Guide>> ||
                                   std::is_same_v<L, UniformGravity<Inertial>>;

/// A load's field of gravity on guide axes.
template <class L>
[[nodiscard]] Vector3<double> field_of(const L& load, const Matrix3<double>& guide_to_inertial) {
  if constexpr (std::is_same_v<L, UniformGravity<Guide>>) return load.g;
  if constexpr (std::is_same_v<L, UniformGravity<Inertial>>) {
    return guide_to_inertial.transpose() * load.g;
  }
  return Vector3<double>::Zero();
}

/// Adds the momenta that a body keeps on a guide at rest under uniform gravity alone, by name. The
/// angular momentum about a fixed point of the guide is kept along gravity, or as a whole without
/// gravity. A free body keeps its linear momentum across gravity.
///
/// about : the fixed point of a fixed-point body, the guide's origin for a free one; on guide axes
/// Frame : guide axes
/// Units : kg m/s, kg m^2/s
template <class M, class... Loads>
void add_kept_momenta(std::vector<std::pair<const char*, double>>& kept,
                      const LoadContext<double>& s, const Vector3<double>& about, bool is_free,
                      const Loads&... loads) {
  if constexpr (is_resting<M> && (is_uniform<Loads> && ...)) {
    static constexpr const char* linear[] = {"momentum x", "momentum y", "momentum z"};
    static constexpr const char* angular[] = {"angular momentum x", "angular momentum y",
                                              "angular momentum z"};
    const Motor<> p = (s.X * (s.inertia * s.V_rel)).value.reduced_at(about);
    Vector3<double> g = Vector3<double>::Zero();
    ((g += field_of(loads, s.guide.X.value.rotation)), ...);
    const double size = g.norm();
    for (int k = 0; k < 3 && is_free; ++k) {
      if (g[k] == 0) kept.emplace_back(linear[k], p.resultant[k]);
    }
    if (size > 0) kept.emplace_back("angular momentum along gravity", p.moment.dot(g) / size);
    for (int k = 0; k < 3 && size == 0; ++k) kept.emplace_back(angular[k], p.moment[k]);
  }
}

}  // namespace kreisel::detail
