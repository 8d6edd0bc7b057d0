#include <algorithm>

#include "generate_parts.hpp"
#include "reference.hpp"

namespace differential {

namespace {

/// A number of an element's tensor.
double stiffness(Random& r) { return r.pick({1.0, 10.0, 30.0, 100.0, 1e3}); }

Eigen::Matrix3d diagonal(Random& r) {
  return Vector(stiffness(r), stiffness(r), stiffness(r)).asDiagonal();
}

/// A spring whose ends are off all axes, so that no motion about an axis lets them meet.
Element spring(Random& r) {
  Element result;
  result.at = {vector(r, 0.1, 2), vector(r, 0.1, 2)};
  for (double& x : result.at[1]) x += sign(r) * rounded(r.between(0.05, 0.1), 3);
  if (r.chance(0.2)) {
    result.table = {{0, -10}, {1, 0}, {2, 30}};
    if (r.chance(0.5)) result.table = {{0, -100}, {0.3, 0}, {5, 0}, {5.5, 200}};  // two stops
  } else {
    result.stiffness = stiffness(r);
    if (r.chance(0.6)) result.length = plain(r, 0.1, 2);
  }
  if (r.chance(0.4)) result.damping = r.pick({0.1, 1.0, 10.0});
  return result;
}

/// A mount; tensors that depend on the rotation only sometimes, as it must stay below 3 rad.
Element mount(Random& r) {
  Element result{.kind = ElementKind::mount};
  result.at = {vector(r, 0.1, 2), vector(r, 0.1, 2)};
  if (r.chance(0.4)) result.axes = attitude(r);
  result.linear = diagonal(r);
  if (r.chance(0.3)) {
    const double across = r.pick({0.5, 3.0});
    result.linear(0, 1) = across;
    result.linear(1, 0) = r.chance(0.5) ? -across : across;
  }
  if (r.chance(0.4)) {
    result.turning = diagonal(r);
    if (r.chance(0.5)) result.coupling = Vector(0.3, 0.1, -0.2).asDiagonal();
    if (r.chance(0.3)) result.torque = vector(r, 0.1, 2);
  }
  if (r.chance(0.5)) result.linear_damping = Vector(1, 0.5, 2) * r.pick({0.1, 1.0});
  if (r.chance(0.3)) result.turning_damping = Vector(0.2, 0.1, 0.5);
  if (r.chance(0.3)) result.force = vector(r, 0.1, 10);
  return result;
}

/// The length of a rope on a winch, without jumps: a broken line or smooth.
Signal winch(Random& r, double length) {
  const auto along = [&r] { return Vector(sign(r) * Vector::UnitX()); };
  Signal s = any_signal(r, 0.3, along);
  if (s.jumps.times.empty()) s.series.constant = Vector(length, 0, 0);
  for (Vector& v : s.jumps.values) v.x() = std::max(v.x() + length, 0.05);
  s.jumps.is_broken_line = !s.jumps.times.empty();
  return s;
}

/// A rope that is slack or taut at the start.
Element rope(Random& r) {
  Element result{.kind = ElementKind::rope};
  result.at = {vector(r, 0.1, 2), vector(r, 0.1, 2)};
  for (double& x : result.at[1]) x += sign(r) * rounded(r.between(0.05, 0.1), 3);
  result.stiffness = stiffness(r);
  result.length = plain(r, 0.1, 2);
  if (r.chance(0.6)) result.damping = r.pick({0.1, 1.0, 10.0});
  if (r.chance(0.6)) result.length_in_time = winch(r, result.length);
  return result;
}

Element gear(Random& r) {
  Element result{.kind = ElementKind::gear};
  result.stiffness = stiffness(r);
  if (r.chance(0.4)) result.damping = r.pick({0.1, 1.0});
  if (r.chance(0.7)) result.ratio = sign(r) * r.pick({0.5, 2.0, 3.0});
  return result;
}

/// The bodies that an element of this kind may join. Rotors take none.
std::vector<int> joinable(const Scene& scene, ElementKind kind) {
  std::vector<int> result;
  for (int i = 0; i < static_cast<int>(scene.bodies.size()); ++i) {
    const Body& body = scene.bodies[static_cast<std::size_t>(i)];
    const bool has_one = kreisel::joint_type(body.kind).rate_count() == 1;
    if (!body.rotor && (has_one || kind != ElementKind::gear)) result.push_back(i);
  }
  if (kind != ElementKind::gear) result.push_back(guide_frame);
  return result;
}

}  // namespace

void add_elements(Random& r, Scene& scene) {
  if (r.chance(0.7)) return;
  do {
    const double u = r.uniform();
    Element element = u < 0.3 ? spring(r) : u < 0.55 ? rope(r) : u < 0.75 ? mount(r) : gear(r);
    const std::vector<int> all = joinable(scene, element.kind);
    if (all.size() < 2) return;
    const int first = r.below(static_cast<int>(all.size()));
    const int second =
        (first + 1 + r.below(static_cast<int>(all.size()) - 1)) % static_cast<int>(all.size());
    element.bodies = {all[static_cast<std::size_t>(first)], all[static_cast<std::size_t>(second)]};
    scene.elements.push_back(element);
    if (!last_element_works(scene)) {
      scene.elements.pop_back();
    } else if (r.chance(0.5)) {
      scene.sensors.push_back(sensor_of_element(r, scene));
    }
  } while (r.chance(0.4));
}

}  // namespace differential
