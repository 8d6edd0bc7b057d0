#pragma once

#include <cmath>
#include <sstream>

#include <dynamics/gimbal/cardan_gyro.hpp>

namespace kreisel {

/// The motion of a free Cardan gyro with a symmetric rotor for small nutations. It nutates about
/// the tilt beta_0 and drifts about the outer axis, because the rings have mass.
///
///   H = C_1 (phi' + alpha' sin beta),   p = J(beta) alpha' + H sin beta
///   sin beta_0 = p/H,   n = H cos(beta_0)/sqrt((B_1 + B_2) J(beta_0))
///   <alpha'> = -H w^2 sin(beta_0) (A_3 + C_2)/(2 J(beta_0)^2),   w = amplitude of beta
///   J(beta) = A_3 + C_2 sin^2 beta + (A_1 + A_2) cos^2 beta
///
/// Source : K. Magnus 1955 (reference 4 of paper 000), here from the exact equations (paper 002
///          section 7) by averaging
/// Units  : N m s, rad, rad/s
/// Error  : drift and period relatively O(w^2): 7e-4 of the drift at w = 0.025, H = 0.4
///          (tests/dynamics/gimbal/cardan_gyro_laws.cpp)
struct GimbalDrift {
  double rotor_momentum;      ///< H
  double tilt;                ///< beta_0, the mean of beta to first order
  double nutation_frequency;  ///< n, that of alpha and beta
  double nutation_amplitude;  ///< w, of beta
  double drift;               ///< the mean of alpha'; 0 for rings without mass
};

/// The drift law for a gyro with the angle beta against the outer ring and these rates.
///
/// Throws : InvalidInput if the rotor is not symmetric, cos beta <= 0, or |p| >= |H|: the gyro then
///          does not nutate about a tilt but turns over
[[nodiscard]] inline GimbalDrift gimbal_drift(const CardanMoments& moments, double beta,
                                              double alpha_rate, double beta_rate,
                                              double phi_rate) {
  const double A = moments.rotor.x();
  if (A != moments.rotor.y()) {
    throw InvalidInput("gimbal drift: the rotor is not symmetric, its drift has no closed form");
  }
  const double carried = moments.outer_ring.x() + moments.inner_ring.z();
  const double turned = A + moments.inner_ring.x();
  const auto J = [&](double sine) {
    return moments.outer_ring.x() + moments.inner_ring.z() * sine * sine +
           turned * (1 - sine) * (1 + sine);
  };
  const double s = std::sin(beta);
  const double H = moments.rotor.z() * (phi_rate + alpha_rate * s);
  const double p = J(s) * alpha_rate + H * s;
  if (!(std::cos(beta) > 0)) {
    throw InvalidInput("gimbal drift: beta lies beyond a quarter turn");
  }
  if (!(std::abs(p) < std::abs(H))) {
    std::ostringstream text;
    text << "gimbal drift: the momentum about the outer axis, " << p
         << " N m s, is not below that of the rotor, " << H << " N m s";
    throw InvalidInput(text.str());
  }
  const double s_0 = p / H;
  const double J_0 = J(s_0);
  const double tilt = std::asin(s_0);
  const double n = std::abs(H) * std::cos(tilt) / std::sqrt((A + moments.inner_ring.y()) * J_0);
  const double w = std::hypot(beta - tilt, beta_rate / n);
  return {H, tilt, n, w, -H * w * w * s_0 * carried / (2 * J_0 * J_0)};
}

/// The eigenfrequencies of small oscillations about alpha = beta = 0, guide at rest.
///
/// Units : rad/s
struct CardanFrequencies {
  double nutation;
  double precession;  ///< 0 if one of the bearings has no spring
};

/// Nutation and precession of a spinning rotor between springs of the stiffnesses c_a and c_b: the
/// roots of
///
///   T_a T_b w^4 - (H^2 + T_a c_b + T_b c_a) w^2 + c_a c_b = 0,
///   T_a = A_1 + A_2 + A_3,   T_b = B_1 + B_2,   H = C_1 phi'
///
/// Source : A. Foeppl's equations generalised to rings with mass, paper 002 below (50), exact to
///          first order in the angles; an unsymmetric rotor counts with the mean of A_1 and B_1
/// Error  : <= 8u of each; the lower one from the product of both, so that nothing cancels
[[nodiscard]] inline CardanFrequencies cardan_frequencies(const CardanMoments& moments,
                                                          const CardanBearings& bearings,
                                                          double phi_rate) {
  const double rotor = (moments.rotor.x() + moments.rotor.y()) / 2;
  const double T_a = rotor + moments.inner_ring.x() + moments.outer_ring.x();
  const double T_b = rotor + moments.inner_ring.y();
  const double H = moments.rotor.z() * phi_rate;
  // w_1^2 w_2^2 and (w_1 +- w_2)^2, the latter as a sum of squares.
  const double product =
      std::sqrt(bearings.outer.stiffness / T_a) * std::sqrt(bearings.inner.stiffness / T_b);
  const double difference =
      std::sqrt(bearings.outer.stiffness / T_a) - std::sqrt(bearings.inner.stiffness / T_b);
  const double gyroscopic = H * H / (T_a * T_b);
  const double w_less = std::sqrt(gyroscopic + difference * difference);
  const double w_sum = std::sqrt(gyroscopic + difference * difference + 4 * product);
  const double nutation = (w_sum + w_less) / 2;
  return {nutation, nutation > 0 ? product / nutation : 0};
}

/// The ring angles at which the rotor's axis points along n, on guide axes:
///
///   n = (sin beta, -sin alpha cos beta, cos alpha cos beta)
///
/// Their change is the kinematic gimbal error. alpha changes although the axis stays fixed in space
/// and the guide does not turn about the outer axis.
///
/// Source   : paper 002 (34), third column; the error: below (40)
/// Requires : n not along the outer axis x, where alpha is not determined and 0 is given
/// Units    : rad; beta within a quarter turn
struct GimbalAngles {
  double alpha;
  double beta;

  [[nodiscard]] static GimbalAngles of(const Vector3<double>& n) {
    const double across = std::hypot(n.y(), n.z());
    return {across > 0 ? std::atan2(-n.y(), n.z()) : 0, std::atan2(n.x(), across)};
  }

  [[nodiscard]] Vector3<double> axis() const {
    return {std::sin(beta), -std::sin(alpha) * std::cos(beta), std::cos(alpha) * std::cos(beta)};
  }
};

/// The rates of the angles while the rotor's axis keeps its direction in space and the guide turns
/// with u (on guide axes). `spin` is the rotor's absolute speed about its axis.
///
///   alpha' = z_3 tan beta - u_x,   beta' = -y_3,   phi' = spin - z_3/cos beta,
///   y_3 = u_y cos alpha + u_z sin alpha,   z_3 = u_z cos alpha - u_y sin alpha
///
/// Exact for rings without mass, on a guide in arbitrary motion: the free motion of the gyro.
///
/// Requires : cos beta != 0
/// Units    : rad/s
[[nodiscard]] inline CardanGyro<RestingFrame<>>::State riding_rates(const GimbalAngles& angles,
                                                                    double phi, double spin,
                                                                    const Vector3<double>& u) {
  const auto& [alpha, beta] = angles;
  const double y_3 = u.y() * std::cos(alpha) + u.z() * std::sin(alpha);
  const double z_3 = u.z() * std::cos(alpha) - u.y() * std::sin(alpha);
  return {alpha, beta, phi, z_3 * std::tan(beta) - u.x(), -y_3, spin - z_3 / std::cos(beta)};
}

}  // namespace kreisel
