#pragma once

#include <cmath>
#include <limits>
#include <type_traits>

#include <motor/absent.hpp>
#include <motor/motor.hpp>
#include <motor/tensor.hpp>

namespace kreisel {

/// A displacement without frame tags: rotation R and translation x,  p -> R p + x.
///
/// Read as a change of coordinates it takes components written in a frame B to components written
/// in a frame A: R turns B axes into A axes, x is the origin of B written in A. The rotation is a
/// matrix: displacing costs less than with a quaternion (benchmarks/kernels.cpp).
///
/// Units  : [translation] = metre
template <class S = double>
struct Pose {
  Matrix3<S> rotation = Matrix3<S>::Identity();
  Vector3<S> translation = Vector3<S>::Zero();

  using Scalar = S;

  /// The pose of a quaternion of any norm whose square is a normal number (1e-150 to 1e150): q and
  /// s q give the same rotation to rounding.
  [[nodiscard]] static Pose from(const Eigen::Quaternion<S>& q,
                                 const Vector3<S>& translation = Vector3<S>::Zero()) {
    const Vector3<S> v = q.vec();
    const S two_over_norm2 = S(2) / q.squaredNorm();
    const Matrix3<S> k = skew(v);
    const Matrix3<S> turn = two_over_norm2 * (q.w() * k + k * k);
    return {Matrix3<S>::Identity() + turn, translation};
  }

  /// A point:  R p + x.
  [[nodiscard, gnu::always_inline]] Vector3<S> point(const Vector3<S>& p) const {
    using detail::component;
    return {component(rotation, 0, p) + translation.x(),
            component(rotation, 1, p) + translation.y(),
            component(rotation, 2, p) + translation.z()};
  }

  [[nodiscard]] Pose inverse() const {
    return {rotation.transpose(), -detail::transposed_product(rotation, translation)};
  }

  [[gnu::always_inline]] friend Pose operator*(const Pose& a, const Pose& b) {
    Pose X{Matrix3<S>(), Vector3<S>()};  // not made the unit first
    if constexpr (std::is_same_v<S, double>) {
      const detail::Columns R(a.rotation.data());
      detail::multiply(R, b.rotation, X.rotation);
      const auto x = detail::Three::from(a.translation.data());
      (x + R.combined(b.translation.data())).to(X.translation.data());
    } else {
      detail::multiply(a.rotation, b.rotation, X.rotation);
      X.translation = a.point(b.translation);
    }
    return X;
  }

  /// A motor:  {R a; R a0 + x x R a}. Axes and point of reduction change together. Cost: 42 flops.
  [[gnu::always_inline]] friend Motor<S> operator*(const Pose& X, const Motor<S>& a) {
    detail::Read<S> px = X.translation.x(), py = X.translation.y(), pz = X.translation.z();
    const auto moved = [&](const auto& n, const auto& m) -> Motor<S> {
      const S x = n.x();
      const S y = n.y();
      const S z = n.z();
      return {{x, y, z},
              {m.x() + (py * z - pz * y), m.y() + (pz * x - px * z), m.z() + (px * y - py * x)}};
    };
    if constexpr (std::is_same_v<S, double>) {
      const detail::Columns R(X.rotation.data());
      return moved(R.combined(a.resultant.data()), R.combined(a.moment.data()));
    } else {
      return moved(detail::product(X.rotation, a.resultant), detail::product(X.rotation, a.moment));
    }
  }

