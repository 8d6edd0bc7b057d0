#pragma once

#include <Eigen/Core>

#include <string>
#include <utility>
#include <vector>

#include <dynamics/law/relative.hpp>
#include <dynamics/model/corner.hpp>
#include <dynamics/model/terms.hpp>
#include <dynamics/tree/balance.hpp>
#include <dynamics/tree/loads.hpp>
#include <dynamics/tree/reaction.hpp>
#include <dynamics/tree/workspace.hpp>
#include <motor/api.hpp>

/// The computations of a BodySystem for a given motion of its guide, whatever the guide's type. The
/// functions are documented in dynamics/tree/body_system.hpp.

namespace kreisel::detail {

/// Time, guide motion, gravity and forces from outside of a tree at one moment.
struct Surroundings {
  double t;
  GuideNow<> guide;
  bool guide_rests;
  const Gravity& gravity;
  const OutsideForces<double>* outside = nullptr;  ///< null: none
};

/// Refuses a gravity that is not finite.
///
/// Throws : InvalidInput
KREISEL_API void check_gravity(const Gravity& gravity);

KREISEL_API [[noreturn]] void refuse_sizes(const BodyTree& tree, Eigen::Index components,
                                           Eigen::Index per_rate);

/// Checks the sizes of a state, of a vector with one number per rate, and of a workspace.
///
/// Throws : InvalidInput if one of them does not fit this tree
inline void require(const BodyTree& tree, const Eigen::VectorXd& y, Eigen::Index per_rate,
                    const BodyWorkspace& w) {
  const bool fit = y.size() == tree.coordinates() + tree.rates() &&
                   (per_rate == 0 || per_rate == tree.rates()) && w.pose.size() == tree.slots() &&
                   w.joint_force.size() == tree.rates();
  if (!fit) refuse_sizes(tree, y.size(), per_rate);
}

/// Checks that all loads take dual numbers.
///
/// Throws : InvalidInput, naming the body, for a load that does not
KREISEL_API void require_dual_loads(const BodyTree& tree);

/// A state as one vector, and its two parts.
[[nodiscard]] KREISEL_API Eigen::VectorXd joined(const Eigen::VectorXd& coordinates,
                                                 const Eigen::VectorXd& rates);
[[nodiscard]] KREISEL_API Eigen::VectorXd coordinates(const BodyTree& tree,
                                                      const Eigen::VectorXd& y);
[[nodiscard]] KREISEL_API Eigen::VectorXd rates(const BodyTree& tree, const Eigen::VectorXd& y);

/// The accelerations of the joints into `result`; leaves poses, motions and factors in w.
KREISEL_API void accelerate(const BodyTree& tree, const Surroundings& now, const Eigen::VectorXd& y,
                            double* result, BodyWorkspace& w);

KREISEL_API void rates(const BodyTree& tree, const Surroundings& now, const Eigen::VectorXd& y,
                       Eigen::VectorXd& result, BodyWorkspace& w);

/// Solves  M dv = joint_force  for a system at rest, into w.acceleration. Needs w as rates() leaves
/// it at the same coordinates: joints eliminated, axes of rotors set.
KREISEL_API void respond(const BodyTree& tree, const Eigen::VectorXd& joint_force,
                         BodyWorkspace& w);

/// As above, for joint forces and accelerations as arrays.
void respond(const BodyTree& tree, const double* joint_force, double* result, BodyWorkspace& w);

KREISEL_API void joint_forces(const BodyTree& tree, const Surroundings& now,
                              const Eigen::VectorXd& y, const Eigen::VectorXd& dv,
                              Eigen::VectorXd& result, BodyWorkspace& w);

KREISEL_API void mass_matrix(const BodyTree& tree, const Eigen::VectorXd& y,
                             Eigen::MatrixXd& result, BodyWorkspace& w);

KREISEL_API void reactions(const BodyTree& tree, const Surroundings& now, const Eigen::VectorXd& y,
                           JointReactions& result, BodyWorkspace& w);

KREISEL_API void reaction_parts(const BodyTree& tree, const Surroundings& now,
                                const Eigen::VectorXd& y, std::vector<ReactionParts>& result,
                                BodyWorkspace& w);

KREISEL_API void element_forces(const BodyTree& tree, const Surroundings& now,
                                const Eigen::VectorXd& y, std::vector<Motor<>>& result,
                                BodyWorkspace& w);

KREISEL_API [[nodiscard]] LoadContext<> situation(const BodyTree& tree, const Surroundings& now,
                                                  const Eigen::VectorXd& y, int body,
                                                  BodyWorkspace& w);

KREISEL_API [[nodiscard]] ForceParts<Body> terms(const BodyTree& tree, const Surroundings& now,
                                                 const Eigen::VectorXd& y, int body,
                                                 BodyWorkspace& w);

KREISEL_API [[nodiscard]] Terms terms(const BodyTree& tree, bool guide_rests,
                                      const Gravity& gravity);

KREISEL_API [[nodiscard]] BodyBalance balance(const BodyTree& tree, const Surroundings& now,
                                              const Eigen::VectorXd& y, BodyWorkspace& w);

/// As element_corners(), with those of damped ropes whose pull ends before they are slack.
KREISEL_API [[nodiscard]] std::vector<Corner> corners(const BodyTree& tree, const Surroundings& now,
                                                      const Eigen::VectorXd& y, BodyWorkspace& w);

KREISEL_API [[nodiscard]] std::vector<std::pair<std::string, double>> conserved(
    const BodyTree& tree, const Surroundings& now, const Eigen::VectorXd& y, BodyWorkspace& w);

}  // namespace kreisel::detail
