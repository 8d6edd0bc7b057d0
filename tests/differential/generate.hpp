#pragma once

#include "random.hpp"
#include "scene.hpp"

namespace differential {

/// A scene that a user might write. It may use all of the language, often with common numbers
/// (zeros, units, right angles, rest).
[[nodiscard]] Scene generate(Random random);

}  // namespace differential