  /// A motor tensor, by congruence:  (X T) (X A) = X (T A)  for every motor A.
  friend MotorTensor<S> operator*(const Pose& X, const MotorTensor<S>& T) {
    const Matrix3<S>& R = X.rotation;
    const Matrix3<S> k = skew(X.translation);
    MotorTensor<S> turned{R * T.rr * R.transpose(), R * T.rm * R.transpose(),
                          R * T.mr * R.transpose(), R * T.mm * R.transpose()};
    turned.mr += k * turned.rr;
    turned.mm += k * turned.rm;
    turned.rr -= turned.rm * k;
    turned.mr -= turned.mm * k;
    return turned;
  }
};

namespace detail {

/// Below this squared angle three terms of the series in it leave an error under u/5000.
template <class S>
[[nodiscard]] S small_squared_angle() {
  if constexpr (std::is_same_v<S, double>) {
    return 0x1.965fea53d6e3dp-18;  // a static has a guard to pass
  } else {
    using std::cbrt;
    static const S bound = cbrt(std::numeric_limits<S>::epsilon());
    return bound;
  }
}

}  // namespace detail

/// The exponential of a motor A = (w; v): the displacement that a constant velocity motor A brings
/// about in unit time (a screw motion),
///
///   R = 1 + a S + b S^2,   x = v + b S v + c S^2 v = a v + b S v + c w w.v,   S = skew(w),
///   a = sin(theta)/theta,  b = 2 sin^2(theta/2)/theta^2,  c = (1 - a)/theta^2,   theta = |w|.
///
/// The half angle keeps b free of cancellation; c loses digits near 0 just where S^2 takes them
/// away again. Of the two forms of x each errs less on its side of theta = 1. Below theta = 2.5e-3
/// (double) the series takes over.
///
/// Source : Rodrigues; the exponential map of SE(3)
/// Error  : |R - exact| <= 8u, |x - exact| <= 8u |v| up to theta = pi, beyond it both times
///          theta/pi (tests/motor/displacement.cpp)
template <class S>
[[nodiscard]] Pose<S> exp(const Motor<S>& A) {
  using std::cos;
  using std::sin;
  using std::sqrt;
  const auto w = detail::components(A.resultant);
  const auto v = detail::components(A.moment);
  const S t2 = w.x * w.x + w.y * w.y + w.z * w.z;
  S a;
  S b;
  S c;
  if (t2 < detail::small_squared_angle<S>()) {
    a = S(1) - t2 / S(6) * (S(1) - t2 / S(20));
    b = S(0.5) - t2 / S(24) * (S(1) - t2 / S(30));
    c = S(1) / S(6) - t2 / S(120) * (S(1) - t2 / S(42));
  } else {
    const S theta = sqrt(t2);
    const S half = theta / S(2);
    const S s = sin(half);
    const S two_s = s + s;
    a = two_s * cos(half) / theta;
    b = two_s * s / t2;
    c = (S(1) - a) / t2;
  }
  const auto bw = b * w;
  // Before the rotation, which would have to wait for it in registers.
  detail::Components<S> x;
  if (t2 < S(1)) {
    const auto wv = cross(w, v);
    x = v + (b * wv + c * cross(w, wv));
  } else {
    const S along = c * (w.x * v.x + w.y * v.y + w.z * v.z);
    x = cross(bw, v) + (a * v + along * w);
  }
  const S cosine = S(1) - b * t2;
  const auto aw = a * w;
  const S xy = bw.x * w.y;
  const S xz = bw.x * w.z;
  const S yz = bw.y * w.z;
  Pose<S> X{Matrix3<S>(), Vector3<S>()};
  X.rotation(0, 0) = cosine + bw.x * w.x;
  X.rotation(1, 0) = xy + aw.z;
  X.rotation(2, 0) = xz - aw.y;
  X.rotation(0, 1) = xy - aw.z;
  X.rotation(1, 1) = cosine + bw.y * w.y;
  X.rotation(2, 1) = yz + aw.x;
  X.rotation(0, 2) = xz + aw.y;
  X.rotation(1, 2) = yz - aw.x;
  X.rotation(2, 2) = cosine + bw.z * w.z;
  X.translation = detail::vector<S>(x);
  return X;
}

/// The unit quaternion (w >= 0) of a rotation matrix, from its largest component.
///
/// Error  : <= 4u at every angle, because no component is formed by cancellation
template <class S>
[[nodiscard]] Eigen::Quaternion<S> quaternion(const Matrix3<S>& R) {
  Eigen::Quaternion<S> q(R);
  if (q.w() < S(0)) q.coeffs() = -q.coeffs();
  return q;
}

namespace detail {

/// The logarithm beyond 120 degrees. Apart, for others not to save the registers that it takes.
template <class S>
[[nodiscard, gnu::noinline]] Motor<S> log_of_wide_turn(const Pose<S>& X) {
  using std::atan2;
  using std::sqrt;
  const Eigen::Quaternion<S> q = quaternion(X.rotation);
  const Vector3<S>& x = X.translation;
  const Vector3<S> n = q.vec();
  const S n2 = n.squaredNorm();
  const S n1 = sqrt(n2);
  const S ratio = atan2(n1, q.w()) / n1;  // theta / 2 / sin(theta/2)
  return {S(2) * ratio * n,
          ratio * (q.w() * x - n.cross(x)) + (S(1) - ratio * q.w()) / n2 * n.dot(x) * n};
}

}  // namespace detail

/// The logarithm of a displacement: the motor A with exp(A) = X and |A.resultant| <= pi.
///
/// Up to 120 degrees it is read off the skew part of R, sin(theta) times the axis, beyond from the
/// quaternion, whose vector part does not vanish at the half turn: that takes longer, and errs half as
/// much there. The moment is
///
///   x - S x / 2 + c S^2 x,   S = skew(w),  c = (1 - gamma)/theta^2,  gamma = (theta/2) cot(theta/2).
///
/// Several answers: at the half turn both signs of the axis are right; the one returned has its
/// largest component positive unless rounding says otherwise.
///
/// Error  : of log(exp(A)), relative in each half, measured over 1e6 motors, in units of 1e-16
///          (tests/motor/displacement.cpp prints it)
///            theta      < 1e-8   1e-8..1e-3   1e-3..1   1..pi-1e-3   pi-1e-3..pi
///            resultant     1          6.5        7           7.5           5
///            moment        1          2          6.5         8.5           9
template <class S>
[[nodiscard]] Motor<S> log(const Pose<S>& X) {
  using std::atan2;
  using std::sqrt;
  const Matrix3<S>& R = X.rotation;
  const S cosine = (R(0, 0) + R(1, 1) + R(2, 2) - S(1)) / S(2);
  if (cosine > S(-0.5)) {
    const auto x = detail::components(X.translation);
    const detail::Components<S> sine{S((R(2, 1) - R(1, 2)) / S(2)), S((R(0, 2) - R(2, 0)) / S(2)),
                                     S((R(1, 0) - R(0, 1)) / S(2))};
    const S s2 = sine.x * sine.x + sine.y * sine.y + sine.z * sine.z;
    S ratio;  // theta / sin(theta)
    if (s2 < std::numeric_limits<S>::epsilon()) {
      ratio = S(1) + s2 / S(6);
    } else {
      const S s = sqrt(s2);
      ratio = atan2(s, cosine) / s;
    }
    const S ratio2 = ratio * ratio;
    const S t2 = ratio2 * s2;
    const S gamma = ratio * (S(1) + cosine) / S(2);
    const S c = t2 < detail::small_squared_angle<S>()
                    ? S(ratio2 * (S(1) / S(12) + t2 / S(720) * (S(1) + t2 / S(42))))
                    : S((S(1) - gamma) / s2);
    // By the sine, whose products do not wait for the angle: c is that of the formula by ratio^2.
    const auto sx = cross(sine, x);
    const auto w = ratio * sine;
    const auto moment = x - (S(ratio / S(2)) * sx - c * cross(sine, sx));
    return {detail::vector<S>(w), detail::vector<S>(moment)};
  }
  return detail::log_of_wide_turn(X);
}

}  // namespace kreisel
