#include <cmath>
#include <string>
#include <type_traits>
#include <variant>

#include <dynamics/tree/constraint/numbers.hpp>
#include <dynamics/tree/constraint/space.hpp>
#include <dynamics/tree/constraints.hpp>
#include <dynamics/tree/loads.hpp>
#include <dynamics/tree/passes.hpp>
#include <motor/error.hpp>

namespace kreisel {

void constraint::Gear::list(detail::ConstraintNumbers& numbers) const {
  numbers.add(ratio);
  numbers.add(offset);
}

namespace detail {

using Eigen::Index;
using Eigen::VectorXd;

namespace {

[[noreturn]] void refuse(const std::string& name, const std::string& why) {
  throw InvalidInput("constraint '" + name + "': " + why);
}

void check_numbers(const Constraint& constraint) {
  ConstraintNumbers numbers;
  std::visit([&numbers](const auto& kind) { kind.list(numbers); }, constraint.kind);
  for (const double x : numbers.all) {
    if (!std::isfinite(x)) refuse(constraint.name, "a number is not finite");
  }
  for (const auto& v : numbers.directions) {
    if (!(v.norm() > 0)) refuse(constraint.name, "an axis, a direction or an attitude is 0");
  }
  for (const double length : numbers.lengths) {
    if (!(length > 0)) refuse(constraint.name, "a length or a radius is not positive");
  }
}

/// The coordinate and the rate of a gear's joint.
JointPlace gear_joint(const BodyTree& tree, const Constraint& constraint, const std::string& body) {
  const JointPlace place = tree.place(tree.index(body));
  if (place.q_count == 1 && place.v_count == 1) return place;
  refuse(constraint.name, "the joint of '" + body + "' has not a single coordinate");
}

std::size_t link_of(const BodyTree& tree, const Constraint& constraint, const std::string& body) {
  if (body == "guide") return 0;
  const int index = tree.index(body);
  if (tree.body(index).rotor) {
    refuse(constraint.name, "'" + body + "' is a rotor: hold its carrier, or make it a body");
  }
  return tree.link(index);
}

}  // namespace

ConstraintLink linked(const BodyTree& tree, const Constraint& constraint) {
  if (constraint.first == constraint.second) refuse(constraint.name, "it joins a body to itself");
  check_numbers(constraint);
  ConstraintLink link{constraint};
  link.first = link_of(tree, constraint, constraint.first);
  link.second = link_of(tree, constraint, constraint.second);
  if (link.is_gear()) {
    const JointPlace first = gear_joint(tree, constraint, constraint.first);
    const JointPlace second = gear_joint(tree, constraint, constraint.second);
    link.q_first = first.q;
    link.v_first = first.v;
    link.q_second = second.q;
    link.v_second = second.v;
  }
  return link;
}

void constrain(const BodyTree& tree, const double* q, const double* v, double* dv,
               BodyWorkspace& w) {
  ConstraintSpace& c = *w.constraints;
  set_motions(tree, LinkMotion<>{}, v, dv, w);
  set_places(tree, v, w);
  list_conditions<double>(tree, q, v, dv, w, c);
  set_directions(tree, w);
  c.right = VectorXd::NullaryExpr(static_cast<Index>(c.rows.size()), [&c](Index k) {
    return -c.rows[static_cast<std::size_t>(k)].acceleration;
  });
  solve_multipliers(c.right, c.multipliers, c);
  if (c.pivot < near_singular) {
    // Once more for what is left: the square of the distance has amplified rounding.
    const VectorXd first = c.multipliers;
    c.right -= c.directions.transpose() * (c.responses * first);
    solve_multipliers(c.right, c.multipliers, c);
    c.multipliers += first;
  }
  Eigen::Map<VectorXd>(dv, tree.rates()) += c.responses * c.multipliers;
}

void take_off_constraints(const BodyTree& tree, BodyWorkspace& w) {
  const ConstraintSpace& c = *w.constraints;
  for (std::size_t k = 0; k < c.rows.size(); ++k) {
    const double mu = c.multipliers[static_cast<Index>(k)];
    add_between(tree.constraints()[c.owner[k]], -mu * c.rows[k].direction, w);
  }
}

/// The reaction of a gear on the second joint's body, from its multiplier.
inline Motor<> gear_reaction(const BodyTree& tree, const ConstraintLink& link, double mu,
                             const BodyWorkspace& w) {
  const double force = -std::get<constraint::Gear>(link.constraint.kind).ratio * mu;
  const Vector3<double> along =
      force * (w.pose[link.first].R.transpose() * w.pose[link.second].axis);
  const Vector3<double> none = Vector3<double>::Zero();
  const bool turns = tree.links()[link.second].turns_by_angle();
  return turns ? Motor<>{none, along} : Motor<>{along, none};
}

std::vector<ConstraintReaction> constraint_reactions(const BodyTree& tree, BodyWorkspace& w) {
  const ConstraintSpace& c = *w.constraints;
  std::vector<ConstraintReaction> result;
  for (const ConstraintLink& link : tree.constraints()) {
    result.push_back({link.constraint.name, {}, Vector3<double>::Zero()});
  }
  for (std::size_t k = 0; k < c.rows.size(); ++k) {
    const ConstraintLink& link = tree.constraints()[c.owner[k]];
    const double mu = c.multipliers[static_cast<Index>(k)];
    result[c.owner[k]].on_second +=
        link.is_gear() ? gear_reaction(tree, link, mu, w) : mu * c.rows[k].direction;
  }
  for (std::size_t i = 0; i < result.size(); ++i) {
    const ConstraintLink& link = tree.constraints()[i];
    std::visit(
        [&]<class Kind>(const Kind& kind) {
          if constexpr (!std::is_same_v<Kind, constraint::Gear>) {
            const SeenMotion m = seen(link, w);
            result[i].at = kind.point_of_second(m);
            result[i].on_second = result[i].on_second.reduced_at(m.place(result[i].at));
          }
        },
        link.constraint.kind);
  }
  return result;
}

}  // namespace detail

}  // namespace kreisel
