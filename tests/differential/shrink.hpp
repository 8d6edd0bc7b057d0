#pragma once

#include <functional>

#include "scene.hpp"

namespace differential {

/// The scene without all parts that the fault does not need, removed one after the other.
///
/// fails   : true if a scene has the fault
/// seconds : limit, after which the present scene is returned
[[nodiscard]] Scene shrink(Scene scene, const std::function<bool(const Scene&)>& fails,
                           double seconds);

}  // namespace differential
