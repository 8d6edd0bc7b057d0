#pragma once

#include <dynamics/tree/constraint/numbers.hpp>
#include <dynamics/tree/constraint/row.hpp>

namespace kreisel::constraint {

/// A point of each body: both coincide.
///
/// Units  : metre, own axes of each body
struct Point {
  static constexpr const char* kind = "point";

  Vector3<double> at_first = Vector3<double>::Zero();
  Vector3<double> at_second = Vector3<double>::Zero();

  void list(detail::ConstraintNumbers& n) const {
    n.add(at_first);
    n.add(at_second);
  }

  /// The point of the second body about which its reaction is told.
  [[nodiscard]] Vector3<double> point_of_second(const detail::SeenMotion<>& /*m*/) const {
    return at_second;
  }

  template <class S, class Take>
  void rows(const detail::SeenMotion<S>& m, const Take& take) const {
    for (int k = 0; k < 3; ++k) {
      take(detail::point_in_plane(m, at_second, at_first, Vector3<double>::Unit(k)));
    }
  }
};

/// Two points keep a distance l > 0: a rod with a ball joint at each end.
///
///   |r| = l,   |r|'' = n.r'' + (r'^2 - (n.r')^2)/|r|,   n = r/|r|
struct Distance {
  static constexpr const char* kind = "distance";

  Vector3<double> at_first = Vector3<double>::Zero();
  Vector3<double> at_second = Vector3<double>::Zero();
  double length = 0;

  void list(detail::ConstraintNumbers& n) const {
    n.add(at_first);
    n.add(at_second);
    n.add_length(length);
  }

  /// The point of the second body about which its reaction is told.
  [[nodiscard]] Vector3<double> point_of_second(const detail::SeenMotion<>& /*m*/) const {
    return at_second;
  }

  template <class S, class Take>
  void rows(const detail::SeenMotion<S>& m, const Take& take) const {
    const Vector3<S> arm = m.turned(at_second);
    const Vector3<S> end = m.x + arm;
    const Vector3<S> r = end - at_first.template cast<S>();
    const S l = r.norm();
    const Vector3<S> n = r / l;
    const Vector3<S> dr = m.velocity(arm);
    const S along = n.dot(dr);
    take(detail::ConstraintRow<S>{
        {n, detail::cross(end, n)},
        l - length,
        n.dot(m.acceleration(arm)) + (dr.squaredNorm() - along * along) / l,
        m.x.norm() + arm.norm() + S(at_first.norm() + length)});
  }
};

}  // namespace kreisel::constraint
