#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

/// A rotor whose speed is swept.
struct Sweep {
  std::string body;
  std::vector<double> speeds;  ///< rad/s, against its carrier
};

/// The options on the command line of analyze.
struct Request {
  std::filesystem::path scene;
  std::optional<Sweep> campbell;
  std::optional<double> period;  ///< s, of the coefficients
  bool json = false;
  std::optional<std::filesystem::path> plot;  ///< a folder
};

/// Reads the command line; nothing if only help was requested.
///
/// Throws : kreisel::InvalidInput
std::optional<Request> read_request(int argc, char** argv);
