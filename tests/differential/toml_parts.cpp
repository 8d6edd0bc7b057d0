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
  static const char* const kinds[] = {"gyro", "accelerometer", "point", "attitude", "reaction"};
  const bool is_point = sensor.kind == SensorKind::point;
  Keys keys{{"name", fmt::format("\"s{}\"", index)},
            {"kind", std::string("\"") + kinds[static_cast<int>(sensor.kind)] + "\""}};
  if (sensor.element >= 0) {
    keys.emplace_back("element", fmt::format("\"e{}\"", sensor.element));
  } else if (sensor.constraint >= 0) {
    keys.emplace_back("constraint", fmt::format("\"k{}\"", sensor.constraint));
  } else {
    keys.emplace_back(sensor.kind == SensorKind::reaction ? "joint" : "body",
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
  std::string result = "[[sensor]]\n";
  for (const auto& [key, value] : keys) result += key + " = " + value + "\n";
  return result;
}

}  // namespace differential
