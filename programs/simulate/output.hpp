#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <dynamics/file/log_error.hpp>
#include <dynamics/file/model.hpp>
#include <dynamics/file/scale.hpp>

/// A complete run.
struct Result {
  const kreisel::SceneFile& scene;
  const kreisel::SceneSolver& model;
  const kreisel::Trajectory<kreisel::JointState>& run;
  bool reactions;
  bool terms;
  kreisel::LogError log_error = {};
  std::vector<double> readings = {};  ///< of all sensors at the end
};

/// Sizes from all states of a run, and from the reactions in the first and the last state.
kreisel::SceneScale scale_of(const Result& result);

/// A term that the equations contain or leave out, with the reason.
struct TermLine {
  std::string name;
  std::string reason;
};

std::vector<TermLine> terms_kept(const Result& result);
std::vector<TermLine> terms_dropped(const Result& result);

/// Throws : kreisel::ComputationFailed naming the first number of the report or of the states that
///          is not finite
void require_finite(const Result& result);

void print_summary(const Result& result);
void print_json(const Result& result);

/// Draws coordinates, rates, sensors, energy, error, reactions and the path of the last body's axis,
/// each as SVG and PNG, and view.html, which shows the bodies moving.
///
/// Throws : kreisel::ComputationFailed if gnuplot is not installed or fails
void draw(const Result& result, const std::filesystem::path& folder);
