#pragma once

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <dynamics/gimbal/cardan_gyro.hpp>
#include <dynamics/gimbal/gimbal_oscillation.hpp>
#include <dynamics/guide/resting.hpp>
#include <dynamics/model/scene.hpp>
#include <dynamics/model/terms.hpp>

namespace kreisel {

/// Small oscillations of a rotor with unequal transverse moments A and B about alpha = beta = 0,
/// guide at rest. The rotor runs at constant speed in a Cardan suspension with springs.
///
///   d/dt (M(t) x') + C Omega S x' + D x' + K x = 0,   x = (alpha, beta),   S = (0 1; -1 0)
///
///        Th + m_x + d cos(2 phi)   d sin(2 phi)               Th = (A + B)/2,  d = (A - B)/2
///   M =  d sin(2 phi)              Th + m_y - d cos(2 phi)    phi = Omega t
///
/// m_x = A_2 + A_3, m_y = B_2 of the rings, which the paper leaves out. The coefficients have the
/// period pi/Omega, and in some ranges of Omega the equilibrium is unstable: study/floquet.hpp.
///
/// Source : paper 002 (49) without the factors 1/2 in the square brackets, and springs. The printed
///          equation has an error of first order and other unstable ranges
/// Frame  : guide axes, reduced where the axes meet
/// Units  : rad, rad/s
/// Error  : of third order in the angles (tests/dynamics/gimbal/unsymmetric_rotor.cpp), growing as
///          exp(t ln|l|/period) in an unstable range; greatest_deviation() measures it
/// Throws : InvalidInput for what CardanGyro refuses, and a speed that is 0 or not finite
template <class Rotor = RegulatedRotor>
class UnsymmetricRotor : public GimbalOscillation<CardanGyro<RestingFrame<>, Rotor>> {
  using Base = GimbalOscillation<CardanGyro<RestingFrame<>, Rotor>>;

 public:
  using typename Base::Vector;

  /// M x'' + damping x' + stiffness x = 0 at one time; `damping` is dM/dt + C Omega S + D.
  struct Coefficients {
    Eigen::Matrix2d mass, damping, stiffness;
  };

  /// `speed` is Omega, the speed of the rotor against the inner ring. References of the bearings
  /// must be 0.
  UnsymmetricRotor(const CardanMoments& moments, const CardanBearings& bearings, double speed,
                   Rotor rotor = {})
      : Base(typename Base::Exact(moments, bearings, RestingFrame<>{}, rotor), speed,
             "unsymmetric rotor") {
    if (speed == 0) throw InvalidInput("unsymmetric rotor: the speed is 0");
  }

  /// The period of the coefficients, in seconds.
  [[nodiscard]] double period() const { return std::numbers::pi / std::abs(this->speed()); }

  [[nodiscard]] Coefficients coefficients(double t) const {
    const auto& [rotor, inner, outer] = this->exact().moments();
    const auto& [about_a, about_b] = this->exact().bearings();
    const double turning = 2 * this->speed();
    const double mean = (rotor.x() + rotor.y()) / 2;
    const double half = (rotor.x() - rotor.y()) / 2;
    const double c = half * std::cos(turning * t);
    const double s = half * std::sin(turning * t);
    const double H = rotor.z() * this->speed();
    Coefficients result;
    result.mass << mean + inner.x() + outer.x() + c, s, s, mean + inner.y() - c;
    result.damping << about_a.damping - turning * s, turning * c + H,  //
        turning * c - H, about_b.damping + turning * s;
    result.stiffness << about_a.stiffness, 0, 0, about_b.stiffness;
    return result;
  }

  /// y' = state_matrix(t) y  on  y = (alpha, beta, alpha', beta').
  [[nodiscard]] Eigen::Matrix4d state_matrix(double t) const {
    const Coefficients c = coefficients(t);
    const Eigen::Matrix2d inverse = c.mass.inverse();
    Eigen::Matrix4d A;
    A << Eigen::Matrix2d::Zero(), Eigen::Matrix2d::Identity(),  //
        -inverse * c.stiffness, -inverse * c.damping;
    return A;
  }

  /// The vector field  y' = rates(t, y).
  [[nodiscard]] Vector rates(double t, const Vector& y) const { return state_matrix(t) * y; }

  /// The terms of rates(): see kreisel::terms.
  [[nodiscard]] Terms terms() const {
    Terms list = Base::linear_terms_at_rest();
    list.add("relative", "A_1 - B_1, which turns with phi");
    return list;
  }
};
template <class Rotor>
UnsymmetricRotor(const CardanMoments&, const CardanBearings&, double, Rotor)
    -> UnsymmetricRotor<Rotor>;

/// The unstable range of a rotor without rings in two equal springs c, in closed form. On axes of
/// the rotor its coefficients are constant,
///
///   A B s^4 + (A k_2 + B k_1 + Omega^2 (A + B - C)^2) s^2 + k_1 k_2 = 0,
///   k_1 = c + Omega^2 (C - B),   k_2 = c + Omega^2 (C - A),
///
/// The rotor is unstable where k_1 k_2 < 0: for any difference of A and B, while the rotor
/// spins about its intermediate axis.
///
/// Units  : rad/s
/// Source : paper 002 (49) with springs, in the rotor's axes
struct EqualSpringsRange {
  double begin;
  double end;  ///< infinity if the range has none

  /// Throws : InvalidInput if moments or stiffness are not above 0
  [[nodiscard]] static EqualSpringsRange of(const Vector3<double>& rotor, double stiffness) {
    if (!(rotor.minCoeff() > 0 && stiffness > 0)) {
      throw InvalidInput("unsymmetric rotor: moments and stiffness have to be above 0");
    }
    const auto limit = [&](double moment) {
      const double over = moment - rotor.z();
      return over > 0 ? std::sqrt(stiffness / over) : std::numeric_limits<double>::infinity();
    };
    return {limit(std::max(rotor.x(), rotor.y())), limit(std::min(rotor.x(), rotor.y()))};
  }
};

static_assert(Scene<UnsymmetricRotor<>>);

}  // namespace kreisel
