#pragma once

#include <Eigen/Core>

#include <cmath>

#include <dynamics/inertia.hpp>
#include <motor/displacement.hpp>
#include <motor/motor.hpp>
#include <motor/tensor.hpp>

namespace kreisel::test {

/// The sum of the sizes of a formula's terms: a number that cannot cancel.
///
/// Put through the same formula as the values, it gives the scale of their rounding errors. In a
/// sum of products with n successive operations the error is at most about n u times this.
struct Terms {
  double size = 0;

  Terms() = default;
  Terms(double value) : size(std::abs(value)) {}  // NOLINT: a number is its own term

  friend Terms operator+(Terms a, Terms b) { return a.size + b.size; }
  friend Terms operator-(Terms a, Terms b) { return a.size + b.size; }
  friend Terms operator-(Terms a) { return a; }
  friend Terms operator*(Terms a, Terms b) { return a.size * b.size; }
  friend Terms operator/(Terms a, Terms b) { return a.size / b.size; }
  friend Terms& operator+=(Terms& a, Terms b) { return a = a + b; }
  friend Terms& operator-=(Terms& a, Terms b) { return a = a + b; }
  friend bool operator==(Terms a, Terms b) = default;
  friend auto operator<=>(Terms a, Terms b) = default;
};

}  // namespace kreisel::test

template <>
struct Eigen::NumTraits<kreisel::test::Terms> : Eigen::GenericNumTraits<kreisel::test::Terms> {
  using Real = kreisel::test::Terms;
  using NonInteger = kreisel::test::Terms;
  using Nested = kreisel::test::Terms;
  enum { IsComplex = 0, IsInteger = 0, IsSigned = 1, RequireInitialization = 1 };
};

namespace kreisel::test {

template <int Rows, int Columns>
[[nodiscard]] Eigen::Matrix<Terms, Rows, Columns> terms(
    const Eigen::Matrix<double, Rows, Columns>& m) {
  return m.template cast<Terms>();
}

[[nodiscard]] inline Motor<Terms> terms(const Motor<>& a) {
  return {terms(a.resultant), terms(a.moment)};
}

[[nodiscard]] inline MotorTensor<Terms> terms(const MotorTensor<>& T) {
  return {terms(T.rr), terms(T.rm), terms(T.mr), terms(T.mm)};
}

[[nodiscard]] inline Pose<Terms> terms(const Pose<>& X) {
  return {terms(X.rotation), terms(X.translation)};
}

[[nodiscard]] inline Symmetric3<Terms> terms(const Symmetric3<>& m) {
  return {m.xx, m.yy, m.zz, m.xy, m.xz, m.yz};
}

[[nodiscard]] inline Inertia<Terms> terms(const Inertia<>& T) {
  return {T.mass, terms(T.first_moment), terms(T.tensor)};
}

}  // namespace kreisel::test
