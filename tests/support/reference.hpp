#pragma once

#include <string>
#include <vector>

#include <motor/motor.hpp>

#include <support/kinematics.hpp>
#include <support/sample.hpp>

namespace kreisel::test {

/// A case of inverse-dynamics.json: a motion and 25 digits of all its results, on body axes and
/// about O'. I1 is general, I3 has the kinematics of hand example K.
struct ReferenceCase {
  std::string name;
  Motion guide, relative;
  Digits50 t;
  std::vector<PointMass> masses;
  Digits50 mass;
  Vector3<Digits50> r_s;
  Matrix3<Digits50> Theta_O;
  Motor<Digits50> F, V_rel;
  Derivatives dF, dV_rel;              ///< T
  Derivatives dF_plain, dV_rel_plain;  ///< P, moments only
  Motor<Digits50> momentum, force;
};

[[nodiscard]] std::vector<ReferenceCase> reference_cases();

/// Hand example K: the x component of the force on a particle, correct and by a misreading of Tafel
/// 1.
struct HandExampleK {
  double force, column_So, column_S_dot, plain;
};

[[nodiscard]] HandExampleK hand_example_K();

}  // namespace kreisel::test
