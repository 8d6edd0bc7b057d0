#pragma once

#include <cmath>

#include <dynamics/inertia.hpp>
#include <dynamics/tree/motion.hpp>
#include <motor/motor.hpp>

namespace kreisel::detail {

/// The length of a vector, without derivatives.
template <class S>
[[nodiscard]] double extent(const Vector3<S>& v) {
  return Vector3<double>(number_in(v[0]), number_in(v[1]), number_in(v[2])).norm();
}

/// The length of a vector that is not 0.
template <class S>
[[nodiscard]] S length(const Vector3<S>& v) {
  using std::sqrt;
  return sqrt(S(dot(v, v)));
}

/// The motion of a body as another one sees it, on the axes of that other one.
template <class S = double>
struct SeenMotion {
  Matrix3<S> R = Matrix3<S>::Identity();  ///< from the body's axes
  Vector3<S> x = Vector3<S>::Zero();      ///< of the origin, as v and a are
  Vector3<S> w = Vector3<S>::Zero();
  Vector3<S> v = Vector3<S>::Zero();
  Vector3<S> dw = Vector3<S>::Zero();
  Vector3<S> a = Vector3<S>::Zero();

  /// A direction of the body, given on its axes.
  [[nodiscard]] Vector3<S> turned(const Vector3<double>& of_body) const {
    return multiply(R, of_body);
  }

  /// A point of the body, given on its axes.
  [[nodiscard]] Vector3<S> place(const Vector3<double>& of_body) const {
    return x + turned(of_body);
  }

  /// The velocity of a point of the body, at a distance r from its origin.
  [[nodiscard]] Vector3<S> velocity(const Vector3<S>& r) const { return v + cross(w, r); }

  /// The acceleration of a point of the body, at a distance r from its origin.
  [[nodiscard]] Vector3<S> acceleration(const Vector3<S>& r) const {
    return a + cross(dw, r) + cross(w, cross(w, r));
  }
};

/// One condition between two bodies.
///
/// Its rate is the power of `direction` in the seen motion. A multiplier times `direction` is
/// therefore the force by which the first body holds the second.
///
/// Frame : the axes of the first body, about its origin
template <class S = double>
struct ConstraintRow {
  Motor<S> direction = {};
  S gap = S(0);           ///< 0 if the condition is fulfilled, and for one of velocities
  S acceleration = S(0);  ///< the second derivative of the gap, or the first of the velocity
  double size = 1;        ///< of the terms of the gap

  [[nodiscard]] S rate(const SeenMotion<S>& m) const {
    const Vector3<S> at_origin = m.v - cross(m.w, m.x);
    return dot(direction.moment, m.w) + dot(direction.resultant, at_origin);
  }
};

/// The point p of the second body lies in the plane through c with the normal e, both of the first.
template <class S>
[[nodiscard]] ConstraintRow<S> point_in_plane(const SeenMotion<S>& m, const Vector3<double>& p,
                                              const Vector3<double>& c, const Vector3<double>& e) {
  const Vector3<S> normal(S(e.x()), S(e.y()), S(e.z()));
  const Vector3<S> arm = m.turned(p);
  const Vector3<S> r = m.x + arm;
  return {{normal, cross(r, normal)},
          dot(normal, Vector3<S>(r - c.cast<S>())),
          dot(normal, m.acceleration(arm)),
          extent(m.x) + p.norm() + c.norm()};
}

/// The direction b of the second body is perpendicular to e of the first.
template <class S>
[[nodiscard]] ConstraintRow<S> perpendicular(const SeenMotion<S>& m, const Vector3<double>& b,
                                             const Vector3<double>& e) {
  const Vector3<S> direction(S(e.x()), S(e.y()), S(e.z()));
  const Vector3<S> turned = m.turned(b);
  return {{Vector3<S>::Zero(), cross(turned, direction)},
          dot(direction, turned),
          dot(direction, Vector3<S>(cross(m.dw, turned) + cross(m.w, cross(m.w, turned)))),
          b.norm() * e.norm()};
}

/// Two unit vectors that make a right-handed system with the third, `axis`.
struct Across {
  explicit Across(const Vector3<double>& axis);

  Vector3<double> first;
  Vector3<double> second;
};

}  // namespace kreisel::detail
