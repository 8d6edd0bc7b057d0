#pragma once

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include <dynamics/tree/workspace.hpp>

/// The articulated-body algorithm. Solves  M dv = joint forces - forces at dv = 0  in linear time.
///
/// An inward pass eliminates each joint and adds the articulated inertia outward of it to its
/// parent. An outward pass then computes the joint accelerations.
///
/// Source : R. Featherstone, Rigid Body Dynamics Algorithms, chapter 7; here on guide axes, and
///          with differences of accelerations, which are motors (LinkMotion)

namespace kreisel::detail {

[[noreturn]] inline void refuse_singular(const BodyTree& tree, const Link& link, const char* motion,
                                         const Vector3<double>& axis) {
  char direction[64];
  const double none = 0;  // makes 0 of -0
  std::snprintf(direction, sizeof direction, " (%.6g, %.6g, %.6g)", axis.x() + none,
                axis.y() + none, axis.z() + none);
  throw ComputationFailed("body '" + tree.body(link.body).name + "': " + motion + direction +
                          " on guide axes moves no inertia, so no force determines it: a body "
                          "without mass at the end of "
                          "a chain, or an axis that coincides with one further out");
}

/// The part of an inertia that may be the rounding error of larger ones of this size.
[[nodiscard]] inline double rounding(double size) {
  return 16 * std::numeric_limits<double>::epsilon() * size;
}

inline void factor(const BodyTree& tree, const Link& link, FactoredSymmetric3<>& result,
                   const Symmetric3<>& m, double size, const char* motion) {
  result = FactoredSymmetric3<>(m);
  for (int k = 0; k < 3; ++k) {
    if (!(result.pivots()[k] <= rounding(size))) continue;
    const Vector3<double> weakest = result.witness(k);
    refuse_singular(tree, link, motion, weakest / std::sqrt(dot(weakest, weakest)));
  }
}

/// B^t m^-1 B, with m factored and B given by its columns.
[[nodiscard]] inline Symmetric3<> congruent(const FactoredSymmetric3<>& m, const Vector3<double>& x,
                                            const Vector3<double>& y, const Vector3<double>& z) {
  const Vector3<double> by_y = m.solve(y);
  const Vector3<double> by_z = m.solve(z);
  return {dot(x, m.solve(x)), dot(y, by_y), dot(z, by_z), dot(x, by_y), dot(x, by_z), dot(y, by_z)};
}

/// Eliminates a screw joint, whose motion subspace is  S = (s; pitch s).
[[gnu::noinline]] inline void eliminate_screw(const BodyTree& tree, const Link& link,
                                              const Vector3<double>& s, const Size& size,
                                              ArticulatedInertia& A, SingleElimination& e) {
  const Vector3<double> slide = link.pitch * s;
  e.U.resultant = A.linear * slide + transposed_product(A.mixed, s);
  e.U.moment = multiply(A.mixed, slide) + A.angular * s;
  const double resistance = dot(s, e.U.moment) + dot(slide, e.U.resultant);
  if (resistance <= rounding(size.angular + link.pitch * link.pitch * size.linear)) {
    refuse_singular(tree, link, "the screw motion about", s);
  }
  e.inverse = 1 / resistance;
  take_square(A, e.U, e.inverse);
}

/// Eliminates a joint with one coordinate from the inertia A of its link.
inline void eliminate_single(const BodyTree& tree, const Link& link, const Vector3<double>& s,
                             const Size& size, ArticulatedInertia& A, SingleElimination& e) {
  if (link.kind == LinkKind::screw) {
    eliminate_screw(tree, link, s, size, A, e);
    return;
  }
  const bool turns = link.kind == LinkKind::revolute;
  if (turns) {
    e.U.resultant = {A.mixed(0, 0) * s[0] + A.mixed(1, 0) * s[1] + A.mixed(2, 0) * s[2],
                     A.mixed(0, 1) * s[0] + A.mixed(1, 1) * s[1] + A.mixed(2, 1) * s[2],
                     A.mixed(0, 2) * s[0] + A.mixed(1, 2) * s[1] + A.mixed(2, 2) * s[2]};
    e.U.moment = A.angular * s;
  } else {
    e.U.resultant = A.linear * s;
    e.U.moment = multiply(A.mixed, s);
  }
  const double resistance = dot(s, turns ? e.U.moment : e.U.resultant);
  if (resistance <= rounding(turns ? size.angular : size.linear)) {
    refuse_singular(tree, link, turns ? "the rotation about" : "the displacement along", s);
  }
  e.inverse = 1 / resistance;
  take_square(A, e.U, e.inverse);
}

/// Eliminates a spherical or free joint from the inertia A of its link.
[[gnu::noinline]] inline void eliminate_ball(const BodyTree& tree, const Link& link,
                                             const Size& size, ArticulatedInertia& A,
                                             BallElimination& e) {
  e.mixed = A.mixed;
  if (link.kind == LinkKind::spherical) {
    factor(tree, link, e.angular, A.angular, size.angular, "the rotation about");
    const Symmetric3<> taken =
        congruent(e.angular, column(e.mixed, 0), column(e.mixed, 1), column(e.mixed, 2));
    A = {A.linear - taken, Matrix3<double>::Zero(), {}};
    return;
  }
  factor(tree, link, e.linear, A.linear, size.linear, "the displacement along");
  const Symmetric3<> taken = congruent(e.linear, row(e.mixed, 0), row(e.mixed, 1), row(e.mixed, 2));
  factor(tree, link, e.angular, A.angular - taken, size.angular, "the rotation about");
  A = {};  // the parent carries no inertia of a free link
}

/// Eliminates the joint of link i from its inertia and adds the rest to the parent.
///
/// A NaN does not throw: it reaches the stepper, which then rejects a step that is too long.
///
/// Throws : ComputationFailed, naming body and direction, if a motion of the joint moves no inertia
inline void eliminate(const BodyTree& tree, std::size_t i, BodyWorkspace& w) {
  const Link& link = tree.links()[i];
  const LinkPose<>& pose = w.pose[i];
  ArticulatedInertia& A = w.articulated[i];
  Size size = w.size[i];
  if (link.moved_by_forces()) {
    size.linear = std::max(size.linear, trace(A.linear));
    size.angular = std::max(size.angular, trace(A.angular));
    if (link.has_one_rate()) {
      eliminate_single(tree, link, pose.axis, size, A, w.single[i]);
    } else {
      eliminate_ball(tree, link, size, A, w.ball[static_cast<std::size_t>(link.factor)]);
      if (link.kind == LinkKind::free) return;
    }
  }
  if (link.parent == 0) return;
  const auto parent = static_cast<std::size_t>(link.parent);
  add_shifted(w.articulated[parent], pose.r, A);
  Size& above = w.size[parent];
  above.linear += size.linear;
  above.angular += size.angular + 2 * dot(pose.r, pose.r) * size.linear;
}

/// The part of the force P that a spherical or free joint transmits.
[[gnu::noinline]] inline Motor<> reduce_ball(const Link& link, const LinkPose<>& pose,
                                             const LinkPose<>& parent, const double* joint_force,
                                             const Motor<>& P, BallElimination& e) {
  const Vector3<double> torque = pose.R * three(joint_force + link.v);
  if (link.kind == LinkKind::spherical) {
    e.x.resultant = e.angular.solve(torque - P.moment);
    return {P.resultant + transposed_product(e.mixed, e.x.resultant), torque};
  }
  Motor<> given{parent.R * three(joint_force + link.v + 3), torque};
  const Motor<> rest = given - P;
  e.x.resultant = e.angular.solve(rest.moment - e.mixed * e.linear.solve(rest.resultant));
  e.x.moment = e.linear.solve(rest.resultant - transposed_product(e.mixed, e.x.resultant));
  return given;
}

/// Adds the force that the joint of link i transmits to the parent's force.
inline void reduce(const Link& link, std::size_t i, const double* joint_force, BodyWorkspace& w) {
  const auto parent = static_cast<std::size_t>(link.parent);
  const LinkPose<>& pose = w.pose[i];
  Vector3<double> f = w.force[i].resultant;
  Vector3<double> n = w.force[i].moment;
  if (link.moved_by_forces()) {
    if (link.has_one_rate()) {
      SingleElimination& e = w.single[i];
      e.rest = joint_force[link.v] - dot(pose.axis, link.kind == LinkKind::prismatic ? f : n);
      if (link.kind == LinkKind::screw) e.rest -= link.pitch * dot(pose.axis, f);
      const double q = e.rest * e.inverse;
      f += q * e.U.resultant;
      n += q * e.U.moment;
    } else {
      const Motor<> rest = reduce_ball(link, pose, w.pose[parent], joint_force, w.force[i],
                                       w.ball[static_cast<std::size_t>(link.factor)]);
      f = rest.resultant;
      n = rest.moment;
    }
  }
  w.force[parent].resultant += f;
  w.force[parent].moment += n + cross(pose.r, f);
}

/// Sets the acceleration of a spherical or free joint.
[[gnu::noinline]] inline void accelerate_ball(const Link& link, const LinkPose<>& pose,
                                              const LinkPose<>& parent, const BallElimination& e,
                                              Motor<>& delta, double* acceleration) {
  const Motor<> given = delta;
  delta.resultant = e.x.resultant;
  if (link.kind == LinkKind::spherical) {
    delta.resultant -= e.angular.solve(e.mixed * given.moment);
  } else {
    delta.moment = e.x.moment;
    const Vector3<double> slide = transposed_product(parent.R, delta.moment - given.moment);
    std::copy_n(slide.data(), 3, acceleration + link.v + 3);
  }
  const Vector3<double> turn = transposed_product(pose.R, delta.resultant - given.resultant);
  std::copy_n(turn.data(), 3, acceleration + link.v);
}

/// Sets the acceleration of the joint of link i. Needs the parent's acceleration in w.delta.
inline void accelerate(const Link& link, std::size_t i, double* acceleration, BodyWorkspace& w) {
  const auto parent = static_cast<std::size_t>(link.parent);
  const LinkPose<>& pose = w.pose[i];
  Motor<>& delta = w.delta[i];
  delta.resultant = w.delta[parent].resultant;
  delta.moment = w.delta[parent].moment + cross(delta.resultant, pose.r);
  if (!link.moved_by_forces()) {
    for (int k = 0; k < rate_count(link.kind); ++k) acceleration[link.v + k] = 0;
    return;
  }
  if (link.has_one_rate()) {
    const SingleElimination& e = w.single[i];
    const double q = (e.rest - reciprocal(e.U, delta)) * e.inverse;
    acceleration[link.v] = q;
    (link.kind == LinkKind::prismatic ? delta.moment : delta.resultant) += q * pose.axis;
    if (link.kind == LinkKind::screw) delta.moment += link.pitch * q * pose.axis;
    return;
  }
  accelerate_ball(link, pose, w.pose[parent], w.ball[static_cast<std::size_t>(link.factor)], delta,
                  acceleration);
}

}  // namespace kreisel::detail
