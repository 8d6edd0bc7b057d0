#pragma once

#include <Eigen/Core>

#include <string>
#include <vector>

#include <dynamics/tree/tree.hpp>

/// A body as it is drawn: the homogeneous solid of its mass and inertia; or, where it holds another
/// in bearings at its own centre, the ring of a gimbal, as wide as what turns in it needs.
///
/// Units  : m; vectors on the body's axes
struct Shape {
  std::string form;      ///< ring, cylinder (both about the third axis), box, ellipsoid
  Eigen::Matrix3d axes;  ///< columns: of the solid
  Eigen::Vector3d centre;
  Eigen::Vector3d half;        ///< extents along the axes, to each side; 0 for a point
  bool holds_a_joint = false;  ///< inside, so that one must see through it
  Eigen::Vector3d axle = Eigen::Vector3d::Zero();  ///< to the bearings, both ways; 0: none
  double axle_begin = 0;  ///< from where on it is seen, as a share of its length
  Eigen::Vector3d mark = Eigen::Vector3d::Zero();  ///< the point whose path shows the motion
};

/// The axis about or along which a joint moves a body last, on the body's axes; z where it has none.
[[nodiscard]] Eigen::Vector3d last_axis(const kreisel::BodyDescription& body);

/// The shapes of all bodies.
[[nodiscard]] std::vector<Shape> shapes(const kreisel::BodyTree& tree);
