#pragma once

#include <dynamics/law/relative.hpp>
#include <dynamics/load/load.hpp>

namespace kreisel {

/// The outputs of a body at one time. Motors (screws) on body axes, about the body's origin O'.
///
/// Units  : N, N m; kg m/s, kg m^2/s; J; W
template <class S = double>
struct BodyOutputs {
  LoadContext<S> situation;
  Rate<Body, Velocity<Body, Guide, Body, S>> dV_rel;  ///< *V'

  /// The left side of the equation of motion by cause: relative, guide and Coriolis part.
  ForceParts<Body, S> parts;
  /// [V (T V)], V = V' + F: the part of the left side that is free of accelerations. An observer in
  /// the body calls its negative the centrifugal force and the gyroscopic moment.
  Force<Body, S> gyroscopic;
  Force<Body, S> applied;   ///< all loads
  Force<Body, S> reaction;  ///< what the guide exerts on the body at O' to hold it there; 0 if free

  Momentum<Body, S> momentum;           ///< T V, absolute
  Momentum<Body, S> relative_momentum;  ///< T V'

  S kinetic_energy;           ///< V.(T V)/2, absolute
  S relative_kinetic_energy;  ///< V'.(T V')/2
  S potential_energy;         ///< of the loads that have one

  /// Power balance in the guide:  d/dt (relative kinetic energy) = applied_power - guide_power. The
  /// Coriolis part and the reaction do no work in the guide.
  S applied_power;  ///< P . V'
  S guide_power;    ///< guide part . V'
};

namespace detail {

template <class S, class... Loads>
[[nodiscard]] Force<Body, S> total_load(const LoadContext<S>& s, const Loads&... loads) {
  Force<Body, S> sum;
  ((sum = sum + loads(s)), ...);
  return sum;
}

template <class S, class L>
[[nodiscard]] S potential(const LoadContext<S>& s, const L& load) {
  if constexpr (requires { load.potential(s); }) {
    return load.potential(s);
  } else {
    return S(0);
  }
}

template <class S, class... Loads>
[[nodiscard]] BodyOutputs<S> body_outputs(const LoadContext<S>& s,
                                          const Rate<Body, Velocity<Body, Guide, Body, S>>& dV_rel,
                                          const Loads&... loads) {
  const Displacement<Body, Guide, S> X = s.X.inverse();
  const Velocity<Guide, Inertial, Body, S> F = X * s.guide.V;
  const auto V = s.V_rel + F;
  BodyOutputs<S> r;
  r.situation = s;
  r.dV_rel = dV_rel;
  r.parts = equation_of_motion(s.inertia, s.V_rel, F, dV_rel, X * s.guide.dV);
  r.applied = total_load(s, loads...);
  r.reaction = r.parts.total() - r.applied;
  r.momentum = s.inertia * V;
  r.relative_momentum = s.inertia * s.V_rel;
  r.gyroscopic = {gyroscopic(V.value, s.inertia.value, V.value)};
  r.kinetic_energy = reciprocal(r.momentum.value, V.value) / S(2);
  r.relative_kinetic_energy = reciprocal(r.relative_momentum.value, s.V_rel.value) / S(2);
  r.potential_energy = (S(0) + ... + potential(s, loads));
  r.applied_power = power(r.applied, s.V_rel);
  r.guide_power = power(r.parts.guide, s.V_rel);
  return r;
}

}  // namespace detail

}  // namespace kreisel
