#pragma once

#include <optional>
#include <string>

#include <dynamics/file/model.hpp>

namespace differential {

/// A sensor whose increments are wrong.
struct WrongIncrements {
  std::string sensor;
  double off;
  double size;
};

/// The worst increments of the first period of a scene's gyros and accelerometers. Rotations are
/// compared with the attitudes of the same run, the others with a quadrature of the values that the
/// same sensors read. Nothing if all agree to the accuracy of the quadrature and to 1e-9, or if the
/// run fails.
[[nodiscard]] std::optional<WrongIncrements> wrong_increments(const kreisel::SceneSolver& model,
                                                              const kreisel::SceneFile& file);

}  // namespace differential
