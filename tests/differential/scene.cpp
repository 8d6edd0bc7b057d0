#include "scene.hpp"

#include <Eigen/Geometry>
#include <fmt/core.h>

#include <algorithm>
#include <fstream>
#include <functional>
#include <numeric>

#include "reference.hpp"
#include "reference_guide.hpp"

namespace differential {

namespace {

constexpr double degree = 3.14159265358979323846 / 180;

/// A single number, or a list of several.
std::string one_or_list(const std::vector<double>& numbers) {
  return numbers.size() == 1 ? text(numbers.front()) : list(numbers);
}

/// A number as a text with a unit.
std::string with_unit(double x, const std::string& unit) {
  return "\"" + text(x) + " " + unit + "\"";
}

template <class Numbers>
std::string list_with_unit(const Numbers& numbers, const std::string& unit) {
  std::string result;
  for (const double x : numbers) result += (result.empty() ? "" : ", ") + with_unit(x, unit);
  return "[" + result + "]";
}

/// Writes `key = value` for values that exist, with commas between.
class Inline {
 public:
  void add(const std::string& key, const std::string& value) {
    inside_ += (inside_.empty() ? "" : ", ") + key + " = " + value;
  }
  void add_vector(const std::string& key, const Vector& v) {
    if (!v.isZero(0)) add(key, list(v));
  }
  [[nodiscard]] bool empty() const { return inside_.empty(); }
  [[nodiscard]] std::string text() const { return "{ " + inside_ + " }"; }

