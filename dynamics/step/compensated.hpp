#pragma once

namespace kreisel::detail {

/// A compensated sum: the value and its rounding error (Kahan, Neumaier). Over many steps the sum's
/// error stays one rounding.
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

  /// Sets this to from + increment. Unlike add() it makes no temporary T: a vector of dynamic size
  /// would allocate memory.
  void set_sum(const Compensated& from, const T& increment) {
    rest = increment + from.rest;
    value = from.value + rest;
    rest -= value - from.value;
  }
};

}  // namespace kreisel::detail
