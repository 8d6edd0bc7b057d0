#pragma once

#include <Eigen/Geometry>

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <dynamics/tree/joint/list.hpp>

#include "log.hpp"

/// A scene of the generator, and its text as a file.
///
/// A new feature of scene files has four places: a member here, its text in toml*.cpp, a function
/// of generate*.cpp that adds it, and its physics in reference*.cpp. shrink.cpp gets a line that
/// removes it. A new kind of joint has one place, reference*.cpp: the names and the number of its
/// coordinates are those of the library's list.

namespace differential {

/// An angle as the file has it, in radian or in degrees.
struct Angle {
  double value = 0;
  bool degrees = false;

  [[nodiscard]] double radian() const;
};

/// constant + sum of amplitude sin(frequency t + phase)
struct Series {
  struct Term {
    Vector amplitude = Vector::Zero();
    Angle frequency = {};
    Angle phase = {};
  };
  Vector constant = Vector::Zero();
  std::vector<Term> terms = {};
};

/// A function of time whose value or rate jumps; for a number the x component counts.
struct Jumps {
  bool is_broken_line = false;  ///< else steps
  std::vector<double> times = {};
  std::vector<Vector> values = {};
};

/// A function of time as in the file; nothing if both members are empty.
struct Signal {
  Series series = {};
  Vector rate = Vector::Zero();
  Jumps jumps = {};
  std::string file = {};  ///< a log of the samples, instead of the terms

  [[nodiscard]] bool empty() const;
};

/// Elements of an orbit about the earth.
struct Orbit {
  double semi_major_axis = 0;
  double eccentricity = 0;
  Angle inclination = {};
  Angle node = {};
  Angle perigee = {};
  Angle anomaly = {};
  bool j2 = false;
};

/// A vehicle over the earth: its start, and its speeds as functions of time, as in the file.
struct Vehicle {
  Angle latitude = {};
  Angle longitude = {};
  Angle heading = {};
  double height = 0;
  double speed = 0;
  Signal turn_rate = {};
  Signal acceleration = {};
  Signal climb = {};
  Signal bank = {};
  bool is_coordinated = false;  ///< the bank
};

enum class LinkKind { inertial, rotating, harmonic, earth, table, rates, motion, orbit, course };

struct Link {
  LinkKind kind = LinkKind::inertial;
  Vector angular_velocity = Vector::Zero();
  Vector origin_acceleration = Vector::Zero();
  Series turning = {};
  Series pushing = {};
  bool turns_in_degrees = false;                 ///< angular_velocity, or turning
  std::optional<Eigen::Vector4d> attitude = {};  ///< at t = 0: w, x, y, z
  Vector origin_position = Vector::Zero();
  Vector origin_velocity = Vector::Zero();
  double latitude = 0;  ///< degrees
  double height = 0;
  double azimuth = 0;  ///< degrees
  std::optional<Angle> rate = {};
  std::string gravity = {};  ///< of an earth or a course, as in the file; empty: not given
  Log log = {};
  Signal position = {};               ///< of a motion
  std::array<Signal, 3> angles = {};  ///< yaw, pitch, roll
  Orbit orbit = {};
  Vehicle vehicle = {};

