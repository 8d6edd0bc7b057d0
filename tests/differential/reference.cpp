#include "reference.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "reference_tree.hpp"

namespace differential {

namespace {

using reference::Real;
using reference::State;
using reference::Tree;

constexpr int columns = 8;  // 2, 4, .. 16 parts of a step: order 16, 73 evaluations

/// Gragg's steps by the modified midpoint rule, extrapolated.
class Steps {
 public:
  Steps(Tree& tree, Real t, State start) : tree_(tree), y_(std::move(start)), sampled_(t) {
    note();
  }

  [[nodiscard]] const State& state() const { return y_; }
  [[nodiscard]] double evaluations() const { return evaluations_; }

  /// Takes the samples at t, once. An output may differ from a sample by rounding.
  void sample(Real t) {
    if (t - sampled_ <= 1e-12L * std::abs(t)) return;
    tree_.sample(t, y_);
    sampled_ = t;
  }

  /// One step from t by h. The error is the difference to the column before, relative to the
  /// greatest sizes so far.
  [[nodiscard]] Real attempt(Real t, Real h) {
    tree_.rates(t, y_, first_);
    evaluations_ += 1;
    std::array<State, columns> table;
    State before;
    for (int j = 0; j < columns; ++j) {
      table[static_cast<std::size_t>(j)] = midpoint(t, h, 2 * (j + 1));
      before = table[0];
      for (int k = j - 1; k >= 0; --k) {
        const Real ratio = Real(j + 1) / Real(k + 1);
        auto& coarse = table[static_cast<std::size_t>(k)];
        const auto& fine = table[static_cast<std::size_t>(k + 1)];
        coarse = fine + (fine - coarse) / (ratio * ratio - 1);
      }
    }
    next_ = table[0];
    Real worst = 0;
    for (Eigen::Index i = 0; i < y_.size(); ++i) {
      const Real off = std::abs(next_[i] - before[i]) / size_[i];
      if (!(off <= worst)) worst = off;
    }
    return worst;
  }

  void accept(Real t) {
    y_ = next_;
    tree_.project(t, y_);
    note();
  }

 private:
  [[nodiscard]] State midpoint(Real t, Real h, int parts) {
    const Real s = h / Real(parts);
    State before = y_;
    State now = y_ + s * first_;
    for (int i = 1; i <= parts; ++i) {
      tree_.rates(t + s * Real(i), now, rate_);
      evaluations_ += 1;
      if (i == parts) break;
      State after = before + 2 * s * rate_;
      before = std::move(now);
      now = std::move(after);
    }
    return (before + now + s * rate_) / 2;
  }

  void note() {
    if (size_.size() == 0) size_ = State::Constant(y_.size(), 1e-3L);
    size_ = size_.cwiseMax(y_.cwiseAbs());
  }

