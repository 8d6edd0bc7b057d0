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

/// The results of a case.
struct Finding {
  std::string name;
  std::string extreme;
  std::vector<Row> rows;
  std::vector<DriftPoint> drift;
};

/// Runs all cases, each in a process of its own, with a bar on a terminal. Ctrl-C ends the
/// catalogue and returns the results so far. A case that crashes or does not end in time has
/// failed, and the others continue.
std::vector<Finding> run_isolated(const std::vector<Case>& cases, bool quick);

/// True if Ctrl-C was pressed.
bool interrupted();

}  // namespace stability
