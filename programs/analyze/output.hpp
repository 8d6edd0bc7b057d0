#pragma once

#include <nlohmann/json.hpp>

#include <filesystem>

#include <dynamics/file/analysis.hpp>

/// A complete analysis and its subject.
struct Result {
  const kreisel::SceneFile& scene;
  const kreisel::StudySystem& system;
  const kreisel::scene_analysis::Analysis& analysis;
};

void print_summary(const Result& result);

/// The object of --json.
[[nodiscard]] nlohmann::ordered_json to_json(const Result& result);

/// Draws roots, Campbell diagram and multipliers, if there are any, each as SVG and PNG.
///
/// Throws : kreisel::ComputationFailed if gnuplot is not installed or fails
void draw(const Result& result, const std::filesystem::path& folder);
