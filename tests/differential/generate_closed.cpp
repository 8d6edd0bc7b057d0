#include <algorithm>
#include <cmath>

#include "generate_parts.hpp"
#include "reference.hpp"

/// Constraints between the bodies of a scene, placed so that its start fulfils them.

namespace differential {

namespace {

StartPose pose_of(const std::vector<StartPose>& poses, int body) {
  return body < 0 ? StartPose{} : poses[static_cast<std::size_t>(body)];
}

/// Sets the second body's point to a point of the guide.
void set_second_point(Constraint& c, const StartPose& second, const Vector& point) {
  c.at[1] = second.R.transpose() * (point - second.x);
}

void place_joint(Random& r, const std::vector<StartPose>& poses, Constraint& c) {
  const StartPose first = pose_of(poses, c.bodies[0]);
  const StartPose second = pose_of(poses, c.bodies[1]);
  c.at[0] = vector(r, 0.1, 2);
  Vector point = first.x + first.R * c.at[0];
  if (c.kind == ConstraintKind::prismatic) {
    point += first.R * c.axis.normalized() * rounded(r.between(-1, 1), 2);
  }
  set_second_point(c, second, point);
  if (c.kind != ConstraintKind::universal) return;
  const Vector axis = first.R * c.axis.normalized();
  Vector other;
  do {
    other = axis.cross(direction(r));
  } while (other.norm() < 0.1);
  c.second_axis = second.R.transpose() * other.normalized();
}

void place_distance(Random& r, const std::vector<StartPose>& poses, Constraint& c) {
  const StartPose first = pose_of(poses, c.bodies[0]);
  const StartPose second = pose_of(poses, c.bodies[1]);
  do {
    c.at = {vector(r, 0.1, 2), vector(r, 0.1, 2)};
    for (double& x : c.at[1]) x += sign(r) * rounded(r.between(0.1, 0.3), 3);
    c.length = (second.x + second.R * c.at[1] - first.x - first.R * c.at[0]).norm();
  } while (c.length < 0.1);
}

/// A ball, a disc or a tyre on a plane through its contact; the plane's point lies beside it.
void place_wheel(Random& r, const std::vector<StartPose>& poses, Constraint& c) {
  const StartPose on = pose_of(poses, c.bodies[0]);
  const StartPose wheel = pose_of(poses, c.bodies[1]);
  c.is_ball = r.chance(0.4);
  c.radius = plain(r, 0.1, 2);
  if (!c.is_ball && r.chance(0.3)) c.tube = r.pick({0.01, 0.1});
  if (r.chance(0.3)) c.at[1] = vector(r, 0.01, 0.3);
  Vector n;
  Vector down;
  do {
    c.normal = direction(r);
    c.axis = direction(r);
    n = on.R * c.normal.normalized();
    const Vector a = wheel.R * c.axis.normalized();
    down = c.is_ball ? n : Vector(n - n.dot(a) * a);
  } while (down.norm() < 0.3);
  const Vector contact = wheel.x + wheel.R * c.at[1] - c.radius * down.normalized() - c.tube * n;
  c.at[0] = on.R.transpose() * (contact - on.x);
  if (r.chance(0.5)) c.at[0] += c.normal.normalized().cross(vector(r, 0.1, 2));
}

double coordinate(const Body& body) {
  if (body.kind == JointKind::prismatic) {
    return body.displacement.empty() ? 0 : body.displacement.front();
  }
  return body.angle.empty() ? 0 : body.angle.front().radian();
}

void place_gear(Random& r, const Scene& scene, Constraint& c) {
  if (r.chance(0.7)) c.ratio = sign(r) * r.pick({0.5, 2.0, 3.0});
  const auto at = [&](std::size_t i) {
    return coordinate(scene.bodies[static_cast<std::size_t>(c.bodies[i])]);
  };
  c.offset = at(0) - c.ratio * at(1);
}

/// The bodies that a constraint of this kind may join; rotors take none.
std::vector<int> suitable(const Scene& scene, ConstraintKind kind) {
  std::vector<int> result;
  const bool is_gear = kind == ConstraintKind::gear;
  for (int i = 0; i < static_cast<int>(scene.bodies.size()); ++i) {
    const Body& body = scene.bodies[static_cast<std::size_t>(i)];
    const bool has_one = kreisel::joint_type(body.free_kind()).rate_count() == 1;
    const bool is_ruled = body.rotor || body.drive || body.hold;
    if (!body.rotor && (!is_gear || (has_one && !is_ruled))) result.push_back(i);
  }
  if (!is_gear) result.push_back(guide_frame);
  return result;
}

/// Draws the bodies, one of them the last if `takes_last`; false if the scene has too few.
bool pick_bodies(Random& r, const Scene& scene, bool takes_last, Constraint& c) {
  std::vector<int> all = suitable(scene, c.kind);
  const int count = static_cast<int>(all.size());
  if (count < 2) return false;
  const int last = static_cast<int>(scene.bodies.size()) - 1;
  const auto at_last = std::find(all.begin(), all.end(), last) - all.begin();
  const int first = takes_last ? static_cast<int>(at_last) : r.below(count);
  const int second = (first + 1 + r.below(count - 1)) % count;
  c.bodies = {all[static_cast<std::size_t>(first)], all[static_cast<std::size_t>(second)]};
  const bool has_order = c.kind == ConstraintKind::rolling || c.kind == ConstraintKind::blade;
  const bool wheel_is_first = has_order && (c.bodies[1] < 0 || takes_last);
  if (wheel_is_first) std::swap(c.bodies[0], c.bodies[1]);
  if (c.kind == ConstraintKind::blade) c.bodies[0] = guide_frame;
  return true;
}

/// The scene with all its joints moved a little.
Scene shifted(Scene scene) {
  double shift = 0.05;
  for (Body& body : scene.bodies) {
    if (body.hold || body.drive || body.rotor) continue;
    const auto n = static_cast<std::size_t>(single_coordinates(body.kind));
    body.angle.resize(n);
    body.displacement.resize(n);
    for (std::size_t i = 0; i < n; ++i) {
      shift = -1.1 * shift;
      body.angle[i] = {body.angle[i].radian() + shift, false};
      body.displacement[i] += shift;
    }
    if (n > 0) continue;
    body.attitude = body.attitude.value_or(Eigen::Vector4d(1, 0, 0, 0)) +
                    Eigen::Vector4d(0, shift, 1.3 * shift, -0.7 * shift);
    body.place = body.place.value_or(Vector::Zero()) + Vector(shift, -shift, 1.2 * shift);
  }
  return scene;
}

constexpr double none = 1e-10;  // as a singular value

/// The number of independent conditions, or -1 if the start is near a position with fewer.
int clear_rank(const Scene& scene) {
  const Eigen::VectorXd values = condition_values(scene);
  const auto rank = (values.array() > none).count();
  if ((values.array() > 0.02).count() != rank) return -1;
  const Eigen::VectorXd others = condition_values(shifted(scene));
  return (others.array() > none).count() == rank ? static_cast<int>(rank) : -1;
}

/// True if the bodies keep a motion, and what is compared is unique.
bool is_sound(const Scene& scene) {
  const int rank = clear_rank(scene);
  if (rank < 0 || rank >= static_cast<int>(6 * scene.bodies.size())) return false;
  if (rank == condition_values(scene).size()) return true;
  const bool is_driven = std::any_of(scene.bodies.begin(), scene.bodies.end(), [](const Body& b) {
    return b.drive || (b.rotor && b.rotor->mode == RotorMode::regulated);
  });
  const bool reads_reactions =
      std::any_of(scene.sensors.begin(), scene.sensors.end(), [](const Sensor& sensor) {
        return sensor.kind == SensorKind::reaction && sensor.element < 0;
      });
  return !is_driven && !reads_reactions && !scene.reports;
}

/// Sets the rates of a body to the values from `v` on.
void set_rates(Body& body, const double* v) {
  const int n = kreisel::joint_type(body.kind).rate_count();
  if (body.rotor) {
    body.rotor->speed = {v[0], false};
  } else if (single_coordinates(body.kind) > 0) {
    body.rate.clear();
    for (int i = 0; i < n; ++i) body.rate.push_back({v[i], false});
  } else if (n > 0) {
    body.turns_in_degrees = false;
    body.angular_velocity = Vector(v[0], v[1], v[2]);
    if (n == 6) body.velocity = Vector(v[3], v[4], v[5]);
  }
}

/// Changes the rates at the start so that they fulfil the constraints; false if none do.
bool fulfil(Scene& scene) {
  Scene tree = scene;
  for (Body& body : tree.bodies) body.loose = false;
  const JointValues before = start_values(tree);
  const JointValues after = fulfilled_values(tree);
  std::size_t at = 0;
  for (Body& body : scene.bodies) {
    const kreisel::JointType& type = kreisel::joint_type(body.kind);
    at += static_cast<std::size_t>(type.coordinate_count());
    double change = 0;
    for (int i = 0; i < type.rate_count(); ++i) {
      const std::size_t k = at + static_cast<std::size_t>(i);
      if (!std::isfinite(after[k])) return false;
      change = std::max(change, std::abs(after[k] - before[k]));
    }
    const bool is_ruled =
        body.drive || body.hold || (body.rotor && body.rotor->mode == RotorMode::regulated);
    if (change > 1e-13 && !is_ruled) set_rates(body, after.data() + at);
    at += static_cast<std::size_t>(type.rate_count());
  }
  return true;
}

Sensor sensor_of_constraint(Random& r, const Scene& scene) {
  Sensor result{.kind = SensorKind::reaction};
  result.constraint = static_cast<int>(scene.constraints.size()) - 1;
  result.body = std::max(0, scene.constraints.back().bodies[1]);
  if (r.chance(0.5)) result.at = vector(r, 0.1, 3);
  if (r.chance(0.3)) result.axes = attitude(r);
  return result;
}

}  // namespace

bool add_constraint(Random& r, Scene& scene, Constraint c) {
  switch (c.kind) {
    case ConstraintKind::distance: place_distance(r, start_poses(scene), c); break;
    case ConstraintKind::gear: place_gear(r, scene, c); break;
    case ConstraintKind::rolling: place_wheel(r, start_poses(scene), c); break;
    case ConstraintKind::blade: c.at[1] = vector(r, 0.1, 1); break;
    default: place_joint(r, start_poses(scene), c);
  }
  Scene tried = scene;
  tried.constraints.push_back(c);
  if (r.chance(0.4)) tried.sensors.push_back(sensor_of_constraint(r, tried));
  if (!is_sound(tried) || !fulfil(tried)) return false;
  scene = std::move(tried);
  return true;
}

void add_constraints(Random& r, Scene& scene) {
  if (scene.has_log() || r.chance(0.7)) return;
  for (int tries = 0; tries < 4; ++tries) {
    Constraint c;
    c.kind = r.pick({ConstraintKind::point, ConstraintKind::revolute, ConstraintKind::universal,
                     ConstraintKind::fixed, ConstraintKind::prismatic, ConstraintKind::distance,
                     ConstraintKind::gear, ConstraintKind::gear, ConstraintKind::rolling,
                     ConstraintKind::blade});
    c.axis = direction(r);
    Scene tried = scene;
    const bool is_new = c.kind != ConstraintKind::gear && r.chance(0.6);
    if (is_new) add_free_body(r, tried);
    if (!pick_bodies(r, tried, is_new, c) || !add_constraint(r, tried, c)) continue;
    scene = std::move(tried);
    if (r.chance(0.6)) return;
  }
}

}  // namespace differential
