#include "shrink.hpp"

#include <chrono>
#include <cmath>
#include <vector>

namespace differential {

namespace {

using Change = std::function<void(Scene&)>;

void for_each(Vector& v, const std::function<void(double&)>& f) {
  for (double& x : v) f(x);
}

void for_each(Series& s, const std::function<void(double&)>& f) {
  for_each(s.constant, f);
  for (Series::Term& term : s.terms) {
    for_each(term.amplitude, f);
    f(term.frequency.value);
    f(term.phase.value);
  }
}

void for_each(Body& body, const std::function<void(double&)>& f) {
  for (Vector* const v : {&body.axis, &body.second_axis, &body.position, &body.centre,
                          &body.angular_velocity, &body.velocity}) {
    for_each(*v, f);
  }
  f(body.mass);
  for (auto* const list :
       {&body.displacement, &body.inertia, &body.stiffness, &body.damping, &body.force}) {
    for (double& x : *list) f(x);
  }
  for (auto* const list : {&body.angle, &body.rate, &body.rest}) {
    for (Angle& angle : *list) f(angle.value);
  }
  if (body.place) for_each(*body.place, f);
  if (body.rotor) f(body.rotor->speed.value);
  if (body.rotor) f(body.rotor->torque);
  for (Load& load : body.loads) {
    for (Vector* const v : {&load.force, &load.torque, &load.point, &load.linear, &load.quadratic,
                            &load.angular, &load.moment}) {
      for_each(*v, f);
    }
  }
}

void for_each(Element& element, const std::function<void(double&)>& f) {
  for (Vector* const v : {&element.at[0], &element.at[1], &element.linear_damping,
                          &element.turning_damping, &element.force, &element.torque}) {
    for_each(*v, f);
  }
  for (auto* const m : {&element.linear, &element.turning, &element.coupling}) {
    for (double& x : m->reshaped()) f(x);
  }
  for (double* const x : {&element.stiffness, &element.damping, &element.length, &element.ratio}) {
    f(*x);
  }
}

/// Calls f with every number of the scene.
void for_each_number(Scene& scene, const std::function<void(double&)>& f) {
  for (Link& link : scene.guide) {
    for_each(link.angular_velocity, f);
    for_each(link.origin_acceleration, f);
    for_each(link.turning, f);
    for_each(link.pushing, f);
    for_each(link.origin_position, f);
    for_each(link.origin_velocity, f);
    f(link.latitude);
    f(link.height);
    f(link.azimuth);
  }
  for_each(scene.gravity_vector, f);
  for (Body& body : scene.bodies) for_each(body, f);
  for (Element& element : scene.elements) for_each(element, f);
  for (Sensor& sensor : scene.sensors) for_each(sensor.at, f);
  f(scene.t_end);
}

double rounded(double x, int digits) {
  if (x == 0) return 0;
  const double unit = std::pow(10, std::floor(std::log10(std::abs(x))) - digits + 1);
  return unit < 1 ? std::round(x / unit) / std::round(1 / unit) : std::round(x / unit) * unit;
}

/// Removes an element, the sensors that read it and the servos that drive it.
void drop_element(Scene& scene, std::size_t index) {
  const int dropped = static_cast<int>(index);
  scene.elements.erase(scene.elements.begin() + dropped);
  std::erase_if(scene.sensors,
                [dropped](const Sensor& sensor) { return sensor.element == dropped; });
  for (Sensor& sensor : scene.sensors) sensor.element -= sensor.element > dropped ? 1 : 0;
  std::erase_if(scene.servos, [dropped](const Servo& servo) { return servo.rope == dropped; });
  for (Servo& servo : scene.servos) servo.rope -= servo.rope > dropped ? 1 : 0;
}

/// Removes a constraint and the sensors that read it.
void drop_constraint(Scene& scene, std::size_t index) {
  const int dropped = static_cast<int>(index);
  scene.constraints.erase(scene.constraints.begin() + dropped);
  std::erase_if(scene.sensors,
                [dropped](const Sensor& sensor) { return sensor.constraint == dropped; });
  for (Sensor& sensor : scene.sensors) sensor.constraint -= sensor.constraint > dropped ? 1 : 0;
}

/// Removes a body that carries no other.
void drop_body(Scene& scene, std::size_t index) {
  for (const Body& body : scene.bodies) {
    if (body.parent == static_cast<int>(index)) return;
  }
  if (scene.bodies.size() == 1) return;
  const int dropped = static_cast<int>(index);
  for (std::size_t i = scene.elements.size(); i-- > 0;) {
    const auto& ends = scene.elements[i].bodies;
    if (ends[0] == dropped || ends[1] == dropped) drop_element(scene, i);
  }
  for (std::size_t i = scene.constraints.size(); i-- > 0;) {
    const auto& ends = scene.constraints[i].bodies;
    if (ends[0] == dropped || ends[1] == dropped) drop_constraint(scene, i);
  }
  scene.bodies.erase(scene.bodies.begin() + static_cast<std::ptrdiff_t>(index));
  const auto move_up = [dropped](int& body) { body -= body > dropped ? 1 : 0; };
  for (Body& body : scene.bodies) move_up(body.parent);
  std::erase_if(scene.sensors, [dropped](const Sensor& sensor) {
    return sensor.body == dropped || sensor.against == dropped || sensor.on == dropped;
  });
  for (Sensor& sensor : scene.sensors) {
    for (int* const body : {&sensor.body, &sensor.against, &sensor.on}) move_up(*body);
  }
  for (Element& element : scene.elements) {
    for (int& body : element.bodies) move_up(body);
  }
  std::erase_if(scene.servos, [dropped](const Servo& servo) {
    return servo.reads == dropped || servo.drives == dropped;
  });
  for (Servo& servo : scene.servos) {
    for (int* const body : {&servo.reads, &servo.drives}) move_up(*body);
  }
  for (Constraint& constraint : scene.constraints) {
    for (int& body : constraint.bodies) move_up(body);
  }
}

void add_guide_changes(const Scene& scene, std::vector<Change>& changes) {
  changes.emplace_back([](Scene& s) { s.title.clear(), s.chain_in_chain = false; });
  changes.emplace_back([](Scene& s) { s.model.clear(), s.method.clear(), s.reports = false; });
  changes.emplace_back([](Scene& s) { s.guide.clear(); });
  changes.emplace_back([](Scene& s) { s.gravity = GravityKind::not_given; });
  changes.emplace_back([](Scene& s) { s.gradient.reset(); });
  changes.emplace_back([](Scene& s) { s.pole = Vector::UnitZ(); });
  for (std::size_t i = 0; i < scene.guide.size(); ++i) {
    changes.emplace_back(
        [i](Scene& s) { s.guide.erase(s.guide.begin() + static_cast<std::ptrdiff_t>(i)); });
    changes.emplace_back([i](Scene& s) { s.guide[i].turning = {}; });
    changes.emplace_back([i](Scene& s) { s.guide[i].orbit.eccentricity = 0; });
    changes.emplace_back([i](Scene& s) { s.guide[i].orbit.j2 = false; });
    changes.emplace_back([i](Scene& s) { s.guide[i].vehicle.turn_rate = {}; });
    changes.emplace_back([i](Scene& s) { s.guide[i].vehicle.acceleration = {}; });
    changes.emplace_back([i](Scene& s) { s.guide[i].vehicle.climb = {}; });
    changes.emplace_back([i](Scene& s) { s.guide[i].vehicle.bank = {}; });
    changes.emplace_back([i](Scene& s) { s.guide[i].vehicle.speed = 0; });
    changes.emplace_back([i](Scene& s) { s.guide[i].pushing = {}; });
    changes.emplace_back([i](Scene& s) { s.guide[i].position = {}; });
    changes.emplace_back([i](Scene& s) { s.guide[i].angles = {}; });
    changes.emplace_back([i](Scene& s) { s.guide[i].rate.reset(); });
    changes.emplace_back([i](Scene& s) { s.guide[i].attitude.reset(); });
    changes.emplace_back([i](Scene& s) { s.guide[i].turns_in_degrees = false; });
    changes.emplace_back([i](Scene& s) { s.guide[i].log.spelling = {}; });
    changes.emplace_back([i](Scene& s) { s.guide[i].log.from.reset(); });
    changes.emplace_back([i](Scene& s) { s.guide[i].log.shift.setZero(); });
    for (std::size_t k = 0; k < scene.guide[i].turning.terms.size(); ++k) {
      changes.emplace_back([i, k](Scene& s) {
        auto& terms = s.guide[i].turning.terms;
        terms.erase(terms.begin() + static_cast<std::ptrdiff_t>(k));
      });
    }
  }
}

void add_body_changes(std::size_t i, std::vector<Change>& changes) {
  const auto add = [&changes, i](const std::function<void(Body&)>& change) {
    changes.emplace_back([i, change](Scene& s) { change(s.bodies[i]); });
  };
  changes.emplace_back([i](Scene& s) { drop_body(s, i); });
  add([](Body& b) { b.parent = -1; });
  add([](Body& b) { b.has_units = false; });
  add([](Body& b) {
    b.force_in_time.file.clear(), b.motion.file.clear();
    for (Load& load : b.loads) load.force_in_time.file.clear(), load.field.file.clear();
  });
  add([](Body& b) { b.orientation.reset(); });
  add([](Body& b) { b.loads.clear(); });
  add([](Body& b) {
    if (!b.loads.empty()) b.loads.pop_back();
  });
  add([](Body& b) { b.stiffness.clear(), b.rest.clear(); });
  add([](Body& b) { b.rest.clear(); });
  add([](Body& b) { b.damping.clear(); });
  add([](Body& b) { b.force.clear(); });
  add([](Body& b) { b.force_in_time = {}; });
  add([](Body& b) {
    for (Load& load : b.loads) load.force_in_time = {};
  });
  add([](Body& b) {
    if (b.rotor) b.rotor->torque_in_time = {};
  });
  add([](Body& b) { b.rotor.reset(); });
  add([](Body& b) { b.motion = {}; });
  add([](Body& b) { b.drive = false, b.motion = {}; });
  add([](Body& b) { b.hold = false; });
  add([](Body& b) { b.loose = false; });
  add([](Body& b) { b.angle.clear(), b.displacement.clear(); });
  add([](Body& b) { b.rate.clear(); });
  add([](Body& b) { b.attitude.reset(); });
  add([](Body& b) { b.place.reset(); });
  add([](Body& b) { b.inertia = {1, 1, 1}; });
  add([](Body& b) { b.inertia.resize(3); });
  add([](Body& b) { b.centre.setZero(); });
  add([](Body& b) { b.position.setZero(); });
  add([](Body& b) { b.kind = JointKind::spherical, b.drive = false, b.motion = {}; });
  add([](Body& b) { b.angular_velocity.setZero(), b.velocity.setZero(); });
}

void add_number_changes(Scene scene, std::vector<Change>& changes) {
  int count = 0;
  for_each_number(scene, [&count](double& x) { count += std::isfinite(x) ? 1 : 0; });
  for (int i = 0; i < count; ++i) {
    const auto add = [&changes, i](const std::function<double(double)>& change) {
      changes.emplace_back([i, change](Scene& s) {
        int k = 0;
        for_each_number(s, [&](double& x) {
          if (k++ == i) x = change(x);
        });
      });
    };
    add([](double) { return 0.0; });
    add([](double x) { return x == 0 ? 0.0 : 1.0; });
    add([](double x) { return rounded(x, 1); });
    add([](double x) { return rounded(x, 2); });
  }
}

std::vector<Change> changes_of(const Scene& scene) {
  std::vector<Change> changes;
  add_guide_changes(scene, changes);
  for (std::size_t i = scene.bodies.size(); i-- > 0;) add_body_changes(i, changes);
  for (std::size_t i = 0; i < scene.elements.size(); ++i) {
    changes.emplace_back([i](Scene& s) { drop_element(s, i); });
    changes.emplace_back(
        [i](Scene& s) { s.elements[i].axes.reset(), s.elements[i].table.clear(); });
    changes.emplace_back([i](Scene& s) { s.elements[i].length_in_time = {}; });
  }
  for (std::size_t i = 0; i < scene.constraints.size(); ++i) {
    changes.emplace_back([i](Scene& s) { drop_constraint(s, i); });
  }
  for (std::size_t i = 0; i < scene.sensors.size(); ++i) {
    changes.emplace_back(
        [i](Scene& s) { s.sensors.erase(s.sensors.begin() + static_cast<std::ptrdiff_t>(i)); });
    changes.emplace_back(
        [i](Scene& s) { s.sensors[i].axes.reset(), s.sensors[i].at_by_name = false; });
    changes.emplace_back([i](Scene& s) { s.sensors[i].errors.reset(); });
  }
  for (std::size_t i = 0; i < scene.servos.size(); ++i) {
    changes.emplace_back(
        [i](Scene& s) { s.servos.erase(s.servos.begin() + static_cast<std::ptrdiff_t>(i)); });
    for (double Servo::*const part : {&Servo::integral, &Servo::derivative, &Servo::reference,
                                      &Servo::limit, &Servo::period, &Servo::delay}) {
      changes.emplace_back([i, part](Scene& s) { s.servos[i].*part = 0; });
    }
  }
  changes.emplace_back([](Scene& s) { s.outputs = 1; });
  changes.emplace_back([](Scene& s) { s.tolerance = 1e-10; });
  for (const double factor : {0.1, 0.5}) {
    changes.emplace_back(
        [factor](Scene& s) { s.t_end = s.t_begin + factor * (s.t_end - s.t_begin); });
  }
  add_number_changes(scene, changes);
  return changes;
}

}  // namespace

Scene shrink(Scene scene, const std::function<bool(const Scene&)>& fails, double seconds) {
  using Clock = std::chrono::steady_clock;
  const auto end = Clock::now() + std::chrono::duration<double>(seconds);
  for (bool smaller = true; smaller;) {
    smaller = false;
    std::vector<Change> changes = changes_of(scene);
    for (std::size_t i = 0; i < changes.size(); ++i) {
      if (Clock::now() > end) return scene;
      Scene tried = scene;
      changes[i](tried);
      const std::string before = to_toml(scene);
      const std::string after = to_toml(tried);
      if (after == before || after.size() > before.size() || !fails(tried)) continue;
      scene = std::move(tried);
      changes = changes_of(scene);  // the next changes have the same index or a smaller one
      smaller = true;
    }
  }
  return scene;
}

}  // namespace differential
