#pragma once

#include <Eigen/Core>

#include <motor/motor.hpp>

namespace kreisel {

/// In which order other libraries keep the halves of a velocity or force: docs/conventions.md has a
/// table of them.
enum class SpatialVectorOrder {
  angular_first,  ///< (omega; v), (moment; force): Featherstone, Drake, MuJoCo's cvel
  linear_first    ///< (v; omega), (force; moment): Pinocchio, KDL, ROS
};

/// Six numbers as other libraries keep them. Axes and point of reference are those of the motor.
template <class S = double>
using SpatialVector = Eigen::Matrix<S, 6, 1>;

namespace detail {

template <class S>
[[nodiscard]] SpatialVector<S> stacked(const Vector3<S>& upper, const Vector3<S>& lower) {
  return SpatialVector<S>(upper[0], upper[1], upper[2], lower[0], lower[1], lower[2]);
}

}  // namespace detail

/// Of a velocity, whose resultant is the angular one.
template <class S>
[[nodiscard]] SpatialVector<S> velocity_numbers(const Motor<S>& V, SpatialVectorOrder order) {
  return order == SpatialVectorOrder::angular_first ? detail::stacked<S>(V.resultant, V.moment)
                                                    : detail::stacked<S>(V.moment, V.resultant);
}

/// Of a force, whose resultant is the force: its halves lie the other way round.
template <class S>
[[nodiscard]] SpatialVector<S> force_numbers(const Motor<S>& F, SpatialVectorOrder order) {
  return order == SpatialVectorOrder::angular_first ? detail::stacked<S>(F.moment, F.resultant)
                                                    : detail::stacked<S>(F.resultant, F.moment);
}

/// The velocity that such numbers are.
template <class S>
[[nodiscard]] Motor<S> velocity_of(const SpatialVector<S>& numbers, SpatialVectorOrder order) {
  const Vector3<S> upper = numbers.template head<3>();
  const Vector3<S> lower = numbers.template tail<3>();
  return order == SpatialVectorOrder::angular_first ? Motor<S>{upper, lower}
                                                    : Motor<S>{lower, upper};
}

/// The force that such numbers are.
template <class S>
[[nodiscard]] Motor<S> force_of(const SpatialVector<S>& numbers, SpatialVectorOrder order) {
  const Vector3<S> upper = numbers.template head<3>();
  const Vector3<S> lower = numbers.template tail<3>();
  return order == SpatialVectorOrder::angular_first ? Motor<S>{lower, upper}
                                                    : Motor<S>{upper, lower};
}

/// A body's velocity against the world, on world axes about the world's origin, of MuJoCo's `cvel`,
/// which is about the centre of mass of the whole kinematic tree (`subtree_com` of its root).
template <class S>
[[nodiscard]] Motor<S> velocity_of_cvel(const SpatialVector<S>& cvel,
                                        const Vector3<S>& subtree_com) {
  return velocity_of(cvel, SpatialVectorOrder::angular_first).reduced_at(-subtree_com);
}

/// The same of Pinocchio's LOCAL_WORLD_ALIGNED, about the frame's origin in the world.
template <class S>
[[nodiscard]] Motor<S> velocity_of_world_aligned(const SpatialVector<S>& motion,
                                                 const Vector3<S>& origin) {
  return velocity_of(motion, SpatialVectorOrder::linear_first).reduced_at(-origin);
}

}  // namespace kreisel
