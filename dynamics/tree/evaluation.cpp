#include <Eigen/Core>

#include <algorithm>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include <dynamics/tree/accelerations.hpp>
#include <dynamics/tree/check.hpp>
#include <dynamics/tree/conservation.hpp>
#include <dynamics/tree/constraints.hpp>
#include <dynamics/tree/elements.hpp>
#include <dynamics/tree/evaluation.hpp>
#include <dynamics/tree/kept_momenta.hpp>
#include <dynamics/tree/mass_matrix.hpp>
#include <dynamics/tree/passes.hpp>
#include <dynamics/tree/terms.hpp>
#include <motor/error.hpp>

namespace kreisel {

BodyWorkspace::BodyWorkspace(const BodyTree& tree)
    : MotionSpace(tree),
      articulated(tree.links().size()),
      single(tree.links().size()),
      size(tree.links().size()),
      delta(tree.links().size()),
      ball(static_cast<std::size_t>(tree.balls())),
      still(Eigen::VectorXd::Zero(tree.rates())),
      acceleration(Eigen::VectorXd::Zero(tree.rates())),
      outside{Eigen::VectorXd::Zero(tree.rates()), {}, {}},
      spin_up(tree.rotors().size()),
      driven(tree.is_prescribed() ? static_cast<std::size_t>(tree.rates()) : 0) {}

BodyWorkspace::BodyWorkspace(const BodyWorkspace&) = default;
BodyWorkspace::BodyWorkspace(BodyWorkspace&&) noexcept = default;
BodyWorkspace& BodyWorkspace::operator=(const BodyWorkspace&) = default;
BodyWorkspace& BodyWorkspace::operator=(BodyWorkspace&&) noexcept = default;
BodyWorkspace::~BodyWorkspace() = default;

namespace detail {

/// The force of a body's joint on the body. Needs w.force summed inwards.
[[nodiscard]] inline Force<Body> joint_reaction(const BodyTree& tree, int body,
                                                const BodyWorkspace& w) {
  const std::size_t link = tree.link(body);
  const Matrix3<double>& R = w.pose[link].R;
  const auto& [force, moment] = w.force[link];
  return {{transposed_product(R, force), transposed_product(R, moment)}};
}

/// The terms of (26) of one body, from the absolute accelerations less g in w.
[[nodiscard]] inline ForceParts<Body> terms_of_body(const BodyTree& tree, const LoadContext<>& s,
                                                    int body, const Vector3<double>& g,
                                                    const BodyWorkspace& w) {
  const std::size_t link = tree.link(body);
  const LinkMotion<>& absolute = w.motion[link];
  const auto& [x, V] = w.place[link];
  const Vector3<double>& u = s.guide.V.value.resultant;
  const Vector3<double>& du = s.guide.dV.value.resultant;
  const Vector3<double> carried =
      s.guide.origin_acceleration() + cross(du, x) + cross(u, cross(u, x));
  const Vector3<double> turn = absolute.dw - du - cross(u, V.resultant);
  const Vector3<double> slide = absolute.a + g - carried - 2.0 * cross(u, V.moment);
  const Matrix3<double>& R = w.pose[link].R;
  const Rate<Body, Velocity<Body, Guide, Body>> dV_rel{
      {transposed_product(R, turn), transposed_product(R, slide - cross(V.resultant, V.moment))}};
  const Displacement<Body, Guide> X = s.X.inverse();
  return equation_of_motion(s.inertia, s.V_rel, X * s.guide.V, dV_rel, X * s.guide.dV);
}

void check_gravity(const Gravity& gravity) {
  if (is_finite(field<double>(gravity, {}))) return;
  throw InvalidInput("system of bodies: gravity is not finite");
}

void refuse_sizes(const BodyTree& tree, Eigen::Index components, Eigen::Index per_rate) {
  if (components != tree.coordinates() + tree.rates()) {
    throw InvalidInput("system of bodies: a state of " + std::to_string(components) +
                       " components, not " + std::to_string(tree.coordinates() + tree.rates()));
  }
  if (per_rate != 0 && per_rate != tree.rates()) {
    throw InvalidInput("system of bodies: " + std::to_string(per_rate) + " numbers for " +
                       std::to_string(tree.rates()) + " rates");
  }
  throw InvalidInput("system of bodies: the workspace is of another system");
}

void require_dual_loads(const BodyTree& tree) {
  for (const int body : tree.loaded()) {
    const auto& loads = tree.body(body).loads;
    if (std::all_of(loads.begin(), loads.end(),
                    [](const BodyLoad& load) { return load.takes_dual_numbers(); })) {
      continue;
    }
    refuse_body(tree.body(body).name,
                "a load of it takes no dual numbers, so it has no linear equations: make "
                "it a template on the number type N,  Force<Body, N> operator()(const "
                "LoadContext<N>&) const");
  }
}

Eigen::VectorXd joined(const Eigen::VectorXd& coordinates, const Eigen::VectorXd& rates) {
  Eigen::VectorXd y(coordinates.size() + rates.size());
  y << coordinates, rates;
  return y;
}

Eigen::VectorXd coordinates(const BodyTree& tree, const Eigen::VectorXd& y) {
  return y.head(tree.coordinates());
}

Eigen::VectorXd rates(const BodyTree& tree, const Eigen::VectorXd& y) {
  return y.tail(tree.rates());
}

/// The motion of the tree's root, the guide, with gravity subtracted.
[[nodiscard]] inline LinkMotion<> root(const Surroundings& now) {
  return root(now.guide, now.gravity, now.guide_rests);
}

[[nodiscard]] inline const double* rates_of(const BodyTree& tree, const Eigen::VectorXd& y) {
  return y.data() + tree.coordinates();
}

/// Adds the joint forces from outside.
inline void add_outside(const OutsideForces<double>& outside, BodyWorkspace& w) {
  if (outside.joint_force.size() > 0) w.joint_force += outside.joint_force;
}

/// Sets the accelerations of driven joints, and makes all fulfil the constraints. A null `driven`:
/// there is neither.
inline void prescribe(const BodyTree& tree, const Eigen::VectorXd& y, const double* driven,
                      const double* v, double* acceleration, BodyWorkspace& w) {
  if (driven == nullptr) return;
  set_driven(tree, driven, acceleration);
  if (!tree.constraints().empty()) constrain(tree, y.data(), v, acceleration, w);
}

void accelerate(const BodyTree& tree, const Surroundings& now, const Eigen::VectorXd& y,
                double* result, BodyWorkspace& w) {
  const double* v = rates_of(tree, y);
  const double* const driven = ask_drives(tree, now.t, w);
  set_poses_and_motions(tree, root(now), y.data(), v, driven, w);
  set_joint_forces(tree, y.data(), v, w);
  if (tree.is_acted_on()) {
    take_off_loads(tree, now.t, now.guide, v, w);
    add_timed_forces(tree, now.t, w);
    apply_elements(tree, now.t, y.data(), v, w);
  }
  if (now.outside != nullptr) {
    take_off_outside(tree, *now.outside, now.t, v, w);
    add_outside(*now.outside, w);
  }
  ask_spin_up(tree, now.t, w);
  add_rotor_forces(tree, v, w.joint_force.data(), w);
  eliminate_and_solve(tree, w.joint_force.data(), result, w);
  prescribe(tree, y, driven, v, result, w);
}

void rates(const BodyTree& tree, const Surroundings& now, const Eigen::VectorXd& y,
           Eigen::VectorXd& result, BodyWorkspace& w) {
  result.resize(y.size());
  const auto evaluate = [&](const Eigen::VectorXd& state) -> const Eigen::VectorXd& {
    set_coordinate_rates(tree, state.data(), rates_of(tree, state), result.data());
    accelerate(tree, now, state, result.data() + tree.coordinates(), w);
    return result;
  };
  evaluate(y);
  if (tree.constraints().empty() || !is_near_singular(w)) return;
  if (const auto near = rates_near_singular(tree, y, w, evaluate)) result = *near;
}

void respond(const BodyTree& tree, const double* joint_force, double* result, BodyWorkspace& w) {
  std::fill(w.motion.begin(), w.motion.end(), LinkMotion<>{});
  std::fill(w.force.begin(), w.force.end(), Motor<>{});
  ask_no_spin_up(w);
  add_rotor_forces(tree, w.still.data(), joint_force, w);
  solve(tree, joint_force, result, w);
}

void respond(const BodyTree& tree, const Eigen::VectorXd& joint_force, BodyWorkspace& w) {
  respond(tree, joint_force.data(), w.acceleration.data(), w);
}

/// Sets the joint forces of springs, dampers, functions of time, couplings and from outside.
inline void set_all_joint_forces(const BodyTree& tree, const Surroundings& now,
                                 const Eigen::VectorXd& y, BodyWorkspace& w) {
  const double* v = rates_of(tree, y);
  set_joint_forces(tree, y.data(), v, w);
  add_timed_forces(tree, now.t, w);
  add_couplings(tree, y.data(), v, w.joint_force);
  if (now.outside != nullptr) add_outside(*now.outside, w);
}

/// As joint_forces(). held : the constraints' forces, from the multipliers in w, are among the
/// forces on the bodies
void joint_forces(const BodyTree& tree, const Surroundings& now, const Eigen::VectorXd& y,
                  const Eigen::VectorXd& dv, bool held, Eigen::VectorXd& result, BodyWorkspace& w) {
  const double* v = rates_of(tree, y);
  result.resize(tree.rates());
  set_poses_and_motions(tree, root(now), y.data(), v, dv.size() ? dv.data() : nullptr, w);
  take_off_loads(tree, now.t, now.guide, v, w);
  take_off_elements(tree, now.t, v, w);
  if (now.outside != nullptr) take_off_outside(tree, *now.outside, now.t, v, w);
  const double* given = dv.size() ? dv.data() : w.still.data();
  add_rotor_forces_at(tree, v, given, w);
  if (held) take_off_constraints(tree, w);
  sum_inwards(tree, w);
  project(tree, w, result.data());
  project_rotors(tree, given, w, result.data());
  set_all_joint_forces(tree, now, y, w);
  result -= w.joint_force;
}

void joint_forces(const BodyTree& tree, const Surroundings& now, const Eigen::VectorXd& y,
                  const Eigen::VectorXd& dv, Eigen::VectorXd& result, BodyWorkspace& w) {
  joint_forces(tree, now, y, dv, false, result, w);
}

void mass_matrix(const BodyTree& tree, const Eigen::VectorXd& y, Eigen::MatrixXd& result,
                 BodyWorkspace& w) {
  set_poses(tree, y.data(), w);
  mass_matrix(tree, w, result);
}

void reactions(const BodyTree& tree, const Surroundings& now, const Eigen::VectorXd& y,
               JointReactions& result, BodyWorkspace& w) {
  accelerate(tree, now, y, w.acceleration.data(), w);
  joint_forces(tree, now, y, w.acceleration, !tree.constraints().empty(), result.drive, w);
  for (const Link& link : tree.links()) {
    if (!link.moved_by_forces()) continue;
    for (int k = 0; k < rate_count(link.kind); ++k) result.drive[link.v + k] = 0;
  }
  for (const RotorLink& rotor : tree.rotors()) {
    if (!rotor.regulated()) result.drive[rotor.link.v] = 0;
  }
  set_rotor_poses(tree, y.data(), w);
  complete_rotor_forces(tree, rates_of(tree, y), w.acceleration.data(), w);
  result.on_body.resize(tree.bodies().size());
  for (std::size_t i = 0; i < tree.bodies().size(); ++i) {
    result.on_body[i] = joint_reaction(tree, static_cast<int>(i), w);
  }
}

/// Computes the reactions to one group of causes. Needs the joints eliminated and w.joint_force
/// set.
inline void answer(const BodyTree& tree, const LinkMotion<>& root, const double* v,
                   const double* driven, const Surroundings* forces_at, const Eigen::VectorXd& y,
                   BodyWorkspace& w) {
  const auto set_forces = [&](const double* dv) {
    set_motions(tree, root, v, dv, w);
    if (!forces_at) return;
    take_off_loads(tree, forces_at->t, forces_at->guide, rates_of(tree, y), w);
    take_off_elements(tree, forces_at->t, rates_of(tree, y), w);
    if (forces_at->outside != nullptr) {
      take_off_outside(tree, *forces_at->outside, forces_at->t, rates_of(tree, y), w);
    }
  };
  set_forces(driven);
  add_rotor_forces(tree, v, w.joint_force.data(), w);
  solve(tree, w.joint_force.data(), w.acceleration.data(), w);
  prescribe(tree, y, driven, v, w.acceleration.data(), w);
  const double* dv = w.acceleration.data();
  set_forces(dv);
  add_rotor_forces_at(tree, v, dv, w);
  if (!tree.constraints().empty()) take_off_constraints(tree, w);
  sum_inwards(tree, w);
  set_rotor_poses(tree, y.data(), w);
  complete_rotor_forces(tree, v, dv, w);
}

void reaction_parts(const BodyTree& tree, const Surroundings& now, const Eigen::VectorXd& y,
                    std::vector<ReactionParts>& result, BodyWorkspace& w) {
  const LinkMotion<> moving{now.guide.V.value.resultant, now.guide.dV.value.resultant,
                            now.guide.origin_acceleration()};
  const Vector3<double> zero = Vector3<double>::Zero();
  const LinkMotion<> weight{zero, zero, -field(now.gravity, now.guide)};
  result.resize(tree.bodies().size());
  set_poses(tree, y.data(), w);
  eliminate_all(tree, w);
  const double* v = rates_of(tree, y);
  const double* still = w.still.data();
  const auto note = [&](Force<Body> ReactionParts::*part) {
    for (std::size_t i = 0; i < result.size(); ++i) {
      result[i].*part = joint_reaction(tree, static_cast<int>(i), w);
    }
  };
  w.joint_force.setZero();
  ask_spin_up(tree, now.t, w);
  const double* const driven = ask_drives(tree, now.t, w);
  answer(tree, {}, v, driven, nullptr, y, w);
  note(&ReactionParts::spin);
  answer(tree, moving, v, driven, nullptr, y, w);
  note(&ReactionParts::guide);
  for (ReactionParts& parts : result) parts.guide = parts.guide - parts.spin;
  ask_no_spin_up(w);
  const double* const undriven = tree.constraints().empty() ? nullptr : still;
  answer(tree, weight, still, undriven, nullptr, y, w);
  note(&ReactionParts::gravity);
  set_all_joint_forces(tree, now, y, w);
  answer(tree, {}, still, undriven, &now, y, w);
  note(&ReactionParts::forces);
}

void element_forces(const BodyTree& tree, const Surroundings& now, const Eigen::VectorXd& y,
                    std::vector<Motor<>>& result, BodyWorkspace& w) {
  const double* v = rates_of(tree, y);
  set_poses(tree, y.data(), w);
  set_places(tree, v, w);
  element_forces(tree, now.t, y.data(), v, now.outside, w, result);
}

LoadContext<> situation(const BodyTree& tree, const Surroundings& now, const Eigen::VectorXd& y,
                        int body, BodyWorkspace& w) {
  const double* v = rates_of(tree, y);
  set_poses(tree, y.data(), w);
  set_places(tree, v, w);
  set_rotor_places(tree, y.data(), v, w);
  return situation(tree, now.t, now.guide, body, w);
}

ForceParts<Body> terms(const BodyTree& tree, const Surroundings& now, const Eigen::VectorXd& y,
                       int body, BodyWorkspace& w) {
  const double* v = rates_of(tree, y);
  accelerate(tree, now, y, w.acceleration.data(), w);
  set_motions(tree, root(now), v, w.acceleration.data(), w);
  set_places(tree, v, w);
  set_rotor_places(tree, y.data(), v, w);
  set_rotor_motions(tree, v, w.acceleration.data(), w);
  return terms_of_body(tree, situation(tree, now.t, now.guide, body, w), body,
                       field(now.gravity, now.guide), w);
}

Terms terms(const BodyTree& tree, bool guide_rests, const Gravity& gravity) {
  return equation_terms(tree, guide_rests, gravity);
}

BodyBalance balance(const BodyTree& tree, const Surroundings& now, const Eigen::VectorXd& y,
                    BodyWorkspace& w) {
  const double* v = rates_of(tree, y);
  set_poses(tree, y.data(), w);
  set_places(tree, v, w);
  set_rotor_places(tree, y.data(), v, w);
  return balance(tree, now.t, now.guide, now.gravity, y.data(), v, w);
}

std::vector<Corner> corners(const BodyTree& tree, const Surroundings& now, const Eigen::VectorXd& y,
                            BodyWorkspace& w) {
  set_poses(tree, y.data(), w);
  set_places(tree, rates_of(tree, y), w);
  std::vector<Corner> result = element_corners(tree, now.t, now.outside, w);
  if (has_damped_ropes(tree)) {
    Eigen::VectorXd dy;
    rates(tree, now, y, dy, w);
    append_ends_of_pull(tree, now.t, now.outside, y, dy, result);
  }
  return result;
}

std::vector<std::pair<std::string, double>> conserved(const BodyTree& tree, const Surroundings& now,
                                                      const Eigen::VectorXd& y, BodyWorkspace& w) {
  std::vector<std::pair<std::string, double>> result;
  const BodyBalance sums = balance(tree, now, y, w);
  for (std::size_t k = 0; k < tree.rotors().size(); ++k) {
    const RotorLink& rotor = tree.rotors()[k];
    if (rotor.mode != RotorMode::free) continue;
    result.emplace_back("cyclic momentum of '" + tree.body(rotor.link.body).name + "'",
                        momentum_weight(tree, k, now.guide, rates_of(tree, y), w));
  }
  if (!now.guide_rests) return result;
  switch (energy_law(tree)) {
    case EnergyLaw::none: break;
    case EnergyLaw::all:
      result.emplace_back("energy", sums.kinetic_energy + sums.potential_energy);
      break;
    case EnergyLaw::without_spin:
      result.emplace_back("energy without spin", sums.carrier_energy + sums.potential_energy);
      break;
  }
  add_kept_momenta(tree, now.guide, now.gravity, rates_of(tree, y), w, result);
  return result;
}

}  // namespace detail

}  // namespace kreisel
