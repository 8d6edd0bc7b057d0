#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include <dynamics/file/model.hpp>
#include <dynamics/file/period_integrals.hpp>
#include <dynamics/file/scene_sensor.hpp>
#include <dynamics/file/scene_system.hpp>

namespace kreisel {

/// The readings of a scene's sensors during a run. Samples are taken at the output times, or at
/// multiples of a sensor's period. Between samples a sensor keeps its reading; increments are 0
/// there.
///
/// Sensors with a period need all rows in order. A row that is not later than the previous one
/// begins a new run.
///
/// Cost : none without sensors; else one evaluation of the kinematics for each row, and for each
///        period of increments a short run
class SensorReadings {
 public:
  explicit SensorReadings(const SceneFile& scene);

  /// True if a reading depends on earlier rows.
  [[nodiscard]] bool need_all_rows() const;

  /// The readings at one of the output times, in the order of columns(scene).
  ///
  /// Throws : InvalidInput if a row is missing in which a sensor's period begins,
  ///          ComputationFailed if the motion within a period cannot be computed
  [[nodiscard]] std::vector<double> row(const SceneSolver& model, double t,
                                        const JointState& state);

  /// The readings at the end of a run. Only rows that they depend on are read.
  [[nodiscard]] std::vector<double> last_row(const SceneSolver& model,
                                             const Trajectory<JointState>& run);

 private:
  struct Now;

  /// A sensor during a run.
  struct Instrument {
    SensorNoise noise;
    Vector3<double> latest_noise = Vector3<double>::Zero();
    Vector3<double> rest =
        Vector3<double>::Zero();             ///< what rounding left out of the last increment
    std::vector<double> reading = {};        ///< of the latest sample
    std::optional<std::size_t> sample = {};  ///< its index
    double t = 0;                            ///< its time
    JointState state = {};                   ///< the system's state at that time
  };

  void begin_again();
  [[nodiscard]] Now at(const SceneSolver& model, double t, const JointState& state) const;

  /// The first row on which a sensor's latest reading depends.
  [[nodiscard]] std::size_t first_needed(std::size_t sensor,
                                         const std::vector<double>& times) const;

  /// The index of a sensor's sample at time t; nothing between its samples.
  [[nodiscard]] std::optional<std::size_t> sample_of(std::size_t sensor, double t) const;

  /// Keeps the state in which a sensor's next period begins.
  void note(std::size_t sensor, const Now& now, std::size_t sample);

  [[nodiscard]] std::vector<double> reading(std::size_t sensor, const Now& now, std::size_t sample);
  [[nodiscard]] std::vector<double> increment(std::size_t sensor, const Now& now,
                                              std::size_t sample);

  /// The noise of a sensor's sample.
  [[nodiscard]] Vector3<double> noise(std::size_t sensor, std::size_t sample);

  /// The time since the previous sample. For the first sample it is the time since the beginning
  /// or, if that is 0, the time to the next sample.
  [[nodiscard]] double length(std::size_t sensor, std::size_t sample) const;

  const SceneFile& scene_;
  SolveOptions options_;
  std::optional<SceneGuide> inertial_guide_;  ///< if the equations use a freely falling frame
  std::vector<Instrument> instruments_;       ///< one for each sensor
  PeriodIntegrals integrals_;
  std::optional<double> latest_ = {};  ///< time of the latest row
};

}  // namespace kreisel
