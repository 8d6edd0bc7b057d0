#pragma once

#include <type_traits>

#include <motor/displacement.hpp>
#include <motor/motor.hpp>

namespace kreisel {

/// Frames are empty tags; any empty struct of the user's may be one. A frame has axes and an
/// origin: "written in E" means components on E's axes AND reduction at E's origin.
///
/// Tags know no time: two values in one frame taken at different times type-check together. Do not
/// keep tagged values across a time step.
struct Inertial {};  ///< where Newton's law holds; paper 002: Sigma', marked by a dot
struct Guide {};     ///< from where the body is watched; Sigma° (Fuehrung), marked by a ring
struct Body {};      ///< fixed in the rigid body, origin O'; Sigma*, marked by a star

/// The velocity motor (angular velocity; velocity of In's origin) of frame Of against frame From.
///
/// The moment is the velocity of that point of Of which now coincides with the origin of In.
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

/// A momentum motor (momentum; angular momentum about In's origin), written in In.
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

/// A force motor (force; torque about In's origin), written in In.
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

/// A quantity whose type tells in which frame it is written.
template <class Q>
concept Tagged = requires {
  typename Q::Frame;
  typename Q::Value;
};

/// The way out of the types: the bare value. The way in is braces, Force<Body>{motor}.
template <Tagged Q>
[[nodiscard]] const typename Q::Value& untagged(const Q& q) {
  return q.value;
}

namespace detail {

/// The type of the result of a legal use. An illegal one is refused in the way of which each
/// compiler speaks most briefly: clang by the substitution that fails here; g++, to whom that is
/// worth twice as many lines, by the static_assert in the body (tests/misuse counts them).
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

/// What adds to what. A pair that is not listed does not add; other headers list theirs.
template <class A, class B>
struct Sum {
  using Type = void;
};

/// V_AB + V_BC = V_AC: velocities join along a chain of frames and in no other way.
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

/// The type of -Q; only a velocity changes its name: -V_AB = V_BA.
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
/// It rewrites a quantity and does not change what it is: a velocity against the inertial frame
/// stays one. What a velocity is measured against changes by a sum, an observer by seen_from.
///
/// Source : paper 002 section 3, the step between the columns of Tafel 1
template <class To, class From, class S = double>
struct Displacement {
  Pose<S> value;

  [[nodiscard]] Displacement<From, To, S> inverse() const { return {value.inverse()}; }

  /// A position written in From, written in To.
  [[nodiscard]] Vector3<S> point(const Vector3<S>& p_From) const { return value.point(p_From); }
};

/// X_AB X_BC = X_AC.
template <class A, class B, class B2, class C, class S>
[[nodiscard, gnu::always_inline]] inline auto operator*(const Displacement<A, B, S>& a,
                                                        const Displacement<B2, C, S>& b) {
  static_assert(std::is_same_v<B, B2>, "displacements join as X_AB X_BC");
  if constexpr (std::is_same_v<B, B2>) return Displacement<A, C, S>{a.value * b.value};
}

/// Any motor quantity written in From, written in To. Axes and point of reduction change together.
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

/// The power of a force on what moves with velocity V:  P . v + M . u.
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
