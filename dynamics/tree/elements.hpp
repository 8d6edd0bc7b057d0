#pragma once

#include <array>
#include <cstddef>
#include <type_traits>
#include <variant>
#include <vector>

#include <dynamics/model/corner.hpp>
#include <dynamics/tree/loads.hpp>

/// The elements of a tree: forces between bodies and between joints.

namespace kreisel::detail {

/// The motion at the ends of an element. Needs poses and positions in w.
template <class S>
[[nodiscard]] ElementMotion<S> motion_between(const std::array<ElementEnd, 2>& ends,
                                              const std::array<std::size_t, 2>& slot,
                                              const std::type_identity_t<S>& t,
                                              const MotionSpace<S>& w) {
  const LinkPlace<S>& first = w.place[slot[0]];
  const LinkPlace<S>& second = w.place[slot[1]];
  const Matrix3<S>& R = w.pose[slot[0]].R;
  const Vector3<S> arm = multiply(w.pose[slot[1]].R, ends[1].at);
  const Vector3<S> lever = second.x + arm - first.x;
  const Vector3<S> reach = lever - multiply(R, ends[0].at);
  const Vector3<S> v = second.V.reduced_at(arm).moment - first.V.reduced_at(lever).moment;
  ElementMotion<S> m;
  m.t = t;
  m.reach = transposed_product(R, reach);
  m.velocity = transposed_product(R, v);
  for (int k = 0; k < 3; ++k) {
    const Vector3<S> image = transposed_product(R, column(w.pose[slot[1]].R, k));
    for (int i = 0; i < 3; ++i) m.turn(i, k) = image[i];
  }
  m.turning = transposed_product(R, Vector3<S>(second.V.resultant - first.V.resultant));
  return m;
}

/// Adds a force of an element to the forces on its bodies, which w has with the opposite sign. The
/// force is about the second end, on the first body's axes.
template <class S>
void add_element_force(const Motor<S>& force, const Vector3<double>& at,
                       const std::array<std::size_t, 2>& slot, MotionSpace<S>& w) {
  const Matrix3<S>& R = w.pose[slot[0]].R;
  const Motor<S> P{R * force.resultant, R * force.moment};
  const Vector3<S> arm = multiply(w.pose[slot[1]].R, at);
  const Vector3<S> lever = w.place[slot[1]].x + arm - w.place[slot[0]].x;
  w.force[slot[1]] -= carried(arm, P);
  w.force[slot[0]] += carried(lever, P);
}

/// The displacement q_a - ratio q_b of a coupling, or its rate for rates.
template <class S>
[[nodiscard]] S difference(const CouplingElement& coupling, const std::array<int, 2>& at,
                           const std::array<bool, 2>& counts, const S* numbers) {
  const S first = counts[0] ? numbers[at[0]] : S(0);
  const S second = counts[1] ? numbers[at[1]] : S(0);
  return first - coupling.ratio * second;
}

/// The joint force Q_a of a coupling.
template <class S>
[[nodiscard]] S coupling_force(const CouplingElement& coupling, const ElementPlace& place,
                               const S* q, const S* v) {
  return coupling.force(difference(coupling, place.q, {true, true}, q),
                        difference(coupling, place.v, place.moves, v));
}

/// Subtracts the elements between points from the forces in w, which the joints transmit.
template <class S>
void take_off_elements(const BodyTree& tree, const std::type_identity_t<S>& t, const S* v,
                       MotionSpace<S>& w) {
  if (tree.elements().empty()) return;
  set_places(tree, v, w);
  for (std::size_t k = 0; k < tree.elements().size(); ++k) {
    const std::array<std::size_t, 2>& slot = tree.element_places()[k].slot;
    std::visit(
        [&](const auto& kind) {
          if constexpr (!joins_joints<std::decay_t<decltype(kind)>>) {
            const Motor<S> force = kind.force(motion_between(kind.ends, slot, t, w));
            add_element_force(force, kind.ends[1].at, slot, w);
          }
        },
        tree.elements()[k]);
  }
}

/// Adds the elements between joints to the joint forces.
template <class S>
void add_couplings(const BodyTree& tree, const S* q, const S* v,
                   Eigen::Matrix<S, Eigen::Dynamic, 1>& joint_force) {
  for (std::size_t k = 0; k < tree.elements().size(); ++k) {
    const auto* const coupling = std::get_if<CouplingElement>(&tree.elements()[k]);
    if (coupling == nullptr) continue;
    const ElementPlace& place = tree.element_places()[k];
    const S force = coupling_force(*coupling, place, q, v);
    joint_force[place.v[0]] += force;
    joint_force[place.v[1]] -= coupling->ratio * force;
  }
}

/// Applies all elements: take_off_elements() and add_couplings().
template <class S>
void apply_elements(const BodyTree& tree, const std::type_identity_t<S>& t, const S* q, const S* v,
                    MotionSpace<S>& w) {
  if (tree.elements().empty()) return;
  take_off_elements(tree, t, v, w);
  add_couplings(tree, q, v, w.joint_force);
}

/// The force that a rope gains if a winch makes it longer by `paid_out`.
template <class S>
[[nodiscard]] Motor<S> winch_force(const RopeElement& rope, const ElementMotion<S>& m,
                                   const S& paid_out) {
  const S length = rope.length(m.t) + paid_out;
  return rope.force(m, length, rope.length.derivative(m.t, 1)) - rope.force(m);
}

/// Subtracts forces from outside from the forces in w, which the joints transmit.
template <class S>
void take_off_outside(const BodyTree& tree, const OutsideForces<S>& outside, const S& t, const S* v,
                      MotionSpace<S>& w) {
  for (const auto& [body, P] : outside.on_bodies) {
    const std::size_t link = tree.link(body);
    w.force[link] -= Motor<S>{w.pose[link].R * P.resultant, w.pose[link].R * P.moment};
  }
  if (!outside.winches.empty()) set_places(tree, v, w);
  for (const auto& [k, paid_out] : outside.winches) {
    const auto index = static_cast<std::size_t>(k);
    const auto& rope = std::get<RopeElement>(tree.elements()[index]);
    const std::array<std::size_t, 2>& slot = tree.element_places()[index].slot;
    const auto m = motion_between(rope.ends, slot, t, w);
    add_element_force(winch_force(rope, m, paid_out), rope.ends[1].at, slot, w);
  }
}

/// The potential energy of all elements. Needs poses and positions in w.
[[nodiscard]] KREISEL_API double element_energy(const BodyTree& tree, double t, const double* q,
                                                const MotionSpace<>& w);

/// True if there are ropes, or springs with tables that have corners.
[[nodiscard]] KREISEL_API bool has_corners(const BodyTree& tree);

/// The greatest frequency with which the length of a rope oscillates.
[[nodiscard]] KREISEL_API double corner_frequency(const BodyTree& tree);

/// L^2 - l^2 of all ropes, and for all points of the tables of springs. L is the distance of the ends,
/// and l the length at which the force has a corner, with winches of `outside`, which may be null.
/// Squares are nearly polynomials of time, also where the ends pass each other. Needs poses and
/// positions in w.
[[nodiscard]] std::vector<Corner> element_corners(const BodyTree& tree, double t,
                                                  const OutsideForces<double>* outside,
                                                  const MotionSpace<>& w);

[[nodiscard]] bool has_damped_ropes(const BodyTree& tree);

/// Appends for all damped ropes L times the pull, k (L - l) + c (L' - l'), also where it is below 0 and
/// the rope does not act.
///
/// dy : the derivative of y = (coordinates; rates)
void append_ends_of_pull(const BodyTree& tree, double t, const OutsideForces<double>* outside,
                         const Eigen::VectorXd& y, const Eigen::VectorXd& dy,
                         std::vector<Corner>& result);

/// The point of an element's second body about which its torque is reported.
[[nodiscard]] Vector3<double> second_point(const Element& element);

/// The forces of all elements on their second bodies, with winches of `outside`, which may be null.
/// Needs poses and positions in w.
void element_forces(const BodyTree& tree, double t, const double* q, const double* v,
                    const OutsideForces<double>* outside, const MotionSpace<>& w,
                    std::vector<Motor<>>& result);

}  // namespace kreisel::detail
