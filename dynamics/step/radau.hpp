#pragma once

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include <dynamics/step/accuracy.hpp>
#include <dynamics/step/compensated.hpp>
#include <dynamics/step/factors.hpp>
#include <dynamics/step/jacobian.hpp>
#include <dynamics/step/radau_coefficients.hpp>
#include <dynamics/step/shared.hpp>

namespace kreisel {

namespace detail {

/// The stages Z of a Radau step and Newton's method for them. It knows no field and sizes only at
/// run time, so that a program compiles its linear algebra once for all its scenes. Plain loops, as
/// in Factors: they take the compiler a tenth of what Eigen's products do.
class RadauStages {
 public:
  /// The coefficients have to outlive it.
  RadauStages(const RadauCoefficients& coefficients, int components)
      : value(Eigen::MatrixXd::Zero(components, coefficients.node.size())),
        coefficients_(&coefficients),
        residual_(value),
        change_(value),
        mode_(components),
        pair_(components),
        complex_(coefficients.pairs.size()) {}

  Eigen::MatrixXd value;  ///< Z, a column each

  /// For the Jacobian of the field and a step of length h.
  void factorise(const Eigen::MatrixXd& J, double h) {
    factorise_shifted(J, coefficients_->real.eigenvalue / h, real_);
    for (std::size_t k = 0; k < complex_.size(); ++k) {
      factorise_shifted(J, coefficients_->pairs[k].eigenvalue / h, complex_[k]);
    }
  }

  /// The first guess for a step from the collocation polynomial of the one before: in the latter's
  /// own time, 0 to 1, the new step begins at 1 + begin and is `length` long.
  void guess(double begin, double length) {
    // Newton's divided differences through (0, 0) and the old stages.
    const Eigen::VectorXd& c = coefficients_->node;
    const Eigen::Index stages = c.size();
    Eigen::MatrixXd difference = value;
    const auto divide = [&](Eigen::Index i, double distance) {
      for (Eigen::Index r = 0; r < difference.rows(); ++r) {
        difference(r, i) = (difference(r, i) - difference(r, i - 1)) / distance;
      }
    };
    for (Eigen::Index i = stages - 1; i > 0; --i) divide(i, c[i] - c[i - 1]);
    for (Eigen::Index r = 0; r < difference.rows(); ++r) difference(r, 0) /= c[0];
    for (Eigen::Index degree = 2; degree <= stages; ++degree) {
      for (Eigen::Index i = stages - 1; i >= degree - 1; --i) {
        divide(i, c[i] - (i == degree - 1 ? 0 : c[i - degree]));
      }
    }
    const auto at = [&](Eigen::Index r, double x) {
      double sum = difference(r, stages - 1);
      for (Eigen::Index i = stages - 2; i >= 0; --i) sum = difference(r, i) + (x - c[i]) * sum;
      return x * sum;
    };
    for (Eigen::Index r = 0; r < difference.rows(); ++r) {
      const double start = at(r, 1 + begin);
      for (Eigen::Index i = 0; i < stages; ++i) {
        value(r, i) = at(r, 1 + begin + length * c[i]) - start;
      }
    }
  }

  /// One iteration for  Z = h (A (x) 1) f,  f the field's rates at the stages; returns its change.
  const Eigen::MatrixXd& correct(const Eigen::MatrixXd& f, double h) {
    set_residual(f, h);
    const auto& real = coefficients_->real;
    combine(residual_, real.covector, mode_);
    real_.solve(mode_);
    for (Eigen::Index j = 0; j < change_.cols(); ++j) {
      for (Eigen::Index i = 0; i < change_.rows(); ++i) change_(i, j) = mode_[i] * real.vector[j];
    }
    for (std::size_t k = 0; k < complex_.size(); ++k) {
      const auto& pair = coefficients_->pairs[k];
      combine(residual_, pair.covector, pair_);
      complex_[k].solve(pair_);
      for (Eigen::Index j = 0; j < change_.cols(); ++j) {
        const std::complex<double> v = pair.vector[j];
        for (Eigen::Index i = 0; i < change_.rows(); ++i) {
          change_(i, j) += 2 * (pair_[i].real() * v.real() - pair_[i].imag() * v.imag());
        }
      }
    }
    value += change_;
    return change_;
  }

