#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include <dynamics/file/model.hpp>
#include <dynamics/file/scene_sensor.hpp>
#include <dynamics/file/scene_system.hpp>

namespace kreisel {

/// The readings of a scene's sensors during a run. Samples are taken at the output times.
///
/// Cost : none without sensors; else one evaluation of the kinematics for each row
class SensorReadings {
 public:
  explicit SensorReadings(const SceneFile& scene);

  /// The readings at one of the output times, in the order of columns(scene).
  [[nodiscard]] std::vector<double> row(const SceneSolver& model, double t,
                                        const JointState& state);

 private:
  /// The noise of a sensor at the sample of time t.
  [[nodiscard]] Vector3<double> noise(std::size_t sensor, double t);

  /// The time since the previous sample. For the first sample it is the time since t = 0 or, if
  /// that is 0, the time to the next sample.
  [[nodiscard]] double length(std::size_t sample) const;

  const SceneFile& scene_;
  std::optional<SceneGuide> inertial_guide_;  ///< if the equations use a freely falling frame
  std::vector<double> times_;
  std::vector<SensorNoise> noises_;      ///< one for each sensor
  std::vector<Vector3<double>> latest_;  ///< noise of each sensor's latest sample
};

}  // namespace kreisel
