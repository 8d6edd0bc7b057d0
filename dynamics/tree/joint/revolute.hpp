#pragma once

#include <dynamics/tree/joint/type.hpp>

namespace kreisel::detail {

/// The joint that rotates about `axis`.
[[nodiscard]] inline JointType revolute_joint() {
  return {.kind = JointKind::revolute,
          .name = "revolute",
          .axis = JointType::Axis::required,
          .coordinates = {{"angle", "rad", {"angle"}, "angle", {""}}},
          .rates = {{"rate", "rad/s", {"rate"}, "rate", {""}}},
          .parts = [](const kreisel::Joint& joint) {
            return JointParts{{LinkKind::revolute, joint.axis}};
          }};
}

}  // namespace kreisel::detail