  /// sum_i weight_i Z_i
  [[nodiscard]] Eigen::VectorXd sum(const Eigen::VectorXd& weight) const {
    Eigen::VectorXd result(value.rows());
    combine(value, weight, result);
    return result;
  }

  /// By the real factor: what the error estimate takes.
  [[nodiscard]] Eigen::VectorXd solve(Eigen::VectorXd rate) const {
    real_.solve(rate);
    return rate;
  }

 private:
  /// Of  shift - J.
  template <class Number>
  static void factorise_shifted(const Eigen::MatrixXd& J, const Number& shift,
                                Factors<Number>& factors) {
    const Eigen::Index n = J.rows();
    factors.matrix.resize(n, n);
    for (Eigen::Index j = 0; j < n; ++j) {
      for (Eigen::Index i = 0; i < n; ++i) factors.matrix(i, j) = -J(i, j);
      factors.matrix(j, j) += shift;
    }
    factors.compute();
  }

  /// residual = f - Z A^-t / h
  void set_residual(const Eigen::MatrixXd& f, double h) {
    const Eigen::MatrixXd& inverse = coefficients_->inverse;
    const Eigen::Index n = value.rows();
    for (Eigen::Index j = 0; j < value.cols(); ++j) {
      double* const column = residual_.col(j).data();
      for (Eigen::Index i = 0; i < n; ++i) column[i] = inverse(j, 0) * value(i, 0);
      for (Eigen::Index k = 1; k < value.cols(); ++k) {
        for (Eigen::Index i = 0; i < n; ++i) column[i] += inverse(j, k) * value(i, k);
      }
      for (Eigen::Index i = 0; i < n; ++i) column[i] = f(i, j) - column[i] / h;
    }
  }

  /// result = sum_k weight_k columns_k
  template <class Vector>
  static void combine(const Eigen::MatrixXd& columns, const Vector& weight, Vector& result) {
    for (Eigen::Index i = 0; i < columns.rows(); ++i) result[i] = columns(i, 0) * weight[0];
    for (Eigen::Index k = 1; k < columns.cols(); ++k) {
      for (Eigen::Index i = 0; i < columns.rows(); ++i) result[i] += columns(i, k) * weight[k];
    }
  }

  const RadauCoefficients* coefficients_;
  Eigen::MatrixXd residual_;
  Eigen::MatrixXd change_;
  Eigen::VectorXd mode_;
  Eigen::VectorXcd pair_;
  Factors<double> real_;
  std::vector<Factors<std::complex<double>>> complex_;
};

}  // namespace detail

/// Implicit integration of a stiff  y' = field(t, y)  with adaptive steps, by Radau IIA.
///
/// A step is as long as what is slow allows: how hard a damped bearing is does not matter, from
/// 1e3 to 1e12 N m/rad. It damps what is faster than its steps, be it damped or not: an oscillation
/// has to be resolved by it as by any other method, and ExplicitSteps does that at less cost.
///
/// Interface and meaning of the arguments as ExplicitSteps; output within a step is of full order
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
      : field_(std::move(field)),
        jacobian_(std::move(jacobian)),
        accuracy_(accuracy),
        sizes_(blocks, accuracy.smallest, y),
        time_{t, 0},
        state_{y, Vector::Zero(y.size())},
        before_{time_, state_},
        rate_(Vector::Zero(y.size())),
        stages_(radau(), static_cast<int>(y.size())) {
    detail::check(accuracy);
    if (!std::isfinite(t)) detail::refuse_steps("the start time is not finite");
    if (!finite(y)) detail::refuse_steps("the state at the start is not finite");
    // The estimate is of order s + 1 where the step is of order 2 s: it is held against as much
    // more as that makes.
    allowed_ = std::max(0.3 * std::pow(accuracy.relative, (stages + 1.0) / (2 * stages)),
                        accuracy.relative);
  }

