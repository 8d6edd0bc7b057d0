#pragma once

// Includes toml++: only for the .cpp files of this folder.
#include <filesystem>
#include <optional>
#include <vector>

#include <dynamics/file/scene_file.hpp>
#include <dynamics/file/scene_section.hpp>

namespace kreisel::detail {

/// The table [guide] of a scene.
struct GuideSection {
  std::vector<scene_guide::Link> links;                  ///< never empty
  scene_gravity::Field gravity = scene_gravity::None{};  ///< given by the guide
  std::vector<double> discontinuities = {};              ///< times within the run, in any order
  std::optional<Section> rates_without_gravity = {};     ///< of a link that has specific forces
};

/// Reads the table [guide] of a scene for a run from t_begin to t_end. `scene` is the path of its file; logs
/// are searched beside it.
[[nodiscard]] GuideSection read_guide(Section& root, const std::filesystem::path& scene,
                                      double t_begin, double t_end, const Mistakes& mistakes);

/// Passes gravity to logged specific forces: the guide's own, or uniform gravity of the scene.
void give_gravity_to_rates(GuideSection& guide, const scene_gravity::Field& gravity);

}  // namespace kreisel::detail
