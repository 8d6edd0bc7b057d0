#include <Eigen/Geometry>

#include <cmath>
#include <numbers>

#include <dynamics/sensor/increments.hpp>
#include <motor/attitude.hpp>

namespace kreisel {

namespace {

using Numbers = IncrementEquations::Numbers;
using Vector = Vector3<double>;

/// The rotation vector of p that is nearest to another vector. p need not have norm 1.
Vector rotation_vector(const Eigen::Quaterniond& p, const Vector& other) {
  const double sine = p.vec().norm();
  if (sine == 0) return Vector::Zero();
  const Vector axis = p.vec() / sine;
  const double angle = 2 * std::atan2(sine, p.w());
  const double turn = 2 * std::numbers::pi;
  return (angle + turn * std::round((axis.dot(other) - angle) / turn)) * axis;
}

}  // namespace

Numbers IncrementEquations::start() { return Numbers::Unit(3); }

Numbers IncrementEquations::rates(const Numbers& numbers, const InertialReading& reading) {
  const Eigen::Quaterniond p(numbers.head<4>());
  const Vector& f = reading.specific_force;
  Numbers result;
  result << attitude_rate(p, reading.angular_velocity), p * f, reading.angular_velocity, f;
  return result;
}

Increments IncrementEquations::increments(const Numbers& numbers) {
  const Vector angle = numbers.segment<3>(7);
  return {rotation_vector(Eigen::Quaterniond(numbers.head<4>()), angle), numbers.segment<3>(4),
          angle, numbers.tail<3>()};
}

}  // namespace kreisel
