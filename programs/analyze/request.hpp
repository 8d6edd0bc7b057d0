#pragma once

#include <filesystem>
#include <optional>

#include <dynamics/file/analysis.hpp>
#include <dynamics/file/scene_file.hpp>

/// The options on the command line of analyze.
struct Request : kreisel::scene_analysis::AnalysisRequest {
  std::filesystem::path scene;
  kreisel::SolveRequest solve;
  std::optional<std::filesystem::path> response_file;  ///< CSV
  std::optional<std::filesystem::path> state_space;    ///< JSON
  bool json = false;
  std::optional<std::filesystem::path> plot;  ///< a folder
};

/// Reads the command line; nothing if only help was requested.
///
/// Throws : kreisel::InvalidInput
std::optional<Request> read_request(int argc, char** argv);
