#pragma once

#include <Eigen/Core>

#include <vector>

#include <dynamics/file/study_system.hpp>

namespace kreisel {

namespace steady_motion {

/// A state in which all bodies rest but rotors and drives.
struct Equilibrium {
  Eigen::VectorXd state;  ///< angles without a spring in (-pi, pi]
  double residual = 0;    ///< greatest rate that should be 0

  /// Directions of coordinates in which it goes on as a family of equilibria.
  int neutral = 0;

  /// Whether some stiffness is 0 though the neighbouring states are no equilibria.
  bool degenerate = false;
};

struct Equilibria {
  std::vector<Equilibrium> list;  ///< in the order of the search; one of each family
  int starts = 0;                 ///< states from which it was searched
};

/// Equilibria that are found from many starts: zero of all coordinates, the given state, each angle
/// at 0 or pi, then quasi-random states (Halton). From each start go Newton's method, which finds
/// equilibria of all kinds, and a descent along the accelerations, which finds stable ones.
///
/// start : its rates are taken where they are given or those of rotors
/// t_end : up to which the equations have to stay what they are
/// Cost  : at most max(16, 6000/n^2) starts for n rates, at most 100 linearizations for each
[[nodiscard]] Equilibria find_equilibria(const StudySystem& system, const Eigen::VectorXd& start,
                                         double t_end);

/// The state with whole turns added to its angles without a spring, next to those of another.
[[nodiscard]] Eigen::VectorXd in_turns_of(const StudySystem& system, Eigen::VectorXd state,
                                          const Eigen::VectorXd& other);

/// The greatest difference of coordinates, in radian and metre, but for whole turns of angles without
/// a spring; of attitudes that of the angles of the turn between both.
[[nodiscard]] double distance(const StudySystem& system, const Eigen::VectorXd& a,
                              const Eigen::VectorXd& b);

}  // namespace steady_motion

}  // namespace kreisel
