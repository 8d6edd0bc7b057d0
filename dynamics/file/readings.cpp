#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <variant>

#include <dynamics/file/columns.hpp>
#include <dynamics/file/readings.hpp>
#include <motor/attitude.hpp>
#include <motor/error.hpp>

namespace kreisel {

/// The state of a run at one time.
struct SensorReadings::Now {
  const SceneSolver& model;
  double t;
  const JointState& state;
  SystemKinematics system;
};

namespace {

/// The readings of a sensor without errors, in the order of its parts.
class TrueNumbers {
 public:
  TrueNumbers(const BodyTree& tree, const JointState& state, const SystemKinematics& system,
              std::vector<double>& numbers)
      : tree_(tree), state_(state), system_(system), numbers_(numbers) {}

  void operator()(const Gyro& sensor) const { append(sensor(system_)); }
  void operator()(const Accelerometer& sensor) const { append(sensor(system_)); }
  void operator()(const PointSensor& sensor) const {
    const PointReading<> point = sensor(system_);
    append(point.position);
    append(point.velocity);
    append(point.acceleration);
  }
  void operator()(const scene_sensor::Attitude& attitude) const {
    const Matrix3<double> R = attitude.sensor(system_);
    if (attitude.as_angles) {
      const auto [yaw, pitch, roll] = YawPitchRoll<double>::of(R);
      append(Vector3<double>(yaw, pitch, roll));
    } else {
      const Eigen::Quaterniond q(R);
      const double sign = q.w() < 0 ? -1 : 1;
      append(Eigen::Vector4d(q.w(), q.x(), q.y(), q.z()) * (sign / q.norm()));
    }
  }
  void operator()(const scene_sensor::Joint& joint) const {
    append_joint(tree_, joint.body, state_, numbers_);
  }
  void operator()(const AzimuthSensor& sensor) const { numbers_.push_back(sensor(system_)); }
  void operator()(const ReactionSensor& sensor) const { append(sensor(system_)); }
  void operator()(const ElementSensor& sensor) const { append(sensor(system_)); }
  void operator()(const scene_sensor::Outputs& outputs) const {
    append(system_.outputs[outputs.controller]);
  }

 private:
  void append(const Motor<>& force) const {
    append(force.resultant);
    append(force.moment);
  }
  template <class Numbers>
  void append(const Numbers& numbers) const {
    for (const double x : numbers.eval()) numbers_.push_back(x);
  }

