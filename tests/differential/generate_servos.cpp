#include <algorithm>

#include "generate_parts.hpp"

namespace differential {

namespace {

/// The bodies whose joints have one coordinate.
std::vector<int> joints_of_one(const Scene& scene, bool only_driven) {
  std::vector<int> result;
  for (int i = 0; i < static_cast<int>(scene.bodies.size()); ++i) {
    const Body& body = scene.bodies[static_cast<std::size_t>(i)];
    const bool has_one = kreisel::joint_type(body.kind).rate_count() == 1;
    const bool is_free = !body.hold && !body.drive;
    if (has_one && !body.rotor && !body.loose && (is_free || !only_driven)) result.push_back(i);
  }
  return result;
}

std::vector<int> bodies_with_mass(const Scene& scene) {
  std::vector<int> result;
  for (int i = 0; i < static_cast<int>(scene.bodies.size()); ++i) {
    const Body& body = scene.bodies[static_cast<std::size_t>(i)];
    if (body.mass > 0 && !body.rotor) result.push_back(i);
  }
  return result;
}

/// The ropes that a servo may pay out: a damped one needs the rate of its length.
std::vector<int> winches(const Scene& scene, bool is_sampled) {
  std::vector<int> result;
  for (int i = 0; i < static_cast<int>(scene.elements.size()); ++i) {
    const Element& element = scene.elements[static_cast<std::size_t>(i)];
    const bool has_rate = is_sampled || element.damping == 0;
    if (element.kind == ElementKind::rope && has_rate) result.push_back(i);
  }
  return result;
}

Servo servo(Random& r, double duration) {
  Servo result;
  result.reads_rate = r.chance(0.3);
  if (r.chance(0.8)) result.proportional = sign(r) * r.pick({0.1, 1.0, 10.0});
  if (r.chance(0.5)) result.integral = r.pick({0.1, 1.0});
  if (r.chance(0.4)) result.derivative = r.pick({0.1, 1.0});
  if (result.proportional == 0 && result.derivative == 0) result.integral = 1;
  if (r.chance(0.6)) result.period = duration / r.pick({8.0, 30.0, 100.0});
  const bool filters = result.period == 0 || r.chance(0.5);
  if (filters && result.derivative != 0) result.filter = r.pick({0.01, 0.1, 1.0});
  if (r.chance(0.3)) result.reference = r.pick({0.1, 1.0});
  if (r.chance(0.2)) result.limit = r.pick({0.1, 1.0, 10.0});
  if (result.period > 0 && r.chance(0.4)) result.delay = result.period * r.pick({0.4, 1.0, 2.5});
  return result;
}

}  // namespace

void add_servos(Random& r, Scene& scene) {
  const double duration = scene.t_end - scene.t_begin;
  const bool has_rope = !winches(scene, true).empty();
  // Samples jump within the periods of increments, which the check of increments does not expect.
  const bool integrates = std::any_of(scene.sensors.begin(), scene.sensors.end(),
                                      [](const Sensor& s) { return !s.increments.empty(); });
  const std::vector<int> driven = joints_of_one(scene, true);
  const double seldom = has_rope ? 0.5 : 0.85;
  if (r.chance(seldom) || driven.empty() || integrates || duration > 20) return;
  do {
    Servo result = servo(r, duration);
    result.drives = driven[static_cast<std::size_t>(r.below(static_cast<int>(driven.size())))];
    const std::vector<int> read = joints_of_one(scene, false);
    const std::vector<int> loaded = bodies_with_mass(scene);
    if (!loaded.empty() && r.chance(0.3)) {
      result.drives = loaded[static_cast<std::size_t>(r.below(static_cast<int>(loaded.size())))];
      result.load = r.below(6);
    }
    result.reads = r.chance(0.7) && result.load < 0
                       ? result.drives
                       : read[static_cast<std::size_t>(r.below(static_cast<int>(read.size())))];
    const std::vector<int> ropes = winches(scene, result.period > 0);
    if (!ropes.empty() && r.chance(0.7)) {
      result.load = -1;
      result.rope = ropes[static_cast<std::size_t>(r.below(static_cast<int>(ropes.size())))];
      const double length = scene.elements[static_cast<std::size_t>(result.rope)].length;
      result.limit = r.pick({0.1, 0.4}) * length;  // lengths stay above 0
    }
    scene.servos.push_back(result);
  } while (r.chance(0.3));
}

}  // namespace differential
