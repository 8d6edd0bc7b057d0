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
#include <dynamics/step/stage_memory.hpp>
#include <dynamics/step/verner.hpp>

namespace kreisel {

/// Explicit Runge-Kutta integration of  y' = field(t, y)  with adaptive steps.
///
/// State and time are summed with compensation, and the weights are corrected for the rounding of
/// their digits. Rounding then neither grows with the number of steps nor drifts to one side. A
/// step with a result that is not finite is rejected and shortened, like one with too large an
/// error. A field that exists only in a region is therefore not left. The last accepted time and
/// state stay readable.
///
/// Output between the ends of a step has the method's full order and does not change the steps.
/// at() evaluates a polynomial. The first output in a step costs ten evaluations, further ones cost
/// none.
///
/// Vector : Eigen::Matrix<S, n, 1>; n may be Eigen::Dynamic, and then the constructor allocates all
///          memory, the steps none. Or Eigen::Matrix<Pack, n, 1>: one solution for each lane. Time
///          and step are then double and common to all, by the greatest relative error
/// Field  : callable (S t, Vector y) -> Vector, or (S t, Vector y, Vector& rate), which writes into
///          a rate that has its size already. If it has a member project(Vector& y), that moves the
///          state onto conditions after each step and at each output
/// Blocks : how many components, in turn, share a unit and a size, e.g. {4, 3} for a quaternion and
///          an angular velocity; one block by default
/// Source : Verner's tableau; step control (PI): E. Hairer, G. Wanner, Solving Ordinary
///          Differential Equations II, IV.2
/// Cost   : 16 evaluations a step
/// Throws : InvalidInput for an accuracy out of range or a start that is not finite;
///          ComputationFailed naming the time where steps become too short or too many
template <class Vector, class Field, class Tableau = Verner98>
class ExplicitRungeKutta {
 public:
  using Scalar = detail::ScalarOf<typename Vector::Scalar>;

  ExplicitRungeKutta(Field field, const Scalar& t, const Vector& y, const Accuracy& accuracy = {},
                     std::span<const int> blocks = {})
      : field_(std::move(field)),
        accuracy_(accuracy),
        time_{t, Scalar(0)},
        state_{y, zero(y)},
        allowed_(static_cast<Scalar>(accuracy.relative)),
        stage_(y),
        sizes_(blocks, Scalar(accuracy.absolute_scale), y),
        before_{time_, state_, zero(y)} {
    coefficient_.fill(zero(y));
    detail::check(accuracy, detail::least_over_long_ways);
    if (!std::isfinite(static_cast<double>(t)))
      detail::refuse_steps("the start time is not finite");
    if (!detail::finite(y)) detail::refuse_steps("the state at the start is not finite");
  }

  [[nodiscard]] const Scalar& t() const { return time_.value; }
  [[nodiscard]] const Vector& y() const { return state_.value; }
  [[nodiscard]] const IntegrationStatistics& effort() const { return effort_; }

  /// True if stiffness, not curvature of the solution, has limited the last 20 examined steps
  /// (every eighth). RadauSteps is then the better choice.
  ///
  /// Source : Hairer, Wanner, Solving Ordinary Differential Equations II, IV.2: the greatest rate
  ///          of the field, from two stages at the same time, against the method's stability limit
  [[nodiscard]] bool stiff() const { return short_steps_ >= 20; }

  /// The greatest size so far of the block of each component.
  [[nodiscard]] Vector sizes() const {
    Vector sizes = y();
    sizes_.put(sizes);
    return sizes;
  }

  /// Takes over the block sizes of an earlier integration, relative to which errors are measured.
  void set_sizes(std::span<const double> sizes) { sizes_.set(sizes); }

  /// Times at which the field is discontinuous (start of a thrust, jerk of a guide), in any order.
  /// Steps end there exactly and evaluate the field only on their own side.
  void stop_at(std::vector<Scalar> jumps) { jumps_ = detail::sorted(std::move(jumps)); }

