#pragma once

#include <concepts>
#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include <dynamics/model/dual_numbers.hpp>
#include <dynamics/signal/signal.hpp>

namespace kreisel {

/// A function of time: any callable, or a derivative of a signal. The derivative of an analytic
/// signal has a Taylor series. The default is no function.
class TimeFunction {
 public:
  TimeFunction() = default;
  template <class F>
  requires(!std::same_as<F, TimeFunction> && std::is_invocable_r_v<double, F, double>)
      TimeFunction(F function)  // NOLINT: any callable is a function of time
      : value_(std::move(function)) {}
  TimeFunction(const Signal<double>& signal)  // NOLINT: a signal is a function of time
      : TimeFunction(signal, 0) {}

  /// The derivative of the given order.
  TimeFunction(const Signal<double>& signal, int order)
      : value_([signal, order](double t) { return signal.derivative(t, order); }),
        source_({signal, order}) {}

  [[nodiscard]] explicit operator bool() const { return static_cast<bool>(value_); }
  [[nodiscard]] double operator()(double t) const { return value_(t); }

  /// The derivative: exact for signals, else a difference of fourth order in steps of 1/1024 s.
  [[nodiscard]] double slope(double t) const {
    if (source_) return source_->signal.derivative(t, source_->order + 1);
    return detail::slope_in_time(value_, t);
  }

  /// True if coefficients() is available.
  [[nodiscard]] bool is_analytic() const { return source_ && source_->signal.is_analytic(); }

  /// Fills `result` with the coefficients in powers of (time - t)/h, after a jump if t is one.
  void coefficients(double t, double h, std::span<double> result) const {
    const auto order = static_cast<std::size_t>(source_->order);
    std::vector<double> all(result.size() + order);
    source_->signal.coefficients(t, h, all);
    for (std::size_t n = 0; n < result.size(); ++n) {
      result[n] = all[n + order];
      for (std::size_t i = 1; i <= order; ++i) result[n] *= static_cast<double>(n + i) / h;
    }
  }

 private:
  struct Source {
    Signal<double> signal;
    int order;
  };

  std::function<double(double t)> value_ = nullptr;
  std::optional<Source> source_ = {};
};

}  // namespace kreisel
