#pragma once

#include <map>
#include <stop_token>
#include <string>

#include <dynamics/file/analysis.hpp>

#include "scene.hpp"

/// Studies whose results are the JSON objects of the programs, as text.

/// The object of  analyze --json.  A stop ends it by ComputationFailed.
///
/// Throws : kreisel::InvalidInput, kreisel::ComputationFailed
[[nodiscard]] std::string analyze(const SceneText& scene,
                                  const kreisel::scene_analysis::AnalysisRequest& request,
                                  const std::stop_token& stop);

/// The object of  analyze --state-space.
///
/// Throws : as analyze()
[[nodiscard]] std::string state_space(const SceneText& scene, const std::stop_token& stop);

/// The object of  pendulum_deviation --json.  Options have the names of the command line, with _
/// for -, and numbers as text, so that decimals count as exact.
///
/// Throws : as analyze()
[[nodiscard]] std::string pendulum_deviation(const std::map<std::string, std::string>& options);
