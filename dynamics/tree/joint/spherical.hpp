#pragma once

#include <dynamics/tree/joint/type.hpp>

namespace kreisel::detail {

/// The attitude of a spherical or free joint.
[[nodiscard]] inline JointQuantity joint_attitude() {
  return {"attitude",
          "1",
          {"qw", "qx", "qy", "qz"},
          "attitude (quaternion)",
          {"w", "x", "y", "z"},
          JointQuantity::Meaning::attitude};
}

/// The angular velocity of a spherical or free joint.
[[nodiscard]] inline JointQuantity joint_angular_velocity() {
  return {"angular_velocity",
          "rad/s",
          {"wx", "wy", "wz"},
          "angular velocity on body axes",
          {"x", "y", "z"}};
}

/// The joint that rotates about a point.
[[nodiscard]] inline JointType spherical_joint() {
  return {.kind = JointKind::spherical,
          .name = "spherical",
          .coordinates = {joint_attitude()},
          .rates = {joint_angular_velocity()},
          .parts = [](const kreisel::Joint&) { return JointParts{{LinkKind::spherical}}; }};
}

}  // namespace kreisel::detail