  [[nodiscard]] const double& t() const { return time_.value; }
  [[nodiscard]] const Vector& y() const { return state_.value; }
  [[nodiscard]] const Effort& effort() const { return effort_; }

  /// Times at which the field jumps, in any order. Steps end there exactly.
  void stop_at(std::vector<double> jumps) { jumps_ = std::move(jumps); }

  /// Integrates to `end`, which is hit exactly; forwards or backwards.
  const Vector& advance_to(double end) {
    while (end != t()) step_towards(end);
    return y();
  }

  /// One step towards `end`, not past it.
  void step_towards(double end) {
    if (!std::isfinite(end)) detail::refuse_steps("the end time is not finite");
    if (end == t()) return;
    const double goal = detail::next_stop(t(), end, jumps_);
    start_time_ = detail::on_this_side(t(), goal, jumps_);
    rate_ = evaluate(start_time_, y());
    if (!finite(rate_)) detail::stop_integration(t(), "the field is not finite");
    if (step_ == 0) step_ = sizes_.first_step(rate_);
    note_jacobian();
    before_ = {time_, state_};
    if (goal > t() ? t() >= rejected_.end : t() <= rejected_.end) rejected_ = {};
    bool again = false;
    while (true) {
      const double left = (goal - time_.value) - time_.rest;
      const bool last = std::abs(left) <= std::abs(step_);
      const double wanted = step_;
      last_stage_time_ = detail::on_this_side(goal, t(), jumps_);
      if (!attempt(last ? left : std::copysign(step_, left), again)) {
        again = true;
        continue;
      }
      if (last) {
        time_ = {goal, 0};
        step_ = std::max(step_, wanted);
      }
      return;
    }
  }

  /// Whether a time lies within the last step.
  [[nodiscard]] bool covers(double time) const {
    return time >= std::min(before_.time.value, t()) && time <= std::max(before_.time.value, t());
  }

  /// The state at a time within the last step.
  ///
  /// Throws : InvalidInput for a time outside of it
  [[nodiscard]] Vector at(double time) {
    if (!covers(time)) {
      detail::refuse_steps("t = ", time, " s lies outside the last step, [", before_.time.value,
                           ", ", t(), "] s");
    }
    if (time == t()) return y();
    if (time == before_.time.value) return before_.state.value;
    const Eigen::MatrixXd kept = stages_.value;
    const double h = (time - before_.time.value) - before_.time.rest;
    stages_.factorise(tangent_, h);
    stages_.guess(-1, h / h_before_);
    const bool done = solve_stages(before_.time, before_.state, h);
    Vector there = before_.state.value + (last_stage() + before_.state.rest);
    stages_.value = kept;
    if (!done) detail::stop_integration(time, "the stages of a part of a step do not converge");
    return there;
  }

  /// Goes back to a time within the last step and continues from there.
  void back_to(double time) {
    const Vector there = at(time);
    time_ = {time, 0};
    state_ = {there, Vector::Zero(there.size())};
    before_ = {time_, state_};
    h_before_ = 0;
  }

  /// What rounding of the state has made of it, by way of its rates: in proportion to size.
  [[nodiscard]] double noise() const {
    return sizes_.relative(noise_.cwiseSqrt(), Vector::Zero(noise_.size()));
  }

  /// What the steps go on from, outputs within the last step included.
  template <class Bookmark>
  void pass(Bookmark& bookmark) {
    bookmark(sizes_, time_, state_, before_.time, before_.state, start_time_, last_stage_time_,
             step_, h_before_, worst_before_, rejected_.end, rejected_.step, rejected_.worst, rate_,
             stages_.value, tangent_, noise_, effort_);
  }

