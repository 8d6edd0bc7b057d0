#pragma once

#include <Eigen/Geometry>

#include <cmath>

#include <motor/motor.hpp>

namespace kreisel {

/// Aerospace angles: a rotation by yaw about z, then by pitch about the new y, then by roll about
/// the new x.
///
/// For input and output only: at pitch = +-pi/2 yaw and roll cannot be told apart, so no state of
/// the library is kept in these angles.
///
/// Units  : radian
template <class S = double>
struct YawPitchRoll {
  S yaw = S(0);
  S pitch = S(0);
  S roll = S(0);

  /// Rz(yaw) Ry(pitch) Rx(roll): takes components on the rotated axes to the original axes.
  [[nodiscard]] Matrix3<S> rotation() const {
    using std::cos;
    using std::sin;
    const S cy = cos(yaw), sy = sin(yaw);
    const S cp = cos(pitch), sp = sin(pitch);
    const S cr = cos(roll), sr = sin(roll);
    Matrix3<S> R;
    R << cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr,  //
        sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr,   //
        -sp, cp * sr, cp * cr;
    return R;
  }

  /// The angles of a rotation: yaw and roll in [-pi, pi], pitch in [-pi/2, pi/2].
  ///
  /// Error  : pitch <= 4u everywhere, yaw and roll <= 4u / cos(pitch); the rotation that the three
  ///          describe together <= 8u everywhere (tests/motor/attitude.cpp)
  [[nodiscard]] static YawPitchRoll of(const Matrix3<S>& R) {
    using std::atan2;
    using std::cos;
    using std::sin;
    using std::sqrt;
    const S yaw = atan2(R(1, 0), R(0, 0));
    // Roll of the rotation that remains after this yaw is removed. It is consistent with the yaw
    // also at pitch = pi/2, where only their sum or difference is determined.
    const S cy = cos(yaw), sy = sin(yaw);
    return {yaw, atan2(-R(2, 0), S(sqrt(R(0, 0) * R(0, 0) + R(1, 0) * R(1, 0)))),
            atan2(sy * R(0, 2) - cy * R(1, 2), cy * R(1, 1) - sy * R(0, 1))};
  }
};

/// The rate of the attitude q of a body whose angular velocity on its own axes is w: q' = q (0,
/// w/2), as x, y, z, w.
///
/// Units  : rad/s
template <class S>
[[nodiscard, gnu::always_inline]] inline Eigen::Matrix<S, 4, 1> attitude_rate(
    const Eigen::Quaternion<S>& q, const Vector3<S>& w) {
  const S x = w.x() / S(2);
  const S y = w.y() / S(2);
  const S z = w.z() / S(2);
  return {q.w() * x + q.y() * z - q.z() * y, q.w() * y + q.z() * x - q.x() * z,
          q.w() * z + q.x() * y - q.y() * x, -(q.x() * x + q.y() * y + q.z() * z)};
}

/// The attitude q after a rotation by the vector w on the rotating body's axes:  q exp(w/2).
///
/// The product is summed as  q + q w/2 + q (exp(w/2) - 1 - w/2),  so that a small rotation is not
/// rounded before it is added to q. Equal rotations would repeat that rounding error, and the error
/// would grow with the total angle. q is never scaled to norm 1, because scaling would round in a
/// preferred direction.
///
/// Over 1e9 steps the norm drifts by 1e-12 and the attitude by 3e-12 rad
/// (benchmarks/group_drift.cpp; tests/motor/attitude.cpp runs 1e6 steps). The drift of the norm has
/// no effect here: Pose::from and all scenes divide by |q|^2.
///
/// Units  : radian
template <class S>
[[nodiscard]] Eigen::Quaternion<S> rotated(const Eigen::Quaternion<S>& q, const Vector3<S>& w) {
  using std::sin;
  using std::sqrt;
  const Vector3<S> half = w / S(2);
  const S x2 = half.squaredNorm();
  S sinc_less_one;    // sin(x)/x - 1
  S cosine_less_one;  // cos(x) - 1
  if (x2 < S(1) / S(16)) {
    const auto less = [&x2](const S& divisor, const S& rest) { return S(1) - x2 / divisor * rest; };
    const S sixth = less(S(110), less(S(156), S(1)));
    sinc_less_one = -x2 / S(6) * less(S(20), less(S(42), less(S(72), sixth)));
    const S fifth = less(S(90), less(S(132), S(1)));
    cosine_less_one = -x2 / S(2) * less(S(12), less(S(30), less(S(56), fifth)));
  } else {
    const S x = sqrt(x2);
    const S s = sin(x / S(2));
    sinc_less_one = sin(x) / x - S(1);
    cosine_less_one = S(-2) * s * s;
  }
  const Vector3<S> rest = sinc_less_one * half;
  const auto product = [&q](const S& scalar, const Vector3<S>& v) {
    return (q * Eigen::Quaternion<S>(scalar, v.x(), v.y(), v.z())).coeffs();
  };
  return Eigen::Quaternion<S>(
      Eigen::Matrix<S, 4, 1>(q.coeffs() + (product(S(0), half) + product(cosine_less_one, rest))));
}

}  // namespace kreisel
