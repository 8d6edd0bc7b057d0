#pragma once

// Includes toml++: only for the .cpp files of this folder.
#include <vector>

#include <dynamics/file/scene_file.hpp>
#include <dynamics/file/scene_section.hpp>

namespace kreisel::detail {

/// Reads the list [[element]], after the bodies. `sound`: the bodies have no mistakes, so that the
/// kinds of their joints are known.
[[nodiscard]] std::vector<Element> read_elements(Section& root, const SceneFile& scene, bool sound);

}  // namespace kreisel::detail
