#pragma once

#include <Eigen/Core>

#include <algorithm>
#include <concepts>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <dynamics/control/loop.hpp>
#include <dynamics/control/readings.hpp>
#include <dynamics/sensor/kinematics.hpp>
#include <dynamics/signal/same_time.hpp>
#include <dynamics/tree/body_system.hpp>

namespace kreisel {

/// Small influences from outside on a controlled system, for derivatives: see Disturbance.
template <class S>
struct ControlDisturbance {
  Disturbance<S> bodies = {};
  std::vector<detail::VectorOn<S>> references = {};  ///< for each controller; empty: none
};

/// A system of bodies with controllers: sensors, laws and torquers in a closed loop. Systems without
/// controllers are a BodySystem, which pays nothing for them.
///
/// The state of continuous laws is part of the state of the system, so that integrators, their
/// Jacobians and error estimates cover the loop. The outputs that sampled laws hold are part of it
/// as well: they jump at samples, which solve() meets exactly. A state at the time of samples is the
/// one before them. A run that starts with it takes them, and forces and readings are those after
/// them.
///
/// Error  : as BodySystem; joint forces are those of the law, with <= 4u for each product
/// Throws : InvalidInput, naming the controller and the reason; else as BodySystem
template <class M>
class ControlledSystem {
 public:
  using S = double;
  using Vector = Eigen::VectorXd;  ///< y = (coordinates of all joints; their rates; memory)

  struct State {
    Vector coordinates;
    Vector rates;
    Vector memory;  ///< of the controllers, in their order; see memory_names()
  };

  /// Scratch memory for evaluations; each thread needs its own.
  struct Workspace {
    BodyWorkspace bodies;
    MotionOfBodies<double> motion = {};
    Vector joints = {};  ///< coordinates and rates
    Vector rates = {};   ///< their derivatives
  };

  /// gravitation : the load on all bodies that represents a gravity that is not uniform, for
  ///               accelerometers; none: gravity is uniform
  ControlledSystem(BodySystem<M> system, const std::vector<Controller>& controllers,
                   std::optional<BodyLoad> gravitation = {})
      : system_(std::move(system)), gravitation_(std::move(gravitation)) {
    for (const Controller& controller : controllers) {
      for (const detail::ControlLoop& other : loops_) {
        if (other.name() != controller.name) continue;
        throw InvalidInput("controller '" + controller.name + "' is there twice: rename one");
      }
      loops_.emplace_back(controller, tree(), tree().coordinates() + tree().rates() + memory_);
      memory_ += loops_.back().memory_size();
    }
    for (const detail::ControlLoop& loop : loops_) {
      if (loop.is_sampled()) continue;
      reads_bodies_ = reads_bodies_ || loop.reads_bodies();
      feeds_through_ = feeds_through_ || loop.feeds_through();
      completes_later_ = completes_later_ || !loop.feeds_through();
    }
  }

  [[nodiscard]] const BodySystem<M>& bodies() const { return system_; }
  [[nodiscard]] const M& guide() const { return system_.guide(); }
  [[nodiscard]] const BodyTree& tree() const { return system_.tree(); }
  [[nodiscard]] const std::vector<detail::ControlLoop>& loops() const { return loops_; }
  [[nodiscard]] int memory() const { return memory_; }
  [[nodiscard]] Workspace workspace() const { return {system_.workspace()}; }

  /// The names of the memory's numbers: "NAME state 1", "NAME output BODY".
  [[nodiscard]] std::vector<std::string> memory_names() const {
    std::vector<std::string> names;
    for (const detail::ControlLoop& loop : loops_) {
      for (std::string& name : loop.memory_names()) names.push_back(std::move(name));
    }
    return names;
  }

  /// A state of the joints, with the memory at the start.
  [[nodiscard]] State start(const typename BodySystem<M>::State& joints) const {
    State state{joints.coordinates, joints.rates, Vector(memory_)};
    Eigen::Index at = 0;
    for (const detail::ControlLoop& loop : loops_) {
      state.memory.segment(at, loop.memory_size()) = loop.initial();
      at += loop.memory_size();
    }
    return state;
  }

