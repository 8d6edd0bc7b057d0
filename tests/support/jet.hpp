#pragma once

#include <Eigen/Core>

#include <cmath>
#include <type_traits>

namespace kreisel::test {

/// A function of time, given by its value and two derivatives: sums and products follow Leibniz.
template <class S>
struct Jet {
  S value = S(0);
  S first = S(0);
  S second = S(0);

  Jet() = default;
  template <class N>
  requires std::is_arithmetic_v<N> Jet(N constant)
      : value(constant) {}                     // NOLINT: a number is a constant function
  Jet(const S& constant) : value(constant) {}  // NOLINT
  Jet(const S& v, const S& d, const S& dd) : value(v), first(d), second(dd) {}

  friend Jet operator+(const Jet& a, const Jet& b) {
    return {a.value + b.value, a.first + b.first, a.second + b.second};
  }
  friend Jet operator-(const Jet& a, const Jet& b) {
    return {a.value - b.value, a.first - b.first, a.second - b.second};
  }
  friend Jet operator-(const Jet& a) { return {-a.value, -a.first, -a.second}; }
  friend Jet operator*(const Jet& a, const Jet& b) {
    return {a.value * b.value, a.first * b.value + a.value * b.first,
            a.second * b.value + S(2) * a.first * b.first + a.value * b.second};
  }
  friend Jet& operator+=(Jet& a, const Jet& b) { return a = a + b; }
  friend Jet& operator-=(Jet& a, const Jet& b) { return a = a - b; }
  friend Jet& operator*=(Jet& a, const Jet& b) { return a = a * b; }

  /// f(a) with f, f' and f'' given at the value.
  [[nodiscard]] Jet through(const S& f, const S& df, const S& ddf) const {
    return {f, df * first, ddf * first * first + df * second};
  }

  friend Jet sin(const Jet& a) {
    using std::cos;
    using std::sin;
    const S s = sin(a.value);
    return a.through(s, cos(a.value), -s);
  }
  friend Jet cos(const Jet& a) {
    using std::cos;
    using std::sin;
    const S c = cos(a.value);
    return a.through(c, -sin(a.value), -c);
  }

  /// The derivative as a function of time; its own second derivative is unknown and set to 0.
  [[nodiscard]] Jet rate() const { return {first, second, S(0)}; }
};

template <class S, int Rows, int Columns>
[[nodiscard]] Eigen::Matrix<S, Rows, Columns> value(const Eigen::Matrix<Jet<S>, Rows, Columns>& m) {
  return m.unaryExpr([](const Jet<S>& x) { return x.value; });
}

template <class S, int Rows, int Columns>
[[nodiscard]] Eigen::Matrix<S, Rows, Columns> first(const Eigen::Matrix<Jet<S>, Rows, Columns>& m) {
  return m.unaryExpr([](const Jet<S>& x) { return x.first; });
}

template <class S, int Rows, int Columns>
[[nodiscard]] Eigen::Matrix<S, Rows, Columns> second(
    const Eigen::Matrix<Jet<S>, Rows, Columns>& m) {
  return m.unaryExpr([](const Jet<S>& x) { return x.second; });
}

template <class S, int Rows, int Columns>
[[nodiscard]] Eigen::Matrix<Jet<S>, Rows, Columns> rate(
    const Eigen::Matrix<Jet<S>, Rows, Columns>& m) {
  return m.unaryExpr([](const Jet<S>& x) { return x.rate(); });
}

}  // namespace kreisel::test

template <class S>
struct Eigen::NumTraits<kreisel::test::Jet<S>> : Eigen::GenericNumTraits<kreisel::test::Jet<S>> {
  using Real = kreisel::test::Jet<S>;
  using NonInteger = kreisel::test::Jet<S>;
  using Nested = kreisel::test::Jet<S>;
  enum { IsComplex = 0, IsInteger = 0, IsSigned = 1, RequireInitialization = 1 };
};
