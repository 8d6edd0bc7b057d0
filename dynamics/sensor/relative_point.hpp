#pragma once

#include <Eigen/Geometry>

#include <dynamics/inertia.hpp>
#include <dynamics/model/dual_numbers.hpp>
#include <dynamics/sensor/kinematics.hpp>

/// The motion of a body's point relative to several frames, in double or dual numbers.

namespace kreisel {

/// The frame to which a reading is relative, or on whose axes it is given: the guide, the inertial
/// frame or a body.
struct SensorFrame {
  enum class Kind { guide, inertial, body };

  Kind kind = Kind::guide;
  int body = 0;  ///< index, for kind body

  [[nodiscard]] static SensorFrame guide() { return {Kind::guide}; }
  [[nodiscard]] static SensorFrame inertial() { return {Kind::inertial}; }
  [[nodiscard]] static SensorFrame of_body(int body) { return {Kind::body, body}; }
};

/// Position, velocity and acceleration of a point.
///
/// Units  : metre, m/s, m/s^2
template <class S = double>
struct PointReading {
  Vector3<S> position;
  Vector3<S> velocity;
  Vector3<S> acceleration;
};

namespace detail {

/// A vector on guide axes, on the axes of a sensor on a body whose axes R rotates to the guide's.
template <class S>
[[nodiscard]] Vector3<S> on_sensor_axes(const Eigen::Quaterniond& axes, const Matrix3<S>& R,
                                        const Vector3<S>& v) {
  return axes.conjugate().toRotationMatrix().cast<S>() * (R.transpose() * v);
}

/// The motion of a body's point relative to the guide, on guide axes.
template <class S>
[[nodiscard]] PointReading<S> seen_from_guide(const BodyKinematicsOn<S>& body,
                                              const Vector3<double>& at) {
  const Vector3<S> r = body.R * at.cast<S>();
  const Vector3<S> turn = body.w.cross(r);
  return {body.x + r, body.v + turn, body.a + body.dw.cross(r) + body.w.cross(turn)};
}

/// The motion of the point relative to the inertial frame, on guide axes.
template <class S>
[[nodiscard]] PointReading<S> seen_from_inertial(const PointReading<S>& p,
                                                 const FrameMotion<Guide, Inertial, S>& guide) {
  const auto& [u, v_origin] = guide.V.value;
  const Vector3<S>& du = guide.dV.value.resultant;
  const auto& [R, origin] = guide.X.value;
  const Vector3<S> turn = u.cross(p.position);
  return {R.transpose() * origin + p.position, v_origin + turn + p.velocity,
          p.acceleration + guide.origin_acceleration() + du.cross(p.position) + u.cross(turn) +
              S(2) * u.cross(p.velocity)};
}

/// The motion of the point relative to a body, on guide axes.
template <class S>
[[nodiscard]] PointReading<S> seen_from_body(const PointReading<S>& p,
                                             const BodyKinematicsOn<S>& body) {
  const Vector3<S> r = p.position - body.x;
  const Vector3<S> turn = body.w.cross(r);
  const Vector3<S> v = p.velocity - body.v - turn;
  return {r, v,
          p.acceleration - body.a - body.dw.cross(r) - body.w.cross(turn) - S(2) * body.w.cross(v)};
}

/// The rotation from guide axes to the axes of the frame.
template <class S>
[[nodiscard]] Matrix3<S> from_guide(const SensorFrame& frame, const MotionOfBodies<S>& system) {
  switch (frame.kind) {
    case SensorFrame::Kind::guide: break;
    case SensorFrame::Kind::inertial: return system.guide.X.value.rotation;
    case SensorFrame::Kind::body: return system.body(frame.body).R.transpose();
  }
  return Matrix3<S>::Identity();
}

/// Gravitation at a position in the guide, on guide axes: the load on a mass of 1 kg at rest there.
template <class S>
[[nodiscard]] Vector3<S> gravitation(const MotionOfBodies<S>& system, const Vector3<S>& place) {
  if (system.gravity.load == nullptr) return system.gravity.uniform;
  const Vector3<double> zero = Vector3<double>::Zero();
  const Inertia<> unit =
      InertiaTensor<Body>::about_centre(1, zero, Matrix3<double>::Zero(), Mass::zero_allowed).value;
  const LoadContext<S> here{
      system.t, {{Matrix3<S>::Identity(), place}}, {}, system.guide, {lifted<S>(unit)}};
  return system.gravity.uniform + (*system.gravity.load)(here).value.resultant;
}

}  // namespace detail

}  // namespace kreisel
