#pragma once

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <complex>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include <dynamics/step/accuracy.hpp>
#include <dynamics/step/compensated.hpp>
#include <dynamics/step/factors.hpp>
#include <dynamics/step/jacobian.hpp>
#include <dynamics/step/radau_coefficients.hpp>
#include <dynamics/step/shared.hpp>
#include <motor/api.hpp>

namespace kreisel {

namespace detail {

/// The field and its Jacobian as RadauIntegrator calls them. Results have their size already.
class StiffField {
 public:
  virtual ~StiffField() = default;

  virtual void rate(double t, const Eigen::VectorXd& y, double* result) = 0;
  virtual void jacobian(double t, const Eigen::VectorXd& y, Eigen::MatrixXd& result) = 0;

  /// Moves a state onto the conditions of the field, if it has some.
  virtual void project(Eigen::VectorXd& /*y*/) {}
};

/// StiffField for states of the type that the field accepts.
template <class Vector, class Field, class J>
class StiffFieldOf final : public StiffField {
 public:
  StiffFieldOf(Field field, J jacobian)
      : field_(std::move(field)), jacobian_(std::move(jacobian)) {}

  void rate(double t, const Eigen::VectorXd& y, double* result) override {
    if constexpr (std::is_same_v<Vector, Eigen::VectorXd>) {
      rate_.resize(y.size());
      call(field_, t, y, rate_);
      std::copy_n(rate_.data(), rate_.size(), result);
    } else {
      const Vector rate = rate_of(field_, t, vector_of<Vector>(y));
      std::copy_n(rate.data(), rate.size(), result);
    }
  }

  void jacobian(double t, const Eigen::VectorXd& y, Eigen::MatrixXd& result) override {
    if constexpr (std::is_same_v<Vector, Eigen::VectorXd>) {
      result = jacobian_(t, y).of_state;
    } else {
      const auto tangent = jacobian_(t, vector_of<Vector>(y)).of_state;
      std::copy_n(tangent.data(), tangent.size(), result.data());
    }
  }

  void project(Eigen::VectorXd& y) override {
    if constexpr (requires { field_.project(y); }) field_.project(y);
  }

 private:
  Field field_;
  J jacobian_;
  Vector rate_;  ///< a member, because a vector of dynamic size would allocate in each call
};

/// The stages Z of a Radau step and Newton's method for them. Plain loops, as in LuFactors: they
/// compile in a tenth of the time of Eigen's products.
class RadauStages {
 public:
  /// The coefficients must outlive this object.
  RadauStages(const RadauCoefficients& coefficients, int components);

  Eigen::MatrixXd value;  ///< Z, a column each

  /// Factorises for the Jacobian of the field and a step of length h.
  void factorise(const Eigen::MatrixXd& J, double h);

  /// Sets the first guess from the collocation polynomial of the step before. In that step's own
  /// time, 0 to 1, the new step begins at 1 + begin and has the given length.
  void guess(double begin, double length);

  /// One iteration for Z = h (A (x) 1) f, with the field's rates f at the stages; returns its
  /// change.
  const Eigen::MatrixXd& correct(const Eigen::MatrixXd& f, double h);

  /// sum_i weight_i Z_i
  [[nodiscard]] Eigen::VectorXd sum(const Eigen::VectorXd& weight) const;

  /// Solves with the real factor, in place, for the error estimate.
  void solve(Eigen::VectorXd& rate) const;

 private:
  /// residual = f - Z A^-t / h
  void set_residual(const Eigen::MatrixXd& f, double h);

  const RadauCoefficients* coefficients_;
  Eigen::MatrixXd residual_;
  Eigen::MatrixXd change_;
  Eigen::VectorXd mode_;
  Eigen::VectorXcd pair_;
  LuFactors<double> real_;
  std::vector<LuFactors<std::complex<double>>> complex_;
};

/// The step control of RadauSteps. Sizes are run-time values and the field is an argument, so that
/// a program compiles this class once for all its scenes.
class KREISEL_API RadauIntegrator {
 public:
  /// The coefficients must outlive this object.
  RadauIntegrator(const RadauCoefficients& coefficients, double t, const Eigen::VectorXd& y,
                  const Accuracy& accuracy, std::span<const int> blocks);

