#pragma once

#include <Eigen/Geometry>

#include <algorithm>

#include <dynamics/step/integrator.hpp>
#include <motor/displacement.hpp>

namespace kreisel {

/// Error of a body's linear equations against its exact ones.
///
/// Units  : metre, radian
struct LinearError {
  double displacement = 0;    ///< the greatest distance between both positions
  double angle = 0;           ///< the greatest angle between both attitudes
  double greatest_angle = 0;  ///< of the linear motion: the errors are of second order in it
};

/// Runs a linear scene and its exact scene side by side from t_begin to t_end. The accuracy of the
/// steps must be finer than the error to be measured.
///
/// Scene  : has State with displacement and angles, exact() and exact_state(State)
/// Throws : as Integrator
template <class Linear>
[[nodiscard]] LinearError linear_error(const Linear& linear, const typename Linear::State& start,
                                       double t_begin, double t_end, int samples = 200,
                                       const Accuracy& accuracy = {.relative = 1e-10}) {
  const auto exact = linear.exact();
  Integrator approximate(linear, t_begin, start, accuracy);
  Integrator true_run(exact, t_begin, Linear::exact_state(start), accuracy);
  LinearError error;
  for (int i = 0; i <= samples; ++i) {
    const double t = t_begin + (t_end - t_begin) * i / samples;
    const auto a = approximate.to(t);
    const auto b = true_run.to(t);
    const Matrix3<double> R = exp(Motor<double>{a.angles, Vector3<double>::Zero()}).rotation;
    const Matrix3<double> off = R.transpose() * Pose<double>::from(b.attitude).rotation;
    const double angle = log(Pose<double>{off}).resultant.norm();
    error.displacement = std::max(error.displacement, (a.displacement - b.position).norm());
    error.angle = std::max(error.angle, angle);
    error.greatest_angle = std::max(error.greatest_angle, a.angles.norm());
  }
  return error;
}

}  // namespace kreisel
