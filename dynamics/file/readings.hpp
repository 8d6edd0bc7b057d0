#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include <dynamics/file/model.hpp>
#include <dynamics/file/scene_sensor.hpp>
#include <dynamics/file/scene_system.hpp>

namespace kreisel {

/// The sensors of a scene along a run, whose samples are the output times.
///
/// Cost : nothing where the scene has no sensor; else one evaluation of the kinematics for each row
class SensorReadings {
 public:
  explicit SensorReadings(const SceneFile& scene);

  /// The readings at one of the output times, in the order of columns(scene).
  [[nodiscard]] std::vector<double> row(const SceneSolver& model, double t,
                                        const JointState& state);

 private:
  /// The noise of a sensor at the sample of that time.
  [[nodiscard]] Vector3<double> noise(std::size_t sensor, double t);

  /// The time since the sample before; of the first sample its distance from t = 0 or, where that
  /// is 0, from the next.
  [[nodiscard]] double length(std::size_t sample) const;

  const SceneFile& scene_;
  std::optional<SceneGuide> inertial_guide_;  ///< if the equations are seen from a frame in free fall
  std::vector<double> times_;
  std::vector<SensorNoise> noises_;      ///< one for each sensor
  std::vector<Vector3<double>> latest_;  ///< noise of each sensor's latest sample
};

}  // namespace kreisel
