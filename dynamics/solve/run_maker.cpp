#include <algorithm>
#include <cstddef>
#include <limits>
#include <vector>

#include <dynamics/solve/run_maker.hpp>
#include <dynamics/solve/splitting_run.hpp>
#include <dynamics/solve/switching_run.hpp>
#include <dynamics/step/shared.hpp>

namespace kreisel::detail {

Eigen::VectorXd RunMaker::start_of(const RunRequest& request) const {
  Eigen::VectorXd from = after_samples_;
  if (request.moved != 0) move_last_digits(from, request.moved);
  return from;
}

/// The options with the stops of the request among the discontinuities, which steps do not cross.
SolveOptions RunMaker::options_of(const RunRequest& request) const {
  SolveOptions options = options_;
  if (request.stops_at == 0) return options;
  const double end = options.output_times.back();
  const auto [first, last] = std::minmax(options.begin, end);
  std::vector<double> ways{options.begin, end};
  for (const double t : options_.discontinuities) {
    if (t > first && t < last) ways.push_back(t);
  }
  std::sort(ways.begin(), ways.end());
  for (std::size_t i = 1; i < ways.size(); ++i) {
    options.discontinuities.push_back(ways[i - 1] + request.stops_at * (ways[i] - ways[i - 1]));
  }
  return options;
}

std::unique_ptr<SteppedRun> RunMaker::stepped(const Levels& levels,
                                              const RunRequest& request) const {
  const SolveOptions options = options_of(request);
  const bool other = is_other(request);
  const Eigen::VectorXd from = start_of(request);
  const Accuracy accuracy{request.accuracy, options_.absolute_scale, options_.max_evaluations,
                          request.perturbed};
  if (levels.method() == Method::radau13) {
    return std::make_unique<RadauRun>(scene_, other, options, from, accuracy);
  }
  if (options_.method == Method::automatic) {
    return std::make_unique<SwitchingRun>(scene_, other, options, levels.method(), from, accuracy);
  }
  if (levels.method() == Method::taylor) return scene_.taylor_run(options, from, accuracy, other);
  return scene_.explicit_run(options, from, accuracy, other);
}

std::unique_ptr<Run> RunMaker::run(const Levels& levels, const RunRequest& request) const {
  if (levels.adapts()) return stepped(levels, request);
  const Eigen::VectorXd from = start_of(request);
  constexpr double none = std::numeric_limits<double>::infinity();
  const EqualLength length{levels.length(request.accuracy),
                           request.beside > 0 ? levels.length(request.beside) : none};
  if (levels.method() == Method::gauss16) {
    return scene_.gauss_run(options_, from, length, is_other(request));
  }
  return std::make_unique<SplittingRun>(
      *scene_.top(), options_, EulerTop::from_vector(vector_of<EulerTop::Vector>(from)), length);
}

}  // namespace kreisel::detail
