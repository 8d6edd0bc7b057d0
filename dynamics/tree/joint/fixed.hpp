#pragma once

#include <dynamics/tree/joint/type.hpp>

namespace kreisel::detail {

/// The joint without any motion.
[[nodiscard]] inline JointType fixed_joint() {
  return {.kind = JointKind::fixed, .name = "fixed", .parts = [](const kreisel::Joint&) {
            return JointParts{{}};
          }};
}

}  // namespace kreisel::detail
