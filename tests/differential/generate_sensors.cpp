#include <algorithm>

#include "generate_parts.hpp"

namespace differential {

namespace {

/// Any frame that a sensor may name.
int frame(Random& r, const Scene& scene) {
  return r.below(static_cast<int>(scene.bodies.size()) + 2) - 2;
}

bool has_vertical(const Scene& scene) {
  const auto falls_freely = [](const Link& link) { return link.kind == LinkKind::orbit; };
  if (std::ranges::any_of(scene.guide, falls_freely)) return false;
  if (scene.gravity != GravityKind::not_given) return scene.gravity != GravityKind::none;
  if (scene.guide.empty()) return false;
  const std::string& own = scene.guide.front().gravity;
  return !own.empty() && own != "\"none\"";
}

/// Three numbers for the axes, or one for all of them.
Vector for_axes(Random& r, double size) {
  return r.chance(0.3) ? Vector::Constant(size * plain(r, 0.1, 3))
                       : Vector(size * vector(r, 0.1, 3));
}

SensorErrors errors(Random& r, const Sensor& sensor) {
  SensorErrors result;
  if (r.chance(0.5)) result.misalignment = vector(r, 0.001, 0.3);
  if (r.chance(0.5)) result.scale = for_axes(r, 0.01);
  result.is_in_degrees = sensor.kind == SensorKind::gyro && r.chance(0.2);
  if (r.chance(0.5)) result.bias = for_axes(r, result.is_in_degrees ? 1 : 0.02);
  if (r.chance(0.3)) result.resolution = r.pick({0.001, 0.1, 1.0});
  if (r.chance(0.2)) result.range = r.pick({0.5, 2.0, 100.0});
  if (r.chance(0.6)) return result;
  if (r.chance(0.6)) result.noise = for_axes(r, 0.01).cwiseAbs();
  if (r.chance(0.3)) result.drift = for_axes(r, 0.01).cwiseAbs();
  if (r.chance(0.3)) result.sigma = for_axes(r, 0.01).cwiseAbs();
  result.time = plain(r, 0.1, 10);
  result.seed = r.chance(0.5) ? 0 : r.below(1000);
  return result;
}

Sensor sensor(Random& r, const Scene& scene) {
  Sensor result;
  result.body = r.below(static_cast<int>(scene.bodies.size()));
  result.kind = r.pick({SensorKind::gyro, SensorKind::accelerometer, SensorKind::accelerometer,
                        SensorKind::point, SensorKind::attitude, SensorKind::reaction,
                        SensorKind::joint, SensorKind::azimuth});
  const bool is_fixed =
      scene.bodies[static_cast<std::size_t>(result.body)].kind == JointKind::fixed;
  if (result.kind == SensorKind::azimuth && !has_vertical(scene)) result.kind = SensorKind::joint;
  if (result.kind == SensorKind::joint && is_fixed) result.kind = SensorKind::gyro;
  if (result.kind == SensorKind::joint) return result;
  if (result.kind == SensorKind::azimuth) {
    result.at = vector(r, 0.1, 3);
    return result;
  }
  const bool is_point = result.kind == SensorKind::point;
  const bool is_attitude = result.kind == SensorKind::attitude;
  if (!is_attitude && r.chance(0.7)) result.at = vector(r, 0.1, 3);
  result.at_by_name = !is_attitude && r.chance(0.3);
  if (!is_point && !is_attitude && r.chance(0.3)) result.axes = attitude(r);
  if (is_point || is_attitude) result.against = frame(r, scene);
  // With logged rates the position of the guide in the inertial frame is unknown.
  const bool is_lost = !scene.guide.empty() && scene.guide.front().kind == LinkKind::rates;
  if (is_point && is_lost && result.against == inertial_frame) result.against = guide_frame;
  result.on = is_point && r.chance(0.5) ? frame(r, scene) : result.against;
  const bool integrates =
      result.kind == SensorKind::gyro || result.kind == SensorKind::accelerometer;
  const bool suits = integrates && scene.model.empty() && scene.t_end <= 5;
  if (suits && r.chance(0.3)) {
    result.increments = r.pick<std::string>({"true", "true", "\"uncompensated\""});
  }
  const bool is_sampled = !result.increments.empty() || (scene.model.empty() && r.chance(0.1));
  if (is_sampled) result.period = scene.t_end / 8;
  if (integrates && r.chance(0.3)) result.errors = errors(r, result);
  return result;
}

}  // namespace

Sensor sensor_of_element(Random& r, const Scene& scene) {
  Sensor result{.kind = SensorKind::reaction};
  result.element = r.below(static_cast<int>(scene.elements.size()));
  result.body = std::max(0, scene.elements[static_cast<std::size_t>(result.element)].bodies[1]);
  result.at = vector(r, 0.1, 3);
  if (r.chance(0.3)) result.axes = attitude(r);
  return result;
}

void add_sensors(Random& r, Scene& scene) {
  if (r.chance(0.6)) return;
  do {
    scene.sensors.push_back(sensor(r, scene));
  } while (r.chance(0.6));
}

}  // namespace differential
