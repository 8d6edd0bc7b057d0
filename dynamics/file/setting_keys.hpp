#pragma once

// Includes toml++: only for the .cpp files of this folder.
#include <vector>

#include <dynamics/file/scene_section.hpp>
#include <dynamics/file/scene_setting.hpp>

namespace kreisel::detail {

/// Puts the settings into the table of a scene file, in their order. Messages about a value that is
/// set name the setting's place. A key that leads nowhere, or that is set twice, is a mistake.
///
/// Throws : SceneMistakes if a value is no TOML
void apply_settings(const std::vector<SceneSetting>& settings, toml::table& root,
                    Mistakes& mistakes);

}  // namespace kreisel::detail
