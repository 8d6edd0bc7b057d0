#include <fmt/core.h>

#include <numeric>

#include "reference.hpp"
#include "toml.hpp"

namespace differential {

namespace {

std::string joint(const Body& body) {
  using Axis = kreisel::JointType::Axis;
  const kreisel::JointType& type = kreisel::joint_type(body.kind);
  Inline table;
  table.add("kind", "\"" + type.name + "\"");
  if (type.axis == Axis::required) table.add("axis", list(body.axis));
  if (type.second_axis != Axis::none) table.add_vector("second_axis", body.second_axis);
  if (type.has_pitch) table.add("pitch", text(body.pitch));
  table.add_vector("position", body.position);
  if (body.orientation) table.add("orientation", list(*body.orientation));
  return table.text();
}

/// The next numbers of a list, or none if there are too few.
template <class T>
std::vector<T> taken(const std::vector<T>& list, std::ptrdiff_t& at, int count) {
  if (static_cast<std::ptrdiff_t>(list.size()) < at + count) return {};
  const auto begin = list.begin() + at;
  at += count;
  return {begin, begin + count};
}

void add_single_coordinates(Inline& table, const Body& body) {
  const kreisel::JointType& type = kreisel::joint_type(body.kind);
  std::ptrdiff_t angle = 0;
  std::ptrdiff_t displacement = 0;
  std::ptrdiff_t rate = 0;
  for (const auto& quantity : type.coordinates) {
    if (quantity.unit == "m") {
      const auto values = taken(body.displacement, displacement, quantity.count());
      if (!values.empty()) table.add(quantity.key, one_or_list(values));
    } else {
      const auto values = taken(body.angle, angle, quantity.count());
      if (body.has_units && values.size() == 1) {
        const Angle& only = values.front();
        table.add(quantity.key, with_unit(only.value, only.degrees ? "deg" : "rad"));
      } else {
        add_angles(table, quantity.key, values);
      }
    }
  }
  for (const auto& quantity : type.rates) {
    add_angles(table, quantity.key, taken(body.rate, rate, quantity.count()));
  }
}

/// The start values that the motion of a drive does not give.
std::string initial(Body body) {
  if (!body.motion.empty()) body.rate.clear();
  if (!body.motion.empty() && !body.is_rate) body.angle.clear();
  Inline table;
  if (single_coordinates(body.kind) > 0) add_single_coordinates(table, body);
  if (body.rotor && body.rotor->speed_is_initial) add_angles(table, "rate", {body.rotor->speed});
  if (body.attitude) table.add("attitude", list(*body.attitude));
  table.add_vector(angle_key("angular_velocity", body.turns_in_degrees), body.angular_velocity);
  if (body.place) table.add("position", list(*body.place));
  table.add_vector("velocity", body.velocity);
  return table.empty() ? "" : "initial = " + table.text() + "\n";
}

std::string forces(const Body& body) {
  std::string result;
  if (!body.stiffness.empty()) {
    Inline spring;
    spring.add("stiffness", one_or_list(body.stiffness));
    add_angles(spring, "rest", body.rest);
    result += "spring = " + spring.text() + "\n";
  }
  if (!body.damping.empty()) result += "damping = " + one_or_list(body.damping) + "\n";
  if (!body.force_in_time.empty()) {
    result += "force = " + number_signal(body.force_in_time) + "\n";
  } else if (!body.force.empty()) {
    result += "force = " + one_or_list(body.force) + "\n";
  }
  return result;
}

std::string rotor(const Rotor& rotor) {
  static const char* const modes[] = {"free", "regulated", "torque"};
  Inline table;
  table.add("mode", std::string("\"") + modes[static_cast<int>(rotor.mode)] + "\"");
  if (!rotor.speed_is_initial) add_angles(table, "speed", {rotor.speed});
  if (rotor.mode == RotorMode::torque) {
    const bool is_timed = !rotor.torque_in_time.empty();
    table.add("torque", is_timed ? number_signal(rotor.torque_in_time) : text(rotor.torque));
  }
  return "rotor = " + table.text() + "\n";
}

/// A diagonal as 3 rows.
std::string rows(const Vector& v) {
  return fmt::format("[{}, {}, {}]", list(Vector(v.x(), 0, 0)), list(Vector(0, v.y(), 0)),
                     list(Vector(0, 0, v.z())));
}

std::string drag(const Load& load) {
  Inline table;
  table.add("kind", "\"drag\"");
  table.add("linear", list(load.linear));
  table.add("quadratic", rows(load.quadratic));
  table.add_vector("angular", load.angular);
  table.add_vector("point", load.point);
  return table.text();
}

std::string magnet(const Load& load) {
  Inline table;
  table.add("kind", "\"magnet\"");
  table.add("moment", list(load.moment));
  table.add("field", vector_signal(load.field));
  return table.text();
}

std::string given(const Load& load) {
  static const char* const axes[] = {"body", "guide", "inertial"};
  Inline table;
  const bool is_timed = !load.force_in_time.empty();
  table.add("force", is_timed ? vector_signal(load.force_in_time) : list(load.force));
  table.add_vector("torque", load.torque);
  table.add_vector("point", load.point);
  table.add("axes", std::string("\"") + axes[static_cast<int>(load.axes)] + "\"");
  return table.text();
}

std::string loads(const Body& body) {
  std::string all;
  for (const Load& load : body.loads) {
    all += (all.empty() ? "" : ", ") + (load.kind == LoadKind::drag     ? drag(load)
                                        : load.kind == LoadKind::magnet ? magnet(load)
                                                                        : given(load));
  }
  if (all.empty()) return {};
  return "load = " + (body.loads.size() == 1 ? all : "[" + all + "]") + "\n";
}

std::string points(const Scene& scene, int body) {
  Inline table;
  for (std::size_t i = 0; i < scene.sensors.size(); ++i) {
    const Sensor& sensor = scene.sensors[i];
    if (sensor.body == body && sensor.at_by_name) table.add(fmt::format("p{}", i), list(sensor.at));
  }
  return table.empty() ? "" : "points = " + table.text() + "\n";
}

/// The start of a loose body, from its values in a free joint to the guide.
std::string loose_start(const Scene& scene, int index) {
  const std::vector<int> counts =
      blocks({.bodies = {scene.bodies.begin(), scene.bodies.begin() + index}});
  const JointValues all = start_values(scene);
  const double* const x = all.data() + std::accumulate(counts.begin(), counts.end(), 0);
  Inline table;
  table.add("attitude", list(std::vector<double>{x[3], x[0], x[1], x[2]}));
  table.add("position", list(std::vector<double>(x + 4, x + 7)));
  table.add("angular_velocity", list(std::vector<double>(x + 7, x + 10)));
  table.add("velocity", list(std::vector<double>(x + 10, x + 13)));
  return "initial = " + table.text() + "\n";
}

}  // namespace

std::string body(const Scene& scene, int index) {
  const Body& b = scene.bodies[static_cast<std::size_t>(index)];
  std::string result = "[[body]]\nname = \"" + body_name(index) + "\"\n";
  if (b.parent >= 0 && !b.loose) result += "parent = \"" + body_name(b.parent) + "\"\n";
  result += "joint = " + (b.loose ? "{ kind = \"free\" }" : joint(b)) + "\n";
  const bool off_centre = !b.centre.isZero(0);
  if (b.has_units) {
    result += "mass = " + with_unit(b.mass, "kg") + "\n";
    if (off_centre) result += "centre = " + list_with_unit(b.centre, "m") + "\n";
    result += "inertia = " + list_with_unit(b.inertia, "kg m^2") + "\n";
  } else {
    result += "mass = " + text(b.mass) + "\n";
    if (off_centre) result += "centre = " + list(b.centre) + "\n";
    result += "inertia = " + list(b.inertia) + "\n";
  }
  result += b.loose ? loose_start(scene, index) : initial(b) + forces(b);
  if (b.rotor) result += rotor(*b.rotor);
  if (b.drive && b.motion.empty()) result += "drive = \"constant-rate\"\n";
  if (!b.motion.empty()) {
    result += fmt::format("drive = {{ {} = {} }}\n", b.is_rate ? "rate" : "angle",
                          number_signal(b.motion));
  }
  if (b.hold) result += "hold = true\n";
  result += points(scene, index);
  return result + loads(b);
}

}  // namespace differential
