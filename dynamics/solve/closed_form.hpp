#pragma once

#include <Eigen/Core>

#include <functional>
#include <optional>

#include <dynamics/guide/resting.hpp>
#include <dynamics/model/closed_form.hpp>
#include <dynamics/rigid/euler_top.hpp>
#include <motor/api.hpp>

namespace kreisel {

class BodyTree;
template <class M>
class BodySystem;

/// The closed form of a top, if it has one: free of torque, Lagrange's, or a gyrostat whose rotor
/// lies on a principal axis.
///
/// Error  : the estimate is the rounding of two quaternions (result and reference), 2^-63 of the
///          angle of rotation, and 2^-60 of LagrangeTop::starting_angle()
///          (tests/dynamics/solve/solve, tests/dynamics/exact/lagrange_top)
KREISEL_API [[nodiscard]] std::optional<ClosedForm<EulerTop::State>> closed_form(
    const EulerTop& top, double begin, const EulerTop::State& start);

namespace detail {

/// The closed form of a tree on a guide at rest under uniform gravity, on guide axes, with y =
/// (coordinates; rates).
KREISEL_API [[nodiscard]] std::optional<ClosedForm<Eigen::VectorXd>> closed_form(
    const BodyTree& tree, const Vector3<double>& gravity, double begin, const Eigen::VectorXd& y);

/// The attitude of a guide, and its angular velocity on its own axes.
struct GuideAttitude {
  Matrix3<double> rotation;  ///< turns guide components into inertial ones
  Vector3<double> u;
};

/// The closed form of a tree on a guide that turns, under any uniform gravity.
KREISEL_API [[nodiscard]] std::optional<ClosedForm<Eigen::VectorXd>> closed_form_on_guide(
    const BodyTree& tree, const std::function<GuideAttitude(double)>& guide, double begin,
    const Eigen::VectorXd& y);

/// A closed form on y = (coordinates; rates) as one on states.
template <class State>
[[nodiscard]] std::optional<ClosedForm<State>> by_states(
    const std::optional<ClosedForm<Eigen::VectorXd>>& motion, Eigen::Index coordinates) {
  if (!motion) return std::nullopt;
  return ClosedForm<State>{motion->name,
                           [at = motion->at, coordinates](double t) {
                             const Eigen::VectorXd y = at(t);
                             return State{y.head(coordinates), y.tail(y.size() - coordinates)};
                           },
                           motion->error};
}

}  // namespace detail

/// The closed form of a system that is only a pendulum, a top or a free Cardan gyro. The guide
/// rests, and uniform gravity alone acts. The single body is in a revolute joint, held at a point,
/// or free with its centre of mass at its origin. The axes of a body that rotates about a point
/// must be principal axes. Under weight its start must be exact on axes with the vertical along z.
/// A Cardan gyro is described at exact::FreeCardanGyro.
///
/// Error  : the error of PhysicalPendulum or of the top; for the last digits of the description
///          2^-52 of each radian more, without the spin of a heavy top; and 2^-51 of an attitude
template <class M>
requires detail::is_resting<M>
[[nodiscard]] std::optional<ClosedForm<typename BodySystem<M>::State>> closed_form(
    const BodySystem<M>& system, double begin, const typename BodySystem<M>::State& start) {
  return detail::by_states<typename BodySystem<M>::State>(
      detail::closed_form(system.tree(), system.gravity_at(begin), begin, system.to_vector(start)),
      start.coordinates.size());
}

/// The closed form of a body in a spherical joint at its centre of mass, on any guide. No torque
/// acts, so the body turns as a free top in the inertial frame. Its attitude is written on the
/// guide's axes. The sign of the quaternion is that nearer to the start's.
///
/// Error  : of the free top; 80u and 2^-52 of each radian of the guide's rotation; and the effect
///          of the rounding of the absolute angular velocity at the start, from tops that start
///          beside it (tests/dynamics/solve/closed_forms)
template <class M>
requires(!detail::is_resting<M>)
    [[nodiscard]] std::optional<ClosedForm<typename BodySystem<M>::State>> closed_form(
        const BodySystem<M>& system, double begin, const typename BodySystem<M>::State& start) {
  const auto guide = [motion = system.guide()](double t) {
    const auto now = motion(t);
    return detail::GuideAttitude{now.X.value.rotation, now.V.value.resultant};
  };
  return detail::by_states<typename BodySystem<M>::State>(
      detail::closed_form_on_guide(system.tree(), guide, begin, system.to_vector(start)),
      start.coordinates.size());
}

}  // namespace kreisel
