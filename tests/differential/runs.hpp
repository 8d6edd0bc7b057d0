#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "reference.hpp"

namespace differential {

/// How much a scene may cost.
struct Limits {
  double evaluations = 1e5;  ///< of each run of adaptive steps
  double seconds = 1;        ///< of processor time for each method
  double work = 1.5e8;       ///< operations of the independent integrator
};

/// A number that a run says stays the same.
struct Drift {
  std::string name;
  double start;
  double largest;
};

/// What the library says of a scene, by one method.
struct Answer {
  std::string asked;      ///< the method
  bool answered = false;  ///< else `message` says why not
  bool out_of_budget = false;
  std::string message = {};
  std::string method = {};   ///< that was taken
  std::string changes = {};  ///< of it on the way
  double estimate = 0;
  double tolerance = 0;
  bool kept = false;
  double evaluations = 0;
  double steps = 0;      ///< of the motion that is given
  double end_error = 0;  ///< what is told of the last state
  std::vector<double> times = {};
  std::vector<JointValues> states = {};
  std::vector<Drift> drifts = {};
  std::vector<double> sizes = {};  ///< of blocks, as RunReport::sizes has them
};

/// The report of an approximation of a scene.
struct Approximate {
  Answer answer = {};
  double model_error = 0;  ///< that is told
  double off = 0;  ///< from the exact motion: the greatest difference of a number of the state
  double nearer_off = 0;  ///< the same of nearer()
};

/// The same scene by several methods.
struct Answers {
  std::string refused = {};  ///< by the reader or when the system was made
  std::vector<Answer> by_method = {};
  Answer way = {};  ///< at many times and roughly, for the sizes that errors are measured by
  Answer end = {};  ///< as roughly, with the end as its only output
  std::optional<Approximate> approximate = {};   ///< where the scene asks for a model
  std::vector<std::string> contradictions = {};  ///< in the list of the equation's terms
  std::vector<double> reactions = {};            ///< at the start, as start_reactions() has them
  bool misread = false;                          ///< what the file asks for beside the motion
};

/// Runs the scene's text by the library, by each method in turn. `folder` is where its logs lie;
/// `begin` is told before each part of the work what it is.
[[nodiscard]] Answers run(const Scene& scene, const std::vector<std::string>& methods,
                          const Limits& limits, const std::filesystem::path& folder,
                          const std::function<void(const std::string&)>& begin);

}  // namespace differential
