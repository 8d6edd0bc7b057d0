#pragma once

#include <gsl/gsl_errno.h>
#include <gsl/gsl_sf_ellint.h>
#include <gsl/gsl_sf_elljac.h>

#include <cmath>
#include <numbers>
#include <string>

#include <dynamics/exact/refuse.hpp>
#include <dynamics/gsl/errors.hpp>
#include <motor/error.hpp>

namespace kreisel::exact {

namespace detail {

/// Throws : ComputationFailed with GSL's message
inline void require_success(int status, const char* what) {
  if (status == GSL_SUCCESS) return;
  throw ComputationFailed(std::string(what) + ": " + gsl_strerror(status));
}

}  // namespace detail

/// The plain pendulum  phi.. + omega^2 sin(phi) = 0  released at rest at phi = amplitude.
///
/// (23) with F = H = K = 0 and omega^2 = E/Theta_C.
///
/// Units  : rad, rad/s
class PlainPendulum {
 public:
  struct State {
    double angle;
    double rate;
  };

  /// Throws : InvalidInput unless 0 < |amplitude| < pi and omega > 0
  PlainPendulum(double amplitude, double omega)
      : omega_(omega), k_(std::sin(amplitude / 2)), k_complement_(std::cos(amplitude / 2)) {
    if (!(std::abs(amplitude) > 0 && std::abs(amplitude) < std::numbers::pi)) {
      detail::refuse("amplitude", amplitude, "rad: 0 < |amplitude| < pi is required");
    }
    if (!(omega > 0 && std::isfinite(omega))) {
      detail::refuse("omega", omega, "rad/s must be a finite number above 0");
    }
    // K(k) = R_F(0, 1 - k^2, 1), with cos^2 in place of 1 - sin^2: this form is accurate near pi.
    const kreisel::detail::GslErrorsReturned guard;
    gsl_sf_result quarter;
    detail::require_success(
        gsl_sf_ellint_RF_e(0, k_complement_ * k_complement_, 1, GSL_PREC_DOUBLE, &quarter),
        "period of the plain pendulum");
    quarter_ = quarter.val;
  }

  /// T = 4 K(k)/omega,  k = sin(amplitude/2).
  ///
  /// Error : <= 4u relative to amplitude 3; then the amplitude's own rounding counts, u/(pi -
  ///         amplitude)
  [[nodiscard]] double period() const { return 4 * quarter_ / omega_; }

  /// sin(phi/2) = k cn/dn,  cos(phi/2) = k'/dn,  phi. = -2 omega k k' sn/dn  of omega t and k.
  ///
  /// Error : of angle and rate/omega, within one period: <= 16u (amplitude to 2), 64u (to 3), GSL's
  ///         own; later 2u |omega t| more              (tests/dynamics/gsl/pendulum.cpp)
  /// Throws : InvalidInput for a time that is not finite
  [[nodiscard]] State at(double time) const {
    if (!std::isfinite(time)) detail::refuse("time", time, "s must be finite");
    const kreisel::detail::GslErrorsReturned guard;
    double sn;
    double cn;
    double dn;
    detail::require_success(
        gsl_sf_elljac_e(std::remainder(omega_ * time, 4 * quarter_), k_ * k_, &sn, &cn, &dn),
        "motion of the plain pendulum");
    return {2 * std::atan2(k_ * cn, k_complement_), -2 * omega_ * k_ * k_complement_ * sn / dn};
  }

 private:
  double omega_;
  double k_;
  double k_complement_;
  double quarter_ = 0;  ///< K(k)
};

}  // namespace kreisel::exact
