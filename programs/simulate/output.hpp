#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "../shared/scale.hpp"
#include "log_error.hpp"
#include "model.hpp"

/// A run that came to its end.
struct Result {
  const kreisel::SceneFile& scene;
  const Model& model;
  const kreisel::Trajectory<JointState>& run;
  bool reactions;
  bool terms;
  LogError log_error = {};
};

/// Sizes by all states of a run, and by what the joints carry in the first and the last.
Scale scale_of(const Result& result);

/// A thing that the equations hold, or leave out, and why.
struct Term {
  std::string name;
  std::string reason;
};

std::vector<Term> terms_kept(const Result& result);
std::vector<Term> terms_dropped(const Result& result);

/// Throws : kreisel::ComputationFailed naming the first number of the report or of the states that
///          is not finite
void require_finite(const Result& result);

void print_summary(const Result& result);
void print_json(const Result& result);

/// Coordinates, rates, energy, error, reactions and the path of the last body's axis, each as SVG and PNG,
/// and view.html, which shows the bodies moving.
///
/// Throws : kreisel::ComputationFailed where gnuplot is not installed or fails
void draw(const Result& result, const std::filesystem::path& folder);
