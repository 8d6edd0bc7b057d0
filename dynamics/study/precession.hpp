#pragma once

#include <Eigen/Core>

#include <vector>

#include <dynamics/step/accuracy.hpp>
#include <motor/api.hpp>

namespace kreisel {

/// The equations of a system with fast rotors where they are linear in the velocities u,
///
///   A u' + c(u) + (G + D) u = Q,   c(0) = 0,
///
/// at one place and time: G skew, of the rotors' momenta; Q all forces at u = 0, those of the
/// guide's motion among them.
///
/// Source : paper 000 (11); D = -dQ/du
struct GyroForces {
  Eigen::MatrixXd A;
  Eigen::MatrixXd G;
  Eigen::MatrixXd D;
  Eigen::VectorXd Q;
};

/// Along which directions the accelerations are kept.
enum class KeptAccelerations {
  on_kernel,  ///< of G at the start: there no gyroscopic moment holds the velocity
  none        ///< the paper's (15); on the kernel of G only damping determines the velocity then
};

struct TechnicalOptions {
  KeptAccelerations kept = KeptAccelerations::on_kernel;
  /// Singular values of G below this part of the greatest count as 0.
  double rank_tolerance = 1e-6;
  Accuracy accuracy = {.relative = 1e-12};
  /// For the time up to which the equations are good enough. Unit of the coordinates
  double tolerated_error = 1e-2;
  /// From the start on, in order: samples at these are wanted.
  std::vector<double> output_times = {};
};

/// A motion by the technical equations, at the end of a step.
///
/// Units  : those of the coordinates and their rates
struct TechnicalSample {
  double t = 0;
  Eigen::VectorXd place;     ///< coordinates, as the model has them
  Eigen::VectorXd velocity;  ///< u
  Eigen::VectorXd drift;     ///< exact less technical motion, its nutations left out; an estimate
  Eigen::VectorXd nutation;  ///< amplitudes of what was left out, component by component
  double bound = 0;  ///< of the distance that both motions have had up to this time, as a norm
};

struct TechnicalMotion {
  std::vector<TechnicalSample> samples;
  /// At the times asked for, as far as the motion went; without drift and nutation, the bound that
  /// of the step's end.
  std::vector<TechnicalSample> outputs;
  int kept = 0;            ///< how many accelerations
  double smallness = 0;    ///< of the slow motion's rates against the nutations', greatest
  bool slow = true;        ///< false: broken off where the motion is no longer slow, smallness 1/2
  double valid_until = 0;  ///< as long as the bound is below what is tolerated
  IntegrationStatistics effort;
  double seconds = 0;  ///< of computing
};

/// What technical equations have to know of a system. Places are its own; displacements e and
/// velocities u have as many components as there are equations.
///
/// Units : s, and those of the system's coordinates and rates
class TechnicalModel {
 public:
  virtual ~TechnicalModel() = default;

  [[nodiscard]] virtual GyroForces forces(double t, const Eigen::VectorXd& place) const = 0;

  /// c(u)
  [[nodiscard]] virtual Eigen::VectorXd motion_forces(double t, const Eigen::VectorXd& place,
                                                      const Eigen::VectorXd& u) const = 0;

  /// Of a place.
  [[nodiscard]] virtual Eigen::VectorXd rate(double /*t*/, const Eigen::VectorXd& /*place*/,
                                             const Eigen::VectorXd& u) const {
    return u;
  }

  /// A place that is displaced.
  [[nodiscard]] virtual Eigen::VectorXd moved(const Eigen::VectorXd& place,
                                              const Eigen::VectorXd& e) const {
    return place + e;
  }

  /// What e' has besides the change of u, where u are no rates of coordinates.
  [[nodiscard]] virtual Eigen::VectorXd turning_along(const Eigen::VectorXd& /*place*/,
                                                      const Eigen::VectorXd& /*u*/,
                                                      const Eigen::VectorXd& e) const {
    return Eigen::VectorXd::Zero(e.size());
  }

  /// Numbers of components of a place whose error is told as one, as ExplicitRungeKutta takes them.
  [[nodiscard]] virtual std::vector<int> blocks() const = 0;
};

/// Integrates the technical (precession) equations
///
///   A N N' u' + (G + D) u = Q(place, t)
///
/// from u(0) on, of which they keep N' u(0) alone, and says how far they lead from the exact ones.
///
/// The bound is no crude norm of the neglected forces r = A u' + c(u) but follows what they do:
/// the drift e of the slow motion by its own linear equations,
///
///   e' = w,   (equations)'e + (G + D) w + A N N' w' = -r,
///
/// begun where the nutation that the start excites has its middle, (G + D)^-1 A (u(0) - u_slow);
/// beside it the nutation itself, each mode with its own decay or growth. The bound is both, times
/// 1.2 + 4 `smallness` for what is of higher order.
///
/// Source : paper 000 (15); errors: G^-1 A(u(0) - u_p(0)) and the integral of G^-1 r, here signed
/// Error  : the true error lies in [0.1, 1] of the bound in >= 95 % of random cases
///          (tests/dynamics/study/precession.cpp) and where G is singular (precession_bodies.cpp).
///          From rest it falls with the momenta L as L^-2, from the technical velocity as L^-3; as
///          L^-1 and L^-2 where inertia couples the kernel of G to the rest; as L^-1 where the
///          kernel turns away from the directions kept, which are those at the start
/// Throws : ComputationFailed where G + D (across N) is singular at the start; and as ExplicitRungeKutta
///          does
KREISEL_API [[nodiscard]] TechnicalMotion technical_motion(const TechnicalModel& model,
                                                           double t_begin,
                                                           const Eigen::VectorXd& place,
                                                           const Eigen::VectorXd& u, double t_end,
                                                           const TechnicalOptions& options = {});

}  // namespace kreisel