  /// Continues from another state at the present time.
  void jump_to(const Vector& y) {
    state_ = {y, zero(y)};
    sizes_.note(y);
  }

  /// Integrates to `end` exactly, forwards or backwards.
  const Vector& advance_to(const Scalar& end) {
    while (end != t()) step_towards(end);
    return y();
  }

  /// One step towards `end`, not beyond `end`.
  void step_towards(const Scalar& end) {
    using std::abs;
    if (!std::isfinite(static_cast<double>(end)))
      detail::refuse_steps("the end time is not finite");
    if (end == t()) return;
    const Scalar goal = detail::next_stop(t(), end, jumps_);
    begin_step(goal);
    if (!detail::finite(stage_[0])) detail::stop_integration(t(), "the field is not finite");
    if (step_ == Scalar(0)) step_ = first_step(goal);
    while (true) {
      const Scalar left = (goal - time_.value) - time_.rest;
      const bool last = detail::is_last(step_, left);
      const Scalar wanted = step_;
      last_stage_time_ = detail::on_this_side(goal, t(), jumps_);
      if (!attempt(last ? left : std::copysign(step_, left))) continue;
      if (last) {
        time_ = {goal, Scalar(0)};
        step_ = std::max(step_, wanted);  // the goal, not the error, made it short
      }
      return;
    }
  }

  /// A very short step to `end`, across a corner of the field, without an error test.
  ///
  /// Throws : ComputationFailed if the field has no rate at a point of that step
  void cross_to(const Scalar& end) {
    const Scalar wanted = step_;
    last_stage_time_ = end;
    begin_step(end);
    if (!attempt((end - time_.value) - time_.rest, true)) {
      detail::stop_integration(t(), "the field ends at a corner");
    }
    time_ = {end, Scalar(0)};
    step_ = wanted;
  }

  /// A first step of length h, or to `end` if that is nearer. Returns false and takes no step if
  /// the step is rejected.
  [[nodiscard]] bool try_first_step(const Scalar& h, const Scalar& end) {
    const Scalar goal = detail::next_stop(t(), end, jumps_);
    begin_step(goal);
    last_stage_time_ = detail::on_this_side(goal, t(), jumps_);
    const Scalar left = goal - t();
    return attempt(std::abs(left) <= h ? left : std::copysign(h, left));
  }

  /// Takes the last step of another run of the same field, with the same length and without an
  /// error test.
  ///
  /// Throws : ComputationFailed if the field has no rate at a point of that step
  void follow(const ExplicitRungeKutta& leader) {
    const Scalar h = leader.before_.length;
    last_stage_time_ = leader.last_stage_time_;
    begin_step(last_stage_time_);
    if (!attempt(h, true)) {
      detail::stop_integration(t(), "the step of the leading run leaves the region of the field");
    }
    time_ = leader.time_;
  }

  /// True if a time lies within the last step.
  [[nodiscard]] bool covers(const Scalar& time) const {
    const Scalar& from = before_.time.value;
    return time >= std::min(from, t()) && time <= std::max(from, t());
  }

  /// The state at a time within the last step.
  ///
  /// Throws : InvalidInput for a time outside the last step
  [[nodiscard]] Vector at(const Scalar& time) {
    Vector result;
    at(time, result);
    return result;
  }

  /// As above, written to `result`.
  void at(const Scalar& time, Vector& result) {
    const Scalar& from = before_.time.value;
    if (!covers(time)) {
      detail::refuse_steps("t = ", time, " s lies outside the last step, [", from, ", ", t(),
                           "] s");
    }
    if (time == t()) {
      result = y();
    } else if (time == from) {
      result = before_.state.value;
    } else {
      if (!polynomial_known_) fit_polynomial();
      polynomial_known_ = true;
      polynomial(((time - from) - before_.time.rest) / before_.length, result);
      if constexpr (requires { field_.project(result); }) field_.project(result);
    }
  }

