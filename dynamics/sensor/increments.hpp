#pragma once

#include <array>

#include <motor/api.hpp>
#include <motor/motor.hpp>

namespace kreisel {

/// The readings of gyros and accelerometers on one triad of axes.
///
/// Units  : rad/s, m/s^2
struct InertialReading {
  Vector3<double> angular_velocity = Vector3<double>::Zero();
  Vector3<double> specific_force = Vector3<double>::Zero();
};

/// The integrals of the readings w and f of an inertial unit over a period.
///
/// `rotation` and `velocity` include coning and sculling. From the attitude q at the period's
/// beginning they lead to the attitude q exp(rotation/2). The specific force has changed the
/// inertial velocity by R(q) velocity. `angle` and `force` are integrals of the components alone.
///
///   p' = p w/2,   velocity' = R(p) f,   angle' = w,   force' = f,   p = exp(rotation/2)
///
/// The rotation vector is determined up to whole turns and is the one nearest to `angle`.
///
/// Frame  : the unit's own axes; for rotation and velocity those at the beginning of the period
/// Units  : rad, m/s
/// Source : J. E. Bortz, A new mathematical formulation for strapdown inertial navigation, IEEE
///          Trans. Aerospace and Electronic Systems 7 (1971), 61-66
struct Increments {
  Vector3<double> rotation = Vector3<double>::Zero();
  Vector3<double> velocity = Vector3<double>::Zero();
  Vector3<double> angle = Vector3<double>::Zero();
  Vector3<double> force = Vector3<double>::Zero();
};

/// The unknowns of these equations, for integration beside the equations of a system.
struct KREISEL_API IncrementEquations {
  static constexpr int count = 13;  ///< vector part of p, its real part, velocity, angle, force
  using Numbers = Eigen::Matrix<double, count, 1>;

  static constexpr std::array blocks{3, 1, 3, 3, 3};  ///< that share a unit and a size

  [[nodiscard]] static Numbers start();
  [[nodiscard]] static Numbers rates(const Numbers& numbers, const InertialReading& reading);
  [[nodiscard]] static Increments increments(const Numbers& numbers);
};

}  // namespace kreisel
