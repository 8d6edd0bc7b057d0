#pragma once

#include <cmath>
#include <limits>

#include <motor/error.hpp>
#include <motor/motor.hpp>

namespace kreisel {

/// The kinds of screw that a motor can be.
enum class ScrewKind {
  zero,    ///< resultant and moment vanish: no axis, no direction
  couple,  ///< the resultant vanishes, the moment is the same everywhere; pitch infinite
  line,    ///< the moment on the axis vanishes: rotation about a line, single force; pitch 0
  general  ///< resultant and moment on the axis are parallel and both there
};

/// A screw: a line, a pitch along it and an intensity.
///
///   general, line : motor = (intensity d; intensity (pitch d + point x d))
///   couple        : motor = (0; intensity d), pitch infinite, point zero
///   zero          : intensity 0, direction zero, pitch 0
///
/// Source : von Mises 1924, "Schraube"; paper 002 (11), "physikalische Bausteine" of a motor
/// Frame  : axes and point of reduction of the motor
/// Units  : [intensity] = [resultant] ([moment] for a couple), [pitch] = metre (per radian)
template <class S = double>
struct Screw {
  ScrewKind kind = ScrewKind::zero;
  Vector3<S> direction = Vector3<S>::Zero();  ///< unit vector along the axis
  Vector3<S> point = Vector3<S>::Zero();  ///< foot of the perpendicular from the reduction point
  S intensity = S(0);                     ///< >= 0
  S pitch = S(0);                         ///< signed, right-handed positive
};

namespace detail {

/// The largest absolute component: the scale that keeps squares from overflow and underflow.
template <class S>
[[nodiscard]] S largest(const Vector3<S>& v) {
  return v.cwiseAbs().maxCoeff();
}

}  // namespace detail

/// The opening u of a motor: its resultant, the same at every point.
///
/// Source : paper 002 (11), "Oeffnung"
template <class S>
[[nodiscard]] Vector3<S> opening(const Motor<S>& a) {
  return a.resultant;
}

/// The length v_n of a motor: its moment on its axis, v_n = u (u . v_0)/(u . u); for a couple v_0.
///
/// With r_0 drawn from the point of reduction to any point of the axis:  v_0 = v_n + r_0 x u.
///
/// Source : paper 002 (11), "Laenge"
/// Error  : <= 8u |v_0|, u = 2^-53; squares of the resultant neither overflow nor underflow
template <class S>
[[nodiscard]] Vector3<S> length(const Motor<S>& a) {
  const S scale = detail::largest(a.resultant);
  if (scale == S(0)) return a.moment;
  const Vector3<S> u = a.resultant / scale;
  return u * (u.dot(a.moment) / u.squaredNorm());
}

/// The point of the axis nearest to the point of reduction:  r_0 = u x v_0 / (u . u).
///
/// Throws : InvalidInput for a couple or the zero motor, which have no axis
template <class S>
[[nodiscard]] Vector3<S> axis_point(const Motor<S>& a) {
  const S scale = detail::largest(a.resultant);
  if (scale == S(0)) throw InvalidInput("axis_point: a motor without resultant has no axis");
  const Vector3<S> u = a.resultant / scale;
  return u.cross(a.moment / scale) / u.squaredNorm();
}

/// The pitch  p = u . v_0 / (u . u); infinite for a couple.
///
/// Throws : InvalidInput for the zero motor, which has none
template <class S>
[[nodiscard]] S pitch(const Motor<S>& a) {
  const S scale = detail::largest(a.resultant);
  if (scale == S(0)) {
    if (a.moment == Vector3<S>::Zero()) throw InvalidInput("pitch: the zero motor has no pitch");
    return std::numeric_limits<S>::infinity();
  }
  const Vector3<S> u = a.resultant / scale;
  return u.dot(a.moment / scale) / u.squaredNorm();
}

/// The screw of a motor. Exact zeros decide the kind; nothing is rounded to a kind.
///
/// Source : paper 002 (11)
/// Error  : motor(screw(a)) agrees with a to 8u |a| in each half (tests/motor/screw.cpp)
template <class S>
[[nodiscard]] Screw<S> screw(const Motor<S>& a) {
  using std::sqrt;
  Screw<S> s;
  const auto take = [&s](const Vector3<S>& v) {
    const S scale = detail::largest(v);
    const Vector3<S> scaled = v / scale;
    const S norm = sqrt(scaled.squaredNorm());
    s.intensity = scale * norm;
    s.direction = scaled / norm;
  };
  if (a.resultant == Vector3<S>::Zero()) {
    if (a.moment == Vector3<S>::Zero()) return s;
    s.kind = ScrewKind::couple;
    take(a.moment);
    s.pitch = std::numeric_limits<S>::infinity();
    return s;
  }
  take(a.resultant);
  s.point = axis_point(a);
  s.pitch = pitch(a);
  s.kind = s.pitch == S(0) ? ScrewKind::line : ScrewKind::general;
  return s;
}

/// The motor of a screw, reduced at the origin of screw.point.
template <class S>
[[nodiscard]] Motor<S> motor(const Screw<S>& s) {
  const Vector3<S> resultant = s.intensity * s.direction;
  if (s.kind == ScrewKind::zero || s.kind == ScrewKind::couple) {
    return {Vector3<S>::Zero(), resultant};
  }
  return {resultant, s.pitch * resultant + s.point.cross(resultant)};
}

}  // namespace kreisel
