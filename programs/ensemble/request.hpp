#pragma once

#include <filesystem>
#include <optional>

#include <dynamics/ensemble/scene_ensemble.hpp>

/// The command line of ensemble.
struct Request {
  std::filesystem::path scene;
  kreisel::EnsembleRequest ensemble;
  int threads = 0;
  bool json = false;
  std::optional<std::filesystem::path> csv;
  std::optional<std::filesystem::path> plot;
};

/// The command line; nothing if only help was requested.
///
/// Throws : kreisel::InvalidInput
std::optional<Request> read_request(int argc, char** argv);
