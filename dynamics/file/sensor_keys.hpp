#pragma once

// Includes toml++: only for the .cpp files of this folder.
#include <string>
#include <vector>

#include <dynamics/file/scene_file.hpp>
#include <dynamics/file/scene_section.hpp>

namespace kreisel::detail {

/// Reads the key `points` of a body.
[[nodiscard]] NamedPoints read_points(Section& body);

/// Reads the list [[sensor]] of a scene whose bodies, points, model and end are known. `sound` is
/// true if the bodies have no mistakes.
[[nodiscard]] std::vector<SceneSensor> read_sensors(Section& root, const SceneFile& scene,
                                                    bool sound);

/// The columns that [output] chooses among the known ones; empty without [output].
[[nodiscard]] std::vector<std::string> read_output(Section& root,
                                                   const std::vector<std::string>& known);

}  // namespace kreisel::detail