 private:
  struct Begin {
    detail::Compensated<double> time;
    detail::Compensated<Vector> state;
  };

  /// The last try at a step that did not stand, while t is within it.
  struct Rejected {
    double end = 0;
    double step = 0;  ///< 0 if there is none
    double worst = 0;
  };

  [[nodiscard]] static const RadauCoefficients& radau() {
    static const RadauCoefficients coefficients(stages);
    return coefficients;
  }

  [[nodiscard]] Vector last_stage() const { return stages_.value.col(stages - 1); }

  template <class M>
  [[nodiscard]] static bool finite(const M& m) {
    return (m - m).isZero(0);
  }

  [[nodiscard]] Vector evaluate(double t, const Vector& y) {
    effort_.evaluations += 1;
    return detail::rate_of(field_, t, y);
  }

  void note_jacobian() {
    effort_.jacobians += 1;
    tangent_ = jacobian_(start_time_, y()).of_state;
    if (!finite(tangent_)) detail::stop_integration(t(), "the Jacobian of the field is not finite");
  }

  /// Newton's method for  Z = h (A (x) 1) field(y + Z).
  [[nodiscard]] bool solve_stages(const detail::Compensated<double>& time,
                                  const detail::Compensated<Vector>& state, double h) {
    constexpr int most_iterations = 12;
    constexpr double rounding = 4 * std::numeric_limits<double>::epsilon();
    // What is left errs to the same side in every step: it has to stay below what rounding makes.
    const double enough = std::max(accuracy_.relative / 20, rounding / 64);
    // Rounding in a stiff field ends the descent before rounding of the state would.
    const double stalled = 1e3 * std::max(accuracy_.relative / 20, rounding);
    double change_before = std::numeric_limits<double>::infinity();
    for (int iteration = 1; iteration <= most_iterations; ++iteration) {
      for (int i = 0; i < stages; ++i) {
        const double at = time.value + (radau().node[i] * h + time.rest);
        const bool late = h > 0 ? at > last_stage_time_ : at < last_stage_time_;
        rates_.col(i) = evaluate(late ? last_stage_time_ : at,
                                 state.value + (Vector(stages_.value.col(i)) + state.rest));
      }
      if (!finite(rates_)) return false;
      const Eigen::MatrixXd& correction = stages_.correct(rates_, h);
      double change = 0;
      for (int i = 0; i < stages; ++i) {
        change = std::max(change, sizes_.relative(correction.col(i), stages_.value.col(i)));
      }
      if (!std::isfinite(change)) return false;
      if (change <= std::min(enough, rounding) || change_before <= rounding) return true;
      if (iteration > 1) {
        const double shrinks = change / change_before;
        if (shrinks >= 1) return change <= stalled;
        if (shrinks / (1 - shrinks) * change <= enough) return true;
        const double at_the_end = std::pow(shrinks, most_iterations - iteration) * change;
        if (at_the_end > enough && change > stalled) return false;
      }
      change_before = change;
    }
    return change_before <= stalled;
  }

  /// Whether the error of a step, where a longer one was rejected before, has fallen with the length
  /// no faster than a jump of the field lets it: then the estimate is the error, not far above it.
  [[nodiscard]] bool jumps_within(double h, double worst) const {
    if (rejected_.step == 0) return false;
    const double shortened = std::abs(h) / rejected_.step;
    return worst > rejected_.worst * shortened * shortened;
  }

  /// What is allowed where the estimate is the error, in units of allowed_.
  [[nodiscard]] double least_allowed() const {
    constexpr double rounding = 64 * std::numeric_limits<double>::epsilon();
    return std::min(1.0, std::max(accuracy_.relative, rounding) / allowed_);
  }

