#pragma once

#include <optional>
#include <utility>

#include <dynamics/tree/constraint/numbers.hpp>
#include <dynamics/tree/constraint/row.hpp>

namespace kreisel::constraint {

/// A wheel, a disc or a ball rolls on a plane of the first body without slipping.
///
/// With the plane's unit normal n and the axis a of a wheel, the contact is at the distance s from
/// the centre:
///
///   ball: s = -radius n;   wheel: s = -radius u/|u| - tube n,   u = n - (n.a) a
///
/// The contact lies in the plane, and the body's velocity there is 0.
///
/// Units  : metre; plane on the first body's axes, centre and axis on the second's
struct Rolling {
  static constexpr const char* kind = "rolling";

  Vector3<double> centre = Vector3<double>::Zero();
  double radius = 0;                                ///< of a wheel: to the middle of its rim
  std::optional<Vector3<double>> axis = {};         ///< none: a ball
  double tube = 0;                                  ///< radius of the rim's cross-section
  Vector3<double> point = Vector3<double>::Zero();  ///< of the plane
  Vector3<double> normal = Vector3<double>::UnitZ();

  void list(detail::ConstraintNumbers& n) const {
    n.add(centre);
    n.add_length(radius);
    if (axis) n.add_direction(*axis);
    if (tube != 0) n.add_length(tube);
    n.add(point);
    n.add_direction(normal);
  }

  /// The contact, about which the reaction is told, on the second body's axes.
  [[nodiscard]] Vector3<double> point_of_second(const detail::SeenMotion<>& m) const {
    return centre + m.R.transpose() * reach(m).first;
  }

  template <class S, class Take>
  void rows(const detail::SeenMotion<S>& m, const Take& take) const {
    const Vector3<double> up = normal.normalized();
    const Vector3<S>& n = up.template cast<S>();
    const auto [s, ds] = reach(m);
    const Vector3<S> arm = m.turned(centre);
    const Vector3<S> contact = m.x + arm + s;
    // The rate of the material velocity v + w x (arm + s) at the contact; s moves in the body.
    const Vector3<S> change = m.a + detail::cross(m.dw, Vector3<S>(arm + s)) +
                              detail::cross(m.w, Vector3<S>(detail::cross(m.w, arm) + ds));
    const detail::Across across(up);
    const S height = n.dot(contact - point.template cast<S>());
    const S size = m.x.norm() + arm.norm() + S(radius + tube + point.norm());
    take(row(contact, n, height, change, size));
    take(row(contact, Vector3<S>(across.first.template cast<S>()), S(0), change, size));
    take(row(contact, Vector3<S>(across.second.template cast<S>()), S(0), change, size));
  }

 private:
  /// The vector s from the centre to the contact, and its rate, on the first body's axes.
  template <class S>
  [[nodiscard]] std::pair<Vector3<S>, Vector3<S>> reach(const detail::SeenMotion<S>& m) const {
    const Vector3<S> n = normal.normalized().template cast<S>();
    if (!axis) return {S(-radius) * n, Vector3<S>::Zero()};
    const Vector3<S> a = m.turned(axis->normalized());
    const Vector3<S> da = detail::cross(m.w, a);
    const Vector3<S> u = n - n.dot(a) * a;
    const Vector3<S> du = -(n.dot(da) * a + n.dot(a) * da);
    const S length = u.norm();
    const Vector3<S> e = u / length;
    return {S(-radius) * e - S(tube) * n, S(-radius) * (du - e.dot(du) * e) / length};
  }

  template <class S>
  [[nodiscard]] static detail::ConstraintRow<S> row(const Vector3<S>& contact, const Vector3<S>& e,
                                                    const S& gap, const Vector3<S>& change,
                                                    const S& size) {
    return {{e, detail::cross(contact, e)}, gap, e.dot(change), size};
  }
};

/// A skate or a knife edge: a point of the second body has no velocity along `direction`, which is
/// across the blade.
///
/// Units  : metre; point and direction on the second body's axes
struct Blade {
  static constexpr const char* kind = "blade";

  Vector3<double> at = Vector3<double>::Zero();
  Vector3<double> direction = Vector3<double>::UnitY();

  void list(detail::ConstraintNumbers& n) const {
    n.add(at);
    n.add_direction(direction);
  }

  /// The point of the second body about which its reaction is told.
  [[nodiscard]] Vector3<double> point_of_second(const detail::SeenMotion<>& /*m*/) const {
    return at;
  }

  template <class S, class Take>
  void rows(const detail::SeenMotion<S>& m, const Take& take) const {
    const Vector3<S> arm = m.turned(at);
    const Vector3<S> e = m.turned(direction.normalized());
    take(detail::ConstraintRow<S>{
        {e, detail::cross(Vector3<S>(m.x + arm), e)},
        S(0),
        e.dot(m.acceleration(arm)) + detail::cross(m.w, e).dot(m.velocity(arm)),
        S(1)});
  }
};

}  // namespace kreisel::constraint