  [[nodiscard]] static Vector to_vector(const State& state) {
    return detail::joined(detail::joined(state.coordinates, state.rates), state.memory);
  }

  [[nodiscard]] State from_vector(const Vector& y) const {
    const Vector joints = joints_of(y);
    return {detail::coordinates(tree(), joints), detail::rates(tree(), joints), y.tail(memory_)};
  }

  [[nodiscard]] std::vector<int> blocks() const {
    std::vector<int> result = system_.blocks();
    result.insert(result.end(), static_cast<std::size_t>(memory_), 1);
    return result;
  }

  /// The vector field  y' = rates(t, y), between samples.
  void rates(double t, const Vector& y, Vector& result, Workspace& w) const {
    require(y);
    result.resize(y.size());
    auto memory_rates = result.tail(memory_);
    set_joints(y, w);
    set_outputs(t, y, w, memory_rates);
    detail::rates(tree(), system_.at(t, &w.bodies.outside), w.joints, w.rates, w.bodies);
    result.head(joint_count()) = w.rates;
    if (!completes_later_) return;
    if (reads_bodies_) observe(t, w, &w.rates);
    complete(t, y, Situation<double>{w.joints, w.motion, none_}, memory_rates);
  }

  [[nodiscard]] Vector rates(double t, const Vector& y) const {
    Workspace w = workspace();
    Vector result;
    rates(t, y, result, w);
    return result;
  }

  /// The vector field in dual numbers, as that of BodySystem.
  ///
  /// Throws : also InvalidInput, naming the controller, for a law that is a callable
  template <class Dual>
  [[nodiscard]] detail::VectorOn<Dual> rates(const Dual& t, const detail::VectorOn<Dual>& y) const {
    return rates(t, y, ControlDisturbance<Dual>());
  }

  /// As above, under influences from outside. A guide at rest by its type cannot be moved.
  template <class Dual>
  [[nodiscard]] detail::VectorOn<Dual> rates(const Dual& t, const detail::VectorOn<Dual>& y,
                                             ControlDisturbance<Dual> outside) const {
    require_linear();
    const detail::VectorOn<Dual> joints = y.head(joint_count());
    detail::VectorOn<Dual>& force = outside.bodies.forces.joint_force;
    if (force.size() == 0) force = detail::VectorOn<Dual>::Constant(tree().rates(), Dual(0));
    detail::VectorOn<Dual> memory_rates = detail::VectorOn<Dual>::Constant(memory_, Dual(0));
    MotionOfBodies<Dual> motion;
    if (reads_bodies_) motion = observed(t, joints, static_cast<const Dual*>(nullptr), outside);
    OutsideForces<Dual> forces = outside.bodies.forces;
    add_outputs(t, y, Situation<Dual>{joints, motion, outside}, forces, memory_rates);
    outside.bodies.forces = std::move(forces);
    const detail::VectorOn<Dual> joint_rates = system_.rates(t, joints, outside.bodies);
    if (completes_later_) {
      if (reads_bodies_) {
        motion = observed(t, joints, joint_rates.data() + tree().coordinates(), outside);
      }
      complete(t, y, Situation<Dual>{joints, motion, outside}, memory_rates);
    }
    detail::VectorOn<Dual> result(y.size());
    result << joint_rates, memory_rates;
    return result;
  }

  /// The numbers that readings would give, under influences from outside.
  template <class Dual>
  [[nodiscard]] detail::VectorOn<Dual> numbers(const std::vector<Reading>& wanted, const Dual& t,
                                               const detail::VectorOn<Dual>& y,
                                               const ControlDisturbance<Dual>& outside) const {
    const detail::VectorOn<Dual> joints = y.head(joint_count());
    const detail::VectorOn<Dual> now = rates(t, y, outside);
    const auto motion = observed(t, joints, now.data() + tree().coordinates(), outside);
    return numbers_of(wanted, joints, motion);
  }

