#pragma once

#include <Eigen/Core>

#include <functional>
#include <vector>

#include <dynamics/study/motion_samples.hpp>
#include <dynamics/study/tangent.hpp>
#include <motor/api.hpp>

namespace kreisel {

/// A motion of which only states are known, as polynomials on equal panels. Its rates are those of
/// the polynomials.
///
/// Error  : of the states 1e-11 of the greatest of each component; of the rates at most 1e5 times as
///          much per length of a panel
/// Cost   : states at 12 times on each panel; the number of panels is doubled until they resolve
///          the motion
class InterpolatedMotion {
 public:
  /// The states at times in order.
  using States = std::function<std::vector<Eigen::VectorXd>(const std::vector<double>& times)>;

  /// Throws : ComputationFailed if 16384 panels do not resolve the motion
  KREISEL_API InterpolatedMotion(const Tangent& tangent, const States& states, double begin,
                                 double end);

  [[nodiscard]] KREISEL_API MotionSampler sampler() const;

  /// The ends of all panels.
  [[nodiscard]] KREISEL_API std::vector<double> stops() const;

 private:
  /// False if the panels do not resolve the motion.
  bool interpolate(const States& states, int panels);

  Tangent tangent_;
  double begin_;
  double end_;
  std::vector<Eigen::MatrixXd> coefficients_;
};

}  // namespace kreisel
