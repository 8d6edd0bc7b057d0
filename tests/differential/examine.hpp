#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "judge.hpp"

namespace differential {

/// The result of a scene's examination.
struct Verdict {
  std::vector<Fault> faults = {};
  bool answered = false;    ///< by one method at least
  bool referenced = false;  ///< the independent integrator came to the end
  std::string notes = {};   ///< message of each method
};

struct Examination {
  std::vector<std::string> methods = {"auto", "verner98", "radau13", "taylor", "gauss16"};
  Limits limits = {};
  std::filesystem::path folder = {};  ///< for logs
};

/// Runs and judges a scene in a process of its own, so that a crash or a hang counts as a fault.
[[nodiscard]] Verdict examine(const Scene& scene, const Examination& how);

}  // namespace differential
