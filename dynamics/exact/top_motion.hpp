#pragma once

#include <Eigen/Geometry>

#include <cmath>

#include <dynamics/exact/elliptic.hpp>
#include <dynamics/exact/refuse.hpp>
#include <motor/motor.hpp>

namespace kreisel::exact {

/// The attitude and angular velocity of a top.
struct TopMotion {
  Eigen::Quaterniond attitude;       ///< unit, turns body components into inertial ones
  Vector3<double> angular_velocity;  ///< on body axes, rad/s
};

namespace detail {

using RealQuaternion = Eigen::Quaternion<Real>;
using RealVector = Vector3<Real>;

inline void require_finite(const Vector3<double>& omega0) {
  require_finite("omega0.x", omega0.x());
  require_finite("omega0.y", omega0.y());
  require_finite("omega0.z", omega0.z());
}

/// Throws : InvalidInput unless all are above 0 and, to 1e-12, none exceeds the sum of the others
inline void require_body(const Vector3<double>& moments) {
  require_positive("moments.x", moments.x());
  require_positive("moments.y", moments.y());
  require_positive("moments.z", moments.z());
  const double largest = moments.maxCoeff();
  if (largest > (1 + 1e-12) * (moments.sum() - largest)) {
    refuse("the largest moment", largest, "must not exceed the sum of the other two");
  }
}

/// A quaternion of any norm except 0, normalized.
///
/// Throws : InvalidInput for 0 and for numbers that are not finite
[[nodiscard]] inline RealQuaternion unit(const Eigen::Quaterniond& attitude0) {
  const RealQuaternion q = attitude0.cast<Real>();
  const Real norm = q.norm();
  if (!(norm > 0 && std::isfinite(norm))) {
    refuse("|attitude0|", static_cast<double>(norm), "must be a finite number above 0");
  }
  return RealQuaternion(q.coeffs() / norm);
}

/// The rotation by an angle about e_z.
[[nodiscard]] inline RealQuaternion about_z(Real angle) {
  return {std::cos(angle / 2), 0, 0, std::sin(angle / 2)};
}

/// The rotation in a time at a constant rate: exp(omega t).
[[nodiscard]] inline RealQuaternion steady_turn(const RealVector& omega, Real time) {
  const Real rate = std::hypot(omega.x(), omega.y(), omega.z());
  if (rate == 0) return RealQuaternion::Identity();
  const Real half = rate * time / 2;
  const RealVector v = std::sin(half) / rate * omega;
  return {std::cos(half), v.x(), v.y(), v.z()};
}

}  // namespace detail

}  // namespace kreisel::exact