  /// Goes back to a time within the last step and continues from there.
  void back_to(const Scalar& time) {
    at(time, state_.value);
    state_.rest.setZero();
    time_ = {time, Scalar(0)};
    before_.time = time_;
    before_.state = state_;
    before_.rate.setZero();
  }

  /// All that a step notes besides time and state.
  struct Notes {
    detail::BlockSizes<Vector> sizes;
    Scalar squares;
    unsigned steps_taken;
    int short_steps;
  };
  [[nodiscard]] Notes notes() const { return {sizes_, squares_, steps_taken_, short_steps_}; }

  /// Goes back to the begin of the last step, with the notes of that time.
  void undo_step(const Notes& notes) {
    time_ = before_.time;
    state_ = before_.state;
    sizes_ = notes.sizes;
    squares_ = notes.squares;
    steps_taken_ = notes.steps_taken;
    short_steps_ = notes.short_steps;
  }

  /// Error of the state due to rounding of its rates, relative to size; sampled at intervals.
  [[nodiscard]] Scalar rounding_level() const { return Scalar(0.5) * sizes_.wander(squares_); }

  /// Saves or restores all members from which the steps continue, with outputs within the last
  /// step.
  template <class Checkpoint>
  void pass(Checkpoint& checkpoint) {
    checkpoint(time_, state_, step_, steps_taken_, squares_, log_worst_before_, rejected_.step,
               rejected_.worst, rejected_.in_vain, allowed_, sizes_, last_stage_time_, before_.time,
               before_.state, before_.rate, before_.length, polynomial_known_, short_steps_,
               effort_);
    for (Vector& coefficient : coefficient_) checkpoint(coefficient);
  }

 private:
  using Number = typename Vector::Scalar;

  template <class T>
  using Compensated = detail::Compensated<T>;

  /// Start of a step: time, state, and the field there.
  struct Begin {
    Compensated<Scalar> time;
    Compensated<Vector> state;
    Vector rate;
    Scalar length = Scalar(0);
  };

  /// The last rejected try at this step.
  struct Rejected {
    Scalar step = Scalar(0);
    Scalar worst = Scalar(0);
    int in_vain = 0;
  };

  using Memory = detail::StageMemory<Vector, Tableau::stages + Tableau::later_stages>;

  static Vector zero(const Vector& y) { return Vector::Zero(y.size()); }

  void evaluate(const Scalar& t, const Vector& y, Vector& rate) {
    effort_.evaluations += 1;
    detail::call(field_, t, y, rate);
    if constexpr (!Memory::fixed) {
      if (rate.size() != y.size()) {
        detail::refuse_steps("the field gives ", rate.size(), " rates of ", y.size(),
                             " components");
      }
    }
  }

  void fill_stage(std::size_t k, const Scalar& t, const Vector& y) { fill_stage_here(k, t, y); }

  /// As above, but inlined.
  [[gnu::always_inline]] void fill_stage_here(std::size_t k, const Scalar& t, const Vector& y) {
    if constexpr (Memory::fixed) {
      effort_.evaluations += 1;
      stage_.keep(k, [&] { return detail::rate_of(field_, t, y); });
    } else {
      evaluate(t, y, stage_.rate(k));
    }
  }

  /// The indices of the coefficients of a row that are not 0.
  template <const auto& row>
  static constexpr auto occupied = [] {
    constexpr auto count =
        std::size_t(std::count_if(row.begin(), row.end(), [](auto c) { return c != 0; }));
    std::array<std::size_t, count> used{};
    std::size_t next = 0;
    for (std::size_t j = 0; j < row.size(); ++j) {
      if (row[j] != 0) used[next++] = j;
    }
    return used;
  }();

  /// sum of c_j k_j over the stages, for part() of each stage, without zero terms. Optionally
  /// without the last term.
  template <const auto& row, std::size_t without_last = 0, class Part>
  [[nodiscard, gnu::always_inline]] auto combined(const Part& part) const {
    constexpr auto& used = occupied<row>;
    return added<row, 1>(static_cast<Scalar>(row[used[0]]) * part(stage_[used[0]]), part,
                         std::make_index_sequence<used.size() - without_last - 1>());
  }

