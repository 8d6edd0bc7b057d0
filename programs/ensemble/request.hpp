#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <dynamics/file/scene_file.hpp>
#include <dynamics/random.hpp>

/// How numbers of the scene differ from member to member; those of one variation together.
struct Variation {
  enum class Kind {
    normal,   ///< mean and deviation
    uniform,  ///< from and to
    linear    ///< no chance: from the first member to the last in equal steps
  };
  enum class Use { instead, added, factor };

  std::vector<std::string> keys;
  Use use = Use::instead;
  Kind kind = Kind::normal;
  double first = 0;
  double second = 0;

  /// The number for a member; `share` is 0 of the first, 1 of the last.
  [[nodiscard]] double drawn(double share, kreisel::MemberRandom& random) const;

  /// What it makes of a number of the scene.
  [[nodiscard]] double applied(double given, double drawn) const;
};

/// What the command line of ensemble asks for.
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

/// Nothing where only help was asked for.
///
/// Throws : kreisel::InvalidInput
std::optional<Request> read_request(int argc, char** argv);
