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

/// The series of a motion cannot continue although its field can: another method may.
struct SeriesFailed : ComputationFailed {
  using ComputationFailed::ComputationFailed;
};

/// Integration of y' = f(t, y) by the Taylor series of the solution, with adaptive steps, for
/// scenes with recurrences for the coefficients.
///
/// The step length follows from the last coefficients. At the end of every step the field is
/// compared with the rate of the series. If the series does not solve the equation there, the step
/// is rejected and shortened. Output between the ends of a step is the series itself and costs no
/// evaluation.
///
/// Vector : Eigen::Matrix<double, n, 1> or Eigen::VectorXd
/// Series : series(t, h, order, c) fills the columns 1 to `order` of an n x (most_order + 1) matrix
///          c with the coefficients of the solution in powers of (time - t)/h, from the state at t
///          in column 0; Series::most_order is the greatest order that is used, and
///          Series::relative_order, if there, the best order over that of most
/// Blocks : as ExplicitRungeKutta
/// Source : order and step: A. Jorba, M. Zou, A software package for the numerical integration of
///          ODEs by means of high-order Taylor methods, Experimental Mathematics 14 (2005) 99
/// Error  : that of a step, relative, is about `accuracy.relative`
/// Cost   : a series of order 9 to 24 a step, by the accuracy, and the field at the step's end; the
///          coefficients count as evaluations
/// Throws : as ExplicitRungeKutta; SeriesFailed if only the series, not the field, cannot continue
template <class Vector, class Series>
class TaylorSteps {
 public:
  using Scalar = double;

  TaylorSteps(Series series, double t, const Vector& y, const Accuracy& accuracy = {},
              std::span<const int> blocks = {})
      : series_(std::move(series)),
        accuracy_(accuracy),
        time_(t),
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

  [[nodiscard]] const double& t() const { return time_; }
  [[nodiscard]] const Vector& y() const { return state_.value; }
  [[nodiscard]] const IntegrationStatistics& effort() const { return effort_; }

  /// Takes over the block sizes of an earlier integration, relative to which errors are measured.
  void set_sizes(std::span<const double> sizes) { sizes_.set(sizes); }

  /// Times at which the field is discontinuous, in any order. Steps end there exactly.
  void stop_at(std::vector<double> jumps) { jumps_ = detail::sorted(std::move(jumps)); }

  /// Continues from another state at the present time.
  void jump_to(const Vector& y) {
    state_ = {y, Vector::Zero(y.size())};
    sizes_.note(y);
  }

  /// Integrates to `end` exactly, forwards or backwards.
  const Vector& advance_to(double end) {
    while (end != t()) step_towards(end);
    return y();
  }

  /// One step towards `end`, not beyond `end`.
  void step_towards(double end) {
    if (!std::isfinite(end)) detail::refuse_steps("the end time is not finite");
    if (end == t()) return;
    const double goal = detail::next_stop(t(), end, jumps_);
    const double left = goal - time_;
    here_ = detail::on_this_side(t(), goal, jumps_);
    expand(std::abs(left));
    before_ = {time_, state_};
    doubted_ = {};
    double reach = scale_ * reach_;
    while (!attempt(reach, left, goal)) reach = std::min(reach, std::abs(left)) / 4;
    squares_ += length() * length();
    if (std::fmod(effort_.steps, 4) == 1) note_rounding();
    next_scale_ = reach < std::numeric_limits<double>::max() ? reach : length();
  }

  /// As ExplicitRungeKutta::follow().
  void follow(const TaylorSteps& leader) {
    const double h = leader.time_ - leader.before_.time;
    scale_ = leader.scale_;
    coefficient_.col(0) = y();
    here_ = detail::on_this_side(t(), leader.t(), jumps_);
    series_(here_, scale_, order_, coefficient_);
    effort_.evaluations += order_;
    before_ = {time_, state_};
    take(h, change(h / scale_));
    time_ = leader.time_;
  }

  /// True if a time lies within the last step.
  [[nodiscard]] bool covers(double time) const {
    const double from = before_.time;
    return time >= std::min(from, t()) && time <= std::max(from, t());
  }