  /// As above, added to a sum, from the row's term number `first` on.
  template <const auto& row, std::size_t first, class Sum, class Part, std::size_t... k>
  [[nodiscard, gnu::always_inline]] auto added(const Sum& sum, const Part& part,
                                               std::index_sequence<k...> /*terms*/) const {
    constexpr auto& used = occupied<row>;
    return (sum + ... +
            (static_cast<Scalar>(row[used[first + k]]) * part(stage_[used[first + k]])));
  }

  template <std::size_t i>
  static constexpr auto row = Tableau::a[i];

  /// Corrections of the first and the last weight for the rounding of the coefficients. They fulfil
  /// the conditions sum_i b_i = 1 and sum_ij b_i a_ij = 1/2. Without them each step errs by 1e-16
  /// to the same side: energies drift in proportion to time, phases in proportion to its square.
  struct Rest {
    Scalar first;
    Scalar last;
  };
  static constexpr Rest rest_of_weights = [] {
    DoubleDouble missing = 1;
    DoubleDouble missing_of_half = 0.5;
    DoubleDouble last_node = 0;
    for (std::size_t i = 0; i < Tableau::stages; ++i) {
      last_node = 0;
      for (std::size_t j = 0; j < i; ++j) last_node += static_cast<Scalar>(Tableau::a[i][j]);
      const DoubleDouble weight = static_cast<Scalar>(Tableau::b[i]);
      missing -= weight;
      missing_of_half -= weight * last_node;
    }
    const DoubleDouble last = missing_of_half / last_node;
    return Rest{static_cast<Scalar>(missing - last), static_cast<Scalar>(last)};
  }();

  /// sum of b_j k_j. The corrections of the weights come first: at the end they would be rounded
  /// away.
  template <class Part>
  [[nodiscard, gnu::always_inline]] auto mean_rate(const Part& part) const {
    return added<Tableau::b, 0>(rest_of_weights.first * part(stage_[0]) +
                                    rest_of_weights.last * part(stage_[Tableau::stages - 1]),
                                part, std::make_index_sequence<occupied<Tableau::b>.size()>());
  }

  /// The time of a stage in a step from `time` on, limited to the side of a discontinuity on which
  /// the step lies.
  [[nodiscard]] Scalar stage_time(const Compensated<Scalar>& time, const Scalar& h,
                                  DoubleDouble node) const {
    const Scalar stage_time = time.value + (static_cast<Scalar>(node) * h + time.rest);
    const bool late = h > Scalar(0) ? stage_time > last_stage_time_ : stage_time < last_stage_time_;
    return late ? last_stage_time_ : stage_time;
  }

  /// All stages but the first of a step of length h.
  template <std::size_t... i>
  void fill_stages(const Scalar& h, std::index_sequence<i...>) {
    const auto fill = [&]<std::size_t k>() {
      constexpr std::size_t last = occupied<row<k>>.back();
      const Scalar weight = h * static_cast<Scalar>(row<k>[last]);
      alignas(detail::Vec4d) alignas(Vector) typename Memory::Passing point = stage_.point();
      // Only the last stage depends on its predecessors.
      Memory::put(
          point, [&](const auto& part) __attribute__((always_inline)) {
            if constexpr (occupied<row<k>>.size() == 1) {
              return part(state_.value) + part(state_.rest) + weight * part(stage_[last]);
            } else {
              return part(state_.value) + (h * combined<row<k>, 1>(part) + part(state_.rest)) +
                     weight * part(stage_[last]);
            }
          });
      const Scalar time = stage_time(time_, h, Tableau::node[k]);
      if constexpr (Memory::few) {
        fill_stage_here(k, time, point);
      } else {
        fill_stage(k, time, point);
      }
    };
    (fill.template operator()<i + 1>(), ...);
  }