  const BodyTree& tree_;
  const JointState& state_;
  const SystemKinematics& system_;
  std::vector<double>& numbers_;
};

bool integrates(const SceneSensor& sensor) { return sensor.increments != SensorIncrements::none; }

/// The increment that a sensor reads.
const Vector3<double>& chosen(const SceneSensor& sensor, const Increments& all) {
  const bool is_gyro = std::holds_alternative<Gyro>(sensor.kind);
  if (sensor.increments == SensorIncrements::compensated) {
    return is_gyro ? all.rotation : all.velocity;
  }
  return is_gyro ? all.angle : all.force;
}

}  // namespace

SensorReadings::SensorReadings(const SceneFile& scene)
    : scene_(scene), options_(options_of(scene)), integrals_(scene) {
  if (has_guide_of_equations(scene)) inertial_guide_ = make_guide(scene);
  begin_again();
}

bool SensorReadings::need_all_rows() const {
  return std::any_of(scene_.sensors.begin(), scene_.sensors.end(),
                     [](const SceneSensor& sensor) { return sensor.period > 0; });
}

void SensorReadings::begin_again() {
  instruments_.clear();
  for (const SceneSensor& sensor : scene_.sensors) {
    instruments_.push_back({SensorNoise(sensor.errors.value_or(SensorErrors{}), sensor.name)});
  }
  integrals_.forget();
}

std::vector<double> SensorReadings::row(const SceneSolver& model, double t,
                                        const JointState& state) {
  if (scene_.sensors.empty()) return {};
  if (latest_ && t <= *latest_) begin_again();
  latest_ = t;
  const Now now = at(model, t, state);
  std::vector<double> numbers;
  for (std::size_t i = 0; i < scene_.sensors.size(); ++i) {
    std::vector<double>& own = instruments_[i].reading;
    if (const auto sample = sample_of(i, t)) {
      own = reading(i, now, *sample);
      if (integrates(scene_.sensors[i])) note(i, now, *sample);
    } else if (integrates(scene_.sensors[i])) {
      numbers.insert(numbers.end(), own.size(), 0);
      continue;
    }
    numbers.insert(numbers.end(), own.begin(), own.end());
  }
  return numbers;
}

std::vector<double> SensorReadings::last_row(const SceneSolver& model,
                                             const Trajectory<JointState>& run) {
  begin_again();
  std::vector<double> numbers;
  for (std::size_t i = 0; i < scene_.sensors.size(); ++i) {
    const std::size_t first = first_needed(i, run.times);
    for (std::size_t k = first; k < run.times.size(); ++k) {
      const auto sample = sample_of(i, run.times[k]);
      if (!sample) continue;
      const Now now = at(model, run.times[k], run.states[k]);
      const bool begins_period = k == first && *sample > 0 && integrates(scene_.sensors[i]);
      if (!begins_period) instruments_[i].reading = reading(i, now, *sample);
      note(i, now, *sample);
    }
    const std::vector<double>& own = instruments_[i].reading;
    numbers.insert(numbers.end(), own.begin(), own.end());
  }
  return numbers;
}

std::size_t SensorReadings::first_needed(std::size_t i, const std::vector<double>& times) const {
  const SceneSensor& sensor = scene_.sensors[i];
  if (!(sensor.period > 0)) return times.size() - 1;
  if (integrates(sensor) && sensor.errors && sensor.errors->resolution > 0) return 0;
  std::size_t samples = integrates(sensor) ? 2 : 1;
  std::size_t k = times.size();
  while (k > 0 && samples > 0) {
    if (sample_of(i, times[--k])) --samples;
  }
  return k;
}

SensorReadings::Now SensorReadings::at(const SceneSolver& model, double t,
                                       const JointState& state) const {
  Now now{model, t, state, model.kinematics(t, state)};
  if (inertial_guide_) now.system.inertial_guide = (*inertial_guide_)(t);
  return now;
}

std::optional<std::size_t> SensorReadings::sample_of(std::size_t sensor, double t) const {
  if (scene_.sensors[sensor].period > 0)
    return sample_at(scene_.sensors[sensor], options_.begin, t);
  const auto& times = options_.output_times;
  return std::lower_bound(times.begin(), times.end(), t) - times.begin();
}

void SensorReadings::note(std::size_t sensor, const Now& now, std::size_t sample) {
  Instrument& instrument = instruments_[sensor];
  instrument.sample = sample;
  instrument.t = now.t;
  instrument.state = now.state;
}

std::vector<double> SensorReadings::reading(std::size_t i, const Now& now, std::size_t sample) {
  const SceneSensor& sensor = scene_.sensors[i];
  if (integrates(sensor)) return increment(i, now, sample);
  std::vector<double> numbers;
  std::visit(TrueNumbers(now.model.tree(), now.state, now.system, numbers), sensor.kind);
  if (!sensor.errors) return numbers;
  const Vector3<double> truth(numbers.data());
  const Vector3<double> value = misread(*sensor.errors, truth, noise(i, sample));
  numbers.insert(numbers.begin(), value.begin(), value.end());
  return numbers;
}

std::vector<double> SensorReadings::increment(std::size_t i, const Now& now, std::size_t sample) {
  const SceneSensor& sensor = scene_.sensors[i];
  Instrument& instrument = instruments_[i];
  if (sample == 0) return std::vector<double>(sensor.errors ? 6 : 3, 0);
  if (!instrument.sample || *instrument.sample + 1 != sample) {
    throw InvalidInput("the row in which a period of sensor '" + sensor.name +
                       "' begins was not read: read all rows in order");
  }
  const Vector3<double> truth =
      chosen(sensor, integrals_.of(i, now.model, instrument.t, instrument.state, now.t));
  if (!sensor.errors) return {truth.begin(), truth.end()};
  const Vector3<double> value =
      misread_increment(*sensor.errors, truth, sensor.period, noise(i, sample), instrument.rest);
  std::vector<double> numbers(value.begin(), value.end());
  numbers.insert(numbers.end(), truth.begin(), truth.end());
  return numbers;
}

double SensorReadings::length(std::size_t sensor, std::size_t sample) const {
  if (const double period = scene_.sensors[sensor].period; period > 0) return period;
  const auto& times = options_.output_times;
  if (sample > 0) return times[sample] - times[sample - 1];
  const double first = times.front() - options_.begin;
  return first > 0 ? first : times[1] - times[0];
}

Vector3<double> SensorReadings::noise(std::size_t sensor, std::size_t sample) {
  const SensorErrors& errors = *scene_.sensors[sensor].errors;
  if (!errors.is_random()) return Vector3<double>::Zero();
  auto& [noise, latest, rest, reading, before, t, state] = instruments_[sensor];
  if (sample + 1 < noise.count()) noise = SensorNoise(errors, scene_.sensors[sensor].name);
  while (noise.count() <= sample) latest = noise.next(length(sensor, noise.count()));
  return latest;
}

}  // namespace kreisel
