#pragma once

#include <cmath>

#include <motor/motor.hpp>

namespace kreisel::detail {

/// The motion of a body as another one sees it, on the axes of that other one.
template <class S = double>
struct SeenMotion {
  Matrix3<S> R = Matrix3<S>::Identity();  ///< from the body's axes
  Vector3<S> x = Vector3<S>::Zero();      ///< of the origin, as v and a are
  Vector3<S> w = Vector3<S>::Zero();
  Vector3<S> v = Vector3<S>::Zero();
  Vector3<S> dw = Vector3<S>::Zero();
  Vector3<S> a = Vector3<S>::Zero();

  /// A vector or a point of the body.
  [[nodiscard]] Vector3<S> turned(const Vector3<double>& of_body) const {
    return R * of_body.template cast<S>();
  }
  [[nodiscard]] Vector3<S> place(const Vector3<double>& of_body) const {
    return x + turned(of_body);
  }

  /// The velocity of what is at a distance r from the origin and moves with the body.
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
  S gap = S(0);           ///< what is 0 if the condition is fulfilled; 0 for one of velocities
  S acceleration = S(0);  ///< the second derivative of the gap, or the first of the velocity
  S size = S(1);          ///< of the terms of the gap

  [[nodiscard]] S rate(const SeenMotion<S>& m) const {
    return direction.moment.dot(m.w) + direction.resultant.dot(m.v - cross(m.w, m.x));
  }
};

/// The point p of the second body lies in the plane through c with the normal e, both of the first.
template <class S>
[[nodiscard]] ConstraintRow<S> point_in_plane(const SeenMotion<S>& m, const Vector3<double>& p,
                                              const Vector3<double>& c, const Vector3<double>& e) {
  const Vector3<S> arm = m.turned(p);
  const Vector3<S> r = m.x + arm;
  const Vector3<S>& normal = e.template cast<S>();
  return {{normal, cross(r, normal)},
          normal.dot(r - c.template cast<S>()),
          normal.dot(m.acceleration(arm)),
          m.x.norm() + arm.norm() + S(c.norm())};
}

/// The direction b of the second body is perpendicular to e of the first.
template <class S>
[[nodiscard]] ConstraintRow<S> perpendicular(const SeenMotion<S>& m, const Vector3<double>& b,
                                             const Vector3<double>& e) {
  const Vector3<S> turned = m.turned(b);
  const Vector3<S>& fixed = e.template cast<S>();
  return {{Vector3<S>::Zero(), cross(turned, fixed)},
          fixed.dot(turned),
          fixed.dot(cross(m.dw, turned) + cross(m.w, cross(m.w, turned))),
          S(b.norm() * e.norm())};
}

/// Two unit vectors that make a right-handed system with the third, `axis`.
struct Across {
  explicit Across(const Vector3<double>& axis) {
    const Vector3<double> n = axis.normalized();
    int least = 0;
    n.cwiseAbs().minCoeff(&least);
    first = n.cross(Vector3<double>::Unit(least)).normalized();
    second = n.cross(first);
  }

  Vector3<double> first;
  Vector3<double> second;
};

}  // namespace kreisel::detail
