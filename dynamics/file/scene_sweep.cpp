#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include <dynamics/file/linear_motion.hpp>
#include <dynamics/file/periodic_motions.hpp>
#include <dynamics/file/scene_sweep.hpp>
#include <dynamics/file/steady_motions.hpp>
#include <motor/error.hpp>

namespace kreisel {

using Eigen::Index, Eigen::VectorXd;

namespace {

/// The modes about steady motions, each followed from the one before.
class SteadyModes {
 public:
  SteadyModes(const StudySystem& system, Index speed, VectorXd guess, double duration)
      : system_(system), speed_(speed), guess_(std::move(guess)), duration_(duration) {}

  [[nodiscard]] Steady at(double speed) const {
    VectorXd y = guess_;
    y[speed_] = speed;
    return steady_motion::find_steady(system_, y, duration_);
  }

  [[nodiscard]] std::vector<WhirlingMode> operator()(double speed) {
    const Steady steady = at(speed);
    if (!steady.exists()) {
      throw ComputationFailed(fmt::format("sweep of a speed: no steady motion at {:.9g} rad/s: {}",
                                          speed, steady.reason));
    }
    guess_ = steady.state;
    return linear_motion(system_, steady.state).modes;
  }

 private:
  const StudySystem& system_;
  Index speed_;
  VectorXd guess_;
  double duration_;
};

/// The modes about periodic motions, each followed from the one before.
class PeriodicModes {
 public:
  /// unsteady : why there is no steady motion
  PeriodicModes(const StudySystem& system, const SceneFile& scene, Index speed, VectorXd guess,
                std::string unsteady)
      : system_(system),
        scene_(scene),
        speed_(speed),
        guess_(std::move(guess)),
        unsteady_(std::move(unsteady)) {}

  [[nodiscard]] double period(double speed) const {
    if (speed == 0) {
      throw ComputationFailed(
          "sweep of a speed: a rotor at rest gives no period; leave out 0 rad/s");
    }
    VectorXd y = guess_;
    y[speed_] = speed;
    const FoundPeriod found = find_period(system_, scene_, y);
    const double misses = found.period > 0 ? field_misses(system_, y, found.period) : 0;
    if (found.period > 0 && misses <= 1e-9) return found.period;
    const std::string why =
        found.period > 0
            ? fmt::format("after {:.9g} s the rates differ by {:.1e}", found.period, misses)
            : found.reason;
    throw ComputationFailed(
        fmt::format("sweep of a speed: no steady motion at {:.9g} rad/s: {}; and no period: {}",
                    speed, unsteady_, why));
  }

  [[nodiscard]] std::vector<WhirlingMode> operator()(double speed) {
    VectorXd y = guess_;
    y[speed_] = speed;
    const FloquetMotion motion = floquet_motion(system_, y, period(speed));
    if (!motion.exists()) {
      throw ComputationFailed(fmt::format(
          "sweep of a speed: no periodic motion at {:.9g} rad/s: {}", speed, motion.reason));
    }
    guess_ = motion.start;
    return floquet_modes(system_, motion);
  }

 private:
  const StudySystem& system_;
  const SceneFile& scene_;
  Index speed_;
  VectorXd guess_;
  std::string unsteady_;
};

}  // namespace

Index speed_of(const StudySystem& system, const std::string& body) {
  const BodyTree& tree = system.tree();
  const auto is = [&body](const auto& other) { return other.name == body; };
  if (std::none_of(tree.bodies().begin(), tree.bodies().end(), is)) {
    throw InvalidInput("sweep of a speed: body '" + body + "' does not exist");
  }
  const int index = tree.index(body);
  const BodyDescription& b = tree.body(index);
  const bool turns = b.joint.kind == JointKind::revolute &&
                     (b.rotor ? b.rotor->mode != RotorMode::torque : b.rule == JointRule::driven);
  if (!turns) {
    throw InvalidInput("sweep of a speed: body '" + body +
                       "' is neither a free or regulated rotor nor driven at a constant rate");
  }
  return tree.coordinates() + tree.place(index).v;
}

SceneSweep sweep_speed(const StudySystem& system, const SceneFile& scene, const std::string& body,
                       const std::vector<double>& speeds, const SweepOptions& options,
                       const VectorXd& guess, const std::function<void(double)>& progress) {
  const Index speed = speed_of(system, body);
  SteadyModes steady_modes(system, speed, guess, scene.duration());
  // At the speed 0 every rotor has a steady motion.
  const auto smaller = [](double a, double b) { return std::abs(a) < std::abs(b); };
  const Steady fastest = steady_modes.at(*std::max_element(speeds.begin(), speeds.end(), smaller));
  std::size_t count = 0;
  const auto counted = [&](auto& modes) -> ModesAt {
    return [&](double now) {
      if (progress && count < speeds.size()) progress(double(count++) / double(speeds.size()));
      return modes(now);
    };
  };
  SceneSweep sweep;
  sweep.is_periodic = !fastest.exists();
  if (sweep.is_periodic) {
    PeriodicModes periodic_modes(system, scene, speed, guess, fastest.reason);
    SweepOptions coarser = options;
    coarser.accuracy = std::max(options.accuracy, 1e-9);
    static_cast<RotorSweep&>(sweep) = rotor_sweep(counted(periodic_modes), speeds, coarser);
    for (const double now : speeds) sweep.periods.push_back(periodic_modes.period(now));
    sweep.frame = "against the parent of each body";
  } else {
    static_cast<RotorSweep&>(sweep) = rotor_sweep(counted(steady_modes), speeds, options);
    sweep.has_rotors = !system.tree().rotors().empty();
    sweep.frame = linear_motion(system, fastest.state).frame;
  }
  sweep.body = body;
  return sweep;
}

}  // namespace kreisel
