#pragma once

#include <Eigen/Core>

#include <utility>
#include <vector>

#include <motor/motor.hpp>

namespace kreisel {

/// Forces that act on a system of bodies from outside, besides those of its description, and lengths
/// of its ropes.
///
/// Frame  : forces on bodies on the body's axes, about its origin
/// Units  : N, N m, m
template <class S>
struct OutsideForces {
  Eigen::Matrix<S, Eigen::Dynamic, 1> joint_force = {};  ///< for each rate; empty: none
  std::vector<std::pair<int, Motor<S>>> on_bodies = {};  ///< of bodies that are no rotors
  /// Elements that are ropes, each once, and the lengths by which winches make them longer.
  std::vector<std::pair<int, S>> winches = {};
};

/// Influences from outside on a system of bodies. Those of the guide are for derivatives: their
/// values are 0, their derivatives are those of the inputs.
///
/// S      : dual numbers
/// Frame  : the guide on its own axes
/// Units  : rad, rad/s, rad/s^2, m/s^2
template <class S>
struct Disturbance {
  OutsideForces<S> forces = {};
  bool moves_guide = false;                    ///< else the parts below do not count
  Vector3<S> guide_turn = Vector3<S>::Zero();  ///< a small rotation of the guide
  Vector3<S> guide_rate = Vector3<S>::Zero();
  Vector3<S> guide_angular_acceleration = Vector3<S>::Zero();
  Vector3<S> guide_acceleration = Vector3<S>::Zero();  ///< of its origin, inertial
};

}  // namespace kreisel
