#pragma once

#include <cstddef>

#include <dynamics/tree/elimination.hpp>
#include <dynamics/tree/rotor_forces.hpp>

/// The passes that solve for the joints' accelerations.

namespace kreisel::detail {

inline void clear_articulated(const BodyTree& tree, BodyWorkspace& w) {
  for (std::size_t i = 0; i < tree.links().size(); ++i) {
    w.articulated[i] = {};
    w.size[i] = {};
  }
}

/// Eliminates all joints. The result depends on the coordinates alone.
inline void eliminate_all(const BodyTree& tree, BodyWorkspace& w) {
  clear_articulated(tree, w);
  for (std::size_t i = tree.links().size() - 1; i > 0; --i) {
    add(w.articulated[i], w.inertia[i]);
    eliminate(tree, i, w);
  }
}

/// Sets the joints' accelerations. Needs all joints eliminated and all forces reduced.
inline void accelerate_all(const BodyTree& tree, const double* joint_force, double* acceleration,
                           BodyWorkspace& w) {
  for (std::size_t i = 1; i < tree.links().size(); ++i) {
    accelerate(tree.links()[i], i, acceleration, w);
  }
  accelerate_rotors(tree, joint_force, acceleration, w);
}

/// Solves for the joints' accelerations, with the forces at dv = 0 in w.force. Needs all joints
/// eliminated.
inline void solve(const BodyTree& tree, const double* joint_force, double* acceleration,
                  BodyWorkspace& w) {
  for (std::size_t i = tree.links().size() - 1; i > 0; --i) {
    reduce(tree.links()[i], i, joint_force, w);
  }
  accelerate_all(tree, joint_force, acceleration, w);
}

/// Eliminates all joints and solves, in one inward and one outward pass.
inline void eliminate_and_solve(const BodyTree& tree, const double* joint_force,
                                double* acceleration, BodyWorkspace& w) {
  clear_articulated(tree, w);
  for (std::size_t i = tree.links().size() - 1; i > 0; --i) {
    add(w.articulated[i], w.inertia[i]);
    eliminate(tree, i, w);
    reduce(tree.links()[i], i, joint_force, w);
  }
  accelerate_all(tree, joint_force, acceleration, w);
}

}  // namespace kreisel::detail
