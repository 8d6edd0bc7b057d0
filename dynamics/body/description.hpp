#pragma once

#include <Eigen/Geometry>

#include <concepts>
#include <functional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <dynamics/inertia.hpp>
#include <dynamics/scene/load.hpp>

namespace kreisel {

enum class JointKind {
  fixed,
  revolute,   ///< turns about `axis`
  prismatic,  ///< slides along `axis`
  universal,  ///< turns about `axis` of the parent, then about `second_axis`, which turns along
  spherical,  ///< turns about a point
  free        ///< not joined at all
};

/// How a body may move against its parent.
///
/// At zero coordinates the body's axes are the parent's, turned by `orientation`, and its origin
/// lies at `position`. Both, and the axes, are written on the PARENT's axes; lengths of axes and
/// norm of the quaternion do not matter.
///
/// Coordinates: revolute and prismatic one, universal two (about `axis`, about `second_axis`);
///              spherical a quaternion (x, y, z, w) of any norm; free such a quaternion, then the
///              place of the body's origin, from `position`, on the parent's axes
/// Rates      : the coordinates' own; for a quaternion the angular velocity against the parent, on
///              the body's axes; for a place the velocity against the parent, on the parent's axes
/// Units      : radian, metre, rad/s, m/s
struct Joint {
  JointKind kind = JointKind::fixed;
  Vector3<double> axis = Vector3<double>::Zero();
  Vector3<double> second_axis = Vector3<double>::Zero();  ///< universal: with the first at 0
  Vector3<double> position = Vector3<double>::Zero();
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
};

/// A joint force that follows one coordinate q or rate:  constant - stiffness (q - rest) - damping
/// q'. A quaternion and a free place have no spring, for they have no single coordinate to pull at.
///
/// Units  : N m/rad and N m s/rad, or N/m and N s/m; rad or m; N m or N
struct JointForce {
  double stiffness = 0;
  double rest = 0;
  double damping = 0;
  double constant = 0;
};

/// What rules the motion in a joint.
enum class JointRule {
  forces,        ///< the forces on the bodies
  held,          ///< locked where it is; its rates count as 0
  constant_rate  ///< revolute only: a motor keeps the rate whatever torque that takes
};

/// Any Load, kept by value.
class BodyLoad {
 public:
  template <Load L>
  requires(!std::same_as<L, BodyLoad>) BodyLoad(L load)
      : force_(load) {  // NOLINT: a load is meant where a load is taken
    if constexpr (requires(const Situation<>& s) { load.potential(s); }) {
      potential_ = [load](const Situation<>& s) { return load.potential(s); };
    }
  }

  [[nodiscard]] Force<Body> operator()(const Situation<>& s) const { return force_(s); }

  [[nodiscard]] bool has_potential() const { return static_cast<bool>(potential_); }
  [[nodiscard]] double potential(const Situation<>& s) const {
    return potential_ ? potential_(s) : 0;
  }

 private:
  std::function<Force<Body>(const Situation<>&)> force_;
  std::function<double(const Situation<>&)> potential_;
};

/// One body of a system and the joint that holds it to its parent.
struct BodyDescription {
  std::string name;
  std::string parent = "guide";  ///< the guide frame, or the name of a body earlier in the list
  Joint joint = {};
  InertiaTensor<Body> inertia = {};     ///< about the body's origin, which lies in the joint
  std::vector<JointForce> forces = {};  ///< one for each rate of the joint, or none
  JointRule rule = JointRule::forces;
  std::vector<BodyLoad> loads = {};
};

/// The field of gravity that all bodies of a system are in; a field that is not uniform is a load.
using Gravity = std::variant<std::monostate, UniformGravity<Guide>, UniformGravity<Inertial>>;

}  // namespace kreisel
