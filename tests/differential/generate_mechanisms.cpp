#include "generate_parts.hpp"

namespace differential {

namespace {

/// A body of a chain; it has mass and inertia.
Body link(Random& r, int parent, const Vector& along) {
  Body body;
  body.parent = parent;
  body.mass = plain(r, 0.1, 10);
  body.inertia = inertia(r, body.mass * r.pick({0.1, 1.0}));
  body.centre = rounded(r.between(0, 1), 2) * along;
  if (parent >= 0) body.position = along;
  return body;
}

/// A vector across an axis of the guide.
Vector across(Random& r, int axis) {
  Vector v = Vector::Zero();
  v[(axis + 1) % 3] = rounded(r.between(0.2, 1.5), 2);
  v[(axis + 2) % 3] = rounded(r.between(-1, 1), 2);
  return v;
}

}  // namespace

Constraint add_plane_chain(Random& r, Scene& scene) {
  const int axis = r.below(3);
  const int links = r.chance(0.3) ? 2 : 3;
  for (int i = 0; i < links; ++i) {
    Body body = link(r, i - 1, across(r, axis));
    body.axis = Vector::Unit(axis);
    body.angle = {{rounded(r.between(-1.5, 1.5), 2), false}};
    if (r.chance(0.3)) body.rate = {{sign(r) * r.pick({0.5, 1.0, 3.0}), false}};
    if (r.chance(0.4)) add_joint_forces(r, body);
    scene.bodies.push_back(body);
  }
  Constraint closing;
  closing.kind = links == 2 ? r.pick({ConstraintKind::distance, ConstraintKind::prismatic})
                            : r.pick({ConstraintKind::revolute, ConstraintKind::revolute,
                                      ConstraintKind::point, ConstraintKind::universal});
  closing.bodies = {guide_frame, links - 1};
  closing.axis = Vector::Unit(axis);
  if (closing.kind == ConstraintKind::prismatic) closing.axis = across(r, axis);
  return closing;
}

Constraint add_spatial_chain(Random& r, Scene& scene) {
  const int links = 2 + r.below(2);
  for (int i = 0; i < links; ++i) {
    Body body = link(r, i - 1, plain(r, 0.3, 2) * direction(r));
    body.kind = r.pick(
        {JointKind::spherical, JointKind::universal, JointKind::revolute, JointKind::cylindrical});
    body.axis = unit(r);
    body.second_axis = body.axis.unitOrthogonal();
    for (int k = 0; k < single_coordinates(body.kind); ++k) {
      body.angle.push_back({rounded(r.between(-1, 1), 2), false});
      body.rate.push_back({r.chance(0.5) ? 0 : rounded(r.between(-2, 2), 2), false});
    }
    if (body.kind == JointKind::cylindrical) body.displacement = {rounded(r.between(-1, 1), 2)};
    if (body.kind == JointKind::spherical) body.attitude = attitude(r);
    scene.bodies.push_back(body);
  }
  Constraint closing;
  closing.kind =
      r.pick({ConstraintKind::point, ConstraintKind::revolute, ConstraintKind::universal,
              ConstraintKind::prismatic, ConstraintKind::fixed, ConstraintKind::distance});
  closing.bodies = {guide_frame, links - 1};
  closing.axis = direction(r);
  return closing;
}

void add_free_body(Random& r, Scene& scene) {
  Body body = link(r, -1, direction(r));
  body.kind = JointKind::free;
  if (r.chance(0.7)) body.centre.setZero();
  if (r.chance(0.6)) body.attitude = attitude(r);
  if (r.chance(0.5)) body.place = vector(r, 0.1, 3);
  if (r.chance(0.7)) body.angular_velocity = plain(r, 0.1, 10) * direction(r);
  if (r.chance(0.5)) body.velocity = vector(r, 0.1, 3);
  scene.bodies.push_back(body);
}

Constraint add_vehicle(Random& r, Scene& scene) {
  if (r.chance(0.3)) {
    Body floor = link(r, -1, direction(r));
    floor.kind = r.pick({JointKind::prismatic, JointKind::revolute, JointKind::spherical});
    floor.axis = unit(r);
    scene.bodies.push_back(floor);
  }
  const int on = static_cast<int>(scene.bodies.size()) - 1;
  add_free_body(r, scene);
  Constraint contact;
  contact.kind = r.chance(0.75) ? ConstraintKind::rolling : ConstraintKind::blade;
  contact.bodies = {contact.kind == ConstraintKind::blade ? guide_frame : on, on + 1};
  contact.axis = direction(r);
  return contact;
}

}  // namespace differential
