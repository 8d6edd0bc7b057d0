#pragma once

#include <array>
#include <cmath>
#include <complex>
#include <cstddef>

#include <support/quadrature.hpp>

/// Andrews' squeezing mechanism, reduced to the angle of its crank.
///
/// Seven bodies in the plane form three loops. A crank with a constant torque turns at O, and moves
/// the point E by a rod. E is held to the fixed point B by a triangle, and to the fixed point A by two
/// pairs of bodies. Each pair of bodies is a triangle with two known sides, so that all angles follow
/// from the crank's angle in closed form. The energy gives the time as an integral:
///
///   M(beta) beta'^2/2 + V(beta) = V_0 + N (beta - beta_0),   t = integral of d(beta)/beta'
///
/// Source : E. Hairer, G. Wanner, Solving Ordinary Differential Equations II, section VII.7
/// Units  : metre, kg, s, rad
namespace kreisel::test::squeezer {

/// A vector in the plane.
template <class S>
using Plane = std::complex<S>;

/// The published data. Points of a body are on its own axes.
template <class S>
struct Data {
  static constexpr std::size_t bodies = 7;
  /// The bodies are the crank K1, the rod K2, the triangle K3 and the bars K4 to K7.
  std::array<S, bodies> mass{S(4325e-5L), S(365e-5L), S(2373e-5L), S(706e-5L),
                             S(705e-4L),  S(706e-5L), S(5498e-5L)};
  std::array<S, bodies> inertia{S(2194e-9L), S(4410e-10L), S(5255e-9L), S(5667e-10L),
                                S(1169e-8L), S(5667e-10L), S(1912e-8L)};
  Plane<S> A{S(-6934e-5L), S(-227e-5L)}, B{S(-3635e-5L), S(3273e-5L)}, C{S(14e-3L), S(72e-3L)};
  S stiffness = S(4530), length = S(7785e-5L), torque = S(33e-3L);
  S crank = S(7e-3L), rod = S(28e-3L), triangle = S(35e-3L);
  S K4 = S(20e-3L), K5 = S(40e-3L), K6 = S(20e-3L), K7 = S(40e-3L);  ///< lengths
  /// The centres of mass, from the joint to the guide or to the body before.
  std::array<Plane<S>, bodies> centre{{{S(92e-5L), 0},
                                       {S(-115e-4L), 0},
                                       {S(1043e-5L), S(-1874e-5L)},
                                       {0, S(-579e-5L)},
                                       {S(2308e-5L), S(916e-5L)},
                                       {S(579e-5L), 0},
                                       {S(-449e-5L), S(-1228e-5L)}}};
  Plane<S> spring_on_K3{S(20e-3L), S(-18e-3L)};
};

inline constexpr long double beta_0 = -0.0617138900142764496358948458001L;

/// The angles beta, Theta, gamma, Phi, delta, Omega, epsilon of the book.
template <class S>
using Angles = std::array<S, 7>;

/// The motion as a function of the crank's angle.
class Reduced {
  using S = long double;
  using V = Plane<S>;

 public:
  struct Motion {
    S time = 0;
    Angles<S> angles{}, rates{};
  };

  /// The state at a time after the start from rest.
  [[nodiscard]] Motion at(S time) const {
    // beta = beta_0 + s^2, because beta' is 0 at the start. At 0.03 s the angle is the same up to
    // 4e-17 of it for panels from 0.02 to 0.0006.
    const S panel = 0.02L;
    S s = 0, passed = 0;
    for (S next; (next = passed + duration(s, s + panel)) < time; s += panel) passed = next;
    S end = s;
    for (int k = 0; k < 8; ++k) end -= (passed + duration(s, end) - time) * slope(end);
    return {time, angles(end), rates(end)};
  }

 private:
  /// A body: its turn, the place of its centre, and both per unit of beta'.
  struct Body {
    S angle, turn;
    V place, rate;
  };

  /// Two bars a e^(ix) + b e^(iy) that reach from one point to another. `side` is that of the first.
  struct Pair {
    S x, y, dx, dy;
    Pair(V reach, V rate, S a, S b, int side) {
      const S r = std::abs(reach);
      x = std::arg(reach) + S(side) * std::acos((r * r + a * a - b * b) / (2 * a * r));
      y = std::arg(reach - std::polar(a, x));
      // rate = i a e^(ix) x' + i b e^(iy) y', turned by -y and -x.
      dx = (rate * std::polar(S(1), -y)).real() / (-a * std::sin(x - y));
      dy = (rate * std::polar(S(1), -x)).real() / (-b * std::sin(y - x));
    }
  };

