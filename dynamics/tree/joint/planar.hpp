#pragma once

#include <utility>

#include <dynamics/tree/joint/type.hpp>

namespace kreisel::detail {

/// The two directions of the displacements of a planar joint, on the parent's axes. They are fixed
/// in the parent: the joint's rotation does not affect them.
///
/// The first is the component of `second_axis` normal to `axis`. The default of `second_axis` is
/// the parent's axis after the one nearest to `axis`, in the order x, y, z, x. The second direction
/// is axis x first.  For the axis z they are x and y of the parent.
[[nodiscard]] inline std::pair<Vector3<double>, Vector3<double>> plane_directions(
    const kreisel::Joint& joint) {
  const Vector3<double> axis = joint.axis.normalized();
  Vector3<double> first = joint.second_axis;
  if (first.isZero(0)) {
    int nearest = 0;
    axis.cwiseAbs().maxCoeff(&nearest);
    first = Vector3<double>::Unit((nearest + 1) % 3);
  }
  first.normalize();
  first = (first - axis.dot(first) * axis).normalized();
  return {first, axis.cross(first)};
}

/// The joint that slides in the plane normal to `axis` and rotates about it.
[[nodiscard]] inline JointType planar_joint() {
  return {.kind = JointKind::planar,
          .name = "planar",
          .axis = JointType::Axis::required,
          .second_axis = JointType::Axis::optional,
          .coordinates = {{"displacement",
                           "m",
                           {"displacement 1", "displacement 2"},
                           "displacements",
                           {"first", "second"}},
                          {"angle", "rad", {"angle"}, "angle", {""}}},
          .rates =
              {{"velocity", "m/s", {"velocity 1", "velocity 2"}, "velocities", {"first", "second"}},
               {"rate", "rad/s", {"rate"}, "rate", {""}}},
          .parts = [](const kreisel::Joint& joint) {
            const auto [first, second] = plane_directions(joint);
            return JointParts{{LinkKind::prismatic, first, 1},
                              {LinkKind::prismatic, second, 1},
                              {LinkKind::revolute, joint.axis}};
          }};
}

}  // namespace kreisel::detail
