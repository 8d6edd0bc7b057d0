#include <cstddef>
#include <variant>

#include <dynamics/file/sensor_numbers.hpp>
#include <dynamics/tree/joint/list.hpp>

namespace kreisel {

namespace {

/// The number in column k of a joint.
Reading number_of_joint(int body, int k, const std::vector<BodyDescription>& bodies) {
  const int coordinates =
      joint_type(bodies[static_cast<std::size_t>(body)].joint.kind).coordinate_count();
  const bool is_rate = k >= coordinates;
  return {JointSensor{body, is_rate ? k - coordinates : k, is_rate}};
}

/// The number in column k of a sensor. Instruments with errors have the true values after them.
Reading number_in(const SceneSensor& sensor, int k, const std::vector<BodyDescription>& bodies) {
  if (const auto* const joint = std::get_if<scene_sensor::Joint>(&sensor.kind)) {
    return number_of_joint(joint->body, k, bodies);
  }
  if (const auto* const attitude = std::get_if<scene_sensor::Attitude>(&sensor.kind)) {
    if (attitude->as_angles) return {AttitudeAngles{attitude->sensor}, k};
    return {attitude->sensor, k};
  }
  if (const auto* const point = std::get_if<PointSensor>(&sensor.kind)) return {*point, k};
  if (const auto* const gyro = std::get_if<Gyro>(&sensor.kind)) return {*gyro, k % 3};
  return {std::get<Accelerometer>(sensor.kind), k % 3};
}

}  // namespace

std::vector<SensorNumber> numbers_of(const SceneSensor& sensor,
                                     const std::vector<BodyDescription>& bodies) {
  std::vector<SensorNumber> numbers;
  for (const SensorPart& part : parts(sensor, bodies)) {
    for (const std::string& unit : part.units) {
      numbers.push_back({number_in(sensor, static_cast<int>(numbers.size()), bodies), unit});
    }
  }
  return numbers;
}

std::string obstacle_to_reading(const SceneSensor& sensor) {
  if (std::holds_alternative<ReactionSensor>(sensor.kind) ||
      std::holds_alternative<ElementSensor>(sensor.kind)) {
    return "reads a reaction, which controllers and linear plants cannot read";
  }
  if (std::holds_alternative<AzimuthSensor>(sensor.kind)) {
    return "reads an azimuth, which controllers and linear plants cannot read";
  }
  if (std::holds_alternative<scene_sensor::Outputs>(sensor.kind)) {
    return "is a controller, which controllers cannot read";
  }
  if (sensor.increments != SensorIncrements::none) {
    return "reads increments, which controllers and linear plants cannot read; add a sensor "
           "without 'increments'";
  }
  return "";
}

}  // namespace kreisel
