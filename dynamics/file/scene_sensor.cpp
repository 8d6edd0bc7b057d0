#include <algorithm>
#include <cmath>
#include <utility>

#include <dynamics/file/columns.hpp>
#include <dynamics/file/overloaded.hpp>
#include <dynamics/file/scene_sensor.hpp>
#include <dynamics/signal/same_time.hpp>

namespace kreisel {

namespace {

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

namespace {

using detail::is_same_time;

double sample_time(const SceneSensor& sensor, double begin, double count) {
  return begin + count * sensor.period;
}

}  // namespace

std::optional<std::size_t> sample_at(const SceneSensor& sensor, double begin, double t) {
  const double count = std::round((t - begin) / sensor.period);
  if (count < 0 || !is_same_time(sample_time(sensor, begin, count), t)) return std::nullopt;
  return static_cast<std::size_t>(count);
}

std::vector<double> with_samples(const std::vector<double>& output_times,
                                 const std::vector<SceneSensor>& sensors, double begin,
                                 double end) {
  std::vector<double> times = output_times;
  for (const SceneSensor& sensor : sensors) {
    if (!(sensor.period > 0)) continue;
    std::vector<double> merged;
    auto next = times.begin();
    for (double count = 0;; ++count) {
      const double sample = sample_time(sensor, begin, count);
      if (sample > end && !is_same_time(sample, end)) break;
      while (next != times.end() && *next < sample && !is_same_time(*next, sample)) {
        merged.push_back(*next++);
      }
      const bool is_there = next != times.end() && is_same_time(*next, sample);
      merged.push_back(is_there ? *next++ : std::min(sample, end));
    }
    merged.insert(merged.end(), next, times.end());
    times = std::move(merged);
  }
  return times;
}

std::vector<SensorPart> parts(const SceneSensor& sensor,
                              const std::vector<BodyDescription>& bodies) {
  using Parts = std::vector<SensorPart>;
  const Parts reaction{vector("force", "N"), vector("torque", "N m")};
  const bool integrates = sensor.increments != SensorIncrements::none;
  const auto instrument = [&](SensorPart value) {
    Parts result{std::move(value)};
    if (sensor.errors) result.push_back({"true", result[0].components, result[0].units});
    return result;
  };
  return std::visit(
      detail::Overloaded{
          [&](const Gyro&) {
            return instrument(integrates ? vector("dtheta", "rad") : vector("value", "rad/s"));
          },
          [&](const Accelerometer&) {
            return instrument(integrates ? vector("dv", "m/s") : vector("value", "m/s^2"));
          },
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
          [&](const ReactionSensor&) { return reaction; },
          [&](const ElementSensor&) { return reaction; },
          [](const AzimuthSensor&) {
            return Parts{{"value", {"azimuth"}, {"rad"}}};
          },
          [](const scene_sensor::Outputs& outputs) {
            return Parts{{"value", outputs.drives, outputs.units}};
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