  /// The outputs of the i-th controller in dual numbers, under influences from outside.
  template <class Dual>
  [[nodiscard]] detail::VectorOn<Dual> outputs(std::size_t controller, const Dual& t,
                                               const detail::VectorOn<Dual>& y,
                                               const ControlDisturbance<Dual>& outside) const {
    const detail::VectorOn<Dual> joints = y.head(joint_count());
    MotionOfBodies<Dual> motion;
    if (loops_[controller].reads_bodies()) {
      motion = observed(t, joints, static_cast<const Dual*>(nullptr), outside);
    }
    return outputs_of(loops_[controller], t, y, Situation<Dual>{joints, motion, outside});
  }

  template <class Dual>
  requires(!std::same_as<Dual, double>)
      [[nodiscard]] detail::VectorOn<Dual> rates(double t, const detail::VectorOn<Dual>& y) const {
    return rates(Dual(t), y);
  }

  /// True if a controller is sampled.
  [[nodiscard]] bool has_samples() const {
    return std::any_of(loops_.begin(), loops_.end(),
                       [](const detail::ControlLoop& loop) { return loop.is_sampled(); });
  }

  /// The times in (begin, end], in order, at which controllers are sampled or delayed outputs
  /// follow.
  [[nodiscard]] std::vector<double> sample_times(double begin, double end) const {
    std::vector<double> times;
    for (const detail::ControlLoop& loop : loops_) loop.append_sample_times(begin, end, times);
    std::sort(times.begin(), times.end());
    const auto is_same = [](double a, double b) { return detail::is_same_time(a, b); };
    times.erase(std::unique(times.begin(), times.end(), is_same), times.end());
    return times;
  }

  /// Takes the samples that are due at t, in double or dual numbers. All controllers read the state
  /// before the samples.
  template <class N>
  void sample(const N& t, detail::VectorOn<N>& y) const {
    sample(t, y, ControlDisturbance<N>());
  }

  /// As above, under influences from outside.
  template <class N>
  void sample(const N& t, detail::VectorOn<N>& y, const ControlDisturbance<N>& outside) const {
    const double time = detail::number_in(t);
    const auto is_due = [time](const detail::ControlLoop& loop) {
      return loop.is_sampled() && loop.samples_at(time);
    };
    const detail::VectorOn<N> before = y;
    const detail::VectorOn<N> joints = y.head(joint_count());
    MotionOfBodies<N> motion;
    if (std::any_of(loops_.begin(), loops_.end(), [&](const detail::ControlLoop& loop) {
          return is_due(loop) && loop.reads_bodies();
        })) {
      motion = accelerated(t, before, outside);
    }
    for (const detail::ControlLoop& loop : loops_) {
      auto part = y.segment(loop.memory_begin(), loop.memory_size());
      detail::VectorOn<N> memory = part;
      if (is_due(loop)) {
        loop.sample(t, errors(loop, t, Situation<N>{joints, motion, outside}), memory);
      } else if (loop.is_sampled() && loop.releases_at(time)) {
        loop.release(memory);
      }
      part = memory;
    }
  }

  /// The field for steady states: the memory of sampled controllers changes by what a sample would
  /// change it, per period. It is 0 where nothing changes, with or without samples.
  template <class N>
  [[nodiscard]] detail::VectorOn<N> steady_rates(const N& t, const detail::VectorOn<N>& y) const {
    detail::VectorOn<N> result = rates(t, y);
    if (!has_samples()) return result;
    const detail::VectorOn<N> joints = y.head(joint_count());
    const ControlDisturbance<N> none;
    const auto motion = observed(t, joints, result.data() + tree().coordinates(), none);
    for (const detail::ControlLoop& loop : loops_) {
      if (!loop.is_sampled()) continue;
      const detail::VectorOn<N> before = y.segment(loop.memory_begin(), loop.memory_size());
      detail::VectorOn<N> memory = before;
      loop.sample(t, errors(loop, t, Situation<N>{joints, motion, none}), memory);
      if (loop.has_late_outputs()) loop.release(memory);
      const double period = loop.controller().period;
      for (Eigen::Index i = 0; i < memory.size(); ++i) {
        result[loop.memory_begin() + i] = (memory[i] - before[i]) / period;
      }
    }
    return result;
  }

