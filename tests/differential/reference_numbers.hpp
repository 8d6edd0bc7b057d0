#pragma once

#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "reference_guide.hpp"

/// Small functions of the independent integrator.

namespace differential::reference {

inline constexpr Real two_pi = 2 * 3.14159265358979323846264338327950288L;

[[nodiscard]] inline Vec wide(const Vector& v) { return v.cast<Real>(); }

[[nodiscard]] inline Mat turn_by(const std::optional<Eigen::Vector4d>& q) {
  return unit_quaternion(q).toRotationMatrix();
}

[[nodiscard]] inline Mat about(const Vec& axis, Real angle) {
  return Eigen::AngleAxis<Real>(angle, axis).toRotationMatrix();
}

[[nodiscard]] inline Mat tensor(const std::vector<double>& t) {
  Mat result = Mat::Zero();
  for (int i = 0; i < 3; ++i) result(i, i) = Real(t[static_cast<std::size_t>(i)]);
  if (t.size() == 6) {
    result(0, 1) = result(1, 0) = Real(t[3]);
    result(0, 2) = result(2, 0) = Real(t[4]);
    result(1, 2) = result(2, 1) = Real(t[5]);
  }
  return result;
}

[[nodiscard]] inline Quat attitude(const Real* q) { return {q[3], q[0], q[1], q[2]}; }

/// Two unit vectors perpendicular to a third.
[[nodiscard]] inline std::pair<Vec, Vec> across(const Vec& axis) {
  const Vec first = axis.unitOrthogonal();
  return {first, axis.cross(first)};
}

/// The angle of rotation from `from` to `to` about `axis`.
[[nodiscard]] inline Real turn_between(const Vec& axis, const Vec& from, const Vec& to) {
  const Vec a = from - axis.dot(from) * axis;
  const Vec b = to - axis.dot(to) * axis;
  return std::atan2(axis.dot(a.cross(b)), a.dot(b));
}

[[nodiscard]] inline Real number(double x) { return Real(x); }
[[nodiscard]] inline Real number(const Angle& angle) { return Real(angle.radian()); }

template <class T>
[[nodiscard]] Real at_or(const std::vector<T>& list, std::size_t i) {
  return i < list.size() ? number(list[i]) : Real(0);
}

[[nodiscard]] inline Real nearest_turn(Real measured, Real near) {
  return near + std::remainder(measured - near, two_pi);
}

/// True if a joint rotates about `axis` alone.
[[nodiscard]] inline bool is_hinge(JointKind kind) {
  return kind == JointKind::revolute || kind == JointKind::cylindrical ||
         kind == JointKind::planar || kind == JointKind::screw;
}

/// The number of conditions of a constraint.
[[nodiscard]] inline int rows_of(ConstraintKind kind) {
  static constexpr int rows[] = {3, 5, 4, 6, 5, 1, 1, 3, 1};
  return rows[static_cast<int>(kind)];
}

[[nodiscard]] inline int angle_count(JointKind kind) {
  if (kind == JointKind::universal) return 2;
  return is_hinge(kind) ? 1 : 0;
}

}  // namespace differential::reference
