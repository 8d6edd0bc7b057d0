#pragma once

#include <Eigen/Core>

#include <string>
#include <vector>

#include <dynamics/tree/tree.hpp>

/// A body as it is drawn. It is the homogeneous solid of its mass and inertia. A body that holds
/// another one in bearings at its own centre is the ring of a gimbal, wide enough for the parts in
/// it.
///
/// Units  : m; vectors on the body's axes
struct Shape {
  std::string form;      ///< ring, cylinder (both about the third axis), box, ellipsoid
  Eigen::Matrix3d axes;  ///< columns: of the solid
  Eigen::Vector3d centre;
  Eigen::Vector3d half;        ///< extents along the axes, to each side; 0 for a point
  bool holds_a_joint = false;  ///< inside, so that it must be transparent
  Eigen::Vector3d axle = Eigen::Vector3d::Zero();  ///< to the bearings, in both directions; 0: none
  double axle_begin = 0;  ///< where its visible part begins, as a share of its length
  Eigen::Vector3d mark = Eigen::Vector3d::Zero();  ///< the point whose path shows the motion
};

/// The last axis about or along which a joint moves a body, on the body's axes; z if it has none.
[[nodiscard]] Eigen::Vector3d last_axis(const kreisel::BodyDescription& body);

/// The shapes of all bodies.
[[nodiscard]] std::vector<Shape> shapes(const kreisel::BodyTree& tree);
