#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>

namespace kreisel::exact {

/// The number type of exact motions: over 1e4 periods double would leave an error of 1e-11 of a
/// phase. The bounds stated here are for 64 bits (x86). Where long double is no more than double
/// they are 2^11 times as large.
using Real = long double;

namespace carlson {

namespace detail {

/// The spread below which a series without its eighth power is accurate. It is compared by !(>=),
/// so that NaN ends the loop too.
[[nodiscard]] inline Real last_spread() {
  static const Real spread = std::pow(std::numeric_limits<Real>::epsilon() / 8, Real(1) / 8);
  return spread;
}

}  // namespace detail

/// R_F(x, y, z) = 1/2 int_0^inf dt / sqrt((t + x)(t + y)(t + z)),  at most one of them 0.
///
/// Source : B. C. Carlson, Numerical computation of real or complex elliptic integrals (1995); the
///          series of R_F and R_J to the seventh power: NIST Handbook of Mathematical Functions,
///          19.36(i)
/// Error  : some units of long double, relative
[[nodiscard]] inline Real rf(Real x, Real y, Real z) {
  while (true) {
    const Real mean = (x + y + z) / 3;
    const Real X = 1 - x / mean;
    const Real Y = 1 - y / mean;
    const Real Z = -X - Y;
    if (!(std::max({std::abs(X), std::abs(Y), std::abs(Z)}) >= detail::last_spread())) {
      const Real e2 = X * Y - Z * Z;
      const Real e3 = X * Y * Z;
      const Real series =
          1 + e3 * (Real(1) / 14 + 3 * e3 / 104) +
          e2 * (Real(-0.1L) - 3 * e3 / 44 + e2 * (Real(1) / 24 + e3 / 16 - 5 * e2 / 208));
      return series / std::sqrt(mean);
    }
    const Real sx = std::sqrt(x);
    const Real sy = std::sqrt(y);
    const Real sz = std::sqrt(z);
    const Real lambda = sx * sy + sx * sz + sy * sz;
    x = (x + lambda) / 4;
    y = (y + lambda) / 4;
    z = (z + lambda) / 4;
  }
}

/// R_C(x, y) = R_F(x, y, y),  y > 0.
[[nodiscard]] inline Real rc(Real x, Real y) {
  while (true) {
    const Real mean = (x + 2 * y) / 3;
    const Real s = y / mean - 1;
    if (!(std::abs(s) >= detail::last_spread())) {
      const Real series =
          3 * Real(0.1L) +
          s * (Real(1) / 7 +
               s * (Real(3) / 8 + s * (Real(9) / 22 + s * (Real(159) / 208 + s * 9 / 8))));
      return (1 + s * s * series) / std::sqrt(mean);
    }
    const Real lambda = 2 * std::sqrt(x) * std::sqrt(y) + y;
    x = (x + lambda) / 4;
    y = (y + lambda) / 4;
  }
}

/// R_J(x, y, z, p) = 3/2 int_0^inf dt / ((t + p) sqrt((t + x)(t + y)(t + z))),  p > 0.
///
/// The older of Carlson's two recurrences, whose terms are all positive: it keeps its digits for p
/// far below x, y and z.
///
/// Source : B. C. Carlson, Computing elliptic integrals by duplication (1979)
/// Error  : some units of long double, relative
[[nodiscard]] inline Real rj(Real x, Real y, Real z, Real p) {
  Real sum = 0;
  Real quarter = 1;
  while (true) {
    const Real mean = (x + y + z + 2 * p) / 5;
    const Real X = 1 - x / mean;
    const Real Y = 1 - y / mean;
    const Real Z = 1 - z / mean;
    const Real P = (-X - Y - Z) / 2;
    if (!(std::max({std::abs(X), std::abs(Y), std::abs(Z), std::abs(P)}) >=
          detail::last_spread())) {
      const Real xyz = X * Y * Z;
      const Real e2 = X * Y + X * Z + Y * Z - 3 * P * P;
      const Real e3 = xyz + 2 * e2 * P + 4 * P * P * P;
      const Real e4 = (2 * xyz + e2 * P + 3 * P * P * P) * P;
      const Real e5 = xyz * P * P;
      const Real series = 1 - 3 * e2 / 14 + e3 / 6 + 9 * e2 * e2 / 88 - 3 * e4 / 22 -
                          9 * e2 * e3 / 52 + 3 * e5 / 26 - e2 * e2 * e2 / 16 + 3 * e3 * e3 / 40 +
                          3 * e2 * e4 / 20 + 45 * e2 * e2 * e3 / 272 - 9 * (e3 * e4 + e2 * e5) / 68;
      return quarter * series / (mean * std::sqrt(mean)) + 3 * sum;
    }
    const Real sx = std::sqrt(x);
    const Real sy = std::sqrt(y);
    const Real sz = std::sqrt(z);
    const Real lambda = sx * sy + sx * sz + sy * sz;
    const Real alpha = p * (sx + sy + sz) + sx * sy * sz;
    sum += quarter * rc(alpha * alpha, p * (p + lambda) * (p + lambda));
    quarter /= 4;
    x = (x + lambda) / 4;
    y = (y + lambda) / 4;
    z = (z + lambda) / 4;
    p = (p + lambda) / 4;
  }
}

}  // namespace carlson

/// Jacobi's three functions sn, cn, dn of one argument.
struct Jacobi {
  Real sn;
  Real cn;
  Real dn;
};

/// An argument u = 2 K n + rest, |rest| <= K, with Jacobi's functions of both.
struct Phase {
  Real u;
  Real half_periods;  ///< n, a whole number
  Jacobi rest;        ///< of the rest, so that cn >= 0
  Jacobi at;          ///< of u itself
};

/// Jacobi's elliptic functions of parameter m = k^2 and its complement m1 = 1 - m, 0 <= m <= 1.
///
/// The caller forms m and m1 each without cancellation: near m = 1 everything depends on m1, and 1
/// - m has no correct digit of it. At m1 = 0 the functions are tanh and sech and K is infinite.
///
/// Source : Gauss' transformation (descending Landen), in the cotangent after R. Bulirsch (1965),
///          so that cn and dn keep their digits where they are small
/// Error  : the effect of an error of the argument of some units of long double of |u| + K
class EllipticFunctions {
 public:
  EllipticFunctions() : EllipticFunctions(0, 1) {}
  EllipticFunctions(Real m, Real m1) : m_(m), m1_(m1) {
    if (m1 == 0) return;
    Real a = 1;
    Real b = std::sqrt(m1);
    while (true) {
      a_[steps_] = a;
      b_[steps_] = b;
      ++steps_;
      mean_ = (a + b) / 2;
      // The next two would differ by the square of this, relatively: below rounding.
      const Real spread = (a - b) / (4 * a);
      if (spread * spread <= std::numeric_limits<Real>::epsilon() || steps_ == a_.size()) break;
      b = std::sqrt(a * b);
      a = mean_;
    }
    quarter_ = std::numbers::pi_v<Real> / 2 / mean_;
  }

