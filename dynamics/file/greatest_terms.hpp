#pragma once

#include <optional>

#include <dynamics/file/model.hpp>
#include <dynamics/file/scene_file.hpp>
#include <dynamics/study/frame_terms.hpp>

namespace kreisel {

/// The greatest size of each kind of term over the outputs of a run, for each rate of the joints.
/// There are none if no body is a rotor.
///
/// Source : paper 000, list below (27)
/// Units  : N m, or N for joints that slide
[[nodiscard]] std::optional<FrameTerms> greatest_terms(const SceneFile& scene,
                                                       const SceneSolver& model,
                                                       const Trajectory<JointState>& run);

}  // namespace kreisel
