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

/// "nutation", "precession" or "oscillation"; "" without rotors or without oscillation.
[[nodiscard]] const char* kind(const kreisel::GyroscopicMode& mode, bool has_rotors);

void print_summary(const Result& result);

/// The object of --json.
[[nodiscard]] nlohmann::ordered_json to_json(const Result& result);

/// Writes the response as a table of frequency, amplitude and phase, in rad/s and radian.
void write_response(const Result& result, const std::filesystem::path& path);

/// The linear plant about the steady motion: the object of --state-space.
///
/// Throws : kreisel::ComputationFailed without a steady motion
[[nodiscard]] nlohmann::ordered_json state_space_json(const Result& result);
void write_state_space(const Result& result, const std::filesystem::path& path);

/// Draws roots, Campbell diagram and multipliers, if there are any, each as SVG and PNG.
///
/// Throws : kreisel::ComputationFailed if gnuplot is not installed or fails
void draw(const Result& result, const std::filesystem::path& folder);
