#pragma once

#include <Eigen/Geometry>

#include <vector>

#include <dynamics/tree/constraint/point.hpp>

/// Joints that close a loop.

namespace kreisel::constraint {

/// A hinge: two points coincide, and an axis of each body.
///
/// Units  : metre; points and axes on the own axes of each body
struct Revolute : Point {
  Vector3<double> axis_of_first = Vector3<double>::UnitZ();
  Vector3<double> axis_of_second = Vector3<double>::UnitZ();

  void list(detail::ConstraintNumbers& numbers) const;
  template <class S>
  void add_rows(const detail::SeenMotion<S>& m, std::vector<detail::ConstraintRow<S>>& rows) const;
};

/// A Cardan joint: two points coincide, and an axis of the second body is perpendicular to one of
/// the first.
///
/// Units  : metre; points and axes on the own axes of each body
struct Universal : Point {
  Vector3<double> axis_of_first = Vector3<double>::UnitX();
  Vector3<double> axis_of_second = Vector3<double>::UnitY();

  void list(detail::ConstraintNumbers& numbers) const;
  template <class S>
  void add_rows(const detail::SeenMotion<S>& m, std::vector<detail::ConstraintRow<S>>& rows) const;
};

/// A weld: two points coincide, and the second body keeps its attitude to the first.
///
/// Units  : metre, own axes of each body
struct Fixed : Point {
  Eigen::Quaterniond attitude = Eigen::Quaterniond::Identity();  ///< from second to first axes

  void list(detail::ConstraintNumbers& numbers) const;
  template <class S>
  void add_rows(const detail::SeenMotion<S>& m, std::vector<detail::ConstraintRow<S>>& rows) const;
};

/// A slide: the point of the second body moves along a line through that of the first. The second
/// body keeps its attitude to the first.
///
/// Units  : metre, own axes of each body
struct Prismatic : Point {
  Vector3<double> axis = Vector3<double>::UnitX();               ///< on the first body's axes
  Eigen::Quaterniond attitude = Eigen::Quaterniond::Identity();  ///< from second to first axes

  void list(detail::ConstraintNumbers& numbers) const;
  template <class S>
  void add_rows(const detail::SeenMotion<S>& m, std::vector<detail::ConstraintRow<S>>& rows) const;
};

}  // namespace kreisel::constraint
