#pragma once

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include <dynamics/step/accuracy.hpp>
#include <dynamics/step/compensated.hpp>
#include <dynamics/step/shared.hpp>

namespace kreisel {

/// Integration of  y' = f(t, y)  by the Taylor series of the solution, with adaptive steps, for
/// scenes whose series can be had coefficient by coefficient.
///
/// The step follows from the last two coefficients, so no step is ever rejected; what they cannot
/// know is a field that changes its formula on the way: its jumps have to be announced. Output
/// between the ends of a step is the series itself and costs no evaluation.
///
/// Vector : Eigen::Matrix<double, n, 1> or Eigen::VectorXd
/// Series : series(t, h, order, c) fills the columns 1 to `order` of an n x (most_order + 1) matrix c
///          with the coefficients of the solution in powers of (time - t)/h, from column 0, which is
///          the state at t; Series::most_order is the greatest order it is asked for, and
///          Series::relative_order, if there, the best order over that of most
/// Blocks : as ExplicitSteps
/// Source : order and step: A. Jorba, M. Zou, A software package for the numerical integration of
///          ODEs by means of high-order Taylor methods, Experimental Mathematics 14 (2005) 99
/// Error  : that of a step, relative, is about `accuracy.relative`
/// Cost   : a series of order 9 to 24 a step, by the accuracy; its coefficients count as evaluations
/// Throws : as ExplicitSteps
template <class Vector, class Series>
class TaylorSteps {
 public:
  using Scalar = double;

  TaylorSteps(Series series, double t, const Vector& y, const Accuracy& accuracy = {},
              std::span<const int> blocks = {})
      : series_(std::move(series)),
        accuracy_(accuracy),
        time_{t, 0},
        state_{y, Vector::Zero(y.size())},
        sizes_(blocks, accuracy.smallest, y),
        before_{time_, state_} {
    detail::check(accuracy, detail::least_over_long_ways);
    if (!std::isfinite(t)) detail::refuse_steps("the start time is not finite");
    if (!detail::finite(y)) detail::refuse_steps("the state at the start is not finite");
    order_ = order_for(accuracy.relative);
    coefficient_.setZero(y.size(), most_order + 1);
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
    expand();
    const double left = (goal - time_.value) - time_.rest;
    const double reach = scale_ * reached_from_here();
    const bool last = !(reach < std::abs(left));
    const double h = last ? left : std::copysign(reach, left);
    if (!last && std::abs(h) <= 4 * std::numeric_limits<double>::epsilon() * std::abs(t())) {
      detail::stop_integration(t(), "the step has become too short to move time on");
    }
    before_ = {time_, state_};
    Vector increment = change(h / scale_);
    detail::shake(increment, accuracy_.shaken, effort_.steps, h);
    state_.add(increment);
    if (!detail::finite(y())) {
      state_ = before_.state;
      detail::stop_integration(t(), "the field is not finite");
    }
    time_.add(h);
    if (last) time_ = {goal, 0};
    sizes_.note(y());
    effort_.steps += 1;
    squares_ += h * h;
    if (std::fmod(effort_.steps, 4) == 1) note_noise();
    next_scale_ = reach < std::numeric_limits<double>::max() ? reach : std::abs(h);
  }

  /// Whether a time lies within the last step.
  [[nodiscard]] bool covers(double time) const {
    const double from = before_.time.value;
    return time >= std::min(from, t()) && time <= std::max(from, t());
  }

  /// The state at a time within the last step.
  ///
  /// Throws : InvalidInput for a time outside of it
  [[nodiscard]] Vector at(double time) const {
    const double from = before_.time.value;
    if (!covers(time)) {
      detail::refuse_steps("t = ", time, " s lies outside the last step, [", from, ", ", t(),
                           "] s");
    }
    if (time == t()) return y();
    if (time == from) return before_.state.value;
    const double part = ((time - from) - before_.time.rest) / scale_;
    return before_.state.value + (change(part) + before_.state.rest);
  }

  /// Goes back to a time within the last step and continues from there.
  void back_to(double time) {
    state_ = {at(time), Vector::Zero(y().size())};
    time_ = {time, 0};
    before_ = {time_, state_};
  }

  /// The length of the last step.
  [[nodiscard]] double length() const { return std::abs(t() - before_.time.value); }

  /// As ExplicitSteps::noise().
  [[nodiscard]] double noise() const { return 0.5 * sizes_.wander(squares_); }

