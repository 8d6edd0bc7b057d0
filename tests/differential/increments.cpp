#include "increments.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <variant>
#include <vector>

#include <dynamics/file/columns.hpp>
#include <dynamics/file/readings.hpp>
#include <dynamics/file/scene_sensor.hpp>

using namespace kreisel;

namespace differential {

namespace {

constexpr double two_pi = 2 * std::numbers::pi;

// Gauss and Legendre on [0, 1], of order 10.
constexpr std::array<double, 5> nodes{0.046910077030668004, 0.23076534494715845, 0.5,
                                      0.76923465505284155, 0.953089922969332};
constexpr std::array<double, 5> weights{0.11846344252809454, 0.23931433524968324,
                                        0.28444444444444444, 0.23931433524968324,
                                        0.11846344252809454};

/// The motion of a scene at the nodes of a quadrature over a period, between its ends.
class Period {
 public:
  Period(const SceneSolver& model, const SceneFile& file, double length, int panels) {
    SolveOptions options = options_of(file);
    options.tolerance = 1e-10;
    options.method = Method::automatic;
    options.max_evaluations = 1e5;
    options.output_times = {file.t_begin};
    std::vector<double> ends{file.t_begin};
    for (int i = 1; i <= panels; ++i) ends.push_back(file.t_begin + i * length / panels);
    for (const double t : file.discontinuities) {
      if (t > ends.front() && t < ends.back()) ends.push_back(t);
    }
    std::sort(ends.begin(), ends.end());
    for (std::size_t i = 1; i < ends.size(); ++i) {
      const double part = ends[i] - ends[i - 1];
      if (!(part > 1e-9 * length)) continue;
      for (std::size_t k = 0; k < nodes.size(); ++k) {
        options.output_times.push_back(ends[i - 1] + nodes[k] * part);
        weights_.push_back(weights[k] * part);
      }
    }
    options.output_times.push_back(ends.back());
    run_ = model.solve(options, start_of(file));
    for (std::size_t i = 0; i < run_.states.size(); ++i) {
      now_.push_back(model.kinematics(run_.times[i], run_.states[i]));
    }
  }

  [[nodiscard]] bool is_known() const {
    return run_.report.tolerance_kept && now_.size() == weights_.size() + 2;
  }
  [[nodiscard]] const Trajectory<JointState>& run() const { return run_; }

  /// The right increments of a sensor. A rotation vector is the one nearest to the integral.
  [[nodiscard]] Vector3<double> increment(const Gyro& gyro, SensorIncrements kind) const {
    if (kind == SensorIncrements::uncompensated) return integral(gyro);
    const Eigen::AngleAxisd turn(attitude(gyro, 0).conjugate() * attitude(gyro, now_.size() - 1));
    const double turns = std::round((integral(gyro).dot(turn.axis()) - turn.angle()) / two_pi);
    return (turn.angle() + turns * two_pi) * turn.axis();
  }
  [[nodiscard]] Vector3<double> increment(const Accelerometer& sensor,
                                          SensorIncrements kind) const {
    if (kind == SensorIncrements::uncompensated) return integral(sensor);
    Vector3<double> sum = Vector3<double>::Zero();
    for (std::size_t i = 0; i < weights_.size(); ++i) {
      sum += weights_[i] * (attitude(sensor, i + 1) * sensor(now_[i + 1]));
    }
    return attitude(sensor, 0).conjugate() * sum;
  }

 private:
  template <class Sensor>
  [[nodiscard]] Eigen::Quaterniond attitude(const Sensor& sensor, std::size_t i) const {
    const AttitudeSensor of_body{sensor.body, SensorFrame::inertial()};
    return Eigen::Quaterniond(of_body(now_[i])) * sensor.axes;
  }

  template <class Sensor>
  [[nodiscard]] Vector3<double> integral(const Sensor& sensor) const {
    Vector3<double> sum = Vector3<double>::Zero();
    for (std::size_t i = 0; i < weights_.size(); ++i) sum += weights_[i] * sensor(now_[i + 1]);
    return sum;
  }

  std::vector<double> weights_;
  Trajectory<JointState> run_;
  std::vector<SystemKinematics> now_;
};

/// The wanted increment with two numbers of panels.
struct Wanted {
  Vector3<double> coarse;
  Vector3<double> fine;
};

std::optional<Wanted> wanted(const SceneSensor& sensor, const Period& coarse, const Period& fine) {
  const auto both = [&](const auto& kind) {
    return Wanted{coarse.increment(kind, sensor.increments),
                  fine.increment(kind, sensor.increments)};
  };
  if (const auto* gyro = std::get_if<Gyro>(&sensor.kind)) return both(*gyro);
  if (const auto* other = std::get_if<Accelerometer>(&sensor.kind)) return both(*other);
  return std::nullopt;
}

}  // namespace

std::optional<WrongIncrements> wrong_increments(const SceneSolver& model, const SceneFile& file) {
  const auto integrates = [](const SceneSensor& sensor) {
    return sensor.increments != SensorIncrements::none;
  };
  const auto some = std::find_if(file.sensors.begin(), file.sensors.end(), integrates);
  if (some == file.sensors.end()) return std::nullopt;
  constexpr double rounding = 2e-15;  // of an attitude
  const Period coarse(model, file, some->period, 8);
  const Period fine(model, file, some->period, 16);
  if (!coarse.is_known() || !fine.is_known()) return std::nullopt;

  SensorReadings readings(file);
  (void)readings.row(model, fine.run().times.front(), fine.run().states.front());
  const std::vector<double> row =
      readings.row(model, fine.run().times.back(), fine.run().states.back());
  std::optional<WrongIncrements> worst;
  const double* numbers = row.data();
  for (const SceneSensor& sensor : file.sensors) {
    const Vector3<double> read(numbers + (sensor.errors ? 3 : 0));  // without errors
    for (const auto& part : parts(sensor, file.bodies)) numbers += part.components.size();
    if (!integrates(sensor) || sensor.period != some->period) continue;
    const auto right = wanted(sensor, coarse, fine);
    const double size = std::max(right->fine.norm(), sensor.period);
    const double off = (read - right->fine).norm();
    const double quadrature = (right->fine - right->coarse).norm();
    if (quadrature > 1e-3 * size) continue;  // a transient that the panels do not resolve
    if (off <= rounding + 1e-9 * size + 3 * quadrature) continue;
    if (!worst || off / size > worst->off / worst->size) worst = {sensor.name, off, size};
  }
  return worst;
}

}  // namespace differential
