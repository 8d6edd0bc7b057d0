#include <dynamics/tree/constraint/joint.hpp>
#include <dynamics/tree/constraint/numbers.hpp>
#include <dynamics/tree/constraint/row.hpp>
#include <dynamics/tree/description.hpp>

namespace kreisel::constraint {

using detail::AlongOne;
using detail::ConstraintNumbers;
using detail::ConstraintRow;
using detail::SeenMotion;
template <class S>
using Rows = std::vector<ConstraintRow<S>>;

namespace {

/// The attitude of the second body, from its axes to the first's, is kept.
template <class S>
void keep_attitude(const SeenMotion<S>& m, const Eigen::Quaterniond& attitude, Rows<S>& rows) {
  const Matrix3<double> turn = attitude.normalized().toRotationMatrix();
  for (int k = 0; k < 3; ++k) {
    const Vector3<double> next = turn.row((k + 1) % 3);
    rows.push_back(perpendicular(m, next, Vector3<double>::Unit(k)));
  }
}

}  // namespace

void Revolute::list(ConstraintNumbers& numbers) const {
  Point::list(numbers);
  numbers.add_direction(axis_of_first);
  numbers.add_direction(axis_of_second);
}

template <class S>
void Revolute::add_rows(const SeenMotion<S>& m, Rows<S>& rows) const {
  Point::add_rows(m, rows);
  const detail::Across across(axis_of_first);
  const Vector3<double> axis = axis_of_second.normalized();
  rows.push_back(perpendicular(m, axis, across.first));
  rows.push_back(perpendicular(m, axis, across.second));
}

void Universal::list(ConstraintNumbers& numbers) const {
  Point::list(numbers);
  numbers.add_direction(axis_of_first);
  numbers.add_direction(axis_of_second);
}

template <class S>
void Universal::add_rows(const SeenMotion<S>& m, Rows<S>& rows) const {
  Point::add_rows(m, rows);
  rows.push_back(perpendicular(m, axis_of_second.normalized(), axis_of_first.normalized()));
}

void Fixed::list(ConstraintNumbers& numbers) const {
  Point::list(numbers);
  numbers.add_attitude(attitude);
}

template <class S>
void Fixed::add_rows(const SeenMotion<S>& m, Rows<S>& rows) const {
  Point::add_rows(m, rows);
  keep_attitude(m, attitude, rows);
}

void Prismatic::list(ConstraintNumbers& numbers) const {
  Point::list(numbers);
  numbers.add_direction(axis);
  numbers.add_attitude(attitude);
}

template <class S>
void Prismatic::add_rows(const SeenMotion<S>& m, Rows<S>& rows) const {
  const detail::Across across(axis);
  rows.push_back(point_in_plane(m, at_second, at_first, across.first));
  rows.push_back(point_in_plane(m, at_second, at_first, across.second));
  keep_attitude(m, attitude, rows);
}

template void Revolute::add_rows(const SeenMotion<double>&, Rows<double>&) const;
template void Revolute::add_rows(const SeenMotion<AlongOne>&, Rows<AlongOne>&) const;
template void Universal::add_rows(const SeenMotion<double>&, Rows<double>&) const;
template void Universal::add_rows(const SeenMotion<AlongOne>&, Rows<AlongOne>&) const;
template void Fixed::add_rows(const SeenMotion<double>&, Rows<double>&) const;
template void Fixed::add_rows(const SeenMotion<AlongOne>&, Rows<AlongOne>&) const;
template void Prismatic::add_rows(const SeenMotion<double>&, Rows<double>&) const;
template void Prismatic::add_rows(const SeenMotion<AlongOne>&, Rows<AlongOne>&) const;

}  // namespace kreisel::constraint