  /// What the steps go on from, outputs within the last step included.
  template <class Bookmark>
  void pass(Bookmark& bookmark) {
    bookmark(time_, state_, before_.time, before_.state, scale_, next_scale_, sizes_, squares_,
             coefficient_, effort_);
  }

 private:
  static constexpr int most_order = Series::most_order;
  using Coefficients = Eigen::Matrix<double, Vector::RowsAtCompileTime, most_order + 1>;

  /// Where a step began.
  struct Begin {
    detail::Compensated<double> time;
    detail::Compensated<Vector> state;
  };

  /// Somewhat above the  1 - ln(accuracy)/2  of Jorba and Zou, who count coefficients alone: a step
  /// costs something besides.
  [[nodiscard]] static int order_for(double relative) {
    double best = 7.5 - 0.37 * std::log(relative);
    if constexpr (requires { Series::relative_order; }) best *= Series::relative_order;
    return std::clamp(int(std::lround(best)), 9, most_order);
  }

  /// The series from here on. The unit of time is the last step: powers of it stay within range.
  void expand() {
    if (effort_.evaluations > accuracy_.most_evaluations) {
      detail::stop_integration(t(), accuracy_.most_evaluations, " evaluations are spent");
    }
    coefficient_.col(0) = y();
    if (next_scale_ == 0) next_scale_ = first_scale();
    constexpr int most_tries = 40;  // from 1e308 down to any rate that is a number
    for (int i = 0; i < most_tries; ++i) {
      scale_ = next_scale_;
      series_(t(), scale_, order_, coefficient_);
      effort_.evaluations += order_;
      const Vector last = coefficient_.col(order_);
      if (detail::finite(last)) return;
      next_scale_ *= 1e-8;
    }
    detail::stop_integration(t(), "the field is not finite");
  }

  /// The time in which the state changes by itself.
  [[nodiscard]] double first_scale() {
    series_(t(), 1, 1, coefficient_);
    effort_.evaluations += 1;
    const Vector rate = coefficient_.col(1);
    if (!detail::finite(rate)) detail::stop_integration(t(), "the field is not finite");
    return 100 * sizes_.first_step(rate);
  }

  /// How far the series carries, in units of its time.
  [[nodiscard]] double reached_from_here() const {
    const double reach = reached(1);
    // By a unit that is no step's length, a guess or a long rest's, the change is no measure.
    const bool misjudged = effort_.steps == 0 || reach < 0.5;
    return misjudged ? reached(std::min(reach, 1.0)) : reach;
  }

  /// To where the last two terms are what a step of about `length` may err by. Two, for of an even or
  /// odd solution one of them vanishes.
  [[nodiscard]] double reached(double length) const {
    const Vector change = length * coefficient_.col(1);
    double steepest = -std::numeric_limits<double>::infinity();
    for (int k = order_ - 1; k <= order_; ++k) {
      const double size = sizes_.relative(coefficient_.col(k), change) / accuracy_.relative;
      steepest = std::max(steepest, std::log(size) / k);
    }
    return std::exp(-steepest);
  }

  /// What the series makes of the state in s of its units of time, from the smallest terms on.
  [[nodiscard]] Vector change(double s) const {
    Vector sum = coefficient_.col(order_);
    for (int k = order_ - 1; k > 0; --k) sum = s * sum + coefficient_.col(k);
    return s * sum;
  }

  /// How the rate at the step's begin answers a change of the state in its last digits.
  void note_noise() {
    Coefficients moved(coefficient_.rows(), coefficient_.cols());
    Vector start = before_.state.value;
    detail::move_last_digits(start, 1);
    moved.col(0) = start;
    series_(before_.time.value, scale_, 1, moved);
    effort_.evaluations += 1;
    const Vector apart = (moved.col(1) - coefficient_.col(1)) / scale_;
    if (!detail::finite(apart)) return;
    sizes_.note_noise(apart, squares_);
    squares_ = 0;
  }

  Series series_;
  Accuracy accuracy_;
  int order_;
  detail::Compensated<double> time_;
  detail::Compensated<Vector> state_;
  detail::BlockSizes<Vector> sizes_;
  std::vector<double> jumps_;
  Begin before_;
  Coefficients coefficient_;  ///< of the last step, in powers of its time over scale_
  double scale_ = 1;
  double next_scale_ = 0;
  double squares_ = 0;  ///< of steps, summed since noise was looked at
  Effort effort_;
};

}  // namespace kreisel
