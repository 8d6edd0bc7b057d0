#pragma once

#include <filesystem>
#include <optional>
#include <pybind11/pybind11.h>
#include <string>
#include <vector>

#include <dynamics/ensemble/scene_ensemble.hpp>
#include <dynamics/file/scene_file.hpp>

#include "result.hpp"

/// The text of a scene, its path, and values set against it. Each computation reads it anew, so
/// that it can override the end, the tolerance and the method.
struct SceneText {
  std::string text;
  std::filesystem::path path;
  std::vector<kreisel::SceneSetting> settings;

  [[nodiscard]] kreisel::SceneFile read(kreisel::SolveRequest request = {}) const;
};

/// Options of a run; those left out are the scene's.
struct RunOptions {
  std::optional<double> t_end;
  std::optional<double> tolerance;
  std::optional<std::string> method;
  std::optional<std::vector<double>> times;
  bool reactions = false;
  bool elements = false;
  bool constraints = false;
  bool terms = false;
};

/// Reads the scene and makes its model. A missing t_end is no mistake here.
///
/// Throws : kreisel::InvalidInput
/// Returns the title and the names of the bodies
[[nodiscard]] std::pair<std::string, std::vector<std::string>> examine(const SceneText& scene);

/// Throws : kreisel::InvalidInput, kreisel::ComputationFailed
[[nodiscard]] Motion solve_scene(const SceneText& scene, const RunOptions& options,
                                 const pybind11::object& progress);

[[nodiscard]] Members ensemble(const SceneText& scene, const std::vector<std::string>& variations,
                               std::size_t members, std::uint64_t seed, int threads,
                               const RunOptions& options, const pybind11::object& progress);
