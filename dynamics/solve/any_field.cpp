#include <Eigen/Core>

#include <memory>
#include <utility>

#include <dynamics/solve/any_field.hpp>
#include <dynamics/solve/runs_of_steps.hpp>
#include <dynamics/step/jacobian.hpp>

namespace kreisel::detail {

std::unique_ptr<SteppedRun> run_explicit_steps(const SteppedScene& scene, const AnyField& field,
                                               const SolveOptions& options,
                                               const Eigen::VectorXd& start,
                                               const Accuracy& accuracy) {
  return run_explicit_steps<Eigen::VectorXd, AnyField>(scene, field, options, start, accuracy);
}

std::unique_ptr<Run> run_gauss_steps(const SteppedScene& scene, const AnyField& field,
                                     const SolveOptions& options, const Eigen::VectorXd& start,
                                     const EqualLength& length) {
  return run_gauss_steps<Eigen::VectorXd, AnyField>(scene, field, options, start, length);
}

std::unique_ptr<SteppedRun> run_taylor_steps(const SteppedScene& scene, const AnySeries& series,
                                             const SolveOptions& options,
                                             const Eigen::VectorXd& start,
                                             const Accuracy& accuracy) {
  return run_taylor_steps<Eigen::VectorXd, AnySeries>(scene, series, options, start, accuracy);
}

std::unique_ptr<StiffField> stiff_field(const AnyField& field) {
  auto jacobian = difference_jacobian<Eigen::Dynamic>(field);
  using J = decltype(jacobian);
  return std::make_unique<StiffFieldOf<Eigen::VectorXd, AnyField, J>>(field, std::move(jacobian));
}

}  // namespace kreisel::detail
