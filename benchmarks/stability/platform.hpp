#pragma once

#include <dynamics/gimbal/gyro_platform.hpp>

namespace stability {

/// A platform of 10 kg with three gyros whose rotors run at `speed`, in rad/s.
[[nodiscard]] inline kreisel::GyroPlatform platform(double speed) {
  using namespace kreisel;
  GyroPlatform p;
  p.platform = InertiaTensor<Body>::about_centre(
      10, {0, 0, 0}, Vector3<double>(.3, .25, .35).asDiagonal().toDenseMatrix());
  p.position_4 = {.05, 0, .04};
  p.position_9 = {-.05, .02, .03};
  p.arm_5 = .06;
  p.arm_7 = -.06;
  p.frame_4 = {.5, {1.2e-3, 1.5e-3, 1e-3}};
  p.frame_9 = {.4, {.8e-3, .9e-3, 1.1e-3}};
  p.housing_5 = {.3, {2.4e-4, 2.1e-4, 2.3e-4}};
  p.housing_7 = {.3, {2.5e-4, 2e-4, 2.2e-4}};
  p.housing_10 = {.3, {2.2e-4, 2e-4, 2.5e-4}};
  p.rotor_6 = {.2, 1.6e-4, 1e-4};
  p.rotor_8 = {.2, 1.5e-4, .9e-4};
  p.rotor_11 = {.2, 1.7e-4, 1e-4};
  p.L = speed * p.spin_inertias();
  return p;
}

}  // namespace stability
