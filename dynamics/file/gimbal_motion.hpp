#pragma once

#include <Eigen/Core>

#include <variant>
#include <vector>

#include <dynamics/file/scene_file.hpp>
#include <dynamics/gimbal/foeppl.hpp>
#include <dynamics/gimbal/pendulous_oscillations.hpp>
#include <dynamics/gimbal/unsymmetric_rotor.hpp>
#include <dynamics/guide/any_guide.hpp>

namespace kreisel {

/// The scene's three bodies as a gyro in two rings, for small angles of the rings, with a rotor of
/// constant speed. The equations are Foeppl's, or those of Fuchs and Weigand, on a guide at rest.
/// Centres of mass off the axes, products of inertia or a guide that moves need
/// PendulousOscillations, which cost more.
///
/// Throws : InvalidInput naming the part of the scene that the equations do not contain
class GimbalMotion {
 public:
  static constexpr const char* method = "small oscillations, verner98";

  using Pendulous =
      PendulousOscillations<AnyGuide, UniformGravity<Guide>, UniformGravity<Inertial>>;
  using Gyro = std::variant<FoepplGyro<>, UnsymmetricRotor<>, Pendulous>;

  explicit GimbalMotion(const SceneFile& scene);

  /// States of all joints, coordinates before rates, at times after the begin. The rotor's angle
  /// grows with time.
  [[nodiscard]] std::vector<Eigen::VectorXd> states(const Eigen::VectorXd& start,
                                                    const std::vector<double>& times) const;

 private:
  Gyro gyro_;
  double begin_;  ///< of the run, s
};

}  // namespace kreisel