  [[nodiscard]] const double& t() const { return time_.value; }
  [[nodiscard]] const Eigen::VectorXd& y() const { return state_.value; }
  [[nodiscard]] const IntegrationStatistics& effort() const { return effort_; }

  /// Takes over the block sizes of an earlier integration, relative to which errors are measured.
  void set_sizes(std::span<const double> sizes) { sizes_.set(sizes); }

  void stop_at(std::vector<double> jumps) { jumps_ = sorted(std::move(jumps)); }

  /// Continues from another state at the present time.
  void jump_to(const Eigen::VectorXd& y);

  /// One step towards `end`, not beyond `end`.
  ///
  /// output : the next output time: motions that have decayed by then need not be
  ///          resolved
  void step_towards(StiffField& field, double end, double output);

  /// The same, if a first step of length h is accepted. Otherwise nothing changes and the result is
  /// false.
  [[nodiscard]] bool try_first_step(StiffField& field, double h, double end, double output);

  /// The limit of a step's error estimate, relative to sizes. It is above the accuracy, because the
  /// estimate has a lower order than the step.
  [[nodiscard]] double allowed() const { return allowed_; }

  /// Modulus of the dominant eigenvalue times the length of the last step.
  [[nodiscard]] double fastest_times_step() const { return fastest_ * std::abs(h_before_); }

  [[nodiscard]] bool covers(double time) const;
  [[nodiscard]] Eigen::VectorXd at(StiffField& field, double time);
  void back_to(StiffField& field, double time);
  /// All that a step notes besides time and state.
  struct Notes {
    BlockSizes<Eigen::VectorXd> sizes;
    Eigen::VectorXd rounding_level;
  };
  [[nodiscard]] Notes notes() const { return {sizes_, rounding_level_}; }
  /// Goes back to the begin of the last step, with the notes of that time.
  void undo_step(const Notes& notes);
  [[nodiscard]] double rounding_level() const;

  template <class Checkpoint>
  void pass(Checkpoint& checkpoint) {
    checkpoint(sizes_, time_, state_, before_.time, before_.state, start_time_, last_stage_time_,
               step_, h_before_, worst_before_, rejected_.end, rejected_.step, rejected_.worst,
               rate_, stages_.value, tangent_, rounding_level_, effort_, rates_of_field_, fastest_,
               growth_, steps_to_spectrum_, looked_at_, quiet_, barrier_.length, barrier_.steps,
               barrier_.patience);
  }

 private:
  struct Begin {
    Compensated<double> time;
    Compensated<Eigen::VectorXd> state;
  };

  /// The last rejected try at a step, valid while t is within that step.
  struct Rejected {
    double end = 0;
    double step = 0;  ///< 0: none
    double worst = 0;
  };

  /// The longest step that resolves the fastest motion that is still excited. Also the number of
  /// steps for which it holds, now and the next time.
  struct Barrier {
    double length = 0;
    int steps = 0;
    int patience = 8;

    void take() {
      steps = patience;
      patience = std::min(2 * patience, 1 << 20);
    }
  };

  [[nodiscard]] int stages() const { return static_cast<int>(coefficients_->node.size()); }

  /// Begins a step: evaluates the field, its Jacobian and, at intervals, the spectrum.
  void begin_step(StiffField& field, double goal);
  void note_spectrum();

  /// The step length, limited so that growing motions are resolved.
  [[nodiscard]] double limited(double step) const;

  /// The angle, or the number of time constants, that a step resolves: steps of 2 of order 13 err by
  /// 1e-10.
  [[nodiscard]] double resolved_angle() const;

  /// The greatest rate of the motions that a step of length h does not resolve; 0 if there are none.
  /// Motions that have died at the next output, at the distance `left`, do not count.
  [[nodiscard]] double fastest_unresolved(double h, double left) const;

  /// The estimated error of a step of length h with known stages, in units of allowed_.
  [[nodiscard]] double estimate(double h);

  /// As above, without the response of a stiff field to a start off its slow motion. If that
  /// response decays, it is no error of the step.
  [[nodiscard]] double filtered_estimate(StiffField& field);

