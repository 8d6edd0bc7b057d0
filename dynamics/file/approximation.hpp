#pragma once

#include <memory>

#include <dynamics/file/model.hpp>

namespace kreisel {

/// The model of a scene: the exact one, or that of the approximation which it asks for, with states
/// by its equations, all else by the exact ones. Its error is the distance from the exact motion,
/// which is computed beside it. Angles of rotors are the exact ones.
///
/// linear        : eta' = A eta about the steady motion at the start or next to it
/// precession    : technical equations, which have no angles of rotors
/// foeppl        : paper 002 (50), FoepplGyro
/// fuchs-weigand : paper 002 (49), UnsymmetricRotor
/// Throws        : InvalidInput where the scene has no such equations
[[nodiscard]] std::unique_ptr<SceneSolver> make_approximation(const SceneFile& scene,
                                                              std::unique_ptr<SceneSolver> exact);

}  // namespace kreisel
