#pragma once

#include <string>
#include <vector>

#include <dynamics/control/controller.hpp>
#include <dynamics/file/scene_sensor.hpp>

namespace kreisel {

/// A number of a sensor, as controllers and linear plants read it.
struct SensorNumber {
  Reading reading = {};
  std::string unit = {};
};

/// The numbers of a sensor in the order of its columns. The sensor has no obstacle.
[[nodiscard]] std::vector<SensorNumber> numbers_of(const SceneSensor& sensor,
                                                   const std::vector<BodyDescription>& bodies);

/// The end of a message, why the numbers of a sensor cannot be read as functions of the state;
/// empty if they can.
[[nodiscard]] std::string obstacle_to_reading(const SceneSensor& sensor);

}  // namespace kreisel
