#pragma once

#include <Eigen/Geometry>

#include <optional>

#include <dynamics/sensor/kinematics.hpp>
#include <motor/api.hpp>

/// Readings of instruments on the bodies of a system. Each sensor is a value that is called with the
/// kinematics of its system: kinematics() is computed once and read by all.
///
/// `axes` of a sensor turns its own axes to the body's:  v_Body = axes v_sensor. `at` is a point on
/// the body's axes, from the body's origin.

namespace kreisel {

/// A frame that a reading is seen from, or on whose axes it is written: the guide, the inertial
/// frame or a body's.
struct SensorFrame {
  enum class Kind { guide, inertial, body };

  Kind kind = Kind::guide;
  int body = 0;  ///< of kind body: which

  [[nodiscard]] static SensorFrame guide() { return {Kind::guide}; }
  [[nodiscard]] static SensorFrame inertial() { return {Kind::inertial}; }
  [[nodiscard]] static SensorFrame of_body(int body) { return {Kind::body, body}; }
};

/// The angular velocity against the inertial frame:  u' + u.
///
/// Frame  : the sensor's axes
/// Units  : rad/s
/// Error  : <= 4u (|u'| + |u|)                       (tests/dynamics/sensor/sensors)
struct KREISEL_API Gyro {
  int body = 0;
  Eigen::Quaterniond axes = Eigen::Quaterniond::Identity();

  [[nodiscard]] Vector3<double> operator()(const SystemKinematics& system) const;
};

/// The specific force at a point: its acceleration against the inertial frame less gravitation
/// there.
///
///   f = a' + a_O + ou x p + u x (u x p) + 2 u x v' - g(p),  p the point's place in the guide
///
/// At rest on the turning earth it reads the gravity of the place, centrifugal part included,
/// upwards. Where the effective gravity is given as a number, the guide's origin has no acceleration,
/// and the centrifugal part is that of the distance from there.
///
/// Frame  : the sensor's axes
/// Units  : metre (at), m/s^2
/// Error  : 8u of the sum of the terms' sizes, and the error of the system's accelerations
struct KREISEL_API Accelerometer {
  int body = 0;
  Vector3<double> at = Vector3<double>::Zero();
  Eigen::Quaterniond axes = Eigen::Quaterniond::Identity();

  [[nodiscard]] Vector3<double> operator()(const SystemKinematics& system) const;
};

/// Place, velocity and acceleration of a point.
///
/// Units  : metre, m/s, m/s^2
struct PointReading {
  Vector3<double> position;
  Vector3<double> velocity;
  Vector3<double> acceleration;
};

/// A point of a body as an observer in the frame `against` sees it: its place from that frame's
/// origin, and the first two derivatives for one who turns along with it.
///
///   r = x - x_A,  v_A = v - v(A) - w_A x r,
///   a_A = a - a(A) - dw_A x r - w_A x (w_A x r) - 2 w_A x v_A
///
/// Frame  : on the axes of `axes`, from the origin of `against`
/// Error  : 8u of the sum of the terms' sizes, and the error of the system's accelerations
struct KREISEL_API PointSensor {
  int body = 0;
  Vector3<double> at = Vector3<double>::Zero();
  SensorFrame against = SensorFrame::guide();
  SensorFrame axes = SensorFrame::guide();

  [[nodiscard]] PointReading operator()(const SystemKinematics& system) const;
};

/// How a body is turned against a frame: the matrix takes components on the body's axes to that
/// frame's.
///
/// Error  : <= 8u in each entry
struct KREISEL_API AttitudeSensor {
  int body = 0;
  SensorFrame against = SensorFrame::guide();

  [[nodiscard]] Matrix3<double> operator()(const SystemKinematics& system) const;
};

/// Force and torque about a point of the body that its parent exerts on it through the joint.
///
///   (R; M_O - p x R),  p = at
///
/// Frame  : the axes of `frame`, turned by `axes`; about the point `at` of the body
/// Units  : N, N m
/// Error  : that of JointReactions
struct KREISEL_API ReactionSensor {
  int body = 0;
  Vector3<double> at = Vector3<double>::Zero();
  std::optional<SensorFrame> frame = {};                     ///< none: the body's
  Eigen::Quaterniond axes = Eigen::Quaterniond::Identity();  ///< sensor to `frame`

  [[nodiscard]] Motor<> operator()(const SystemKinematics& system) const;
};

}  // namespace kreisel
