#pragma once

#include <memory>

#include "model.hpp"

/// The model of a scene that asks for an approximation: states by its equations, all else by the
/// exact ones. Its error is the distance from the exact motion, which is computed beside it.
///
/// linear     : eta' = A eta about the steady motion at the start or next to it
/// precession : technical equations; they have no angles of rotors, which are the exact ones
/// Throws     : kreisel::InvalidInput where the scene has no such equations
[[nodiscard]] std::unique_ptr<Model> make_approximation(const kreisel::SceneFile& scene,
                                                        std::unique_ptr<Model> exact);
