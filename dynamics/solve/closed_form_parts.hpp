#pragma once

#include <Eigen/Core>

#include <limits>
#include <optional>

#include <dynamics/model/closed_form.hpp>
#include <dynamics/tree/tree.hpp>

/// Parts of the closed forms of trees.

namespace kreisel::detail {

/// The error per radian from the last digits of the description. Mass, arm, weight and tensor are
/// products of its numbers.
inline constexpr double of_inputs = std::numeric_limits<double>::epsilon();

/// True if nothing but joints and uniform gravity acts on the bodies of a tree.
[[nodiscard]] bool is_free_of_forces(const BodyTree& tree);

/// The closed form of a tree that is a free Cardan gyro on a guide at rest.
[[nodiscard]] std::optional<ClosedForm<Eigen::VectorXd>> gyro_motion(const BodyTree& tree,
                                                                     double begin,
                                                                     const Eigen::VectorXd& y);

}  // namespace kreisel::detail
