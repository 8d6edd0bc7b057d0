#pragma once

#include <span>
#include <vector>

#include <dynamics/solve/invariant_watch.hpp>
#include <dynamics/solve/report.hpp>
#include <dynamics/solve/run.hpp>

/// Outputs of a run: recorded with their errors, and passed to on_output, which may end the run.

namespace kreisel::detail {

[[nodiscard]] inline std::span<const double> components_of(const Eigen::VectorXd& y) {
  return {y.data(), static_cast<std::size_t>(y.size())};
}

/// Marks a run as cancelled by `who`.
void cancel(RunReport& report, const char* who, double last_output);

/// Records a state and its error for the output time t; true if the run continues.
[[nodiscard]] bool output(Trajectory<double>& result, InvariantWatch& watch,
                          const OnComponents& on_output, double t, std::span<const double> state,
                          double error);

/// Shows the outputs of a run that nobody has watched, up to where the watcher stops it.
void show_all(Trajectory<double>& run, const OnComponents& on_output);

}  // namespace kreisel::detail
