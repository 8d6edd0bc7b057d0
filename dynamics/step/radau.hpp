#pragma once

#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstddef>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include <dynamics/step/accuracy.hpp>
#include <dynamics/step/compensated.hpp>
#include <dynamics/step/jacobian.hpp>
#include <dynamics/step/shared.hpp>

namespace kreisel {

/// Radau IIA collocation in s stages, s odd, of order 2 s - 1; the last node is the step's end.
///
///   sum_j A_ij c_j^k = c_i^(k+1)/(k+1),  k < s
///
/// The inverse of its matrix has one real eigenvalue and pairs of complex ones, by which Newton's
/// method for all stages at once falls into systems of the field's own size:
///
///   A^-1 = V diag(eigenvalue) V^-1
///
/// Source : E. Hairer, G. Wanner, Solving Ordinary Differential Equations II, IV.5 and IV.8; the
///          same, Stiff differential equations solved by Radau methods, J. Comput. Appl. Math. 111
///          (1999) 93
/// Error  : <= 2e-14 of the greatest                      (tests/dynamics/step/radau.cpp)
template <int s>
struct RadauCoefficients {
  static_assert(s % 2 == 1, "an odd number of stages leaves one real eigenvalue");

  static constexpr int pairs = (s - 1) / 2;

  using Square = Eigen::Matrix<double, s, s>;
  using Column = Eigen::Matrix<double, s, 1>;
  using ComplexColumn = Eigen::Matrix<std::complex<double>, s, 1>;

  Column node;
  Square inverse;  ///< A^-1

  double real_eigenvalue = 0;
  Column real_vector;    ///< of V
  Column real_covector;  ///< row of V^-1
  std::array<std::complex<double>, pairs> eigenvalue;
  std::array<ComplexColumn, pairs> vector;
  std::array<ComplexColumn, pairs> covector;

  /// Of the stages, in the error estimate  f(y) + sum_i error_i Z_i / h.
  Column error;

  RadauCoefficients() {
    using Real = long double;
    using RealSquare = Eigen::Matrix<Real, s, s>;
    using RealColumn = Eigen::Matrix<Real, s, 1>;
    RealColumn c;
    for (int i = 0; i < s; ++i) c[i] = (1 + zero(i)) / 2;
    RealSquare powers;    // of the nodes, a row each
    RealSquare integral;  // of those powers from 0 to the nodes
    for (int i = 0; i < s; ++i) {
      Real power = 1;
      for (int k = 0; k < s; ++k) {
        powers(i, k) = power;
        power *= c[i];
        integral(i, k) = power / static_cast<Real>(k + 1);
      }
    }
    const RealSquare A_inverse = powers * integral.inverse();
    node = c.template cast<double>();
    inverse = A_inverse.template cast<double>();

    const Eigen::EigenSolver<RealSquare> eigen(A_inverse);
    const auto V = eigen.eigenvectors();
    const auto V_inverse = V.inverse().eval();
    std::size_t next = 0;
    Real real_value = 0;
    for (int i = 0; i < s; ++i) {
      const std::complex<Real> value = eigen.eigenvalues()[i];
      if (value.imag() == 0) {
        real_value = value.real();
        real_vector = V.col(i).real().template cast<double>();
        real_covector = V_inverse.row(i).real().transpose().template cast<double>();
      } else if (value.imag() > 0) {
        eigenvalue[next] = std::complex<double>(value);
        vector[next] = V.col(i).template cast<std::complex<double>>();
        covector[next] = V_inverse.row(i).transpose().template cast<std::complex<double>>();
        ++next;
      }
    }
    real_eigenvalue = static_cast<double>(real_value);

    // A second formula of order s that takes f(y) with the weight 1/real_eigenvalue.
    RealColumn moments;
    for (int k = 0; k < s; ++k) moments[k] = 1 / static_cast<Real>(k + 1);
    moments[0] -= 1 / real_value;
    const RealColumn weights = powers.transpose().inverse() * moments;
    RealColumn e = A_inverse.transpose() * weights;
    e[s - 1] -= 1;
    error = (real_value * e).template cast<double>();
  }

