#include <algorithm>

#include "generate_parts.hpp"

namespace differential {

namespace {

/// A number of either sign that is not small relative to `size`.
double small(Random& r, double size) { return sign(r) * size * r.between(0.5, 1); }

/// Rings with small motions about a rotor, as in the equations of the papers.
void add_small_gimbals(Random& r, Scene& scene, bool symmetric) {
  const int first = r.below(3);
  const double size = r.pick({0.01, 0.03});
  for (int i = 0; i < 2; ++i) {
    Body ring;
    ring.parent = i - 1;
    ring.axis = Vector::Unit((first + i) % 3);
    ring.mass = plain(r, 0.1, 2);
    ring.inertia = {0.002, 0.002, 0.002};
    for (double& moment : ring.inertia) moment = 0.002 * rounded(r.between(1, 1.5), 2);
    ring.angle = {{small(r, size), false}};
    if (r.chance(0.5)) ring.rate = {{small(r, size), false}};
    if (r.chance(0.5)) ring.stiffness = {r.pick({0.01, 0.1, 0.5})};
    if (r.chance(0.5)) ring.damping = {r.pick({1e-4, 1e-3})};
    scene.bodies.push_back(ring);
  }
  Body wheel;
  wheel.parent = 1;
  const auto along = static_cast<std::size_t>((first + 2) % 3);
  wheel.axis = Vector::Unit(static_cast<int>(along));
  wheel.inertia = {0.005, 0.005, 0.005};
  wheel.inertia[along] = 0.008;
  if (!symmetric) wheel.inertia[static_cast<std::size_t>(first)] = 0.0055;
  const double speed = sign(r) * r.pick({10.0, 30.0, 100.0});
  if (symmetric) {
    wheel.rotor =
        Rotor{.mode = r.pick({RotorMode::free, RotorMode::regulated}), .speed = {speed, false}};
  } else {
    wheel.drive = true;
    wheel.rate = {{speed, false}};
    wheel.angle = {angle(r)};
  }
  scene.bodies.push_back(wheel);
  scene.model = symmetric ? "foeppl" : "fuchs-weigand";
}

/// Pendulums with small swings about a rest position, on a guide that may turn about the vertical.
void add_small_pendulums(Random& r, Scene& scene) {
  const int along = r.below(3);
  const Vector down = sign(r) * Vector::Unit(along);
  scene.gravity = r.pick({GravityKind::uniform, GravityKind::inertial});
  scene.gravity_vector = 9.81 * down;
  if (r.chance(0.6)) {
    scene.guide = {Link{.kind = LinkKind::rotating}};
    scene.guide.front().angular_velocity = r.pick({0.1, 1.0, 3.0}) * down;
  }
  const int bodies = 1 + r.below(3);
  for (int i = 0; i < bodies; ++i) {
    Body body;
    body.parent = i - 1;
    body.kind = r.chance(0.6) ? JointKind::revolute : JointKind::universal;
    const int across = 1 + r.below(2);
    body.axis = sign(r) * Vector::Unit((along + across) % 3);
    body.second_axis = Vector::Unit((along + 3 - across) % 3);
    body.mass = plain(r, 0.1, 10);
    body.centre = plain(r, 0.2, 2) * down;
    if (i > 0) body.position = plain(r, 0.2, 2) * down;
    for (double& moment : body.inertia) moment = body.mass * rounded(r.between(0.1, 0.15), 2);
    for (int k = 0; k < single_coordinates(body.kind); ++k) {
      body.angle.push_back({small(r, 0.01), false});
    }
    if (r.chance(0.3)) add_damping(r, body, single_coordinates(body.kind));
    scene.bodies.push_back(body);
  }
  scene.model = r.chance(0.5) ? "linear" : "small";
}

/// A fast rotor in rings; the inner ring has an unbalance.
void add_fast_gyro(Random& r, Scene& scene) {
  add_small_gimbals(r, scene, true);
  for (Body& body : scene.bodies) body.stiffness.clear(), body.damping.clear(), body.rate.clear();
  scene.bodies.back().rotor->mode = RotorMode::regulated;
  scene.bodies.back().rotor->speed = {sign(r) * r.pick({1000.0, 2000.0}), false};
  const auto axis = scene.bodies.back().axis;
  scene.bodies[1].centre = 0.05 * axis;
  if (r.chance(0.4)) scene.bodies[1].force_in_time.rate = small(r, 0.01) * Vector::UnitX();
  scene.gravity = GravityKind::uniform;
  scene.gravity_vector = 9.81 * scene.bodies[0].axis;
  scene.model = "precession";
}

}  // namespace

void add_approximation(Random& r, Scene& scene) {
  scene.guide.clear();
  const auto needs_guide = {GravityKind::earth, GravityKind::earth_j2, GravityKind::orbit};
  if (std::count(needs_guide.begin(), needs_guide.end(), scene.gravity) > 0) {
    scene.gravity = GravityKind::not_given;
  }
  const double u = r.uniform();
  if (u < 0.4) {
    add_small_pendulums(r, scene);
  } else if (u < 0.85) {
    add_small_gimbals(r, scene, r.chance(0.5));
  } else {
    add_fast_gyro(r, scene);
  }
  scene.t_end = r.pick({0.1, 0.5, 1.0});
}

}  // namespace differential
