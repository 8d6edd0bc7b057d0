#pragma once

#include <Eigen/Core>

#include <memory>

#include <dynamics/solve/levels.hpp>
#include <dynamics/solve/run.hpp>

namespace kreisel::detail {

/// The differences of a run to others of the same scene and start.
struct RunRequest {
  double accuracy;
  double moved = 0;  ///< start, by so many last digits; the perturbed copy of the scene if not 0
  double perturbed = 0;  ///< each step, by so many last digits
  double beside = 0;     ///< accuracy of the coarser run of the pair; 0 for that run
  double stops_at = 0;   ///< a step ends at this part of each way between discontinuities; 0: none
};

/// Makes the runs of a scene from one start.
class RunMaker {
 public:
  /// The arguments must outlive it.
  RunMaker(const SteppedScene& scene, const SolveOptions& options, const Eigen::VectorXd& start)
      : scene_(scene),
        options_(options),
        start_(start),
        after_samples_(scene.sampled(options.begin, start)) {}

  [[nodiscard]] std::unique_ptr<Run> run(const Levels& levels, const RunRequest& request) const;

  /// A run whose steps adapt.
  [[nodiscard]] std::unique_ptr<SteppedRun> stepped(const Levels& levels,
                                                    const RunRequest& request) const;

  [[nodiscard]] const SteppedScene& scene() const { return scene_; }
  [[nodiscard]] const SolveOptions& options() const { return options_; }
  [[nodiscard]] const Eigen::VectorXd& start() const { return start_; }
  /// The state with which runs begin: after the samples at the start.
  [[nodiscard]] const Eigen::VectorXd& start_after_samples() const { return after_samples_; }

 private:
  [[nodiscard]] Eigen::VectorXd start_of(const RunRequest& request) const;
  [[nodiscard]] SolveOptions options_of(const RunRequest& request) const;
  [[nodiscard]] bool is_other(const RunRequest& request) const {
    return request.moved != 0 && scene_.has_other();
  }

  const SteppedScene& scene_;
  const SolveOptions& options_;
  const Eigen::VectorXd& start_;
  Eigen::VectorXd after_samples_;
};

}  // namespace kreisel::detail
