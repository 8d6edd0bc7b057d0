#pragma once

#include <Eigen/Core>

#include <optional>
#include <span>
#include <vector>

#include <dynamics/solve/comparison_times.hpp>
#include <dynamics/solve/error_measure.hpp>
#include <dynamics/solve/invariant_watch.hpp>
#include <dynamics/solve/refinement.hpp>
#include <dynamics/solve/rounding_growth.hpp>
#include <dynamics/solve/run_maker.hpp>
#include <dynamics/solve/run_so_far.hpp>
#include <dynamics/step/checkpoint.hpp>

namespace kreisel::detail {

/// The result of the coarser of two runs, with the error that the pair shows.
///
/// The error of the finer run is many times smaller. One run starts a last digit away, or as many
/// digits as rounding changes by the end. The pair then also shows the growth of these digits: near
/// a separatrix, steps of any length round the same digits away. After a try with too great an error
/// Refinement decides how the next one differs. The tries end where the tolerance is kept or
/// rounding leaves nothing to gain.
class PairedRuns {
 public:
  /// spent : evaluations of all runs; those of this object are added
  PairedRuns(const RunMaker& maker, const Levels& levels, const OnComponents& on_output,
             double& spent);

  /// Throws : InvalidInput for a checkpoint of other runs; an empty one stands for the start
  [[nodiscard]] Trajectory<double> solve(const std::vector<double>& checkpoint);

 private:
  /// One try: what the runs of one accuracy show.
  struct Try {
    explicit Try(const RunMaker& maker)
        : watch(maker.scene()), distance(maker.scene().blocks(), maker.options().absolute_scale) {}

    Trajectory<double> result = {};
    InvariantWatch watch;
    BlockDistance distance;
    std::vector<RunSoFar> others = {};
    std::optional<RoundingGrowth> growth = std::nullopt;
    std::size_t done = 0;  ///< number of times at which the runs were compared
    std::span<const double> state = {};
    double expected = 0;  ///< error at the end
    bool rounds_too_much = false;
    bool too_coarse = false;
  };

  [[nodiscard]] RunSoFar made(RunRequest request) const;
  [[nodiscard]] RunSoFar coarse_run() const;
  [[nodiscard]] RunSoFar finer_run() const;
  [[nodiscard]] RunSoFar finer_run(double accuracy, double moved) const;
  void begin_try();
  void continue_from(Checkpoint& numbers);

  void compare();
  [[nodiscard]] bool compare_at_next_time();
  [[nodiscard]] ErrorParts error_at(double t);
  [[nodiscard]] double noise_at(double t);
  void note_error(const ErrorParts& error, double t);
  [[nodiscard]] bool finish_output(double t, double error);

  [[nodiscard]] TryResult summary() const;
  void prepare(Next next);
  void look_for_rounding();
  void shift();
  [[nodiscard]] Trajectory<double> finish();

  void pass_setting(Checkpoint& numbers);
  void pass_runs(Checkpoint& numbers);
  [[nodiscard]] std::vector<double> checkpoint();
  [[nodiscard]] bool has_checkpoints() const;
  [[nodiscard]] double spent_beside() const;

  const RunMaker& maker_;
  const SolveOptions& options_;
  const OnComponents& on_output_;
  double& spent_;
  double end_;
  ComparisonTimes times_;
  Refinement refinement_;
  double coarse_stops_at_ = 0;  ///< RunRequest::stops_at, of the coarser run
  std::optional<RunSoFar> coarse_;
  std::optional<RunSoFar> fine_;
  std::optional<Try> try_;
};

}  // namespace kreisel::detail
