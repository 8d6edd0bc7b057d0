#pragma once

#include <string>
#include <vector>

#include <dynamics/file/joints.hpp>
#include <dynamics/file/scene_file.hpp>
#include <dynamics/tree/reaction.hpp>
#include <dynamics/tree/tree.hpp>

namespace kreisel {

/// Sizes of a scene's quantities, in SI units. A number far below its size is rounding and no
/// physics. Sizes of 0, the default, hide nothing.
struct SceneScale {
  double angle = 0;  ///< of quaternions too
  double length = 0;
  double turning = 0;  ///< rad/s
  double speed = 0;
  double force = 0;
  double torque = 0;

  /// The size of what is measured in this unit: "rad", "1", "m", "rad/s", "m/s", "N" or "N m"; 0 of
  /// all others.
  [[nodiscard]] double of(const std::string& unit) const;

  /// Makes force and torque as large as what the joints carry, where they are smaller.
  void hold(const JointReactions& reactions);
};

/// The number as people see it: 0 where it is below 1e-12 of its size.
[[nodiscard]] double shown(double x, double size);

[[nodiscard]] Eigen::Vector3d shown(const Eigen::Vector3d& v, double size);

/// Sizes by the masses, lengths and gravity of a scene, and by how its bodies move in these states.
[[nodiscard]] SceneScale scale_of(const SceneFile& scene, const BodyTree& tree,
                                  const std::vector<JointState>& states);

}  // namespace kreisel