  [[nodiscard]] bool is_logged() const {
    return kind == LinkKind::table || kind == LinkKind::rates;
  }
};

enum class GravityKind { not_given, none, uniform, inertial, earth, earth_j2, point, j2, orbit };

using kreisel::JointKind;

enum class Axes { body, guide, inertial };

enum class LoadKind { force, drag, magnet };

struct Load {
  LoadKind kind = LoadKind::force;
  Vector force = Vector::Zero();
  Vector torque = Vector::Zero();
  Vector point = Vector::Zero();
  Axes axes = Axes::body;
  Signal force_in_time = {};       ///< instead of the force
  Vector linear = Vector::Zero();  ///< of a drag, diagonals on body axes
  Vector quadratic = Vector::Zero();
  Vector angular = Vector::Zero();
  Vector moment = Vector::Zero();  ///< of a magnet
  Signal field = {};
};

enum class RotorMode { free, regulated, torque };

struct Rotor {
  RotorMode mode = RotorMode::free;
  Angle speed = {};
  bool speed_is_initial = false;  ///< as initial.rate
  double torque = 0;
  Signal torque_in_time = {};  ///< instead of the torque
};

struct Body {
  int parent = -1;  ///< -1: the guide
  JointKind kind = JointKind::revolute;
  Vector axis = Vector::UnitZ();
  Vector second_axis = Vector::UnitX();  ///< 0: left out
  double pitch = 0.1;
  Vector position = Vector::Zero();
  std::optional<Eigen::Vector4d> orientation = {};  ///< w, x, y, z
  double mass = 1;
  Vector centre = Vector::Zero();
  std::vector<double> inertia = {1, 1, 1};
  // Start values; lists with one number for each angle, displacement or coordinate, or empty.
  std::vector<Angle> angle = {};
  std::vector<double> displacement = {};
  std::vector<Angle> rate = {};
  std::optional<Eigen::Vector4d> attitude = {};
  Vector angular_velocity = Vector::Zero();
  bool turns_in_degrees = false;  ///< angular_velocity
  std::optional<Vector> place = {};
  Vector velocity = Vector::Zero();
  // Forces in the joint; a spherical joint has one number for damping.
  std::vector<double> stiffness = {};
  std::vector<Angle> rest = {};
  std::vector<double> damping = {};
  std::vector<double> force = {};
  Signal force_in_time = {};  ///< in a joint of one coordinate, instead of the force
  std::optional<Rotor> rotor = {};
  bool drive = false;
  Signal motion = {};    ///< of the drive instead of a constant rate
  bool is_rate = false;  ///< of the motion: the rate, not the coordinate
  bool hold = false;
  /// The body is free, and its joint is a constraint between it and its parent. Its values are
  /// those of a free joint to the guide.
  bool loose = false;
  std::vector<Load> loads = {};
  bool has_units = false;  ///< mass, centre, inertia and angles as texts with a unit

  [[nodiscard]] JointKind free_kind() const { return loose ? JointKind::free : kind; }
};

enum class ElementKind { spring, mount, gear, rope };

/// A force between two bodies or two joints.
struct Element {
  ElementKind kind = ElementKind::spring;
  std::array<int, 2> bodies = {-1, 0};  ///< -1: the guide; for a gear the joints' bodies
  std::array<Vector, 2> at = {Vector::Zero(), Vector::Zero()};
  double stiffness = 0;  ///< of a spring, a rope or a gear
  double damping = 0;
  double length = 0;
  Signal length_in_time = {};  ///< of a rope on a winch, instead of the length
  std::vector<std::pair<double, double>> table = {};  ///< instead of stiffness and length
  double ratio = 1;
  // Numbers of a mount.
  std::optional<Eigen::Vector4d> axes = {};
  Eigen::Matrix3d linear = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d turning = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d coupling = Eigen::Matrix3d::Zero();
  Vector linear_damping = Vector::Zero();
  Vector turning_damping = Vector::Zero();
  Vector force = Vector::Zero();  ///< preload
  Vector torque = Vector::Zero();
};

enum class ConstraintKind {
  point,
  revolute,
  universal,
  fixed,
  prismatic,
  distance,
  gear,
  rolling,
  blade
};

/// A condition between two bodies or two joints that the start fulfils.
struct Constraint {
  ConstraintKind kind = ConstraintKind::point;
  /// -1: the guide. A gear has the bodies of its joints, rolling the body of the plane first.
  std::array<int, 2> bodies = {-1, 0};
  /// A point of the first body, for rolling of the plane, and one of the second.
  std::array<Vector, 2> at = {Vector::Zero(), Vector::Zero()};
  Vector axis = Vector::UnitZ();         ///< on the first body; of a wheel or a blade on the second
  Vector second_axis = Vector::UnitX();  ///< of a universal joint, on the second body
  double length = 1;
  double ratio = 1;
  double offset = 0;
  double radius = 1;
  double tube = 0;
  bool is_ball = false;
  Vector normal = Vector::UnitZ();  ///< of the plane
};

enum class SensorKind { gyro, accelerometer, point, attitude, reaction, joint, azimuth };

/// A frame that a sensor names: the index of a body, or one of these.
inline constexpr int guide_frame = -1;
inline constexpr int inertial_frame = -2;

/// Errors of a gyro or an accelerometer, three numbers for its axes.
struct SensorErrors {
  Vector misalignment = Vector::Zero();  ///< rad
  Vector scale = Vector::Zero();
  Vector bias = Vector::Zero();
  bool is_in_degrees = false;  ///< the bias
  Vector noise = Vector::Zero();
  Vector drift = Vector::Zero();
  Vector sigma = Vector::Zero();
  double time = 1;  ///< of the correlation
  double resolution = 0;
  double range = 0;
  int seed = 0;

