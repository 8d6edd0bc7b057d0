#pragma once

#include <Eigen/Core>

#include <vector>

#include <dynamics/file/joints.hpp>

namespace kreisel {

/// Coordinates and rates of joints, and the memory of controllers, as one vector.
[[nodiscard]] inline Eigen::VectorXd joined(const JointState& state) {
  Eigen::VectorXd y(state.coordinates.size() + state.rates.size() + state.memory.size());
  y << state.coordinates, state.rates, state.memory;
  return y;
}

/// The blocks of a system's state, for ErrorMeasure.
struct Measured {
  using Vector = Eigen::VectorXd;
  std::vector<int> blocks;
};

}  // namespace kreisel
