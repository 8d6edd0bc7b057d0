#pragma once

#include <Eigen/Core>
#include <nlohmann/json.hpp>

#include <string>

#include <dynamics/file/joints.hpp>
#include <dynamics/file/scale.hpp>
#include <motor/motor.hpp>

/// Tables of joints, their motion and their loads, as text and as JSON. A scale hides rounding.
namespace joint_tables {

[[nodiscard]] nlohmann::ordered_json json(const Eigen::Vector3d& v);

/// A number; null if JSON has none for it.
[[nodiscard]] nlohmann::ordered_json json(double x);

[[nodiscard]] nlohmann::ordered_json json(const kreisel::Motor<>& force,
                                          const kreisel::SceneScale& scale = {});

/// Coordinates and rates of a joint and the torque of its drive, by their names in scene files.
[[nodiscard]] nlohmann::ordered_json joint(const kreisel::BodyTree& tree, int body,
                                           const kreisel::JointState& state,
                                           const kreisel::JointReactions& reactions,
                                           const kreisel::SceneScale& scale = {});

/// A number, or a list of them in brackets, with 15 digits.
[[nodiscard]] std::string text(const nlohmann::ordered_json& numbers);

/// Prints a table of objects by body. Their values are numbers, lists or objects of those.
void print(const char* title, const nlohmann::ordered_json& table);

}  // namespace joint_tables
