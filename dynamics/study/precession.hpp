#pragma once

#include <Eigen/Core>

#include <vector>

#include <dynamics/step/accuracy.hpp>
#include <motor/api.hpp>

namespace kreisel {

/// The forces of a system with fast rotors at one position and time, linear in the velocities u:
///
///   A u' + c(u) + (G + D) u = Q,   c(0) = 0,
///
/// G is skew, from the rotors' momenta. Q contains all forces at u = 0, also those of the guide's
/// motion.
///
/// Source : paper 000 (11); D = -dQ/du
struct GyroForces {
  Eigen::MatrixXd A;
  Eigen::MatrixXd G;
  Eigen::MatrixXd D;
  Eigen::VectorXd Q;
};

/// Directions in which the accelerations are kept.
enum class KeptAccelerations {
  on_kernel,  ///< of G at the start: no gyroscopic moment resists the velocity there
  none        ///< the paper's (15); only damping then determines the velocity on the kernel of G
};

struct PrecessionOptions {
  KeptAccelerations kept = KeptAccelerations::on_kernel;
  /// Singular values of G below this part of the greatest count as 0.
  double rank_tolerance = 1e-6;
  Accuracy accuracy = {.relative = 1e-12};
  /// Defines the time up to which the equations are good enough. Unit of the coordinates
  double tolerated_error = 1e-2;
  /// Times of requested samples from the start on, in order.
  std::vector<double> output_times = {};
};

/// A sample of a motion by the precession equations, at the end of a step.
///
/// Units  : those of the coordinates and their rates
struct PrecessionSample {
  double t = 0;
  Eigen::VectorXd position;  ///< coordinates of the model
  Eigen::VectorXd velocity;  ///< u
  Eigen::VectorXd drift;     ///< exact minus precession motion without its nutations; an estimate
  Eigen::VectorXd nutation;  ///< amplitudes of the neglected nutations, component by component
  double bound = 0;          ///< of the distance of both motions up to this time, as a norm
};

struct PrecessionMotion {
  std::vector<PrecessionSample> samples;
  /// At the requested times, as far as the motion went. Drift and nutation are absent; the bound is
  /// that of the step's end.
  std::vector<PrecessionSample> outputs;
  int kept = 0;            ///< number of kept accelerations
  double smallness = 0;    ///< greatest ratio of the slow motion's rates to the nutations'
  bool slow = true;        ///< false: stopped because the motion is no longer slow, smallness 1/2
  double valid_until = 0;  ///< time up to which the bound is below the tolerated error
  IntegrationStatistics effort;
  double seconds = 0;  ///< of computing time
};

/// Interface of a system for precession equations. Positions are in the model's own coordinates.
/// Displacements e and velocities u have one component for each equation.
///
/// Units  : s, and those of the system's coordinates and rates
class PrecessionModel {
 public:
  virtual ~PrecessionModel() = default;

  [[nodiscard]] virtual GyroForces forces(double t, const Eigen::VectorXd& position) const = 0;

  /// c(u)
  [[nodiscard]] virtual Eigen::VectorXd motion_forces(double t, const Eigen::VectorXd& position,
                                                      const Eigen::VectorXd& u) const = 0;

  /// The rate of a position.
  [[nodiscard]] virtual Eigen::VectorXd rate(double /*t*/, const Eigen::VectorXd& /*position*/,
                                             const Eigen::VectorXd& u) const {
    return u;
  }

  /// A displaced position.
  [[nodiscard]] virtual Eigen::VectorXd moved(const Eigen::VectorXd& position,
                                              const Eigen::VectorXd& e) const {
    return position + e;
  }

  /// The part of e' besides the change of u, if u are not rates of coordinates.
  [[nodiscard]] virtual Eigen::VectorXd turning_along(const Eigen::VectorXd& /*position*/,
                                                      const Eigen::VectorXd& /*u*/,
                                                      const Eigen::VectorXd& e) const {
    return Eigen::VectorXd::Zero(e.size());
  }

  /// Numbers of components of a position whose errors are measured together, as in
  /// ExplicitRungeKutta.
  [[nodiscard]] virtual std::vector<int> blocks() const = 0;
};

/// Integrates the precession (technical) equations
///
///   A N N' u' + (G + D) u = Q(position, t)
///
/// from u(0), of which only N' u(0) is kept, with a bound of their deviation from the exact
/// equations.
///
/// The bound is no crude norm of the neglected forces r = A u' + c(u). It follows their effect, the
/// drift e of the slow motion, by the linear equations of that drift:
///
///   e' = w,   (equations)'e + (G + D) w + A N N' w' = -r,
///
/// The drift starts at the centre of the excited nutation, (G + D)^-1 A (u(0) - u_slow). The
/// nutation itself is added, each mode with its own decay or growth. The sum of both is multiplied
/// by 1.2 + 4 `smallness` for terms of higher order.
///
/// Source : paper 000 (15); errors: G^-1 A(u(0) - u_p(0)) and the integral of G^-1 r, here signed
/// Error  : the true error lies in [0.1, 1] of the bound in >= 95 % of random cases
///          (tests/dynamics/study/precession.cpp) and where G is singular (precession_bodies.cpp).
///          From rest it falls with the momenta L as L^-2, from the precession velocity as L^-3; as
///          L^-1 and L^-2 where inertia couples the kernel of G to the rest; as L^-1 where the
///          kernel turns away from the directions kept, which are those at the start
/// Throws : as ExplicitRungeKutta; ComputationFailed if G + D (across N) is singular at the start
KREISEL_API [[nodiscard]] PrecessionMotion precession_motion(const PrecessionModel& model,
                                                             double t_begin,
                                                             const Eigen::VectorXd& position,
                                                             const Eigen::VectorXd& u, double t_end,
                                                             const PrecessionOptions& options = {});

}  // namespace kreisel
