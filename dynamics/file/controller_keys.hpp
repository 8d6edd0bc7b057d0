#pragma once

// Includes toml++: only for the .cpp files of this folder.
#include <vector>

#include <dynamics/file/scene_file.hpp>
#include <dynamics/file/scene_section.hpp>

namespace kreisel::detail {

/// Reads the list [[controller]] of a scene whose bodies, sensors and begin are known, and appends a
/// sensor for the outputs of each controller. `sound` is true if the scene has no mistakes so far.
void read_controllers(Section& root, bool sound, SceneFile& scene);

}  // namespace kreisel::detail
