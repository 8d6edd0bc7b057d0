#pragma once

#include <type_traits>

#include <motor/frame.hpp>

namespace kreisel {

/// The time derivative of the motor Q seen by an observer fixed in the frame Observer: T, the true
/// moment of the differentiated motor. The derivative is a motor.
///
/// Definition: write Q in Observer (its axes, a point fixed in it) and differentiate the
/// components. The result is a motor and may be written in any frame. Its moment at a point does
/// not depend on the frame in which the moment is resolved. Rates nest: Rate<A, Rate<B, Q>> is a
/// second derivative.
///
/// The rate of a velocity is the spatial acceleration. The acceleration of a point of the body
/// differs from it by omega x v: see PlainRate.
///
/// Source : paper 002 section 2: star, ring and dot over a motor = Rate<Body, Q>, Rate<Guide, Q>,
///          Rate<Inertial, Q>
/// Frame  : written where Q is written
/// Units  : [Q] / s
template <class Observer, class Q>
struct Rate {
  typename Q::Value value;

  using Frame = typename Q::Frame;
  using Scalar = typename Q::Scalar;
  using Value = typename Q::Value;
  template <class E>
  using WrittenIn = Rate<Observer, typename Q::template WrittenIn<E>>;
};

/// The plain derivatives (D u; D v) of the two vectors of a motor seen from Observer: P.
///
/// v is the moment of Q at the origin of the frame in which Q is written. That point may move
/// against the observer, so this pair is no motor: it cannot be reduced elsewhere and cannot be
/// displaced.
///
/// Source : paper 002 section 3, star, ring and dot over the vectors u and v of (12)-(17)
/// Frame  : on the axes of Q::Frame, v taken at its moving origin
/// Units  : [Q] / s
template <class Observer, class Q>
struct PlainRate {
  typename Q::Value value;

  using Frame = typename Q::Frame;
  using Scalar = typename Q::Scalar;
  using Value = typename Q::Value;
};

namespace detail {

/// The rate of a sum, if the sum exists: void stays void.
template <template <class, class> class AnyRate, class Observer, class Q>
struct RateOf {
  using Type = AnyRate<Observer, Q>;
};

template <template <class, class> class AnyRate, class Observer>
struct RateOf<AnyRate, Observer, void> {
  using Type = void;
};

}  // namespace detail

template <class O, class A, class B>
struct Sum<Rate<O, A>, Rate<O, B>> : detail::RateOf<Rate, O, typename Sum<A, B>::Type> {};

template <class O, class A, class B>
struct Sum<PlainRate<O, A>, PlainRate<O, B>>
    : detail::RateOf<PlainRate, O, typename Sum<A, B>::Type> {};

template <class O, class Q>
struct Negative<Rate<O, Q>> {
  using Type = Rate<O, typename Negative<Q>::Type>;
};

template <class O, class Q>
struct Negative<PlainRate<O, Q>> {
  using Type = PlainRate<O, typename Negative<Q>::Type>;
};

namespace detail {

/// True if V is the velocity of the frame Of against the frame From, written where Q is written.
template <class V, class Of, class From, class Q>
inline constexpr bool is_velocity_of =
    std::is_same_v<V, Velocity<Of, From, typename Q::Frame, typename Q::Scalar>>;

}  // namespace detail

/// The rate for the observer New, from the rate for the observer Old:
///
///   (d/dt)_New Q = (d/dt)_Old Q - [V Q],   V = velocity of New against Old.
///
/// For V' and F this is all of (3), (4): seen_from<Body>(oF, V', F) = oF - [V' F] = oF + [F V'].
///
/// Source : paper 002 section 2, .A = *A + [V A], .A = oA + [F A], (3a)-(4c)
/// Frame  : all three written in one frame, which may move against both observers
/// Error  : the error of one motor product, <= 5u * sum of |terms|
template <class New, class Old, class Q, class V>
[[nodiscard, gnu::always_inline]] inline auto seen_from(const Rate<Old, Q>& rate, const V& velocity,
                                                        const std::type_identity_t<Q>& q) ->
    typename detail::Checked<detail::is_velocity_of<V, New, Old, Q>, Rate<New, Q>>::Type {
  static_assert(
      detail::is_velocity_of<V, New, Old, Q>,
      "seen_from<New> takes the velocity of New against the observer of the rate, written "
      "where the rate is written");
  if constexpr (detail::is_velocity_of<V, New, Old, Q>) {
    return {rate.value - cross(velocity.value, q.value)};
  }
}

/// The plain derivatives P of a rate T:  D u unchanged,  D v = T's moment - w x u.
///
/// w is the velocity, against the observer, of the origin of the frame in which Q is written.
///
/// Source : the rule of the moving reference point; paper 002 (13), (17a-f) mix P and T
template <class Observer, class Q, class V>
[[nodiscard]] auto plain_rate(const Rate<Observer, Q>& rate, const V& velocity,
                              const std::type_identity_t<Q>& q) {
  constexpr bool fits = detail::is_velocity_of<V, typename Q::Frame, Observer, Q>;
  static_assert(fits, "plain_rate takes the velocity of the frame written in against the observer");
  if constexpr (fits) {
    const auto& [du, dv] = rate.value;
    return PlainRate<Observer, Q>{{du, dv - velocity.value.moment.cross(q.value.resultant)}};
  }
}

/// The rate T of plain derivatives P:  T's moment = D v + w x u, the inverse of plain_rate.
template <class Observer, class Q, class V>
[[nodiscard]] auto true_rate(const PlainRate<Observer, Q>& rate, const V& velocity,
                             const std::type_identity_t<Q>& q) {
  constexpr bool fits = detail::is_velocity_of<V, typename Q::Frame, Observer, Q>;
  static_assert(fits, "true_rate takes the velocity of the frame written in against the observer");
  if constexpr (fits) {
    const auto& [du, dv] = rate.value;
    return Rate<Observer, Q>{{du, dv + velocity.value.moment.cross(q.value.resultant)}};
  }
}

/// T = P when the observer is the frame in which Q is written: body data are differentiated in the
/// body.
template <class Q>
[[nodiscard]] PlainRate<typename Q::Frame, Q> plain_rate(const Rate<typename Q::Frame, Q>& rate) {
  return {rate.value};
}

template <class Q>
[[nodiscard]] Rate<typename Q::Frame, Q> true_rate(const PlainRate<typename Q::Frame, Q>& rate) {
  return {rate.value};
}

}  // namespace kreisel
