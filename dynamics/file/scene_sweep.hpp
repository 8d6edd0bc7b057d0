#pragma once

#include <Eigen/Core>

#include <functional>
#include <string>
#include <vector>

#include <dynamics/file/scene_file.hpp>
#include <dynamics/file/study_system.hpp>
#include <dynamics/study/rotor_sweep.hpp>

namespace kreisel {

/// The modes of a scene over the speed of one of its bodies, relative to its carrier.
struct SceneSweep : RotorSweep {
  std::string body;
  bool has_rotors = false;  ///< so that modes have a kind
  std::string frame;        ///< in which the roots are observed
  /// True if the coefficients are periodic: modes are those of floquet_modes(). Then W over the
  /// speed, W = 2 pi/period.
  bool is_periodic = false;
  std::vector<double> periods;  ///< for each speed
};

/// Sweeps the speed of a free or regulated rotor or of a body driven at a constant rate. At each
/// speed the steady motion is followed from the one before. If there is none at the greatest speed,
/// the periodic motion is followed, with the period that find_period() gives.
///
/// guess    : the state to begin with
/// progress : called with the share of the speeds that is done, in [0, 1]
/// Throws : InvalidInput if the body has no speed to sweep, naming the reason; ComputationFailed at
///          a speed without a steady or periodic motion; as rotor_sweep()
[[nodiscard]] SceneSweep sweep_speed(const StudySystem& system, const SceneFile& scene,
                                     const std::string& body, const std::vector<double>& speeds,
                                     const SweepOptions& options, const Eigen::VectorXd& guess,
                                     const std::function<void(double)>& progress = {});

/// The index of a body's speed in the state.
///
/// Throws : InvalidInput if the body has no speed to sweep
[[nodiscard]] Eigen::Index speed_of(const StudySystem& system, const std::string& body);

}  // namespace kreisel
