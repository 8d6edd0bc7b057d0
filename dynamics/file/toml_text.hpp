#pragma once

// Includes toml++: only for the .cpp files of this folder.
#include <string_view>
#include <toml++/toml.h>

#include <dynamics/file/scene_section.hpp>

namespace kreisel::detail {

/// The table of a text in TOML 1.0. `place` names a text that is not the scene file, for messages;
/// it is empty for the file.
///
/// Throws : SceneMistakes if the text is no TOML or is nested more than 64 deep
[[nodiscard]] toml::table parse_toml(std::string_view text, std::string_view place,
                                     Mistakes& mistakes);

}  // namespace kreisel::detail
