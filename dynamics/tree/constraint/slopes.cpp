#include <algorithm>
#include <cstddef>

#include <dynamics/tree/constraint/space.hpp>
#include <dynamics/tree/constraints.hpp>
#include <dynamics/tree/evaluation.hpp>
#include <dynamics/tree/loads.hpp>
#include <dynamics/tree/passes.hpp>

/// Derivatives of what constraints do, by dual numbers.

namespace kreisel::detail {

namespace {

/// The conditions at a state in dual numbers; leaves poses, motions and positions in d.
Conditions<AlongOne> conditions_along(const BodyTree& tree, const AlongOne* q, const AlongOne* v,
                                      const AlongOne* dv, MotionSpace<AlongOne>& d) {
  Conditions<AlongOne> conditions;
  set_poses_and_motions(tree, LinkMotion<AlongOne>{}, q, v, dv, d);
  set_places(tree, v, d);
  list_conditions(tree, q, v, dv, d, conditions);
  return conditions;
}

double slope(const AlongOne& x) { return x.derivatives()[0]; }

}  // namespace

void respond_on_constraints(const BodyTree& tree, const AlongOnes& q, const AlongOnes& v,
                            const AlongOnes& dv, Eigen::VectorXd& joint_force, BodyWorkspace& w) {
  ConstraintSpace& c = *w.constraints;
  MotionSpace<AlongOne> d(tree);
  const auto conditions = conditions_along(tree, q.data(), v.data(), dv.data(), d);
  std::fill(d.force.begin(), d.force.end(), Motor<AlongOne>{});
  for (std::size_t k = 0; k < conditions.rows.size(); ++k) {
    const ConstraintLink& link = tree.constraints()[conditions.owner[k]];
    if (link.is_gear()) continue;  // its directions are constant
    const AlongOne mu(c.multipliers[static_cast<Eigen::Index>(k)]);
    add_between<AlongOne>(link, mu * conditions.rows[k].direction, d);
  }
  sum_inwards(tree, d);
  AlongOnes held(tree.rates());
  project(tree, d, held.data());
  for (Eigen::Index i = 0; i < joint_force.size(); ++i) joint_force[i] += slope(held[i]);
  respond(tree, joint_force, w);

  c.right = -c.directions.transpose() * w.acceleration;
  for (std::size_t k = 0; k < conditions.rows.size(); ++k) {
    c.right[static_cast<Eigen::Index>(k)] -= slope(conditions.rows[k].acceleration);
  }
  Eigen::VectorXd change;
  solve_multipliers(c.right, change, c);
  w.acceleration += c.responses * change;
}

Eigen::MatrixXd constraint_slopes(const BodyTree& tree, const Eigen::VectorXd& y,
                                  const Eigen::MatrixXd& E) {
  MotionSpace<AlongOne> d(tree);
  const AlongOnes still = AlongOnes::Constant(tree.rates(), AlongOne(0));
  AlongOnes state(y.size());
  Eigen::MatrixXd slopes;
  for (Eigen::Index column = 0; column < E.cols(); ++column) {
    for (Eigen::Index i = 0; i < y.size(); ++i) {
      state[i].value() = y[i];
      state[i].derivatives()[0] = E(i, column);
    }
    const auto conditions =
        conditions_along(tree, state.data(), state.data() + tree.coordinates(), still.data(), d);
    const auto count = static_cast<Eigen::Index>(conditions.rows.size());
    if (column == 0) slopes.resize(2 * count, E.cols());
    for (Eigen::Index k = 0; k < count; ++k) {
      slopes(k, column) = slope(conditions.rows[static_cast<std::size_t>(k)].gap);
      slopes(count + k, column) = slope(conditions.rates[static_cast<std::size_t>(k)]);
    }
  }
  return slopes;
}

}  // namespace kreisel::detail
