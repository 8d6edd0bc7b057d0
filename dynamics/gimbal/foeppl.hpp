#pragma once

#include <dynamics/gimbal/cardan_gyro.hpp>
#include <dynamics/gimbal/gimbal_oscillation.hpp>
#include <dynamics/guide/resting.hpp>
#include <dynamics/model/scene.hpp>
#include <dynamics/model/terms.hpp>

namespace kreisel {

/// A. Foeppl's equations of a fast symmetric gyro in small oscillations between springs, with the
/// masses of the rings:
///
///   T_a alpha'' + d_a alpha' + H beta'  + c_a alpha = 0,    T_a = A_1 + A_2 + A_3
///   T_b beta''  + d_b beta'  - H alpha' + c_b beta  = 0,    T_b = A_1 + B_2,   H = C_1 phi'
///
/// The exact linearization about alpha = beta = 0 on a guide at rest, for a free or a regulated
/// rotor. Without rings it is the paper's (50), whose error for a gyro with rings is of first
/// order.
///
/// Source : paper 002 (50) and the generalised equations below it
/// Frame  : guide axes, reduced where the axes meet
/// Units  : rad, rad/s
/// Error  : of third order in the angles: 0.32 eps^3 (free) and 0.39 eps^3 (regulated) after 0.2 s
///          for starts of the size eps, growing with the time; greatest_deviation() measures it
///          (tests/dynamics/gimbal/unsymmetric_rotor.cpp)
/// Throws : InvalidInput for parameters that CardanGyro refuses, an unsymmetric rotor, or
///          references of the bearings other than 0
template <class Rotor = FreeRotor>
class FoepplGyro : public GimbalOscillation<CardanGyro<RestingFrame<>, Rotor>> {
  using Base = GimbalOscillation<CardanGyro<RestingFrame<>, Rotor>>;

 public:
  /// mass x'' + damping x' + stiffness x = 0,  x = (alpha, beta)
  struct Coefficients {
    Eigen::Matrix2d mass, damping, stiffness;
  };

  FoepplGyro(const CardanMoments& moments, const CardanBearings& bearings, double speed,
             Rotor rotor = {})
      : Base(typename Base::Exact(moments, bearings, RestingFrame<>{}, rotor), speed,
             "Foeppl's equations") {
    if (moments.rotor.x() != moments.rotor.y()) {
      throw InvalidInput(
          "Foeppl's equations: the rotor is not symmetric; UnsymmetricRotor takes it");
    }
  }

  [[nodiscard]] Coefficients coefficients() const {
    const auto& [rotor, inner, outer] = this->exact().moments();
    const auto& [about_a, about_b] = this->exact().bearings();
    const double H = rotor.z() * this->speed();
    Coefficients c;
    c.mass << rotor.x() + inner.x() + outer.x(), 0, 0, rotor.x() + inner.y();
    c.damping << about_a.damping, H, -H, about_b.damping;
    c.stiffness << about_a.stiffness, 0, 0, about_b.stiffness;
    return c;
  }

  /// The vector field  y' = rates(t, y)  on  y = (alpha, beta, alpha', beta').
  template <class S>
  [[nodiscard]] Eigen::Matrix<S, 4, 1> rates(const S& /*t*/,
                                             const Eigen::Matrix<S, 4, 1>& y) const {
    const Coefficients c = coefficients();
    Eigen::Matrix<S, 4, 1> dy;
    for (int i = 0; i < 2; ++i) {
      dy[i] = y[2 + i];
      dy[2 + i] = -(c.damping(i, 0) * y[2] + c.damping(i, 1) * y[3] + c.stiffness(i, i) * y[i]) /
                  c.mass(i, i);
    }
    return dy;
  }

  /// The terms of rates(): see kreisel::terms.
  [[nodiscard]] Terms terms() const {
    Terms list = Base::linear_terms_at_rest();
    list.add("relative", "A_1 - B_1, which turns with phi", false, "the rotor is symmetric");
    return list;
  }
};
template <class Rotor>
FoepplGyro(const CardanMoments&, const CardanBearings&, double, Rotor) -> FoepplGyro<Rotor>;

static_assert(Scene<FoepplGyro<>>);

}  // namespace kreisel
