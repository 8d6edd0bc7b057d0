#pragma once

#include <filesystem>
#include <optional>

#include <dynamics/file/scene_file.hpp>

/// The options on the command line of simulate.
struct Request {
  std::filesystem::path scene;
  kreisel::SolveRequest solve;
  bool reactions = false;
  bool terms = false;
  bool json = false;
  bool resume = false;
  std::optional<std::filesystem::path> csv;
  std::optional<std::filesystem::path> plot;  ///< a folder
};

/// Reads the command line; nothing if only help was requested.
///
/// Throws : kreisel::InvalidInput
std::optional<Request> read_request(int argc, char** argv);
