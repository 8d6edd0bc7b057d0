#pragma once

#include <string>
#include <vector>

#include "catalogue.hpp"

namespace stability {

struct DriftPoint {
  std::string series;
  double t;
  double value;
};

/// What a case has brought.
struct Finding {
  std::string name;
  std::string extreme;
  std::vector<Row> rows;
  std::vector<DriftPoint> drift;
};

/// Runs all, each in a process of its own, with a bar on a terminal. Ctrl-C ends it; what was found
/// is returned. A case that crashes or does not end in time has failed, and the others go on.
std::vector<Finding> run_isolated(const std::vector<Case>& cases, bool quick);

/// Whether Ctrl-C was pressed.
bool interrupted();

}  // namespace stability
