#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <dynamics/file/scene_file.hpp>
#include <dynamics/random.hpp>

/// The variation of numbers of the scene from member to member; numbers of one variation vary
/// together.
struct Variation {
  enum class Kind {
    normal,   ///< mean and deviation
    uniform,  ///< from and to
    linear    ///< not random: from the first member to the last in equal steps
  };
  enum class Use { instead, added, factor };

  std::vector<std::string> keys;
  Use use = Use::instead;
  Kind kind = Kind::normal;
  double first = 0;
  double second = 0;

  /// The number for a member; `share` is 0 for the first, 1 for the last.
  [[nodiscard]] double drawn(double share, kreisel::MemberRandom& random) const;

  /// A number of the scene after the variation.
  [[nodiscard]] double applied(double given, double drawn) const;
};

/// The command line of ensemble.
struct Request {
  std::filesystem::path scene;
  kreisel::SolveRequest solve;
  std::vector<Variation> variations;
  std::size_t members = 1000;
  std::uint64_t seed = 1;
  int threads = 0;
  bool json = false;
  std::optional<std::filesystem::path> csv;
};

/// The command line; nothing if only help was requested.
///
/// Throws : kreisel::InvalidInput
std::optional<Request> read_request(int argc, char** argv);
