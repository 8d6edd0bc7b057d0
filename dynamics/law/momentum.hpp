#pragma once

#include <type_traits>

#include <dynamics/inertia.hpp>
#include <motor/frame.hpp>
#include <motor/rate.hpp>

namespace kreisel {

/// The rate of the momentum T V for an observer O against whom the body moves with V_rel:
///
///   (d/dt)_O (T V) = [V_rel (T V)] - T [V_rel V] + T (d/dt)_O V
///
/// Source : paper 002 section 2, o(TV') = oT V' + T oV' and o(TF) = oT F + T oF
/// Frame  : all written in E; V may be any velocity, of the body or of the guide
template <class E, class S, class B, class O, class E1, class V, class DV>
[[nodiscard]] auto momentum_rate(const InertiaTensor<E, S>& T, const Velocity<B, O, E1, S>& V_rel,
                                 const V& v, const Rate<O, DV>& dv) {
  constexpr bool one_frame = std::is_same_v<E, E1> && std::is_same_v<E, typename V::Frame>;
  static_assert(one_frame, "inertia and velocities are not written in one frame");
  static_assert(std::is_same_v<V, DV>, "dv is not a rate of v");
  if constexpr (one_frame && std::is_same_v<V, DV>) {
    const Motor<S> transported = cross(V_rel.value, T.value * v.value);
    return Rate<O, Momentum<E, S>>{transported +
                                   T.value * (dv.value - cross(V_rel.value, v.value))};
  }
}

/// The law of motion in momenta seen from the guide frame:  oJ + [F J] + oJ_f + [F J_f] = P.
///
/// Source : paper 002 (7), (9), J = T V' relative momentum, J_f = T F momentum of the guide motion
/// Frame  : G guide, I inertial; everything written in E, usually the guide or the body
template <class G, class I, class E, class S, class OfJ, class OfJf>
[[nodiscard]] auto momentum_balance(const Velocity<G, I, E, S>& F,
                                    const std::type_identity_t<Momentum<E, S>>& J,
                                    const Rate<OfJ, Momentum<E, S>>& dJ,
                                    const std::type_identity_t<Momentum<E, S>>& J_f,
                                    const Rate<OfJf, Momentum<E, S>>& dJ_f) {
  constexpr bool seen_from_guide = std::is_same_v<OfJ, G> && std::is_same_v<OfJf, G>;
  static_assert(seen_from_guide,
                "momentum_balance takes rates seen from the frame whose velocity is F");
  if constexpr (seen_from_guide) {
    return Force<E, S>{dJ.value + cross(F.value, J.value) + dJ_f.value + cross(F.value, J_f.value)};
  }
}

}  // namespace kreisel
