#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <initializer_list>
#include <limits>
#include <numbers>

#include <motor/double_double_functions.hpp>

namespace kreisel::exact {

/// The number type of exact motions: over 1e4 periods double would leave an error of 1e-11 of a
/// phase.
using Real = DoubleDouble;

/// Carlson's integrals. Each duplication makes their arguments equal but for a fourth of their
/// spread. After the last, below 2^-5, a series remains that differs from 1 by so little that the
/// digits of double suffice for it.
///
/// Source : B. C. Carlson, Computing elliptic integrals by duplication (1979), Numerical computation
///          of real or complex elliptic integrals (1995); the series: NIST Handbook of Mathematical
///          Functions, 19.19
/// Error  : 2^-63, relative (tests/dynamics/exact/elliptic.cpp)
namespace carlson {

namespace detail {

/// True if the series may follow. Compared by !(>=), so that NaN ends the duplication too.
[[nodiscard]] inline bool near(std::initializer_list<double> offs) {
  double greatest = 0;
  for (const double off : offs) greatest = std::max(greatest, std::abs(off));
  return !(greatest >= 0x1p-5);
}

/// 1 + sum over n > 1 of  (a)_n/(a + 1)_n T_n,  where T_n are the coefficients of D(t)^-1/2,
/// D = 1 + e2 t^2 - e3 t^3 + e4 t^4 - e5 t^5,  after J. C. P. Miller:
/// n T_n = sum over k of (k/2 - n) d_k T_(n-k).
[[nodiscard]] inline Real series(double a, double e2, double e3, double e4 = 0, double e5 = 0) {
  constexpr std::size_t order = 12;
  std::array<double, order + 4> T{0, 0, 0, 0, 1};  // from T_-4 on
  double sum = 0;
#pragma GCC unroll 12
  for (std::size_t i = 2; i < order; ++i) {
    const auto n = static_cast<double>(i);
    T[i + 4] = (1.5 / n - 1) * -e3 * T[i + 1] + (2 / n - 1) * e4 * T[i] +
               (2.5 / n - 1) * -e5 * T[i - 1] + (1 / n - 1) * e2 * T[i + 2];
    sum += a / (a + n) * T[i + 4];
  }
  return 1 + Real(sum);
}

/// (x + lambda)/4
[[nodiscard]] inline Real next(const Real& x, const Real& lambda) {
  return scaled(x + lambda, 0.25);
}

inline const Real root_of_3 = sqrt(Real(3));

}  // namespace detail

/// R_F(x, y, z) = 1/2 int_0^inf dt / sqrt((t + x)(t + y)(t + z)),  at most one of them 0.
[[nodiscard]] inline Real rf(Real x, Real y, Real z) {
  while (true) {
    const Real sum = x + y + z;
    const double X = (sum - (scaled(x, 2) + x)).hi / sum.hi;  // 1 - x/mean
    const double Y = (sum - (scaled(y, 2) + y)).hi / sum.hi;
    const double Z = -X - Y;
    if (detail::near({X, Y, Z})) {
      return detail::series(0.5, X * Y - Z * Z, X * Y * Z) * detail::root_of_3 / sqrt(sum);
    }
    const Real sx = sqrt(x);
    const Real sy = sqrt(y);
    const Real sz = sqrt(z);
    const Real lambda = sx * (sy + sz) + sy * sz;
    x = detail::next(x, lambda);
    y = detail::next(y, lambda);
    z = detail::next(z, lambda);
  }
}

/// R_C(1, 1 + e) = R_F(1, 1 + e, 1 + e),  e > -1.
[[nodiscard]] inline Real rc_beside_1(const Real& e) {
  Real x = 1;
  Real y = 1 + e;
  while (true) {
    const Real sum = x + scaled(y, 2);
    const double Y = (x - y).hi / sum.hi;  // 1 - y/mean
    if (detail::near({2 * Y})) {
      return detail::series(0.5, -3 * Y * Y, -2 * Y * Y * Y) * detail::root_of_3 / sqrt(sum);
    }
    const Real lambda = scaled(sqrt(x * y), 2) + y;
    x = detail::next(x, lambda);
    y = detail::next(y, lambda);
  }
}

/// R_J(x, y, z, p) = 3/2 int_0^inf dt / ((t + p) sqrt((t + x)(t + y)(t + z))),  p > 0.
///
/// Each duplication adds  3 R_C(alpha^2, beta^2) = 6/d R_C(1, 1 + e),  d = alpha + beta,
/// e = (beta - alpha)/d. All terms of alpha and beta are positive: the integral keeps its digits
/// for p far below x, y and z.
[[nodiscard]] inline Real rj(Real x, Real y, Real z, Real p) {
  Real terms = 0;
  double quarter = 1;
  while (true) {
    const Real sum = x + y + z + scaled(p, 2);
    const auto off = [&](const Real& of) { return (sum - (scaled(of, 4) + of)).hi / sum.hi; };
    const double X = off(x);
    const double Y = off(y);
    const double Z = off(z);
    const double P = (-X - Y - Z) / 2;
    if (detail::near({X, Y, Z, P})) {
      const double xyz = X * Y * Z;
      const double e2 = X * Y + X * Z + Y * Z - 3 * P * P;
      const double e3 = xyz + 2 * e2 * P + 4 * P * P * P;
      const double e4 = (2 * xyz + e2 * P + 3 * P * P * P) * P;
      const double e5 = xyz * P * P;
      const Real mean = sum / 5;
      return scaled(detail::series(1.5, e2, e3, e4, e5), quarter) / (mean * sqrt(mean)) + 6 * terms;
    }
    const Real sx = sqrt(x);
    const Real sy = sqrt(y);
    const Real sz = sqrt(z);
    const Real yz = sy * sz;
    const Real lambda = sx * (sy + sz) + yz;
    const Real alpha = p * (sx + sy + sz) + sx * yz;
    const Real beta = sqrt(p) * (p + lambda);
    const Real d = alpha + beta;
    const Real inverse = 1 / d;
    terms += scaled(rc_beside_1((beta - alpha) * inverse) * inverse, quarter);
    quarter /= 4;
    x = detail::next(x, lambda);
    y = detail::next(y, lambda);
    z = detail::next(z, lambda);
    p = detail::next(p, lambda);
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
  double half_periods;  ///< n, a whole number
  Jacobi rest;          ///< of the rest, so that cn >= 0
  Jacobi at;            ///< of u itself
};

/// Jacobi's elliptic functions of parameter m = k^2 and its complement m1 = 1 - m, 0 <= m <= 1.
///
/// The caller forms m and m1 each without cancellation: near m = 1 everything depends on m1, and 1
/// - m has no correct digit of it. At m1 = 0 the functions are tanh and sech and K is infinite.
///
/// Source : Gauss' transformation (descending Landen), in the cotangent after R. Bulirsch (1965),
///          so that cn and dn keep their digits where they are small
/// Error  : the effect of an error of the argument of 2^-75 of |u| + K
class EllipticFunctions {
 public:
  EllipticFunctions() : EllipticFunctions(0, 1) {}
  EllipticFunctions(Real m, Real m1) : m_(m), m1_(m1) {
    if (m1 == 0) return;
    Real a = 1;
    Real b = sqrt(m1);
    while (true) {
      steps_[count_] = {a, 1 / a, a - b};
      ++count_;
      mean_ = scaled(a + b, 0.5);
      // The next two would differ by the square of this, relatively: below rounding.
      const double spread = (a - b).hi / (4 * a.hi);
      if (spread * spread <= 0x1p-76 || count_ == steps_.size()) break;
      b = sqrt(a * b);
      a = mean_;
    }
    quarter_ = std::numbers::pi_v<Real> / scaled(mean_, 2);
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
    const double n = std::round(u.hi / (2 * quarter_.hi));
    const Jacobi j = within_quarter(u - scaled(quarter_, 2) * n);
    const bool odd = std::fmod(n, 2) != 0;
    return {u, n, j, odd ? Jacobi{-j.sn, -j.cn, j.dn} : j};
  }

 private:
  /// The functions for |u| <= K.
  [[nodiscard]] Jacobi within_quarter(Real u) const {
    if (m1_ == 0) return {tanh(u), 1 / cosh(u), 1 / cosh(u)};
    const auto [sine, cosine] = detail::sine_cosine(mean_ * u);
    if (sine == 0) return {0, 1, 1};
    Real a = cosine / sine;
    Real cotangent = mean_ * a;
    Real dn = 1;
    for (std::size_t i = count_; i-- > 0;) {
      const Step& step = steps_[i];
      a *= cotangent;
      cotangent *= dn;
      const Real sum = step.a + a;
      // A small difference from 1 needs only the digits of double.
      dn = 1 - (step.gap.hi < 0x1p-20 ? Real(step.gap.hi / sum.hi) : step.gap / sum);
      a = cotangent * step.inverse;
    }
    const Real sn = copysign(1 / sqrt(1 + cotangent * cotangent), sine);
    return {sn, cotangent * sn, dn};
  }

  Real m_;
  Real m1_;
  struct Step {
    Real a, inverse;  ///< the arithmetic mean and 1/a
    Real gap;         ///< its difference from the geometric mean
  };
  std::array<Step, 32> steps_{};
  std::size_t count_ = 0;
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
    const Real root = sqrt(abs(nu));
    if (root == 0) return T;
    return (nu > 0 ? atan(root * T) : atanh(root * T)) / root;
  }

  Real p_;  ///< 1 + nu
  bool separatrix_;
  Real complete_;
};

}  // namespace kreisel::exact