 private:
  /// Of Legendre's P_s - P_s-1 in [-1, 1], ascending; the last is 1.
  [[nodiscard]] static long double zero(int i) {
    if (i == s - 1) return 1;
    long double x =
        -std::cos(std::numbers::pi_v<long double> * (static_cast<long double>(i) + 0.75L) / s);
    for (int iteration = 0; iteration < 12; ++iteration) {
      long double before = 1, P = x;
      for (int k = 1; k < s - 1; ++k) {
        const long double next =
            (static_cast<long double>(2 * k + 1) * x * P - static_cast<long double>(k) * before) /
            static_cast<long double>(k + 1);
        before = std::exchange(P, next);
      }
      const long double top =
          (static_cast<long double>(2 * s - 1) * x * P - static_cast<long double>(s - 1) * before) /
          static_cast<long double>(s);
      const auto slope = [&x](int n, long double P_n, long double P_before) {
        return static_cast<long double>(n) * (x * P_n - P_before) / (x * x - 1);
      };
      x -= (top - P) / (slope(s, top, P) - slope(s - 1, P, before));
    }
    return x;
  }
};

/// Implicit integration of a stiff  y' = field(t, y)  with adaptive steps, by Radau IIA.
///
/// A step is as long as what is slow allows: how hard a damped bearing is does not matter, from
/// 1e3 to 1e12 N m/rad. It damps what is faster than its steps, be it damped or not: an oscillation
/// has to be resolved by it as by any other method, and ExplicitSteps does that at less cost.
///
/// Interface and meaning of the arguments as ExplicitSteps; output within a step is of full order
/// and takes a part of the step anew.
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

  template <std::size_t n = 1>
  RadauSteps(Field field, J jacobian, double t, const Vector& y, const Accuracy& accuracy = {},
             const std::array<int, n>& blocks = {int(Vector::RowsAtCompileTime)})
      : field_(std::move(field)),
        jacobian_(std::move(jacobian)),
        accuracy_(accuracy),
        sizes_(blocks, accuracy.smallest, y),
        time_{t, 0},
        state_{y, Vector::Zero()},
        before_{time_, state_} {
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
    const Stages kept = stage_;
    const double h = (time - before_.time.value) - before_.time.rest;
    factorise(h);
    guess(-1, h / h_before_);
    const bool done = solve_stages(before_.time, before_.state, h);
    Vector there = before_.state.value + (stage_.col(stages - 1) + before_.state.rest);
    stage_ = kept;
    if (!done) detail::stop_integration(time, "the stages of a part of a step do not converge");
    return there;
  }

  /// Goes back to a time within the last step and continues from there.
  void back_to(double time) {
    const Vector there = at(time);
    time_ = {time, 0};
    state_ = {there, Vector::Zero()};
    before_ = {time_, state_};
    h_before_ = 0;
  }

 private:
  static constexpr int n = int(Vector::RowsAtCompileTime);
  static constexpr int pairs = RadauCoefficients<stages>::pairs;

  using Stages = Eigen::Matrix<double, n, stages>;
  using ComplexMatrix = Eigen::Matrix<std::complex<double>, n, n>;
  using ComplexVector = Eigen::Matrix<std::complex<double>, n, 1>;

  struct Begin {
    detail::Compensated<double> time;
    detail::Compensated<Vector> state;
  };

  [[nodiscard]] static const RadauCoefficients<stages>& radau() {
    static const RadauCoefficients<stages> coefficients;
    return coefficients;
  }

  template <class M>
  [[nodiscard]] static bool finite(const M& m) {
    return (m - m).isZero(0);
  }

  [[nodiscard]] Vector evaluate(double t, const Vector& y) {
    effort_.evaluations += 1;
    return field_(t, y);
  }

  void note_jacobian() {
    effort_.jacobians += 1;
    tangent_ = jacobian_(start_time_, y()).of_state;
    if (!finite(tangent_)) detail::stop_integration(t(), "the Jacobian of the field is not finite");
  }

  void factorise(double h) {
    const Eigen::Matrix<double, n, n> unit = Eigen::Matrix<double, n, n>::Identity();
    real_.compute(radau().real_eigenvalue / h * unit - tangent_);
    for (std::size_t k = 0; k < pairs; ++k) {
      complex_[k].compute(radau().eigenvalue[k] / h * unit - tangent_);
    }
  }

  /// The stages of a step, from the collocation polynomial of the one before: in the latter's own
  /// time, 0 to 1, the new step begins at 1 + begin and is `length` long.
  void guess(double begin, double length) {
    if (h_before_ == 0) {
      stage_.setZero();
      return;
    }
    // Newton's divided differences through (0, 0) and the old stages.
    const auto& c = radau().node;
    Stages difference = stage_;
    for (int i = stages - 1; i > 0; --i) {
      difference.col(i) = (difference.col(i) - difference.col(i - 1)) / (c[i] - c[i - 1]);
    }
    difference.col(0) /= c[0];
    for (int degree = 2; degree <= stages; ++degree) {
      for (int i = stages - 1; i >= degree - 1; --i) {
        const double left = i == degree - 1 ? 0 : c[i - degree];
        difference.col(i) = (difference.col(i) - difference.col(i - 1)) / (c[i] - left);
      }
    }
    const auto value = [&](double x) {
      Vector sum = difference.col(stages - 1);
      for (int i = stages - 2; i >= 0; --i) sum = difference.col(i) + (x - c[i]) * sum;
      return Vector(x * sum);
    };
    const Vector start = value(1 + begin);
    Stages result;
    for (int i = 0; i < stages; ++i) result.col(i) = value(1 + begin + length * c[i]) - start;
    stage_ = result;
  }

