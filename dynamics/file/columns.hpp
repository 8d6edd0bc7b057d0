#pragma once

#include <string>
#include <vector>

#include <dynamics/file/model.hpp>
#include <dynamics/file/scale.hpp>

namespace kreisel {

/// The columns of a trajectory: t, coordinates and rates of every joint, and on demand what it
/// carries and what its drive needs. Attitudes (w, x, y, z) and places are against the parent.
std::vector<std::string> columns(const BodyTree& tree, bool reactions);

/// The numbers of a row, in the order of the columns.
std::vector<double> row(const SceneSolver& model, double t, const JointState& state,
                        bool reactions);

/// The row as pictures show it: what is rounding next to the scale is 0.
std::vector<double> shown_row(const BodyTree& tree, std::vector<double> values,
                              const SceneScale& scale);

/// The state in a row.
JointState state_of(const BodyTree& tree, const std::vector<double>& row);

}  // namespace kreisel
