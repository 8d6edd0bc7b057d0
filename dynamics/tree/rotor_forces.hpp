#pragma once

#include <algorithm>
#include <cstddef>

#include <dynamics/tree/rotors.hpp>

/// Rotors on their carriers in the forward dynamics and in the computation of reactions.

namespace kreisel::detail {

/// Sets w.spin_up to the prescribed relative accelerations of the regulated rotors.
inline void ask_spin_up(const BodyTree& tree, double t, BodyWorkspace& w) {
  for (std::size_t k = 0; k < tree.rotors().size(); ++k) {
    const auto& asked = tree.body(tree.rotors()[k].link.body).rotor->acceleration;
    w.spin_up[k] = asked ? asked(t) : 0;
  }
}

inline void ask_no_spin_up(BodyWorkspace& w) { std::fill(w.spin_up.begin(), w.spin_up.end(), 0.0); }

/// The prescribed derivatives of rates, one for each rate, in w.driven; null if there are neither
/// drives nor constraints.
[[nodiscard]] inline const double* ask_drives(const BodyTree& tree, double t, BodyWorkspace& w) {
  if (!tree.is_prescribed()) return nullptr;
  for (const BodyTree::Drive& drive : tree.drives()) {
    w.driven[static_cast<std::size_t>(drive.rate)] = drive.acceleration(t);
  }
  return w.driven.data();
}

/// Copies the prescribed derivatives.
inline void set_driven(const BodyTree& tree, const double* driven, double* acceleration) {
  for (const BodyTree::Drive& drive : tree.drives()) acceleration[drive.rate] = driven[drive.rate];
}

/// Adds the rotors' gyroscopic torques and motor reactions to the inertia forces in w. The motor
/// torques are the joint forces; for regulated rotors they follow from spin_up.
inline void add_rotor_forces(const BodyTree& tree, const double* v, const double* joint_force,
                             BodyWorkspace& w) {
  for (std::size_t k = 0; k < tree.rotors().size(); ++k) {
    const RotorLink& rotor = tree.rotors()[k];
    const std::size_t c = carrier(rotor);
    const Vector3<double>& e = w.pose[tree.rotor_slot(k)].axis;
    const Vector3<double>& turn = w.motion[c].w;
    const double l = momentum_weight(rotor, v[rotor.link.v], dot(e, turn));
    const double N = rotor.regulated() ? rotor.about * w.spin_up[k] : joint_force[rotor.link.v];
    w.force[c].moment += l * cross(turn, e) + N * e;
  }
}

/// Sets the rotors' own accelerations. Needs their carriers' accelerations in w: those at dv = 0
/// and the differences from them.
inline void accelerate_rotors(const BodyTree& tree, const double* joint_force, double* acceleration,
                              const BodyWorkspace& w) {
  for (std::size_t k = 0; k < tree.rotors().size(); ++k) {
    const RotorLink& rotor = tree.rotors()[k];
    const std::size_t c = carrier(rotor);
    const Vector3<double>& e = w.pose[tree.rotor_slot(k)].axis;
    const Vector3<double> turn = w.motion[c].dw + w.delta[c].resultant;
    acceleration[rotor.link.v] =
        rotor.regulated() ? w.spin_up[k] : joint_force[rotor.link.v] / rotor.about - dot(e, turn);
  }
}

/// Sets the poses of the rotors for output, angles included.
inline void set_rotor_poses(const BodyTree& tree, const double* q, BodyWorkspace& w) {
  for (std::size_t k = 0; k < tree.rotors().size(); ++k) {
    const RotorLink& rotor = tree.rotors()[k];
    set_pose(rotor.link, w.pose[carrier(rotor)], q, w.pose[tree.rotor_slot(k)]);
  }
}

/// Sets the poses, positions and velocity motors of the rotors.
inline void set_rotor_places(const BodyTree& tree, const double* q, const double* v,
                             BodyWorkspace& w) {
  set_rotor_poses(tree, q, w);
  for (std::size_t k = 0; k < tree.rotors().size(); ++k) {
    const RotorLink& rotor = tree.rotors()[k];
    const std::size_t slot = tree.rotor_slot(k);
    const std::size_t c = carrier(rotor);
    w.place[slot] = place(rotor.link, w.pose[slot], w.pose[c], w.place[c], v);
  }
}

/// Sets the motions of the rotors from the motions of their carriers. Needs poses of rotors.
inline void set_rotor_motions(const BodyTree& tree, const double* v, const double* dv,
                              BodyWorkspace& w) {
  for (std::size_t k = 0; k < tree.rotors().size(); ++k) {
    const RotorLink& rotor = tree.rotors()[k];
    const std::size_t slot = tree.rotor_slot(k);
    const std::size_t c = carrier(rotor);
    set_motion(rotor.link, w.pose[slot], w.pose[c], w.motion[c], v, dv, w.motion[slot]);
  }
}

/// Adds inertia forces to w.force of the rotors, which holds minus their loads. The sum is the
/// force that each carrier exerts on its rotor.
///
/// The inertia force is that of a rotor at rest on its carrier, and the term of its spin
///
///   C phi'' e + w x C phi' e,
///
/// so no terms of the size phi'^2 cancel. Needs poses of rotors.
inline void complete_rotor_forces(const BodyTree& tree, const double* v, const double* dv,
                                  BodyWorkspace& w) {
  for (std::size_t k = 0; k < tree.rotors().size(); ++k) {
    const RotorLink& rotor = tree.rotors()[k];
    const std::size_t slot = tree.rotor_slot(k);
    const auto& [R, r, e] = w.pose[slot];
    const auto& [turn, dw, a] = w.motion[carrier(rotor)];
    const LinkMotion<> along{turn, dw, a + cross(dw, r) + cross(turn, cross(turn, r))};
    w.force[slot] += inertia_force(rotor.inertia(e, rotor.about), along);
    const double spin = rotor.about * v[rotor.link.v];
    w.force[slot].moment += rotor.about * dv[rotor.link.v] * e + spin * cross(turn, e);
  }
}

}  // namespace kreisel::detail
