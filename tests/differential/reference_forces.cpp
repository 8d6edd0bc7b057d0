#include "reference_numbers.hpp"
#include "reference_tree.hpp"

/// Forces on bodies and in joints.

namespace differential::reference {

/// Gravity on the centre of mass, or on six masses: the neglected terms are of fourth order in the
/// size.
void Tree::add_gravity(int body, Real t, const Motion& guide) {
  const Part& part = parts_[static_cast<std::size_t>(body)];
  const Pose& b = poses_[static_cast<std::size_t>(body)];
  if (!(part.mass > 0)) return;
  if (!guide_.has_gradient()) {
    right_.segment<3>(6 * body) += part.mass * (guide_.gravity(t, guide, b.x) - guide.a);
    return;
  }
  for (int k = 0; k < 6; ++k) {
    const Vec reach = (k % 2 == 0 ? 1 : -1) * (b.R * part.masses.col(k / 2));
    const Vec force = part.mass / 6 * (guide_.gravity(t, guide, b.x + reach) - guide.a);
    right_.segment<3>(6 * body) += force;
    right_.segment<3>(6 * body + 3) += reach.cross(force);
  }
}

void Tree::add_torque(int body, const Vec& torque) {
  right_.segment<3>(6 * body + 3) += torque;
  const int index = parents_[static_cast<std::size_t>(body)];
  if (index >= 0) right_.segment<3>(6 * index + 3) -= torque;
}

void Tree::add_force(int body, const Relative& r, const Vec& force) {
  right_.segment<3>(6 * body) += force;
  right_.segment<3>(6 * body + 3) += r.arm.cross(force);
  const int index = parents_[static_cast<std::size_t>(body)];
  if (index < 0) return;
  right_.segment<3>(6 * index) -= force;
  right_.segment<3>(6 * index + 3) -= r.reach.cross(force);
}

/// Drag of a medium that moves with the guide.
void Tree::add_drag(const Load& load, int body, const Motion& guide) {
  const Pose& b = poses_[static_cast<std::size_t>(body)];
  const Vec lever = b.R * (wide(load.point) - parts_[static_cast<std::size_t>(body)].centre);
  const Vec v = b.R.transpose() * (b.v + b.w.cross(lever) - guide.w.cross(b.x + lever));
  const Vec w = b.R.transpose() * (b.w - guide.w);
  const Vec force = -(b.R * (wide(load.linear) + v.norm() * wide(load.quadratic)).cwiseProduct(v));
  right_.segment<3>(6 * body) += force;
  right_.segment<3>(6 * body + 3) += lever.cross(force) - b.R * wide(load.angular).cwiseProduct(w);
}

void Tree::add_load(Real t, const Load& load, int body, const Motion& guide) {
  if (load.kind == LoadKind::drag) return add_drag(load, body, guide);
  if (load.kind == LoadKind::magnet) {
    const Mat R = poses_[static_cast<std::size_t>(body)].R;
    right_.segment<3>(6 * body + 3) +=
        (R * wide(load.moment)).cross(guide.R * course_of(load.field, t, within_).value);
    return;
  }
  const Pose& b = poses_[static_cast<std::size_t>(body)];
  const Mat axes = load.axes == Axes::body    ? b.R
                   : load.axes == Axes::guide ? guide.R
                                              : Mat(Mat::Identity());
  const bool is_timed = !load.force_in_time.empty();
  const Vec force =
      axes * (is_timed ? course_of(load.force_in_time, t, within_).value : wide(load.force));
  const Vec lever = b.R * (wide(load.point) - parts_[static_cast<std::size_t>(body)].centre);
  right_.segment<3>(6 * body) += force;
  right_.segment<3>(6 * body + 3) += axes * wide(load.torque) + lever.cross(force);
}

void Tree::add_joint_force(Real t, int body, const State& y) {
  const Body& b = scene_.bodies[static_cast<std::size_t>(body)];
  const Part& part = parts_[static_cast<std::size_t>(body)];
  const bool is_timed = !b.force_in_time.empty();
  if (b.stiffness.empty() && b.damping.empty() && b.force.empty() && !b.rotor && !is_timed) return;
  const Relative r = relative(body);
  const auto force = [&](std::size_t i, Real q, Real rate) {
    const auto one = [i](const auto& list) { return at_or(list, list.size() == 1 ? 0 : i); };
    const Real given = is_timed ? course_of(b.force_in_time, t, within_).value.x() : one(b.force);
    return given - one(b.stiffness) * (q - one(b.rest)) - one(b.damping) * rate;
  };
  if (b.kind == JointKind::spherical) {
    add_torque(body, -at_or(b.damping, 0) * r.w);
  } else if (b.kind == JointKind::revolute) {
    Real motor = 0;
    if (b.rotor && b.rotor->mode == RotorMode::torque) {
      const Signal& torque = b.rotor->torque_in_time;
      motor = torque.empty() ? Real(b.rotor->torque) : course_of(torque, t, within_).value.x();
    }
    add_torque(body, (motor + force(0, y[part.angles], r.axis.dot(r.w))) * r.axis);
  } else if (b.kind == JointKind::prismatic) {
    add_force(body, r, force(0, r.axis.dot(r.place), r.axis.dot(r.v)) * r.axis);
  } else if (b.kind == JointKind::cylindrical) {
    add_torque(body, force(0, y[part.angles], r.axis.dot(r.w)) * r.axis);
    add_force(body, r, force(1, r.axis.dot(r.place), r.axis.dot(r.v)) * r.axis);
  } else if (b.kind == JointKind::planar) {
    const auto [first, second] = plane_of(body, r);
    add_force(body, r, force(0, first.dot(r.place), first.dot(r.v)) * first);
    add_force(body, r, force(1, second.dot(r.place), second.dot(r.v)) * second);
    add_torque(body, force(2, y[part.angles], r.axis.dot(r.w)) * r.axis);
  } else if (b.kind == JointKind::screw) {
    add_torque(body, force(0, y[part.angles], r.axis.dot(r.w)) * r.axis);
  } else if (b.kind == JointKind::universal) {
    // A torque in the plane of both axes that does the work of both forces.
    const Real c = r.axis.dot(r.second_axis);
    const Real left = r.axis.dot(r.w);
    const Real right = r.second_axis.dot(r.w);
    const Real d = 1 - c * c;
    const Real first = force(0, y[part.angles], (left - c * right) / d);
    const Real second = force(1, y[part.angles + 1], (right - c * left) / d);
    add_torque(body, (first - c * second) / d * r.axis + (second - c * first) / d * r.second_axis);
  }
}

void Tree::add_forces(Real t, const State& y, const Motion& guide) {
  for (int i = 0; i < static_cast<int>(poses_.size()); ++i) {
    const Part& part = parts_[static_cast<std::size_t>(i)];
    add_gravity(i, t, guide);
    for (const Load& load : scene_.bodies[static_cast<std::size_t>(i)].loads) {
      add_load(t, load, i, guide);
    }
    if (!part.held) add_joint_force(t, i, y);
  }
  add_elements();
  add_gears(y);
  add_servos(true);
}

}  // namespace differential::reference
