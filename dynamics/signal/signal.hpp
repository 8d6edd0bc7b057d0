#pragma once

#include <Eigen/Core>

#include <cmath>
#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <dynamics/signal/polynomials.hpp>
#include <motor/error.hpp>
#include <motor/lanes.hpp>
#include <motor/motor.hpp>

namespace kreisel {

namespace detail {

/// A signal's value in numbers of type S.
template <class Value, class S>
using SignalValue = std::conditional_t<std::is_same_v<Value, double>, S, Vector3<S>>;

}  // namespace detail

/// A function of time: a piecewise linear part plus oscillations, or a spline.
///
///   f(t) = value + rate (t - begin) + sum amplitude sin(frequency t + phase) + spline(t)
///
/// Each line is valid from its begin to the next one's; the first is also valid before its begin.
/// At a jump the signal has the value after the jump.
///
/// Value  : double, or Vector3<double>
/// Units  : second, rad/s, radian
/// Error  : each oscillation <= 3u of its amplitude at any time, for frequency and phase taken as
///          exact                                            (tests/dynamics/signal/signal.cpp)
template <class Value = double>
class Signal {
 public:
  struct Term {
    Value amplitude;
    double frequency = 0;
    double phase = 0;
  };

  /// Times, in order, with the signal's values.
  using Points = std::vector<std::pair<double, Value>>;

  Signal() : Signal(zero()) {}
  Signal(const Value& constant)  // NOLINT: a constant is a signal
      : Signal(constant, zero(), {}) {}
  /// The signal  constant + rate t + sum amplitude sin(frequency t + phase).
  ///
  /// Throws : InvalidInput for a number that is not finite
  Signal(const Value& constant, const Value& rate, std::vector<Term> terms)
      : lines_{{0, constant, rate}}, terms_(std::move(terms)) {
    bool finite = is_finite(constant) && is_finite(rate);
    for (const Term& term : terms_) {
      finite = finite && is_finite(term.amplitude) && std::isfinite(term.frequency) &&
               std::isfinite(term.phase);
    }
    if (!finite) throw InvalidInput("signal: a number is not finite");
  }

  /// A piecewise constant signal: each value holds from its time on; before the first time it is 0.
  ///
  /// Throws : InvalidInput: no points, times that do not increase, a number that is not finite
  [[nodiscard]] static Signal steps(const Points& points) {
    check(points, "steps");
    Signal result;
    for (const auto& [begin, value] : points) {
      if (value != result.lines_.back().value) result.lines_.push_back({begin, value, zero()});
    }
    result.jumps_ = result.lines_.size() > 1;
    return result;
  }

  /// A broken line through the points; constant before the first and after the last one.
  ///
  /// Throws : as steps()
  [[nodiscard]] static Signal broken_line(const Points& points) {
    check(points, "points");
    Signal result(points.front().second);
    for (std::size_t i = 0; i + 1 < points.size(); ++i) {
      const auto& [begin, value] = points[i];
      const auto& [end, next] = points[i + 1];
      result.lines_.push_back({begin, value, (next - value) / (end - begin)});
    }
    if (points.size() > 1) {
      result.lines_.push_back({points.back().first, points.back().second, zero()});
    }
    return result;
  }

  /// A signal of continuous polynomials whose rates are continuous, too.
  ///
  /// Throws : InvalidInput for no pieces, or a number of coefficients that does not fit them. The
  ///          signal throws where the polynomials do
  [[nodiscard]] static Signal polynomials(Polynomials<Value> pieces) {
    if (pieces.begins.empty() || pieces.terms == 0 ||
        pieces.coefficients.size() != pieces.begins.size() * pieces.terms) {
      throw InvalidInput("signal: the coefficients of polynomials do not fit their pieces");
    }
    Signal result;
    result.spline_ = std::make_shared<const Polynomials<Value>>(std::move(pieces));
    return result;
  }

  /// The value in double, or in dual numbers of any depth; a pack's lanes share the time.
  template <class S>
  [[nodiscard]] detail::SignalValue<Value, S> operator()(const S& t) const {
    return at(t, 0);
  }

  /// The derivative of the given order, after a jump if t is one.
  [[nodiscard]] Value derivative(double t, int order) const {
    const Line& line = line_at(t);
    Value sum = zero();
    if (order == 0) sum = line.value + (t - line.begin) * line.rate;
    if (order == 1) sum = line.rate;
    for (const Term& term : terms_) {
      const auto cycle = Cycle(term, t);
      sum += (std::pow(term.frequency, order) * cycle[order]) * term.amplitude;
    }
    if (spline_) sum += spline_->derivative(t, order);
    return sum;
  }

