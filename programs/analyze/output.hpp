#pragma once

#include <filesystem>

#include "analysis.hpp"

/// An analysis that came to its end, and of what.
struct Result {
  const kreisel::SceneFile& scene;
  const kreisel::StudySystem& system;
  const Analysis& analysis;
};

/// "nutation", "precession" or "oscillation"; "" where there are no rotors or no oscillation.
[[nodiscard]] const char* kind(const kreisel::GyroscopicMode& mode, bool has_rotors);

void print_summary(const Result& result);
void print_json(const Result& result);

/// Roots, Campbell diagram and multipliers, as far as there are any, each as SVG and PNG.
///
/// Throws : kreisel::ComputationFailed where gnuplot is not installed or fails
void draw(const Result& result, const std::filesystem::path& folder);
