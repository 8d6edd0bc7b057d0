#pragma once

#include <functional>
#include <vector>

#include <dynamics/file/scene_file.hpp>

namespace kreisel {

/// A guide motion whose kind a file has named.
using SceneGuide = std::function<FrameMotion<Guide, Inertial>(double)>;

/// The guide motion of a scene, for times in [0, t_end].
///
/// Cost   : of one link that of its kind, of a chain one product of motions more for each link
/// Throws : InvalidInput as the kinds do, where what each of them takes was not checked in the file
[[nodiscard]] SceneGuide make_guide(const SceneFile& scene);

/// What a BodySystem takes: the bodies, with the gravity that is not uniform among their loads.
struct SceneBodies {
  std::vector<BodyDescription> bodies;
  Gravity gravity;
};

[[nodiscard]] SceneBodies bodies_in_gravity(const SceneFile& scene);

}  // namespace kreisel
