#pragma once

#include <cstddef>
#include <utility>

#include <dynamics/tree/constraint/space.hpp>
#include <dynamics/tree/tree.hpp>
#include <dynamics/tree/workspace.hpp>

/// States and their distance from the conditions.

namespace kreisel::detail {

/// Sets poses and motions relative to the guide, and the rows, for a state.
void set_state(const BodyTree& tree, const Eigen::VectorXd& y, BodyWorkspace& w);

/// The greatest gap relative to its size, and its constraint.
[[nodiscard]] std::pair<double, std::size_t> worst_gap(const ConstraintSpace& c);

/// Puts the gaps of all conditions into c.right.
void list_gaps(ConstraintSpace& c);

/// Moves the coordinates by the small motion c.change.
void move_coordinates(const BodyTree& tree, Eigen::VectorXd& y, ConstraintSpace& c);

/// Changes the rates least so that they fulfil the conditions.
void close_rates(const BodyTree& tree, Eigen::VectorXd& y, ConstraintSpace& c);

/// Moves a state onto the conditions by Newton's method, with the directions at its start. Near a
/// singular position these are rounded.
///
/// Throws : ComputationFailed, naming the constraint, if the state is too far from them
void project_on_directions(const BodyTree& tree, Eigen::VectorXd& y, BodyWorkspace& w);

}  // namespace kreisel::detail