  /// First step length from the curvature: a fixed part of the time in which the rates change. It
  /// counts if it is longer than the length that the rates suggest. It is found by Euler steps,
  /// each a hundred times as long as the one before. A uniform motion, like the angle of a fast
  /// rotor on which nothing depends, does not shorten the step.
  ///
  /// Source : h = (0.01/d)^(1/order), d the second derivative in units of the allowed error:
  ///          E. Hairer, S. P. Norsett, G. Wanner, Solving Ordinary Differential Equations I, II.4
  [[nodiscard]] Scalar first_step(const Scalar& goal) {
    using std::abs;
    using std::pow;
    constexpr Scalar farther(100);
    const Scalar part = pow(Scalar(0.01) * allowed_, Scalar(1) / Tableau::order);
    const Scalar most = abs(goal - t());
    typename Memory::Passing point = stage_.point();
    typename Memory::Passing bend = stage_.error();
    Scalar h = std::min(sizes_.first_step(before_.rate), most);
    while (true) {
      const Scalar ahead = std::copysign(h, goal - t());
      point = y() + ahead * before_.rate;
      const Scalar there = h < most ? t() + ahead : detail::on_this_side(goal, t(), jumps_);
      if (!failure_.succeeds(t(), [&] { evaluate(there, point, bend); })) return h;
      bend -= before_.rate;
      if (!detail::finite(bend)) return h;
      const Scalar found = part * sizes_.bending_time(before_.rate, bend, h);
      if (h == most || found <= farther * h) return std::clamp(found, h, most);
      h = std::min(farther * h, most);
    }
  }

  /// Evaluates the field at the start of a step towards `goal`.
  void begin_step(const Scalar& goal) {
    fill_stage(0, detail::on_this_side(t(), goal, jumps_), y());
    before_.time = time_;
    before_.state = state_;
    before_.rate = Memory::own(stage_[0]);
    polynomial_known_ = false;
  }

  /// One step of length h; returns true if it is accepted. Sets the length of the next step.
  ///
  /// follows : the step repeats that of another run and is accepted whatever its error
  bool attempt(const Scalar& h, bool follows = false) {
    using std::abs;
    using std::exp;
    using std::isfinite;
    using std::log;
    using std::max;
    using std::pow;
    if (abs(h) <= Scalar(4) * std::numeric_limits<Scalar>::epsilon() * abs(t()) || h == Scalar(0)) {
      failure_.stop(t());
      detail::stop_integration(t(), "the step has become too short to move time on");
    }
    if (effort_.evaluations > accuracy_.max_evaluations) {
      detail::stop_without_evaluations(t(), accuracy_.max_evaluations);
    }
    const auto fill = [&] { fill_stages(h, std::make_index_sequence<Tableau::stages - 1>()); };
    if (!failure_.succeeds(t(), fill)) {
      step_ = Scalar(0.125) * abs(h);
      effort_.rejected += 1;
      return false;
    }
    typename Memory::Passing change = stage_.change();
    typename Memory::Passing error = stage_.error();
    Memory::put(change, [&](const auto& part) { return h * mean_rate(part); });
    Memory::put(error, [&](const auto& part) { return h * combined<Tableau::difference>(part); });
    // In units of the allowed error.
    const Scalar worst = sizes_.relative(error, change, Scalar(4) * abs(h)) / allowed_;
    const bool finite = isfinite(static_cast<double>(worst)) && detail::finite(change);
    if (!finite || (worst > Scalar(1) && !follows)) {
      const Scalar aim =
          finite ? Scalar(0.9) * pow(worst, Scalar(-1) / Tableau::order) : Scalar(0.125);
      step_ = abs(h) * max(aim, Scalar(0.125));
      effort_.rejected += 1;
      if (finite) heed_rounding(abs(h), worst);
      return false;
    }
    rejected_ = {};
    set_next_step(h, worst);
    steps_taken_ += 1;
    squares_ += h * h;
    if (steps_taken_ % 8 == 0) look_for_stiffness();
    if (steps_taken_ % 64 == 16) note_rounding();
    take(h, change);
    time_.add(h);
    return true;
  }

