#pragma once

#include <Eigen/Core>

#include <motor/motor.hpp>

namespace kreisel {

/// The order in which other libraries store the halves of a velocity or force. docs/conventions.md
/// has a table of them.
enum class SpatialVectorOrder {
  angular_first,  ///< (omega; v), (moment; force): Featherstone, Drake, MuJoCo's cvel
  linear_first    ///< (v; omega), (force; moment): Pinocchio, KDL, ROS
};

/// A velocity or force as six numbers, as other libraries store it. Axes and point of reference are
/// those of the motor.
template <class S = double>
using SpatialVector = Eigen::Matrix<S, 6, 1>;

namespace detail {

template <class S>
[[nodiscard]] SpatialVector<S> stacked(const Vector3<S>& upper, const Vector3<S>& lower) {
  return SpatialVector<S>(upper[0], upper[1], upper[2], lower[0], lower[1], lower[2]);
}

}  // namespace detail

/// The six numbers of a velocity (twist). Its resultant is the angular velocity.
template <class S>
[[nodiscard]] SpatialVector<S> velocity_numbers(const Motor<S>& V, SpatialVectorOrder order) {
  return order == SpatialVectorOrder::angular_first ? detail::stacked<S>(V.resultant, V.moment)
                                                    : detail::stacked<S>(V.moment, V.resultant);
}

/// The six numbers of a force (wrench). Its resultant is the force, so its halves have the opposite
/// order.
template <class S>
[[nodiscard]] SpatialVector<S> force_numbers(const Motor<S>& F, SpatialVectorOrder order) {
  return order == SpatialVectorOrder::angular_first ? detail::stacked<S>(F.moment, F.resultant)
                                                    : detail::stacked<S>(F.resultant, F.moment);
}

/// The velocity motor of six numbers.
template <class S>
[[nodiscard]] Motor<S> velocity_of(const SpatialVector<S>& numbers, SpatialVectorOrder order) {
  const Vector3<S> upper = numbers.template head<3>();
  const Vector3<S> lower = numbers.template tail<3>();
  return order == SpatialVectorOrder::angular_first ? Motor<S>{upper, lower}
                                                    : Motor<S>{lower, upper};
}

/// The force motor of six numbers.
template <class S>
[[nodiscard]] Motor<S> force_of(const SpatialVector<S>& numbers, SpatialVectorOrder order) {
  const Vector3<S> upper = numbers.template head<3>();
  const Vector3<S> lower = numbers.template tail<3>();
  return order == SpatialVectorOrder::angular_first ? Motor<S>{lower, upper}
                                                    : Motor<S>{upper, lower};
}

/// The velocity of a body against the world, on world axes about the world's origin, from MuJoCo's
/// `cvel`. `cvel` refers to the centre of mass of the whole kinematic tree (`subtree_com` of its
/// root).
template <class S>
[[nodiscard]] Motor<S> velocity_of_cvel(const SpatialVector<S>& cvel,
                                        const Vector3<S>& subtree_com) {
  return velocity_of(cvel, SpatialVectorOrder::angular_first).reduced_at(-subtree_com);
}

/// The velocity of a body from Pinocchio's LOCAL_WORLD_ALIGNED motion, which refers to the frame's
/// origin in the world.
template <class S>
[[nodiscard]] Motor<S> velocity_of_world_aligned(const SpatialVector<S>& motion,
                                                 const Vector3<S>& origin) {
  return velocity_of(motion, SpatialVectorOrder::linear_first).reduced_at(-origin);
}

}  // namespace kreisel
