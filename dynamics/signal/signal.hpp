#pragma once

#include <Eigen/Core>

#include <memory>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include <dynamics/signal/polynomials.hpp>
#include <motor/api.hpp>
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
class KREISEL_API Signal {
 public:
  struct Term {
    Value amplitude;
    double frequency = 0;
    double phase = 0;
  };

  /// Times, in order, with the signal's values.
  using Points = std::vector<std::pair<double, Value>>;

  Signal();
  Signal(const Value& constant);  // NOLINT: a constant is a signal
  /// The signal  constant + rate t + sum amplitude sin(frequency t + phase).
  ///
  /// Throws : InvalidInput for a number that is not finite
  Signal(const Value& constant, const Value& rate, std::vector<Term> terms);

  /// A piecewise constant signal: each value holds from its time on; before the first time it is 0.
  ///
  /// Throws : InvalidInput: no points, times that do not increase, a number that is not finite
  [[nodiscard]] static Signal steps(const Points& points);

  /// A broken line through the points; constant before the first and after the last one.
  ///
  /// Throws : as steps()
  [[nodiscard]] static Signal broken_line(const Points& points);

  /// A signal of continuous polynomials whose rates are continuous, too.
  ///
  /// Throws : InvalidInput for no pieces, or a number of coefficients that does not fit them. The
  ///          signal throws where the polynomials do
  [[nodiscard]] static Signal polynomials(Polynomials<Value> pieces);

  /// The value in double, or in dual numbers of any depth; a pack's lanes share the time.
  template <class S>
  [[nodiscard]] detail::SignalValue<Value, S> operator()(const S& t) const {
    return at(t, 0);
  }

  /// The derivative of the given order, after a jump if t is one.
  [[nodiscard]] Value derivative(double t, int order) const;
  /// The same in dual numbers.
  template <class S>
  requires(!std::is_arithmetic_v<S>)
      [[nodiscard]] detail::SignalValue<Value, S> derivative(const S& t, int order) const {
    return at(t, order);
  }

  /// Fills `result` with the coefficients in powers of (time - t)/h, after a jump if t is one. The
  /// signal must be analytic.
  void coefficients(double t, double h, std::span<Value> result) const;

  /// The times at which value or rate jumps, in order.
  [[nodiscard]] std::vector<double> discontinuities() const;

  /// True if neither value nor rate jumps.
  [[nodiscard]] bool is_smooth() const { return lines_.size() == 1; }

  /// True if its Taylor series holds up to the next jump: it has no spline.
  [[nodiscard]] bool is_analytic() const { return spline_ == nullptr; }

  /// True if its value jumps, not only its rate.
  [[nodiscard]] bool jumps() const { return jumps_; }

  /// True if it is constant.
  [[nodiscard]] bool is_constant() const;

  /// The greatest frequency of its oscillations; 0 if it has none.
  [[nodiscard]] double greatest_frequency() const;

  /// The signal times a factor.
  [[nodiscard]] Signal scaled(double factor) const;

 private:
  struct Line {
    double begin;
    Value value;
    Value rate;
  };

  class Cycle;

  [[nodiscard]] const Line& line_at(double t) const;

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

extern template class Signal<double>;
extern template class Signal<Vector3<double>>;

}  // namespace kreisel
