#pragma once

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include <dynamics/step/accuracy.hpp>
#include <dynamics/step/compensated.hpp>
#include <dynamics/step/shared.hpp>

namespace kreisel {

/// The series of a motion cannot go on where its field can: another method may.
struct SeriesFailed : ComputationFailed {
  using ComputationFailed::ComputationFailed;
};

/// Integration of  y' = f(t, y)  by the Taylor series of the solution, with adaptive steps, for
/// scenes whose series can be had coefficient by coefficient.
///
/// The step follows from the last coefficients. The field at the end of every step is compared with
/// the rate of the series there, so that a step on which the series does not solve the equation is
/// rejected and shortened. Output between the ends of a step is the series itself and costs no
/// evaluation.
///
/// Vector : Eigen::Matrix<double, n, 1> or Eigen::VectorXd
/// Series : series(t, h, order, c) fills the columns 1 to `order` of an n x (most_order + 1) matrix c
///          with the coefficients of the solution in powers of (time - t)/h, from column 0, which is
///          the state at t; Series::most_order is the greatest order it is asked for, and
///          Series::relative_order, if there, the best order over that of most
/// Blocks : as ExplicitRungeKutta
/// Source : order and step: A. Jorba, M. Zou, A software package for the numerical integration of
///          ODEs by means of high-order Taylor methods, Experimental Mathematics 14 (2005) 99
/// Error  : that of a step, relative, is about `accuracy.relative`
/// Cost   : a series of order 9 to 24 a step, by the accuracy, and the field at the step's end; the
///          coefficients count as evaluations
/// Throws : as ExplicitRungeKutta; SeriesFailed where the field is finite and the series cannot go on
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
        sizes_(blocks, accuracy.absolute_scale, y),
        before_{time_, state_} {
    detail::check(accuracy, detail::least_over_long_ways);
    if (!std::isfinite(t)) detail::refuse_steps("the start time is not finite");
    if (!detail::finite(y)) detail::refuse_steps("the state at the start is not finite");
    order_ = order_for(accuracy.relative);
    coefficient_.setZero(y.size(), most_order + 1);
    probe_ = coefficient_;
    const auto mean_log_factorial = [](int k) { return std::lgamma(k + 1.0) / k; };
    constexpr double tolerated = 0.15;
    for (int i = 0; i < 3; ++i) {
      falls_[std::size_t(i)] =
          mean_log_factorial(order_) - mean_log_factorial(order_ - 4 + i) + tolerated;
    }
  }

  [[nodiscard]] const double& t() const { return time_.value; }
  [[nodiscard]] const Vector& y() const { return state_.value; }
  [[nodiscard]] const IntegrationStatistics& effort() const { return effort_; }

