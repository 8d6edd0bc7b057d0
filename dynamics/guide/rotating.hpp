#pragma once

#include <cmath>
#include <limits>

#include <dynamics/guide/motion.hpp>

namespace kreisel {

/// A frame with constant angular velocity whose origin has a constant inertial acceleration on the
/// frame's own axes. Examples: a turntable on a vehicle that brakes, a thrusting spinner.
///
///   R(t) = R(0) exp(u t),   x(t) = x(0) + v(0) t + R(0) t^2 J(u t) a
///
///   J(w) = 1/2 + c skew(w) + d skew(w)^2,   c = (theta - sin(theta)) / theta^3,
///   d = (theta^2/2 - 1 + cos(theta)) / theta^4
///
/// Units  : rad/s, m/s^2
/// Error  : of the position <= 8u * sum of |terms| up to |u t| = pi, beyond it |u t|/pi times that
template <class G = Guide, class I = Inertial, class S = double>
struct RotatingFrame {
  Vector3<S> angular_velocity = Vector3<S>::Zero();     ///< u, on G's axes
  Vector3<S> origin_acceleration = Vector3<S>::Zero();  ///< a of the origin against I, on G's axes
  Displacement<I, G, S> X = {};                         ///< at t = 0
  Vector3<S> origin_velocity = Vector3<S>::Zero();  ///< of the origin against I at t = 0, I's axes

  [[nodiscard]] FrameMotion<G, I, S> operator()(const S& t) const {
    using detail::components;
    const auto axes = detail::Rotation<S>::from(X.value.rotation);
    const auto u = components(angular_velocity);
    const auto a = components(origin_acceleration);
    const auto w = t * u;
    // The translation of the exponential is the integral of exp(u s) a.
    const Pose<S> turn = exp(Motor<S>{detail::vector<S>(w), detail::vector<S>(t * a)});
    const auto v = rotated_back(
        detail::Rotation<S>::from(turn.rotation),
        rotated_back(axes, components(origin_velocity)) + components(turn.translation));
    FrameMotion<G, I, S> motion;
    detail::multiply(X.value.rotation, turn.rotation, motion.X.value.rotation);
    motion.X.value.translation =
        detail::vector<S>(components(X.value.translation) + t * components(origin_velocity) +
                          rotated(axes, (t * t) * twice_integrated(w, a)));
    motion.V.value = {angular_velocity, detail::vector<S>(v)};
    motion.dV.value = {Vector3<S>::Zero(), detail::vector<S>(a - cross(u, v))};
    return motion;
  }

  [[nodiscard]] FrameTurning<S> turning(const S& /*t*/) const {
    return {angular_velocity, Vector3<S>::Zero()};
  }

  [[nodiscard]] SteadyMotion<detail::Components<S>, detail::Components<S>> steady() const {
    return {detail::components(angular_velocity), detail::components(origin_acceleration)};
  }

 private:
  /// J(w) a, the integral of (1 - s) exp(s skew(w)) a over s from 0 to 1.
  [[nodiscard]] static detail::Components<S> twice_integrated(const detail::Components<S>& w,
                                                              const detail::Components<S>& a) {
    using std::sin;
    using std::sqrt;
    const S t2 = w.x * w.x + w.y * w.y + w.z * w.z;
    S c;
    S d;
    if (t2 < S(1)) {
      c = alternating_series(t2, 3);
      d = alternating_series(t2, 4);
    } else {
      const S theta = sqrt(t2);
      const S s = sin(theta / S(2));
      c = (S(1) - sin(theta) / theta) / t2;
      d = (S(0.5) - S(2) * s * s / t2) / t2;
    }
    const auto wa = cross(w, a);
    return a / S(2) + (c * wa + d * cross(w, wa));
  }

  /// 1/n! - x/(n+2)! + x^2/(n+4)! - ...
  [[nodiscard]] static S alternating_series(const S& x, int n) {
    using std::abs;
    S term(1);
    for (int k = 2; k <= n; ++k) term /= S(k);
    S sum = term;
    for (int k = n + 1; abs(term) > std::numeric_limits<S>::epsilon() * sum; k += 2) {
      term *= -x / S(k * (k + 1));
      sum += term;
    }
    return sum;
  }
};

}  // namespace kreisel
