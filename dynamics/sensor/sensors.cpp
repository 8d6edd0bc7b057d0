#include <cmath>

#include <dynamics/sensor/sensors.hpp>

namespace kreisel {

namespace {

using Vector = Vector3<double>;

/// The motion of a body's point relative to the guide, on guide axes.
PointReading seen_from_guide(const BodyKinematics& body, const Vector& at) {
  const Vector r = body.R * at;
  const Vector turn = body.w.cross(r);
  return {body.x + r, body.v + turn, body.a + body.dw.cross(r) + body.w.cross(turn)};
}

/// The motion of the point relative to the inertial frame, on guide axes.
PointReading seen_from_inertial(const PointReading& p, const FrameMotion<Guide, Inertial>& guide) {
  const auto& [u, v_origin] = guide.V.value;
  const Vector& du = guide.dV.value.resultant;
  const auto& [R, origin] = guide.X.value;
  const Vector turn = u.cross(p.position);
  return {R.transpose() * origin + p.position, v_origin + turn + p.velocity,
          p.acceleration + guide.origin_acceleration() + du.cross(p.position) + u.cross(turn) +
              2 * u.cross(p.velocity)};
}

/// The motion of the point relative to a body, on guide axes.
PointReading seen_from_body(const PointReading& p, const BodyKinematics& body) {
  const Vector r = p.position - body.x;
  const Vector turn = body.w.cross(r);
  const Vector v = p.velocity - body.v - turn;
  return {r, v,
          p.acceleration - body.a - body.dw.cross(r) - body.w.cross(turn) - 2 * body.w.cross(v)};
}

/// The rotation from guide axes to the axes of the frame.
Matrix3<double> from_guide(const SensorFrame& frame, const SystemKinematics& system) {
  switch (frame.kind) {
    case SensorFrame::Kind::guide: break;
    case SensorFrame::Kind::inertial: return system.guide.X.value.rotation;
    case SensorFrame::Kind::body: return system.body(frame.body).R.transpose();
  }
  return Matrix3<double>::Identity();
}

/// Gravitation at a point of a body, on guide axes: the load on a mass of 1 kg at the point.
Vector gravitation(const SystemKinematics& system, int body, const Vector& at) {
  if (system.gravity.load == nullptr) return system.gravity.uniform;
  const BodyKinematics& b = system.body(body);
  const Matrix3<double> to_body = b.R.transpose();
  const LoadContext<> here{
      system.t,
      {{b.R, b.x}},
      {{to_body * b.w, to_body * b.v}},
      system.guide,
      InertiaTensor<Body>::about_centre(1, at, Matrix3<double>::Zero(), Mass::zero_allowed)};
  return system.gravity.uniform + b.R * (*system.gravity.load)(here).value.resultant;
}

}  // namespace

Vector Gyro::operator()(const SystemKinematics& system) const {
  const BodyKinematics& b = system.body(body);
  return axes.conjugate() * (b.R.transpose() * (b.w + system.guide.V.value.resultant));
}

Vector Accelerometer::operator()(const SystemKinematics& system) const {
  const BodyKinematics& b = system.body(body);
  const Vector a = seen_from_inertial(seen_from_guide(b, at), system.guide).acceleration;
  return axes.conjugate() * (b.R.transpose() * (a - gravitation(system, body, at)));
}

PointReading PointSensor::operator()(const SystemKinematics& system) const {
  PointReading p = seen_from_guide(system.body(body), at);
  if (against.kind == SensorFrame::Kind::inertial) p = seen_from_inertial(p, system.inertial_guide);
  if (against.kind == SensorFrame::Kind::body) p = seen_from_body(p, system.body(against.body));
  const Matrix3<double> turn = from_guide(axes, system);
  return {turn * p.position, turn * p.velocity, turn * p.acceleration};
}

Matrix3<double> AttitudeSensor::operator()(const SystemKinematics& system) const {
  return from_guide(against, system) * system.body(body).R;
}

double AzimuthSensor::operator()(const SystemKinematics& system) const {
  using Matrix2 = Eigen::Matrix2d;
  const Vector down =
      (gravitation(system, body, at) - system.guide.origin_acceleration()).normalized();
  const Vector axis = std::abs(down.z()) < 0.9 ? Vector::UnitZ() : Vector::UnitX();
  const Vector first = (axis - down.dot(axis) * down).normalized();
  Eigen::Matrix<double, 2, 3> level;
  level << first.transpose(), down.cross(first).transpose();

  const PointReading point = seen_from_guide(system.body(body), at);
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
  const Vector shift = to_guide(load.second) * (at.value_or(load.at) - load.at);
  const Motor<> moved = load.force.reduced_at(first.transpose() * shift);
  const auto turned = [&](const Vector& v) -> Vector {
    if (!frame) return axes.conjugate() * v;
    return axes.conjugate() * (from_guide(*frame, system) * (first * v));
  };
  return {turned(moved.resultant), turned(moved.moment)};
}

Motor<> ReactionSensor::operator()(const SystemKinematics& system) const {
  const Motor<> on_body =
      system.reactions.on_body[static_cast<std::size_t>(body)].value.reduced_at(at);
  const auto turned = [&](const Vector& v) -> Vector {
    if (!frame) return axes.conjugate() * v;
    return axes.conjugate() * (from_guide(*frame, system) * (system.body(body).R * v));
  };
  return {turned(on_body.resultant), turned(on_body.moment)};
}

}  // namespace kreisel
