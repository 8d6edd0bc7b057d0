#pragma once

#include <Eigen/Geometry>

#include <filesystem>
#include <vector>

#include <dynamics/tree/reaction.hpp>
#include <dynamics/tree/tree.hpp>
#include <dynamics/file/scene_file.hpp>

/// Coordinates and rates of all joints, as BodySystem counts them.
struct JointState {
  Eigen::VectorXd coordinates;
  Eigen::VectorXd rates;
};

/// The scene file and the tables of its guides.
[[nodiscard]] std::vector<std::filesystem::path> files_read(const std::filesystem::path& scene_file,
                                                            const kreisel::SceneFile& scene);

/// The state that a scene begins with.
[[nodiscard]] JointState start_of(const kreisel::SceneFile& scene);

/// Attitude and place of a body against its parent.
[[nodiscard]] Eigen::Quaterniond attitude(const kreisel::BodyTree& tree, int body,
                                          const JointState& state);
[[nodiscard]] Eigen::Vector3d place(const kreisel::BodyTree& tree, int body,
                                    const JointState& state);

/// The torque of what keeps the rate of a joint, 0 where nothing does.
[[nodiscard]] double drive_torque(const kreisel::BodyTree& tree, int body,
                                  const kreisel::JointReactions& reactions);
