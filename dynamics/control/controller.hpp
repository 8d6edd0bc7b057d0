#pragma once

#include <string>
#include <variant>
#include <vector>

#include <dynamics/control/law.hpp>
#include <dynamics/sensor/sensors.hpp>
#include <dynamics/signal/signal.hpp>

namespace kreisel {

/// A single coordinate of a joint, or one of its rates; of a rotor, too.
///
/// Units : rad or m, rad/s or m/s
struct JointSensor {
  int body = 0;
  int component = 0;
  bool is_rate = false;
};

/// A body's attitude as yaw, pitch and roll.
struct AttitudeAngles {
  AttitudeSensor sensor = {};
};

/// One number that a controller reads: a component of a sensor. PointSensor has nine: position,
/// velocity and acceleration. AttitudeSensor is read as the quaternion w, x, y, z with w >= 0.
struct Reading {
  std::variant<JointSensor, Gyro, Accelerometer, PointSensor, AttitudeSensor, AttitudeAngles>
      sensor = JointSensor{};
  int component = 0;
};

/// A controller: readings in, forces and lengths out. The input of its law is the control error
///
///   e = reference(t) - reading.
///
/// A continuous controller is part of the equations of motion. One with a period reads and computes
/// at the times first + k period, k = 0, 1, .., and holds its outputs in between; they are 0 before
/// the first. Outputs follow `delay` seconds after their sample.
///
/// Source : paper 000, the torquers and pickoffs that it leaves out ("Momentegeber, Abgriffe,
///          Fesselungen")
/// Units  : N m, N or m (outputs, limit), s
struct Controller {
  std::string name = {};
  std::vector<Reading> reads = {};
  /// Names of bodies, for the forces of all rates of their joints; of ropes, for the lengths that
  /// winches pay out; or of single actuators.
  std::vector<std::string> drives = {};
  ControlLaw law = PidLaw{};
  std::vector<Signal<double>> reference = {};  ///< one for each reading; empty: 0
  std::vector<double> limit = {};              ///< |u| of each output; empty: none
  double period = 0;                           ///< 0: continuous
  double delay = 0;                            ///< of a sampled controller
  double first = 0;                            ///< time of the first sample
};

}  // namespace kreisel
