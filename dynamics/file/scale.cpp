#include <algorithm>
#include <cmath>
#include <type_traits>
#include <variant>

#include <dynamics/file/scale.hpp>
#include <dynamics/tree/joint/list.hpp>

namespace kreisel {

namespace {

double gravity_of(const SceneFile& scene) {
  return std::visit(
      [](const auto& field) {
        using Field = std::decay_t<decltype(field)>;
        if constexpr (requires { field.g; }) {
          return double(field.g.norm());
        } else if constexpr (requires { field.magnitude; }) {
          return double(field.magnitude);
        } else if constexpr (requires { field.parameter; }) {
          // Gravity at the planet's surface, if its radius is given.
          return field.j2 == 0 ? 0.0 : field.parameter / (field.radius * field.radius);
        } else {
          return std::is_same_v<Field, scene_gravity::Ellipsoid> ? 9.8 : 0.0;
        }
      },
      scene.gravity);
}

/// The extent of a body's mass and its joint.
double length_of(const BodyDescription& body) {
  const auto& [mass, first_moment, tensor] = body.inertia.value;
  const double joint = body.joint.position.norm();
  if (!(mass > 0)) return joint;
  const double centre = first_moment.norm() / mass;
  return std::max({joint, centre, std::sqrt(tensor.matrix().trace() / mass)});
}

/// Greatest rate, speed and displacement of one body's joint.
struct Motion {
  double turning = 0;
  double speed = 0;
  double way = 0;
};

Motion motion_of(const BodyTree& tree, int body, const std::vector<JointState>& states) {
  const JointPlace place = tree.place(body);
  const JointType& type = joint_type(tree.body(body).joint.kind);
  Motion most;
  for (const JointState& state : states) {
    int at = place.q;
    for (const JointQuantity& quantity : type.coordinates) {
      const double size = state.coordinates.segment(at, quantity.count()).norm();
      if (quantity.unit == "m") most.way = std::max(most.way, size);
      at += quantity.count();
    }
    at = place.v;
    for (const JointQuantity& quantity : type.rates) {
      const double size = state.rates.segment(at, quantity.count()).norm();
      double& greatest = quantity.unit == "m/s" ? most.speed : most.turning;
      greatest = std::max(greatest, size);
      at += quantity.count();
    }
  }
  return most;
}

}  // namespace

double SceneScale::of(const std::string& unit) const {
  if (unit == "rad" || unit == "1") return angle;
  if (unit == "m") return length;
  if (unit == "rad/s") return turning;
  if (unit == "m/s") return speed;
  if (unit == "N") return force;
  if (unit == "N m") return torque;
  return 0;
}

void SceneScale::hold(const JointReactions& reactions) {
  for (const auto& on_body : reactions.on_body) {
    force = std::max(force, on_body.value.resultant.norm());
    torque = std::max(torque, on_body.value.moment.norm());
  }
  torque = std::max(torque, force * length);
}

double shown(double x, double size) { return std::abs(x) < 1e-12 * size ? 0 : x; }

Eigen::Vector3d shown(const Eigen::Vector3d& v, double size) {
  return v.unaryExpr([size](double x) { return shown(x, size); });
}

SceneScale scale_of(const SceneFile& scene, const BodyTree& tree,
                    const std::vector<JointState>& states) {
  SceneScale scale;
  scale.angle = 1;
  scale.turning = scene.duration() > 0 ? 1 / scene.duration() : 0;
  double mass = 0;
  double momentum = 0;  // the greatest angular momentum of a body
  for (int i = 0; i < static_cast<int>(tree.bodies().size()); ++i) {
    const BodyDescription& body = tree.body(i);
    const Motion motion = motion_of(tree, i, states);
    scale.length = std::max({scale.length, length_of(body), motion.way});
    scale.speed = std::max(scale.speed, motion.speed);
    // The rotation of a rotor moves no mass to and fro.
    if (!body.rotor) scale.turning = std::max(scale.turning, motion.turning);
    mass = std::max(mass, body.inertia.value.mass);
    momentum = std::max(momentum, body.inertia.value.tensor.matrix().trace() * motion.turning);
  }
  scale.speed = std::max(scale.speed, scale.length * scale.turning);
  scale.force = mass * (gravity_of(scene) + scale.speed * scale.turning);
  scale.torque = std::max(scale.force * scale.length, momentum * scale.turning);
  return scale;
}

}  // namespace kreisel