  void set_next_step(const Scalar& h, const Scalar& worst) {
    using std::abs;
    using std::exp;
    using std::log;
    using std::max;
    // PI controller: the next length depends on this step's error and, weakly, on its change since
    // the last step.
    constexpr Scalar little = Scalar(0.04);
    const Scalar log_worst = log(max(worst, Scalar(1e-12)));
    const Scalar aim =
        Scalar(0.9) * exp((Scalar(0.75) * little - Scalar(1) / Tableau::order) * log_worst +
                          little * log_worst_before_);
    step_ = abs(h) * std::clamp(aim, Scalar(0.2), Scalar(5));
    log_worst_before_ = max(log_worst, Scalar(-9.21));
  }

  /// Accepts the state at the end of a step.
  void take(const Scalar& h, typename Memory::Passing change) {
    effort_.steps += 1;
    detail::perturb(change, accuracy_.perturbed, effort_.steps, static_cast<double>(h));
    state_.set_sum(before_.state, change);
    if constexpr (requires { field_.project(state_.value); }) field_.project(state_.value);
    before_.length = h;
    sizes_.note(y());
  }

  void look_for_stiffness() {
    using detail::any;
    constexpr std::size_t last = Tableau::stages - 1;
    typename Memory::Passing between = stage_.error();
    Memory::put(between, [&](const auto& part) {
      return combined<row<last>>(part) - combined<row<last - 1>>(part);
    });
    const Number apart = between.norm();
    const Number rate = (stage_[last] - stage_[last - 1]).norm();
    const bool at_the_limit = any(rate > Number(0.6 * Tableau::stable) * apart);
    short_steps_ = at_the_limit ? short_steps_ + 1 : 0;
  }

  /// Raises the allowed error if the error does not fall with the step. Such an error is rounding
  /// in the field, which no shorter step reduces. An example is a rate held to 1e-17 that is a
  /// difference of terms with rounding of 1e-16. After three rejections without success the error
  /// of the step is allowed, up to 1e-12.
  void heed_rounding(const Scalar& h, const Scalar& worst) {
    using std::pow;
    const bool in_vain =
        rejected_.step > h && worst > rejected_.worst * pow(h / rejected_.step, Scalar(3));
    rejected_ = {h, worst, in_vain ? rejected_.in_vain + 1 : 0};
    if (rejected_.in_vain < 2) return;
    if constexpr (detail::is_pack<Number>) {
      detail::stop_integration(t(),
                               "rounding in the field of one member prevents the accuracy of all");
    }
    const Scalar most = std::max(Scalar(1e-12), Scalar(accuracy_.relative));
    allowed_ = std::min(most, Scalar(2) * worst * allowed_);
    step_ = h;
    rejected_ = {};
  }

  /// Records the change of the rate for a change of the state in its last digits. A stiff spring
  /// far from its zero amplifies these so much that steps would shrink in vain.
  void note_rounding() {
    typename Memory::Passing moved = stage_.point();
    typename Memory::Passing rate = stage_.error();
    moved = before_.state.value;
    detail::move_last_digits(moved, 1);
    evaluate(before_.time.value, moved, rate);
    rate -= before_.rate;
    if (!detail::finite(rate)) return;
    sizes_.note_rounding(rate, squares_);
    squares_ = 0;
  }

  void fill_later_stages() {
    const Scalar& h = before_.length;
    typename Memory::Passing sum = stage_.change();
    typename Memory::Passing point = stage_.point();
    for (std::size_t i = 0; i < Tableau::later_stages; ++i) {
      sum.setZero();
      for (std::size_t j = 0; j < Tableau::stages + i; ++j) {
        const auto a = static_cast<Scalar>(Tableau::later[i][j]);
        if (a != Scalar(0)) sum += a * Memory::own(stage_[j]);
      }
      point = before_.state.value + (h * sum + before_.state.rest);
      fill_stage(Tableau::stages + i, stage_time(before_.time, h, Tableau::later_node[i]), point);
    }
  }