  /// The amplitude at the next output of the unresolved motions in this estimate, without its
  /// rounding, which would never decrease to the accuracy. In units of allowed_.
  [[nodiscard]] double living_amplitude(double h, double left);

  /// The error of a step and its limit, both in units of allowed_.
  struct Verdict {
    double worst;
    double most = 1;
    bool looks_new = false;  ///< unresolved motions were examined
    double lives = 0;        ///< the greatest rate of those that exceed the limit
  };

  /// The estimate has a lower order and therefore a higher limit. An unresolved motion smaller than
  /// that limit is invisible to the estimate. If such a motion persists until the next output, it
  /// must be as small as the accuracy. So must the estimate where the motion is not smooth.
  [[nodiscard]] Verdict judge(StiffField& field, double h, double output, bool again);

  /// True if an error may be rounding, which shorter steps do not reduce. The step is then about as
  /// long as the rounding of its time, or a longer step had no greater error. The error of a jump is
  /// in proportion to the length.
  [[nodiscard]] bool only_rounds(double h, double worst) const;

  /// True if the parts of the polynomial of a step of length h do not decrease as those of a smooth motion.
  [[nodiscard]] bool is_rough(double h) const;

  /// Sets the length of the next step from the length h and the error of this one, by Gustafsson's
  /// controller.
  void set_next_step(double h, double worst, bool again);

  /// Shortens the next step after a rejected one of length h with the given error.
  void reject(double h, double worst, double most, double fastest);

  void evaluate(StiffField& field, double t, const Eigen::VectorXd& y, double* result);
  /// Evaluates the field at a trial point; returns false if the field is undefined there.
  [[nodiscard]] bool try_rate(StiffField& field, double at, double* result);
  void note_jacobian(StiffField& field);

  /// Newton's method for  Z = h (A (x) 1) field(y + Z).
  [[nodiscard]] bool solve_stages(StiffField& field, const Compensated<double>& time,
                                  const Compensated<Eigen::VectorXd>& state, double h);

  /// True if the field may be discontinuous within the step: since a longer rejected step the error
  /// has fallen no faster than a discontinuity allows. The estimate then equals the error.
  [[nodiscard]] bool jumps_within(double h, double worst) const;

  /// The allowed error in units of allowed_, for steps whose estimate equals the error.
  [[nodiscard]] double least_allowed() const;

  /// One step of length h; returns true if it is accepted. Sets the length of the next step.
  bool attempt(StiffField& field, double h, double output, bool again);

  /// The rounding of a step, squared. Each stage is off by half a last digit, and the mean over the
  /// stages stays.
  [[nodiscard]] Eigen::VectorXd rounding_of_step();

  /// Adds the rounding of this step to a random walk. Motions that are damped within a step carry no
  /// rounding on.
  void note_rounding();

