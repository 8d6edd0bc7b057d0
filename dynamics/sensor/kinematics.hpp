#pragma once

#include <Eigen/Core>

#include <vector>

#include <dynamics/guide/resting.hpp>
#include <dynamics/tree/evaluation.hpp>
#include <motor/api.hpp>

namespace kreisel {

template <class M>
class BodySystem;

/// The motion of a body relative to the guide at one moment.
///
/// Frame  : relative to the guide, on the GUIDE's axes; x, v and a are those of the body's origin
/// Units  : metre, rad/s, m/s, rad/s^2, m/s^2
struct BodyKinematics {
  Matrix3<double> R = Matrix3<double>::Identity();  ///< body to guide axes
  Vector3<double> x = Vector3<double>::Zero();
  Vector3<double> w = Vector3<double>::Zero();
  Vector3<double> v = Vector3<double>::Zero();
  Vector3<double> dw = Vector3<double>::Zero();
  Vector3<double> a = Vector3<double>::Zero();
};

/// The gravitation on a system: a uniform field, and a field that depends on the position, which is
/// a load on the bodies.
struct GravityField {
  Vector3<double> uniform = Vector3<double>::Zero();  ///< m/s^2, guide axes
  const BodyLoad* load = nullptr;                     ///< per kg, for a point mass; null: none
};

/// The force of an element or a constraint at one moment.
///
/// Frame  : on the FIRST body's axes; on the second body, about its point `at`
/// Units  : metre (at: second body's axes), N, N m
struct ElementLoad {
  int first = -1;  ///< bodies; -1: the guide
  int second = -1;
  Vector3<double> at = Vector3<double>::Zero();
  Motor<> force = {};
};

/// The motion of all bodies of a system and the forces of its joints and elements at one moment.
/// Sensors read it, and their readings are integrated from it.
///
/// `guide` and `gravity` belong together: the guide's motion may be relative to a frame in free
/// fall, and gravity is then the difference from that fall. `inertial_guide` is the motion of the
/// same guide relative to the inertial frame.
struct SystemKinematics {
  double t = 0;
  FrameMotion<Guide, Inertial> guide = {};
  FrameMotion<Guide, Inertial> inertial_guide = {};
  GravityField gravity = {};
  std::vector<BodyKinematics> bodies = {};
  JointReactions reactions = {};
  std::vector<ElementLoad> elements = {};  ///< and, after them, of the constraints
  Eigen::VectorXd rates = {};  ///< y' of the state: of all coordinates, then of the rates

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

/// Poses, velocities and accelerations of all bodies of a system in the state y, and the reactions.
///
/// The accelerations come from the forward dynamics. They are relative to the guide, summed
/// outwards from body to body:  a = a_P + dw_P x r + w_P x (w_P x r) + ..., w = w_P + S v.  The
/// guide's own speed does not enter.
///
/// gravitation : the load of a gravity that is not uniform (EarthGravitation, OblateGravitation);
///               null if there is none. It must outlive the result
/// Source : paper 002 (18), (19) from link to link
/// Error  : that of the system's accelerations
/// Cost   : one evaluation of the reactions and one pass outwards, however many sensors read it
/// Throws : InvalidInput if y or w does not belong to this system
template <class M>
[[nodiscard]] SystemKinematics kinematics(const BodySystem<M>& system, double t,
                                          const Eigen::VectorXd& y, BodyWorkspace& w,
                                          const BodyLoad* gravitation = nullptr) {
  detail::require(system.tree(), y, 0, w);
  const detail::Surroundings now{t, system.guide()(t), detail::is_resting<M>, system.gravity()};
  return detail::kinematics(system.tree(), now, y, gravitation, w);
}

}  // namespace kreisel
