#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <vector>

#include <dynamics/solve/error_measure.hpp>

#include <support/worst.hpp>

namespace kreisel::test {

/// The greatest distance of a run from the wanted states at its output times, in the measure of
/// RunReport::error_estimate.
template <class System, class Run>
[[nodiscard]] double true_error(const System& system, const Run& run,
                                const std::vector<Eigen::VectorXd>& wanted) {
  ErrorMeasure<System> distance(system, 1e-3);
  distance.note_sizes(run.report.sizes);
  double worst = 0;
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    worst = worst_of(worst, distance(system.to_vector(run.states.at(i)), wanted[i]));
  }
  return worst;
}

/// The greatest gap of any condition at the outputs of a run, as a part of the lengths in it.
template <class System, class Run>
[[nodiscard]] double greatest_gap(const System& system, const Run& run) {
  double worst = 0;
  for (const auto& state : run.states) {
    for (const auto& gap : system.constraint_gaps(state)) {
      worst = worst_of(worst, gap.relative);
    }
  }
  return worst;
}

/// The same for the rates of the gaps, in m/s or rad/s.
template <class System, class Run>
[[nodiscard]] double greatest_gap_rate(const System& system, const Run& run) {
  double worst = 0;
  for (const auto& state : run.states) {
    for (const auto& gap : system.constraint_gaps(state)) worst = worst_of(worst, gap.rate);
  }
  return worst;
}

}  // namespace kreisel::test
