#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include <dynamics/file/scene_sensor.hpp>
#include <dynamics/guide/earth.hpp>
#include <dynamics/guide/harmonic.hpp>
#include <dynamics/guide/orbit.hpp>
#include <dynamics/guide/rates.hpp>
#include <dynamics/guide/signal_frame.hpp>
#include <dynamics/guide/tabulated.hpp>
#include <dynamics/load/oblate_gravitation.hpp>
#include <dynamics/solve/solve_options.hpp>
#include <dynamics/tree/description.hpp>
#include <motor/error.hpp>

/// What a scene file says, checked and typed: one mechanical system on one guide frame.

namespace kreisel {

/// One frame of a chain of guides, as the file describes it. Each moves against the one before, the
/// first against the inertial frame.
namespace scene_guide {

struct Resting {};

/// Pose and velocity of a frame at t = 0, on the axes of the frame before it.
struct Start {
  Eigen::Quaterniond attitude = Eigen::Quaterniond::Identity();
  Vector3<double> origin_position = Vector3<double>::Zero();
  Vector3<double> origin_velocity = Vector3<double>::Zero();
};

struct Rotating {
  Vector3<double> angular_velocity = Vector3<double>::Zero();     ///< on the frame's own axes
  Vector3<double> origin_acceleration = Vector3<double>::Zero();  ///< inertial, on its own axes
  Start start = {};
};

struct Harmonic {
  HarmonicSeries<double> angular_velocity = {};
  HarmonicSeries<double> origin_acceleration = {};
  Start start = {};
};

/// The local level at a site. With a gravity given as a number its latitude is that of the plumb
/// line, and the number holds the centrifugal part; else the place on the WGS84 ellipsoid decides.
struct Earth {
  EarthSite<double> site = {};
  std::optional<double> gravity = {};  ///< m/s^2, effective
};

struct Table {
  std::filesystem::path file;
  MotionLog<double> log;
  LogSpline spline = {};
};

/// A log of rates on the frame's own axes.
struct Rates {
  std::filesystem::path file;
  RatesLog log;
  RatesStart start;
  LogSpline spline = {};
};

/// Pose as a function of time.
struct Motion {
  PoseSignals pose = {};
};

struct Orbit {
  OrbitElements<double> elements;
};

using Link = std::variant<Resting, Rotating, Harmonic, Earth, Table, Rates, Motion, Orbit>;

}  // namespace scene_guide

/// The gravity that the bodies of a scene are in.
namespace scene_gravity {

struct None {};

/// Gravitation of the WGS84 ellipsoid at every body's centre of mass.
struct Ellipsoid {};

/// The effective gravity at the site of the earth frame, down its x axis, the same for all bodies.
struct AtSite {
  double magnitude = 0;  ///< m/s^2
};

/// The planet of the orbit on which the guide goes, at every body's own place.
struct OnOrbit {
  bool gradient = true;  ///< with the terms of the bodies' size
};

using Field = std::variant<None, UniformGravity<Guide>, UniformGravity<Inertial>, Ellipsoid, AtSite,
                           OblateGravitation<>, OnOrbit>;

}  // namespace scene_gravity

/// A joint's coordinates and rates as Joint counts them, quaternions as (x, y, z, w).
struct JointStart {
  std::vector<double> coordinates;
  std::vector<double> rates;
};

/// The equations that a scene is computed by.
enum class SceneModel {
  exact,
  linear,        ///< about the steady motion next to the start
  precession,    ///< technical equations, in which the nutations are left out
  foeppl,        ///< small oscillations of a Cardan gyro with a symmetric rotor
  fuchs_weigand  ///< the same with a rotor of any moments at constant speed
};

/// As a scene file has it.
[[nodiscard]] constexpr const char* name(SceneModel model) {
  switch (model) {
    case SceneModel::exact: return "exact";
    case SceneModel::linear: return "linear";
    case SceneModel::precession: return "precession";
    case SceneModel::foeppl: return "foeppl";
    case SceneModel::fuchs_weigand: return "fuchs-weigand";
  }
  return "none";
}

struct SceneFile {
  std::string title;
  std::vector<scene_guide::Link> guide;  ///< from the inertial frame inwards; never empty
  scene_gravity::Field gravity;
  std::vector<BodyDescription> bodies;
  std::vector<JointStart> start;    ///< one for each body
  std::vector<NamedPoints> points;  ///< one for each body
  std::vector<SceneSensor> sensors;
  double t_end = 0;
  double tolerance = 1e-10;
  Method method = Method::automatic;
  SceneModel model = SceneModel::exact;
  std::vector<double> output_times;  ///< in order, within [0, t_end]
  std::vector<double> discontinuities;  ///< when forces jump, in order, within (0, t_end]
  bool forces_change = false;           ///< with time: loads, joint forces or speeds of rotors
  std::vector<std::string> columns;  ///< that are chosen, or groups of them; empty: all
  bool reactions = false;
  bool terms = false;

  /// Whether the guide rests, so that nothing of its motion needs to be computed.
  [[nodiscard]] bool rests() const;

  /// Of the logs that the guide and its parts follow.
  [[nodiscard]] std::vector<std::filesystem::path> log_files() const;
  [[nodiscard]] bool follows_log() const { return !log_files().empty(); }
};

/// What is wrong with a scene file: a line for each mistake,  file:line:column: key: reason
struct SceneMistakes : InvalidInput {
  using InvalidInput::InvalidInput;
};

/// What a command line sets against the file's [solve].
struct SolveRequest {
  std::optional<double> t_end = {};
  std::optional<double> tolerance = {};
  std::optional<Method> method = {};
};

/// The integrator of that name: "auto", "verner98", "gauss16", ...; nothing for any other word.
[[nodiscard]] std::optional<Method> method_named(std::string_view name);

/// Reads a scene file, TOML 1.0.
///
/// Units  : SI and radian; keys of angles may end in _deg
/// Throws : SceneMistakes; InvalidInput where the file cannot be read
[[nodiscard]] SceneFile read_scene(const std::filesystem::path& path,
                                   const SolveRequest& request = {});

/// The same of a text; `path` names it in messages, and tables are looked for beside it.
[[nodiscard]] SceneFile parse_scene(std::string_view text, const std::filesystem::path& path,
                                    const SolveRequest& request = {});

}  // namespace kreisel
