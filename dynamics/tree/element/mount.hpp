#pragma once

#include <Eigen/Geometry>

#include <array>
#include <string>

#include <dynamics/tree/element/motion.hpp>
#include <motor/api.hpp>
#include <motor/displacement.hpp>
#include <motor/error.hpp>
#include <motor/tensor.hpp>

namespace kreisel {

/// An elastic mount between a point of one body and a point of another: a motor tensor. It takes
/// the motor of displacement to the motor of force. The mount is unloaded if both points meet and
/// both bodies have the same attitude.
///
///   z = (theta; d),   theta = log R,   d = displacement of the second point
///   (F; N) = preload - K z,   force F - D v,   torque J(theta)^-t N - D w
///
/// R is the rotation of the second body relative to the first. d, v and w are relative to the first
/// body, which may turn at will. J takes theta' to the angular velocity w, so that the power of the
/// elastic force is F d' + N theta'. A symmetric K therefore has the potential z K z/2 - preload z
/// at all angles.
///
/// Blocks of K and D: rm force by displacement, mr torque by rotation, rr force by rotation, mm
/// torque by displacement. K may be unsymmetric, as for an oil film; then there is no potential.
///
/// Frame  : on the mount's axes, which move with the first body
/// Units  : rm N/m, rr and mm N, mr N m; damping N s/m, N s, N m s; preload N, N m
/// Source : von Mises 1924, "Motordyade"; paper 002 section 8a, the elastically held engine
/// Error  : 16u of the terms' sizes
/// Throws : ComputationFailed if a torque depends on theta and |theta| is above 3 rad
struct MountElement {
  static constexpr const char* kind = "mount";

  std::string name = {};
  std::array<ElementEnd, 2> ends = {};
  /// Attitude of the mount's axes on the first body: takes components on them to the body's.
  Eigen::Quaterniond axes = Eigen::Quaterniond::Identity();
  MotorTensor<> stiffness = {};
  MotorTensor<> damping = {};
  Motor<> preload = {};  ///< on the second body when the mount is not displaced

  /// Force and torque on the second body, about its end, on the first body's axes.
  template <class S>
  [[nodiscard]] Motor<S> force(const ElementMotion<S>& m) const {
    const Matrix3<S> A = to_body().template cast<S>();
    const Matrix3<S> to_mount = A.transpose();
    const Motor<S> displacement{to_mount * turn(m), to_mount * m.reach};
    const Motor<S> rate{to_mount * m.turning, to_mount * m.velocity};
    Motor<S> elastic = cast<S>(preload) - cast<S>(stiffness) * displacement;
    elastic.moment = torque(displacement.resultant, elastic.moment);
    const Motor<S> all = elastic - cast<S>(damping) * rate;
    return {A * all.resultant, A * all.moment};
  }

  [[nodiscard]] KREISEL_API double potential(const ElementMotion<>& m) const;

  /// True if the stiffness is symmetric up to rounding.
  [[nodiscard]] KREISEL_API bool has_potential() const;

  /// True if there is a potential and nothing is damped.
  [[nodiscard]] KREISEL_API bool keeps_energy() const;

  /// True if the force depends on the rotation theta.
  [[nodiscard]] KREISEL_API bool feels_rotation() const;

 private:
  /// The rotation from the mount's axes to the first body's.
  [[nodiscard]] KREISEL_API Matrix3<double> to_body() const;

  template <class S>
  [[nodiscard]] static Motor<S> cast(const Motor<>& m) {
    return {m.resultant.cast<S>(), m.moment.cast<S>()};
  }
  template <class S>
  [[nodiscard]] static MotorTensor<S> cast(const MotorTensor<>& T) {
    return {T.rr.cast<S>(), T.rm.cast<S>(), T.mr.cast<S>(), T.mm.cast<S>()};
  }

  /// theta, or 0 if nothing depends on it.
  template <class S>
  [[nodiscard]] Vector3<S> turn(const ElementMotion<S>& m) const {
    constexpr double cosine_of_3 = -0.98999249660044545;
    if (!feels_rotation()) return Vector3<S>::Zero();
    if (m.turn.trace() < S(1 + 2 * cosine_of_3)) {
      throw ComputationFailed("element '" + name +
                              "': its ends are rotated by more than 3 rad relative to each other; "
                              "a mount is for smaller angles");
    }
    return log(Pose<S>{m.turn, Vector3<S>::Zero()}).resultant;
  }

  /// J(theta)^-t N = N + theta x N/2 + c theta x (theta x N),  c = (1 - (t/2) cot(t/2))/t^2, t =
  /// |theta|. The polynomial has the error u/2 at its end.
  ///
  /// Source : J = sum of [theta]^n/(n + 1)!; its inverse has Bernoulli's numbers
  template <class S>
  [[nodiscard]] static Vector3<S> torque(const Vector3<S>& theta, const Vector3<S>& N) {
    using std::cos;
    using std::sin;
    using std::sqrt;
    const S t2 = theta.squaredNorm();
    S c;
    if (t2 < S(0.01)) {
      c = S(1.0 / 12) + t2 * (S(1.0 / 720) + t2 * (S(1.0 / 30240) + t2 * (S(1.0 / 1209600) +
                                                                          t2 * S(1.0 / 47900160))));
    } else {
      const S half = sqrt(t2) / S(2);
      c = (S(1) - half * cos(half) / sin(half)) / t2;
    }
    const Vector3<S> once = theta.cross(N);
    return N + once / S(2) + c * theta.cross(once);
  }
};

}  // namespace kreisel
