#pragma once

#include <optional>
#include <stop_token>
#include <vector>

#include <dynamics/file/model.hpp>

namespace kreisel {

/// The effect of the errors of logs on the end of a run.
struct LogError {
  double worst = 0;  ///< of the state, in the measure of RunReport::error_estimate

  struct Joint {
    std::vector<double>
        coordinates;            ///< rad or m; a quaternion has one angle, a position one distance
    std::vector<double> rates;  ///< one for each coordinate
    double force = 0;           ///< N, of the reaction on the body
    double torque = 0;          ///< N m
  };
  std::vector<Joint> joints = {};  ///< one for each body; empty without logs
};

/// The error of a run that is due to the logs of its guide and of functions of time; see
/// error_of_log. It is estimated by runs along other readings of the logs. Returns nothing after an interruption.
///
/// Cost   : thirteen runs for each log, to 1e-6, or to the options' tolerance if the error is as
///          small
/// Throws : ComputationFailed if such a run fails
[[nodiscard]] std::optional<LogError> error_of_logs(const SceneFile& scene,
                                                    const SceneSolver& model,
                                                    const Trajectory<JointState>& run,
                                                    const std::stop_token& stop);

}  // namespace kreisel
