#pragma once

#include <iosfwd>
#include <string>
#include <vector>

#include <dynamics/step/accuracy.hpp>
#include <motor/api.hpp>

namespace kreisel {

/// The result of a function that solve() calls at outputs.
enum class OutputAction { proceed, stop };

/// A conserved quantity and its drift during a run.
struct InvariantDrift {
  std::string name;
  double start = 0;
  double largest = 0;  ///< the greatest distance from the start
};

/// The outcome of a run.
enum class RunStatus {
  complete,
  cancelled,  ///< by the progress callback
  failed      ///< RunReport::message gives time and reason
};

/// The sources of a run's error, each measured by its own means (docs/site/errors.md). Errors of logs
/// and of models are not among them: a scene's program reports these beside.
struct ErrorParts {
  double truncation = 0;  ///< of the steps, by a second run of another accuracy
  double rounding = 0;    ///< and its growth, by perturbed runs

  [[nodiscard]] double sum() const { return truncation + rounding; }
};

/// The cost of a run and the error of its result.
///
/// error_estimate is the GLOBAL error, the greatest over the output times and the parts of the
/// state. It is in radian for attitudes, and relative to the greatest size so far for other parts.
struct RunReport {
  std::string method;   ///< at the end
  std::string changes;  ///< of the method: "taylor to t = 0.5 s, then radau13"; or empty
  RunStatus status = RunStatus::complete;
  std::string message;
  double tolerance = 0;
  double error_estimate = 0;
  ErrorParts error_parts = {};  ///< their sum is error_estimate, without the error of a model
  bool tolerance_kept =
      false;  ///< error_estimate <= tolerance; else nothing better could be reached
  IntegrationStatistics effort;  ///< of the trajectory returned
  double all_evaluations = 0;    ///< including the estimate and failed attempts
  double run_time = 0;           ///< s, all included
  std::vector<InvariantDrift> invariants;
  /// The greatest size of each part of the state at the start and at every step; error_estimate is
  /// relative to it. Parts have their own units and the order of the scene's blocks. Empty for
  /// closed forms.
  std::vector<double> sizes = {};

  /// Takes a greater error for the estimate; keeps a NaN.
  void raise(const ErrorParts& error) {
    if (error.sum() <= error_estimate || error_estimate != error_estimate) return;
    error_estimate = error.sum();
    error_parts = error;
  }
};

/// Prints a line for each of method, status, steps, evaluations, error, tolerance and, if there is one,
/// the message. No line depends on the machine or its load.
KREISEL_API std::ostream& operator<<(std::ostream& out, const RunReport& report);

/// The states at the output times, as far as the run came, and the report.
template <class State>
struct Trajectory {
  std::vector<double> times;
  std::vector<State> states;
  RunReport report;
  std::vector<double> errors = {};  ///< of the states, in the measure of RunReport::error_estimate
};

}  // namespace kreisel
