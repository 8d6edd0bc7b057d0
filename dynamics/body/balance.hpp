#pragma once

#include <algorithm>
#include <variant>

#include <dynamics/body/loads.hpp>
#include <dynamics/body/passes.hpp>

namespace kreisel {

/// What is balanced over a whole system.
///
/// Frame  : momenta on guide axes about the guide's origin; value.reduced_at() takes them elsewhere
/// Units  : J; kg m/s, kg m^2/s
struct BodyBalance {
  double kinetic_energy = 0;               ///< sum of V.(T V)/2, absolute
  double relative_kinetic_energy = 0;      ///< sum of V'.(T V')/2
  double potential_energy = 0;             ///< of springs, gravity and the loads that have one
  Momentum<Guide> momentum = {};           ///< sum of T V
  Momentum<Guide> relative_momentum = {};  ///< sum of T V'
};

namespace detail {

/// The energy of springs and of constant forces along single coordinates.
[[nodiscard]] inline double joint_energy(const BodyTree& tree, const double* q) {
  double sum = 0;
  for (const Link& link : tree.links()) {
    if (rate_count(link.kind) != 1) continue;
    const JointForce& f = tree.forces()[static_cast<std::size_t>(link.v)];
    const double stretch = q[link.q] - f.rest;
    sum += f.stiffness * stretch * stretch / 2 - f.constant * q[link.q];
  }
  return sum;
}

/// Needs poses and places in w.
[[nodiscard]] inline BodyBalance balance(const BodyTree& tree, double t, const GuideNow& guide,
                                         const Gravity& gravity, const double* q,
                                         const BodyWorkspace& w) {
  BodyBalance sum;
  sum.potential_energy = joint_energy(tree, q);
  for (int i = 0; i < static_cast<int>(tree.bodies().size()); ++i) {
    const std::size_t link = tree.link(i);
    const auto& [x, V_rel] = w.place[link];
    const Motor<> V = V_rel + guide.V.value.reduced_at(x);
    const Motor<> p = w.inertia[link] * V;
    const Motor<> p_rel = w.inertia[link] * V_rel;
    sum.kinetic_energy += reciprocal(p, V) / 2;
    sum.relative_kinetic_energy += reciprocal(p_rel, V_rel) / 2;
    sum.momentum.value += carried(x, p);
    sum.relative_momentum.value += carried(x, p_rel);
    sum.potential_energy += potential(situation(tree, t, guide, i, w), gravity, tree.body(i));
  }
  return sum;
}

/// Whether all forces of a tree have a potential, on a guide at rest.
[[nodiscard]] inline bool keeps_energy(const BodyTree& tree) {
  return std::none_of(tree.bodies().begin(), tree.bodies().end(), [](const BodyDescription& b) {
    const auto takes = [&b](const JointForce& f) {
      return f.damping != 0 || (b.forces.size() > 2 && f.constant != 0);
    };
    return b.rule == JointRule::constant_rate ||
           std::any_of(b.forces.begin(), b.forces.end(), takes) ||
           !std::all_of(b.loads.begin(), b.loads.end(),
                        [](const BodyLoad& load) { return load.has_potential(); });
  });
}

/// Whether nothing acts on a tree from outside, on a guide at rest.
[[nodiscard]] inline bool keeps_momentum(const BodyTree& tree, const Gravity& gravity) {
  if (!std::holds_alternative<std::monostate>(gravity)) return false;
  return std::all_of(tree.bodies().begin(), tree.bodies().end(), [](const BodyDescription& b) {
    if (!b.loads.empty()) return false;
    if (b.parent != "guide") return true;
    const auto pushes = [](const JointForce& f) { return f.constant != 0 || f.damping != 0; };
    return b.joint.kind == JointKind::free && b.rule == JointRule::forces &&
           std::none_of(b.forces.begin(), b.forces.end(), pushes);
  });
}

}  // namespace detail

}  // namespace kreisel
