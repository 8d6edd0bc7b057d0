#pragma once

#include <Eigen/Core>

#include <vector>

#include <motor/api.hpp>

namespace kreisel {

/// The directions in which a constrained state can move.
///
///   eta = N eta_I,   G N = 0
///
/// eta_I are the independent components of eta; G are the derivatives of the conditions and of
/// their rates. Without constraints all components are independent.
///
/// Frame : eta as in study/tangent.hpp
/// Units : those of eta
struct FreeDirections {
  std::vector<int> independent = {};
  std::vector<int> dependent = {};  ///< components that follow from the others, in order
  Eigen::MatrixXd N = {};           ///< empty if there are no constraints

  [[nodiscard]] bool bound() const { return N.size() > 0; }

  [[nodiscard]] bool is_dependent(int component) const;

  /// A move, from its independent components.
  [[nodiscard]] Eigen::VectorXd complete(const Eigen::VectorXd& eta) const;

  /// The moves of unit independent components, as columns at their positions among `dimension`; the
  /// unit matrix without constraints.
  [[nodiscard]] Eigen::MatrixXd unit_moves(int dimension) const;
};

namespace detail {

/// Chooses dependent components by QR decompositions with pivoting: first among the coordinates,
/// for the conditions on positions, then among their rates. Components that are given, as those of
/// drives, stay independent.
///
/// slopes : derivatives of the gaps of all conditions, then of their rates, along eta
/// rates  : the number of rates. Coordinates come first in eta, as many as rates.
[[nodiscard]] KREISEL_API FreeDirections free_directions(const Eigen::MatrixXd& slopes,
                                                         const std::vector<int>& given, int rates);

/// The same with a choice of dependent components that was made at another state.
[[nodiscard]] KREISEL_API FreeDirections free_directions(const Eigen::MatrixXd& slopes,
                                                         std::vector<int> dependent);

/// How well the conditions determine these components from the others. It is the least pivot of their
/// columns, relative to the greatest: 0 if one of them is free.
[[nodiscard]] KREISEL_API double determination(const Eigen::MatrixXd& slopes,
                                               const std::vector<int>& dependent);

/// A matrix of `count` columns with the given ones at these positions; the others are 0.
[[nodiscard]] KREISEL_API Eigen::MatrixXd with_columns(const Eigen::MatrixXd& given,
                                                       const std::vector<int>& positions,
                                                       int count);

}  // namespace detail

}  // namespace kreisel
