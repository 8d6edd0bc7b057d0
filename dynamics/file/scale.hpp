#pragma once

#include <string>
#include <vector>

#include <dynamics/file/joints.hpp>
#include <dynamics/file/scene_file.hpp>
#include <dynamics/tree/reaction.hpp>
#include <dynamics/tree/tree.hpp>

namespace kreisel {

/// Reference sizes of a scene's quantities, in SI units. A number far below its reference size is
/// rounding. Sizes of 0, the default, hide nothing.
struct SceneScale {
  double angle = 0;  ///< also of quaternions
  double length = 0;
  double turning = 0;  ///< rad/s
  double speed = 0;
  double force = 0;
  double torque = 0;

  /// The reference size for the unit "rad", "1", "m", "rad/s", "m/s", "N" or "N m"; 0 for any
  /// other.
  [[nodiscard]] double of(const std::string& unit) const;

  /// Raises force and torque to at least the reactions of the joints.
  void hold(const JointReactions& reactions);
};

/// The number for display: 0 if it is below 1e-12 of its reference size.
[[nodiscard]] double shown(double x, double size);

[[nodiscard]] Eigen::Vector3d shown(const Eigen::Vector3d& v, double size);

/// Sizes from the masses, lengths and gravity of a scene, and from the motion in these states.
[[nodiscard]] SceneScale scale_of(const SceneFile& scene, const BodyTree& tree,
                                  const std::vector<JointState>& states);

}  // namespace kreisel
