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

/// The greatest power of 2 that is not above |x|; 1 for 0. Rates and moments in such a unit keep
/// their digits. Their products neither underflow nor overflow.
[[nodiscard]] inline double power_of_2(double x) { return x == 0 ? 1 : std::exp2(std::ilogb(x)); }

/// A rate in such a unit. A component below 2^-480 of it counts as 0, because its square would
/// underflow.
[[nodiscard]] inline Vector3<double> in_unit(const Vector3<double>& rate, double unit) {
  return (rate / unit).unaryExpr([](double w) { return std::abs(w) < 0x1p-480 ? 0 : w; });
}

/// A quaternion of any norm except 0, normalized.
///
/// Throws : InvalidInput for 0 and for numbers that are not finite
[[nodiscard]] inline RealQuaternion unit(const Eigen::Quaterniond& attitude0) {
  const RealQuaternion q = attitude0.cast<Real>();
  const Real norm = q.norm();
  if (!(norm > 0 && isfinite(norm))) {
    refuse("|attitude0|", static_cast<double>(norm), "must be a finite number above 0");
  }
  return RealQuaternion(q.coeffs() / norm);
}

/// The rotation by an angle about e_z.
[[nodiscard]] inline RealQuaternion about_z(Real angle) {
  const auto [sine, cosine] = kreisel::detail::sine_cosine(scaled(angle, 0.5));
  return {cosine, 0, 0, sine};
}

/// The shortest rotation of L = (x, y, height - |L|) to e_z, followed by a rotation about e_z by
/// twice the angle of (c, s). Both may have any norm.
[[nodiscard]] inline RealQuaternion to_z_and_about_z(const Real& height, const Real& x,
                                                     const Real& y, const Real& c, const Real& s) {
  const Real size = sqrt((height * height + x * x + y * y) * (c * c + s * s));
  const Real inverse = 1 / size;
  const Real cn = c * inverse;
  const Real sn = s * inverse;
  return {cn * height, cn * y + sn * x, sn * y - cn * x, sn * height};
}

/// The rotation in a time at a constant rate: exp(omega t).
[[nodiscard]] inline RealQuaternion steady_turn(const RealVector& omega, Real time) {
  const Real rate = hypot(hypot(omega.x(), omega.y()), omega.z());
  if (rate == 0) return RealQuaternion::Identity();
  const auto [sine, cosine] = kreisel::detail::sine_cosine(scaled(rate * time, 0.5));
  const RealVector v = sine / rate * omega;
  return {cosine, v.x(), v.y(), v.z()};
}

}  // namespace detail

}  // namespace kreisel::exact
