#pragma once

#include <Eigen/Core>

#include <utility>
#include <vector>

#include <motor/motor.hpp>

namespace kreisel {

/// Small influences from outside on a system of bodies, for derivatives: their values are 0, their
/// derivatives are those of the inputs. Only `joint_force` may have values.
///
/// S      : dual numbers
/// Frame  : forces on bodies on the body's axes, about its origin; the guide on its own axes
/// Units  : N, N m; rad, rad/s, rad/s^2, m/s^2
template <class S>
struct Disturbance {
  Eigen::Matrix<S, Eigen::Dynamic, 1> joint_force = {};  ///< for each rate; empty: none
  std::vector<std::pair<int, Motor<S>>> on_bodies = {};
  bool moves_guide = false;                    ///< else the parts below do not count
  Vector3<S> guide_turn = Vector3<S>::Zero();  ///< a small rotation of the guide
  Vector3<S> guide_rate = Vector3<S>::Zero();
  Vector3<S> guide_angular_acceleration = Vector3<S>::Zero();
  Vector3<S> guide_acceleration = Vector3<S>::Zero();  ///< of its origin, inertial
};

}  // namespace kreisel
