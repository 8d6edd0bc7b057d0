#pragma once

#include <string>
#include <vector>

#include <dynamics/random.hpp>
#include <motor/error.hpp>

namespace kreisel {

/// The variation of numbers of a scene from member to member of an ensemble. The numbers of one
/// variation vary together.
struct Variation {
  enum class Kind {
    normal,   ///< mean and deviation
    uniform,  ///< from and to
    linear    ///< not random: from the first member to the last in equal steps
  };
  enum class Use { instead, added, factor };

  std::string text;               ///< as parsed, for messages
  std::vector<std::string> keys;  ///< as SceneSetting has them
  Use use = Use::instead;
  Kind kind = Kind::normal;
  double first = 0;
  double second = 0;

  /// The number for a member; `share` is 0 for the first, 1 for the last.
  [[nodiscard]] double drawn(double share, MemberRandom& random) const;

  /// A number of the scene after the variation.
  [[nodiscard]] double applied(double given, double drawn) const;
};

/// Reads KEY=normal(MEAN,DEVIATION), KEY+=uniform(FROM,TO) or KEY,KEY*=linear(FROM,TO).
///
/// Throws : InvalidInput
[[nodiscard]] Variation parse_variation(const std::string& text);

}  // namespace kreisel
