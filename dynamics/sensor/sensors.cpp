#include <cmath>

#include <dynamics/sensor/sensors.hpp>

namespace kreisel {

double AzimuthSensor::operator()(const SystemKinematics& system) const {
  using Matrix2 = Eigen::Matrix2d;
  const Vector3<double> down =
      (detail::gravitation(system, body, at) - system.guide.origin_acceleration()).normalized();
  const Vector3<double> axis =
      std::abs(down.z()) < 0.9 ? Vector3<double>::UnitZ() : Vector3<double>::UnitX();
  const Vector3<double> first = (axis - down.dot(axis) * down).normalized();
  Eigen::Matrix<double, 2, 3> level;
  level << first.transpose(), down.cross(first).transpose();

  const PointReading<> point = detail::seen_from_guide(system.body(body), at);
  const double turn = down.dot(system.guide.V.value.resultant);
  const Matrix2 across = (Matrix2() << 0, -turn, turn, 0).finished();
  const Eigen::Vector2d p = level * (point.position - pivot);
  const Eigen::Vector2d relative = level * point.velocity;
  const Eigen::Vector2d v = relative + across * p;
  const Eigen::Vector2d a = level * point.acceleration + across * (relative + v);
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
