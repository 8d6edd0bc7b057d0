#pragma once

namespace kreisel::detail {

/// A sum and what rounding has taken from it (Kahan, Neumaier): over many steps the sum's error
/// stays one rounding instead of growing with their number.
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

  /// Becomes from + increment, like add() but without a T for the time being: a vector of a size
  /// known at run time only would ask for memory.
  void set_sum(const Compensated& from, const T& increment) {
    rest = increment + from.rest;
    value = from.value + rest;
    rest -= value - from.value;
  }
};

}  // namespace kreisel::detail
