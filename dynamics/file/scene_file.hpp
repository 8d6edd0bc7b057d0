#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include <dynamics/control/controller.hpp>
#include <dynamics/file/scene_sensor.hpp>
#include <dynamics/file/scene_setting.hpp>
#include <dynamics/guide/course.hpp>
#include <dynamics/guide/earth.hpp>
#include <dynamics/guide/harmonic.hpp>
#include <dynamics/guide/orbit.hpp>
#include <dynamics/guide/rates.hpp>
#include <dynamics/guide/signal_frame.hpp>
#include <dynamics/guide/tabulated.hpp>
#include <dynamics/guide/value_log.hpp>
#include <dynamics/load/oblate_gravitation.hpp>
#include <dynamics/solve/solve_options.hpp>
#include <dynamics/tree/description.hpp>
#include <dynamics/tree/element/element.hpp>
#include <motor/error.hpp>

/// The contents of a scene file, checked and typed: one mechanical system on one guide frame.

namespace kreisel {

/// Descriptions of the frames in a chain of guides. Each frame moves relative to the previous one,
/// the first relative to the inertial frame.
namespace scene_guide {

struct Resting {};

/// Pose and velocity of a frame at t = 0, on the axes of the previous frame.
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

/// The local level at a site. If gravity is a number, the latitude is that of the plumb line, and
/// the number includes the centrifugal part. Otherwise latitude and height refer to the WGS84
/// ellipsoid.
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

/// A pose as a function of time.
struct Motion {
  PoseSignals pose = {};
};

struct Orbit {
  OrbitElements<double> elements;
};

/// A vehicle over the WGS84 ellipsoid.
struct Course {
  CoursePlan plan = {};  ///< its `gravity` is the field at all bodies
};

using Link = std::variant<Resting, Rotating, Harmonic, Earth, Table, Rates, Motion, Orbit, Course>;

}  // namespace scene_guide

/// The gravity that the bodies of a scene are in.
namespace scene_gravity {

struct None {};

/// Gravitation of the WGS84 ellipsoid at every body's centre of mass.
struct Ellipsoid {};

/// The effective gravity at the site of the earth frame or of a level vehicle, along its x axis. It
/// includes the centrifugal part at the origin; the gravitation is the same for all bodies.
struct AtSite {
  double magnitude = 0;  ///< m/s^2
};

/// The gravity of the planet that the guide orbits, at every body's own position.
struct OnOrbit {
  bool gradient = true;  ///< includes the terms of second order in the bodies' size
};

using Field = std::variant<None, UniformGravity<Guide>, UniformGravity<Inertial>, Ellipsoid, AtSite,
                           OblateGravitation<>, OnOrbit>;

}  // namespace scene_gravity

/// A joint's coordinates and rates in the order of Joint, quaternions as (x, y, z, w).
struct JointStart {
  std::vector<double> coordinates;
  std::vector<double> rates;
};

/// The equations by which a scene is computed.
enum class SceneModel {
  exact,
  linear,        ///< about the steady motion at or next to the start
  small,         ///< about the start's position, on any guide: SmallMotion
  precession,    ///< technical equations, without nutations
  foeppl,        ///< small oscillations of a Cardan gyro with a symmetric rotor
  fuchs_weigand  ///< small oscillations with a rotor of any moments at constant speed
};

/// The model's name in scene files.
[[nodiscard]] constexpr const char* name(SceneModel model) {
  switch (model) {
    case SceneModel::exact: return "exact";
    case SceneModel::linear: return "linear";
    case SceneModel::small: return "small";
    case SceneModel::precession: return "precession";
    case SceneModel::foeppl: return "foeppl";
    case SceneModel::fuchs_weigand: return "fuchs-weigand";
  }
  return "none";
}

/// A log that a function of time follows.
struct SceneSignalLog {
  std::filesystem::path file;
  ValueLog log;
  LogSpline spline = {};
};

struct SceneFile {
  std::string title;
  std::vector<scene_guide::Link> guide;  ///< from the inertial frame inwards; never empty
  scene_gravity::Field gravity;
  std::vector<BodyDescription> bodies;
  std::vector<JointStart> start;    ///< one for each body
  std::vector<NamedPoints> points;  ///< one for each body
  std::vector<Element> elements = {};
  std::vector<Constraint> constraints = {};
  std::vector<RedundantConstraint> redundant_constraints = {};  ///< at the start
  /// Those of the file, then one for the outputs of each controller.
  std::vector<SceneSensor> sensors;
  std::vector<Controller> controllers = {};
  std::vector<std::string> memory_names = {};  ///< of all controllers, as ControlledSystem has it
  std::vector<double> memory_start = {};
  double t_begin = 0;
  double t_end = 0;  ///< after t_begin
  double tolerance = 1e-10;
  Method method = Method::automatic;
  SceneModel model = SceneModel::exact;
  bool compare = false;              ///< an approximation with the exact motion
  std::vector<double> output_times;  ///< in order, within [t_begin, t_end]
  std::vector<double>
      discontinuities;         ///< times of jumps of forces, in order, within (t_begin, t_end]
  bool forces_change = false;  ///< loads, joint forces or rotor speeds change with time
  std::vector<std::string> columns;  ///< chosen columns or groups of columns; empty: all
  bool reactions = false;
  bool element_forces = false;  ///< reported, as the reactions
  bool constraint_forces = false;
  bool terms = false;
  std::vector<SceneSignalLog> signal_logs = {};
  std::vector<double> frequencies = {};  ///< rad/s, of the terms of functions of time
  /// The same scene with other logs of functions of time.
  std::function<SceneFile(std::vector<SceneSignalLog>)> with_signal_logs = nullptr;

  [[nodiscard]] double duration() const { return t_end - t_begin; }

  /// True if the guide is at rest, so that its motion need not be computed.
  [[nodiscard]] bool rests() const;

  /// The files of the logs that the guide, its parts and functions of time follow.
  [[nodiscard]] std::vector<std::filesystem::path> log_files() const;
  [[nodiscard]] bool follows_log() const { return !log_files().empty(); }
  [[nodiscard]] bool guide_follows_log() const;
};

/// The mistakes in a scene file: a line for each,  file:line:column: key: reason
/// The place of a mistake in a setting is that of the setting.
struct SceneMistakes : InvalidInput {
  using InvalidInput::InvalidInput;
};

/// Options of a command line that override values of the file.
struct SolveRequest {
  std::optional<double> t_end = {};
  std::optional<double> tolerance = {};
  std::optional<Method> method = {};
  std::vector<SceneSetting> settings = {};
};

/// The integrator with a name: "auto", "verner98", "gauss16", ...; nothing for any other word.
[[nodiscard]] std::optional<Method> method_named(std::string_view name);

/// Reads a scene file, TOML 1.0.
///
/// Units  : SI and radian; keys of angles may end in _deg
/// Throws : SceneMistakes; InvalidInput if the file cannot be read
[[nodiscard]] SceneFile read_scene(const std::filesystem::path& path,
                                   const SolveRequest& request = {});

/// Reads a scene from a text. Messages name `path`, and logs are searched beside it.
[[nodiscard]] SceneFile parse_scene(std::string_view text, const std::filesystem::path& path,
                                    const SolveRequest& request = {});

}  // namespace kreisel