  /// The state at a time within the last step.
  ///
  /// Throws : InvalidInput for a time outside the last step
  [[nodiscard]] Vector at(double time) const {
    const double from = before_.time;
    if (!covers(time)) {
      detail::refuse_steps("t = ", time, " s lies outside the last step, [", from, ", ", t(),
                           "] s");
    }
    if (time == t()) return y();
    if (time == from) return before_.state.value;
    const double part = (time - from) / scale_;
    return before_.state.value + (change(part) + before_.state.rest);
  }

  /// Goes back to a time within the last step and continues from there.
  void back_to(double time) {
    state_ = {at(time), Vector::Zero(y().size())};
    time_ = time;
    before_ = {time_, state_};
  }

  /// The length of the last step.
  [[nodiscard]] double length() const { return std::abs(t() - before_.time); }

  /// True if a small, growing part of the series has shortened the last step. That part is a
  /// motion, or rounding, far below the accuracy. Half the series would be enough for the rest.
  [[nodiscard]] bool is_short_for_little() const {
    const double part = length() / scale_;
    const int half = order_ / 2;
    const Vector middle = std::pow(part, half) * coefficient_.col(half);
    return effort_.steps > 0 &&
           sizes_.relative(middle, part * coefficient_.col(1)) < accuracy_.relative / 10;
  }

  /// As ExplicitRungeKutta::rounding_level().
  [[nodiscard]] double rounding_level() const { return 0.5 * sizes_.wander(squares_); }

  /// Saves or restores all members from which the steps continue, with outputs within the last
  /// step.
  template <class Checkpoint>
  void pass(Checkpoint& checkpoint) {
    checkpoint(time_, state_, before_.time, before_.state, scale_, reach_, next_scale_, sizes_,
               squares_, rounding_, coefficient_, effort_);
  }

 private:
  static constexpr int most_order = Series::most_order;
  using Coefficients = Eigen::Matrix<double, Vector::RowsAtCompileTime, most_order + 1>;

  /// Start of a step.
  struct Begin {
    double time;
    detail::Compensated<Vector> state;
  };

  /// A trial of this step whose end does not solve the equation.
  struct Doubted {
    double length = std::numeric_limits<double>::infinity();
    double apart = std::numeric_limits<double>::infinity();
  };

  /// Somewhat above the 1 - ln(accuracy)/2 of Jorba and Zou, who count coefficients only: a step
  /// has costs besides.
  [[nodiscard]] static int order_for(double relative) {
    double best = 7.5 - 0.37 * std::log(relative);
    if constexpr (requires { Series::relative_order; }) best *= Series::relative_order;
    return std::clamp(int(std::lround(best)), 9, most_order);
  }

