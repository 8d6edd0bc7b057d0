#include <algorithm>

#include "generate_parts.hpp"

namespace differential {

namespace {

/// Any frame that a sensor may name.
int frame(Random& r, const Scene& scene) {
  return r.below(static_cast<int>(scene.bodies.size()) + 2) - 2;
}

Sensor sensor(Random& r, const Scene& scene) {
  Sensor result;
  result.kind = r.pick({SensorKind::gyro, SensorKind::accelerometer, SensorKind::accelerometer,
                        SensorKind::point, SensorKind::attitude, SensorKind::reaction});
  result.body = r.below(static_cast<int>(scene.bodies.size()));
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
