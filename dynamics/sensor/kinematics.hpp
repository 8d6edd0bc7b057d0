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
template <class S>
struct BodyKinematicsOn {
  Matrix3<S> R = Matrix3<S>::Identity();  ///< body to guide axes
  Vector3<S> x = Vector3<S>::Zero();
  Vector3<S> w = Vector3<S>::Zero();
  Vector3<S> v = Vector3<S>::Zero();
  Vector3<S> dw = Vector3<S>::Zero();
  Vector3<S> a = Vector3<S>::Zero();
};

using BodyKinematics = BodyKinematicsOn<double>;

/// The gravitation on a system: a uniform field, and a field that depends on the position, which is
/// a load on the bodies.
template <class S>
struct GravityFieldOn {
  Vector3<S> uniform = Vector3<S>::Zero();  ///< m/s^2, guide axes
  const BodyLoad* load = nullptr;           ///< per kg, for a point mass; null: none
};

using GravityField = GravityFieldOn<double>;

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

/// The motion of all bodies of a system at one moment, in double or dual numbers.
///
/// `guide` and `gravity` belong together: the guide's motion may be relative to a frame in free
/// fall, and gravity is then the difference from that fall. `inertial_guide` is the motion of the
/// same guide relative to the inertial frame.
template <class S>
struct MotionOfBodies {
  S t = S(0);
  FrameMotion<Guide, Inertial, S> guide = {};
  FrameMotion<Guide, Inertial, S> inertial_guide = {};
  GravityFieldOn<S> gravity = {};
  std::vector<BodyKinematicsOn<S>> bodies = {};

  [[nodiscard]] const BodyKinematicsOn<S>& body(int i) const {
    return bodies[static_cast<std::size_t>(i)];
  }
};

/// The motion of all bodies of a system and the forces of its joints and elements at one moment.
/// Sensors read it, and their readings are integrated from it.
struct SystemKinematics : MotionOfBodies<double> {
  JointReactions reactions = {};
  std::vector<ElementLoad> elements = {};  ///< and, after them, of the constraints
  Eigen::VectorXd rates = {};  ///< y' of the state: of coordinates, rates, memory of controllers
  std::vector<Eigen::VectorXd> outputs = {};  ///< joint forces of each controller, N m or N
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
  return detail::kinematics(system.tree(), system.at(t), y, gravitation, w);
}

}  // namespace kreisel
