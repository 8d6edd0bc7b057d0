#pragma once

#include <concepts>
#include <functional>
#include <memory>
#include <span>
#include <type_traits>
#include <utility>

#include <dynamics/signal/signal.hpp>
#include <motor/api.hpp>

namespace kreisel {

/// A function of time: any callable, or a derivative of a signal. The derivative of an analytic
/// signal has a Taylor series. The default is no function.
///
/// Throws : as the function
class KREISEL_API TimeFunction {
 public:
  TimeFunction() = default;
  template <class F>
  requires(!std::same_as<F, TimeFunction> && std::is_invocable_r_v<double, F, double>)
      TimeFunction(F function)  // NOLINT: any callable is a function of time
      : value_(std::move(function)) {}

  /// The derivative of the given order of a signal.
  TimeFunction(const Signal<double>& signal, int order = 0);  // NOLINT: a signal is such a function

  [[nodiscard]] explicit operator bool() const { return static_cast<bool>(value_); }
  [[nodiscard]] double operator()(double t) const { return value_(t); }

  /// The derivative: exact for signals, else a difference of fourth order in steps of 1/1024 s.
  [[nodiscard]] double slope(double t) const;

  /// True if coefficients() is available.
  [[nodiscard]] bool is_analytic() const;

  /// Fills `result` with the coefficients in powers of (time - t)/h, after a jump if t is one.
  void coefficients(double t, double h, std::span<double> result) const;

 private:
  struct Source;

  std::function<double(double t)> value_ = nullptr;
  std::shared_ptr<const Source> source_ = nullptr;
};

}  // namespace kreisel