  /// Newton's method for  Z = h (A (x) 1) field(y + Z).
  [[nodiscard]] bool solve_stages(const detail::Compensated<double>& time,
                                  const detail::Compensated<Vector>& state, double h) {
    constexpr int most_iterations = 12;
    constexpr double rounding = 4 * std::numeric_limits<double>::epsilon();
    const double enough = std::max(accuracy_.relative / 20, rounding);
    double change_before = 0;
    for (int iteration = 1; iteration <= most_iterations; ++iteration) {
      Stages f;
      for (int i = 0; i < stages; ++i) {
        const double at = time.value + (radau().node[i] * h + time.rest);
        const bool late = h > 0 ? at > last_stage_time_ : at < last_stage_time_;
        f.col(i) = evaluate(late ? last_stage_time_ : at,
                            state.value + (Vector(stage_.col(i)) + state.rest));
      }
      if (!finite(f)) return false;
      const Stages residual = f - stage_ * radau().inverse.transpose() / h;
      Stages correction =
          real_.solve(Vector(residual * radau().real_covector)) * radau().real_vector.transpose();
      for (std::size_t k = 0; k < pairs; ++k) {
        const ComplexVector w = complex_[k].solve(ComplexVector(residual * radau().covector[k]));
        correction += 2 * (w * radau().vector[k].transpose()).real();
      }
      stage_ += correction;
      double change = 0;
      for (int i = 0; i < stages; ++i) {
        change = std::max(change, sizes_.relative(correction.col(i), stage_.col(i)));
      }
      if (!std::isfinite(change)) return false;
      if (change <= rounding) return true;
      if (iteration > 1) {
        const double shrinks = change / change_before;
        // Rounding in a stiff field ends the descent before rounding of the state would.
        if (shrinks >= 1) return change <= 1e3 * enough && iteration > 2;
        if (shrinks / (1 - shrinks) * change <= enough) return true;
        const double at_the_end = std::pow(shrinks, most_iterations - iteration) * change;
        if (at_the_end > enough) return false;
      }
      change_before = change;
    }
    return false;
  }

  /// One step of length h; says whether it stood. Sets the length of the next.
  bool attempt(double h, bool again) {
    if (std::abs(h) <= 4 * std::numeric_limits<double>::epsilon() * std::abs(t()) || h == 0) {
      detail::stop_integration(t(), "the step has become too short to move time on");
    }
    if (effort_.evaluations > accuracy_.most_evaluations) {
      detail::stop_integration(t(), accuracy_.most_evaluations, " evaluations are spent");
    }
    const Stages kept = stage_;
    factorise(h);
    guess(0, h_before_ == 0 ? 0 : h / h_before_);
    if (!solve_stages(time_, state_, h)) {
      stage_ = kept;
      effort_.rejected += 1;
      step_ = std::abs(h) / 4;
      return false;
    }
    const Vector change = stage_.col(stages - 1);
    const Vector from_stages = stage_ * (radau().error / h);
    Vector error = real_.solve(Vector(rate_ + from_stages));
    double worst = sizes_.relative(error, change) / allowed_;
    if (worst >= 1 && (again || effort_.steps == 0)) {
      // What a stiff field makes of a start off its slow motion is not the step's error.
      error = real_.solve(Vector(evaluate(start_time_, y() + error) + from_stages));
      worst = sizes_.relative(error, change) / allowed_;
    }
    const double root = 1.0 / (stages + 1);
    if (!(worst < 1)) {
      stage_ = kept;
      effort_.rejected += 1;
      const double aim = std::isfinite(worst) ? 0.9 * std::pow(worst, -root) : 0.125;
      step_ = std::abs(h) * std::clamp(aim, 0.125, 0.9);
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
    state_.add(change);
    time_.add(h);
    sizes_.note(y());
    return true;
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
  double h_before_ = 0;  ///< of the step that stage_ belongs to; 0 if there is none
  double worst_before_ = 1;
  Vector rate_ = Vector::Zero();
  Stages stage_ = Stages::Zero();  ///< Z
  Eigen::Matrix<double, n, n> tangent_ = Eigen::Matrix<double, n, n>::Zero();
  Eigen::PartialPivLU<Eigen::Matrix<double, n, n>> real_;
  std::array<Eigen::PartialPivLU<ComplexMatrix>, pairs> complex_;
  Effort effort_;
};

}  // namespace kreisel
