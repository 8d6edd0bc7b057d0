#pragma once

#include <Eigen/Core>

#include <string>
#include <utility>
#include <vector>

#include <dynamics/solve/solve_options.hpp>
#include <dynamics/study/exponential_panels.hpp>
#include <dynamics/study/linearize.hpp>
#include <dynamics/study/motion_samples.hpp>
#include <dynamics/study/tangent.hpp>
#include <motor/api.hpp>

namespace kreisel {

struct ModelBoundOptions {
  double accuracy = 0.03;        ///< of the deviation
  double tolerance = 1e-12;      ///< a deviation below it need not be resolved
  double absolute_scale = 1e-3;  ///< as SolveOptions::absolute_scale
  double max_evaluations = 1e7;  ///< of the exact field
};

/// Distances of an approximate motion from the exact one, in the measure of
/// RunReport::error_estimate.
struct ModelDistance {
  /// At the output times, as far as the deviation could be followed.
  std::vector<double> bounds;
  std::string message = {};   ///< why not to the end; or empty
  std::vector<double> sizes;  ///< the greatest of each block, as in RunReport
  double evaluations = 0;     ///< of the exact field
};

/// The bound of the error of any approximate motion, without the exact motion.
///
/// The exact motion is moved(x(t), e(t)), x the approximate one. The deviation e follows
///
///   e' = A e + r(t) + n(t, e),   r = exact rates along x - rates of x (the defect),
///
/// n contains all terms of second order. A is the exact linearisation at the start. e is solved on
/// panels with the exponential of A, and repeatedly with n. Three percent of e are accurate enough,
/// which costs a fraction of an exact run. The bound is
///
///   1.05 |e| + the estimated error of e.
///
/// Source : the defect of an approximation, carried by the variational equations
/// Error  : true error / bound in [0.1, 1] for >= 95 % of random scenes, below 1.2
///          (tests/dynamics/file/models.cpp)
class ModelBound {
 public:
  /// scene : Differentiable; it must outlive the bound
  /// state : of the approximate motion at the begin
  template <class Scene>
  ModelBound(const Scene& scene, double begin, const Eigen::VectorXd& state,
             std::vector<int> blocks)
      : tangent_(detail::tangent_of(scene, state.size(), {})),
        field_(tangent_field(scene, tangent_)),
        steps_(detail::reduced(scene, begin, typename Scene::Vector(state), tangent_,
                               detail::InTime::no)
                   .A),
        begin_(begin),
        state_(state),
        blocks_(std::move(blocks)) {}

  /// The bounds at output times.
  ///
  /// start   : of the exact motion
  /// outputs : states of the approximate motion at the times, with corrections that its samples
  ///           lack
  /// stops   : times at which rates of the motion or of the scene jump
  ///
  /// The run ends early, with a message, where an attitude is off by more than 1 rad, or after
  /// max_evaluations: the approximation does not hold there.
  KREISEL_API [[nodiscard]] ModelDistance run(const Eigen::VectorXd& start,
                                              const MotionSampler& motion,
                                              const std::vector<double>& times,
                                              const std::vector<Eigen::VectorXd>& outputs,
                                              const std::vector<double>& stops,
                                              const ModelBoundOptions& options = {}) const;

 private:
  Tangent tangent_;
  TangentField field_;
  ExponentialPanels steps_;
  double begin_;
  Eigen::VectorXd state_;
  std::vector<int> blocks_;
};

}  // namespace kreisel
