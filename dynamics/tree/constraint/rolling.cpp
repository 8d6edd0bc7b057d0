#include <utility>

#include <dynamics/tree/constraint/numbers.hpp>
#include <dynamics/tree/constraint/rolling.hpp>
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

namespace {

/// The vector s from the centre to the contact, and its rate, on the first body's axes.
template <class S>
std::pair<Vector3<S>, Vector3<S>> reach(const Rolling& wheel, const SeenMotion<S>& m) {
  const Vector3<S> n = wheel.normal.normalized().cast<S>();
  const S radius(wheel.radius);
  if (!wheel.axis) return {-radius * n, Vector3<S>::Zero()};
  const Vector3<S> a = m.turned(wheel.axis->normalized());
  const Vector3<S> da = cross(m.w, a);
  const S along = dot(n, a);
  const Vector3<S> u = n - along * a;
  const Vector3<S> du = -(S(dot(n, da)) * a + along * da);
  const S size = detail::length(u);
  const Vector3<S> e = u / size;
  const Vector3<S> turning = du - S(dot(e, du)) * e;
  return {-radius * e - S(wheel.tube) * n, -S(radius / size) * turning};
}

}  // namespace

void Rolling::list(ConstraintNumbers& numbers) const {
  numbers.add(centre);
  numbers.add_length(radius);
  if (axis) numbers.add_direction(*axis);
  if (tube != 0) numbers.add_length(tube);
  numbers.add(point);
  numbers.add_direction(normal);
}

template <class S>
void Rolling::add_rows(const SeenMotion<S>& m, Rows<S>& rows) const {
  const auto [s, ds] = reach(*this, m);
  const Vector3<S> arm = m.turned(centre);
  const Vector3<S> to_contact = arm + s;
  const Vector3<S> contact = m.x + to_contact;
  // The rate of the material velocity v + w x (arm + s) at the contact; s moves in the body.
  const Vector3<S> moved = cross(m.w, arm) + ds;
  const Vector3<S> change = m.a + cross(m.dw, to_contact) + cross(m.w, moved);
  const double size = detail::extent(m.x) + centre.norm() + radius + tube + point.norm();
  const Vector3<double> n = normal.normalized();
  const detail::Across across(n);
  for (const Vector3<double>& direction : {n, across.first, across.second}) {
    const Vector3<S> e = direction.cast<S>();
    rows.push_back({{e, cross(contact, e)}, S(0), dot(e, change), size});
  }
  rows[rows.size() - 3].gap = dot(n.cast<S>().eval(), Vector3<S>(contact - point.cast<S>()));
}

Vector3<double> Rolling::point_of_second(const SeenMotion<>& m) const {
  return centre + m.R.transpose() * reach(*this, m).first;
}

void Blade::list(ConstraintNumbers& numbers) const {
  numbers.add(at);
  numbers.add_direction(direction);
}

template <class S>
void Blade::add_rows(const SeenMotion<S>& m, Rows<S>& rows) const {
  const Vector3<S> arm = m.turned(at);
  const Vector3<S> e = m.turned(direction.normalized());
  const S change = dot(e, m.acceleration(arm)) + dot(cross(m.w, e), m.velocity(arm));
  rows.push_back({{e, cross(m.place(at), e)}, S(0), change, 1});
}

Vector3<double> Blade::point_of_second(const SeenMotion<>& /*m*/) const { return at; }

template void Rolling::add_rows(const SeenMotion<double>&, Rows<double>&) const;
template void Rolling::add_rows(const SeenMotion<AlongOne>&, Rows<AlongOne>&) const;
template void Blade::add_rows(const SeenMotion<double>&, Rows<double>&) const;
template void Blade::add_rows(const SeenMotion<AlongOne>&, Rows<AlongOne>&) const;

}  // namespace kreisel::constraint
