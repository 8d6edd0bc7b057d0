#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace work_precision {

/// What solve() says of its own run, beside the truth in the same measure.
struct Promise {
  std::string method;  ///< that it chose
  double error;
  double estimate;
  bool kept;  ///< it says that the estimate is within the tolerance
};

/// What a run gives back.
struct Result {
  double error;
  double evaluations;
  std::optional<Promise> promise = {};
};

/// A run to be measured. `setting` is a tolerance or a step; the runs of a method on a scene stand
/// in a row, the cheapest first.
struct Run {
  std::string scene;
  std::string method;
  double setting;
  std::function<Result()> run;
};

/// A run measured: how far off, how dear. Where it failed, `status` says why.
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

/// The method that stands for what one calls who knows nothing about integrators, and how the name of
/// one begins that solve() was told to take; both tell their error.
inline const std::string automatic = "auto";
inline const std::string fixed_choice = "solve: ";

inline const std::string ok = "ok";
inline const std::string not_tried = "not tried: too slow at the setting before";

/// How much time a measurement may take.
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

/// Measures all, with a bar on a terminal. Ctrl-C ends it; what was measured is returned.
std::vector<Point> measure(const std::vector<Run>& runs, const Thoroughness& thoroughness);

/// Whether Ctrl-C was pressed.
bool interrupted();

}  // namespace work_precision
