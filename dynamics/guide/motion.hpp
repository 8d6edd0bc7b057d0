#pragma once

#include <Eigen/Geometry>

#include <concepts>

#include <motor/frame.hpp>
#include <motor/rate.hpp>
#include <motor/static_zero.hpp>

namespace kreisel {

/// The motion of a frame G against a frame I at one time: pose, velocity, acceleration.
///
/// Velocity and rate are written in G and reduced at G's ORIGIN. The rate is seen from G. They are
/// numbers and their plain time derivatives, without a transport term (T = P). Displace them for
/// use in the body: X_BG * V and X_BG * dV.
///
/// Do not differentiate the velocity of the guide-fixed point that coincides with a moving point of
/// the body. The result would be a PlainRate.
///
/// Source : paper 002 section 2, F and oF
/// Units  : metre, rad/s, m/s, rad/s^2, m/s^2
template <class G, class I, class S = double>
struct FrameMotion {
  Displacement<I, G, S> X = {};           ///< attitude and position of G in I
  Velocity<G, I, G, S> V = {};            ///< (u; v of G's origin)
  Rate<G, Velocity<G, I, G, S>> dV = {};  ///< (ou; ov), componentwise derivatives on G's axes

  using Of = G;
  using Against = I;
  using Scalar = S;

  /// The inertial acceleration of G's origin on G's axes:  ov + u x v.
  [[nodiscard]] Vector3<S> origin_acceleration() const {
    return dV.value.moment + V.value.resultant.cross(V.value.moment);
  }
};

/// The rotation of a frame against another at one time: u and its rate ou on the frame's own axes.
///
/// Units  : rad/s, rad/s^2
template <class S = double>
struct FrameTurning {
  Vector3<S> u = Vector3<S>::Zero();
  Vector3<S> du = Vector3<S>::Zero();
};

/// A guide motion (motion of a carrier frame): a callable that returns the motion of its frame at a
/// given time.
///
/// Every such callable is a guide motion, including a user's lambda. The kinds in this folder have
/// a file each: resting, translating, rotating, steady, harmonic, posed, tabulated, chain.
template <class M, class G = Guide, class I = Inertial, class S = double>
concept GuideMotion = requires(const M& motion, const S& t) {
  { motion(t) } -> std::same_as<FrameMotion<G, I, S>>;
};

/// u and ou alone, which are sufficient for bodies whose centre of mass is at a guide-fixed point.
/// A guide that can compute them without its pose offers them as turning(t), with the same numbers.
template <class M, class S>
[[nodiscard]] auto turning(const M& motion, const S& t) {
  if constexpr (requires { motion.turning(t); }) {
    return motion.turning(t);
  } else {
    const auto now = motion(t);
    using Number = typename decltype(now)::Scalar;
    return FrameTurning<Number>{now.V.value.resultant, now.dV.value.resultant};
  }
}

/// The constants of a frame in steady motion, on its own axes: u (ou = 0) and the inertial
/// acceleration of its origin. A guide whose motion is steady offers them as steady(); a zero
/// constant is StaticZero by type.
///
/// Units  : rad/s, m/s^2
template <class U, class A>
struct SteadyMotion {
  U u;
  A origin_acceleration;
};

template <class M>
concept SteadyGuide = requires(const M& motion) {
  motion.steady();
};

namespace detail {

/// True if a guide's type declares by a static member never_turns = true that its u and ou are 0.
template <class M>
inline constexpr bool never_turns = requires {
  requires M::never_turns;
};

}  // namespace detail

/// The motion of C against A, from the motions of C against B and of B against A. It is exact.
/// Poses multiply, velocities add, and the rate of V_BA gets the transport term of the observer C.
///
///   V_CA = V_CB + V_BA,   (d/dt)_C V_CA = (d/dt)_C V_CB + (d/dt)_B V_BA - [V_CB V_BA]
///
/// Source : paper 002 section 2, V = V' + F and (4c), for a chain of guides: earth, ship, device
/// Error  : <= 1e-15 * sum of |terms| in each of the three (tests/dynamics/guide/motion.cpp)
template <class C, class B, class A, class S>
[[nodiscard]] FrameMotion<C, A, S> operator*(const FrameMotion<B, A, S>& outer,
                                             const FrameMotion<C, B, S>& inner) {
  const Displacement<C, B, S> X_CB = inner.X.inverse();
  const Velocity<B, A, C, S> V_BA = X_CB * outer.V;
  const auto dV_BA = X_CB * outer.dV;
  return {outer.X * inner.X, inner.V + V_BA, inner.dV + seen_from<C>(dV_BA, inner.V, V_BA)};
}

/// A quaternion and a position as functions of time: values and two derivatives.
///
/// Frame  : attitude G to I, position of G's origin on I axes
template <class S = double>
struct PoseDerivatives {
  Eigen::Quaternion<S> q = Eigen::Quaternion<S>::Identity();
  Eigen::Quaternion<S> dq = Eigen::Quaternion<S>(S(0), S(0), S(0), S(0));
  Eigen::Quaternion<S> ddq = Eigen::Quaternion<S>(S(0), S(0), S(0), S(0));
  Vector3<S> x = Vector3<S>::Zero();
  Vector3<S> dx = Vector3<S>::Zero();
  Vector3<S> ddx = Vector3<S>::Zero();
};

/// The motion of a frame from its pose and the pose's derivatives. The norm of the quaternion need
/// not be 1 or constant:  u = 2 vec(q^-1 q'),  ou = 2 vec(q^-1 q'') - (ln |q|^2)' u.
template <class G, class I, class S>
[[nodiscard]] FrameMotion<G, I, S> frame_motion(const PoseDerivatives<S>& p) {
  const S norm2 = p.q.squaredNorm();
  const Vector3<S> u = S(2) / norm2 * (p.q.conjugate() * p.dq).vec();
  const S swelling = S(2) * p.q.dot(p.dq) / norm2;
  const Vector3<S> du = S(2) / norm2 * (p.q.conjugate() * p.ddq).vec() - swelling * u;
  FrameMotion<G, I, S> motion;
  motion.X.value = Pose<S>::from(p.q, p.x);
  const Matrix3<S> to_guide = motion.X.value.rotation.transpose();
  motion.V.value = {u, to_guide * p.dx};
  motion.dV.value = {du, to_guide * p.ddx - u.cross(motion.V.value.moment)};
  return motion;
}

}  // namespace kreisel