  [[nodiscard]] bool is_random() const {
    return !noise.isZero(0) || !drift.isZero(0) || !sigma.isZero(0);
  }
};

struct Sensor {
  SensorKind kind = SensorKind::gyro;
  int body = 0;
  int element = -1;     ///< of a reaction, instead of the body's joint
  int constraint = -1;  ///< likewise
  Vector at = Vector::Zero();
  bool at_by_name = false;                   ///< as one of the body's points
  std::optional<Eigen::Vector4d> axes = {};  ///< w, x, y, z
  int against = guide_frame;
  int on = guide_frame;  ///< axes of a point
  double period = 0;     ///< 0: not given
  std::optional<SensorErrors> errors = {};
  std::string increments = {};  ///< "true" or "\"uncompensated\""; empty: values
};

/// A pid that reads a joint of one coordinate, and drives such a joint or a load on a body.
struct Servo {
  int reads = 0;
  bool reads_rate = false;
  int drives = 0;  ///< a body
  int load = -1;   ///< component of the force and torque on it; -1: its joint
  int rope = -1;   ///< the element whose length it pays out instead; -1: none
  double proportional = 0;
  double integral = 0;
  double derivative = 0;
  double filter = 0;
  double reference = 0;
  double limit = 0;   ///< 0: none
  double period = 0;  ///< 0: continuous
  double delay = 0;

  /// The periods that a sample waits at the least, and the rest of the delay.
  [[nodiscard]] int whole_periods() const;
  [[nodiscard]] double rest() const;
};

struct Scene {
  std::string title = {};
  std::vector<Link> guide = {};  ///< more than one: a chain; none: not given
  bool chain_in_chain = false;   ///< of all links but the first
  GravityKind gravity = GravityKind::not_given;
  Vector gravity_vector = Vector::Zero();  ///< of a planet its centre
  Vector pole = Vector::UnitZ();
  std::optional<bool> gradient = {};  ///< as in the file
  std::vector<Body> bodies = {};
  std::vector<Element> elements = {};
  std::vector<Constraint> constraints = {};
  std::vector<Sensor> sensors = {};
  std::vector<Servo> servos = {};
  double t_begin = 0;
  double t_end = 1;
  double tolerance = 1e-10;
  std::string model = {};   ///< an approximation; empty: none
  std::string method = {};  ///< as in the file; empty: not given
  bool reports = false;     ///< reactions and terms
  int outputs = 20;         ///< evenly spaced after t = 0; from three on by a step

  [[nodiscard]] bool has_log() const;
  /// The functions of time in forces and drives.
  [[nodiscard]] std::vector<const Signal*> signals() const;
  /// The times at which something jumps, in order.
  [[nodiscard]] std::vector<double> jumps() const;
  [[nodiscard]] std::vector<double> times() const;
};

/// A vector of the file, in radian.
[[nodiscard]] Vector radian(const Vector& v, bool degrees);

/// The number of coordinates of a joint that have single numbers.
[[nodiscard]] int single_coordinates(JointKind kind);

/// The numbers of a joint's coordinates and rates: 4 for an attitude, 3 for other vectors, else 1.
[[nodiscard]] std::vector<int> blocks(JointKind kind);

/// True if one of the coordinates is a displacement.
[[nodiscard]] bool slides(JointKind kind);

/// The same scene nearer to the limit in which its model is exact. All motions except those of
/// rotors are halved; for precession equations the rotors have twice the speed.
[[nodiscard]] Scene nearer(Scene scene);

/// The text of the scene's file. Its logs are log0.csv, log1.csv, .. in the order of the links.
[[nodiscard]] std::string to_toml(const Scene& scene);

/// Writes the logs that the file names.
void write_logs(const Scene& scene, const std::filesystem::path& folder);

}  // namespace differential
