#pragma once

#include <filesystem>

#include <dynamics/json/analysis.hpp>

void print_summary(const kreisel::AnalysisResult& result);

/// Draws roots, Campbell diagram and multipliers, if there are any, each as SVG and PNG.
///
/// Throws : kreisel::ComputationFailed if gnuplot is not installed or fails
void draw(const kreisel::AnalysisResult& result, const std::filesystem::path& folder);