  /// The outputs of the i-th controller.
  ///
  /// Units : N m or N; m of winches
  [[nodiscard]] Vector outputs(double t, const Vector& y, std::size_t controller) const {
    return outputs_after_samples(t, after_samples(t, y), controller);
  }

  /// As the functions of BodySystem, with the forces of the controllers.
  void reactions(double t, const Vector& y, JointReactions& result, Workspace& w) const {
    act(t, y, w);
    detail::reactions(tree(), system_.at(t, &w.bodies.outside), w.joints, result, w.bodies);
  }
  void element_forces(double t, const Vector& y, std::vector<Motor<>>& result, Workspace& w) const {
    act(t, y, w);
    detail::element_forces(tree(), system_.at(t, &w.bodies.outside), w.joints, result, w.bodies);
  }
  [[nodiscard]] std::vector<ConstraintReaction> constraint_reactions(double t, const Vector& y,
                                                                     Workspace& w) const {
    act(t, y, w);
    detail::accelerate(tree(), system_.at(t, &w.bodies.outside), w.joints,
                       w.bodies.acceleration.data(), w.bodies);
    return detail::constraint_reactions(tree(), w.bodies);
  }
  [[nodiscard]] LoadContext<> situation(double t, const Vector& y, int body, Workspace& w) const {
    return system_.situation(t, joints_of(y), body, w.bodies);
  }
  [[nodiscard]] ForceParts<Body> terms(double t, const Vector& y, int body, Workspace& w) const {
    act(t, y, w);
    return detail::terms(tree(), system_.at(t, &w.bodies.outside), w.joints, body, w.bodies);
  }
  [[nodiscard]] Terms terms() const {
    Terms all = system_.terms();
    all.add("load", "joint forces of controllers");
    return all;
  }
  [[nodiscard]] bool may_be_stiff() const { return true; }

  /// As BodySystem::corners(), with the winches of the controllers, and with the limits of continuous
  /// ones. At the time of samples the state is taken as it is.
  [[nodiscard]] bool has_corners() const { return system_.has_corners() || has_limits(); }
  [[nodiscard]] double corner_frequency() const {
    double greatest = system_.corner_frequency();
    for (const detail::ControlLoop& loop : loops_) {
      if (!loop.has_corners()) continue;
      for (const Signal<double>& reference : loop.controller().reference) {
        greatest = std::max(greatest, reference.greatest_frequency());
      }
    }
    return greatest;
  }
  [[nodiscard]] std::vector<Corner> corners(double t, const Vector& y) const {
    Workspace w = workspace();
    std::vector<Corner> result;
    if (system_.has_corners()) {
      act_after_samples(t, y, w);
      result = detail::corners(tree(), system_.at(t, &w.bodies.outside), w.joints, w.bodies);
    }
    if (has_limits()) append_limits(t, y, result, w);
    return result;
  }

  /// The motion of all bodies and the reactions, for sensors.
  [[nodiscard]] SystemKinematics kinematics(double t, const Vector& y, Workspace& w) const {
    return kinematics_after_samples(t, after_samples(t, y), w);
  }

  /// The same from a state after the samples at its time.
  [[nodiscard]] SystemKinematics kinematics_after_samples(double t, const Vector& after,
                                                          Workspace& w) const {
    act_after_samples(t, after, w);
    SystemKinematics result = detail::kinematics(tree(), system_.at(t, &w.bodies.outside), w.joints,
                                                 gravitation(), w.bodies);
    result.rates = rates(t, after);
    for (std::size_t i = 0; i < loops_.size(); ++i) {
      result.outputs.push_back(outputs_after_samples(t, after, i));
    }
    return result;
  }

