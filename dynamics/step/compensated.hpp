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
};

}  // namespace kreisel::detail
