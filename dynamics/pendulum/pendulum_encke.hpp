#pragma once

#include <Eigen/Core>

#include <array>
#include <cmath>
#include <utility>

#include <motor/error.hpp>

namespace kreisel {

/// The deviation d of a plane pendulum's swing from the undisturbed swing a under a small
/// disturbance (Encke's method). Both are integrated together:
///
///   a'' = -k sin a,   d'' = -2 k cos(a + d/2) sin(d/2) + disturbance(t, a + d, a' + d')
///
/// The earth's rotation moves a swing of 1 rad by 1e-9 rad in half a minute. The difference of two
/// runs would have six digits of that; d has twelve. Each component is measured by its own size:
/// set Accuracy::absolute_scale or SolveOptions::absolute_scale = 0.
///
/// D      : callable (S t, S angle, S rate) -> S, an angular acceleration. Name S as its result: an
///          expression of dual numbers returned as auto refers to temporaries
/// Source : J. F. Encke, Berliner Astronomisches Jahrbuch fuer 1857; the disturbance of the
///          rotating earth: paper 002 (23) with one angle
/// Units  : 1/s^2 (k = m g l/Theta), radian, s
/// Error  : of d over 30 s <= 1e-12 relative    (tests/dynamics/pendulum/pendulum_encke.cpp)
/// Throws : InvalidInput if k is not a finite number above 0
template <class D>
class EnckePendulum {
 public:
  template <class S>
  using Components = Eigen::Matrix<S, 4, 1>;
  using Vector = Components<double>;

  struct State {
    double angle = 0;      ///< a
    double rate = 0;       ///< a'
    double deviation = 0;  ///< d
    double deviation_rate = 0;
  };

  EnckePendulum(double k, D disturbance) : k_(k), disturbance_(std::move(disturbance)) {
    if (!(k > 0 && std::isfinite(k))) {
      throw InvalidInput("Encke pendulum: k = m g l/Theta must be a finite number above 0");
    }
  }

  /// The vector field on  y = (a, a', d, d').
  template <class S>
  [[nodiscard]] Components<S> rates(const S& t, const Components<S>& y) const {
    using std::cos;
    using std::sin;
    const S &a = y[0], &da = y[1], &d = y[2], &dd = y[3];
    const S pull = -2 * k_ * cos(S(a + d / 2)) * sin(S(d / 2));
    return {da, S(-k_ * sin(a)), dd, S(pull + disturbance_(t, S(a + d), S(da + dd)))};
  }

  /// For integrators: components that share unit and size.
  static constexpr std::array<int, 4> blocks = {1, 1, 1, 1};

  [[nodiscard]] static Vector to_vector(const State& s) {
    return {s.angle, s.rate, s.deviation, s.deviation_rate};
  }
  [[nodiscard]] static State from_vector(const Vector& y) { return {y[0], y[1], y[2], y[3]}; }

 private:
  double k_;
  D disturbance_;
};

}  // namespace kreisel
