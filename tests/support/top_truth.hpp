#pragma once

#include <Eigen/Geometry>

#include <motor/motor.hpp>

#include <support/cast.hpp>
#include <support/kinematics.hpp>

namespace kreisel::test {

/// A top in 50 digits: Theta diagonal on body axes, a rotor's angular momentum constant there, and
/// a weight whose centre lies on body z. Taylor series of
///
///   Theta omega' = (Theta omega + rotor) x omega + weight_moment gamma x e_z,
///   gamma' = gamma x omega,   q' = q omega / 2
///
/// of order 36; it shares no formula with dynamics/exact.
struct TopTruth {
  Vector3<Digits50> moments;
  Vector3<Digits50> rotor;
  Digits50 weight_moment;
  Vector3<Digits50> omega;
  Eigen::Quaternion<Digits50> attitude;

  /// An attitude of any norm is normalised.
  TopTruth(const Vector3<double>& moments, const Vector3<double>& rotor, double weight_moment,
           const Vector3<double>& omega0, const Eigen::Quaterniond& attitude0);

  void advance(const Digits50& time);

  /// Advances far, by the change in one period raised to the number of periods. For a free top the
  /// period is that of omega on body axes, for a Lagrange top that of the tilt. A guess is enough.
  void advance_far(double time, double period);

  /// Deviations of the truth's angular velocity and attitude (an angle) from given ones.
  [[nodiscard]] double rate_error(const Vector3<double>& other) const;
  [[nodiscard]] double attitude_error(const Eigen::Quaterniond& other) const;

 private:
  [[nodiscard]] Digits50 step(const Digits50& longest);
  [[nodiscard]] Vector3<Digits50> acceleration() const;
  [[nodiscard]] Digits50 advance_period(double guess);
};

}  // namespace kreisel::test
