#pragma once

#include <optional>
#include <vector>

#include <dynamics/tree/constraint/point.hpp>

/// Contacts that restrict velocities.

namespace kreisel::constraint {

/// A wheel, a disc or a ball rolls on a plane of the first body without slipping.
///
/// With the plane's unit normal n and the axis a of a wheel, the contact is at the distance s from
/// the centre:
///
///   ball: s = -radius n;   wheel: s = -radius u/|u| - tube n,   u = n - (n.a) a
///
/// The contact lies in the plane. The body's velocity there is 0. A wheel whose axis is along n has no
/// single contact.
///
/// Units  : metre; plane on the first body's axes, centre and axis on the second's
struct Rolling {
  Vector3<double> centre = Vector3<double>::Zero();
  double radius = 0;                                ///< of a wheel: to the middle of its rim
  std::optional<Vector3<double>> axis = {};         ///< none: a ball
  double tube = 0;                                  ///< radius of the rim's cross-section
  Vector3<double> point = Vector3<double>::Zero();  ///< of the plane
  Vector3<double> normal = Vector3<double>::UnitZ();

  void list(detail::ConstraintNumbers& numbers) const;
  template <class S>
  void add_rows(const detail::SeenMotion<S>& m, std::vector<detail::ConstraintRow<S>>& rows) const;
  /// The contact.
  [[nodiscard]] Vector3<double> point_of_second(const detail::SeenMotion<double>& m) const;
};

/// A skate or a knife edge: a point of the second body has no velocity along `direction`, which is
/// across the blade.
///
/// Units  : metre; point and direction on the second body's axes
struct Blade {
  Vector3<double> at = Vector3<double>::Zero();
  Vector3<double> direction = Vector3<double>::UnitY();

  void list(detail::ConstraintNumbers& numbers) const;
  template <class S>
  void add_rows(const detail::SeenMotion<S>& m, std::vector<detail::ConstraintRow<S>>& rows) const;
  [[nodiscard]] Vector3<double> point_of_second(const detail::SeenMotion<double>& m) const;
};

}  // namespace kreisel::constraint
