#pragma once

#include <cstddef>

#include <dynamics/tree/workspace.hpp>

/// Rotors on their carriers. The rotor's inertia is included in its carrier's link. An evaluation
/// adds, for each rotor,
///
///   on the carrier   -w x l e  and the motor's reaction -N e,
///   of the rotor     phi'' = N/C - e.dw,
///
/// with N from the motor, or N = C phi'' for a prescribed phi''. The angles are not used.
///
/// Source : paper 000 (14): G_R u = sum_i J^t (w x l_i e_i), l = L if regulated, p else

namespace kreisel::detail {

[[nodiscard]] inline bool is_rotor(const BodyTree& tree, std::size_t slot) {
  return slot >= tree.links().size();
}

[[nodiscard]] inline const RotorLink& rotor(const BodyTree& tree, std::size_t slot) {
  return tree.rotors()[slot - tree.links().size()];
}

[[nodiscard]] inline std::size_t carrier(const RotorLink& rotor) {
  return static_cast<std::size_t>(rotor.link.parent);
}

/// The weight l: C phi' of a regulated rotor, the cyclic momentum C (phi' + e.w) of another.
template <class S>
[[nodiscard]] S momentum_weight(const RotorLink& rotor, const S& rate, const S& turn) {
  if (rotor.regulated()) return rotor.about * rate;
  return rotor.about * (rate + turn);
}

/// Sets the rotors' axes on guide axes, and their forces to 0.
template <class S>
void begin_rotors(const BodyTree& tree, MotionSpace<S>& w) {
  for (std::size_t k = 0; k < tree.rotors().size(); ++k) {
    const RotorLink& rotor = tree.rotors()[k];
    const std::size_t slot = tree.rotor_slot(k);
    w.pose[slot].axis = multiply(w.pose[carrier(rotor)].R, rotor.link.axis);
    w.force[slot] = {};
  }
}

/// The torque about the axis for a rotor's relative acceleration ddphi. Needs its carrier's motion.
template <class S>
[[nodiscard]] S spin_torque(const RotorLink& rotor, const Vector3<S>& e, const S& ddphi,
                            const MotionSpace<S>& w) {
  return rotor.about * (ddphi + dot(e, w.motion[carrier(rotor)].dw));
}

/// Adds the rotors' gyroscopic torques and motor reactions to the inertia forces in w, for given
/// accelerations dv. The motor torques follow from dv.
template <class S>
void add_rotor_forces_at(const BodyTree& tree, const S* v, const S* dv, MotionSpace<S>& w) {
  for (std::size_t k = 0; k < tree.rotors().size(); ++k) {
    const RotorLink& rotor = tree.rotors()[k];
    const std::size_t c = carrier(rotor);
    const Vector3<S>& e = w.pose[tree.rotor_slot(k)].axis;
    const Vector3<S>& turn = w.motion[c].w;
    const S l = momentum_weight(rotor, v[rotor.link.v], dot(e, turn));
    const S& ddphi = dv[rotor.link.v];
    const S N = rotor.regulated() ? S(rotor.about * ddphi) : spin_torque(rotor, e, ddphi, w);
    w.force[c].moment += l * cross(turn, e) + N * e;
  }
}

/// Sets the rotors' components of the joint forces.
template <class S>
void project_rotors(const BodyTree& tree, const S* dv, const MotionSpace<S>& w, S* result) {
  for (std::size_t k = 0; k < tree.rotors().size(); ++k) {
    const RotorLink& rotor = tree.rotors()[k];
    const Vector3<S>& e = w.pose[tree.rotor_slot(k)].axis;
    result[rotor.link.v] = spin_torque(rotor, e, dv[rotor.link.v], w);
  }
}

/// Sets pose and position of a rotor as if its angle were 0, for loads that ignore the angle.
template <class S>
void set_place_without_angle(const BodyTree& tree, std::size_t slot, const S* v,
                             MotionSpace<S>& w) {
  const Link& link = rotor(tree, slot).link;
  const auto c = static_cast<std::size_t>(link.parent);
  LinkPose<S>& pose = w.pose[slot];
  Matrix3<S> turned;
  for (int k = 0; k < 9; ++k) turned(k) = link.still(k) + link.cosine(k);
  multiply(w.pose[c].R, turned, pose.R);
  pose.r = multiply(w.pose[c].R, link.position);
  w.place[slot] = place(link, pose, w.pose[c], w.place[c], v);
}

}  // namespace kreisel::detail
