#pragma once

#include <Eigen/Core>

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <dynamics/tree/constraint/constraint.hpp>
#include <dynamics/tree/tree.hpp>
#include <dynamics/tree/workspace.hpp>
#include <motor/api.hpp>

/// The constraints of a tree of bodies.
///
///   M dv = f + J^t mu,   J dv + c = 0,   so that  J M^-1 J^t mu = -(J M^-1 f + c)
///
/// M^-1 is applied by the tree's own elimination of joints, once for each condition. The cost is
/// linear in the number of bodies times that of conditions. If conditions follow from others, the
/// multipliers are not unique. The smallest are taken, each scaled by the mass that its condition
/// moves.
///
/// Integrators project each step onto the conditions, positions and velocities, by the least change
/// of the motion weighted with M.
///
/// Source : paper 002 section 6; multipliers: R. Featherstone, Rigid Body Dynamics Algorithms,
///          chapter 8

namespace kreisel {

namespace detail {

/// The index, coordinates and rates of the joints in a constraint.
///
/// Throws : InvalidInput, naming the constraint: unknown body, a rotor, the same body twice, a
///          number that is not finite, an axis or direction of length 0, a joint of a gear with
///          several coordinates
[[nodiscard]] ConstraintLink linked(const BodyTree& tree, const Constraint& constraint);

/// Changes the accelerations dv so that they fulfil the conditions. Needs w as the solution for dv
/// leaves it, and leaves the multipliers in w.
void constrain(const BodyTree& tree, const double* q, const double* v, double* dv,
               BodyWorkspace& w);

/// Subtracts the constraints' forces from the forces in w, which the joints transmit. Needs the
/// multipliers in w.
void take_off_constraints(const BodyTree& tree, BodyWorkspace& w);

/// The reactions of all constraints. Needs the multipliers in w.
[[nodiscard]] KREISEL_API std::vector<ConstraintReaction> constraint_reactions(const BodyTree& tree,
                                                                               BodyWorkspace& w);

[[nodiscard]] KREISEL_API std::vector<ConstraintGap> constraint_gaps(const BodyTree& tree,
                                                                     const Eigen::VectorXd& y,
                                                                     BodyWorkspace& w);

/// Moves a state that is close to the conditions onto them.
///
/// Throws : ComputationFailed, naming the constraint, if the state is too far from them
KREISEL_API void project_on_constraints(const BodyTree& tree, Eigen::VectorXd& y, BodyWorkspace& w);

/// True near a singular position: the rates at a state err by its distance from the conditions, over
/// its distance from the singular position. Needs w as constrain() leaves it.
[[nodiscard]] bool is_near_singular(BodyWorkspace& w);

/// The rates near a singular position, from those of states on the conditions: of the state next to
/// y, or interpolated from states before and after y. Nothing if y is far from the conditions. Needs w
/// as constrain() leaves it, and leaves it so at the state next to y.
[[nodiscard]] std::optional<Eigen::VectorXd> rates_near_singular(
    const BodyTree& tree, const Eigen::VectorXd& y, BodyWorkspace& w,
    const std::function<const Eigen::VectorXd&(const Eigen::VectorXd&)>& rates);

/// The nearest state to y that fulfils the conditions, by Newton's method.
///
/// Throws : ComputationFailed, naming the constraint that stays open, if there is none near
KREISEL_API [[nodiscard]] Eigen::VectorXd assembled(const BodyTree& tree, Eigen::VectorXd y,
                                                    BodyWorkspace& w);

using AlongOnes = Eigen::Matrix<AlongOne, Eigen::Dynamic, 1>;

/// The derivatives of the accelerations of a constrained tree, along one direction of its state,
/// into w.acceleration. `joint_force` has the derivatives of all other forces at fixed accelerations
/// dv. With fixed multipliers mu it follows
///
///   M d(dv) = d(forces) + d(J^t mu) + J^t d(mu),   J d(dv) = -d(J dv + c) at fixed dv
///
/// Needs w as rates() leaves it at this state.
KREISEL_API void respond_on_constraints(const BodyTree& tree, const AlongOnes& q,
                                        const AlongOnes& v, const AlongOnes& dv,
                                        Eigen::VectorXd& joint_force, BodyWorkspace& w);

/// The derivatives of all conditions' gaps, then of their rates, along the columns of E.
[[nodiscard]] KREISEL_API Eigen::MatrixXd constraint_slopes(const BodyTree& tree,
                                                            const Eigen::VectorXd& y,
                                                            const Eigen::MatrixXd& E);

[[nodiscard]] KREISEL_API std::vector<RedundantConstraint> redundant_constraints(
    const BodyTree& tree, const Eigen::VectorXd& y, BodyWorkspace& w);

}  // namespace detail

}  // namespace kreisel
