#pragma once

#include <dynamics/tree/joint/type.hpp>

namespace kreisel::detail {

/// The joint that rotates about `axis` and slides along it.
[[nodiscard]] inline JointType cylindrical_joint() {
  return {
      .kind = JointKind::cylindrical,
      .name = "cylindrical",
      .axis = JointType::Axis::required,
      .coordinates = {{"angle", "rad", {"angle"}, "angle", {""}},
                      {"displacement", "m", {"displacement"}, "displacement", {""}}},
      .rates = {{"rate", "rad/s", {"rate"}, "rate", {""}},
                {"velocity", "m/s", {"velocity"}, "velocity", {""}}},
      .parts = [](const kreisel::Joint& joint) {
        return JointParts{{LinkKind::revolute, joint.axis}, {LinkKind::prismatic, joint.axis, 1}};
      }};
}

}  // namespace kreisel::detail
