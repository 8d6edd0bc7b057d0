#include <fmt/core.h>

#include "toml.hpp"

namespace differential {

namespace {

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
  if (!e.length_in_time.empty()) {
    keys.emplace_back("length", number_signal(e.length_in_time));
  } else if (e.length != 0 && table.empty())
    keys.emplace_back("length", text(e.length));
  if (e.damping != 0) keys.emplace_back("damping", text(e.damping));
}

void add_errors(const SensorErrors& errors, Keys& keys) {
  const auto axes = [](const Vector& v) { return v.isConstant(v.x(), 0) ? text(v.x()) : list(v); };
  const auto add = [&keys, &axes](const std::string& key, const Vector& v) {
    if (!v.isZero(0)) keys.emplace_back(key, axes(v));
  };
  if (!errors.misalignment.isZero(0)) keys.emplace_back("misalignment", list(errors.misalignment));
  add("scale", errors.scale);
  add(angle_key("bias", errors.is_in_degrees), errors.bias);
  add("noise", errors.noise);
  add("drift", errors.drift);
  if (!errors.sigma.isZero(0)) {
    keys.emplace_back("correlation", fmt::format("{{ sigma = {}, time = {} }}", axes(errors.sigma),
                                                 text(errors.time)));
  }
  if (errors.resolution > 0) keys.emplace_back("resolution", text(errors.resolution));
  if (errors.range > 0) keys.emplace_back("range", text(errors.range));
  keys.emplace_back("seed", fmt::format("{}", errors.seed));
}

std::string frame_name(int frame) {
  const std::string name = frame == inertial_frame ? "inertial" : body_name(frame);
  return "\"" + name + "\"";
}

}  // namespace

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
      keys.emplace_back("at", fmt::format("[{}, {}]", list(e.at[0]), list(e.at[1])));
    }
    if (e.kind == ElementKind::mount) add_mount(e, keys);
    if (e.kind == ElementKind::spring || e.kind == ElementKind::rope) add_spring(e, keys);
  }
  std::string result = "[[element]]\n";
  for (const auto& [key, value] : keys) result += key + " = " + value + "\n";
  return result;
}

std::string sensor(const Sensor& sensor, std::size_t index) {
  static const char* const kinds[] = {"gyro",     "accelerometer", "point",  "attitude",
                                      "reaction", "joint",         "azimuth"};
  const bool is_point = sensor.kind == SensorKind::point;
  Keys keys{{"name", fmt::format("\"s{}\"", index)},
            {"kind", std::string("\"") + kinds[static_cast<int>(sensor.kind)] + "\""}};
  if (sensor.element >= 0) {
    keys.emplace_back("element", fmt::format("\"e{}\"", sensor.element));
  } else if (sensor.constraint >= 0) {
    keys.emplace_back("constraint", fmt::format("\"k{}\"", sensor.constraint));
  } else {
    const bool is_of_joint =
        sensor.kind == SensorKind::reaction || sensor.kind == SensorKind::joint;
    keys.emplace_back(is_of_joint ? "joint" : "body",
                      fmt::format("\"{}\"", body_name(sensor.body)));
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
  if (sensor.errors) add_errors(*sensor.errors, keys);
  std::string result = "[[sensor]]\n";
  for (const auto& [key, value] : keys) result += key + " = " + value + "\n";
  return result;
}

std::string driven(const Servo& servo) {
  if (servo.rope >= 0) return fmt::format("e{}", servo.rope);
  const std::string body = body_name(servo.drives);
  if (servo.load < 0) return body;
  return fmt::format("load.{}.{}.{}", body, servo.load < 3 ? "force" : "torque",
                     "xyz"[servo.load % 3]);
}

std::string servo(const Servo& servo, const Scene& scene, std::size_t index) {
  const Body& read = scene.bodies[static_cast<std::size_t>(servo.reads)];
  const char* const coordinate = read.kind == JointKind::prismatic ? "displacement" : "angle";
  std::string law = "{ kind = \"pid\"";
  const auto add = [&law](const char* key, double x) {
    if (x != 0) law += fmt::format(", {} = {}", key, text(x));
  };
  add("proportional", servo.proportional);
  add("integral", servo.integral);
  add("derivative", servo.derivative);
  add("filter", servo.filter);
  Keys keys{{"name", fmt::format("\"c{}\"", index)},
            {"reads", fmt::format("[\"r{}.{}\"]", index, servo.reads_rate ? "rate" : coordinate)},
            {"drives", fmt::format("[\"{}\"]", driven(servo))},
            {"law", law + " }"}};
  const auto add_key = [&keys](const char* key, double x) {
    if (x != 0) keys.emplace_back(key, fmt::format("{}", x));
  };
  add_key("reference", servo.reference);
  add_key("limit", servo.limit);
  add_key("period", servo.period);
  add_key("delay", servo.delay);
  std::string result = fmt::format("[[sensor]]\nname = \"r{}\"\nkind = \"joint\"\njoint = \"{}\"\n",
                                   index, body_name(servo.reads)) +
                       "[[controller]]\n";
  for (const auto& [key, value] : keys) result += key + " = " + value + "\n";
  return result;
}

}  // namespace differential
