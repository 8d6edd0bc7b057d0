#pragma once

// Knows toml++: for the .cpp files of this folder alone.
#include <string>
#include <vector>

#include <dynamics/file/scene_section.hpp>
#include <dynamics/file/scene_sensor.hpp>
#include <dynamics/tree/description.hpp>

namespace kreisel::detail {

/// The key `points` of a body.
[[nodiscard]] NamedPoints read_points(Section& body);

/// The list [[sensor]] of a scene. `points` are those of each body; `sound` says that nothing is
/// wrong with the bodies.
[[nodiscard]] std::vector<SceneSensor> read_sensors(Section& root,
                                                    const std::vector<BodyDescription>& bodies,
                                                    const std::vector<NamedPoints>& points,
                                                    bool sound);

/// The columns that [output] chooses among those known; empty where it is not there.
[[nodiscard]] std::vector<std::string> read_output(Section& root,
                                                   const std::vector<std::string>& known);

}  // namespace kreisel::detail
