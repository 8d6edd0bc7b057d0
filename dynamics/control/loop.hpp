#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <dynamics/control/actuator.hpp>
#include <dynamics/control/controller.hpp>
#include <dynamics/model/corner.hpp>
#include <dynamics/tree/description.hpp>
#include <dynamics/tree/tree.hpp>
#include <motor/api.hpp>

namespace kreisel::detail {

template <class S>
using VectorOn = Eigen::Matrix<S, Eigen::Dynamic, 1>;

/// The times first + k period, k = 0, 1, ..  Times that differ by rounding are the same.
class KREISEL_API SampleTimes {
 public:
  SampleTimes(double first, double period) : first_(first), period_(period) {}

  [[nodiscard]] bool contain(double t) const;

  /// Appends those in (begin, end].
  void append(double begin, double end, std::vector<double>& times) const;

 private:
  [[nodiscard]] double at(double k) const { return first_ + k * period_; }

  double first_;
  double period_;
};

/// Time, control errors and memory of a continuous loop, with their derivatives in one direction. The
/// errors are empty if its outputs do not depend on them.
struct MovingLoop {
  AlongOne t;
  VectorOn<AlongOne> errors;
  VectorOn<AlongOne> memory;
};

/// A controller of a tree: its law in state space and the positions of its outputs and memory.
///
/// Memory of a sampled loop: the states of the law; outputs that are not yet due, the latest first;
/// the outputs that are held.
class KREISEL_API ControlLoop {
 public:
  /// memory : position of the first number of its memory
  ///
  /// Throws : InvalidInput naming the controller and the reason
  ControlLoop(Controller controller, const BodyTree& tree, int memory);

  [[nodiscard]] const std::string& name() const { return controller_.name; }
  [[nodiscard]] const Controller& controller() const { return controller_; }
  [[nodiscard]] bool is_sampled() const { return controller_.period > 0; }
  [[nodiscard]] int inputs() const { return static_cast<int>(controller_.reads.size()); }
  [[nodiscard]] int outputs() const { return static_cast<int>(actuators_.size()); }
  [[nodiscard]] int memory_begin() const { return memory_; }
  [[nodiscard]] int memory_size() const;
  [[nodiscard]] const std::vector<Actuator>& actuators() const { return actuators_; }

  /// True if an output depends on a reading of the same moment.
  [[nodiscard]] bool feeds_through() const { return feeds_through_; }
  /// True if a reading depends on accelerations.
  [[nodiscard]] bool reads_accelerations() const;
  /// True if a reading depends on more than coordinates and rates of joints.
  [[nodiscard]] bool reads_bodies() const;
  /// False for a callable, which has no linear equations.
  [[nodiscard]] bool is_linear() const { return !callable_; }

  /// The memory at the start.
  [[nodiscard]] Eigen::VectorXd initial() const;

  /// The names of the memory: "NAME state 1", "NAME output BODY".
  [[nodiscard]] std::vector<std::string> memory_names() const;

  /// The control errors, from the readings.
  template <class S>
  [[nodiscard]] VectorOn<S> errors(const S& t, const VectorOn<S>& readings) const {
    VectorOn<S> e(readings.size());
    for (Eigen::Index i = 0; i < e.size(); ++i) {
      e[i] = -readings[i];
      if (!controller_.reference.empty()) {
        e[i] += controller_.reference[static_cast<std::size_t>(i)](t);
      }
    }
    return e;
  }

  /// The outputs of a continuous loop with the memory x, and the derivatives of x. `e` is empty if
  /// the readings are not known yet; the outputs must not depend on them.
  template <class S>
  void evaluate(const S& t, const VectorOn<S>& e, const VectorOn<S>& x, VectorOn<S>& u,
                VectorOn<S>& dx) const;

  /// True if a continuous loop has limits, at which its field has corners.
  [[nodiscard]] bool has_corners() const;

  /// These corners.
  ///
  /// along   : the loop along its motion
  /// in_time : with derivatives in time alone, at the same state
  [[nodiscard]] std::vector<Corner> corners(const MovingLoop& along,
                                            const MovingLoop& in_time) const;

  /// The outputs that a sampled loop holds.
  template <class S>
  [[nodiscard]] VectorOn<S> held(const VectorOn<S>& memory) const {
    return memory.tail(outputs());
  }

  /// True if the loop reads at t, or its delayed outputs follow then.
  [[nodiscard]] bool samples_at(double t) const { return reads_at_.contain(t); }
  [[nodiscard]] bool releases_at(double t) const { return late_ && late_->contain(t); }
  [[nodiscard]] bool has_late_outputs() const { return late_.has_value(); }
  void append_sample_times(double begin, double end, std::vector<double>& times) const;

  /// The memory after a sample at t with the control errors e.
  template <class S>
  void sample(const S& t, const VectorOn<S>& e, VectorOn<S>& memory) const;
  /// The memory after delayed outputs follow.
  template <class S>
  void release(VectorOn<S>& memory) const {
    memory.tail(outputs()) = memory.segment(states() + (waiting_ - 1) * outputs(), outputs());
  }