  /// One step of length h; says whether it stood. Sets the length of the next.
  bool attempt(double h, bool again) {
    if (std::abs(h) <= 4 * std::numeric_limits<double>::epsilon() * std::abs(t()) || h == 0) {
      detail::stop_integration(t(), "the step has become too short to move time on");
    }
    if (effort_.evaluations > accuracy_.most_evaluations) {
      detail::stop_integration(t(), accuracy_.most_evaluations, " evaluations are spent");
    }
    const Eigen::MatrixXd kept = stages_.value;
    stages_.factorise(tangent_, h);
    if (h_before_ == 0) {
      stages_.value.setZero();
    } else {
      stages_.guess(0, h / h_before_);
    }
    if (!solve_stages(time_, state_, h)) {
      stages_.value = kept;
      effort_.rejected += 1;
      step_ = std::abs(h) / 4;
      return false;
    }
    const Vector change = last_stage();
    const Vector from_stages = stages_.sum(radau().error) / h;
    Vector error = stages_.solve(rate_ + from_stages);
    double worst = sizes_.relative(error, change) / allowed_;
    if (worst >= 1 && (again || effort_.steps == 0)) {
      // What a stiff field makes of a start off its slow motion is not the step's error.
      error = stages_.solve(evaluate(start_time_, y() + error) + from_stages);
      worst = sizes_.relative(error, change) / allowed_;
    }
    const double root = 1.0 / (stages + 1);
    const double most = jumps_within(h, worst) ? least_allowed() : 1;
    if (!(worst < most)) {
      stages_.value = kept;
      effort_.rejected += 1;
      const double aim = std::isfinite(worst) ? 0.9 * std::pow(worst / most, -root) : 0.125;
      step_ = std::abs(h) * std::clamp(aim, 0.125, 0.9);
      rejected_ = {t() + h, std::abs(h), worst};
      return false;
    }
    worst = std::max(worst, 1e-8);
    double aim = 0.9 * std::pow(worst, -root);
    if (h_before_ != 0) {
      aim = std::min(aim, aim * std::abs(h / h_before_) * std::pow(worst_before_ / worst, root));
    }
    step_ = std::abs(h) * std::clamp(aim, 0.2, again ? 1.0 : 8.0);
    worst_before_ = std::max(worst, 1e-2);
    h_before_ = h;
    effort_.steps += 1;
    note_noise();
    state_.add(change);
    time_.add(h);
    sizes_.note(y());
    return true;
  }

  /// A random walk: each stage is off by half a last digit, of which the mean over the stages stays.
  /// What is damped within a step forgets what was.
  void note_noise() {
    constexpr double half_digit = std::numeric_limits<double>::epsilon() / 2;
    const double eigenvalue = radau().real.eigenvalue;
    const double part = half_digit * eigenvalue / std::sqrt(double(stages));
    const auto n = static_cast<Eigen::Index>(y().size());
    Vector added = Vector::Zero(n);
    for (Eigen::Index j = 0; j < n; ++j) {
      added += stages_.solve(part * std::abs(y()[j]) * tangent_.col(j)).cwiseAbs2();
      const double stays = stages_.solve(Vector::Unit(n, j))[j] * eigenvalue / h_before_;
      noise_[j] *= std::min(1.0, stays * stays);
    }
    noise_ += added;
  }

  Field field_;
  J jacobian_;
  Accuracy accuracy_;
  double allowed_ = 0;
  detail::BlockSizes<Vector> sizes_;
  detail::Compensated<double> time_;
  detail::Compensated<Vector> state_;
  Begin before_;
  std::vector<double> jumps_;
  double start_time_ = 0;       ///< no stage is earlier
  double last_stage_time_ = 0;  ///< or later
  double step_ = 0;
  double h_before_ = 0;  ///< of the step that the stages belong to; 0 if there is none
  double worst_before_ = 1;
  Rejected rejected_;
  Vector rate_;
  detail::RadauStages stages_;
  Vector noise_ = Vector::Zero(y().size());  ///< of the state, squared
  Eigen::MatrixXd rates_ = stages_.value;    ///< at the stages
  Eigen::MatrixXd tangent_;
  Effort effort_;
};

}  // namespace kreisel
