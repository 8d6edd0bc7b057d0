#pragma once

#include <Eigen/Core>

#include <complex>
#include <vector>

#include <dynamics/study/precession.hpp>
#include <motor/api.hpp>

namespace kreisel {

/// A root of the precession equations and the nearest exact root.
///
/// Units  : rad/s
struct SlowRoot {
  std::complex<double> precession;
  std::complex<double> exact;
  /// precession + ds, ds = -s^2 y.(A - A N N') x / y.(W + 2 s A N N') x; not a number if the root
  /// is multiple
  std::complex<double> first_order;
};

/// Reasons against the precession equations.
enum class Obstacle {
  none,
  not_determined,  ///< G + D is singular and no accelerations are kept
  not_slow,        ///< a root is off by more than the tolerance: the nutations are not fast
  growing_nutation,
  defective  ///< a multiple slow root with too few shapes, which the neglected terms split
};

/// Admissibility of the precession equations about a state of rest, by all roots.
///
/// Source : paper 000, its condition corrected: det G != 0 is neither sufficient nor, with damping
///          or with kept accelerations, necessary; nor are roots that are all simple
struct Admissibility {
  KeptAccelerations kept = KeptAccelerations::none;  ///< on the kernel, unless that is empty or
                                                     ///< overdamped
  Eigen::VectorXd singular_values;                   ///< of G alone
  int rank = 0;
  Eigen::MatrixXd kernel;          ///< orthonormal columns
  bool kernel_overdamped = false;  ///< damping alone determines the motion there
  std::vector<SlowRoot> slow;
  std::vector<std::complex<double>> fast;  ///< exact roots without a counterpart in the precession
                                           ///< equations
  double greatest_shift = 0;               ///< of a slow root, relative
  double fast_growth = 0;  ///< of the fast roots, beyond that of the slow ones; <= 0 if none grows
  Obstacle obstacle = Obstacle::none;

  [[nodiscard]] bool admissible() const { return obstacle == Obstacle::none; }
};

struct AdmissibilityOptions {
  double rank_tolerance = 1e-6;    ///< of singular values against the greatest
  double tolerated_shift = 0.1;    ///< of slow roots, relative
  double tolerated_growth = 1e-9;  ///< of fast roots, of their size: rounding
};

/// Tests the precession equations about a state of rest: A u' + (G + D) u + K x = 0, x' = u.
///
/// Stiffness : K, which need not be symmetric (circulatory forces)
/// Error     : of the roots as spectrum(); "multiple" are roots that are closer than 1e-6 of their
///             size
/// Throws    : as spectrum(); InvalidInput if A is not positive definite
KREISEL_API [[nodiscard]] Admissibility admissibility(const GyroForces& f, const Eigen::MatrixXd& K,
                                                      const AdmissibilityOptions& options = {});

/// K = -dQ/d(displacement) of a model at rest in a position, by differences.
///
/// Error  : of fourth order in steps of 1e-3
KREISEL_API [[nodiscard]] Eigen::MatrixXd stiffness(const PrecessionModel& model, double t,
                                                    const Eigen::VectorXd& position);

}  // namespace kreisel
