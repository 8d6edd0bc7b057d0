#include <dynamics/tree/constraint/numbers.hpp>
#include <dynamics/tree/constraint/point.hpp>
#include <dynamics/tree/constraint/row.hpp>
#include <dynamics/tree/description.hpp>

namespace kreisel::constraint {

using detail::AlongOne;
using detail::ConstraintNumbers;
using detail::ConstraintRow;
using detail::cross;
using detail::dot;
using detail::SeenMotion;
template <class S>
using Rows = std::vector<ConstraintRow<S>>;

void Point::list(ConstraintNumbers& numbers) const {
  numbers.add(at_first);
  numbers.add(at_second);
}

template <class S>
void Point::add_rows(const SeenMotion<S>& m, Rows<S>& rows) const {
  for (int k = 0; k < 3; ++k) {
    rows.push_back(point_in_plane(m, at_second, at_first, Vector3<double>::Unit(k)));
  }
}

Vector3<double> Point::point_of_second(const SeenMotion<>& /*m*/) const { return at_second; }

void Distance::list(ConstraintNumbers& numbers) const {
  Point::list(numbers);
  numbers.add_length(length);
}

template <class S>
void Distance::add_rows(const SeenMotion<S>& m, Rows<S>& rows) const {
  const Vector3<S> arm = m.turned(at_second);
  const Vector3<S> end = m.x + arm;
  const Vector3<S> r = end - at_first.cast<S>();
  const S l = detail::length(r);
  const Vector3<S> n = r / l;
  const Vector3<S> dr = m.velocity(arm);
  const S along = dot(n, dr);
  rows.push_back({{n, cross(end, n)},
                  S(l - length),
                  S(dot(n, m.acceleration(arm)) + (dot(dr, dr) - along * along) / l),
                  detail::extent(m.x) + at_second.norm() + at_first.norm() + length});
}

template void Point::add_rows(const SeenMotion<double>&, Rows<double>&) const;
template void Point::add_rows(const SeenMotion<AlongOne>&, Rows<AlongOne>&) const;
template void Distance::add_rows(const SeenMotion<double>&, Rows<double>&) const;
template void Distance::add_rows(const SeenMotion<AlongOne>&, Rows<AlongOne>&) const;

}  // namespace kreisel::constraint
