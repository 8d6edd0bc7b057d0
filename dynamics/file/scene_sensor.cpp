#include <dynamics/file/columns.hpp>
#include <dynamics/file/scene_sensor.hpp>

namespace kreisel {

namespace {

template <class... Cases>
struct Overloaded : Cases... {
  using Cases::operator()...;
};
template <class... Cases>
Overloaded(Cases...) -> Overloaded<Cases...>;

SensorPart vector(const char* name, const char* unit) {
  return {name, {"x", "y", "z"}, {unit, unit, unit}};
}

SensorPart joint_part(const BodyDescription& body) {
  SensorPart part{"value", {}, {}};
  for (const JointQuantity& quantity : joint_quantities(body.joint.kind)) {
    part.components.insert(part.components.end(), quantity.columns.begin(), quantity.columns.end());
    part.units.insert(part.units.end(), quantity.columns.size(), quantity.unit);
  }
  return part;
}

}  // namespace

std::vector<SensorPart> parts(const SceneSensor& sensor,
                              const std::vector<BodyDescription>& bodies) {
  using Parts = std::vector<SensorPart>;
  const auto instrument = [&sensor](const char* unit) {
    Parts result{vector("value", unit)};
    if (sensor.errors) result.push_back(vector("true", unit));
    return result;
  };
  return std::visit(
      Overloaded{[&](const Gyro&) { return instrument("rad/s"); },
                 [&](const Accelerometer&) { return instrument("m/s^2"); },
                 [](const PointSensor&) {
                   return Parts{vector("position", "m"), vector("velocity", "m/s"),
                                vector("acceleration", "m/s^2")};
                 },
                 [](const scene_sensor::Attitude& attitude) {
                   return attitude.as_angles
                              ? Parts{{"value", {"yaw", "pitch", "roll"}, {"rad", "rad", "rad"}}}
                              : Parts{{"value", {"qw", "qx", "qy", "qz"}, {"1", "1", "1", "1"}}};
                 },
                 [&](const scene_sensor::Joint& joint) {
                   return Parts{joint_part(bodies[static_cast<std::size_t>(joint.body)])};
                 },
                 [](const ReactionSensor&) {
                   return Parts{vector("force", "N"), vector("torque", "N m")};
                 }},
      sensor.kind);
}

std::vector<std::string> columns(const SceneSensor& sensor,
                                 const std::vector<BodyDescription>& bodies) {
  std::vector<std::string> names;
  for (const SensorPart& part : parts(sensor, bodies)) {
    const std::string before = sensor.name + "." + (part.name == "value" ? "" : part.name + " ");
    for (const std::string& component : part.components) names.push_back(before + component);
  }
  return names;
}

}  // namespace kreisel
