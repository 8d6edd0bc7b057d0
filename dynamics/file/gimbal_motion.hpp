#pragma once

#include <Eigen/Core>

#include <variant>
#include <vector>

#include <dynamics/file/scene_file.hpp>
#include <dynamics/gimbal/foeppl.hpp>
#include <dynamics/gimbal/unsymmetric_rotor.hpp>

namespace kreisel {

/// The scene's three bodies as a gyro in two rings, at rest and for small angles of the rings, with
/// a rotor of constant speed. Foeppl's equations and those of Fuchs and Weigand describe such a
/// gyro.
///
/// Throws : InvalidInput naming the part of the scene that the equations do not contain
class GimbalMotion {
 public:
  static constexpr const char* method = "small oscillations, verner98";

  explicit GimbalMotion(const SceneFile& scene);

  /// States of all joints, coordinates before rates. The rotor's angle grows with time.
  [[nodiscard]] std::vector<Eigen::VectorXd> states(const Eigen::VectorXd& start,
                                                    const std::vector<double>& times) const;

 private:
  std::variant<FoepplGyro<>, UnsymmetricRotor<>> gyro_;
};

}  // namespace kreisel