  struct Position {
    Angles<S> angles, rates;
    std::array<Body, 7> bodies;
    S stretch, stretch_rate;
  };

  static constexpr V i{0, 1};

  [[nodiscard]] Position position(S beta) const {
    const S quarter = std::acos(S(-1)) / 2;
    const V tip = std::polar(d.crank, beta), tip_rate = i * tip;
    const Pair rods(tip - d.B, tip_rate, d.rod, d.triangle, 1);
    const S gamma = rods.y + quarter;
    const V E = tip - std::polar(d.rod, rods.x);
    const V E_rate = tip_rate - i * rods.dx * std::polar(d.rod, rods.x);
    const Pair upper(E - d.A, E_rate, d.K5, d.K4, 1);
    const Pair lower(E - d.A, E_rate, d.K7, d.K6, -1);
    const S K4 = upper.y + quarter, K7 = lower.x + quarter;
    Position p;
    p.angles = {beta, rods.x - beta, gamma, K4 - upper.x, upper.x, lower.y - K7, K7};
    p.rates = {1,        rods.dx - 1,         rods.dy, upper.dy - upper.dx,
               upper.dx, lower.dy - lower.dx, lower.dx};
    const auto put = [&](std::size_t k, V joint, V joint_rate, S angle, S turn) {
      const V arm = d.centre[k] * std::polar(S(1), angle);
      p.bodies[k] = {angle, turn, joint + arm, joint_rate + i * turn * arm};
    };
    const V elbow = std::polar(d.K5, upper.x), other = std::polar(d.K7, lower.x);
    put(0, 0, 0, beta, 1);
    put(1, tip, tip_rate, rods.x, rods.dx);
    put(2, d.B, 0, gamma, rods.dy);
    put(3, d.A + elbow, i * upper.dx * elbow, K4, upper.dy);
    put(4, d.A, 0, upper.x, upper.dx);
    put(5, d.A + other, i * lower.dx * other, lower.y, lower.dy);
    put(6, d.A, 0, K7, lower.dx);
    const V arm = d.spring_on_K3 * std::polar(S(1), gamma);
    const V spring = d.B + arm - d.C;
    p.stretch = std::abs(spring) - d.length;
    p.stretch_rate = (std::conj(spring) * i * rods.dy * arm).real() / std::abs(spring);
    return p;
  }

  /// beta' / s.
  [[nodiscard]] S speed(const Position& p, S s) const {
    S mass = 0;
    for (std::size_t k = 0; k < 7; ++k) {
      mass += d.mass[k] * std::norm(p.bodies[k].rate) +
              d.inertia[k] * p.bodies[k].turn * p.bodies[k].turn;
    }
    return std::sqrt(2 * (d.torque + pull(p, s)) / mass);
  }

  /// (V_0 - V)/s^2. The difference has no digits near the start, the mean of -dV/d(beta) has.
  [[nodiscard]] S pull(const Position& p, S s) const {
    const S k = d.stiffness;
    if (s > 0.25L)
      return k * (start_.stretch - p.stretch) * (start_.stretch + p.stretch) / (2 * s * s);
    return integral<S>(0, 1, [&](S part) {
      const Position between = position(beta_0 + part * s * s);
      return -k * between.stretch * between.stretch_rate;
    });
  }

  /// ds/dt = beta'/(2 s).
  [[nodiscard]] S slope(S s) const { return speed(position(beta_0 + s * s), s) / 2; }

  /// The time from s = a to b.
  [[nodiscard]] S duration(S a, S b) const {
    return integral<S>(a, b, [this](S s) { return 1 / slope(s); });
  }

  [[nodiscard]] Angles<S> angles(S s) const { return position(beta_0 + s * s).angles; }
  [[nodiscard]] Angles<S> rates(S s) const {
    const Position p = position(beta_0 + s * s);
    Angles<S> rates = p.rates;
    for (S& rate : rates) rate *= s * speed(p, s);
    return rates;
  }

  Data<S> d;
  Position start_ = position(beta_0);
};

}  // namespace kreisel::test::squeezer
