#pragma once

#include <Eigen/Core>

#include <functional>
#include <optional>

#include <dynamics/tree/tree.hpp>
#include <dynamics/tree/workspace.hpp>

namespace kreisel::detail {

/// The value at y of a vector function of states, interpolated between states on the conditions before
/// and after y. Nothing far from a singular position, if y rests, or if states before and after y are
/// near a singular position too. Needs the multipliers solved at y.
[[nodiscard]] std::optional<Eigen::VectorXd> interpolated_near_singular(
    const BodyTree& tree, const Eigen::VectorXd& y, BodyWorkspace& w,
    const std::function<const Eigen::VectorXd&(const Eigen::VectorXd&)>& value);

}  // namespace kreisel::detail
