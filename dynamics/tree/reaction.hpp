#pragma once

#include <Eigen/Core>

#include <vector>

#include <motor/frame.hpp>

namespace kreisel {

/// A reaction motor split by causes. For each cause alone the accelerations of all joints are
/// computed, and from them the reaction in this joint. The parts sum to the whole.
///
/// Source : paper 002 (26), its terms moved to the right side one group at a time
/// Frame  : body axes, about the body's origin
/// Units  : N, N m
struct ReactionParts {
  Force<Body> spin;     ///< V' alone: the reaction on a guide at rest, without any force
  Force<Body> guide;    ///< F, oF and their Coriolis terms with V'
  Force<Body> gravity;  ///< weight in a uniform field
  Force<Body> forces;   ///< springs, dampers, constant forces of joints; loads; elements

  [[nodiscard]] Force<Body> total() const { return spin + guide + gravity + forces; }
};

/// The reactions in all joints.
///
/// Units  : N, N m
struct JointReactions {
  /// For each body the force that the PARENT exerts on it through the joint, springs, dampers and
  /// drives included. On body axes, about the body's origin, which moves along if the joint slides.
  std::vector<Force<Body>> on_body;

  /// For each rate the force of a drive or lock, in addition to spring, damper and constant force
  /// of the joint; 0 for JointRule::forces.
  Eigen::VectorXd drive;
};

}  // namespace kreisel