 private:
  void check() const;
  void set_pid(const PidLaw& pid);
  void set_derivative(const PidLaw& pid, int at);
  void set_delay();
  void check_limits() const;
  void check_winches(const BodyTree& tree) const;
  void check_readings(const BodyTree& tree) const;
  void check_body(const BodyTree& tree, int body) const;
  void check_carrier(const BodyTree& tree, int body) const;
  void check_frames(const BodyTree& tree, const Reading& reading) const;
  void check_matrices() const;
  [[noreturn]] void refuse(const std::string& why) const;

  [[nodiscard]] int states() const;

  /// How far output i is beyond its limit, if the integral of error e_i would drive it further; else 0.
  template <class S>
  [[nodiscard]] S winds_up(int i, const VectorOn<S>& u, const VectorOn<S>& e) const {
    if (integral_ == 0 || controller_.limit.empty()) return S(0);
    const S beyond = (integral_ * e[i] > S(0) ? u[i] : S(-u[i])) -
                     controller_.limit[static_cast<std::size_t>(i)];
    return beyond > S(0) ? beyond : S(0);
  }
  template <class S>
  void saturate(VectorOn<S>& u) const {
    for (Eigen::Index i = 0; i < u.size() && !controller_.limit.empty(); ++i) {
      const double limit = controller_.limit[static_cast<std::size_t>(i)];
      if (u[i] > S(limit)) u[i] = S(limit);
      if (u[i] < S(-limit)) u[i] = S(-limit);
    }
  }
  [[nodiscard]] VectorOn<AlongOne> corner_functions(const MovingLoop& loop) const;
  [[nodiscard]] double corner_rounding(const MovingLoop& loop) const;

  template <class S>
  void apply_law(const S& t, const VectorOn<S>& e, const VectorOn<S>& x, VectorOn<S>& u,
                 VectorOn<S>& dx) const;

  /// Beyond the limit of an output, relative to it, the integral of a continuous law fades out over
  /// this distance. If it stopped at once, an output that it alone drives up would chatter.
  static constexpr double fading = 1e-6;

  Controller controller_;
  int memory_;
  std::vector<Actuator> actuators_;
  StateSpaceLaw law_;                    ///< unless callable_
  std::optional<CallableLaw> callable_;  ///< of a law that is no matrix
  double integral_ = 0;                  ///< of a PidLaw whose states begin with the integrals
  bool feeds_through_ = false;
  int waiting_ = 0;  ///< number of outputs in the memory that wait
  SampleTimes reads_at_;
  std::optional<SampleTimes> late_;  ///< times at which delayed outputs follow, if not at samples
};

template <class S>
void ControlLoop::apply_law(const S& t, const VectorOn<S>& e, const VectorOn<S>& x, VectorOn<S>& u,
                            VectorOn<S>& dx) const {
  u = VectorOn<S>::Constant(outputs(), S(0));
  dx = VectorOn<S>::Constant(states(), S(0));
  if (callable_) {
    if constexpr (std::is_same_v<S, double>) callable_->law(t, e, x, u, dx);
    return;
  }
  const auto add = [](const Eigen::MatrixXd& A, const VectorOn<S>& b, VectorOn<S>& to) {
    for (Eigen::Index i = 0; i < A.rows(); ++i) {
      for (Eigen::Index k = 0; k < b.size(); ++k) {
        if (A(i, k) != 0) to[i] += A(i, k) * b[k];
      }
    }
  };
  add(law_.C, x, u);
  add(law_.A, x, dx);
  add(law_.D, e, u);
  add(law_.B, e, dx);
}

template <class S>
void ControlLoop::evaluate(const S& t, const VectorOn<S>& e, const VectorOn<S>& x, VectorOn<S>& u,
                           VectorOn<S>& dx) const {
  apply_law(t, e, x, u, dx);
  for (int i = 0; i < outputs() && e.size() > 0; ++i) {
    const S beyond = winds_up(i, u, e);
    if (!(beyond > S(0))) continue;
    const double faded = fading * controller_.limit[static_cast<std::size_t>(i)];
    dx[i] *= beyond < S(faded) ? S(1 - beyond / faded) : S(0);
  }
  saturate(u);
}

template <class S>
void ControlLoop::sample(const S& t, const VectorOn<S>& e, VectorOn<S>& memory) const {
  const VectorOn<S> x = memory.head(states());
  VectorOn<S> u;
  VectorOn<S> next;
  apply_law(t, e, x, u, next);
  for (int i = 0; i < outputs(); ++i) {
    // The integral grows no further than its output to the limit.
    const S beyond = winds_up(i, u, e);
    if (!(beyond > S(0))) continue;
    const S grown = integral_ * (next[i] - x[i]);
    const S size = grown > S(0) ? grown : S(-grown);
    const S too_much = beyond < size ? S(beyond / size) : S(1);
    u[i] -= too_much * grown;
    next[i] -= too_much * (next[i] - x[i]);
  }
  saturate(u);
  const int m = outputs();
  VectorOn<S> due = u;
  if (waiting_ > 0) due = memory.segment(states() + (waiting_ - 1) * m, m);
  for (int k = waiting_ - 1; k > 0; --k) {
    memory.segment(states() + k * m, m) = memory.segment(states() + (k - 1) * m, m).eval();
  }
  memory.head(states()) = next;
  if (waiting_ > 0) memory.segment(states(), m) = u;
  if (!late_) memory.tail(m) = due;
}

}  // namespace kreisel::detail
