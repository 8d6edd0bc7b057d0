#pragma once

#include <Eigen/Geometry>

#include <dynamics/tree/constraint/point.hpp>

/// Joints that close a loop.

namespace kreisel::constraint {

/// A hinge: two points coincide, and an axis of each body.
///
/// Units  : metre; points and axes on the own axes of each body
struct Revolute {
  static constexpr const char* kind = "revolute";

  Point centre = {};
  Vector3<double> axis_of_first = Vector3<double>::UnitZ();
  Vector3<double> axis_of_second = Vector3<double>::UnitZ();

  void list(detail::ConstraintNumbers& n) const {
    centre.list(n);
    n.add_direction(axis_of_first);
    n.add_direction(axis_of_second);
  }

  /// The point of the second body about which its reaction is told.
  [[nodiscard]] Vector3<double> point_of_second(const detail::SeenMotion<>& /*m*/) const {
    return centre.at_second;
  }

  template <class S, class Take>
  void rows(const detail::SeenMotion<S>& m, const Take& take) const {
    centre.rows(m, take);
    const detail::Across across(axis_of_first);
    const Vector3<double> axis = axis_of_second.normalized();
    take(detail::perpendicular(m, axis, across.first));
    take(detail::perpendicular(m, axis, across.second));
  }
};

/// A Cardan joint: two points coincide, and an axis of the second body is perpendicular to one of
/// the first.
struct Universal {
  static constexpr const char* kind = "universal";

  Point centre = {};
  Vector3<double> axis_of_first = Vector3<double>::UnitX();
  Vector3<double> axis_of_second = Vector3<double>::UnitY();

  void list(detail::ConstraintNumbers& n) const {
    centre.list(n);
    n.add_direction(axis_of_first);
    n.add_direction(axis_of_second);
  }

  /// The point of the second body about which its reaction is told.
  [[nodiscard]] Vector3<double> point_of_second(const detail::SeenMotion<>& /*m*/) const {
    return centre.at_second;
  }

  template <class S, class Take>
  void rows(const detail::SeenMotion<S>& m, const Take& take) const {
    centre.rows(m, take);
    take(detail::perpendicular(m, axis_of_second.normalized(), axis_of_first.normalized()));
  }
};

/// The second body keeps its attitude to the first.
struct SameAttitude {
  Eigen::Quaterniond attitude = Eigen::Quaterniond::Identity();  ///< from second to first axes

  void list(detail::ConstraintNumbers& n) const { n.add_attitude(attitude); }

  template <class S, class Take>
  void rows(const detail::SeenMotion<S>& m, const Take& take) const {
    const Matrix3<double> turn = attitude.normalized().toRotationMatrix();
    for (int k = 0; k < 3; ++k) {
      take(detail::perpendicular(m, Vector3<double>(turn.row((k + 1) % 3)),
                                 Vector3<double>::Unit(k)));
    }
  }
};

/// A weld: two points coincide, and the attitude is kept.
struct Fixed {
  static constexpr const char* kind = "fixed";

  Point centre = {};
  SameAttitude attitude = {};

  void list(detail::ConstraintNumbers& n) const {
    centre.list(n);
    attitude.list(n);
  }

  /// The point of the second body about which its reaction is told.
  [[nodiscard]] Vector3<double> point_of_second(const detail::SeenMotion<>& /*m*/) const {
    return centre.at_second;
  }

  template <class S, class Take>
  void rows(const detail::SeenMotion<S>& m, const Take& take) const {
    centre.rows(m, take);
    attitude.rows(m, take);
  }
};

/// A slide: a point of the second body moves along a line of the first, and the attitude is kept.
struct Prismatic {
  static constexpr const char* kind = "prismatic";

  Point centre = {};
  Vector3<double> axis = Vector3<double>::UnitX();  ///< on the first body's axes
  SameAttitude attitude = {};

  void list(detail::ConstraintNumbers& n) const {
    centre.list(n);
    n.add_direction(axis);
    attitude.list(n);
  }

  /// The point of the second body about which its reaction is told.
  [[nodiscard]] Vector3<double> point_of_second(const detail::SeenMotion<>& /*m*/) const {
    return centre.at_second;
  }

  template <class S, class Take>
  void rows(const detail::SeenMotion<S>& m, const Take& take) const {
    const detail::Across across(axis);
    take(detail::point_in_plane(m, centre.at_second, centre.at_first, across.first));
    take(detail::point_in_plane(m, centre.at_second, centre.at_first, across.second));
    attitude.rows(m, take);
  }
};

}  // namespace kreisel::constraint