  void project(Vector& y, Workspace& w) const {
    if (tree().constraints().empty()) return;
    set_joints(y, w);
    system_.project(w.joints, w.bodies);
    y.head(joint_count()) = w.joints;
  }
  [[nodiscard]] Vector assembled(const Vector& y) const {
    Vector result = y;
    result.head(joint_count()) = system_.assembled(joints_of(y));
    return result;
  }
  [[nodiscard]] Eigen::MatrixXd constraint_slopes(const Vector& y, const Eigen::MatrixXd& E) const {
    return system_.constraint_slopes(joints_of(y), E.topRows(joint_count()));
  }

 private:
  [[nodiscard]] Eigen::Index joint_count() const { return tree().coordinates() + tree().rates(); }
  [[nodiscard]] Vector joints_of(const Vector& y) const { return y.head(joint_count()); }
  void set_joints(const Vector& y, Workspace& w) const { w.joints = y.head(joint_count()); }
  [[nodiscard]] const BodyLoad* gravitation() const {
    return gravitation_ ? &*gravitation_ : nullptr;
  }

  void require(const Vector& y) const {
    if (y.size() == joint_count() + memory_) return;
    throw InvalidInput("controlled system: a state of " + std::to_string(y.size()) +
                       " components, not " + std::to_string(joint_count() + memory_));
  }

  void require_linear() const {
    for (const detail::ControlLoop& loop : loops_) {
      if (loop.is_linear()) continue;
      throw InvalidInput("controller '" + loop.name() +
                         "' is a callable, which has no linear equations: take a StateSpaceLaw");
    }
  }

  /// The joints, the motion of the bodies and the influences from outside that loops react to.
  template <class N>
  struct Situation {
    const detail::VectorOn<N>& joints;
    const MotionOfBodies<N>& motion;
    const ControlDisturbance<N>& outside;
  };

  template <class N>
  [[nodiscard]] MotionOfBodies<N> frame(const N& t, const Disturbance<N>& outside) const {
    MotionOfBodies<N> motion;
    motion.t = t;
    motion.guide = system_.guide_at(t, outside);
    motion.inertial_guide = motion.guide;
    motion.gravity = {detail::field(system_.gravity(), motion.guide), gravitation()};
    return motion;
  }

  template <class N>
  [[nodiscard]] MotionOfBodies<N> observed(const N& t, const detail::VectorOn<N>& joints,
                                           const N* dv,
                                           const ControlDisturbance<N>& outside) const {
    MotionOfBodies<N> motion = frame(t, outside.bodies);
    detail::MotionSpace<N> space(tree());
    detail::set_motion_of_bodies(tree(), joints, dv, space, motion);
    return motion;
  }

  /// The motion with the accelerations by the equations of motion.
  template <class N>
  [[nodiscard]] MotionOfBodies<N> accelerated(const N& t, const detail::VectorOn<N>& y,
                                              const ControlDisturbance<N>& outside) const {
    const detail::VectorOn<N> joints = y.head(joint_count());
    if constexpr (std::is_same_v<N, double>) {
      const detail::VectorOn<N> now = rates(t, y);
      return observed(t, joints, now.data() + tree().coordinates(), outside);
    } else {
      const detail::VectorOn<N> now = rates(t, y, outside);
      return observed(t, joints, now.data() + tree().coordinates(), outside);
    }
  }

  /// As observed(), in the memory of w.
  void observe(double t, Workspace& w, const Vector* rates) const {
    std::vector<BodyKinematics> bodies = std::move(w.motion.bodies);
    w.motion = frame(t, none_.bodies);
    w.motion.bodies = std::move(bodies);
    const double* const dv = rates == nullptr ? nullptr : rates->data() + tree().coordinates();
    detail::set_motion_of_bodies(tree(), w.joints, dv, w.bodies, w.motion);
  }

