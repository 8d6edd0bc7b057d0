#pragma once

#include "random.hpp"
#include "scene.hpp"

namespace differential {

/// A scene that a person might write: anything the language has, often with the numbers that people
/// take (zeros, units, right angles, rest).
[[nodiscard]] Scene generate(Random random);

}  // namespace differential
