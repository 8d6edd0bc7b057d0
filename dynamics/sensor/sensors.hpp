#pragma once

#include <Eigen/Geometry>

#include <optional>

#include <dynamics/sensor/kinematics.hpp>
#include <dynamics/sensor/relative_point.hpp>
#include <motor/api.hpp>

/// Instruments on the bodies of a system. A sensor is a function of its system's kinematics, which
/// kinematics() computes once for all sensors.
///
/// `axes` of a sensor is the rotation from its own axes to the body's:  v_Body = axes v_sensor.
/// `at` is a point given on the body's axes, from the body's origin.

namespace kreisel {

/// A gyro: the angular velocity relative to the inertial frame,  u' + u.
///
/// Frame  : the sensor's axes
/// Units  : rad/s
/// Error  : <= 4u (|u'| + |u|)                       (tests/dynamics/sensor/sensors)
struct Gyro {
  int body = 0;
  Eigen::Quaterniond axes = Eigen::Quaterniond::Identity();

  template <class S>
  [[nodiscard]] Vector3<S> operator()(const MotionOfBodies<S>& system) const;
};

/// An accelerometer: the specific force at a point, which is its acceleration relative to the
/// inertial frame less gravitation.
///
///   f = a' + a_O + ou x p + u x (u x p) + 2 u x v' - g(p),  p the point's position in the guide
///
/// At rest on the rotating earth it reads the local gravity, centrifugal part included, upwards. If
/// the effective gravity is given as a number, the guide's origin has no acceleration. The
/// centrifugal part is then that of the distance from the origin.
///
/// Frame  : the sensor's axes
/// Units  : metre (at), m/s^2
/// Error  : 8u of the sum of the terms' sizes, and the error of the system's accelerations
struct Accelerometer {
  int body = 0;
  Vector3<double> at = Vector3<double>::Zero();
  Eigen::Quaterniond axes = Eigen::Quaterniond::Identity();

  template <class S>
  [[nodiscard]] Vector3<S> operator()(const MotionOfBodies<S>& system) const;
};

/// The motion of a body's point relative to the frame `against`: its position from the frame's
/// origin, and the first two derivatives in the rotating frame.
///
///   r = x - x_A,  v_A = v - v(A) - w_A x r,
///   a_A = a - a(A) - dw_A x r - w_A x (w_A x r) - 2 w_A x v_A
///
/// Frame  : on the axes of `axes`, from the origin of `against`
/// Error  : 8u of the sum of the terms' sizes, and the error of the system's accelerations
struct PointSensor {
  int body = 0;
  Vector3<double> at = Vector3<double>::Zero();
  SensorFrame against = SensorFrame::guide();
  SensorFrame axes = SensorFrame::guide();

  template <class S>
  [[nodiscard]] PointReading<S> operator()(const MotionOfBodies<S>& system) const;
};

/// The attitude of a body relative to a frame: the rotation matrix from the body's axes to the
/// frame's.
///
/// Error  : <= 8u in each entry
struct AttitudeSensor {
  int body = 0;
  SensorFrame against = SensorFrame::guide();

