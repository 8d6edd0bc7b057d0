#pragma once

#include <Eigen/Core>
#include <nlohmann/json.hpp>

#include <dynamics/file/joints.hpp>
#include <dynamics/file/scale.hpp>
#include <motor/motor.hpp>

/// Numbers, forces and the motion of joints as JSON objects. A scale hides rounding.

namespace kreisel {

[[nodiscard]] nlohmann::ordered_json json_of(const Eigen::Vector3d& v);

/// A number; null if JSON has none for it.
[[nodiscard]] nlohmann::ordered_json json_of(double x);

[[nodiscard]] nlohmann::ordered_json json_of(const Motor<>& force, const SceneScale& scale = {});

/// Coordinates and rates of a joint and the torque of its drive, by their names in scene files.
[[nodiscard]] nlohmann::ordered_json joint_json(const BodyTree& tree, int body,
                                                const JointState& state,
                                                const JointReactions& reactions,
                                                const SceneScale& scale = {});

}  // namespace kreisel
