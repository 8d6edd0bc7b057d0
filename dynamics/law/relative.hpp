#pragma once

#include <type_traits>

#include <dynamics/inertia.hpp>
#include <motor/frame.hpp>
#include <motor/rate.hpp>

namespace kreisel {

/// The left side of the equation of motion, by cause. The sum of the parts is the force motor
/// (wrench) P on the body.
///
/// Source : paper 002 section 2, Anteil der Relativbewegung, der Fuehrungsbewegung, Coriolisanteil
/// Units  : (N; N m)
template <class E, class S = double>
struct ForceParts {
  Force<E, S> relative;
  Force<E, S> guide;
  Force<E, S> coriolis;

  [[nodiscard]] Force<E, S> total() const { return relative + guide + coriolis; }
};

namespace detail {

/// [A (T B)] up to terms that cancel against [B (T A)]. The sum of both, and [A (T A)], are exact.
///
/// The term v_A x m v_B is left out, and u x (s x v) + v x (u x s) is written s x (u x v) (Jacobi).
/// On the earth, v = 465 m/s, the rounding error of v x m v = 0 would be a torque of 1e-11 N m for
/// a kilogram.
template <class S>
[[nodiscard]] Motor<S> gyroscopic(const Motor<S>& A, const Inertia<S>& T, const Motor<S>& B) {
  const Vector3<S>& u = A.resultant;
  const Vector3<S> uv = u.cross(B.moment);
  return {T.mass * uv + u.cross(B.resultant.cross(T.first_moment)),
          T.first_moment.cross(uv) + u.cross(T.tensor * B.resultant)};
}

template <class Observer, class... Frames>
inline constexpr bool is_one_of = (std::is_same_v<Observer, Frames> || ...);

/// The factor k of T [F V'] in the form of the equation of motion for these observers.
///
/// Form (2) has no such term. Another observer of V' or F changes the derivative by a multiple of
/// [F V'], (3b) and (4b), and the term with k compensates the change.
template <class OfV, class OfF, class B, class I>
inline constexpr int extra_coriolis = (std::is_same_v<OfF, B> ? 0 : 1) -
                                      (std::is_same_v<OfV, I> ? 1 : 0);

}  // namespace detail

/// The equation of motion of a rigid body relative to a moving guide frame, in all nine forms:
///
///   relative : T dV' + [V' (T V')]
///   guide    : T dF  + [F (T F)]
///   coriolis : [V' (T F)] + [F (T V')] + k T [F V']
///
/// The observers of dV' and dF select the form, hence k, at compile time:
///
///        dF seen from    body      guide     inertial
///   dV' from body         0  (2)    1  (5)     1
///            guide        0         1  (8)     1
///            inertial    -1         0          0  (6)
///
/// The total is the same in all nine forms. The form decides which part contains T [F V']. Only
/// with dF seen from the guide is the guide part the force that a body at rest in the guide would
/// feel.
///
/// Source : paper 002 (2), (5), (6), (8); the four forms that the paper does not print were proved
/// Frame  : B body, G guide, I inertial, each any tag; everything written in E, usually the body
/// Error  : <= 20u * sum of |terms|; against 25-digit references <= 1e-14 (tests/dynamics/law)
/// Cost   : 2 (k = 0) or 3 products of tensor and motor, 4 of 4 cross products; for k != 0 one
///          motor product more
template <class E, class S, class B, class G, class I, class E1, class E2, class OfV, class OfF,
          class DV, class DF>
[[nodiscard]] auto equation_of_motion(const InertiaTensor<E, S>& T,
                                      const Velocity<B, G, E1, S>& V_rel,
                                      const Velocity<G, I, E2, S>& F, const Rate<OfV, DV>& dV_rel,
                                      const Rate<OfF, DF>& dF) {
  constexpr bool one_frame = std::is_same_v<E, E1> && std::is_same_v<E, E2>;
  constexpr bool rates_fit =
      std::is_same_v<DV, Velocity<B, G, E, S>> && std::is_same_v<DF, Velocity<G, I, E, S>>;
  constexpr bool form_exists = detail::is_one_of<OfV, B, G, I> && detail::is_one_of<OfF, B, G, I>;
  static_assert(one_frame, "inertia and velocities are not written in one frame");
  static_assert(!one_frame || rates_fit, "dV_rel, dF are not rates of V_rel, F in that order");
  static_assert(form_exists,
                "a rate is seen neither from the body, the guide nor the inertial frame");
  if constexpr (one_frame && rates_fit && form_exists) {
    const Inertia<S>& inertia = T.value;
    const Motor<S>& V = V_rel.value;
    Motor<S> coriolis =
        detail::gyroscopic(V, inertia, F.value) + detail::gyroscopic(F.value, inertia, V);
    constexpr int k = detail::extra_coriolis<OfV, OfF, B, I>;
    if constexpr (k != 0) coriolis += S(k) * (inertia * cross(F.value, V));
    return ForceParts<E, S>{{inertia * dV_rel.value + detail::gyroscopic(V, inertia, V)},
                            {inertia * dF.value + detail::gyroscopic(F.value, inertia, F.value)},
                            {coriolis}};
  }
}

/// The rate of V_rel, seen from Observer, under the force P: the equation of motion solved for the
/// acceleration.
///
/// Source : paper 002 (2), (5), (6), (8) solved for the derivative of V'
/// Throws : ComputationFailed when the body's inertia is singular
template <class Observer, class E, class S, class B, class G, class I, class E1, class E2, class E3,
          class OfF, class DF>
[[nodiscard]] auto relative_acceleration(const InertiaTensor<E, S>& T, const Force<E1, S>& P,
                                         const Velocity<B, G, E2, S>& V_rel,
                                         const Velocity<G, I, E3, S>& F, const Rate<OfF, DF>& dF) {
  static_assert(std::is_same_v<E, E1>, "inertia and force are not written in one frame");
  using Acceleration = Rate<Observer, Velocity<B, G, E, S>>;
  if constexpr (std::is_same_v<E, E1>) {
    const auto without = equation_of_motion(T, V_rel, F, Acceleration{}, dF);
    return Acceleration{solve(T.value, P.value - without.total().value)};
  }
}

}  // namespace kreisel
