#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <dynamics/sensor/errors.hpp>
#include <dynamics/sensor/sensors.hpp>
#include <dynamics/tree/description.hpp>

/// Sensors and points of bodies, as in a scene file.

namespace kreisel {

/// Points of a body by name, on the body's axes.
using NamedPoints = std::map<std::string, Vector3<double>>;

namespace scene_sensor {

struct Attitude {
  AttitudeSensor sensor = {};
  bool as_angles = false;  ///< yaw, pitch, roll instead of a quaternion
};

/// Coordinates and rates of a body's joint, in the order of a run's columns.
struct Joint {
  int body = 0;
};

/// The outputs of a controller.
struct Outputs {
  std::size_t controller = 0;
  std::vector<std::string> drives = {};  ///< what they drive, see short_name()
  std::vector<std::string> units = {};
};

using Kind = std::variant<Gyro, Accelerometer, PointSensor, Attitude, Joint, ReactionSensor,
                          ElementSensor, AzimuthSensor, Outputs>;

}  // namespace scene_sensor

/// The integrals that a gyro or an accelerometer reads instead of the values: rotation and velocity
/// of Increments, or angle and force.
enum class SensorIncrements { none, compensated, uncompensated };

struct SceneSensor {
  std::string name;
  scene_sensor::Kind kind = Gyro{};
  std::optional<SensorErrors> errors = {};  ///< for a gyro or an accelerometer; none: ideal
  double period = 0;                        ///< s, from sample to sample; 0: the output times
  SensorIncrements increments = SensorIncrements::none;
};

/// The index of the sample at time t of a run from `begin`; nothing if there is none. Times may
/// differ by rounding.
[[nodiscard]] std::optional<std::size_t> sample_at(const SceneSensor& sensor, double begin,
                                                   double t);

/// Output times and the sample times of all sensors from begin to end, in order.
[[nodiscard]] std::vector<double> with_samples(const std::vector<double>& output_times,
                                               const std::vector<SceneSensor>& sensors,
                                               double begin, double end);

/// Numbers of a reading that belong together: "value", "true", "position", "force" and the like.
struct SensorPart {
  std::string name;
  std::vector<std::string> components;
  std::vector<std::string> units;  ///< one for each component
};

/// The parts of a sensor's reading, in order.
[[nodiscard]] std::vector<SensorPart> parts(const SceneSensor& sensor,
                                            const std::vector<BodyDescription>& bodies);

/// The columns of a sensor: NAME.x for its value, NAME.position x for another part.
[[nodiscard]] std::vector<std::string> columns(const SceneSensor& sensor,
                                               const std::vector<BodyDescription>& bodies);

}  // namespace kreisel
