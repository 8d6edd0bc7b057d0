#pragma once

#include <string>
#include <vector>

#include "point.hpp"

namespace work_precision {

/// The method that is no integrator.
inline const std::string closed_form = "closed form";

/// Whether it is one of the libraries'.
bool of_a_library(const std::string& method);

/// Whether it is one of our steppers, bare.
bool is_stepper(const std::string& method);

void write_csv(const std::string& path, const std::vector<Point>& points);

/// Who wins, how honest solve() is, and who failed.
void write_tables(const std::string& path, const std::vector<Point>& points);

/// Error over time and over evaluations, two SVG a scene.
///
/// Throws : kreisel::ComputationFailed if gnuplot does not draw them
void draw(const std::string& directory, const std::vector<Point>& points);

}  // namespace work_precision
