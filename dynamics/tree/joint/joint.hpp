#pragma once

#include <Eigen/Geometry>

#include <motor/motor.hpp>

namespace kreisel {

enum class JointKind {
  fixed,
  revolute,     ///< rotates about `axis`
  prismatic,    ///< slides along `axis`
  universal,    ///< rotates about the parent's `axis`, then about `second_axis`, which follows
  spherical,    ///< rotates about a point
  free,         ///< without constraints
  cylindrical,  ///< rotates about `axis` and slides along it
  planar,       ///< slides in the plane normal to `axis` and rotates about it
  screw         ///< rotates about `axis` and advances along it by `pitch`
};

/// The joint of a body: the possible motions relative to its parent.
///
/// At zero coordinates the body's axes are the parent's, rotated by `orientation`, and its origin
/// is at `position`. Both, and the joint's axes, are given on the PARENT's axes. Lengths of axes
/// and norm of the quaternion do not matter.
///
/// Coordinates: revolute and prismatic one, universal two (about `axis`, about `second_axis`);
///              spherical a quaternion (x, y, z, w) of any norm; free such a quaternion, then the
///              position of the body's origin from `position`, on the parent's axes; cylindrical
///              angle and displacement; planar displacements along both directions of
///              plane_directions(), then the angle; screw the angle
/// Rates      : those of the coordinates; for a quaternion the relative angular velocity on the
///              body's axes; for a position the relative velocity on the parent's axes
/// Units      : radian, metre, rad/s, m/s
struct Joint {
  JointKind kind = JointKind::fixed;
  Vector3<double> axis = Vector3<double>::Zero();
  Vector3<double> second_axis = Vector3<double>::Zero();  ///< universal: if the first angle is 0
  Vector3<double> position = Vector3<double>::Zero();
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
  double pitch = 0;  ///< screw: metres per radian, not per revolution; left-handed: negative
};

}  // namespace kreisel
