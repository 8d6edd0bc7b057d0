#pragma once

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <sstream>
#include <type_traits>
#include <utility>

#include <dynamics/step/verner.hpp>
#include <motor/error.hpp>

namespace kreisel {

/// How exact an integration is to be.
struct Accuracy {
  /// Of the error made in one step, relative to each block of the state; 1e-16 to 1e-2.
  double relative = 1e-14;

  /// A block smaller than this (in its SI unit) counts as being so large. Set it to the size of the
  /// signal where that is smaller.
  double smallest = 1e-3;

  /// Evaluations of the field after which the integration gives up.
  double most_evaluations = 1e8;
};

/// What an integration has cost so far.
struct Effort {
  double steps = 0;
  double rejected = 0;
  double evaluations = 0;
};

/// Explicit Runge-Kutta integration of  y' = field(t, y)  with adaptive steps.
///
/// State and time are added up with compensation, so that rounding does not grow with the number of
/// steps. A step whose result is not finite is rejected and halved like one that errs too much, so a
/// field that only exists in a region is not left; the last good time and state always stay readable.
///
/// Field  : callable (S t, Vector y) -> Vector, Vector = Eigen::Matrix<S, n, 1>
/// Blocks : how many components, in turn, share a unit and a size, e.g. {4, 3} for a quaternion and
///          an angular velocity; one block by default
/// Cost   : 16 evaluations a step
/// Throws : InvalidInput for an accuracy out of range or a start that is not finite;
///          ComputationFailed naming the time where steps become too short or too many
template <class Vector, class Field, class Tableau = Verner98>
class ExplicitSteps {
 public:
  using Scalar = typename Vector::Scalar;

  template <std::size_t n = 1>
  ExplicitSteps(Field field, const Scalar& t, const Vector& y, const Accuracy& accuracy = {},
                const std::array<int, n>& blocks = {int(Vector::RowsAtCompileTime)})
      : field_(std::move(field)), accuracy_(accuracy), time_{t, Scalar(0)}, state_{y, zero(y)} {
    if (!(accuracy.relative >= 1e-16 && accuracy.relative <= 1e-2)) {
      refuse("accuracy.relative = ", accuracy.relative,
             " lies outside [1e-16, 1e-2], what steps in double precision can keep");
    }
    if (!(accuracy.smallest >= 0))
      refuse("accuracy.smallest = ", accuracy.smallest, " must be 0 or above");
    if (!std::isfinite(static_cast<double>(t))) refuse("the start time is not finite");
    if (!(y - y).isZero(Scalar(0))) refuse("the state at the start is not finite");
    int begin = 0;
    for (const int size : blocks) {
      blocks_[blocks_used_++] = {begin, size, Scalar(0)};
      begin += size;
    }
    if (begin != y.size()) refuse("blocks of ", begin, " components for a state of ", y.size());
    note_size(y);
  }

  [[nodiscard]] const Scalar& t() const { return time_.value; }
  [[nodiscard]] const Vector& y() const { return state_.value; }
  [[nodiscard]] const Effort& effort() const { return effort_; }

  /// Integrates to `end`, which is hit exactly; forwards or backwards.
  const Vector& advance_to(const Scalar& end) {
    using std::abs;
    if (!std::isfinite(static_cast<double>(end))) refuse("the end time is not finite");
    if (end == t()) return y();
    stage_[0] = evaluate(t(), y());
    if (!(stage_[0] - stage_[0]).isZero(Scalar(0))) give_up("the field is not finite");
    if (step_ == Scalar(0)) step_ = first_step();
    while (end != t()) {
      const Scalar left = (end - time_.value) - time_.rest;
      const bool last = abs(left) <= abs(step_);
      const Scalar wanted = step_;
      if (!attempt(last ? left : std::copysign(step_, left))) continue;
      if (last) {
        time_ = {end, Scalar(0)};
        step_ = std::max(step_, wanted);  // it was the end, not the error, that made it short
      } else {
        stage_[0] = evaluate(t(), y());
      }
    }
    return y();
  }

 private:
  /// A sum and what rounding has taken from it.
  template <class T>
  struct Compensated {
    T value;
    T rest;

    void add(const T& increment) {
      const T corrected = increment + rest;
      const T sum = value + corrected;
      rest = corrected - (sum - value);
      value = sum;
    }
  };

  struct Block {
    int begin;
    int size;
    Scalar scale;
  };

  static Vector zero(const Vector& y) { return Vector::Zero(y.size()); }

  template <class... Words>
  [[noreturn]] static void refuse(const Words&... words) {
    std::ostringstream text;
    text.precision(10);
    (text << ... << words);
    throw InvalidInput(text.str());
  }

