#pragma once

#include <algorithm>
#include <cstddef>
#include <variant>

#include <dynamics/tree/balance.hpp>
#include <dynamics/tree/elements.hpp>
#include <dynamics/tree/joint/list.hpp>
#include <dynamics/tree/loads.hpp>

/// Energy and momentum of a tree, and the law by which its energy is conserved.

namespace kreisel::detail {

/// The potential energy of weight and loads of one body.
[[nodiscard]] inline double potential(const LoadContext<>& s, const Gravity& gravity,
                                      const BodyDescription& body) {
  double sum = 0;
  if (body.inertia.value.mass > 0) {
    if (const auto* g = std::get_if<UniformGravity<Guide>>(&gravity)) sum += g->potential(s);
    if (const auto* g = std::get_if<UniformGravity<Inertial>>(&gravity)) sum += g->potential(s);
  }
  for (const BodyLoad& load : body.loads) sum += load.potential(s);
  return sum;
}

/// The potential energy of springs and of constant forces along single coordinates.
[[nodiscard]] inline double joint_energy(const BodyTree& tree, const double* q) {
  double sum = 0;
  for (const Link& link : tree.links()) {
    if (rate_count(link.kind) != 1) continue;
    const JointForce& f = tree.forces()[static_cast<std::size_t>(link.v)];
    const double stretch = q[link.q] - f.rest;
    sum += f.stiffness * stretch * stretch / 2 - f.constant * q[link.q];
  }
  for (const RotorLink& rotor : tree.rotors()) {
    if (rotor.mode != RotorMode::torque) continue;
    sum -= tree.forces()[static_cast<std::size_t>(rotor.link.v)].constant * q[rotor.link.q];
  }
  return sum;
}

/// The weight l of a rotor, from its rate and the absolute angular velocity of its carrier. Needs
/// poses and positions in w.
[[nodiscard]] inline double momentum_weight(const BodyTree& tree, std::size_t rotor,
                                            const GuideNow<>& guide, const double* v,
                                            const BodyWorkspace& w) {
  const RotorLink& r = tree.rotors()[rotor];
  const Vector3<double> turn = w.place[carrier(r)].V.resultant + guide.V.value.resultant;
  return momentum_weight(r, v[r.link.v], dot(w.pose[tree.rotor_slot(rotor)].axis, turn));
}

/// Adds the energy and momentum of the rotors' spin to the sums over the links.
inline void add_spins(const BodyTree& tree, const GuideNow<>& guide, const double* v,
                      const BodyWorkspace& w, BodyBalance& sum) {
  for (std::size_t k = 0; k < tree.rotors().size(); ++k) {
    const RotorLink& rotor = tree.rotors()[k];
    const auto c = static_cast<std::size_t>(rotor.link.parent);
    const Vector3<double>& e = w.pose[tree.rotor_slot(k)].axis;
    const double rate = v[rotor.link.v];
    const double relative = dot(e, w.place[c].V.resultant);
    const double absolute = relative + dot(e, guide.V.value.resultant);
    const auto energy = [&](double turn) {
      return rotor.regulated() ? rotor.about * rate * (turn + rate / 2)
                               : rotor.about * (rate + turn) * (rate + turn) / 2;
    };
    sum.kinetic_energy += energy(absolute);
    sum.relative_kinetic_energy += energy(relative);
    sum.momentum.value.moment += momentum_weight(rotor, rate, absolute) * e;
    sum.relative_momentum.value.moment += momentum_weight(rotor, rate, relative) * e;
  }
}

/// The energies and momenta of a tree. Needs poses and positions in w.
[[nodiscard]] inline BodyBalance balance(const BodyTree& tree, double t, const GuideNow<>& guide,
                                         const Gravity& gravity, const double* q, const double* v,
                                         const BodyWorkspace& w) {
  BodyBalance sum;
  sum.potential_energy = joint_energy(tree, q) + element_energy(tree, t, q, w);
  for (std::size_t link = 0; link < tree.links().size(); ++link) {
    const Inertia<>& T = link == 0 ? tree.links()[0].inertia : w.inertia[link];
    const auto& [x, V_rel] = w.place[link];
    const Motor<> V = V_rel + guide.V.value.reduced_at(x);
    const Motor<> p = T * V;
    const Motor<> p_rel = T * V_rel;
    sum.kinetic_energy += reciprocal(p, V) / 2;
    sum.relative_kinetic_energy += reciprocal(p_rel, V_rel) / 2;
    sum.momentum.value += carried(x, p);
    sum.relative_momentum.value += carried(x, p_rel);
  }
  sum.carrier_energy = sum.kinetic_energy;
  add_spins(tree, guide, v, w, sum);
  for (int i = 0; i < static_cast<int>(tree.bodies().size()); ++i) {
    sum.potential_energy += potential(situation(tree, t, guide, i, w), gravity, tree.body(i));
  }
  return sum;
}

/// The energy that is conserved on a guide at rest.
enum class EnergyLaw {
  none,
  all,
  without_spin  ///< BodyBalance::carrier_energy + potential_energy: T2 + V
};

/// True if no force of a tree changes the energy on a guide at rest. Motors of regulated rotors are
/// not counted.
[[nodiscard]] inline bool keeps_energy(const BodyTree& tree) {
  const auto& elements = tree.elements();
  const bool loses = !std::all_of(elements.begin(), elements.end(), [](const Element& element) {
    return kreisel::keeps_energy(element);
  });
  if (loses) return false;
  return std::none_of(tree.bodies().begin(), tree.bodies().end(), [](const BodyDescription& b) {
    if (b.rotor && b.rotor->mode == RotorMode::regulated) return false;
    const bool has_attitude = joint_type(b.joint.kind).has_attitude();
    const auto takes = [has_attitude](const JointForce& f) {
      return f.damping != 0 || f.in_time || (has_attitude && f.constant != 0);
    };
    return b.rule == JointRule::driven || std::any_of(b.forces.begin(), b.forces.end(), takes) ||
           !std::all_of(b.loads.begin(), b.loads.end(),
                        [](const BodyLoad& load) { return load.keeps_energy(); });
  });
}

/// The energy law of a tree on a guide at rest.
///
/// Source : paper 000 (9)-(13) for L = const: d(u^t A* u)/dt = 2 u^t Q; there is no such law if the
///          rate of a regulated rotor changes with time or another rotor has a motor torque
[[nodiscard]] inline EnergyLaw energy_law(const BodyTree& tree) {
  if (!keeps_energy(tree)) return EnergyLaw::none;
  const auto any = [&tree](const auto& is) {
    return std::any_of(tree.bodies().begin(), tree.bodies().end(),
                       [&is](const BodyDescription& b) { return b.rotor && is(*b.rotor); });
  };
  const bool regulated = any([](const Rotor& r) { return r.mode == RotorMode::regulated; });
  const bool driven = any([](const Rotor& r) { return r.mode == RotorMode::torque; });
  const bool changed = any([](const Rotor& r) { return static_cast<bool>(r.acceleration); });
  if (!regulated) return EnergyLaw::all;
  return driven || changed ? EnergyLaw::none : EnergyLaw::without_spin;
}

}  // namespace kreisel::detail