  template <class S>
  [[nodiscard]] Matrix3<S> operator()(const MotionOfBodies<S>& system) const;
};

/// The direction of the plane in which a point of a pendulum swings.
///
/// p, v and a are horizontal: position relative to the pivot, and its derivatives in a frame that
/// does not turn about the vertical. The swing is an ellipse, and the reading is the direction of
/// its major axis, which is an eigenvector of
///
///   S = v v^t - (a p^t + p a^t)/2
///
/// For small swings a = -w^2 p, and S is constant. At turning points the reading is the direction of
/// p. A pendulum that circles has no plane; its reading is arbitrary.
///
/// The vertical is the plumb line from the pivot: apparent gravity as far below the pivot as the
/// point is. It does not change with the swing, and the point at rest is on it. On a guide that turns
/// at the rate u, apparent gravity at the pivot differs by up to u^2 d/g at the distance d.
///
/// Frame  : an angle about the vertical, clockwise from above: from the guide's z axis, or from x if
///          z is within 26 degrees of vertical. In [-pi/2, pi/2], plus `reference`
/// Units  : rad
/// Error  : of a plane swing of any size <= 1e-14; of the direction of the plumb line <= 2e-15 for
///          u^2 d <= g/2                            (tests/dynamics/sensor/sensors)
/// Throws : ComputationFailed if the guide falls freely: apparent gravity is then below 1e-9 of its parts
struct KREISEL_API AzimuthSensor {
  int body = 0;
  Vector3<double> at = Vector3<double>::Zero();
  Vector3<double> pivot = Vector3<double>::Zero();  ///< on guide axes, from the guide's origin
  double reference = 0;                             ///< rad: azimuth of the axis

  [[nodiscard]] double operator()(const SystemKinematics& system) const;
};

/// The force and torque of a body's joint on the body, about a point of the body.
///
///   (R; M_O - p x R),  p = at
///
/// Frame  : the axes of `frame`, rotated by `axes`; about the point `at` of the body
/// Units  : N, N m
/// Error  : that of JointReactions
struct KREISEL_API ReactionSensor {
  int body = 0;
  Vector3<double> at = Vector3<double>::Zero();
  std::optional<SensorFrame> frame = {};                     ///< none: the body's
  Eigen::Quaterniond axes = Eigen::Quaterniond::Identity();  ///< sensor to `frame`

  [[nodiscard]] Motor<> operator()(const SystemKinematics& system) const;
};

/// The force and torque of an element or a constraint on its second body, about a point of that
/// body.
///
/// Frame  : the axes of `frame`, rotated by `axes`; about the point `at` of the second body
/// Units  : N, N m
/// Error  : that of the element
struct KREISEL_API ElementSensor {
  int element = 0;                                           ///< constraints follow the elements
  std::optional<Vector3<double>> at = {};                    ///< none: the element's own point
  std::optional<SensorFrame> frame = {};                     ///< none: the first body's
  Eigen::Quaterniond axes = Eigen::Quaterniond::Identity();  ///< sensor to `frame`

  [[nodiscard]] Motor<> operator()(const SystemKinematics& system) const;
};

template <class S>
Vector3<S> Gyro::operator()(const MotionOfBodies<S>& system) const {
  const BodyKinematicsOn<S>& b = system.body(body);
  const Vector3<S> w = b.w + system.guide.V.value.resultant;
  return detail::on_sensor_axes(axes, b.R, w);
}

template <class S>
Vector3<S> Accelerometer::operator()(const MotionOfBodies<S>& system) const {
  const BodyKinematicsOn<S>& b = system.body(body);
  const PointReading<S> p = detail::seen_from_guide(b, at);
  const Vector3<S> a = detail::seen_from_inertial(p, system.guide).acceleration;
  return detail::on_sensor_axes(axes, b.R, Vector3<S>(a - detail::gravitation(system, p.position)));
}

template <class S>
PointReading<S> PointSensor::operator()(const MotionOfBodies<S>& system) const {
  PointReading<S> p = detail::seen_from_guide(system.body(body), at);
  if (against.kind == SensorFrame::Kind::inertial) {
    p = detail::seen_from_inertial(p, system.inertial_guide);
  }
  if (against.kind == SensorFrame::Kind::body) {
    p = detail::seen_from_body(p, system.body(against.body));
  }
  const Matrix3<S> turn = detail::from_guide(axes, system);
  return {turn * p.position, turn * p.velocity, turn * p.acceleration};
}

template <class S>
Matrix3<S> AttitudeSensor::operator()(const MotionOfBodies<S>& system) const {
  return detail::from_guide(against, system) * system.body(body).R;
}

}  // namespace kreisel
