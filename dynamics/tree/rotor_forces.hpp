#pragma once

#include <algorithm>
#include <cstddef>

#include <dynamics/tree/rotors.hpp>

/// Rotors on their carriers where accelerations are sought, and where reactions are read out.

namespace kreisel::detail {

/// The accelerations that regulated rotors are asked for.
inline void ask_spin_up(const BodyTree& tree, double t, BodyWorkspace& w) {
  for (std::size_t k = 0; k < tree.rotors().size(); ++k) {
    const auto& asked = tree.body(tree.rotors()[k].link.body).rotor->acceleration;
    w.spin_up[k] = asked ? asked(t) : 0;
  }
}

inline void ask_no_spin_up(BodyWorkspace& w) { std::fill(w.spin_up.begin(), w.spin_up.end(), 0.0); }

/// Adds what the rotors ask of their carriers to the forces of motion in w. Their motors' torques
/// are the joint forces, or those that spin_up takes.
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

/// The rotors' own accelerations, once their carriers' are known: those at dv = 0 and the
/// differences from them.
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

/// Poses of the rotors, for what is read out: here the angles count.
inline void set_rotor_poses(const BodyTree& tree, const double* q, BodyWorkspace& w) {
  for (std::size_t k = 0; k < tree.rotors().size(); ++k) {
    const RotorLink& rotor = tree.rotors()[k];
    set_pose(rotor.link, w.pose[carrier(rotor)], q, w.pose[tree.rotor_slot(k)]);
  }
}

/// Poses of the rotors, and what of their places follows from them.
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

/// Motions of the rotors from those of their carriers. Needs poses of rotors.
inline void set_rotor_motions(const BodyTree& tree, const double* v, const double* dv,
                              BodyWorkspace& w) {
  for (std::size_t k = 0; k < tree.rotors().size(); ++k) {
    const RotorLink& rotor = tree.rotors()[k];
    const std::size_t slot = tree.rotor_slot(k);
    const std::size_t c = carrier(rotor);
    set_motion(rotor.link, w.pose[slot], w.pose[c], w.motion[c], v, dv, w.motion[slot]);
  }
}

/// Makes the forces that stand at the rotors, their loads taken off, into what their carriers exert
/// on them: of the whole rotor as if at rest on its carrier, and of its spin
///
///   C phi'' e + w x C phi' e,
///
/// in which nothing of the size phi'^2 comes and goes. Needs poses of rotors.
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