  [[nodiscard]] Real m() const { return m_; }
  [[nodiscard]] Real m1() const { return m1_; }

  /// K(m), a quarter of the period of sn.
  [[nodiscard]] Real quarter() const { return quarter_; }

  /// The argument in [-K, K] of given values with cn >= 0:  u = sn R_F(cn^2, dn^2, 1).
  [[nodiscard]] static Real argument(const Jacobi& j) {
    return j.sn == 0 ? 0 : j.sn * carlson::rf(j.cn * j.cn, j.dn * j.dn, 1);
  }

  [[nodiscard]] Phase phase(Real u) const {
    if (m1_ == 0) {
      const Jacobi j = within_quarter(u);
      return {u, 0, j, j};
    }
    const Real rest = std::remainder(u, 2 * quarter_);
    const Real n = std::round((u - rest) / (2 * quarter_));
    const Jacobi j = within_quarter(rest);
    const Real sign = std::fmod(n, Real(2)) == 0 ? 1 : -1;
    return {u, n, j, {sign * j.sn, sign * j.cn, j.dn}};
  }

 private:
  /// The functions for |u| <= K.
  [[nodiscard]] Jacobi within_quarter(Real u) const {
    if (m1_ == 0) return {std::tanh(u), 1 / std::cosh(u), 1 / std::cosh(u)};
    const Real sine = std::sin(mean_ * u);
    if (sine == 0) return {0, 1, 1};
    Real a = std::cos(mean_ * u) / sine;
    Real cotangent = mean_ * a;
    Real dn = 1;
    for (std::size_t i = steps_; i-- > 0;) {
      a *= cotangent;
      cotangent *= dn;
      dn = (b_[i] + a) / (a_[i] + a);
      a = cotangent / a_[i];
    }
    const Real sn = std::copysign(1 / std::sqrt(1 + cotangent * cotangent), sine);
    return {sn, cotangent * sn, dn};
  }

  Real m_;
  Real m1_;
  std::array<Real, 32> a_{};
  std::array<Real, 32> b_{};
  std::size_t steps_ = 0;
  Real mean_ = 0;
  Real quarter_ = std::numeric_limits<Real>::infinity();
};

/// The integral of the third kind without its linear part: J(u) = int_0^u sn^2 / (1 + nu sn^2) du,
/// where int du / (1 + nu sn^2) = u - nu J.
///
///   J = sn^3/3 R_J(cn^2, dn^2, 1, cn^2 + (1 + nu) sn^2)   up to u = K,
///
/// For whole half periods the complete integral is used; at m1 = 0, where T = tanh u, J = (u -
/// int_0^T dT / (1 + nu T^2)) / (1 + nu).
class ThirdKind {
 public:
  /// The argument is 1 + nu > 0, because it may be small.
  ThirdKind(const EllipticFunctions& functions, Real one_plus_nu)
      : p_(one_plus_nu),
        separatrix_(functions.m1() == 0),
        complete_(separatrix_ ? 0 : carlson::rj(0, functions.m1(), 1, p_) / 3) {}

  [[nodiscard]] Real operator()(const Phase& phase) const {
    const auto [sn, cn, dn] = phase.rest;
    if (separatrix_) return (phase.u - of_tanh(sn)) / p_;
    const Real s2 = sn * sn;
    const Real c2 = cn * cn;
    const Real rest = s2 * sn / 3 * carlson::rj(c2, dn * dn, 1, c2 + p_ * s2);
    return 2 * phase.half_periods * complete_ + rest;
  }

 private:
  [[nodiscard]] Real of_tanh(Real T) const {
    const Real nu = p_ - 1;
    const Real root = std::sqrt(std::abs(nu));
    if (root == 0) return T;
    return (nu > 0 ? std::atan(root * T) : std::atanh(root * T)) / root;
  }

  Real p_;  ///< 1 + nu
  bool separatrix_;
  Real complete_;
};

}  // namespace kreisel::exact
