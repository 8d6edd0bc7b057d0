#pragma once

#include <Eigen/Geometry>

#include <filesystem>
#include <vector>

#include <dynamics/file/scene_file.hpp>
#include <dynamics/tree/reaction.hpp>
#include <dynamics/tree/tree.hpp>

namespace kreisel {

/// Coordinates and rates of all joints, in the order of BodySystem, and the memory of controllers.
struct JointState {
  Eigen::VectorXd coordinates;
  Eigen::VectorXd rates;
  Eigen::VectorXd memory = {};  ///< as ControlledSystem has it
};

/// The scene file and the logs of its guides.
[[nodiscard]] std::vector<std::filesystem::path> files_read(const std::filesystem::path& scene_file,
                                                            const SceneFile& scene);

/// The initial state of a scene.
[[nodiscard]] JointState start_of(const SceneFile& scene);

/// The attitude and position of a body relative to its parent.
[[nodiscard]] Eigen::Quaterniond attitude(const BodyTree& tree, int body, const JointState& state);
[[nodiscard]] Eigen::Vector3d place(const BodyTree& tree, int body, const JointState& state);

/// The torque that keeps the rate of a joint constant; 0 without a drive.
[[nodiscard]] double drive_torque(const BodyTree& tree, int body, const JointReactions& reactions);

}  // namespace kreisel
