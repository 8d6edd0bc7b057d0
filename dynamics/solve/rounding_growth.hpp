#pragma once

#include <Eigen/Core>

#include <array>
#include <memory>
#include <stop_token>

#include <dynamics/solve/error_measure.hpp>
#include <dynamics/solve/run_maker.hpp>
#include <dynamics/step/checkpoint.hpp>

namespace kreisel::detail {

/// The growth of rounding, estimated by three runs with the same steps, coarse and cheap. Two of
/// them are perturbed, in different ways, because one alone may miss the direction that grows. Runs
/// with different steps would differ by the errors of these steps. Near a separatrix the growth may
/// far exceed the errors of steps, which cancel there.
class RoundingGrowth {
 public:
  RoundingGrowth(const RunMaker& maker, const Levels& levels, double accuracy);

  /// The size of rounding at t, in the measure of RunReport::error_estimate. Times must be given in
  /// order. 0 if such coarse steps fail.
  [[nodiscard]] double at(double t, double end);

  [[nodiscard]] double evaluations() const;

  void pass(Checkpoint& checkpoint);

 private:
  [[nodiscard]] double distance_at(double t, double end);

  std::stop_token stop_;
  std::unique_ptr<SteppedRun> calm_;
  std::array<std::unique_ptr<SteppedRun>, 2> perturbed_;
  Eigen::VectorXd calm_state_;
  Eigen::VectorXd perturbed_state_;
  BlockDistance distance_;
  bool gave_up_ = false;
};

}  // namespace kreisel::detail