  /// Fills `result` with the coefficients in powers of (time - t)/h, after a jump if t is one. The
  /// signal must be analytic.
  void coefficients(double t, double h, std::span<Value> result) const {
    const Line& line = line_at(t);
    for (Value& coefficient : result) coefficient = zero();
    result[0] = line.value + (t - line.begin) * line.rate;
    if (result.size() > 1) result[1] = h * line.rate;
    for (const Term& term : terms_) {
      const auto cycle = Cycle(term, t);
      double factor = 1;  // (frequency h)^n / n!
      for (std::size_t n = 0; n < result.size(); ++n) {
        result[n] += (factor * cycle[static_cast<int>(n)]) * term.amplitude;
        factor *= term.frequency * h / static_cast<double>(n + 1);
      }
    }
  }

  /// The times at which value or rate jumps, in order.
  [[nodiscard]] std::vector<double> discontinuities() const {
    std::vector<double> times;
    for (std::size_t i = 1; i < lines_.size(); ++i) times.push_back(lines_[i].begin);
    return times;
  }

  /// True if neither value nor rate jumps.
  [[nodiscard]] bool is_smooth() const { return lines_.size() == 1; }

  /// True if its Taylor series holds up to the next jump: it has no spline.
  [[nodiscard]] bool is_analytic() const { return spline_ == nullptr; }

  /// True if its value jumps, not only its rate.
  [[nodiscard]] bool jumps() const { return jumps_; }

  /// True if it is constant.
  [[nodiscard]] bool is_constant() const {
    return lines_.size() == 1 && lines_.front().rate == zero() && terms_.empty() && !spline_;
  }

  /// The signal times a factor.
  [[nodiscard]] Signal scaled(double factor) const {
    Signal result = *this;
    for (Line& line : result.lines_) {
      line.value *= factor;
      line.rate *= factor;
    }
    for (Term& term : result.terms_) term.amplitude *= factor;
    if (spline_) {
      Polynomials<Value> pieces = *spline_;
      for (Value& coefficient : pieces.coefficients) coefficient *= factor;
      result.spline_ = std::make_shared<const Polynomials<Value>>(std::move(pieces));
    }
    return result;
  }

 private:
  struct Line {
    double begin;
    Value value;
    Value rate;
  };

  /// sin(angle + n pi/2), for the angle without rounding.
  class Cycle {
   public:
    Cycle(const Term& term, double t) {
      const double way = term.frequency * t;
      const double angle = way + term.phase;
      const double added = angle - way;
      const double off =
          std::fma(term.frequency, t, -way) + ((way - (angle - added)) + (term.phase - added));
      const double s = std::sin(angle);
      const double c = std::cos(angle);
      sine_ = s * std::cos(off) + c * std::sin(off);
      cosine_ = c * std::cos(off) - s * std::sin(off);
    }

    [[nodiscard]] double operator[](int n) const {
      const double size = n % 2 == 0 ? sine_ : cosine_;
      return n % 4 < 2 ? size : -size;
    }

   private:
    double sine_;
    double cosine_;
  };

  [[nodiscard]] static Value zero() {
    if constexpr (std::is_same_v<Value, double>) {
      return 0;
    } else {
      return Value::Zero();
    }
  }

  [[nodiscard]] static bool is_finite(const Value& value) {
    const Value none = value - value;
    return none == zero();
  }

  static void check(const Points& points, const std::string& what) {
    const auto refuse = [&what](const std::string& why) {
      throw InvalidInput("signal: " + what + " " + why);
    };
    if (points.empty()) refuse("are none");
    for (std::size_t i = 0; i < points.size(); ++i) {
      const auto& [t, value] = points[i];
      const std::string number = std::to_string(i + 1);
      if (!std::isfinite(t) || !is_finite(value)) refuse("are not finite at number " + number);
      if (i > 0 && !(t > points[i - 1].first)) refuse("do not increase at number " + number);
    }
  }

  [[nodiscard]] const Line& line_at(double t) const {
    std::size_t first = 0;
    std::size_t last = lines_.size() - 1;
    while (first < last) {
      const std::size_t middle = (first + last + 1) / 2;
      if (lines_[middle].begin <= t) {
        first = middle;
      } else {
        last = middle - 1;
      }
    }
    return lines_[first];
  }

  template <class S>
  [[nodiscard]] detail::SignalValue<Value, S> at(const S& t, int order) const {
    if constexpr (std::is_same_v<S, double>) {
      return derivative(t, order);
    } else {
      const auto now = at(t.value(), order);
      const auto slope = at(t.value(), order + 1);
      if constexpr (std::is_same_v<Value, double>) {
        return S(now, slope * t.derivatives());
      } else {
        return {S(now[0], slope[0] * t.derivatives()), S(now[1], slope[1] * t.derivatives()),
                S(now[2], slope[2] * t.derivatives())};
      }
    }
  }

  std::vector<Line> lines_;  ///< the first is also valid before its begin
  std::vector<Term> terms_;
  std::shared_ptr<const Polynomials<Value>> spline_ = nullptr;
  bool jumps_ = false;
};

}  // namespace kreisel
