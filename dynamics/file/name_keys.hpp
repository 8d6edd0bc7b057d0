#pragma once

// Includes toml++: only for the .cpp files of this folder.
#include <string>
#include <string_view>
#include <vector>

#include <dynamics/file/scene_section.hpp>
#include <dynamics/file/scene_sensor.hpp>

/// Keys whose values are names of bodies, points and the like.

namespace kreisel::detail {

/// The index of a word among the allowed words. A word that is none of them is a mistake at the
/// key, and the index is 0. `what` is the noun of the message.
[[nodiscard]] int index_of_name(Section& section, std::string_view key, const std::string& word,
                                const std::vector<std::string>& words, const char* what);

/// A point of a body by its name. An unknown name is a mistake at the key.
[[nodiscard]] Vector3<double> named_point(Section& section, std::string_view key,
                                          const std::string& name, const NamedPoints& known,
                                          const std::string& body);

}  // namespace kreisel::detail
