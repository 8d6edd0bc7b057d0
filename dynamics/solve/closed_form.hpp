#pragma once

#include <Eigen/Core>

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

}  // namespace detail

/// The closed form of a system that is only a pendulum or a top: one body on a guide at rest, under
/// uniform gravity alone. The body is in a revolute joint, held at a point, or free with its centre
/// of mass at its origin. The axes of a body that rotates about a point must be principal axes.
/// Under weight its start must be exact on axes with the vertical along z.
///
/// Error  : the error of PhysicalPendulum or of the top; for the last digits of the description
///          2^-52 of each radian more, without the spin of a heavy top; and 2^-51 of an attitude
template <class M>
requires detail::is_resting<M>
[[nodiscard]] std::optional<ClosedForm<typename BodySystem<M>::State>> closed_form(
    const BodySystem<M>& system, double begin, const typename BodySystem<M>::State& start) {
  using State = typename BodySystem<M>::State;
  const auto motion =
      detail::closed_form(system.tree(), system.gravity_at(begin), begin, system.to_vector(start));
  if (!motion) return std::nullopt;
  const Eigen::Index coordinates = start.coordinates.size();
  return ClosedForm<State>{motion->name,
                           [at = motion->at, coordinates](double t) {
                             const Eigen::VectorXd y = at(t);
                             return State{y.head(coordinates), y.tail(y.size() - coordinates)};
                           },
                           motion->error};
}

}  // namespace kreisel
