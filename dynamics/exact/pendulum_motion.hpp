#pragma once

#include <cmath>
#include <numbers>

#include <dynamics/exact/elliptic.hpp>
#include <dynamics/exact/refuse.hpp>

namespace kreisel::exact {

/// The plane pendulum  phi.. + k sin(phi) = 0  from any angle and rate. It swings, turns over, or
/// on the separatrix ends upright.
///
/// With s = sin(phi/2), c = cos(phi/2), h = phi./(2 sqrt(k)) the energy is  e = s^2 + h^2. Its
/// deficit at the upper rest point is  1 - e = (c - h)(c + h),  free of cancellation near that
/// point:
///
///   e <= 1, it swings:     s = sqrt(e) sn u,  c = dn u,  h = sqrt(e) cn u,  m = e,
///                          u' = sqrt(k)
///   e > 1, it turns over:  s = sn u,          c = cn u,  h = sqrt(e) dn u,  m = 1/e,
///                          u' = sqrt(k e)
///
/// All are mirrored for phi. < 0 at the start.
///
/// Source : Whittaker, Analytical Dynamics, art. 44
/// Units  : 1/s^2, rad, rad/s, s
/// Error  : <= 1.5u of |angle| + 0.125 and of |rate| + 0.125 for k = 1, 40 s and any start, also
///          near the upper rest point and turning over it        (tests/dynamics/gsl/pendulum.cpp)
/// Limits : std::numbers::pi is 1.2e-16 below the top, so a pendulum released there falls
class PendulumMotion {
 public:
  struct State {
    double angle;  ///< whole turns counted
    double rate;
  };

  /// Throws : InvalidInput unless k > 0 and all numbers are finite
  PendulumMotion(double k, double phi0, double rate0) : root_k_(sqrt(Real(k))) {
    detail::require_positive("k", k);
    detail::require_finite("phi0", phi0);
    detail::require_finite("rate0", rate0);
    turns_ = static_cast<double>(round(phi0 / scaled(pi, 2)));
    const double sign = std::fmod(turns_, 2) == 0 ? 1 : -1;
    const auto [sine, cosine] = kreisel::detail::sine_cosine(phi0 / 2);
    const Real c = sign * cosine;
    const Real h = std::abs(rate0) / scaled(root_k_, 2);
    if (rate0 < 0) direction_ = -1;
    const Real s = direction_ * sign * sine;
    // Quotients of numbers below 1e-291 would lose digits, those of subnormal ones everything.
    const double up = std::max(abs(s), h) < 0x1p-900 ? 0x1p900 : 1;
    const Real s_up = scaled(s, up);
    const Real h_up = scaled(h, up);
    const Real root_up = hypot(s_up, h_up);
    root_e_ = scaled(root_up, 1 / up);
    const Real e = root_e_ * root_e_;  // 0 for swings whose nonlinearity is 0 to rounding
    const Real lacking = (c - h) * (c + h);
    if (lacking < 0) {
      turns_over_ = true;
      functions_ = {1 / e, -lacking / e};
      u0_ = EllipticFunctions::argument({s, c, h / root_e_});
    } else if (root_e_ > 0) {
      functions_ = {e, lacking};
      u0_ = EllipticFunctions::argument({s_up / root_up, h_up / root_up, c});
    }
  }

  /// Throws : InvalidInput for a time that is not finite
  [[nodiscard]] State at(double time) const {
    detail::require_finite("time", time);
    const Phase phase = functions_.phase(speed() * time + u0_);
    const Real half_angle = turns_over_
                                ? pi * phase.half_periods + atan2(phase.rest.sn, phase.rest.cn)
                                : atan2(root_e_ * phase.at.sn, phase.at.dn);
    const Real h = root_e_ * (turns_over_ ? phase.at.dn : phase.at.cn);
    return {static_cast<double>(scaled(pi * turns_ + direction_ * half_angle, 2)),
            static_cast<double>(2.0 * direction_ * root_k_ * h)};
  }

  /// The period of a swing, or of one turn over the top; infinite on the separatrix.
  [[nodiscard]] double period() const {
    return static_cast<double>(scaled(functions_.quarter(), turns_over_ ? 2 : 4) / speed());
  }

 private:
  static constexpr Real pi = std::numbers::pi_v<Real>;

  /// u'
  [[nodiscard]] Real speed() const { return turns_over_ ? root_k_ * root_e_ : root_k_; }

  Real root_k_;
  Real root_e_;
  double turns_;       ///< whole ones of phi0
  int direction_ = 1;  ///< of the start; the formulas are for rate0 >= 0
  bool turns_over_ = false;
  EllipticFunctions functions_;
  Real u0_ = 0;
};

}  // namespace kreisel::exact
