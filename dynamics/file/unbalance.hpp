#pragma once

#include <Eigen/Core>

#include <complex>
#include <string>
#include <vector>

#include <dynamics/file/scene_file.hpp>
#include <dynamics/file/study_system.hpp>

namespace kreisel {

/// The response to an unbalance u of a rotor at the speeds W. The force
///
///   u W^2 (e_1 cos(W t) + e_2 sin(W t))
///
/// acts at the point of the axis next to the rotor's centre of mass. e_1 and e_2 are directions of
/// the carrier across the axis, as a planar joint has them.
struct UnbalanceResponse {
  std::vector<double> speeds;                ///< rad/s, against the carrier
  std::vector<std::complex<double>> values;  ///< output for an unbalance of 1 kg m
};

/// guess  : the state to begin with; steady motions are followed over the speeds
/// Error  : as LinearPlant::response()
/// Throws : InvalidInput if the body has no speed, or its carrier is the guide or turns;
///          ComputationFailed at a speed without a steady motion
[[nodiscard]] UnbalanceResponse unbalance_response(const StudySystem& system,
                                                   const SceneFile& scene, const std::string& body,
                                                   const PlantOutput& output,
                                                   const std::vector<double>& speeds,
                                                   const Eigen::VectorXd& guess);

}  // namespace kreisel