  /// The node, as a part of the step, of the polynomial's i-th interpolated stage.
  static constexpr DoubleDouble met(std::size_t i) {
    const std::size_t stage = Tableau::met[i];
    return stage == 0 ? 0 : Tableau::later_node[stage - Tableau::stages];
  }

  static constexpr std::size_t coefficients = Tableau::met.size() + 2;

  /// Row m: the powers from 1 on of N_m(x) = int_0^x prod_{i<m} (s - x_i) ds, with x_i of met() and
  /// 0.
  static constexpr auto newton = [] {
    std::array<std::array<DoubleDouble, coefficients>, coefficients> N{};
    std::array<DoubleDouble, coefficients + 1> product{1};
    for (std::size_t m = 0; m < coefficients; ++m) {
      for (std::size_t j = 0; j <= m; ++j) {
        N[m][j] = product[j] / static_cast<DoubleDouble>(j + 1);
      }
      const DoubleDouble x = m < Tableau::met.size() ? met(m) : 0;
      for (std::size_t j = m + 1; j > 0; --j) product[j] = product[j - 1] - x * product[j];
      product[0] *= -x;
    }
    return N;
  }();

  [[nodiscard]] static Scalar newton_at(std::size_t m, const Scalar& x) {
    Scalar sum(0);
    for (std::size_t j = m + 1; j-- > 0;) sum = (sum + static_cast<Scalar>(newton[m][j])) * x;
    return sum;
  }

  /// Fits the polynomial through the last step, y = y0 + sum_m power_m N_m(x). Its coefficients
  /// come from Newton's divided differences of rates, the ninth power from all stages, and the
  /// state at the step's end.
  void fit_polynomial() {
    fill_later_stages();
    constexpr std::size_t rates = Tableau::met.size();
    for (std::size_t i = 0; i < rates; ++i) {
      coefficient_[i] = before_.length * Memory::own(stage_[Tableau::met[i]]);
    }
    for (std::size_t order = 1; order < rates; ++order) {
      for (std::size_t i = rates - 1; i >= order; --i) {
        coefficient_[i] =
            (coefficient_[i] - coefficient_[i - 1]) / static_cast<Scalar>(met(i) - met(i - order));
      }
    }
    const Scalar ninth = Scalar(Tableau::order) * before_.length;
    Memory::put(coefficient_[rates + 1],
                [&](const auto& part) { return ninth * combined<Tableau::ninth>(part); });
    Vector& last = coefficient_[rates];
    last = (state_.value - before_.state.value) + (state_.rest - before_.state.rest);
    for (std::size_t m = 0; m < coefficients; ++m) {
      if (m != rates) last -= newton_at(m, Scalar(1)) * coefficient_[m];
    }
    last /= newton_at(rates, Scalar(1));
  }

  void polynomial(const Scalar& x, Vector& result) const {
    result = before_.state.rest;
    for (std::size_t m = coefficients; m-- > 0;) result += newton_at(m, x) * coefficient_[m];
    result += before_.state.value;
  }

  Field field_;
  Accuracy accuracy_;
  Compensated<Scalar> time_;
  Compensated<Vector> state_;
  Scalar step_ = Scalar(0);
  unsigned steps_taken_ = 0;  ///< modulo its range
  Scalar squares_{0};         ///< of step lengths, since the last rounding sample
  Scalar log_worst_before_ = Scalar(0);
  Rejected rejected_;
  Scalar allowed_;  ///< accuracy_.relative, or the rounding level if that is higher
  Memory stage_;
  detail::BlockSizes<Vector> sizes_;
  std::vector<Scalar> jumps_;
  Scalar last_stage_time_ = Scalar(0);  ///< upper limit of stage times on the side of the step
  Begin before_;
  bool polynomial_known_ = false;
  int short_steps_ = 0;
  std::array<Vector, coefficients> coefficient_;  ///< the polynomial's coefficients
  IntegrationStatistics effort_;
  detail::TrialFailure<Scalar> failure_;
};

}  // namespace kreisel
