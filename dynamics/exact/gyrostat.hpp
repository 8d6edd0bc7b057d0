#pragma once

#include <Eigen/Geometry>

#include <cmath>
#include <numbers>

#include <dynamics/exact/elliptic.hpp>
#include <dynamics/exact/refuse.hpp>
#include <dynamics/exact/top_motion.hpp>

namespace kreisel::exact {

/// The symmetric gyrostat free of torques: a body of moments A, A, C with a rotor on its axis of
/// symmetry that is kept at constant speed against it,
///
///   Theta omega' + omega x (Theta omega + h e_z) = 0,   Theta including the rotor.
///
/// omega = L/A + s e_z with s = omega3 - L3/A, L3 = C omega3 + h: the body turns steadily about L,
/// and steadily about its axis against that; seen from the body omega circles the axis with -s. The
/// rotor acts like a change of the axial moment, also one to 0 or below, which no body has.
///
/// Source : Wangerin 1889, Volterra 1899; Wittenburg, Dynamics of Multibody Systems, sect. 4.6
/// Frame  : body z is the axis of symmetry and of the rotor; attitudes turn body into inertial
/// Units  : kg m^2, N m s, rad/s, s
/// Error  : attitude <= 2u rad, rate <= 2u relative, besides 4 * 2^-64 of the angle turned through
///                                                         (tests/dynamics/exact/gyrostat.cpp)
class SymmetricGyrostat {
 public:
  /// rotor is h, the rotor's angular momentum against the body.
  ///
  /// Throws : InvalidInput for moments that no body has (see FreeTop), an attitude that is 0 and
  ///          anything not finite
  SymmetricGyrostat(double A, double C, double rotor, const Vector3<double>& omega0,
                    const Eigen::Quaterniond& attitude0)
      : omega0_(omega0), attitude0_(detail::unit(attitude0)) {
    detail::require_body({A, A, C});
    detail::require_finite("rotor", rotor);
    detail::require_finite(omega0);
    // The transverse parts of L/A and of omega are the same; s by a difference of moments, because
    // that of the rates would cancel.
    against_ = ((Real(A) - Real(C)) * omega0.z() - rotor) / A;
    about_momentum_ = omega0.cast<Real>();
    about_momentum_.z() -= against_;
  }

  /// Throws : InvalidInput for a time that is not finite
  [[nodiscard]] TopMotion at(double time) const {
    detail::require_finite("time", time);
    const Real angle = against_ * time;
    const Real s = std::sin(angle);
    const Real c = std::cos(angle);
    const Real x = omega0_.x();
    const Real y = omega0_.y();
    const detail::RealVector omega(c * x + s * y, c * y - s * x, omega0_.z());
    const auto turn = detail::steady_turn(about_momentum_, time) * detail::about_z(angle);
    return {(attitude0_ * turn).cast<double>(), omega.cast<double>()};
  }

  /// 2 pi/|s|, after which omega is the same on body axes again: infinite where the rotor makes the
  /// body one without a preferred axis.
  [[nodiscard]] double period() const {
    return static_cast<double>(2 * std::numbers::pi_v<Real> / std::abs(against_));
  }

 private:
  Vector3<double> omega0_;
  detail::RealQuaternion attitude0_;
  Real against_;                       ///< s, about the axis against the turn about L
  detail::RealVector about_momentum_;  ///< L/A on body axes at time 0
};

}  // namespace kreisel::exact