  /// Computes the series from here on, in a unit of time that keeps its coefficients within the
  /// range of numbers. The unit is the last step, at most `left`, or follows from the coefficients'
  /// decay if that differs by far.
  void expand(double left) {
    if (effort_.evaluations > accuracy_.max_evaluations) {
      detail::stop_without_evaluations(t(), accuracy_.max_evaluations);
    }
    coefficient_.col(0) = y();
    constexpr double farthest = 1e4;  // to the power of 24 and squared it is still finite
    constexpr int most_tries = 100;   // from 1e308 down to any rate that is finite
    scale_ = next_scale_ == 0 ? first_scale() : next_scale_;
    for (int i = 0; i < most_tries; ++i) {
      scale_ = std::min(scale_, left);
      series_(here_, scale_, order_, coefficient_);
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
    detail::stop_integration<SeriesFailed>(t(),
                                           "the coefficients of the series overflow or underflow");
  }

  /// The time in which the state changes by its own size.
  [[nodiscard]] double first_scale() {
    require_finite_field();
    return 100 * sizes_.first_step(probe_.col(1));
  }

  /// Puts the rate of the state into the probe.
  void require_finite_field() {
    probe_.col(0) = y();
    series_(here_, 1, 1, probe_);
    effort_.evaluations += 1;
    if (!detail::finite(Vector(probe_.col(1)))) {
      detail::stop_integration(t(), "the field is not finite");
    }
  }

  /// A step of at most `reach` towards `goal` at the distance `left`; returns true if it is
  /// accepted.
  [[nodiscard]] bool attempt(double reach, double left, double goal) {
    const bool last = detail::is_last(reach, left);
    const double end = last ? goal : t() + std::copysign(reach, left);
    const double h = end - time_;
    if (!last && std::abs(h) <= 4 * std::numeric_limits<double>::epsilon() * std::abs(t())) {
      failure_.stop(t());
      require_finite_field();
      detail::stop_integration<SeriesFailed>(t(), "the step has become too short to move time on");
    }
    Vector increment = change(h / scale_);
    const double end_of_step = last ? detail::on_this_side(goal, t(), jumps_) : end;
    if (!solves_equation(h, end_of_step, increment)) {
      effort_.rejected += 1;
      return false;
    }
    take(h, std::move(increment));
    time_ = end;
    return true;
  }

  /// Accepts the state at the end of a step.
  void take(double h, Vector increment) {
    detail::perturb(increment, accuracy_.perturbed, effort_.steps, h);
    state_.add(increment);
    sizes_.note(y());
    effort_.steps += 1;
  }

  /// True if the series has the rate of the field at the end of a step. The difference times the
  /// step is about `order` times the error of the step. The tolerance includes rounding: 1e-11 of
  /// the state, and the rounding of the field. A difference that does not fall with the step is
  /// rounding too, which no shorter step reduces. A discontinuity of the field leaves a larger one.
  [[nodiscard]] bool solves_equation(double h, double end_of_step, const Vector& increment) {
    probe_.col(0) = before_.state.value + (increment + before_.state.rest);
    effort_.evaluations += 1;
    if (!failure_.succeeds(t(), [&] { series_(end_of_step, scale_, 1, probe_); })) return false;
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

  /// Reach of the series, in units of its time.
  [[nodiscard]] double reached_from_here() const {
    const double reach = reached(1);
    // If the unit is no step's length, but a guess or that of a long rest, the change is no
    // measure.
    const bool misjudged = effort_.steps == 0 || reach < 0.5;
    return misjudged ? reached(std::min(reach, 1.0)) : reach;
  }

  /// The time at which the last two terms equal the allowed error of a step of about `length`. Two,
  /// because one of them vanishes for an even or odd solution. Both may vanish if that time is much
  /// longer than the unit, the last step: for example if only every fourth term exists.
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

  /// -log of the reach. It follows from the last two terms if they are smaller than the three
  /// before them predict. The ratio of terms is then taken as constant, not as falling like that of
  /// 1/k!.
  [[nodiscard]] double looked_back(double steepest, const Vector& change) const {
    int k = order_ - 4;
    for (const double fall : falls_) {
      const double from_this = log_size(k, change) - std::log(accuracy_.relative) / (order_ - 1);
      if (from_this - fall > steepest) steepest = from_this;
      k += 1;
    }
    return steepest;
  }

  /// The change of the state by the series in s of its units of time, summed from the smallest
  /// terms on.
  [[nodiscard]] Vector change(double s) const {
    Vector sum = coefficient_.col(order_);
    for (int k = order_ - 1; k > 0; --k) sum = s * sum + coefficient_.col(k);
    return s * sum;
  }

  /// Records the change of the rate at the step's begin for a change of the state in its last
  /// digits.
  void note_rounding() {
    Vector start = before_.state.value;
    detail::move_last_digits(start, 1);
    probe_.col(0) = start;
    series_(here_, scale_, 1, probe_);
    effort_.evaluations += 1;
    const Vector apart = (probe_.col(1) - coefficient_.col(1)) / scale_;
    if (!detail::finite(apart)) return;
    sizes_.note_rounding(apart, squares_);
    squares_ = 0;
  }

  Series series_;
  Accuracy accuracy_;
  int order_;
  std::array<double, 3>
      falls_{};  ///< log of the reach by the terms from order - 4 on of a series like exp(t)
  double time_;  ///< each step ends at a number: the series has the phase of what drives it
  detail::Compensated<Vector> state_;
  detail::BlockSizes<Vector> sizes_;
  std::vector<double> jumps_;
  double here_ = 0;  ///< where the last step began, on its side of a jump
  Begin before_;
  Coefficients coefficient_;  ///< of the last step, in powers of its time over scale_
  Coefficients probe_;        ///< only for the field, in its columns 0 and 1
  double scale_ = 1;
  double reach_ = 1;  ///< of the series, in units of scale_
  double next_scale_ = 0;
  double squares_ = 0;   ///< of step lengths, since the last rounding sample
  double rounding_ = 0;  ///< in the difference of two rates, per second
  Doubted doubted_;
  IntegrationStatistics effort_;
  detail::TrialFailure<double> failure_;
};

}  // namespace kreisel
