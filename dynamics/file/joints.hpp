#pragma once

#include <Eigen/Geometry>

#include <filesystem>
#include <vector>

#include <dynamics/file/scene_file.hpp>
#include <dynamics/tree/reaction.hpp>
#include <dynamics/tree/tree.hpp>

namespace kreisel {

/// Coordinates and rates of all joints, as BodySystem counts them.
struct JointState {
  Eigen::VectorXd coordinates;
  Eigen::VectorXd rates;
};

/// The scene file and the tables of its guides.
[[nodiscard]] std::vector<std::filesystem::path> files_read(const std::filesystem::path& scene_file,
                                                            const SceneFile& scene);

/// The state that a scene begins with.
[[nodiscard]] JointState start_of(const SceneFile& scene);

/// Attitude and place of a body against its parent.
[[nodiscard]] Eigen::Quaterniond attitude(const BodyTree& tree, int body, const JointState& state);
[[nodiscard]] Eigen::Vector3d place(const BodyTree& tree, int body, const JointState& state);

/// The torque of what keeps the rate of a joint, 0 where nothing does.
[[nodiscard]] double drive_torque(const BodyTree& tree, int body, const JointReactions& reactions);

}  // namespace kreisel
