#pragma once

#include <type_traits>

#include <motor/displacement.hpp>
#include <motor/motor.hpp>

namespace kreisel {

/// Frames are empty tag types; any empty struct of the user's can be one. A frame has axes and an
/// origin: "written in E" means components on E's axes AND reduction at E's origin.
///
/// Tags contain no time: two values in one frame taken at different times type-check together. Do
/// not keep tagged values across a time step.
struct Inertial {};  ///< where Newton's law holds; paper 002: Sigma', marked by a dot
struct Guide {};     ///< from where the body is watched; Sigma° (Fuehrung), marked by a ring
struct Body {};      ///< fixed in the rigid body, origin O'; Sigma*, marked by a star

/// The velocity motor (twist) of frame Of against frame From: (angular velocity; velocity of In's
/// origin).
///
/// The moment is the velocity of the point of Of that coincides with the origin of In at this
/// instant.
///
/// Source : paper 002 section 2: V' = Velocity<Body, Guide, ..>, F = Velocity<Guide, Inertial, ..>
/// Frame  : written in In, which may be any frame
/// Units  : (rad/s; m/s)
template <class Of, class From, class In, class S = double>
struct Velocity {
  Motor<S> value;

  using Frame = In;
  using Scalar = S;
  using Value = Motor<S>;
  template <class E>
  using WrittenIn = Velocity<Of, From, E, S>;
};

/// A momentum motor (momentum; angular momentum about In's origin), written in In. Robotics:
/// spatial momentum.
///
/// Source : paper 002 section 3, J = {G; J}
/// Units  : (kg m/s; kg m^2/s)
template <class In, class S = double>
struct Momentum {
  Motor<S> value;

  using Frame = In;
  using Scalar = S;
  using Value = Motor<S>;
  template <class E>
  using WrittenIn = Momentum<E, S>;
};

/// A force motor (wrench): (force; torque about In's origin), written in In.
///
/// Source : paper 002 (1), P = {P; M}
/// Units  : (N; N m)
template <class In, class S = double>
struct Force {
  Motor<S> value;

  using Frame = In;
  using Scalar = S;
  using Value = Motor<S>;
  template <class E>
  using WrittenIn = Force<E, S>;
};

/// A quantity whose type names the frame in which it is written.
template <class Q>
concept Tagged = requires {
  typename Q::Frame;
  typename Q::Value;
};

/// The bare value of a tagged quantity: the only way out of the types. Braces are the way in:
/// Force<Body>{motor}.
template <Tagged Q>
[[nodiscard]] const typename Q::Value& untagged(const Q& q) {
  return q.value;
}

namespace detail {

/// The type of the result of a legal use. An illegal use is refused in the way for which each
/// compiler prints the shortest message (tests/misuse counts the lines). For clang that is the
/// substitution that fails here. For g++ it is the static_assert in the body; the substitution
/// would print twice as many lines.
template <bool legal, class Result>
struct Checked {
  using Type = Result;
};

template <class Result>
struct Checked<false, Result> {
#ifndef __clang__
  using Type = void;
#endif
};

}  // namespace detail

/// The list of pairs that can be added. A pair that is not listed does not add; other headers
/// extend the list.
template <class A, class B>
struct Sum {
  using Type = void;
};

/// V_AB + V_BC = V_AC: velocities add along a chain of frames and in no other way.
template <class A, class B, class C, class E, class S>
struct Sum<Velocity<A, B, E, S>, Velocity<B, C, E, S>> {
  using Type = Velocity<A, C, E, S>;
};

template <class E, class S>
struct Sum<Momentum<E, S>, Momentum<E, S>> {
  using Type = Momentum<E, S>;
};

template <class E, class S>
struct Sum<Force<E, S>, Force<E, S>> {
  using Type = Force<E, S>;
};

/// The type of -Q. Only a velocity changes its type: -V_AB = V_BA.
template <class Q>
struct Negative {
  using Type = Q;
};

template <class A, class B, class E, class S>
struct Negative<Velocity<A, B, E, S>> {
  using Type = Velocity<B, A, E, S>;
};

template <Tagged A, Tagged B, class Result = typename Sum<A, B>::Type>
[[nodiscard, gnu::always_inline]] inline auto operator+(const A& a, const B& b) ->
    typename detail::Checked<!std::is_void_v<Result>, Result>::Type {
  static_assert(!std::is_void_v<Result>,
                "no such sum: velocities join as V_AB + V_BC, all else adds to its own kind, and "
                "both are written in one frame");
  if constexpr (!std::is_void_v<Result>) return {a.value + b.value};
}

template <Tagged Q>
[[nodiscard, gnu::always_inline]] inline typename Negative<Q>::Type operator-(const Q& q) {
  return {-q.value};
}

/// a - b = a + (-b), so that V_AC - V_BC = V_AB.
template <Tagged A, Tagged B>
[[nodiscard, gnu::always_inline]] inline auto operator-(const A& a, const B& b) {
  using Result = typename Sum<A, typename Negative<B>::Type>::Type;
  static_assert(!std::is_void_v<Result>,
                "no such difference: velocities leave V_AC - V_BC = V_AB, all else is taken from "
                "its own kind, and both are written in one frame");
  if constexpr (!std::is_void_v<Result>) return Result{a.value - b.value};
}

/// A change of coordinates: takes components written in From to components written in To.
///
/// It rewrites a quantity and does not change its meaning: a velocity against the inertial frame
/// stays one. A sum changes the frame against which a velocity is measured; seen_from changes the
/// observer.
///
/// Source : paper 002 section 3, the step between the columns of Tafel 1
template <class To, class From, class S = double>
struct Displacement {
  Pose<S> value;

  [[nodiscard]] Displacement<From, To, S> inverse() const { return {value.inverse()}; }

  /// The position p_From, written in To.
  [[nodiscard]] Vector3<S> point(const Vector3<S>& p_From) const { return value.point(p_From); }
};

/// X_AB X_BC = X_AC.
template <class A, class B, class B2, class C, class S>
[[nodiscard, gnu::always_inline]] inline auto operator*(const Displacement<A, B, S>& a,
                                                        const Displacement<B2, C, S>& b) {
  static_assert(std::is_same_v<B, B2>, "displacements join as X_AB X_BC");
  if constexpr (std::is_same_v<B, B2>) return Displacement<A, C, S>{a.value * b.value};
}

/// The motor quantity Q, written in To. Axes and point of reduction change together.
template <class To, class From, class S, Tagged Q>
[[nodiscard, gnu::always_inline]] inline auto operator*(const Displacement<To, From, S>& X,
                                                        const Q& q) {
  constexpr bool movable = requires { typename Q::template WrittenIn<To>; };
  static_assert(std::is_same_v<typename Q::Frame, From>,
                "the quantity is not written in the frame that this displacement takes from");
  static_assert(movable, "a plain rate is tied to its moving point: make it a true_rate first");
  if constexpr (std::is_same_v<typename Q::Frame, From> && movable) {
    return typename Q::template WrittenIn<To>{X.value * q.value};
  }
}

/// The power of a force on a body that moves with velocity V:  P . v + M . u.
///
/// Units  : W
template <class E, class E2, class Of, class From, class S>
[[nodiscard, gnu::always_inline]] inline auto power(const Force<E, S>& P,
                                                    const Velocity<Of, From, E2, S>& V) ->
    typename detail::Checked<std::is_same_v<E, E2>, S>::Type {
  static_assert(std::is_same_v<E, E2>, "force and velocity are not written in one frame");
  if constexpr (std::is_same_v<E, E2>) return reciprocal(P.value, V.value);
}

}  // namespace kreisel
