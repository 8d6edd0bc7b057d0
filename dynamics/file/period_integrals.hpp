#pragma once

#include <cstddef>
#include <vector>

#include <dynamics/file/model.hpp>
#include <dynamics/sensor/increments.hpp>

namespace kreisel {

/// The increments of a scene's gyros and accelerometers, integrated beside the motion of the scene
/// from the state at the beginning of each period.
///
/// Error  : 1e-13 of the sizes for each step; smaller ones would follow rounding
/// Cost   : one run of verner98 for each period, common to all sensors with the same period; of
///          radau13 where the field is stiff
class PeriodIntegrals {
 public:
  explicit PeriodIntegrals(const SceneFile& scene);

  /// Makes the next period begin a new run.
  void forget() {
    for (Group& group : groups_) group.increments.clear();
  }

  /// The increments of a sensor from `begin`, at which the scene is in the given state, to `end`.
  ///
  /// Throws : ComputationFailed
  [[nodiscard]] Increments of(std::size_t sensor, const SceneSolver& model, double begin,
                              const JointState& state, double end);

 private:
  /// Sensors with the same period, and their integrals over the latest period.
  struct Group {
    std::vector<std::size_t> sensors;
    double end = 0;
    std::vector<Increments> increments = {};
  };

  void integrate(Group& group, const SceneSolver& model, double begin, const JointState& state,
                 double end) const;

  const SceneFile& scene_;
  std::vector<Group> groups_;
};

}  // namespace kreisel
