#pragma once

#include <string>
#include <vector>

#include "isolated.hpp"

namespace stability {

/// Every row.
void write_csv(const std::string& path, const std::vector<Finding>& findings);

/// Failures, the number of each verdict, and every row.
void write_tables(const std::string& path, const std::vector<Finding>& findings);

/// Drift over time, an SVG for each case that has one.
///
/// Throws : kreisel::ComputationFailed if gnuplot does not draw them
void draw(const std::string& directory, const std::vector<Finding>& findings);

}  // namespace stability
