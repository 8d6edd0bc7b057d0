#pragma once

#include <dynamics/tree/joint/type.hpp>

namespace kreisel::detail {

/// The joint that rotates about `axis` and advances along it by `pitch` metres per radian.
[[nodiscard]] inline JointType screw_joint() {
  return {.kind = JointKind::screw,
          .name = "screw",
          .axis = JointType::Axis::required,
          .has_pitch = true,
          .coordinates = {{"angle", "rad", {"angle"}, "angle", {""}}},
          .rates = {{"rate", "rad/s", {"rate"}, "rate", {""}}},
          .parts = [](const kreisel::Joint& joint) {
            return JointParts{{LinkKind::screw, joint.axis, joint.pitch}};
          }};
}

}  // namespace kreisel::detail
