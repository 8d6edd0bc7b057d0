#pragma once

#include <Eigen/Cholesky>

#include <vector>

#include <dynamics/body/articulated.hpp>
#include <dynamics/body/motion.hpp>

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
  Eigen::LDLT<Matrix3<double>> linear = {};
  Eigen::LDLT<Matrix3<double>> angular = {};
  Matrix3<double> mixed = Matrix3<double>::Zero();
  Motor<> x = {};
};

/// Sizes of what was taken off on the way, to tell an inertia from what rounding left of one.
struct Size {
  double linear = 0;
  double angular = 0;
};

}  // namespace detail

/// Scratch memory for one evaluation of a BodySystem at a time: one of it for each thread. All that
/// is computed grows linearly with the number of bodies; nothing is asked of the heap once it is
/// made.
///
/// Cost : 1 kB for each body
struct BodyWorkspace {
  explicit BodyWorkspace(const BodyTree& tree)
      : pose(tree.links().size()),
        motion(tree.links().size()),
        place(tree.links().size()),
        inertia(tree.links().size()),
        force(tree.links().size()),
        articulated(tree.links().size()),
        single(tree.links().size()),
        size(tree.links().size()),
        delta(tree.links().size()),
        ball(static_cast<std::size_t>(tree.balls())),
        joint_force(Eigen::VectorXd::Zero(tree.rates())),
        still(Eigen::VectorXd::Zero(tree.rates())),
        acceleration(Eigen::VectorXd::Zero(tree.rates())) {}

  std::vector<detail::LinkPose> pose;
  std::vector<detail::LinkMotion> motion;
  std::vector<detail::LinkPlace> place;
  std::vector<Inertia<>> inertia;  ///< on guide axes
  std::vector<Motor<>> force;      ///< of each link alone, then of it and all that hangs on it
  std::vector<detail::ArticulatedInertia> articulated;
  std::vector<detail::SingleElimination> single;
  std::vector<detail::Size> size;
  std::vector<Motor<>> delta;  ///< acceleration less that with no joint accelerating
  std::vector<detail::BallElimination> ball;
  Eigen::VectorXd joint_force;
  Eigen::VectorXd still;  ///< rates that are all 0
  Eigen::VectorXd acceleration;
};

}  // namespace kreisel
