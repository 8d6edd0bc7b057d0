#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <motor/error.hpp>

namespace kreisel {

/// The text of a scene file in which some numbers can be replaced. Members of an ensemble differ,
/// for example, in a mass or in the start.
///
/// A number is named by the path of its keys. Tables in a list are selected by name or by index:
/// body.rotor.inertia[2], gravity.vector[2], guide.links[1].rate
/// The value of a text with a unit is in SI units and radian. Another value replaces the whole text.
class SceneNumbers {
 public:
  /// Throws : InvalidInput if the text is no TOML, or if a key does not lead to a number
  SceneNumbers(std::string text, const std::vector<std::string>& keys);

  /// The numbers of the text, in the order of the keys.
  [[nodiscard]] const std::vector<double>& values() const { return values_; }

  /// The text with other numbers, exact to the last bit; all other text and all lines are
  /// unchanged.
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
