#pragma once

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <optional>

#include <dynamics/exact/elliptic.hpp>
#include <dynamics/exact/refuse.hpp>
#include <dynamics/exact/top_motion.hpp>
#include <motor/double_double_functions.hpp>

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
///          addition 2^-67 of the angle L t/I_min (tests/dynamics/exact/free_top.cpp)
/// Cost   : at() 1.4 us, to construct 4.3 us (g++ 12 -O3, EPYC)
/// Limits : a component of the rate below 1e-144 of the greatest counts as 0;
///          near the separatrix the rounding of an input to double changes D by u L^2, and each
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
    unit_ = detail::power_of_2(omega0.cwiseAbs().maxCoeff());
    const Vector3<double> rate = detail::in_unit(omega0, unit_);
    const double moment = detail::power_of_2(moments.maxCoeff());
    const Vector3<double> I = moments / moment;
    const detail::RealVector omega = rate.cast<Real>();
    const detail::RealVector L = omega.cwiseProduct(I.cast<Real>());
    energy_ = static_cast<double>(scaled(L.dot(omega), 0.5)) * unit_ * (moment * unit_);
    momentum_ = static_cast<double>(L.norm()) * moment * unit_;
    if (!steady(I, rate)) polhode_.emplace(I, rate, attitude0_);
  }

  /// Throws : InvalidInput for a time that is not finite
  [[nodiscard]] TopMotion at(double time) const {
    detail::require_finite("time", time);
    if (!polhode_) {
      const auto turn = detail::steady_turn(omega0_.cast<Real>(), time);
      return {(attitude0_ * turn).cast<double>(), omega0_};
    }
    TopMotion motion = polhode_->at(time * unit_);
    motion.angular_velocity *= unit_;
    return motion;
  }

  /// 4 K/lambda, after which omega repeats on body axes: infinite on the separatrix, 0 for a steady
  /// rotation.
  [[nodiscard]] double period() const {
    return polhode_ ? static_cast<double>(polhode_->period()) / unit_ : 0.0;
  }

  /// E = omega . Theta omega / 2.
  [[nodiscard]] double energy() const { return energy_; }

  /// L = |Theta omega|.
  [[nodiscard]] double momentum() const { return momentum_; }

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
      const Real i1 = moments[body_[0]];
      const Real i2 = moments[body_[1]];
      const Real i3 = moments[body_[2]];
      const Real w1 = omega0[body_[0]];
      const Real w3 = omega0[body_[2]];
      const Real D = i3 * (i3 - i2) * (w3 * w3) - i1 * (i2 - i1) * (w1 * w1);
      distance_ = abs(D);
      if (D < 0) {
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
    [[nodiscard]] double side() const { return side_; }

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
    [[nodiscard]] detail::RealQuaternion to_body(const detail::RealQuaternion& q) const {
      const detail::RealVector v = to_body(detail::RealVector(q.vec()));
      return {q.w(), v.x(), v.y(), v.z()};
    }

   private:
    std::array<int, 3> body_{0, 1, 2};
    std::array<int, 3> sign_{};
    Real distance_;
    double side_ = 1;
  };

  /// A motion in which L moves against the body.
  class Polhode {
   public:
    Polhode(const Vector3<double>& moments, const Vector3<double>& omega0,
            const detail::RealQuaternion& attitude0)
        : axes_(moments, omega0) {
      const detail::RealVector theta = axes_.ordered(moments);
      const detail::RealVector w = axes_.from_body(omega0);
      const detail::RealVector w2 = w.cwiseAbs2();
      const Real i21 = abs(theta[1] - theta[0]);
      const Real i31 = abs(theta[2] - theta[0]);
      const Real i32 = abs(theta[2] - theta[1]);
      const Real p1 = theta[1] * i21 * w2[1] + theta[2] * i31 * w2[2];
      const Real p3 = theta[0] * i31 * w2[0] + theta[1] * i32 * w2[1];
      const Real L = theta.cwiseProduct(w).norm();

      functions_ = {i21 * p3 / (i32 * p1), i31 * axes_.distance() / (i32 * p1)};
      lambda_ = sqrt(i32 * p1 / (theta[0] * theta[1] * theta[2]));
      amplitude_ = {sqrt(p3 / (theta[0] * i31)), axes_.side() * sqrt(p3 / (theta[1] * i32)),
                    sqrt(p1 / (theta[2] * i31))};
      direction_ = amplitude_.cwiseProduct(theta) / L;
      const double up = std::exp2(-std::ilogb(direction_[0].hi));  // squares must not underflow
      azimuth_ = {scaled(direction_[0], up), scaled(direction_[1], up)};
      side_ = axes_.side();
      u0_ = EllipticFunctions::argument(
          {w[1] / amplitude_[1], w[0] / amplitude_[0], w[2] / amplitude_[2]});

      const Real nu = theta[2] * i21 / (theta[0] * i32);
      third_kind_ = {functions_, 1 + nu};
      steady_precession_ = L / theta[0];
      unsteady_precession_ = axes_.side() * i31 * L / (theta[0] * theta[2] * lambda_) * nu;
      start_ = attitude0 * axes_.to_body(attitude(functions_.phase(u0_), 0).conjugate());
    }

    [[nodiscard]] TopMotion at(double time) const {
      const Phase phase = functions_.phase(lambda_ * time + u0_);
      const auto [sn, cn, dn] = phase.at;
      const detail::RealVector omega = amplitude_.cwiseProduct(detail::RealVector(cn, sn, dn));
      return {(start_ * axes_.to_body(attitude(phase, time))).cast<double>(),
              axes_.to_body(omega).cast<double>()};
    }

    [[nodiscard]] Real period() const { return scaled(functions_.quarter(), 4) / lambda_; }

   private:
    /// From the axes 1, 2, 3 to non-rotating axes whose z is along L.
    [[nodiscard]] detail::RealQuaternion attitude(const Phase& phase, double time) const {
      const auto [sn, cn, dn] = phase.at;
      const detail::RealVector n = direction_.cwiseProduct(detail::RealVector(cn, sn, dn));
      const Real precession = steady_precession_ * time - unsteady_precession_ * third_kind_(phase);
      const auto [s, c] = kreisel::detail::sine_cosine(scaled(precession, 0.5));
      // Half of the azimuth of L, whose tan is L2/L1 = y/x, without a cut at +-pi.
      const Real x = azimuth_[0] * phase.rest.cn;
      const Real y = azimuth_[1] * phase.rest.sn;
      const Real half_x = sqrt(x * x + y * y) + x;
      const Real cosine = c * half_x + s * y;
      const Real sine = s * half_x - c * y;
      const auto turned = [&](const Real& a, const Real& b) {
        return detail::to_z_and_about_z(1 + n[2], n[0], n[1], a, b);
      };
      // Each half period turns L by half a turn.
      switch (static_cast<long long>(std::fmod(side_ * phase.half_periods, 4)) & 3) {
        case 0: return turned(cosine, sine);
        case 1: return turned(sine, -cosine);
        case 2: return turned(-cosine, -sine);
        default: return turned(-sine, cosine);
      }
    }

    Axes axes_;
    EllipticFunctions functions_;
    ThirdKind third_kind_{functions_, 1};
    Real lambda_;
    Real u0_;
    detail::RealVector amplitude_;  ///< a1, a2, a3
    detail::RealVector direction_;  ///< L/|L| where the functions are 1
    std::array<Real, 2> azimuth_;   ///< its parts across, enlarged
    double side_;                   ///< the sign of D
    Real steady_precession_;
    Real unsteady_precession_;
    detail::RealQuaternion start_;  ///< from inertial axes to those along L at time 0
  };

  Vector3<double> omega0_;
  detail::RealQuaternion attitude0_;
  double unit_;  ///< of rates in the polhode
  double energy_;
  double momentum_;
  std::optional<Polhode> polhode_;  ///< none for a steady rotation
};

}  // namespace kreisel::exact
