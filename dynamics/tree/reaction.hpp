#pragma once

#include <Eigen/Core>

#include <vector>

#include <motor/frame.hpp>

namespace kreisel {

/// A reaction motor by what causes it: the accelerations of all joints answer each cause by itself,
/// and what that takes from this joint is its part. The parts sum to the whole.
///
/// Source : paper 002 (26), its terms moved to the right side one group at a time
/// Frame  : body axes, about the body's origin
/// Units  : N, N m
struct ReactionParts {
  Force<Body> spin;     ///< V' alone: what would be there on a guide at rest, without any force
  Force<Body> guide;    ///< F, oF and their Coriolis terms with V'
  Force<Body> gravity;  ///< weight in a uniform field
  Force<Body> forces;   ///< springs, dampers and constant forces of joints, loads on bodies

  [[nodiscard]] Force<Body> total() const { return spin + guide + gravity + forces; }
};

/// What the joints carry.
///
/// Units  : N, N m
struct JointReactions {
  /// One for each body: what the PARENT exerts on it through the joint, springs, dampers and drives
  /// included; on body axes, about the body's origin. That lies in the joint; in a prismatic or
  /// free one it has moved along.
  std::vector<Force<Body>> on_body;

  /// One for each rate: what a drive or a lock adds to spring, damper and constant force of its
  /// joint; 0 where forces rule.
  Eigen::VectorXd drive;
};

}  // namespace kreisel
