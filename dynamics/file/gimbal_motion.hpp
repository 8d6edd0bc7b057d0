#pragma once

#include <Eigen/Core>

#include <variant>
#include <vector>

#include <dynamics/file/scene_file.hpp>
#include <dynamics/gimbal/foeppl.hpp>
#include <dynamics/gimbal/unsymmetric_rotor.hpp>

namespace kreisel {

/// The scene's three bodies as a gyro in two rings at rest: what Foeppl's equations, and Fuchs' and
/// Weigand's, are about. Small angles of the rings, a rotor at constant speed.
///
/// Throws : InvalidInput with what the scene has that the equations have not
class GimbalMotion {
 public:
  static constexpr const char* method = "small oscillations, verner98";

  explicit GimbalMotion(const SceneFile& scene);

  /// States of all joints, their coordinates before their rates. The angle of the rotor grows with
  /// the time.
  [[nodiscard]] std::vector<Eigen::VectorXd> states(const Eigen::VectorXd& start,
                                                    const std::vector<double>& times) const;

 private:
  std::variant<FoepplGyro<>, UnsymmetricRotor<>> gyro_;
};

}  // namespace kreisel
