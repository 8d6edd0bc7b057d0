#pragma once

#include <dynamics/tree/joint/type.hpp>

namespace kreisel::detail {

/// The joint that rotates about the parent's `axis`, then about `second_axis`, which rotates along.
[[nodiscard]] inline JointType universal_joint() {
  return {.kind = JointKind::universal,
          .name = "universal",
          .axis = JointType::Axis::required,
          .second_axis = JointType::Axis::required,
          .coordinates = {{"angle", "rad", {"angle 1", "angle 2"}, "angles", {"first", "second"}}},
          .rates = {{"rate", "rad/s", {"rate 1", "rate 2"}, "rates", {"first", "second"}}},
          .parts = [](const kreisel::Joint& joint) {
            return JointParts{{LinkKind::revolute, joint.axis},
                              {LinkKind::revolute, joint.second_axis}};
          }};
}

}  // namespace kreisel::detail
