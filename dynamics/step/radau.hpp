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

/// A field and its Jacobian as RadauIntegrator asks for them. Results have their size already.
class StiffField {
 public:
  virtual ~StiffField() = default;

  virtual void rate(double t, const Eigen::VectorXd& y, double* result) = 0;
  virtual void jacobian(double t, const Eigen::VectorXd& y, Eigen::MatrixXd& result) = 0;
};

/// Of states of the kind that the field takes.
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

 private:
  Field field_;
  J jacobian_;
  Vector rate_;  ///< of a size known at run time only, lest each call ask for memory
};

/// The stages Z of a Radau step and Newton's method for them. Plain loops, as in
/// Factors: they take the compiler a tenth of what Eigen's products do.
class RadauStages {
 public:
  /// The coefficients have to outlive it.
  RadauStages(const RadauCoefficients& coefficients, int components);

  Eigen::MatrixXd value;  ///< Z, a column each

  /// For the Jacobian of the field and a step of length h.
  void factorise(const Eigen::MatrixXd& J, double h);

  /// The first guess for a step from the collocation polynomial of the one before: in the latter's
  /// own time, 0 to 1, the new step begins at 1 + begin and is `length` long.
  void guess(double begin, double length);

  /// One iteration for  Z = h (A (x) 1) f,  f the field's rates at the stages; returns its change.
  const Eigen::MatrixXd& correct(const Eigen::MatrixXd& f, double h);

  /// sum_i weight_i Z_i
  [[nodiscard]] Eigen::VectorXd sum(const Eigen::VectorXd& weight) const;

  /// By the real factor, in place: what the error estimate takes.
  void solve(Eigen::VectorXd& rate) const;

 private:
  /// residual = f - Z A^-t / h
  void set_residual(const Eigen::MatrixXd& f, double h);

  const RadauCoefficients* coefficients_;
  Eigen::MatrixXd residual_;
  Eigen::MatrixXd change_;
  Eigen::VectorXd mode_;
  Eigen::VectorXcd pair_;
  Factors<double> real_;
  std::vector<Factors<std::complex<double>>> complex_;
};

/// The steps of RadauSteps. They know sizes only at run time and of the field what they are given at
/// each call, so that a program compiles them once for all its scenes.
class KREISEL_API RadauIntegrator {
 public:
  /// The coefficients have to outlive it.
  RadauIntegrator(const RadauCoefficients& coefficients, double t, const Eigen::VectorXd& y,
                  const Accuracy& accuracy, std::span<const int> blocks);

  [[nodiscard]] const double& t() const { return time_.value; }
  [[nodiscard]] const Eigen::VectorXd& y() const { return state_.value; }
  [[nodiscard]] const IntegrationStatistics& effort() const { return effort_; }

  /// Takes over the sizes that blocks have had before, which errors are measured by.
  void know_sizes(std::span<const double> sizes) { sizes_.know(sizes); }

  void stop_at(std::vector<double> jumps) { jumps_ = std::move(jumps); }

  /// One step towards `end`, not past it.
  ///
  /// output : the next time at which the state is wanted: what has died out by then need not be
  ///          resolved
  void step_towards(StiffField& field, double end, double output);

  /// The same, if a first step of length h stands; else nothing changes and false is returned.
  [[nodiscard]] bool try_first_step(StiffField& field, double h, double end, double output);

  /// The limit of a step's estimate, relative to sizes. It is above the accuracy, for the estimate is of
  /// lower order than the step.
  [[nodiscard]] double allowed() const { return allowed_; }

  /// The greatest rate of the field times the length of the last step.
  [[nodiscard]] double fastest_times_step() const { return fastest_ * std::abs(h_before_); }

  [[nodiscard]] bool covers(double time) const;
  [[nodiscard]] Eigen::VectorXd at(StiffField& field, double time);
  void back_to(StiffField& field, double time);
  [[nodiscard]] double noise() const;

  template <class Checkpoint>
  void pass(Checkpoint& checkpoint) {
    checkpoint(sizes_, time_, state_, before_.time, before_.state, start_time_, last_stage_time_,
               step_, h_before_, worst_before_, rejected_.end, rejected_.step, rejected_.worst,
               rate_, stages_.value, tangent_, noise_, added_, effort_, rates_of_field_, fastest_,
               growth_, steps_to_spectrum_, looked_at_, quiet_, barrier_.length, barrier_.steps,
               barrier_.patience);
  }

 private:
  struct Begin {
    Compensated<double> time;
    Compensated<Eigen::VectorXd> state;
  };

  /// The last try at a step that did not stand, while t is within it.
  struct Rejected {
    double end = 0;
    double step = 0;  ///< 0 if there is none
    double worst = 0;
  };

  /// The longest step that resolves the fastest living motion: for how many steps it is kept to, and
  /// for how many it will be the next time.
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

  /// Begins a step: the field, its Jacobian and, now and then, its spectrum.
  void begin_step(StiffField& field, double goal);
  void note_spectrum();

  /// The step length, kept so short that growing motions are resolved.
  [[nodiscard]] double limited(double step) const;

  /// Motions that a step does not resolve: the greatest of their rates, and what part of the slowest
  /// to die is left at the next output. 0 if there are none.
  struct Unresolved {
    double fastest = 0;
    double remains = 0;
  };

  /// Of a step of length h, an output `left` ahead; those that have died out by then do not count.
  [[nodiscard]] Unresolved unresolved(double h, double left) const;

  /// The estimated error of a step of length h whose stages are known, in units of allowed_.
  [[nodiscard]] double estimate(double h);

