#include <Eigen/Geometry>

#include <algorithm>
#include <variant>

#include <dynamics/file/columns.hpp>
#include <dynamics/file/readings.hpp>
#include <motor/attitude.hpp>

namespace kreisel {

namespace {

/// The state of a run at one time.
struct Now {
  const BodyTree& tree;
  const JointState& state;
  const SystemKinematics& system;
};

/// The readings of a sensor without errors, in the order of its parts.
class TrueNumbers {
 public:
  TrueNumbers(const Now& now, std::vector<double>& numbers) : now_(now), numbers_(numbers) {}

  void operator()(const Gyro& sensor) const { append(sensor(now_.system)); }
  void operator()(const Accelerometer& sensor) const { append(sensor(now_.system)); }
  void operator()(const PointSensor& sensor) const {
    const PointReading point = sensor(now_.system);
    append(point.position);
    append(point.velocity);
    append(point.acceleration);
  }
  void operator()(const scene_sensor::Attitude& attitude) const {
    const Matrix3<double> R = attitude.sensor(now_.system);
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
    append_joint(now_.tree, joint.body, now_.state, numbers_);
  }
  void operator()(const ReactionSensor& sensor) const {
    const auto [force, torque] = sensor(now_.system);
    append(force);
    append(torque);
  }

 private:
  template <class Numbers>
  void append(const Numbers& numbers) const {
    for (const double x : numbers.eval()) numbers_.push_back(x);
  }

  const Now& now_;
  std::vector<double>& numbers_;
};

}  // namespace

SensorReadings::SensorReadings(const SceneFile& scene)
    : scene_(scene), times_(options_of(scene).output_times) {
  if (has_guide_of_equations(scene)) inertial_guide_ = make_guide(scene);
  for (const SceneSensor& sensor : scene.sensors) {
    noises_.emplace_back(sensor.errors.value_or(SensorErrors{}), sensor.name);
    latest_.emplace_back(Vector3<double>::Zero());
  }
}

std::vector<double> SensorReadings::row(const SceneSolver& model, double t,
                                        const JointState& state) {
  if (scene_.sensors.empty()) return {};
  SystemKinematics system = model.kinematics(t, state);
  if (inertial_guide_) system.inertial_guide = (*inertial_guide_)(t);
  const Now now{model.tree(), state, system};
  std::vector<double> numbers;
  for (std::size_t i = 0; i < scene_.sensors.size(); ++i) {
    const SceneSensor& sensor = scene_.sensors[i];
    const std::size_t begin = numbers.size();
    std::visit(TrueNumbers(now, numbers), sensor.kind);
    if (!sensor.errors) continue;
    const Vector3<double> truth(numbers.data() + begin);
    const Vector3<double> value = misread(*sensor.errors, truth, noise(i, t));
    numbers.insert(numbers.begin() + static_cast<std::ptrdiff_t>(begin), value.begin(),
                   value.end());
  }
  return numbers;
}

double SensorReadings::length(std::size_t sample) const {
  if (sample > 0) return times_[sample] - times_[sample - 1];
  const double first = times_.front() - scene_.t_begin;
  return first > 0 ? first : times_[1] - times_[0];
}

Vector3<double> SensorReadings::noise(std::size_t sensor, double t) {
  const SensorErrors& errors = *scene_.sensors[sensor].errors;
  if (!errors.is_random()) return Vector3<double>::Zero();
  SensorNoise& noise = noises_[sensor];
  const auto found = std::lower_bound(times_.begin(), times_.end(), t);
  const auto sample = static_cast<std::uint64_t>(found - times_.begin());
  if (sample + 1 < noise.count()) noise = SensorNoise(errors, scene_.sensors[sensor].name);
  while (noise.count() <= sample && noise.count() < times_.size()) {
    latest_[sensor] = noise.next(length(noise.count()));
  }
  return latest_[sensor];
}

}  // namespace kreisel
