#pragma once

#include <dynamics/tree/joint/spherical.hpp>

namespace kreisel::detail {

/// The joint without constraints: six degrees of freedom.
[[nodiscard]] inline JointType free_joint() {
  return {.kind = JointKind::free,
          .name = "free",
          .coordinates = {joint_attitude(),
                          {"position",
                           "m",
                           {"x", "y", "z"},
                           "position",
                           {"x", "y", "z"},
                           JointQuantity::Meaning::place}},
          .rates = {joint_angular_velocity(),
                    {"velocity", "m/s", {"vx", "vy", "vz"}, "velocity", {"x", "y", "z"}}},
          .parts = [](const kreisel::Joint&) { return JointParts{{LinkKind::free}}; }};
}

}  // namespace kreisel::detail
