#pragma once

#include <motor/four.hpp>
#include <motor/motor.hpp>

namespace kreisel::detail {

/// A vector and both its cyclic exchanges.
struct Cycles {
  Four as_is, next, after;

  Cycles() = default;
  explicit Cycles(const Four& v) : as_is(v), next(v.next()), after(v.after()) {}
};

/// A 3x3 matrix by its three diagonals, which what it multiplies goes round.
struct Diagonals {
  Four main, upper, lower;

  [[nodiscard]] static Diagonals of(const Matrix3<double>& m) {
    return {Four(m(0, 0), m(1, 1), m(2, 2), 0), Four(m(0, 1), m(1, 2), m(2, 0), 0),
            Four(m(0, 2), m(1, 0), m(2, 1), 0)};
  }

  /// R^t of a quaternion q, by the products (xx, yy, zz, ww), (xy, yz, zx) and (xw, yw, zw) of its
  /// components; scale = 1/|q|^2.
  [[nodiscard]] static Diagonals turn_back(const Four& square, const Four& next, const Four& by_w,
                                           double scale) {
    const double ww = square[3];
    const Four zw = by_w.after();
    return {scale * ((square + Four(ww, ww, ww, ww)) - (square.next() + square.after())),
            2 * scale * (next + zw), (2 * scale * (next - zw)).after()};
  }

  [[nodiscard]] Diagonals transposed() const { return {main, lower.next(), upper.after()}; }

  [[nodiscard]] friend Four operator*(const Diagonals& m, const Cycles& v) {
    return m.main * v.as_is + m.upper * v.next + m.lower * v.after;
  }
};

}  // namespace kreisel::detail
