#pragma once

#include <Eigen/Geometry>

#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>
#include <vector>

#include <dynamics/inertia.hpp>
#include <motor/displacement.hpp>
#include <motor/motor.hpp>
#include <motor/tensor.hpp>

namespace kreisel::test {

/// A mass and its position.
struct PointMass {
  double mass;
  Vector3<double> place;
};

/// Random numbers for a property test, made from a seed: the same on every machine and for every
/// compiler.
///
/// They spread over decades and include edge cases. These are zero, a pure couple, pitch 0, a
/// missing component, no displacement, a half turn, a point, a needle, a disc.
class Sample {
 public:
  explicit Sample(std::uint64_t seed) : engine_(seed) {}

  /// Evenly in [low, high).
  [[nodiscard]] double uniform(double low, double high) {
    return low + (high - low) * static_cast<double>(engine_() >> 11) * 0x1p-53;
  }

  /// True once in n times.
  [[nodiscard]] bool once_in(unsigned n) { return engine_() % n == 0; }

  /// Evenly over the decades from 10^low to 10^high, above 0.
  [[nodiscard]] double magnitude(double low = -3, double high = 3) {
    return std::pow(10.0, uniform(low, high));
  }

  /// A number of either sign, sometimes 0.
  [[nodiscard]] double number(double low = -3, double high = 3) {
    if (once_in(16)) return 0;
    return once_in(2) ? magnitude(low, high) : -magnitude(low, high);
  }

  /// A unit vector, sometimes along an axis or in a coordinate plane.
  [[nodiscard]] Vector3<double> direction() {
    Vector3<double> v;
    do {
      v = {uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)};
    } while (v.norm() > 1 || v.norm() < 0.1);
    if (once_in(8)) v[axis()] = 0;
    if (once_in(16)) v = Vector3<double>::Unit(axis());
    return v.norm() == 0 ? Vector3<double>::UnitZ() : Vector3<double>(v.normalized());
  }

  [[nodiscard]] Vector3<double> vector(double low = -3, double high = 3) {
    if (once_in(24)) return Vector3<double>::Zero();
    return magnitude(low, high) * direction();
  }

  [[nodiscard]] Motor<> motor(double low = -3, double high = 3) {
    switch (engine_() % 12) {
      case 0: return {};
      case 1: return {Vector3<double>::Zero(), vector(low, high)};  // couple
      case 2: return {vector(low, high), Vector3<double>::Zero()};  // line through the origin
      case 3: {                                                     // line elsewhere, to rounding
        const Vector3<double> r = vector(low, high);
        return {r, vector(low, high).cross(r)};
      }
      case 4: {  // axis through the origin
        const Vector3<double> r = vector(low, high);
        return {r, number(low, high) * r};
      }
      default: return {vector(low, high), vector(low, high)};
    }
  }

  /// A rotation, orthogonal to 4u; sometimes the identity, a quarter turn or a half turn.
  [[nodiscard]] Matrix3<double> rotation() {
    const Vector3<double> axis = direction();
    double angle = uniform(0, std::numbers::pi);
    if (once_in(8)) angle = magnitude(-12, 0);
    Eigen::Quaterniond q(std::cos(angle / 2), 0, 0, 0);
    q.vec() = std::sin(angle / 2) * axis;
    if (once_in(12)) q = Eigen::Quaterniond(0, axis.x(), axis.y(), axis.z());
    if (once_in(12)) q = Eigen::Quaterniond(1, axis.x() > 0 ? 1 : -1, 0, 0);
    if (once_in(12)) q = Eigen::Quaterniond::Identity();
    return Pose<>::from(q).rotation;
  }

  [[nodiscard]] Pose<> pose(double low = -3, double high = 3) {
    return {rotation(), vector(low, high)};
  }

  [[nodiscard]] MotorTensor<> tensor() { return {matrix(), matrix(), matrix(), matrix()}; }

  /// One to six masses: a point, a needle, a disc, a body.
  [[nodiscard]] std::vector<PointMass> masses() {
    std::vector<PointMass> masses(static_cast<std::size_t>(1 + engine_() % 6));
    const double scale = magnitude(-1, 1);
    const Vector3<double> centre = once_in(4) ? Vector3<double>::Zero() : vector(-1, 1);
    for (auto& [mass, place] : masses) {
      mass = magnitude(-1, 1);
      place = centre + scale * vector(-1, 0);
    }
    return masses;
  }

  /// Masses that resist every rotation: four corners of a box and the masses of masses().
  [[nodiscard]] std::vector<PointMass> solid_masses() {
    std::vector<PointMass> masses = this->masses();
    const double scale = magnitude(-1, 1);
    for (const Vector3<double>& corner : {Vector3<double>(1, 1, 1), Vector3<double>(1, -1, -1),
                                          Vector3<double>(-1, 1, -1), Vector3<double>(-1, -1, 1)}) {
      masses.push_back({magnitude(-1, 1), masses.front().place + scale * corner});
    }
    return masses;
  }

 private:
  [[nodiscard]] int axis() { return static_cast<int>(engine_() % 3); }

  [[nodiscard]] Matrix3<double> matrix() {
    Matrix3<double> m;
    m << vector(), vector(), vector();
    return m;
  }

  std::mt19937_64 engine_;
};

/// The inertia of point masses about the origin, by definition.
template <class S = double>
[[nodiscard]] Inertia<S> inertia(const std::vector<PointMass>& masses) {
  Inertia<S> sum;
  for (const auto& [mass, place] : masses) {
    const S m(mass);
    const S x(place.x());
    const S y(place.y());
    const S z(place.z());
    sum.mass += m;
    sum.first_moment += m * Vector3<S>(x, y, z);
    sum.tensor =
        sum.tensor + Symmetric3<S>{m * (y * y + z * z), m * (x * x + z * z), m * (x * x + y * y),
                                   -m * x * y,          -m * x * z,          -m * y * z};
  }
  return sum;
}

}  // namespace kreisel::test
