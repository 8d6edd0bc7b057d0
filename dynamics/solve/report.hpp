#pragma once

#include <iosfwd>
#include <string>
#include <vector>

#include <dynamics/step/accuracy.hpp>
#include <motor/api.hpp>

namespace kreisel {

/// The answer of a function that solve() calls at outputs.
enum class OutputAction { proceed, stop };

/// A number that should not change during a run, and how much it did.
struct InvariantDrift {
  std::string name;
  double start = 0;
  double largest = 0;  ///< the greatest distance from the start
};

/// How a run ended.
enum class RunStatus {
  complete,
  cancelled,  ///< by on_output or SolveOptions::stop; RunReport::message says by which and where
  failed      ///< RunReport::message says where and why
};

/// What a run has cost and how far its result is off.
///
/// error_estimate is of the GLOBAL error, the greatest over the output times and over the parts of
/// the state: attitudes in radian, other parts relative to their greatest size so far.
struct RunReport {
  std::string method;   ///< of the end
  std::string changes;  ///< of the method on the way: "taylor to t = 0.5 s, then radau13"; or empty
  RunStatus status = RunStatus::complete;
  std::string message;
  double tolerance = 0;
  double error_estimate = 0;
  bool tolerance_kept =
      false;  ///< error_estimate <= tolerance; else nothing better could be reached
  IntegrationStatistics effort;  ///< of the trajectory returned
  double all_evaluations = 0;    ///< with those for the estimate and for attempts that fell short
  double run_time = 0;           ///< s, all included
  std::vector<InvariantDrift> invariants;
  /// The greatest size of each part of the state at the start and at every step, in its own unit and in
  /// the order of the scene's blocks: error_estimate is relative to it. Empty for closed forms.
  std::vector<double> sizes = {};
};

/// One line each: method, status, steps, evaluations, error, tolerance and, if there is one, the
/// message. No line depends on the machine or its load.
KREISEL_API std::ostream& operator<<(std::ostream& out, const RunReport& report);

/// States at the output times, up to where the run came, and the report.
template <class State>
struct Trajectory {
  std::vector<double> times;
  std::vector<State> states;
  RunReport report;
  std::vector<double> errors =
      {};  ///< of the states, as RunReport::error_estimate has the greatest
};

}  // namespace kreisel
