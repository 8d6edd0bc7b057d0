#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include <vector>

#include <dynamics/tree/constraint/conditions.hpp>

namespace kreisel::detail {

/// The linear equations of the constraints at one state, and their memory.
struct ConstraintSpace : Conditions<> {
  Eigen::MatrixXd directions;  ///< J^t
  Eigen::MatrixXd responses;   ///< M^-1 J^t
  Eigen::MatrixXd mass;        ///< J M^-1 J^t
  Eigen::MatrixXd scaled;
  Eigen::VectorXd scale;
  Eigen::LLT<Eigen::MatrixXd> factors;
  Eigen::VectorXd right;
  Eigen::VectorXd multipliers;
  Eigen::VectorXd change;  ///< of the motion, and that of the coordinates
  Eigen::VectorXd moved;
  std::vector<double> spin_up;
  double pivot = 1;  ///< the least of the scaled mass, as a part of the greatest
};

/// Sets J, M^-1 J^t and J M^-1 J^t. Needs the rows set and the joints eliminated.
void set_directions(const BodyTree& tree, BodyWorkspace& w);

/// Conditions whose direction is below 1e-6 of the others' follow from these: in J M^-1 J^t it stands
/// squared.
inline constexpr double redundant_below = 1e-12;

/// Below this squared distance from a singular position the directions of conditions are rounded.
inline constexpr double near_singular = 1e-2;

/// Solves  (J M^-1 J^t) x = b  for rows scaled by their mobility, for the least x if some conditions
/// follow from others.
void solve_multipliers(const Eigen::VectorXd& b, Eigen::VectorXd& x, ConstraintSpace& c);

/// The least mobility of a condition, as a part of the greatest of its constraint. Near a singular
/// position it is the square of the distance, in radians or lengths of the bodies. Needs the
/// multipliers solved.
[[nodiscard]] double independence(const ConstraintSpace& c);

}  // namespace kreisel::detail
