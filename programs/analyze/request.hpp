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

/// A response that is asked for.
struct ResponseRequest {
  std::string input;
  std::string output;
  std::vector<double> frequencies;  ///< rad/s, rising
};

/// The options on the command line of analyze.
struct Request {
  std::filesystem::path scene;
  std::optional<Sweep> campbell;
  std::optional<ResponseRequest> response;
  std::optional<std::filesystem::path> response_file;  ///< CSV
  std::optional<std::filesystem::path> state_space;    ///< JSON
  std::optional<double> period;                        ///< s, of the coefficients
  bool json = false;
  std::optional<std::filesystem::path> plot;  ///< a folder
};

/// Reads the command line; nothing if only help was requested.
///
/// Throws : kreisel::InvalidInput
std::optional<Request> read_request(int argc, char** argv);