  /// Takes over the sizes that blocks have had before, which errors are measured by.
  void know_sizes(std::span<const double> sizes) { sizes_.know(sizes); }

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
    const double left = (goal - time_.value) - time_.rest;
    expand(std::abs(left));
    before_ = {time_, state_};
    doubted_ = {};
    double reach = scale_ * reach_;
    while (!attempt(reach, left, goal)) reach = std::min(reach, std::abs(left)) / 4;
    squares_ += length() * length();
    if (std::fmod(effort_.steps, 4) == 1) note_noise();
    next_scale_ = reach < std::numeric_limits<double>::max() ? reach : length();
  }

  /// As ExplicitRungeKutta::follow().
  void follow(const TaylorSteps& leader) {
    const double h = leader.time_.value - leader.before_.time.value;
    scale_ = leader.scale_;
    coefficient_.col(0) = y();
    series_(t(), scale_, order_, coefficient_);
    effort_.evaluations += order_;
    before_ = {time_, state_};
    take(h, change(h / scale_));
    time_ = leader.time_;
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

  /// Whether the last step was short for a part of the motion, or for rounding, that is far smaller than
  /// the accuracy but whose terms grow: half the series would do for all else.
  [[nodiscard]] bool is_short_for_little() const {
    const double part = length() / scale_;
    const int half = order_ / 2;
    const Vector middle = std::pow(part, half) * coefficient_.col(half);
    return effort_.steps > 0 &&
           sizes_.relative(middle, part * coefficient_.col(1)) < accuracy_.relative / 10;
  }

  /// As ExplicitRungeKutta::noise().
  [[nodiscard]] double noise() const { return 0.5 * sizes_.wander(squares_); }

  /// What the steps go on from, outputs within the last step included.
  template <class Checkpoint>
  void pass(Checkpoint& checkpoint) {
    checkpoint(time_, state_, before_.time, before_.state, scale_, reach_, next_scale_, sizes_,
               squares_, rounding_, coefficient_, effort_);
  }

 private:
  static constexpr int most_order = Series::most_order;
  using Coefficients = Eigen::Matrix<double, Vector::RowsAtCompileTime, most_order + 1>;

  /// Where a step began.
  struct Begin {
    detail::Compensated<double> time;
    detail::Compensated<Vector> state;
  };

  /// A try at this step whose end does not solve the equation.
  struct Doubted {
    double length = std::numeric_limits<double>::infinity();
    double apart = std::numeric_limits<double>::infinity();
  };

  /// Somewhat above the  1 - ln(accuracy)/2  of Jorba and Zou, who count coefficients alone: a step
  /// costs something besides.
  [[nodiscard]] static int order_for(double relative) {
    double best = 7.5 - 0.37 * std::log(relative);
    if constexpr (requires { Series::relative_order; }) best *= Series::relative_order;
    return std::clamp(int(std::lround(best)), 9, most_order);
  }

  /// The series from here on, in a unit of time in which its coefficients stay within the range of
  /// numbers: the last step, at most `left`, or what their own decay says where that is far from it.
  void expand(double left) {
    if (effort_.evaluations > accuracy_.max_evaluations) {
      detail::stop_integration(t(), accuracy_.max_evaluations, " evaluations are spent");
    }
    coefficient_.col(0) = y();
    constexpr double farthest = 1e4;  // to the power of 24 and squared still a number
    constexpr int most_tries = 100;   // from 1e308 down to any rate that is a number
    scale_ = next_scale_ == 0 ? first_scale() : next_scale_;
    for (int i = 0; i < most_tries; ++i) {
      scale_ = std::min(scale_, left);
      series_(t(), scale_, order_, coefficient_);
      effort_.evaluations += order_;
      if (!detail::finite(coefficient_)) {
        scale_ /= farthest;
        continue;
      }
      reach_ = reached_from_here();
      const bool within_range = reach_ > 1 / farthest && reach_ < farthest;
      if (within_range || (scale_ == left && reach_ >= 1)) return;
      scale_ *= std::clamp(reach_, 1e-100, 1e100);
    }
    require_finite_field();
    detail::stop_integration<SeriesFailed>(
        t(), "the coefficients of the series leave the range of numbers");
  }

  /// The time in which the state changes by itself.
  [[nodiscard]] double first_scale() {
    require_finite_field();
    return 100 * sizes_.first_step(probe_.col(1));
  }

  /// Puts the rate of the state into the probe.
  void require_finite_field() {
    probe_.col(0) = y();
    series_(t(), 1, 1, probe_);
    effort_.evaluations += 1;
    if (!detail::finite(Vector(probe_.col(1)))) {
      detail::stop_integration(t(), "the field is not finite");
    }
  }

  /// A step of at most `reach` towards `goal`, which is `left` away; says whether it stood.
  [[nodiscard]] bool attempt(double reach, double left, double goal) {
    const bool last = detail::is_last(reach, left);
    const double h = last ? left : std::copysign(reach, left);
    if (!last && std::abs(h) <= 4 * std::numeric_limits<double>::epsilon() * std::abs(t())) {
      failure_.tell(t());
      require_finite_field();
      detail::stop_integration<SeriesFailed>(t(), "the step has become too short to move time on");
    }
    Vector increment = change(h / scale_);
    const double end_of_step = last ? detail::on_this_side(goal, t(), jumps_) : t() + h;
    if (!solves_equation(h, end_of_step, increment)) {
      effort_.rejected += 1;
      return false;
    }
    take(h, std::move(increment));
    time_.add(h);
    if (last) time_ = {goal, 0};
    return true;
  }

  /// The state at the end of a step that stands.
  void take(double h, Vector increment) {
    detail::shake(increment, accuracy_.shaken, effort_.steps, h);
    state_.add(increment);
    sizes_.note(y());
    effort_.steps += 1;
  }

  /// Whether the series has the rate of the field at the end of a step. The difference times the
  /// step is some `order` times the error of the step; rounding may make it 1e-11 of the state, and
  /// what rounding makes of the field. What falls no faster than the step does is rounding too, which
  /// no shorter step makes good; a jump in the field leaves more.
  [[nodiscard]] bool solves_equation(double h, double end_of_step, const Vector& increment) {
    probe_.col(0) = before_.state.value + (increment + before_.state.rest);
    effort_.evaluations += 1;
    if (!failure_.is_spared(t(), [&] { series_(end_of_step, scale_, 1, probe_); })) return false;
    const double s = h / scale_;
    Vector rate = double(order_) * coefficient_.col(order_);
    for (int k = order_ - 1; k > 0; --k) rate = s * rate + double(k) * coefficient_.col(k);
    const Vector off = s * (rate - probe_.col(1));
    constexpr double rounding = 1e-11;
    constexpr double most_rounding = 1e-7;
    const double length = std::abs(h);
    const double allowed = std::max(100 * order_ * accuracy_.relative, rounding);
    const double apart = sizes_.relative(off, increment, 8 * length);
    if (apart <= std::max(allowed, std::min(4 * rounding_ * length, most_rounding))) return true;
    const double shortened = length / doubted_.length;
    const bool rounds = apart < most_rounding && apart > doubted_.apart * std::pow(shortened, 4);
    if (rounds) rounding_ = apart / length;
    doubted_ = {length, apart};
    return rounds;
  }

  /// How far the series carries, in units of its time.
  [[nodiscard]] double reached_from_here() const {
    const double reach = reached(1);
    // By a unit that is no step's length, a guess or a long rest's, the change is no measure.
    const bool misjudged = effort_.steps == 0 || reach < 0.5;
    return misjudged ? reached(std::min(reach, 1.0)) : reach;
  }

  /// To where the last two terms are what a step of about `length` may err by: two, for of an even or
  /// odd solution one of them vanishes. Where that is much longer than the unit of time, the last
  /// step, both may have vanished, as where only every fourth term is there.
  [[nodiscard]] double reached(double length) const {
    const Vector change = length * coefficient_.col(1);
    const double steepest =
        std::max(log_size(order_ - 1, change) - std::log(accuracy_.relative) / (order_ - 1),
                 log_size(order_, change) - std::log(accuracy_.relative) / order_);
    constexpr double much_longer = 1.25;
    const bool looks_back = effort_.steps == 0 || std::exp(-steepest) > much_longer;
    return std::exp(-(looks_back ? looked_back(steepest, change) : steepest));
  }

  /// log of the k-th root of the k-th term's size.
  [[nodiscard]] double log_size(int k, const Vector& change) const {
    return std::log(sizes_.relative(coefficient_.col(k), change)) / k;
  }

  /// -log of the reach: where the last two terms are smaller than the three before them let expect,
  /// these count, by a ratio of terms that stays, not by one that falls as that of 1/k!.
  [[nodiscard]] double looked_back(double steepest, const Vector& change) const {
    int k = order_ - 4;
    for (const double fall : falls_) {
      const double from_this = log_size(k, change) - std::log(accuracy_.relative) / (order_ - 1);
      if (from_this - fall > steepest) steepest = from_this;
      k += 1;
    }
    return steepest;
  }

  /// What the series makes of the state in s of its units of time, from the smallest terms on.
  [[nodiscard]] Vector change(double s) const {
    Vector sum = coefficient_.col(order_);
    for (int k = order_ - 1; k > 0; --k) sum = s * sum + coefficient_.col(k);
    return s * sum;
  }

  /// How the rate at the step's begin answers a change of the state in its last digits.
  void note_noise() {
    Vector start = before_.state.value;
    detail::move_last_digits(start, 1);
    probe_.col(0) = start;
    series_(before_.time.value, scale_, 1, probe_);
    effort_.evaluations += 1;
    const Vector apart = (probe_.col(1) - coefficient_.col(1)) / scale_;
    if (!detail::finite(apart)) return;
    sizes_.note_noise(apart, squares_);
    squares_ = 0;
  }

  Series series_;
  Accuracy accuracy_;
  int order_;
  std::array<double, 3>
      falls_{};  ///< log of reach by the terms order - 4 ... of a series as exp(t)
  detail::Compensated<double> time_;
  detail::Compensated<Vector> state_;
  detail::BlockSizes<Vector> sizes_;
  std::vector<double> jumps_;
  Begin before_;
  Coefficients coefficient_;  ///< of the last step, in powers of its time over scale_
  Coefficients probe_;        ///< for the field alone, in its columns 0 and 1
  double scale_ = 1;
  double reach_ = 1;  ///< of the series, in units of scale_
  double next_scale_ = 0;
  double squares_ = 0;   ///< of steps, summed since noise was looked at
  double rounding_ = 0;  ///< in the difference of two rates, per second
  Doubted doubted_;
  IntegrationStatistics effort_;
  detail::TrialFailure<double> failure_;
};

}  // namespace kreisel
