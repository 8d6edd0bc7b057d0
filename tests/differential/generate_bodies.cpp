#include <algorithm>
#include <cmath>

#include "generate_parts.hpp"
#include "reference_guide.hpp"

namespace differential {

namespace {

void add_mass(Random& r, Body& body) {
  body.mass = plain(r);
  const double size = body.mass * r.pick({0.1, 0.01, 1.0});
  body.inertia = inertia(r, size);
  if (r.chance(0.7)) body.centre = vector(r, 0.01, 1);
}

/// The kind of joint after `free` at a share of the list, from 0 to 1.
JointKind later_kind(double share) {
  const auto& types = kreisel::joint_types();
  const auto first = static_cast<std::size_t>(JointKind::free) + 1;
  return types[first + static_cast<std::size_t>(share * double(types.size() - first))].kind;
}

void add_joint(Random& r, Body& body) {
  const double u = r.uniform();
  body.kind = u < 0.36   ? JointKind::revolute
              : u < 0.45 ? later_kind((u - 0.36) / 0.09)
              : u < 0.60 ? JointKind::prismatic
              : u < 0.75 ? JointKind::universal
              : u < 0.87 ? JointKind::spherical
              : u < 0.96 ? JointKind::free
                         : JointKind::fixed;
  body.axis = direction(r);
  do {
    body.second_axis = direction(r);
  } while (body.axis.normalized().cross(body.second_axis.normalized()).norm() < 0.1);
  const kreisel::JointType& type = kreisel::joint_type(body.kind);
  if (type.has_pitch) body.pitch = sign(r) * plain(r, 0.01, 1);
  const bool optional = type.second_axis == kreisel::JointType::Axis::optional;
  if (optional && r.chance(0.5)) body.second_axis.setZero();
  if (r.chance(0.5)) body.position = vector(r, 0.1, 2);
  if (r.chance(0.1)) body.orientation = attitude(r);
}

void add_initial(Random& r, Body& body) {
  if (r.chance(0.15)) return;
  const int n = single_coordinates(body.kind);
  const bool moves = r.chance(0.5);
  const bool in_degrees = !slides(body.kind) && r.chance(0.15);
  for (const auto& quantity : kreisel::joint_type(body.kind).coordinates) {
    for (int i = 0; i < quantity.count() && n > 0; ++i) {
      if (quantity.unit == "m") {
        body.displacement.push_back(r.chance(0.5) ? 0 : angle(r).radian());
      } else {
        body.angle.push_back(angle(r));
        body.angle.back().degrees = body.angle.front().degrees;
      }
      if (moves) body.rate.push_back(rate(r, in_degrees));
    }
  }
  if (n > 0 || body.kind == JointKind::fixed) return;
  if (r.chance(0.5)) body.attitude = attitude(r);
  if (moves) body.angular_velocity = rate(r, in_degrees).value * direction(r);
  body.turns_in_degrees = in_degrees;
  if (body.kind != JointKind::free) return;
  if (r.chance(0.5)) body.place = vector(r, 0.1, 3);
  if (moves) body.velocity = speed(r) * direction(r);
}

/// A number for each coordinate: the first, and all others.
std::vector<double> for_each_coordinate(int n, double first, double others) {
  std::vector<double> numbers(static_cast<std::size_t>(n), others);
  numbers.front() = first;
  return numbers;
}

void add_loads(Random& r, Body& body) {
  if (r.chance(0.85)) return;
  do {
    Load load;
    load.force = vector(r, 0.1, 10);
    if (r.chance(0.5)) load.torque = vector(r, 0.01, 3);
    if (r.chance(0.3)) load.point = vector(r, 0.1, 1);
    load.axes = r.pick({Axes::body, Axes::guide, Axes::inertial});
    if (r.chance(0.3)) load.force_in_time = any_signal(r, 1, [&r] { return direction(r); });
    body.loads.push_back(load);
  } while (r.chance(0.15));
}

/// Prescribes the angle, or its rate, which may be a broken line.
void add_motion(Random& r, Body& body) {
  body.is_rate = r.chance(0.5);
  do {
    const auto along = [&r] { return Vector(sign(r) * Vector::UnitX()); };
    body.motion = body.is_rate ? any_signal(r, 1, along) : smooth_signal(r, 0.3, along);
  } while (body.motion.empty() ||
           (!body.motion.jumps.times.empty() && !body.motion.jumps.is_broken_line));
  start_motion(body, 0);
}

/// Locks the joint or drives it.
void add_rule(Random& r, Body& body) {
  if (r.chance(0.04)) {
    body.hold = true;
    body.rate.clear();
    body.angular_velocity.setZero();
    body.velocity.setZero();
  } else if (body.kind == JointKind::revolute && r.chance(0.12)) {
    body.drive = true;
    if (r.chance(0.5)) add_motion(r, body);
  }
}

void add_body(Random& r, Scene& scene) {
  Body body;
  const int before = static_cast<int>(scene.bodies.size());
  if (before > 0) {
    body.parent = r.chance(0.7) ? before - 1 : r.below(before + 1) - 1;
    if (body.parent >= 0 && scene.bodies[static_cast<std::size_t>(body.parent)].rotor) {
      body.parent = -1;
    }
  }
  add_joint(r, body);
  add_mass(r, body);
  add_initial(r, body);
  add_joint_forces(r, body);
  add_loads(r, body);
  add_rule(r, body);
  scene.bodies.push_back(body);
}

}  // namespace

std::vector<double> inertia(Random& r, double size) {
  const auto moment = [&r, size] { return size * plain(r, 0.1, 10); };
  const double a = moment();
  if (r.chance(0.3)) return {a, a, a};
  if (r.chance(0.3)) return {a, a, a * r.pick({0.1, 0.5, 1.5, 1.9})};
  const double A = moment();
  const double B = moment();
  if (r.chance(0.75)) return {A + a, B + a, A + B};
  const double least = std::min({a, A, B});
  const auto product = [&r, least] { return least * rounded(r.between(-0.4, 0.4), 2); };
  return {A + a, B + a, A + B, product(), product(), product()};
}

void add_damping(Random& r, Body& body, int n) {
  const double ratio =
      r.chance(0.6) ? r.pick({1e-4, 1e-3, 1e-2, 0.1, 1.0, 10.0}) : r.spread(1e-4, 10);
  const double stiffness = body.stiffness.empty() ? 1 : std::abs(body.stiffness.front());
  const double inertia = slides(body.kind) ? body.mass : body.inertia.front();
  const double damping = rounded(2 * ratio * std::sqrt(stiffness * inertia), 3);
  body.damping = for_each_coordinate(std::max(n, 1), damping, r.chance(0.5) ? damping : 0);
}

void add_joint_forces(Random& r, Body& body) {
  const int n = single_coordinates(body.kind);
  if (n > 0 && r.chance(0.3)) {
    const double stiffness =
        r.chance(0.7) ? plain(r, 0.1, 100) : r.pick({1e3, 1e4, 1e6, 1e8, 1e10});
    body.stiffness = for_each_coordinate(n, stiffness, r.chance(0.5) ? stiffness : 1);
    if (r.chance(0.3)) {
      const bool degrees = !slides(body.kind) && r.chance(0.3);
      body.rest.assign(static_cast<std::size_t>(n), {0, degrees});
      body.rest.front().value = rounded(r.between(-1, 1), 1) * (degrees ? 50 : 1);
    }
  }
  const double damped = body.stiffness.empty() ? 0.2 : 0.6;
  if ((n > 0 || body.kind == JointKind::spherical) && r.chance(damped)) add_damping(r, body, n);
  if (n > 0 && r.chance(0.1)) {
    body.force = for_each_coordinate(n, sign(r) * plain(r, 0.1, 10), 0);
  }
  if (n == 1 && r.chance(0.15)) body.force_in_time = number_signal(r, 1);
}

void add_other_loads(Random& r, Body& body) {
  if (body.rotor || r.chance(0.9)) return;
  Load load;
  load.kind = r.chance(0.5) ? LoadKind::drag : LoadKind::magnet;
  if (load.kind == LoadKind::drag) {
    load.linear = body.mass * vector(r, 0.01, 1).cwiseAbs();
    load.quadratic = body.mass * vector(r, 0.01, 1).cwiseAbs();
    load.angular = body.inertia.front() * vector(r, 0.01, 1).cwiseAbs();
    if (r.chance(0.4)) load.point = vector(r, 0.1, 1);
  } else {
    load.moment = body.inertia.front() * vector(r, 0.1, 10);
    do {
      load.field = any_signal(r, 1, [&r] { return direction(r); });
    } while (load.field.empty());
  }
  body.loads.push_back(load);
}

void start_motion(Body& body, double t) {
  const reference::Course start = reference::course_of(body.motion, t, t);
  const auto value = static_cast<double>(start.value.x());
  if (!body.is_rate) body.angle = {{value, false}};
  body.rate = {{body.is_rate ? value : static_cast<double>(start.rate.x()), false}};
}

Body rotor(Random& r, int carrier) {
  Body body;
  body.parent = carrier;
  body.kind = JointKind::revolute;
  const int along = r.below(3);
  body.axis = Vector::Unit(along);
  if (r.chance(0.3)) body.position = vector(r, 0.1, 1);
  body.mass = plain(r, 0.1, 10);
  const double about = r.pick({0.001, 0.01, 0.1, 1.0});
  const double across = about * r.pick({0.5, 0.6, 1.0, 3.0});
  body.inertia = {across, across, across};
  body.inertia[static_cast<std::size_t>(along)] = about;
  Rotor rotor;
  rotor.mode = r.pick({RotorMode::free, RotorMode::regulated, RotorMode::torque});
  rotor.speed = {sign(r) * r.pick({1.0, 10.0, 50.0, 100.0, 300.0}), false};
  if (r.chance(0.15)) rotor.speed = {sign(r) * r.pick({360.0, 3600.0}), true};
  rotor.speed_is_initial = r.chance(0.15);
  if (rotor.mode == RotorMode::torque) rotor.torque = r.chance(0.5) ? 0 : sign(r) * about;
  if (rotor.mode == RotorMode::torque && r.chance(0.4)) {
    rotor.torque_in_time = number_signal(r, about);
  }
  if (rotor.mode != RotorMode::free && r.chance(0.2)) body.damping = {0.01 * about};
  body.rotor = rotor;
  return body;
}

void add_bodies(Random& r, Scene& scene) {
  const int bodies = r.chance(0.45) ? 1 : r.chance(0.7) ? 2 : 3;
  for (int i = 0; i < bodies; ++i) add_body(r, scene);
  if (r.chance(0.2)) {
    const int carrier = static_cast<int>(scene.bodies.size()) - 1;
    scene.bodies.push_back(rotor(r, carrier));
  }
}

}  // namespace differential
