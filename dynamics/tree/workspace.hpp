#pragma once

#include <memory>
#include <vector>

#include <dynamics/tree/articulated.hpp>
#include <dynamics/tree/disturbance.hpp>
#include <dynamics/tree/motion.hpp>

namespace kreisel {

namespace detail {

/// The elimination of a joint with one coordinate: the force motor U for its unit acceleration,
/// 1/(U . S), and the joint force less the force that the motion needs at dv = 0.
struct SingleElimination {
  Motor<> U = {};
  double inverse = 0;
  double rest = 0;
};

/// The elimination of a spherical or free joint; x is its acceleration if the parent has none.
struct BallElimination {
  FactoredSymmetric3<> linear = {};
  FactoredSymmetric3<> angular = {};
  Matrix3<double> mixed = Matrix3<double>::Zero();
  Motor<> x = {};
};

/// Sums of the inertias before subtraction: the scale by which rounding errors are recognized.
struct Size {
  double linear = 0;
  double angular = 0;
};

/// Motions of the links and the forces that they need. Evaluations in dual numbers need nothing
/// more.
template <class S = double>
struct MotionSpace {
  explicit MotionSpace(const BodyTree& tree)
      : pose(tree.slots()),
        motion(tree.slots()),
        place(tree.slots()),
        inertia(tree.links().size()),
        force(tree.slots()),
        joint_force(Eigen::Matrix<S, Eigen::Dynamic, 1>::Zero(tree.rates())) {}

  std::vector<LinkPose<S>> pose;  ///< of links, then of rotors, as for motion, place and force
  std::vector<LinkMotion<S>> motion;
  std::vector<LinkPlace<S>> place;
  std::vector<Inertia<S>> inertia;  ///< on guide axes
  std::vector<Motor<S>> force;      ///< of each link alone, then of it and all links outward
  Eigen::Matrix<S, Eigen::Dynamic, 1> joint_force;
};

struct ConstraintSpace;

/// The memory for constraints: nothing until it is asked for.
class KREISEL_API ConstraintMemory {
 public:
  ConstraintMemory();
  ConstraintMemory(const ConstraintMemory& other);
  ConstraintMemory(ConstraintMemory&& other) noexcept;
  ConstraintMemory& operator=(const ConstraintMemory& other);
  ConstraintMemory& operator=(ConstraintMemory&& other) noexcept;
  ~ConstraintMemory();

  [[nodiscard]] ConstraintSpace& operator*();

 private:
  std::unique_ptr<ConstraintSpace> space_;
};

}  // namespace detail

/// Scratch memory of a BodySystem; each thread needs its own. An evaluation with a workspace
/// allocates no memory.
///
/// Cost : 1 kB for each body
struct KREISEL_API BodyWorkspace : detail::MotionSpace<> {
  explicit BodyWorkspace(const BodyTree& tree);
  // Compiled once, in libkreisel: programs would instantiate the vectors' own.
  BodyWorkspace(const BodyWorkspace& other);
  BodyWorkspace(BodyWorkspace&& other) noexcept;
  BodyWorkspace& operator=(const BodyWorkspace& other);
  BodyWorkspace& operator=(BodyWorkspace&& other) noexcept;
  ~BodyWorkspace();

  std::vector<detail::ArticulatedInertia> articulated;
  std::vector<detail::SingleElimination> single;
  std::vector<detail::Size> size;
  std::vector<Motor<>> delta;  ///< acceleration less the one at dv = 0
  std::vector<detail::BallElimination> ball;
  Eigen::VectorXd still;  ///< rates that are all 0
  Eigen::VectorXd acceleration;
  OutsideForces<double> outside;  ///< forces from outside, of the caller
  std::vector<double> spin_up;    ///< prescribed relative acceleration of each rotor
  std::vector<double> driven;     ///< prescribed derivatives of rates; the others are 0
  detail::ConstraintMemory constraints;
};

}  // namespace kreisel