  const RadauCoefficients* coefficients_;
  Accuracy accuracy_;
  double allowed_;
  BlockSizes<Eigen::VectorXd> sizes_;
  Compensated<double> time_;
  Compensated<Eigen::VectorXd> state_;
  Begin before_;
  std::vector<double> jumps_;
  double start_time_ = 0;       ///< lower limit of stage times
  double last_stage_time_ = 0;  ///< upper limit of stage times
  double step_ = 0;
  double h_before_ = 0;  ///< of the step to which the stages belong; 0: none
  double worst_before_ = 1;
  Rejected rejected_;
  Eigen::VectorXd rate_;
  RadauStages stages_;
  Eigen::VectorXd rounding_level_;  ///< rounding level of the state, squared
  Eigen::MatrixXd rates_;           ///< at the stages
  // A member, so that steps allocate no memory.
  Eigen::MatrixXd kept_;
  Eigen::VectorXd point_;
  Eigen::VectorXd change_;
  Eigen::VectorXd from_stages_;
  Eigen::VectorXd error_;
  Eigen::MatrixXd tangent_;
  Eigen::MatrixXd rates_of_field_;  ///< eigenvalues of the Jacobian, a column each: Re, |Im|
  double fastest_ = 0;              ///< the greatest modulus of them
  double growth_ = 0;               ///< the greatest real part, beyond rounding
  int steps_to_spectrum_ = 0;       ///< until the eigenvalues are computed anew
  double looked_at_ = 0;            ///< length of the step at which they were computed
  int quiet_ = 0;                   ///< steps for which unresolved motions count as decayed
  Barrier barrier_;
  IntegrationStatistics effort_;
  TrialFailure<double> failure_;
};

/// Coefficients for a number of stages, computed once.
template <int stages>
[[nodiscard]] const RadauCoefficients& radau_coefficients() {
  static const RadauCoefficients coefficients(stages);
  return coefficients;
}

}  // namespace detail

/// Implicit integration of a stiff  y' = field(t, y)  with adaptive steps, by Radau IIA.
///
/// The slow motions determine the step length. The stiffness of a damped bearing does not matter,
/// from 1e3 to 1e12 N m/rad. A growing motion is resolved. An oscillation faster than the steps
/// that persists until the next output is resolved if it is greater than the accuracy.
/// ExplicitRungeKutta does that at less cost. A smaller oscillation is damped.
///
/// Interface and arguments as in ExplicitRungeKutta. Output within a step has full order and
/// repeats a part of the step. Steps allocate memory.
///
/// J      : callable (t, y) -> Jacobian<n>; forward_jacobian() or difference_jacobian() makes one.
///          It serves the iteration only: an error in it costs time, not digits
/// Error  : of a step, the accuracy; if the solution rests on a stiff spring whose own end moves,
///          the order falls to s + 1, and a step at accuracy a errs by up to a^((s + 1)/2s)
/// Source : as RadauCoefficients; error estimate and controller of Gustafsson: IV.8 there
/// Cost   : a step takes a Jacobian, (s + 1)/2 factorisations of the field's size and two to four
///          iterations of s evaluations
/// Throws : InvalidInput for an accuracy out of range or a start that is not finite;
///          ComputationFailed naming the time where steps become too short or too many
template <class Vector, class Field, class J, int stages = 7>
class RadauSteps {
 public:
  using Scalar = double;

  static constexpr int order = 2 * stages - 1;

  RadauSteps(Field field, J jacobian, double t, const Vector& y, const Accuracy& accuracy = {},
             std::span<const int> blocks = {})
      : field_(std::move(field), std::move(jacobian)),
        steps_(detail::radau_coefficients<stages>(), t, y, accuracy, blocks),
        y_(y) {}

  [[nodiscard]] const double& t() const { return steps_.t(); }
  [[nodiscard]] const Vector& y() const { return y_; }
  [[nodiscard]] const IntegrationStatistics& effort() const { return steps_.effort(); }

  /// Times at which the field is discontinuous, in any order. Steps end there exactly.
  void stop_at(std::vector<double> jumps) { steps_.stop_at(std::move(jumps)); }
  /// Continues from another state at the present time.
  void jump_to(const Vector& y) {
    steps_.jump_to(detail::vector_of<Eigen::VectorXd>(y));
    y_ = y;
  }

  /// Integrates to `end` exactly, forwards or backwards.
  const Vector& advance_to(double end) {
    while (end != t()) step_towards(end);
    return y();
  }

  /// One step towards `end`, not beyond `end`.
  void step_towards(double end) {
    steps_.step_towards(field_, end, end);
    y_ = steps_.y();
  }

  /// True if a time lies within the last step.
  [[nodiscard]] bool covers(double time) const { return steps_.covers(time); }

  /// The state at a time within the last step.
  ///
  /// Throws : InvalidInput for a time outside the last step
  [[nodiscard]] Vector at(double time) { return steps_.at(field_, time); }

  /// Goes back to a time within the last step and continues from there.
  void back_to(double time) {
    steps_.back_to(field_, time);
    y_ = steps_.y();
  }

  /// Error of the state due to rounding of its rates, relative to size.
  [[nodiscard]] double rounding_level() const { return steps_.rounding_level(); }

  /// Saves or restores all members from which the steps continue, with outputs within the last
  /// step.
  template <class Checkpoint>
  void pass(Checkpoint& checkpoint) {
    steps_.pass(checkpoint);
    y_ = steps_.y();
  }

 private:
  detail::StiffFieldOf<Vector, Field, J> field_;
  detail::RadauIntegrator steps_;
  Vector y_;
};

}  // namespace kreisel
