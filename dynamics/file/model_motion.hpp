#pragma once

#include <Eigen/Core>

#include <functional>
#include <string>
#include <vector>

#include <dynamics/file/scene_file.hpp>
#include <dynamics/file/study_system.hpp>
#include <dynamics/study/motion_samples.hpp>

namespace kreisel {

/// The motion of a scene by an approximate model.
struct ModelMotion {
  std::vector<Eigen::VectorXd> states;  ///< at the output times, as far as the model holds
  std::string message = {};             ///< why it does not hold to the end; or empty
  Eigen::VectorXd begin;                ///< the state at the begin, which the model may change
  MotionSampler samples;
  std::vector<double> stops = {};  ///< ends of the panels of `samples`
  double integration_error = 0;    ///< relative to the size of the state
};

/// A model with the numbers of a scene.
struct SceneApproximation {
  const char* method;
  std::function<ModelMotion(const Eigen::VectorXd& start, const std::vector<double>& times)> motion;
};

/// The approximation that a scene selects. Angles of rotors grow uniformly in `precession`, whose
/// equations do not contain them.
///
/// system : of the scene; it must outlive the result
/// Throws : InvalidInput if the scene does not fit the equations
[[nodiscard]] SceneApproximation approximation_of(const SceneFile& scene,
                                                  const StudySystem& system);

}  // namespace kreisel