  template <class N>
  [[nodiscard]] detail::VectorOn<N> numbers_of(const std::vector<Reading>& wanted,
                                               const detail::VectorOn<N>& joints,
                                               const MotionOfBodies<N>& motion) const {
    detail::VectorOn<N> result(static_cast<Eigen::Index>(wanted.size()));
    for (Eigen::Index i = 0; i < result.size(); ++i) {
      const Reading& reading = wanted[static_cast<std::size_t>(i)];
      result[i] = detail::number_of(reading, tree(), joints, motion);
    }
    return result;
  }

  /// The control errors of a loop.
  template <class N>
  [[nodiscard]] detail::VectorOn<N> errors(const detail::ControlLoop& loop, const N& t,
                                           const Situation<N>& now) const {
    detail::VectorOn<N> e =
        loop.errors(t, numbers_of(loop.controller().reads, now.joints, now.motion));
    if (!now.outside.references.empty()) {
      e += now.outside.references[static_cast<std::size_t>(&loop - loops_.data())];
    }
    return e;
  }

  template <class N>
  [[nodiscard]] detail::VectorOn<N> outputs_of(const detail::ControlLoop& loop, const N& t,
                                               const detail::VectorOn<N>& y,
                                               const Situation<N>& now) const {
    const detail::VectorOn<N> x = y.segment(loop.memory_begin(), loop.memory_size());
    if (loop.is_sampled()) return loop.held(x);
    detail::VectorOn<N> u;
    detail::VectorOn<N> dx;
    detail::VectorOn<N> e;
    if (loop.feeds_through()) e = errors(loop, t, now);
    loop.evaluate(t, e, x, u, dx);
    return u;
  }

  /// Adds the outputs of all loops to `forces`, and sets the derivatives of the memory of those that
  /// feed their readings through.
  template <class N, class MemoryRates>
  void add_outputs(const N& t, const detail::VectorOn<N>& y, const Situation<N>& now,
                   OutsideForces<N>& forces, MemoryRates& memory_rates) const {
    detail::VectorOn<N> u;
    detail::VectorOn<N> dx;
    for (const detail::ControlLoop& loop : loops_) {
      const detail::VectorOn<N> x = y.segment(loop.memory_begin(), loop.memory_size());
      if (loop.is_sampled()) {
        u = loop.held(x);
      } else {
        detail::VectorOn<N> e;
        if (loop.feeds_through()) e = errors(loop, t, now);
        loop.evaluate(t, e, x, u, dx);
        if (loop.feeds_through()) set_rates(loop, dx, memory_rates);
      }
      for (int i = 0; i < loop.outputs(); ++i) {
        detail::add(loop.actuators()[static_cast<std::size_t>(i)], u[i], forces);
      }
    }
  }

  /// Sets the derivatives of the memory of the other continuous loops.
  template <class N, class MemoryRates>
  void complete(const N& t, const detail::VectorOn<N>& y, const Situation<N>& now,
                MemoryRates& memory_rates) const {
    detail::VectorOn<N> u;
    detail::VectorOn<N> dx;
    for (const detail::ControlLoop& loop : loops_) {
      if (loop.is_sampled() || loop.feeds_through()) continue;
      const detail::VectorOn<N> x = y.segment(loop.memory_begin(), loop.memory_size());
      loop.evaluate(t, errors(loop, t, now), x, u, dx);
      set_rates(loop, dx, memory_rates);
    }
  }

  template <class N, class MemoryRates>
  void set_rates(const detail::ControlLoop& loop, const detail::VectorOn<N>& dx,
                 MemoryRates& memory_rates) const {
    memory_rates.segment(loop.memory_begin() - joint_count(), loop.memory_size()) = dx;
  }

  [[nodiscard]] bool has_limits() const {
    return std::any_of(loops_.begin(), loops_.end(),
                       [](const detail::ControlLoop& loop) { return loop.has_corners(); });
  }

