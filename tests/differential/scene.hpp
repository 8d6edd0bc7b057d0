#pragma once

#include <Eigen/Geometry>

#include <optional>
#include <string>
#include <vector>

/// A scene as the generator makes it, the file's text of it, and what is left of a failing one.
///
/// A new feature of the language of scene files enters at four places: here as a member, in
/// to_toml() as its text, in generate.cpp as a function that adds it, and in reference*.cpp as its
/// physics. shrink.cpp gets a line that takes it away.

namespace differential {

using Vector = Eigen::Vector3d;

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
    double frequency = 0;
    Angle phase = {};
  };
  Vector constant = Vector::Zero();
  std::vector<Term> terms = {};
};

enum class LinkKind { inertial, rotating, harmonic, earth, table };

/// How a log is written down.
struct Spelling {
  char separator = ',';
  bool decimal_comma = false;
  std::string time_unit = "s";  ///< or ms, us
  int lines_before = 0;         ///< the header
  bool header_is_comment = false;
  bool scalar_comes_last = false;  ///< of quaternions; and the origin before them
  bool ends_with_cr = false;       ///< lines
};

/// A motion that is logged: a turn about a fixed axis by amplitude sin(frequency t + phase), and a
/// shift of the origin by the same sine.
struct Log {
  Vector axis = Vector::UnitX();
  double amplitude = 0;
  Vector shift = Vector::Zero();
  double frequency = 1;
  double phase = 0;
  double step = 0.02;  ///< s
  Spelling spelling = {};

  [[nodiscard]] std::string csv(double t_end) const;
};

struct Link {
  LinkKind kind = LinkKind::inertial;
  Vector angular_velocity = Vector::Zero();
  Vector origin_acceleration = Vector::Zero();
  Series turning = {};
  Series pushing = {};
  double latitude = 0;  ///< degrees
  double height = 0;
  double azimuth = 0;  ///< degrees
  std::optional<double> rate = {};
  std::string gravity = {};  ///< of an earth, as in the file; empty: not given
  Log log = {};
};

enum class GravityKind { not_given, none, uniform, inertial, earth };

enum class JointKind { fixed, revolute, prismatic, universal, spherical, free };

enum class Axes { body, guide, inertial };

struct Load {
  Vector force = Vector::Zero();
  Vector torque = Vector::Zero();
  Vector point = Vector::Zero();
  Axes axes = Axes::body;
};

enum class RotorMode { free, regulated, torque };

struct Rotor {
  RotorMode mode = RotorMode::free;
  double speed = 0;
  double torque = 0;
};

struct Body {
  int parent = -1;  ///< -1: the guide
  JointKind kind = JointKind::revolute;
  Vector axis = Vector::UnitZ();
  Vector second_axis = Vector::UnitX();
  Vector position = Vector::Zero();
  std::optional<Eigen::Vector4d> orientation = {};  ///< w, x, y, z
  double mass = 1;
  Vector centre = Vector::Zero();
  std::vector<double> inertia = {1, 1, 1};
  // How it begins; lists of one number for each coordinate, or empty.
  std::vector<Angle> angle = {};
  double displacement = 0;
  std::vector<double> rate = {};
  std::optional<Eigen::Vector4d> attitude = {};
  Vector angular_velocity = Vector::Zero();
  std::optional<Vector> place = {};
  Vector velocity = Vector::Zero();
  // What acts in the joint; of a ball one number of damping.
  std::vector<double> stiffness = {};
  std::vector<double> rest = {};
  std::vector<double> damping = {};
  std::vector<double> force = {};
  std::optional<Rotor> rotor = {};
  bool drive = false;
  bool hold = false;
  std::vector<Load> loads = {};
};

struct Scene {
  std::vector<Link> guide = {};  ///< more than one: a chain; none: not given
  GravityKind gravity = GravityKind::not_given;
  Vector gravity_vector = Vector::Zero();
  std::vector<Body> bodies = {};
  double t_end = 1;
  double tolerance = 1e-10;
  int outputs = 20;  ///< evenly spaced after t = 0; from three on by a step

  [[nodiscard]] bool has_log() const;
  [[nodiscard]] std::vector<double> times() const;
};

/// The number of coordinates of a joint that have single numbers: 0, 1 or 2.
[[nodiscard]] int single_coordinates(JointKind kind);

/// The text of the scene's file. The logs that it names are log0.csv, log1.csv, .. by the links.
[[nodiscard]] std::string to_toml(const Scene& scene);
[[nodiscard]] std::string log_name(std::size_t link);

}  // namespace differential
