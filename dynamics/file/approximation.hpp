#pragma once

#include <memory>

#include <dynamics/file/model.hpp>

namespace kreisel {

/// The solver of a scene, by the exact equations or by the approximation that the scene selects.
/// An approximation computes states by its own equations and all else by the exact equations. Its
/// error is that of ModelBound. The exact motion is computed only for SceneFile::compare.
///
/// linear        : about a steady motion
/// small         : about the position of the start, SmallMotion
/// precession    : technical equations, which have no angles of rotors
/// foeppl        : paper 002 (50), FoepplGyro
/// fuchs-weigand : paper 002 (49), UnsymmetricRotor
/// Throws        : InvalidInput if the scene does not fit these equations
[[nodiscard]] std::unique_ptr<SceneSolver> make_approximation(const SceneFile& scene,
                                                              std::unique_ptr<SceneSolver> exact);

}  // namespace kreisel
