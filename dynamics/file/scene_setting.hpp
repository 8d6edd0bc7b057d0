#pragma once

#include <optional>
#include <string>
#include <string_view>

#include <motor/error.hpp>

namespace kreisel {

/// A value that replaces the value of a scene file at a key, or is added where the file has none.
///
/// A key is the path of its keys. Tables in a list are selected by name or by index:
/// body.rotor.inertia[2], gravity.vector[2], guide.links[1].rate, solve.method
struct SceneSetting {
  std::string key;
  /// In TOML, in the units of the file. A text may stand without its quotes: 5 kg, taylor
  std::string value;
  /// For messages, in the place of file:line:column, such as "--set body.rotor.mass=0".
  std::string place;
};

/// The setting KEY=VALUE of a command line.
///
/// Throws : InvalidInput if there is no '=' behind a key; the message names the option
[[nodiscard]] SceneSetting parse_setting(const std::string& option, std::string_view text);

/// The number of a scene's text at a key, in the unit of the key. Nothing if the text lacks the key,
/// so that the scene has its default.
///
/// Throws : InvalidInput if the text is no TOML, or if the key leads to something else
[[nodiscard]] std::optional<double> number_in_scene(std::string_view text, const std::string& key);

}  // namespace kreisel
