#include <cmath>

#include "generate_parts.hpp"

namespace differential {

namespace {

Link aligned_link(Random& r) {
  const double u = r.uniform();
  if (u < 0.3) return earth(r);
  Link link{.kind = u < 0.5 ? LinkKind::rotating : LinkKind::harmonic};
  link.angular_velocity = r.pick({1.0, 0.5, 0.1, 3.0}) * unit(r);
  if (r.chance(0.3)) link.angular_velocity += unit(r);
  const double frequency = r.pick({1.0, 0.785, 2.0});
  const int terms = 1 + r.below(2);
  for (int i = 0; i < terms; ++i) {
    const double amplitude = r.pick({0.157, 0.1, 1.0});
    const Angle phase{90.0 * r.below(4), true};
    (r.chance(0.8) ? link.turning : link.pushing)
        .terms.push_back({amplitude * unit(r), {frequency}, phase});
  }
  return link;
}

}  // namespace

void add_pendulums(Random& r, Scene& scene) {
  const Vector axis = unit(r);
  const int links = r.chance(0.7) ? 1 : 2;
  Vector down = scene.gravity_vector.isZero(0) ? -Vector::UnitZ() : scene.gravity_vector;
  down.normalize();
  const double length = plain(r, 0.1, 10);
  for (int i = 0; i < links; ++i) {
    Body body;
    body.parent = i - 1;
    body.axis = axis;
    body.mass = plain(r, 0.1, 10);
    body.centre = length * down;
    if (i > 0) body.position = length * down;
    const bool points = r.chance(0.3) && std::abs(axis.dot(down)) < 0.1;
    body.inertia = points ? std::vector<double>{0, 0, 0} : inertia(r, 0.1 * length * length);
    if (r.chance(0.6)) body.angle = {angle(r)};
    if (r.chance(0.2)) body.rate = {rate(r)};
    if (r.chance(0.4)) body.damping = {r.pick({1e-3, 0.01, 0.1, 1.0})};
    scene.bodies.push_back(body);
  }
}

void add_resting_bodies(Random& r, Scene& scene) {
  scene.guide = {aligned_link(r)};
  scene.gravity = GravityKind::not_given;
  const Vector down = scene.guide.front().kind == LinkKind::earth ? Vector::UnitX() : unit(r);
  if (scene.guide.front().kind != LinkKind::earth && r.chance(0.7)) {
    scene.gravity = r.pick({GravityKind::inertial, GravityKind::uniform});
    scene.gravity_vector = 9.81 * down;
  }
  const int bodies = r.chance(0.7) ? 1 : 2;
  for (int i = 0; i < bodies; ++i) {
    Body body;
    body.parent = i - 1;
    body.kind = r.pick({JointKind::revolute, JointKind::revolute, JointKind::universal,
                        JointKind::spherical, JointKind::prismatic});
    const int along = r.below(3);
    body.axis = sign(r) * Vector::Unit(along);
    body.second_axis = Vector::Unit((along + 1 + r.below(2)) % 3);
    body.inertia = inertia(r, 1);
    if (r.chance(0.6)) body.centre = 0.5 * down;
    if (i > 0) body.position = down;
    const int n = single_coordinates(body.kind);
    for (int k = 0; k < n && !slides(body.kind); ++k) {
      const bool off = r.chance(0.2);
      body.angle.push_back(
          {off ? sign(r) * r.pick({1e-20, 1e-14, 1e-9, 1e-6}) : 90.0 * r.below(4), !off});
      body.angle.back().degrees = body.angle.front().degrees;
    }
    if (n > 0 && r.chance(0.3)) add_damping(r, body, n);
    scene.bodies.push_back(body);
  }
}

void add_cardan_gyro(Random& r, Scene& scene) {
  const int first = r.below(3);
  const bool massless = r.chance(0.1);
  for (int i = 0; i < 2; ++i) {
    Body ring;
    ring.parent = i - 1;
    ring.axis = Vector::Unit((first + i) % 3);
    ring.mass = plain(r, 0.1, 2);
    ring.inertia = inertia(r, 0.005);
    if (massless) {
      ring.mass = 0;
      ring.inertia = {0, 0, 0};
    }
    ring.angle = {angle(r)};
    if (r.chance(0.3)) ring.rate = {rate(r)};
    if (!massless) add_joint_forces(r, ring);
    scene.bodies.push_back(ring);
  }
  Body wheel = rotor(r, 1);
  const auto along = static_cast<std::size_t>((first + 2) % 3);
  wheel.axis = Vector::Unit(static_cast<int>(along));
  wheel.inertia = {0.005, 0.005, 0.005};
  wheel.inertia[along] = 0.008;
  scene.bodies.push_back(wheel);
}

}  // namespace differential
