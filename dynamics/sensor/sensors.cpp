#include <cmath>
#include <utility>

#include <dynamics/sensor/sensors.hpp>
#include <motor/error.hpp>

namespace kreisel {

namespace {

/// The direction of apparent gravity on a mass at rest at a position in the guide, on guide axes.
Vector3<double> vertical(const SystemKinematics& system, const Vector3<double>& place) {
  const Vector3<double> zero = Vector3<double>::Zero();
  const PointReading<> rest{place, zero, zero};
  const Vector3<double> gravitation = detail::gravitation(system, place);
  const Vector3<double> acceleration = detail::seen_from_inertial(rest, system.guide).acceleration;
  const Vector3<double> apparent = gravitation - acceleration;
  if (!(apparent.norm() > 1e-9 * (gravitation.norm() + acceleration.norm()))) {
    throw ComputationFailed(
        "azimuth: the guide falls freely, so that nothing gives the vertical; read the motion of a "
        "point in its place");
  }
  return apparent.normalized();
}

/// The direction of the plumb line of this length that hangs from a point of the guide, by fixed
/// point iteration.
Vector3<double> plumb_line(const SystemKinematics& system, const Vector3<double>& pivot,
                           double length) {
  Vector3<double> down = Vector3<double>::Zero();
  for (int i = 0; i < 50; ++i) {
    const Vector3<double> before = std::exchange(down, vertical(system, pivot + length * down));
    if ((down - before).norm() <= 1e-15) break;
  }
  return down;
}

}  // namespace

double AzimuthSensor::operator()(const SystemKinematics& system) const {
  using Matrix2 = Eigen::Matrix2d;
  const PointReading<> point = detail::seen_from_guide(system.body(body), at);
  const Vector3<double> reach = point.position - pivot;
  const Vector3<double> down = plumb_line(system, pivot, reach.norm());
  const Vector3<double> axis =
      std::abs(down.z()) < 0.9 ? Vector3<double>::UnitZ() : Vector3<double>::UnitX();
  const Vector3<double> first = (axis - down.dot(axis) * down).normalized();
  Eigen::Matrix<double, 2, 3> level;
  level << first.transpose(), down.cross(first).transpose();

  const auto turn_by = [&down](const Vector3<double>& w) {
    return (Matrix2() << 0, -down.dot(w), down.dot(w), 0).finished();
  };
  const Matrix2 turn = turn_by(system.guide.V.value.resultant);
  const Eigen::Vector2d p = level * reach;
  const Eigen::Vector2d relative = level * point.velocity;
  const Eigen::Vector2d v = relative + turn * p;
  const Eigen::Vector2d a = level * point.acceleration + turn * (relative + v) +
                            turn_by(system.guide.dV.value.resultant) * p;
  const Matrix2 pull = a * p.transpose();
  const Matrix2 S = v * v.transpose() - (pull + pull.transpose()) / 2;
  return reference + std::atan2(2 * S(0, 1), S(0, 0) - S(1, 1)) / 2;
}

Motor<> ElementSensor::operator()(const SystemKinematics& system) const {
  const ElementLoad& load = system.elements[static_cast<std::size_t>(element)];
  const auto to_guide = [&system](int body) -> Matrix3<double> {
    return body < 0 ? Matrix3<double>::Identity() : system.body(body).R;
  };
  const Matrix3<double> first = to_guide(load.first);
  const Vector3<double> shift = to_guide(load.second) * (at.value_or(load.at) - load.at);
  const Motor<> moved = load.force.reduced_at(first.transpose() * shift);
  const auto turned = [&](const Vector3<double>& v) -> Vector3<double> {
    if (!frame) return axes.conjugate() * v;
    return axes.conjugate() * (detail::from_guide(*frame, system) * (first * v));
  };
  return {turned(moved.resultant), turned(moved.moment)};
}

Motor<> ReactionSensor::operator()(const SystemKinematics& system) const {
  const Motor<> on_body =
      system.reactions.on_body[static_cast<std::size_t>(body)].value.reduced_at(at);
  const auto turned = [&](const Vector3<double>& v) -> Vector3<double> {
    if (!frame) return axes.conjugate() * v;
    return axes.conjugate() * (detail::from_guide(*frame, system) * (system.body(body).R * v));
  };
  return {turned(on_body.resultant), turned(on_body.moment)};
}

}  // namespace kreisel