  Tree& tree_;
  State y_;
  State next_;
  State first_;
  State rate_;
  State size_;
  Real sampled_;  ///< time of the last samples
  double evaluations_ = 0;
};

/// The scene with its start perturbed in the last digit, up and down in turn.
Scene moved(Scene scene) {
  double digit = 0x1p-52;
  const auto move = [&digit](double& x) {
    x *= 1 + digit;
    digit = -digit;
  };
  for (Body& body : scene.bodies) {
    for (Angle& angle : body.angle) move(angle.value);
    for (Angle& rate : body.rate) move(rate.value);
    for (double& x : body.displacement) move(x);
    for (Vector* const v : {&body.angular_velocity, &body.velocity}) {
      for (double& x : *v) move(x);
    }
    if (body.place) std::for_each(body.place->begin(), body.place->end(), move);
    if (body.attitude) {
      for (double& x : *body.attitude) x += (digit = -digit);
    }
  }
  return scene;
}

struct Step {
  Real begin;
  Real length;
  bool output;
};

/// The first jump before `time`, or `time` itself.
Real next_stop(const std::vector<double>& jumps, Real t, double time) {
  const auto next = std::find_if(jumps.begin(), jumps.end(), [t](double jump) { return jump > t; });
  return next == jumps.end() ? Real(time) : std::min(Real(*next), Real(time));
}

/// Adaptive steps to the times; accepted steps are recorded in `taken`.
void run(const Scene& scene, const std::vector<double>& times, double max_evaluations,
         ReferenceMotion& motion, std::vector<Step>& taken) {
  constexpr Real tolerance = 1e-15L;
  Tree tree(scene);
  Steps steps(tree, Real(scene.t_begin), tree.start());
  const std::vector<double> jumps = scene.jumps();
  auto t = Real(scene.t_begin);
  const Real whole = Real(times.back()) - t;
  Real h = whole / 64;
  for (const double time : times) {
    while (t < Real(time)) {
      if (steps.evaluations() > max_evaluations) return;
      const Real goal = next_stop(jumps, t, time);
      const bool last = t + h * Real(1.01) >= goal;
      const Real length = last ? goal - t : h;
      tree.stay_within(t + length / 2);
      steps.sample(t);
      const Real off = steps.attempt(t, length);
      const Real factor = Real(0.8) * std::pow(tolerance / (off + Real(1e-19)), Real(1) / 15);
      if (!(off <= tolerance)) {
        h = length * (factor > Real(0.1) ? factor : Real(0.1));
        if (h < Real(1e-14) * whole) return;
        continue;
      }
      taken.push_back({t, length, last && goal == Real(time)});
      t = last ? goal : t + length;
      steps.accept(t);
      const Sizes sizes = tree.sizes(t, steps.state());
      if (!tree.mounts_hold()) return;
      motion.sizes.energy = std::max(motion.sizes.energy, sizes.energy);
      motion.sizes.momentum = std::max(motion.sizes.momentum, sizes.momentum);
      h = std::max(last ? h : length, length) * std::min(factor, Real(3));
    }
    motion.times.push_back(time);
    motion.states.push_back(tree.values(t, steps.state()));
  }
  motion.complete = true;
}

/// The same steps, each in two halves.
void repeat(const Scene& scene, const std::vector<Step>& taken, ReferenceMotion& motion) {
  Scene other = moved(scene);
  Tree tree(other);
  Steps steps(tree, Real(scene.t_begin), tree.start());
  for (const Step& step : taken) {
    if (motion.others.size() == motion.states.size()) break;
    tree.stay_within(step.begin + step.length / 2);
    steps.sample(step.begin);
    for (const int half : {0, 1}) {
      const Real begin = step.begin + Real(half) * step.length / 2;
      [[maybe_unused]] const Real off = steps.attempt(begin, step.length / 2);
      steps.accept(begin + step.length / 2);
    }
    if (step.output) motion.others.push_back(tree.values(step.begin + step.length, steps.state()));
  }
}

}  // namespace

std::vector<int> blocks(const Scene& scene) {
  std::vector<int> result;
  for (const Body& body : scene.bodies) {
    const std::vector<int> own = blocks(body.free_kind());
    result.insert(result.end(), own.begin(), own.end());
  }
  return result;
}

std::vector<int> parts_of(const Scene& scene, const Sensor& sensor) {
  switch (sensor.kind) {
    case SensorKind::gyro:
    case SensorKind::accelerometer: return std::vector<int>(sensor.errors ? 2 : 1, 3);
    case SensorKind::point: return {3, 3, 3};
    case SensorKind::attitude: return {4};
    case SensorKind::reaction: return {3, 3};
    case SensorKind::azimuth: return {1};
    case SensorKind::joint: break;
  }
  return blocks(scene.bodies[static_cast<std::size_t>(sensor.body)].free_kind());
}

JointValues start_values(const Scene& scene) {
  Tree tree(scene);
  const State start = tree.start();
  tree.stay_within(Real(scene.t_begin));
  return tree.values(Real(scene.t_begin), start);
}

std::vector<StartPose> start_poses(const Scene& scene) {
  std::vector<StartPose> result;
  for (const auto& [R, x] : Tree(scene).start_poses()) {
    result.push_back({R.cast<double>(), x.cast<double>()});
  }
  return result;
}

JointValues fulfilled_values(const Scene& scene) {
  Tree tree(scene);
  State y = tree.start();
  tree.stay_within(Real(scene.t_begin));
  tree.project(Real(scene.t_begin), y);
  return tree.values(Real(scene.t_begin), y);
}

Eigen::VectorXd condition_values(const Scene& scene) {
  Tree tree(scene);
  tree.stay_within(Real(scene.t_begin));
  return tree.condition_values();
}

bool has_idle_motion(const Scene& scene) {
  const std::vector<StartPose> poses = start_poses(scene);
  Scene tree = scene;
  tree.constraints.clear();
  tree.sensors.clear();
  for (std::size_t i = 0; i < poses.size(); ++i) {
    Body& body = tree.bodies[i];
    if (!body.loose) continue;
    const Eigen::Quaterniond q(poses[i].R);
    body.kind = JointKind::free;
    body.parent = guide_frame;
    body.position.setZero();
    body.orientation.reset();
    body.attitude = Eigen::Vector4d(q.w(), q.x(), q.y(), q.z());
    body.place = poses[i].x;
  }
  return Tree(tree).has_idle_motion();
}

std::vector<double> start_reactions(const Scene& scene) {
  Tree tree(scene);
  const State start = tree.start();
  tree.stay_within(Real(scene.t_begin));
  return tree.reactions(Real(scene.t_begin), start);
}

std::vector<double> start_readings(const Scene& scene) {
  Tree tree(scene);
  const State start = tree.start();
  tree.stay_within(Real(scene.t_begin));
  return tree.readings(Real(scene.t_begin), start);
}

ReferenceMotion integrate(const Scene& scene, const std::vector<double>& times, double work) {
  ReferenceMotion motion;
  std::vector<Step> taken;
  run(scene, times, work / (3 * Tree(scene).work()), motion, taken);
  repeat(scene, taken, motion);
  return motion;
}

}  // namespace differential
