#pragma once

#include <vector>

#include <motor/motor.hpp>

namespace kreisel {

namespace detail {

struct ConstraintNumbers;
template <class S>
struct ConstraintRow;
template <class S>
struct SeenMotion;

}  // namespace detail

/// The kinds of constraints. Each lists its numbers for checks. It adds its conditions in double or in
/// dual numbers (detail::AlongOne). Its reaction is about a point of the second body.
namespace constraint {

/// A point of each body: both coincide.
///
///   r = x + R at_second - at_first = 0
///
/// Units  : metre, own axes of each body
struct Point {
  Vector3<double> at_first = Vector3<double>::Zero();
  Vector3<double> at_second = Vector3<double>::Zero();

  void list(detail::ConstraintNumbers& numbers) const;
  template <class S>
  void add_rows(const detail::SeenMotion<S>& m, std::vector<detail::ConstraintRow<S>>& rows) const;
  [[nodiscard]] Vector3<double> point_of_second(const detail::SeenMotion<double>& m) const;
};

/// Two points keep a distance l > 0: a rod with a ball joint at each end.
///
///   |r| = l,   |r|'' = n.r'' + (r'^2 - (n.r')^2)/|r|,   n = r/|r|
///
/// Units  : metre, own axes of each body
struct Distance : Point {
  double length = 0;

  void list(detail::ConstraintNumbers& numbers) const;
  template <class S>
  void add_rows(const detail::SeenMotion<S>& m, std::vector<detail::ConstraintRow<S>>& rows) const;
};

}  // namespace constraint

}  // namespace kreisel
