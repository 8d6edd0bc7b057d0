#pragma once

#include <string>
#include <vector>

#include "../shared/scale.hpp"
#include "model.hpp"

/// The columns of a trajectory: t, coordinates and rates of every joint, and on demand what it
/// carries and what its drive needs. Attitudes (w, x, y, z) and places are against the parent.
std::vector<std::string> columns(const kreisel::BodyTree& tree, bool reactions);

/// The numbers of a row, in the order of the columns.
std::vector<double> row(const Model& model, double t, const JointState& state, bool reactions);

/// The row as pictures show it: what is rounding next to the scale is 0.
std::vector<double> shown_row(const kreisel::BodyTree& tree, std::vector<double> values,
                              const Scale& scale);

/// The state in a row.
JointState state_of(const kreisel::BodyTree& tree, const std::vector<double>& row);
