#pragma once

#include <vector>

#include <dynamics/tree/articulated.hpp>
#include <dynamics/tree/motion.hpp>

namespace kreisel {

namespace detail {

/// What the elimination of a joint with one coordinate leaves: the force motor U that its unit
/// acceleration takes, 1/(U . S), and the force left over for it.
struct SingleElimination {
  Motor<> U = {};
  double inverse = 0;
  double rest = 0;
};

/// The same of a spherical or free joint; x: its acceleration as long as the parent has none.
struct BallElimination {
  FactoredSymmetric3<> linear = {};
  FactoredSymmetric3<> angular = {};
  Matrix3<double> mixed = Matrix3<double>::Zero();
  Motor<> x = {};
};

/// Sizes of what was taken off on the way, to tell an inertia from what rounding left of one.
struct Size {
  double linear = 0;
  double angular = 0;
};

/// How the links move and what that takes. For dual numbers it is all that is needed.
template <class S = double>
struct MotionSpace {
  explicit MotionSpace(const BodyTree& tree)
      : pose(tree.slots()),
        motion(tree.slots()),
        place(tree.slots()),
        inertia(tree.links().size()),
        force(tree.slots()),
        joint_force(Eigen::Matrix<S, Eigen::Dynamic, 1>::Zero(tree.rates())) {}

  std::vector<LinkPose<S>> pose;  ///< of links, then of rotors, as motion, place and force
  std::vector<LinkMotion<S>> motion;
  std::vector<LinkPlace<S>> place;
  std::vector<Inertia<S>> inertia;  ///< on guide axes
  std::vector<Motor<S>> force;      ///< of each link alone, then of it and all that hangs on it
  Eigen::Matrix<S, Eigen::Dynamic, 1> joint_force;
};

}  // namespace detail

/// Scratch memory for one evaluation of a BodySystem at a time: one of it for each thread. All that
/// is computed grows linearly with the number of bodies; nothing is asked of the heap once it is
/// made.
///
/// Cost : 1 kB for each body
struct KREISEL_API BodyWorkspace : detail::MotionSpace<> {
  explicit BodyWorkspace(const BodyTree& tree);

  std::vector<detail::ArticulatedInertia> articulated;
  std::vector<detail::SingleElimination> single;
  std::vector<detail::Size> size;
  std::vector<Motor<>> delta;  ///< acceleration less that with no joint accelerating
  std::vector<detail::BallElimination> ball;
  Eigen::VectorXd still;  ///< rates that are all 0
  Eigen::VectorXd acceleration;
  std::vector<double> spin_up;  ///< of each rotor: the relative acceleration that is asked for
};

}  // namespace kreisel
