#pragma once

#include <Eigen/Core>

#include <vector>

#include <dynamics/file/study_system.hpp>

namespace kreisel {

namespace steady_motion {

/// A state in which all bodies except rotors and drives are at rest.
struct Equilibrium {
  Eigen::VectorXd state;  ///< angles whose turns change no rate in (-pi, pi]
  double residual = 0;    ///< greatest rate that should be 0

  /// Number of directions in which it continues as a family of equilibria.
  int neutral = 0;

  /// True if a stiffness is 0 although the neighbouring states are no equilibria.
  bool degenerate = false;
};

struct Equilibria {
  std::vector<Equilibrium> list;  ///< in the order of the search; one for each family
  int starts = 0;                 ///< number of starting states
};

/// Equilibria found from many starts: all coordinates 0, the given state, each angle at 0 or pi,
/// then quasi-random states (Halton). Two searches run from each start. Newton's method finds
/// equilibria of all kinds, and a descent along the accelerations finds stable ones.
///
/// start : its rates are used where they are given or belong to rotors
/// t_end : the equations must not change before this time
/// Cost  : at most max(16, 6000/n^2) starts for n rates, at most 100 linearizations for each
[[nodiscard]] Equilibria find_equilibria(const StudySystem& system, const Eigen::VectorXd& start,
                                         double t_end);

/// The state whose angles are shifted by full rotations, if these change no rate, to be nearest to
/// another state.
[[nodiscard]] Eigen::VectorXd in_turns_of(const StudySystem& system, Eigen::VectorXd state,
                                          const Eigen::VectorXd& other);

/// The greatest difference of coordinates, in radian and metre. Full rotations of angles without a
/// spring are ignored; attitudes differ by the angle of the rotation between them.
[[nodiscard]] double distance(const StudySystem& system, const Eigen::VectorXd& a,
                              const Eigen::VectorXd& b);

}  // namespace steady_motion

}  // namespace kreisel
