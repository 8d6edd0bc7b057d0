#include <algorithm>
#include <variant>

#include <dynamics/file/period_integrals.hpp>
#include <dynamics/step/explicit.hpp>
#include <dynamics/step/jacobian.hpp>
#include <dynamics/step/radau.hpp>
#include <motor/error.hpp>

namespace kreisel {

namespace {

using Eigen::Index;
using Eigen::VectorXd;
using Equations = IncrementEquations;

/// Explicit steps give up for a period as stiff as a hundred of them.
constexpr Accuracy by_explicit_steps{
    .relative = 1e-13, .absolute_scale = 1e-9, .max_evaluations = 2000};
constexpr Accuracy by_implicit_steps{
    .relative = 1e-13, .absolute_scale = 1e-3, .max_evaluations = 1e5};

/// The sizes relative to which steps err. Increments begin at 0; their sizes are those that the
/// first rates lead to in a period, or 1e-3 rad/s and 1 m/s^2. With smaller ones steps would follow
/// rounding.
std::vector<double> sizes_of(const VectorXd& rates, std::size_t blocks_of_motion, double period) {
  std::vector<double> sizes(blocks_of_motion, 1e-3);
  for (Index at = 0; at < rates.size(); at += Equations::count) {
    const auto size = [&](Index part, double least) {
      return std::max(rates.segment<3>(at + part).norm(), least) * period;
    };
    sizes.insert(sizes.end(), {size(0, 1e-3), 1, size(4, 1), size(7, 1e-3), size(10, 1)});
  }
  return sizes;
}

/// The reading of gyros and accelerometers on a sensor's axes. A gyro needs no specific force.
class TrueReading {
 public:
  explicit TrueReading(const SystemKinematics& system) : system_(system) {}

  InertialReading operator()(const Gyro& sensor) const { return {sensor(system_)}; }
  InertialReading operator()(const Accelerometer& sensor) const {
    return {Gyro{sensor.body, sensor.axes}(system_), sensor(system_)};
  }
  template <class Other>
  InertialReading operator()(const Other& /*sensor*/) const {
    return {};
  }

 private:
  const SystemKinematics& system_;
};

}  // namespace

PeriodIntegrals::PeriodIntegrals(const SceneFile& scene) : scene_(scene) {
  for (std::size_t i = 0; i < scene.sensors.size(); ++i) {
    const SceneSensor& sensor = scene.sensors[i];
    if (sensor.increments == SensorIncrements::none) continue;
    const auto same = std::find_if(groups_.begin(), groups_.end(), [&](const Group& group) {
      return scene.sensors[group.sensors.front()].period == sensor.period;
    });
    if (same == groups_.end()) {
      groups_.push_back({{i}});
    } else {
      same->sensors.push_back(i);
    }
  }
}

Increments PeriodIntegrals::of(std::size_t sensor, const SceneSolver& model, double begin,
                               const JointState& state, double end) {
  for (Group& group : groups_) {
    const auto found = std::find(group.sensors.begin(), group.sensors.end(), sensor);
    if (found == group.sensors.end()) continue;
    if (group.increments.empty() || group.end != end) integrate(group, model, begin, state, end);
    return group.increments[static_cast<std::size_t>(found - group.sensors.begin())];
  }
  throw InvalidInput("sensor '" + scene_.sensors[sensor].name + "' reads no increments");
}

void PeriodIntegrals::integrate(Group& group, const SceneSolver& model, double begin,
                                const JointState& state, double end) const {
  const Index coordinates = state.coordinates.size();
  const Index of_joints = coordinates + state.rates.size();
  const Index of_motion = of_joints + state.memory.size();
  VectorXd start(of_motion + Equations::count * static_cast<Index>(group.sensors.size()));
  const JointState from = model.sampled(begin, state);
  start << from.coordinates, from.rates, from.memory,
      Equations::start().replicate(static_cast<Index>(group.sensors.size()), 1);
  std::vector<int> blocks = model.tree().blocks();
  blocks.insert(blocks.end(), static_cast<std::size_t>(state.memory.size()), 1);
  const std::size_t blocks_of_motion = blocks.size();
  for (std::size_t i = 0; i < group.sensors.size(); ++i) {
    blocks.insert(blocks.end(), Equations::blocks.begin(), Equations::blocks.end());
  }

  const auto state_in = [&](const VectorXd& all) -> JointState {
    return {all.head(coordinates), all.segment(coordinates, of_joints - coordinates),
            all.segment(of_joints, of_motion - of_joints)};
  };
  const auto field = [&](double t, const VectorXd& all, VectorXd& result) {
    const auto system = model.kinematics_after_samples(t, state_in(all));
    result.head(of_motion) = system.rates;
    Index at = of_motion;
    for (const std::size_t i : group.sensors) {
      result.segment<Equations::count>(at) =
          Equations::rates(all.segment<Equations::count>(at),
                           std::visit(TrueReading(system), scene_.sensors[i].kind));
      at += Equations::count;
    }
  };
  VectorXd first(start.size());
  field(begin, start, first);
  const std::vector<double> sizes =
      sizes_of(first.tail(start.size() - of_motion), blocks_of_motion, end - begin);
  const std::vector<double> samples = model.sample_times(begin, end);
  const auto integrated = [&](auto&& steps) -> VectorXd {
    steps.stop_at(scene_.discontinuities);
    for (const double t : samples) {
      VectorXd all = steps.advance_to(t);
      if (t == end) break;
      all.segment(of_joints, of_motion - of_joints) = model.sampled(t, state_in(all)).memory;
      steps.jump_to(all);
    }
    return steps.advance_to(end);
  };
  VectorXd numbers;
  try {
    ExplicitRungeKutta<VectorXd, decltype(field)> steps(field, begin, start, by_explicit_steps,
                                                        blocks);
    steps.set_sizes(sizes);
    numbers = integrated(steps);
  } catch (const ComputationFailed&) {
    const auto jacobian = difference_jacobian<Eigen::Dynamic>(field);
    try {
      numbers = integrated(RadauSteps<VectorXd, decltype(field), decltype(jacobian)>(
          field, jacobian, begin, start, by_implicit_steps, blocks));
    } catch (const ComputationFailed& error) {
      throw ComputationFailed("the increments of sensor '" +
                              scene_.sensors[group.sensors.front()].name + "': " + error.what() +
                              "; take a shorter period");
    }
  }
  group.end = end;
  group.increments.clear();
  for (std::size_t i = 0; i < group.sensors.size(); ++i) {
    const Index at = of_motion + Equations::count * static_cast<Index>(i);
    group.increments.push_back(Equations::increments(numbers.segment<Equations::count>(at)));
  }
}

}  // namespace kreisel
