#pragma once

#include <Eigen/Geometry>

#include <motor/motor.hpp>

namespace kreisel {

enum class JointKind {
  fixed,
  revolute,     ///< turns about `axis`
  prismatic,    ///< slides along `axis`
  universal,    ///< turns about `axis` of the parent, then about `second_axis`, which turns along
  spherical,    ///< turns about a point
  free,         ///< not joined at all
  cylindrical,  ///< turns about `axis` and slides along it
  planar,       ///< slides in the plane normal to `axis` and turns about it
  screw         ///< turns about `axis` and advances along it by `pitch`
};

/// How a body may move against its parent.
///
/// At zero coordinates the body's axes are the parent's, turned by `orientation`, and its origin
/// lies at `position`. Both, and the axes, are written on the PARENT's axes; lengths of axes and
/// norm of the quaternion do not matter.
///
/// Coordinates: revolute and prismatic one, universal two (about `axis`, about `second_axis`);
///              spherical a quaternion (x, y, z, w) of any norm; free such a quaternion, then the
///              place of the body's origin, from `position`, on the parent's axes; cylindrical
///              angle and displacement; planar displacements along both directions of
///              directions(), then the angle; screw the angle
/// Rates      : the coordinates' own; for a quaternion the angular velocity against the parent, on
///              the body's axes; for a place the velocity against the parent, on the parent's axes
/// Units      : radian, metre, rad/s, m/s
struct Joint {
  JointKind kind = JointKind::fixed;
  Vector3<double> axis = Vector3<double>::Zero();
  Vector3<double> second_axis = Vector3<double>::Zero();  ///< universal: with the first at 0
  Vector3<double> position = Vector3<double>::Zero();
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
  double pitch = 0;  ///< screw: metres per radian, not per turn; negative of a left-handed one
};

}  // namespace kreisel
