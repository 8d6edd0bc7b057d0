#pragma once

#include <dynamics/tree/joint/type.hpp>

namespace kreisel::detail {

/// The joint that slides along `axis`.
[[nodiscard]] inline JointType prismatic_joint() {
  return {.kind = JointKind::prismatic,
          .name = "prismatic",
          .axis = JointType::Axis::required,
          .coordinates = {{"displacement", "m", {"displacement"}, "displacement", {""}}},
          .rates = {{"rate", "m/s", {"rate"}, "rate", {""}}},
          .parts = [](const kreisel::Joint& joint) {
            return JointParts{{LinkKind::prismatic, joint.axis, 1}};
          }};
}

}  // namespace kreisel::detail
