#include <algorithm>
#include <cmath>

#include "generate_parts.hpp"

namespace differential {

namespace {

/// True if a body's joint may be a constraint: it has no forces, and nothing else refers to it.
bool may_be_loose(const Scene& scene, int index) {
  const Body& b = scene.bodies[static_cast<std::size_t>(index)];
  const bool is_kind = b.kind == JointKind::revolute || b.kind == JointKind::prismatic ||
                       b.kind == JointKind::spherical || b.kind == JointKind::fixed ||
                       (b.kind == JointKind::universal && !b.orientation &&
                        std::abs(b.axis.normalized().dot(b.second_axis.normalized())) < 1e-15);
  const bool is_free_of_forces = b.stiffness.empty() && b.damping.empty() && b.force.empty() &&
                                 b.force_in_time.empty() && !b.rotor && !b.drive && !b.hold;
  const bool is_geared =
      std::any_of(scene.elements.begin(), scene.elements.end(), [index](const Element& element) {
        return element.kind == ElementKind::gear &&
               (element.bodies[0] == index || element.bodies[1] == index);
      });
  const bool is_read =
      std::any_of(scene.sensors.begin(), scene.sensors.end(), [index](const Sensor& sensor) {
        return sensor.kind == SensorKind::reaction && sensor.body == index;
      });
  // In a free joint the inertia about each axis must be positive.
  const bool resists = b.mass > 0 && std::all_of(b.inertia.begin(), b.inertia.begin() + 3,
                                                 [](double moment) { return moment > 0; });
  return is_kind && is_free_of_forces && resists && !is_geared && !is_read;
}

}  // namespace

void loosen_joints(Random& r, Scene& scene) {
  if (scene.reports || scene.has_log() || r.chance(0.7)) return;
  for (int i = 0; i < static_cast<int>(scene.bodies.size()); ++i) {
    if (may_be_loose(scene, i) && r.chance(0.4))
      scene.bodies[static_cast<std::size_t>(i)].loose = true;
  }
}

}  // namespace differential