 private:
  std::string inside_;
};

/// The key of an angle in the file.
std::string angle_key(const std::string& key, bool degrees) { return degrees ? key + "_deg" : key; }

void add_angles(Inline& table, const std::string& key, const std::vector<Angle>& angles) {
  if (angles.empty()) return;
  std::vector<double> values;
  for (const Angle& angle : angles) {
    values.push_back(angles.front().degrees == angle.degrees ? angle.value : angle.radian());
  }
  table.add(angle_key(key, angles.front().degrees), one_or_list(values));
}

std::string series(const Series& s) {
  Inline table;
  table.add_vector("constant", s.constant);
  std::string terms;
  for (const Series::Term& term : s.terms) {
    Inline one;
    one.add("amplitude", list(term.amplitude));
    add_angles(one, "frequency", {term.frequency});
    add_angles(one, "phase", {term.phase});
    terms += (terms.empty() ? "" : ", ") + one.text();
  }
  if (!terms.empty() || table.empty()) table.add("terms", "[" + terms + "]");
  return table.text();
}

/// Writes a signal; numbers for which the x component alone counts are written by `value`.
std::string signal(const Signal& s, const std::function<std::string(const Vector&)>& value) {
  Inline table;
  if (!s.file.empty()) {
    table.add("file", "\"" + s.file + "\"");
    return table.text();
  }
  std::string pairs;
  for (std::size_t i = 0; i < s.jumps.times.size(); ++i) {
    pairs += (pairs.empty() ? "[" : ", [") + text(s.jumps.times[i]) + ", " +
             value(s.jumps.values[i]) + "]";
  }
  if (!pairs.empty()) {
    table.add(s.jumps.is_broken_line ? "points" : "steps", "[" + pairs + "]");
    return table.text();
  }
  table.add("constant", value(s.series.constant));
  if (!s.rate.isZero(0)) table.add("rate", value(s.rate));
  std::string terms;
  for (const Series::Term& term : s.series.terms) {
    Inline one;
    one.add("amplitude", value(term.amplitude));
    add_angles(one, "frequency", {term.frequency});
    add_angles(one, "phase", {term.phase});
    terms += (terms.empty() ? "" : ", ") + one.text();
  }
  if (!terms.empty()) table.add("terms", "[" + terms + "]");
  return table.text();
}

std::string vector_signal(const Signal& s) {
  return signal(s, [](const Vector& v) { return list(v); });
}

std::string number_signal(const Signal& s) {
  return signal(s, [](const Vector& v) { return text(v.x()); });
}

std::string angles(const std::array<Signal, 3>& signals) {
  Inline table;
  static const char* const names[] = {"yaw", "pitch", "roll"};
  for (std::size_t i = 0; i < 3; ++i) {
    if (!signals[i].empty()) table.add(names[i], number_signal(signals[i]));
  }
  return table.text();
}

std::string log_name(std::size_t link) { return fmt::format("log{}.csv", link); }

/// The motion of a frame by its rates.
Keys moving_keys(const Link& link, const char* kind, const std::string& turning,
                 const std::string& pushing) {
  Keys result{{"kind", kind},
              {angle_key("angular_velocity", link.turns_in_degrees), turning},
              {"origin_acceleration", pushing}};
  if (link.attitude) result.emplace_back("attitude", list(*link.attitude));
  const auto add = [&result](const char* key, const Vector& v) {
    if (!v.isZero(0)) result.emplace_back(key, list(v));
  };
  add("origin_position", link.origin_position);
  add("origin_velocity", link.origin_velocity);
  return result;
}

Keys orbit_keys(const Orbit& orbit) {
  Keys result{{"kind", "\"orbit\""}, {"semi_major_axis", text(orbit.semi_major_axis)}};
  const auto add = [&result](const char* key, const Angle& angle) {
    result.emplace_back(angle_key(key, angle.degrees), text(angle.value));
  };
  if (orbit.eccentricity != 0) result.emplace_back("eccentricity", text(orbit.eccentricity));
  add("inclination", orbit.inclination);
  add("node", orbit.node);
  add("perigee", orbit.perigee);
  add("anomaly", orbit.anomaly);
  result.emplace_back("mu", "3.986004418e14");
  if (orbit.j2) result.emplace_back("j2", "true");
  return result;
}

Keys course_keys(const Link& link) {
  const Vehicle& vehicle = link.vehicle;
  Keys result{
      {"kind", "\"course\""}, {"height", text(vehicle.height)}, {"speed", text(vehicle.speed)}};
  const auto add_angle = [&result](const char* key, const Angle& angle) {
    result.emplace_back(angle_key(key, angle.degrees), text(angle.value));
  };
  add_angle("latitude", vehicle.latitude);
  add_angle("longitude", vehicle.longitude);
  add_angle("heading", vehicle.heading);
  const auto add = [&result](const char* key, const Signal& s) {
    if (!s.empty()) result.emplace_back(key, number_signal(s));
  };
  add("turn_rate", vehicle.turn_rate);
  add("acceleration", vehicle.acceleration);
  add("climb", vehicle.climb);
  add("bank", vehicle.bank);
  if (!link.gravity.empty()) result.emplace_back("gravity", link.gravity);
  return result;
}

/// The keys of a guide frame.
Keys keys(const Link& link, std::size_t index, double t_end) {
  switch (link.kind) {
    case LinkKind::inertial: return {{"kind", "\"inertial\""}};
    case LinkKind::rotating:
      return moving_keys(link, "\"rotating\"", list(link.angular_velocity),
                         list(link.origin_acceleration));
    case LinkKind::harmonic:
      return moving_keys(link, "\"harmonic\"", series(link.turning), series(link.pushing));
    case LinkKind::table: return link.log.keys(log_name(index), t_end, false);
    case LinkKind::rates: return link.log.keys(log_name(index), t_end, true);
    case LinkKind::motion:
      return {{"kind", "\"motion\""},
              {"position", vector_signal(link.position)},
              {"angles", angles(link.angles)}};
    case LinkKind::orbit: return orbit_keys(link.orbit);
    case LinkKind::course: return course_keys(link);
    case LinkKind::earth: break;
  }
  Keys result{{"kind", "\"earth\""},
              {"latitude_deg", text(link.latitude)},
              {"height", text(link.height)},
              {"azimuth_deg", text(link.azimuth)}};
  if (link.rate) result.emplace_back(angle_key("rate", link.rate->degrees), text(link.rate->value));
  if (!link.gravity.empty()) result.emplace_back("gravity", link.gravity);
  return result;
}

std::string guide(const Scene& scene) {
  if (scene.guide.empty()) return {};
  std::string result = "[guide]\n";
  if (scene.guide.size() == 1) {
    for (const auto& [key, value] : keys(scene.guide.front(), 0, scene.t_end)) {
      result += key + " = " + value + "\n";
    }
    return result;
  }
  result += "kind = \"chain\"\nlinks = [\n";
  for (std::size_t i = 0; i < scene.guide.size(); ++i) {
    Inline table;
    for (const auto& [key, value] : keys(scene.guide[i], i, scene.t_end)) table.add(key, value);
    if (scene.chain_in_chain && i == 1) result += "  { kind = \"chain\", links = [\n";
    result += "  " + table.text() + ",\n";
  }
  return result + (scene.chain_in_chain ? "  ] },\n]\n" : "]\n");
}

std::string planet(const Scene& scene) {
  const bool oblate = scene.gravity == GravityKind::j2;
  std::string result = std::string("[gravity]\nkind = \"") + (oblate ? "j2" : "point") +
                       "\"\nmu = 3.986004418e14\ncentre = " + list(scene.gravity_vector) + "\n";
  if (!oblate) return result;
  return result + "j2 = 1.08262982131e-3\nradius = 6378137\npole = " + list(scene.pole) + "\n";
}

std::string gravity(const Scene& scene) {
  const std::string gradient =
      scene.gradient ? std::string("gradient = ") + (*scene.gradient ? "true\n" : "false\n") : "";
  switch (scene.gravity) {
    case GravityKind::not_given: return {};
    case GravityKind::none: return "[gravity]\nkind = \"none\"\n";
    case GravityKind::earth: return "[gravity]\nkind = \"earth\"\n";
    case GravityKind::earth_j2: return "[gravity]\nkind = \"earth\"\nfield = \"j2\"\n";
    case GravityKind::point:
    case GravityKind::j2: return planet(scene) + gradient;
    case GravityKind::orbit: return "[gravity]\nkind = \"orbit\"\n" + gradient;
    case GravityKind::uniform:
      return "[gravity]\nkind = \"uniform\"\nvector = " + list(scene.gravity_vector) + "\n";
    case GravityKind::inertial: break;
  }
  return "[gravity]\nkind = \"inertial\"\nvector = " + list(scene.gravity_vector) + "\n";
}

std::string body_name(int index) { return index < 0 ? "guide" : fmt::format("b{}", index); }

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
  return "[" + list(Vector(v.x(), 0, 0)) + ", " + list(Vector(0, v.y(), 0)) + ", " +
         list(Vector(0, 0, v.z())) + "]";
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

/// A matrix as its diagonal, if that is all, or as three rows.
std::string matrix(const Eigen::Matrix3d& m) {
  if (m.isDiagonal(0)) return list(Vector(m.diagonal()));
  std::string result;
  for (int i = 0; i < 3; ++i) {
    result += (i > 0 ? ", " : "") + list(Vector(m.row(i).transpose()));
  }
  return "[" + result + "]";
}

void add_mount(const Element& e, Keys& keys) {
  if (e.axes) keys.emplace_back("axes", list(*e.axes));
  keys.emplace_back("stiffness", matrix(e.linear));
  const auto add = [&keys](const char* key, const Eigen::Matrix3d& m) {
    if (!m.isZero(0)) keys.emplace_back(key, matrix(m));
  };
  add("turning_stiffness", e.turning);
  add("coupling", e.coupling);
  add("damping", e.linear_damping.asDiagonal().toDenseMatrix());
  add("turning_damping", e.turning_damping.asDiagonal().toDenseMatrix());
  if (e.force.isZero(0) && e.torque.isZero(0)) return;
  keys.emplace_back("preload", list(std::vector<double>{e.force.x(), e.force.y(), e.force.z(),
                                                        e.torque.x(), e.torque.y(), e.torque.z()}));
}

void add_spring(const Element& e, Keys& keys) {
  std::string table;
  for (const auto& [length, pull] : e.table) {
    table += (table.empty() ? "" : ", ") + list(std::vector<double>{length, pull});
  }
  if (!table.empty()) keys.emplace_back("table", "[" + table + "]");
  if (table.empty()) keys.emplace_back("stiffness", text(e.stiffness));
  if (e.length != 0 && table.empty()) keys.emplace_back("length", text(e.length));
  if (e.damping != 0) keys.emplace_back("damping", text(e.damping));
}

std::string element(const Element& e, std::size_t index) {
  static const char* const kinds[] = {"spring", "mount", "gear", "rope"};
  const std::string names =
      "[\"" + body_name(e.bodies[0]) + "\", \"" + body_name(e.bodies[1]) + "\"]";
  Keys keys{{"name", fmt::format("\"e{}\"", index)},
            {"kind", std::string("\"") + kinds[static_cast<int>(e.kind)] + "\""}};
  if (e.kind == ElementKind::gear) {
    keys.emplace_back("joints", names);
    keys.emplace_back("stiffness", text(e.stiffness));
    if (e.damping != 0) keys.emplace_back("damping", text(e.damping));
    if (e.ratio != 1) keys.emplace_back("ratio", text(e.ratio));
  } else {
    keys.emplace_back("between", names);
    if (!e.at[0].isZero(0) || !e.at[1].isZero(0)) {
      keys.emplace_back("at", "[" + list(e.at[0]) + ", " + list(e.at[1]) + "]");
    }
    if (e.kind == ElementKind::mount) add_mount(e, keys);
    if (e.kind == ElementKind::spring || e.kind == ElementKind::rope) add_spring(e, keys);
  }
  std::string result = "[[element]]\n";
  for (const auto& [key, value] : keys) result += key + " = " + value + "\n";
  return result;
}

std::string frame_name(int frame) {
  const std::string name = frame == inertial_frame ? "inertial" : body_name(frame);
  return "\"" + name + "\"";
}

std::string sensor(const Sensor& sensor, std::size_t index) {
  static const char* const kinds[] = {"gyro", "accelerometer", "point", "attitude", "reaction"};
  const bool is_point = sensor.kind == SensorKind::point;
  Keys keys{{"name", fmt::format("\"s{}\"", index)},
            {"kind", std::string("\"") + kinds[static_cast<int>(sensor.kind)] + "\""}};
  if (sensor.element >= 0) {
    keys.emplace_back("element", fmt::format("\"e{}\"", sensor.element));
  } else {
    keys.emplace_back(sensor.kind == SensorKind::reaction ? "joint" : "body",
                      "\"" + body_name(sensor.body) + "\"");
  }
  if (sensor.at_by_name) {
    keys.emplace_back("at", fmt::format("\"p{}\"", index));
  } else if (!sensor.at.isZero(0)) {
    keys.emplace_back("at", list(sensor.at));
  }
  if (sensor.axes) keys.emplace_back("axes", list(*sensor.axes));
  const bool is_seen = is_point || sensor.kind == SensorKind::attitude;
  if (is_seen && sensor.against != guide_frame) {
    keys.emplace_back("against", frame_name(sensor.against));
  }
  if (is_point && sensor.on != sensor.against) keys.emplace_back("axes", frame_name(sensor.on));
  if (sensor.period > 0) {
    keys.emplace_back("period", fmt::format("{}", sensor.period));
  }
  if (!sensor.increments.empty()) keys.emplace_back("increments", sensor.increments);
  std::string result = "[[sensor]]\n";
  for (const auto& [key, value] : keys) result += key + " = " + value + "\n";
  return result;
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

/// The joint of a loose body as a constraint.
std::string constraint(const Body& b, int index) {
  const char* const kind = b.kind == JointKind::spherical ? "point" : nullptr;
  const std::string name = kind ? kind : kreisel::joint_type(b.kind).name;
  std::string result = fmt::format("[[constraint]]\nname = \"c{}\"\nkind = \"{}\"\n", index, name);
  result += "between = [\"" + (b.parent < 0 ? "guide" : body_name(b.parent)) + "\", \"" +
            body_name(index) + "\"]\nat = [" + list(b.position) + ", [0, 0, 0]]\n";
  if (b.kind == JointKind::revolute || b.kind == JointKind::prismatic) {
    result += "axis = " + list(b.axis) + "\n";
  }
  return result;
}

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

}  // namespace

double Angle::radian() const { return degrees ? value * degree : value; }

bool Signal::empty() const {
  return series.constant.isZero(0) && series.terms.empty() && rate.isZero(0) && jumps.times.empty();
}

std::vector<double> Scene::jumps() const {
  std::vector<double> times;
  for (const Signal* const s : signals()) {
    times.insert(times.end(), s->jumps.times.begin(), s->jumps.times.end());
  }
  std::sort(times.begin(), times.end());
  return times;
}

std::vector<const Signal*> Scene::signals() const {
  std::vector<const Signal*> result;
  for (const Link& link : guide) {
    const Vehicle& v = link.vehicle;
    result.insert(result.end(), {&v.turn_rate, &v.acceleration, &v.climb, &v.bank});
  }
  for (const Body& body : bodies) {
    result.push_back(&body.force_in_time);
    result.push_back(&body.motion);
    if (body.rotor) result.push_back(&body.rotor->torque_in_time);
    for (const Load& load : body.loads) {
      result.insert(result.end(), {&load.force_in_time, &load.field});
    }
  }
  return result;
}

bool Scene::has_log() const {
  const std::vector<const Signal*> all = signals();
  if (std::any_of(all.begin(), all.end(), [](const Signal* s) { return !s->file.empty(); })) {
    return true;
  }
  return std::any_of(guide.begin(), guide.end(), [](const Link& link) { return link.is_logged(); });
}

Vector radian(const Vector& v, bool degrees) { return degrees ? Vector(v * degree) : v; }

std::vector<double> Scene::times() const {
  std::vector<double> result;
  for (int i = 1; i < outputs; ++i) {
    result.push_back(t_begin + i * ((t_end - t_begin) / outputs));
  }
  result.push_back(t_end);
  return result;
}

int single_coordinates(JointKind kind) {
  const kreisel::JointType& type = kreisel::joint_type(kind);
  return type.has_single_coordinates() ? type.rate_count() : 0;
}

bool slides(JointKind kind) {
  const auto& coordinates = kreisel::joint_type(kind).coordinates;
  return single_coordinates(kind) > 0 &&
         std::any_of(coordinates.begin(), coordinates.end(),
                     [](const auto& quantity) { return quantity.unit == "m"; });
}

Scene nearer(Scene scene) {
  const bool by_speed = scene.model == "precession";
  for (Body& body : scene.bodies) {
    if (body.rotor && by_speed) body.rotor->speed.value *= 2;
    if (body.rotor || body.drive || by_speed) continue;
    for (auto* const list : {&body.angle, &body.rate}) {
      for (Angle& angle : *list) angle.value /= 2;
    }
  }
  return scene;
}

/// Samples a hundred times per radian, from before the run to after it.
std::string samples(const Signal& signal, double t_end) {
  double fastest = 1;
  for (const Series::Term& term : signal.series.terms) {
    fastest = std::max(fastest, term.frequency.radian());
  }
  const double step = 0.01 / fastest;
  constexpr long outside = 16;
  std::string result = "t,value,x,y,z\n";
  for (long i = -outside; static_cast<double>(i - outside) * step <= t_end; ++i) {
    const double t = static_cast<double>(i) * step;
    const Vector v = reference::course_of(signal, t, t).value.cast<double>();
    result += text(t);
    for (const double x : {v.x(), v.x(), v.y(), v.z()}) result.append(",").append(text(x));
    result += "\n";
  }
  return result;
}

void write_logs(const Scene& scene, const std::filesystem::path& folder) {
  for (const Signal* const s : scene.signals()) {
    if (!s->file.empty()) std::ofstream(folder / s->file) << samples(*s, scene.t_end);
  }
  for (std::size_t i = 0; i < scene.guide.size(); ++i) {
    const Link& link = scene.guide[i];
    if (!link.is_logged()) continue;
    std::ofstream(folder / log_name(i)) << link.log.csv(scene.t_end, link.kind == LinkKind::rates);
  }
}

std::string to_toml(const Scene& scene) {
  std::string result = scene.title.empty() ? "" : "title = \"" + scene.title + "\"\n";
  result += guide(scene) + gravity(scene);
  for (int i = 0; i < static_cast<int>(scene.bodies.size()); ++i) result += body(scene, i);
  for (std::size_t i = 0; i < scene.elements.size(); ++i) result += element(scene.elements[i], i);
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    if (scene.bodies[i].loose) result += constraint(scene.bodies[i], static_cast<int>(i));
  }
  for (std::size_t i = 0; i < scene.sensors.size(); ++i) result += sensor(scene.sensors[i], i);
  result +=
      "[solve]\nt_end = " + text(scene.t_end) + "\ntolerance = " + text(scene.tolerance) + "\n";
  if (scene.t_begin != 0) result += "t_begin = " + text(scene.t_begin) + "\n";
  if (!scene.model.empty()) result += "model = \"" + scene.model + "\"\n";
  if (!scene.method.empty()) result += "method = \"" + scene.method + "\"\n";
  return result +
         (scene.outputs < 3
              ? "output_times = " + list(scene.times())
              : "output_step = " + text((scene.t_end - scene.t_begin) / scene.outputs)) +
         "\n" +
         (scene.reports ? "[report]\nreactions = true\nelements = true\nterms = true\n" : "");
}

}  // namespace differential
