#pragma once

#include <Eigen/Core>

#include <vector>

#include <dynamics/guide/motion.hpp>
#include <dynamics/tree/body_system.hpp>
#include <motor/api.hpp>

namespace kreisel {

/// The inertial forces in the joints of frames with fast rotors, by the kinds of paper 000. They
/// are left sides of the equations. Each vector has a number for each rate of the system:
///
///   inertia           J q''      with the guide at rest
///   gyroscopic        L q'       of the rotors
///   restraint         L W q      by the guide's rotation W: a spring that the rotors make of it
///   guide_change      J W. q     by changes of W
///   guide_inertia     J W.
///   guide_gyroscopic  L W        the disturbance by the guide's rotation
///   left_out          all other terms, as J W W and J q' q': the paper drops them
///
/// Source : paper 000, list below (27)
/// Units  : N m, or N for joints that slide
struct FrameTerms {
  Eigen::VectorXd inertia, gyroscopic, restraint, guide_change, guide_inertia, guide_gyroscopic,
      left_out;
};

/// The FrameTerms of any tree of bodies. q is counted from the position in which all coordinates
/// are 0. Restraint and guide_change are differences from there and so contain all orders of q.
///
/// A rotor is a body with a Rotor, or one whose joint is driven at a constant rate. Translation of
/// the guide, springs, loads and gravity are no part of these terms.
///
/// Error  : their sum is the inverse dynamics of the tree to rounding
///          (tests/dynamics/study/frame_terms)
/// Cost   : nine evaluations of the inverse dynamics, and memory is allocated
class KREISEL_API FrameTermsOf {
 public:
  explicit FrameTermsOf(const std::vector<BodyDescription>& bodies);

  /// True if a body is a rotor.
  [[nodiscard]] bool has_rotors() const { return has_rotors_; }
  [[nodiscard]] const BodyTree& tree() const { return system_.tree(); }

  /// guide : its angular velocity and acceleration at the time of the state
  [[nodiscard]] FrameTerms operator()(const FrameTurning<double>& guide,
                                      const Eigen::VectorXd& coordinates,
                                      const Eigen::VectorXd& rates,
                                      const Eigen::VectorXd& accelerations) const;

 private:
  /// A guide that turns as it is told and stays where it is.
  struct Turning {
    FrameTurning<double> now = {};
    [[nodiscard]] FrameMotion<Guide, Inertial> operator()(double /*t*/) const {
      FrameMotion<Guide, Inertial> motion;
      motion.V.value.resultant = now.u;
      motion.dV.value.resultant = now.du;
      return motion;
    }
  };

  /// The joint forces for a motion of the joints on a guide that turns.
  [[nodiscard]] Eigen::VectorXd forces(const FrameTurning<double>& guide,
                                       const Eigen::VectorXd& coordinates,
                                       const Eigen::VectorXd& rates,
                                       const Eigen::VectorXd& accelerations) const;

  std::vector<BodyDescription> bodies_;  ///< without forces, drives and loads
  BodySystem<Turning> system_;
  Eigen::VectorXd of_frames_;  ///< 1 for the rates of frames, 0 for those of rotors
  bool has_rotors_ = false;
};

}  // namespace kreisel
