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

/// The closed form of a top, where it has one: free of torque, Lagrange's, or a
/// gyrostat whose rotor lies on a principal axis.
///
/// Error  : the estimate is the rounding of two quaternions, the answer and what it is compared with,
///          2^-63 of each radian turned through, and 2^-60 of those that Lagrange's top takes off
///                               (tests/dynamics/solve/solve, tests/dynamics/exact/lagrange_top)
KREISEL_API [[nodiscard]] std::optional<ClosedForm<EulerTop::State>> closed_form(
    const EulerTop& top, double begin, const EulerTop::State& start);

namespace detail {

/// Of a tree on a guide at rest under a uniform gravity, on guide axes; y = (coordinates; rates).
KREISEL_API [[nodiscard]] std::optional<ClosedForm<Eigen::VectorXd>> closed_form(
    const BodyTree& tree, const Vector3<double>& gravity, double begin, const Eigen::VectorXd& y);

}  // namespace detail

/// The closed form of a system that is no more than a pendulum or a top: one body on a guide at rest,
/// in a revolute joint, held at a point, or free with the centre of mass at its origin, on which nothing
/// acts but a uniform gravity. Of what turns about a point the body's axes have to be principal axes,
/// and under weight its start has to be exact on axes with the vertical along z.
///
/// Error  : as of PhysicalPendulum and of a top; besides 2^-52 of each radian, but for the spin of a
///          heavy top, for the last digits of the description, and 2^-51 of an attitude
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
