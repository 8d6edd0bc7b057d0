#pragma once

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <optional>

#include <dynamics/exact/double_double.hpp>
#include <dynamics/exact/elliptic.hpp>
#include <dynamics/exact/refuse.hpp>
#include <dynamics/exact/top_motion.hpp>

namespace kreisel::exact {

/// The free rigid body without torques,  Theta omega' + omega x Theta omega = 0,  in closed form
/// for all bodies, rates and times.
///
/// The principal axes 1, 2, 3 are numbered so that I2 is the middle moment. The angular momentum L
/// circles axis 3: the axis of the largest moment if D = L^2 - 2 E I2 >= 0, else of the smallest.
/// Then
///
///   omega = (a1 cn, a2 sn, a3 dn)(u),   u = lambda t + u0,
///   a1^2 = P3 / (I1 |I3 - I1|),         a2^2 = P3 / (I2 |I3 - I2|),   a3^2 = P1 / (I3 |I3 - I1|),
///   P1 = |L^2 - 2 E I1|,                P3 = |2 E I3 - L^2|,
///   lambda^2 = |I3 - I2| P1 / (I1 I2 I3),
///   m = |I2 - I1| P3 / (|I3 - I2| P1),  1 - m = |I3 - I1| |D| / (|I3 - I2| P1).
///
/// For Euler's angles with z along L, the precession is
///
///   psi = L/I1 t - (I3 - I1) L / (I1 I3 lambda) nu J(u),   nu = I3 (I2 - I1) / (I1 (I3 - I2)),
///
/// where J is that of ThirdKind. The spin follows from L on body axes: the shortest rotation takes
/// L on body axes to e_z, and precession and spin together are the remaining rotation about e_z.
/// Since L3 > 0, the chart never fails.
///
/// Source : Jacobi 1849; Whittaker, Analytical Dynamics, art. 69; Landau-Lifshitz, Mechanics, 37
/// Frame  : body axes are principal axes; attitudes rotate body components into inertial ones
/// Units  : kg m^2, rad/s, s
/// Error  : attitude <= 2u rad, rate <= 2u relative: the rounding of the result, for exact inputs,
///          near the separatrix (tested to 1e-15) and for symmetric bodies as elsewhere. In
///          addition 8 * 2^-64 of the angle L t/I_min: <= 5e-14 rad over 1e4 periods, 5e-13 rad
///          after 1e6 s at 2 rad/s      (tests/dynamics/exact/free_top.cpp)
/// Cost   : at() 1.3 us, to construct 4.8 us (g++ 12 -O2, EPYC)
/// Limits : near the separatrix the rounding of an input to double changes D by u L^2, and each
///          passage of the middle axis by u L^2 / (2 lambda |D|) seconds; no formula can undo this
class FreeTop {
 public:
  /// Moments on the three body axes, in any order; an attitude of any norm.
  ///
  /// Throws : InvalidInput for a moment that is not above 0 (the rotation of a needle about itself
  ///          is not determined), moments beyond the triangle inequality by 1e-12, rates that are
  ///          not finite, an attitude that is 0 or not finite
  FreeTop(const Vector3<double>& moments, const Vector3<double>& omega0,
          const Eigen::Quaterniond& attitude0)
      : omega0_(omega0), attitude0_(detail::unit(attitude0)) {
    detail::require_body(moments);
    detail::require_finite(omega0);
    const detail::RealVector omega = omega0.cast<Real>();
    const detail::RealVector L = omega.cwiseProduct(moments.cast<Real>());
    energy_ = L.dot(omega) / 2;
    momentum_ = L.norm();
    if (!steady(moments, omega0)) polhode_.emplace(moments, omega0);
  }

  /// Throws : InvalidInput for a time that is not finite
  [[nodiscard]] TopMotion at(double time) const {
    detail::require_finite("time", time);
    if (!polhode_) {
      const auto turn = detail::steady_turn(omega0_.cast<Real>(), time);
      return {(attitude0_ * turn).cast<double>(), omega0_};
    }
    const auto [turn, omega] = polhode_->at(time);
    return {(attitude0_ * turn).cast<double>(), omega.cast<double>()};
  }

  /// 4 K/lambda, after which omega repeats on body axes: infinite on the separatrix, 0 for a steady
  /// rotation.
  [[nodiscard]] double period() const {
    return polhode_ ? static_cast<double>(polhode_->period()) : 0.0;
  }

  /// E = omega . Theta omega / 2.
  [[nodiscard]] double energy() const { return static_cast<double>(energy_); }

  /// L = |Theta omega|.
  [[nodiscard]] double momentum() const { return static_cast<double>(momentum_); }

 private:
  /// True if  omega x Theta omega = 0,  computed without products that might underflow.
  [[nodiscard]] static bool steady(const Vector3<double>& moments, const Vector3<double>& omega) {
    const auto still = [&](int i, int j) {
      return moments[i] == moments[j] || omega[i] == 0 || omega[j] == 0;
    };
    return still(0, 1) && still(1, 2) && still(2, 0);
  }

  /// The body axes in the order 1, 2, 3, oriented so that omega1 and omega3 are not negative.
  class Axes {
   public:
    Axes(const Vector3<double>& moments, const Vector3<double>& omega0) {
      std::sort(body_.begin(), body_.end(), [&](int i, int j) { return moments[i] < moments[j]; });
      const DoubleDouble i1 = moments[body_[0]];
      const DoubleDouble i2 = moments[body_[1]];
      const DoubleDouble i3 = moments[body_[2]];
      const DoubleDouble w1 = omega0[body_[0]];
      const DoubleDouble w3 = omega0[body_[2]];
      const DoubleDouble D = i3 * (i3 - i2) * (w3 * w3) - i1 * (i2 - i1) * (w1 * w1);
      distance_ = std::abs(D.hi);
      if (D.hi < 0) {
        side_ = -1;
        std::swap(body_[0], body_[2]);
      }
      const int parity = (body_[1] - body_[0] + 3) % 3 == 1 ? 1 : -1;
      sign_[0] = omega0[body_[0]] < 0 ? -1 : 1;
      sign_[2] = omega0[body_[2]] < 0 ? -1 : 1;
      sign_[1] = parity * sign_[0] * sign_[2];
    }

