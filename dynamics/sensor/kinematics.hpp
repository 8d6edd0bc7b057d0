#pragma once

#include <Eigen/Core>

#include <vector>

#include <dynamics/guide/resting.hpp>
#include <dynamics/tree/evaluation.hpp>
#include <motor/api.hpp>

namespace kreisel {

template <class M>
class BodySystem;

/// How a body moves against the guide at one moment.
///
/// Frame  : seen from the guide, on the GUIDE's axes; x, v and a are those of the body's origin
/// Units  : metre, rad/s, m/s, rad/s^2, m/s^2
struct BodyKinematics {
  Matrix3<double> R = Matrix3<double>::Identity();  ///< body to guide axes
  Vector3<double> x = Vector3<double>::Zero();
  Vector3<double> w = Vector3<double>::Zero();
  Vector3<double> v = Vector3<double>::Zero();
  Vector3<double> dw = Vector3<double>::Zero();
  Vector3<double> a = Vector3<double>::Zero();
};

/// Gravitation at the points of a system: its uniform field, and one that differs from place to
/// place, which is a load on its bodies.
struct GravityField {
  Vector3<double> uniform = Vector3<double>::Zero();  ///< m/s^2, guide axes
  const BodyLoad* load = nullptr;                     ///< per kg, of a point mass; null: none
};

/// Motion of all bodies of a system and reactions of its joints at one moment: the input of sensors.
///
/// `guide` and `gravity` belong together: the guide may be seen from a frame in free fall, and gravity
/// is then what differs from that fall. `inertial_guide` is the same guide seen from the inertial frame.
struct SystemKinematics {
  double t = 0;
  FrameMotion<Guide, Inertial> guide = {};
  FrameMotion<Guide, Inertial> inertial_guide = {};
  GravityField gravity = {};
  std::vector<BodyKinematics> bodies = {};
  JointReactions reactions = {};

  [[nodiscard]] const BodyKinematics& body(int i) const {
    return bodies[static_cast<std::size_t>(i)];
  }
};

namespace detail {

KREISEL_API [[nodiscard]] SystemKinematics kinematics(const BodyTree& tree, const Surroundings& now,
                                                      const Eigen::VectorXd& y,
                                                      const BodyLoad* gravitation,
                                                      BodyWorkspace& w);

}  // namespace detail

/// Poses, velocities and accelerations of all bodies of a system in the state y, and its reactions.
///
/// Accelerations are those of the forward dynamics, carried outwards from body to body as if the
/// guide rested:  a = a_P + dw_P x r + w_P x (w_P x r) + ..., w = w_P + S v. The guide's own speed
/// does not enter them.
///
/// gravitation : the load that stands for a gravity that is not uniform (EarthGravitation,
///               OblateGravitation); null where the system has none. It has to outlive the result
/// Source : paper 002 (18), (19) from link to link
/// Error  : that of the system's accelerations
/// Cost   : one evaluation of the reactions and one pass outwards, however many sensors read it
/// Throws : InvalidInput where y or w are not of this system
template <class M>
[[nodiscard]] SystemKinematics kinematics(const BodySystem<M>& system, double t,
                                          const Eigen::VectorXd& y, BodyWorkspace& w,
                                          const BodyLoad* gravitation = nullptr) {
  detail::require(system.tree(), y, 0, w);
  const detail::Surroundings now{t, system.guide()(t), detail::is_resting<M>, system.gravity()};
  return detail::kinematics(system.tree(), now, y, gravitation, w);
}

}  // namespace kreisel
