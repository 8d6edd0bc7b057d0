#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace work_precision {

/// The report of solve() about its own run, with the truth by the same measure.
struct Promise {
  std::string method;  ///< that it chose
  double error;
  double estimate;
  bool kept;  ///< the estimate is within the tolerance
};

/// The result of a run.
struct Result {
  double error;
  double evaluations;
  std::optional<Promise> promise = {};
};

/// A run to be measured. `setting` is a tolerance or a step. The runs of a method on a scene are
/// consecutive, the cheapest first.
struct Run {
  std::string scene;
  std::string method;
  double setting;
  std::function<Result()> run;
};

/// A measured run: its error and its cost. For a failed run `status` gives the reason.
struct Point {
  std::string scene;
  std::string method;
  double setting;
  double error;
  double seconds;
  double evaluations;
  std::string status;
  std::optional<Promise> promise;
};

/// The name of solve() with its defaults, and the first part of its name with a chosen method. Both
/// report their error.
inline const std::string automatic = "auto";
inline const std::string fixed_choice = "solve: ";

inline const std::string ok = "ok";
inline const std::string not_tried = "not tried: too slow at the setting before";

/// The time budget of a measurement.
struct Thoroughness {
  bool quick;
  std::vector<double> tolerances;
  double max_evaluations;        ///< of a run
  double patience;               ///< s; a method that took longer is not tried at a finer setting
  double time_enough;            ///< s of repetitions together
  std::size_t repetitions;       ///< as many at least,
  std::size_t most_repetitions;  ///< and at most

  static Thoroughness full();
  static Thoroughness in_a_minute();
};

/// Measures all runs, with a bar on a terminal. Ctrl-C ends it and returns the measured ones.
std::vector<Point> measure(const std::vector<Run>& runs, const Thoroughness& thoroughness);

/// True if Ctrl-C was pressed.
bool interrupted();

}  // namespace work_precision