  template <class... Words>
  [[noreturn]] void give_up(const Words&... words) const {
    std::ostringstream text;
    text.precision(17);
    text << "integration stopped at t = " << t() << " s: ";
    (text << ... << words);
    throw ComputationFailed(text.str());
  }

  [[nodiscard]] Vector evaluate(const Scalar& t, const Vector& y) {
    effort_.evaluations += 1;
    return field_(t, y);
  }

  [[nodiscard]] Scalar norm(const Vector& v, const Block& block) const {
    Scalar sum(0);  // a loop, because g++ 12 sees v.segment().norm() read past the end of v
    for (int i = block.begin; i < block.begin + block.size; ++i) sum += v[i] * v[i];
    return std::sqrt(sum);
  }

  void note_size(const Vector& y) {
    for (std::size_t i = 0; i < blocks_used_; ++i) {
      blocks_[i].scale = std::max(blocks_[i].scale, norm(y, blocks_[i]));
    }
  }

  [[nodiscard]] Scalar scale(const Block& block) const {
    return std::max(block.scale, Scalar(accuracy_.smallest));
  }

  /// A hundredth of the time in which a block changes by its own size.
  [[nodiscard]] Scalar first_step() const {
    Scalar rate(0);
    for (std::size_t i = 0; i < blocks_used_; ++i) {
      rate = std::max(rate, Scalar(norm(stage_[0], blocks_[i]) / scale(blocks_[i])));
    }
    return rate > Scalar(0) ? Scalar(Scalar(0.01) / rate) : Scalar(1);
  }

  /// sum of c_j k_j over the stages, skipping what is 0.
  template <const auto& row, std::size_t... j>
  void accumulate(Vector& sum, std::index_sequence<j...>) const {
    const auto add = [&]<std::size_t i>() {
      if constexpr (row[i] != 0) sum += static_cast<Scalar>(row[i]) * stage_[i];
    };
    (add.template operator()<j>(), ...);
  }

  template <std::size_t i>
  static constexpr auto row = Tableau::a[i];

  template <std::size_t... i>
  void fill_stages(const Scalar& h, std::index_sequence<i...>) {
    const auto fill = [&]<std::size_t k>() {
      Vector sum = zero(y());
      accumulate<row<k>>(sum, std::make_index_sequence<k>());
      const Scalar c = static_cast<Scalar>(Tableau::node[k]);
      stage_[k] = evaluate(t() + (c * h + time_.rest), y() + (h * sum + state_.rest));
    };
    (fill.template operator()<i + 1>(), ...);
  }

  /// One step of length h; says whether it stood. Sets the length of the next.
  bool attempt(const Scalar& h) {
    using std::abs;
    using std::isfinite;
    using std::max;
    using std::pow;
    if (abs(h) <= Scalar(4) * std::numeric_limits<Scalar>::epsilon() * abs(t()) || h == Scalar(0)) {
      give_up("the step has become too short to move time on");
    }
    if (effort_.evaluations > accuracy_.most_evaluations) {
      give_up(accuracy_.most_evaluations, " evaluations are spent");
    }
    fill_stages(h, std::make_index_sequence<Tableau::stages - 1>());
    Vector sum = zero(y());
    accumulate<Tableau::b>(sum, std::make_index_sequence<Tableau::stages>());
    Vector error = zero(y());
    accumulate<Tableau::difference>(error, std::make_index_sequence<Tableau::stages>());
    const Vector change = h * sum;
    Scalar worst(0);  // in units of what is allowed
    for (std::size_t i = 0; i < blocks_used_; ++i) {
      const Block& block = blocks_[i];
      const Scalar size = max(scale(block), Scalar(norm(change, block)));
      const Scalar ratio = abs(h) * norm(error, block) / (Scalar(accuracy_.relative) * size);
      worst = ratio <= worst || worst != worst ? worst : ratio;  // a NaN stays
    }
    const bool finite = isfinite(static_cast<double>(worst)) && (change - change).isZero(Scalar(0));
    if (!finite) {
      step_ = abs(h) / Scalar(8);
    } else {
      const Scalar aim = Scalar(0.9) * pow(max(worst, Scalar(1e-12)), Scalar(-1) / Tableau::order);
      step_ = abs(h) * std::clamp(aim, Scalar(0.2), Scalar(5));
    }
    if (!finite || worst > Scalar(1)) {
      effort_.rejected += 1;
      return false;
    }
    effort_.steps += 1;
    state_.add(change);
    time_.add(h);
    note_size(y());
    return true;
  }

  Field field_;
  Accuracy accuracy_;
  Compensated<Scalar> time_;
  Compensated<Vector> state_;
  Scalar step_ = Scalar(0);
  std::array<Vector, Tableau::stages> stage_ = {};
  std::array<Block, 8> blocks_ = {};
  std::size_t blocks_used_ = 0;
  Effort effort_;
};

}  // namespace kreisel
