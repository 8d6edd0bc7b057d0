#pragma once

#include <string>
#include <vector>

#include "point.hpp"

namespace work_precision {

/// The name of the closed form, which is no integrator.
inline const std::string closed_form = "closed form";

/// True for a method of another library.
bool of_a_library(const std::string& method);

/// True for one of our bare steppers.
bool is_stepper(const std::string& method);

void write_csv(const std::string& path, const std::vector<Point>& points);

/// The tables: the fastest methods, the honesty of solve(), and the failures.
void write_tables(const std::string& path, const std::vector<Point>& points);

/// Error over time and over evaluations, two SVG for each scene.
///
/// Throws : kreisel::ComputationFailed if gnuplot does not draw them
void draw(const std::string& directory, const std::vector<Point>& points);

}  // namespace work_precision