    /// D|, exact to rounding at any distance from the separatrix.
    [[nodiscard]] Real distance() const { return distance_; }

    /// The sign of D.
    [[nodiscard]] Real side() const { return side_; }

    [[nodiscard]] detail::RealVector ordered(const Vector3<double>& v) const {
      return {v[body_[0]], v[body_[1]], v[body_[2]]};
    }

    [[nodiscard]] detail::RealVector from_body(const Vector3<double>& v) const {
      return {sign_[0] * Real(v[body_[0]]), sign_[1] * Real(v[body_[1]]),
              sign_[2] * Real(v[body_[2]])};
    }

    [[nodiscard]] detail::RealVector to_body(const detail::RealVector& v) const {
      detail::RealVector body;
      for (std::size_t i = 0; i < 3; ++i) body[body_[i]] = sign_[i] * v[static_cast<int>(i)];
      return body;
    }

   private:
    std::array<int, 3> body_{0, 1, 2};
    std::array<int, 3> sign_{};
    Real distance_;
    Real side_ = 1;
  };

  /// A motion in which L moves against the body.
  class Polhode {
   public:
    struct State {
      detail::RealQuaternion turn;  ///< since time 0
      detail::RealVector omega;
    };

    Polhode(const Vector3<double>& moments, const Vector3<double>& omega0)
        : axes_(moments, omega0) {
      const detail::RealVector theta = axes_.ordered(moments);
      const detail::RealVector w = axes_.from_body(omega0);
      const detail::RealVector w2 = w.cwiseAbs2();
      const Real i21 = std::abs(theta[1] - theta[0]);
      const Real i31 = std::abs(theta[2] - theta[0]);
      const Real i32 = std::abs(theta[2] - theta[1]);
      const Real p1 = theta[1] * i21 * w2[1] + theta[2] * i31 * w2[2];
      const Real p3 = theta[0] * i31 * w2[0] + theta[1] * i32 * w2[1];
      const Real L = theta.cwiseProduct(w).norm();

      functions_ = {i21 * p3 / (i32 * p1), i31 * axes_.distance() / (i32 * p1)};
      lambda_ = std::sqrt(i32 * p1 / (theta[0] * theta[1] * theta[2]));
      amplitude_ = {std::sqrt(p3 / (theta[0] * i31)),
                    axes_.side() * std::sqrt(p3 / (theta[1] * i32)),
                    std::sqrt(p1 / (theta[2] * i31))};
      direction_ = amplitude_.cwiseProduct(theta) / L;
      u0_ = EllipticFunctions::argument(
          {w[1] / amplitude_[1], w[0] / amplitude_[0], w[2] / amplitude_[2]});

      const Real nu = theta[2] * i21 / (theta[0] * i32);
      third_kind_ = {functions_, 1 + nu};
      steady_precession_ = L / theta[0];
      unsteady_precession_ = axes_.side() * i31 * L / (theta[0] * theta[2] * lambda_) * nu;
      start_ = attitude(functions_.phase(u0_), 0).conjugate();
    }

    [[nodiscard]] State at(Real time) const {
      const Phase phase = functions_.phase(lambda_ * time + u0_);
      const auto [sn, cn, dn] = phase.at;
      const detail::RealQuaternion turn = start_ * attitude(phase, time);
      const detail::RealVector v = axes_.to_body(turn.vec());
      return {{turn.w(), v.x(), v.y(), v.z()},
              axes_.to_body(amplitude_.cwiseProduct(detail::RealVector(cn, sn, dn)))};
    }

    [[nodiscard]] Real period() const { return 4 * functions_.quarter() / lambda_; }

   private:
    /// From the axes 1, 2, 3 to non-rotating axes whose z is along L.
    [[nodiscard]] detail::RealQuaternion attitude(const Phase& phase, Real time) const {
      const auto [sn, cn, dn] = phase.at;
      const detail::RealVector n = direction_.cwiseProduct(detail::RealVector(cn, sn, dn));
      const Real precession = steady_precession_ * time - unsteady_precession_ * third_kind_(phase);
      // tan of this azimuth is L2/L1. It is continued through the half periods, without a cut at
      // +-pi.
      const Real azimuth =
          std::atan2(std::abs(direction_[1]) * phase.rest.sn, direction_[0] * phase.rest.cn) +
          std::numbers::pi_v<Real> * phase.half_periods;
      const detail::RealQuaternion to_z(1 + n[2], n[1], -n[0], 0);
      return detail::about_z(precession - axes_.side() * azimuth) * to_z.normalized();
    }

    Axes axes_;
    EllipticFunctions functions_;
    ThirdKind third_kind_{functions_, 1};
    Real lambda_;
    Real u0_;
    detail::RealVector amplitude_;  ///< a1, a2, a3
    detail::RealVector direction_;  ///< L/|L| where the functions are 1
    Real steady_precession_;
    Real unsteady_precession_;
    detail::RealQuaternion start_;  ///< the inverse of the attitude at time 0
  };

  Vector3<double> omega0_;
  detail::RealQuaternion attitude0_;
  Real energy_;
  Real momentum_;
  std::optional<Polhode> polhode_;  ///< none for a steady rotation
};

}  // namespace kreisel::exact
