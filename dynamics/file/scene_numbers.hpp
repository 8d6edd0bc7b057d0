#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <motor/error.hpp>

namespace kreisel {

/// The text of a scene file in which some numbers can be others: for members of an ensemble that
/// differ in a mass or in where they begin.
///
/// A number is named by the keys that lead to it; of several tables the one with that name, or by
/// its place:  body.rotor.inertia[2], gravity.vector[2], guide.links[1].rate
class SceneNumbers {
 public:
  /// Throws : InvalidInput where the text is no TOML, or a key leads to no number
  SceneNumbers(std::string text, const std::vector<std::string>& keys);

  /// Those of the text, in the order of the keys.
  [[nodiscard]] const std::vector<double>& values() const { return values_; }

  /// The text with others, which stand there to the last bit; all else, lines included, as it was.
  [[nodiscard]] std::string with(const std::vector<double>& values) const;

 private:
  struct Place {
    std::size_t begin;
    std::size_t end;
    std::size_t key;
  };

  std::string text_;
  std::vector<Place> places_;  ///< in the order of the text
  std::vector<double> values_;
};

}  // namespace kreisel
