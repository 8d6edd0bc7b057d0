#pragma once

// Includes toml++: only for the .cpp files of this folder.
#include <array>
#include <string>
#include <vector>

#include <dynamics/file/log_file.hpp>
#include <dynamics/file/scene_section.hpp>

namespace kreisel::detail {

/// Reads the keys of a log in a section of a scene file: `columns`, `separator`, `time_unit`, ...
///
/// `run` is [from, to] of the scene in seconds. Mistakes are noted in the section. The keys `file`
/// and `sigma` are not read here.
[[nodiscard]] LogOptions read_log_options(Section& section, const std::vector<LogRequest>& requests,
                                          const std::array<double, 2>& run);

/// Refuses a log, read with these options, that does not cover the run. Suggests keys that help.
void check_covers_run(Section& section, const std::string& name, const LogOptions& options,
                      const std::vector<double>& times, const std::array<double, 2>& run);

}  // namespace kreisel::detail