  /// The same without what a stiff field makes of a start off its slow motion, which is not the
  /// step's error where it dies out.
  [[nodiscard]] double filtered_estimate(StiffField& field);

  /// The same estimate without what rounding makes of it, which would never fall to the accuracy.
  [[nodiscard]] double estimate_beyond_rounding();

  /// Sets the length of the next step after one of length h that erred by so much, by the controller
  /// of Gustafsson.
  void set_next_step(double h, double worst, bool again);

  /// Shortens the next step after one of length h that erred by so much.
  void reject(double h, double worst, double most, double fastest);

  void evaluate(StiffField& field, double t, const Eigen::VectorXd& y, double* result);
  /// The rate of the point that a step tries; whether there is one.
  [[nodiscard]] bool try_rate(StiffField& field, double at, double* result);
  void note_jacobian(StiffField& field);

  /// Newton's method for  Z = h (A (x) 1) field(y + Z).
  [[nodiscard]] bool solve_stages(StiffField& field, const Compensated<double>& time,
                                  const Compensated<Eigen::VectorXd>& state, double h);

  /// Whether the error of a step, where a longer one was rejected before, has fallen with the length
  /// no faster than a jump of the field lets it: then the estimate is the error, not far above it.
  [[nodiscard]] bool jumps_within(double h, double worst) const;

  /// What is allowed where the estimate is the error, in units of allowed_.
  [[nodiscard]] double least_allowed() const;

  /// One step of length h; says whether it stood. Sets the length of the next.
  bool attempt(StiffField& field, double h, double output, bool again);

  /// A random walk: each stage is off by half a last digit, of which the mean over the stages stays.
  /// What is damped within a step forgets what was.
  void note_noise();

  const RadauCoefficients* coefficients_;
  Accuracy accuracy_;
  double allowed_;
  BlockSizes<Eigen::VectorXd> sizes_;
  Compensated<double> time_;
  Compensated<Eigen::VectorXd> state_;
  Begin before_;
  std::vector<double> jumps_;
  double start_time_ = 0;       ///< no stage is earlier
  double last_stage_time_ = 0;  ///< or later
  double step_ = 0;
  double h_before_ = 0;  ///< of the step that the stages belong to; 0 if there is none
  double worst_before_ = 1;
  Rejected rejected_;
  Eigen::VectorXd rate_;
  RadauStages stages_;
  Eigen::VectorXd noise_;  ///< of the state, squared
  Eigen::MatrixXd rates_;  ///< at the stages
  // Lest each step ask for memory.
  Eigen::MatrixXd kept_;
  Eigen::VectorXd point_;
  Eigen::VectorXd change_;
  Eigen::VectorXd from_stages_;
  Eigen::VectorXd error_;
  Eigen::VectorXd added_;
  Eigen::MatrixXd tangent_;
  Eigen::MatrixXd rates_of_field_;  ///< eigenvalues of the Jacobian, a column each: Re, |Im|
  double fastest_ = 0;              ///< the greatest modulus of them
  double growth_ = 0;               ///< the greatest real part, beyond rounding
  int steps_to_spectrum_ = 0;       ///< until the eigenvalues are computed anew
  double looked_at_ = 0;            ///< length of the step for which they were
  int quiet_ = 0;                   ///< steps for which nothing unresolved is taken to live
  Barrier barrier_;
  IntegrationStatistics effort_;
  TrialFailure<double> failure_;
};

/// Of so many stages, made once.
template <int stages>
[[nodiscard]] const RadauCoefficients& radau_coefficients() {
  static const RadauCoefficients coefficients(stages);
  return coefficients;
}

}  // namespace detail

/// Implicit integration of a stiff  y' = field(t, y)  with adaptive steps, by Radau IIA.
///
/// A step is as long as what is slow allows: how hard a damped bearing is does not matter, from
/// 1e3 to 1e12 N m/rad. A growing motion is resolved. An oscillation that is faster than the steps and
/// does not die out before the next output is resolved too, if it is greater than the accuracy, and
/// ExplicitRungeKutta does that at less cost; a smaller one is damped.
///
/// Interface and meaning of the arguments as ExplicitRungeKutta; output within a step is of full order
/// and takes a part of the step anew. Steps ask for memory.
///
/// J      : callable (t, y) -> Jacobian<n>; forward_jacobian() or difference_jacobian() makes one.
///          It serves the iteration only: an error in it costs time, not digits
/// Error  : of a step, as asked for; where the solution rests on a stiff spring whose own end moves,
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

  /// Times at which the field jumps, in any order. Steps end there exactly.
  void stop_at(std::vector<double> jumps) { steps_.stop_at(std::move(jumps)); }

  /// Integrates to `end`, which is hit exactly; forwards or backwards.
  const Vector& advance_to(double end) {
    while (end != t()) step_towards(end);
    return y();
  }

  /// One step towards `end`, not past it.
  void step_towards(double end) {
    steps_.step_towards(field_, end, end);
    y_ = steps_.y();
  }

  /// Whether a time lies within the last step.
  [[nodiscard]] bool covers(double time) const { return steps_.covers(time); }

  /// The state at a time within the last step.
  ///
  /// Throws : InvalidInput for a time outside of it
  [[nodiscard]] Vector at(double time) { return steps_.at(field_, time); }

  /// Goes back to a time within the last step and continues from there.
  void back_to(double time) {
    steps_.back_to(field_, time);
    y_ = steps_.y();
  }

  /// What rounding of the state has made of it, by way of its rates: in proportion to size.
  [[nodiscard]] double noise() const { return steps_.noise(); }

  /// What the steps go on from, outputs within the last step included.
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