  /// Appends the corners of continuous loops at their limits.
  void append_limits(double t, const Vector& y, std::vector<Corner>& result, Workspace& w) const {
    Vector dy;
    rates(t, y, dy, w);
    const Vector rest = Vector::Zero(y.size());
    for (const detail::ControlLoop& loop : loops_) {
      if (!loop.has_corners()) continue;
      for (const Corner& corner : loop.corners(moving(loop, t, y, dy), moving(loop, t, y, rest))) {
        result.push_back(corner);
      }
    }
  }

  /// A continuous loop at a state that changes by dy per second.
  [[nodiscard]] detail::MovingLoop moving(const detail::ControlLoop& loop, double t,
                                          const Vector& y, const Vector& dy) const {
    using One = detail::AlongOne;
    const detail::VectorOn<One> state = y.binaryExpr(dy, &detail::with_rate);
    const One time = detail::with_rate(t, 1);
    detail::MovingLoop result{time, {}, state.segment(loop.memory_begin(), loop.memory_size())};
    if (!loop.feeds_through()) return result;
    const detail::VectorOn<One> joints = state.head(joint_count());
    const ControlDisturbance<One> none;
    MotionOfBodies<One> motion;
    if (loop.reads_bodies()) {
      motion = observed(time, joints, static_cast<const One*>(nullptr), none);
    }
    result.errors = errors(loop, time, Situation<One>{joints, motion, none});
    return result;
  }

  /// Sets the joints and the forces of the controllers in w, and the derivatives of the memory that
  /// are known without accelerations; the others are 0.
  template <class MemoryRates>
  void set_outputs(double t, const Vector& y, Workspace& w, MemoryRates& memory_rates) const {
    memory_rates.setZero();
    w.bodies.outside.joint_force.setZero(tree().rates());
    w.bodies.outside.on_bodies.clear();
    w.bodies.outside.winches.clear();
    if (reads_bodies_ && feeds_through_) observe(t, w, nullptr);
    add_outputs(t, y, Situation<double>{w.joints, w.motion, none_}, w.bodies.outside, memory_rates);
  }

  /// Sets the joints and the forces of the controllers in w.
  void act(double t, const Vector& y, Workspace& w) const {
    act_after_samples(t, after_samples(t, y), w);
  }

  void act_after_samples(double t, const Vector& y, Workspace& w) const {
    require(y);
    set_joints(y, w);
    Vector memory_rates(memory_);
    set_outputs(t, y, w, memory_rates);
  }

  [[nodiscard]] Vector after_samples(double t, const Vector& y) const {
    require(y);
    Vector result = y;
    sample(t, result);
    return result;
  }

  [[nodiscard]] Vector outputs_after_samples(double t, const Vector& y,
                                             std::size_t controller) const {
    const Vector joints = joints_of(y);
    MotionOfBodies<double> motion;
    if (loops_[controller].reads_bodies()) {
      motion = observed(t, joints, static_cast<const double*>(nullptr), none_);
    }
    return outputs_of(loops_[controller], t, y, Situation<double>{joints, motion, none_});
  }

  BodySystem<M> system_;
  std::optional<BodyLoad> gravitation_;
  std::vector<detail::ControlLoop> loops_;
  int memory_ = 0;
  bool reads_bodies_ = false;   ///< a continuous loop reads more than joints
  bool feeds_through_ = false;  ///< an output of a continuous loop depends on a reading
  ControlDisturbance<double> none_ = {};
  bool completes_later_ = false;  ///< a continuous loop needs readings after the accelerations
};

static_assert(Scene<ControlledSystem<RestingFrame<>>> &&
              HasTree<ControlledSystem<RestingFrame<>>> &&
              HasSamples<ControlledSystem<RestingFrame<>>> &&
              HasDualRates<ControlledSystem<RestingFrame<>>>);

}  // namespace kreisel
