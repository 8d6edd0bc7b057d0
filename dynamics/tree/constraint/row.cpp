#include <dynamics/tree/constraint/row.hpp>

namespace kreisel::detail {

Across::Across(const Vector3<double>& axis) {
  const Vector3<double> n = axis.normalized();
  int least = 0;
  n.cwiseAbs().minCoeff(&least);
  first = n.cross(Vector3<double>::Unit(least)).normalized();
  second = n.cross(first);
}

}  // namespace kreisel::detail
