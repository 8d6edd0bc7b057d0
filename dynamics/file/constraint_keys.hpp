#pragma once

// Includes toml++: only for the .cpp files of this folder.
#include <vector>

#include <dynamics/file/scene_file.hpp>
#include <dynamics/file/scene_section.hpp>

namespace kreisel::detail {

/// Reads the list [[constraint]] into the scene, after bodies and elements. The start then fulfils
/// it exactly. It must do so to 1e-9 before, unless `assemble` is set. `sound`: the bodies have no
/// mistakes.
void read_constraints(Section& root, bool assemble, bool sound, SceneFile& scene);

}  // namespace kreisel::detail
