#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "increments.hpp"
#include "reference.hpp"

namespace differential {

/// Limits for the cost of a scene.
struct Limits {
  double evaluations = 1e5;  ///< of each run of adaptive steps
  double seconds = 1;        ///< of processor time for each method
  double work = 1.5e8;       ///< operations of the independent integrator
};

/// An invariant reported by a run.
struct Drift {
  std::string name;
  double start;
  double largest;
};

/// The library's answer for a scene, by one method.
struct Answer {
  std::string asked;      ///< the method
  bool answered = false;  ///< false: `message` has the reason
  bool out_of_budget = false;
  std::string message = {};
  std::string method = {};   ///< used by the run
  std::string changes = {};  ///< of the method during the run
  double estimate = 0;
  double tolerance = 0;
  bool kept = false;
  double evaluations = 0;
  double steps = 0;      ///< of the returned motion
  double end_error = 0;  ///< reported for the last state
  std::vector<double> times = {};
  std::vector<JointValues> states = {};
  std::vector<Drift> drifts = {};
  std::vector<double> sizes = {};  ///< of blocks, as in RunReport::sizes
};

/// The report of an approximation of a scene.
struct Approximate {
  Answer answer = {};
  double model_error = 0;  ///< as reported
  double off = 0;  ///< from the exact motion: the greatest difference of a number of the state
  double nearer_off = 0;  ///< the same of nearer()
};

/// The same scene by several methods.
struct Answers {
  std::string refused = {};  ///< by the reader or when the system was made
  std::vector<Answer> by_method = {};
  Answer way = {};  ///< at many times with a coarse tolerance, for the reference sizes of errors
  Answer end = {};  ///< with the same tolerance, with the end as its only output
  std::optional<Approximate> approximate = {};   ///< if the scene has a model
  std::vector<std::string> contradictions = {};  ///< in the list of the equation's terms
  std::vector<double> reactions = {};            ///< at the start, as in start_reactions()
  std::vector<double> readings = {};             ///< at the start, as in start_readings()
  std::optional<WrongIncrements> wrong_increments = {};
  bool wrongly_random = false;  ///< errors of sensors do not depend on the seed alone
  bool misread = false;         ///< requests of the file besides the motion, read
                                ///< wrongly
};

/// Runs the scene's text by the library, by each method in turn. `folder` contains its logs.
/// `begin` is called with the name of each part of the work.
[[nodiscard]] Answers run(const Scene& scene, const std::vector<std::string>& methods,
                          const Limits& limits, const std::filesystem::path& folder,
                          const std::function<void(const std::string&)>& begin);

}  // namespace differential
