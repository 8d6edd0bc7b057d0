#pragma once

#include <vector>

#include <dynamics/tree/joint/type.hpp>
#include <motor/api.hpp>

namespace kreisel {

/// All kinds of joints, in the order of JointKind.
KREISEL_API [[nodiscard]] const std::vector<JointType>& joint_types();

/// The joint type of a kind.
KREISEL_API [[nodiscard]] const JointType& joint_type(JointKind kind);

}  // namespace kreisel
