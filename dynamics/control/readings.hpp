#pragma once

#include <Eigen/Geometry>

#include <cmath>
#include <type_traits>

#include <dynamics/control/controller.hpp>
#include <dynamics/control/loop.hpp>
#include <dynamics/tree/loads.hpp>
#include <dynamics/tree/passes.hpp>
#include <motor/attitude.hpp>

/// The numbers that controllers read, in double or dual numbers.

namespace kreisel::detail {

/// The motion of the bodies that carry links, without the angles of rotors. Poses and positions
/// are set in w; accelerations are those of dv, or 0 if dv is null.
template <class S>
void set_motion_of_bodies(const BodyTree& tree, const VectorOn<S>& y, const S* dv,
                          MotionSpace<S>& w, MotionOfBodies<S>& result) {
  const S* const v = y.data() + tree.coordinates();
  set_poses(tree, y.data(), w);
  set_places(tree, v, w);
  if (dv != nullptr) set_motions(tree, LinkMotion<S>{}, v, dv, w);
  result.bodies.resize(tree.bodies().size());
  for (int i = 0; i < static_cast<int>(tree.bodies().size()); ++i) {
    const std::size_t link = tree.link(i);
    if (link >= tree.links().size()) continue;
    BodyKinematicsOn<S>& body = result.bodies[static_cast<std::size_t>(i)];
    body.R = w.pose[link].R;
    body.x = w.place[link].x;
    body.w = w.place[link].V.resultant;
    body.v = w.place[link].V.moment;
    if (dv == nullptr) continue;
    body.dw = w.motion[link].dw;
    body.a = w.motion[link].a;
  }
}

/// The quaternion w, x, y, z of a rotation, with w >= 0. The largest of its numbers is a root, the
/// others are quotients by it.
///
/// Error : <= 8u of each number
template <class S>
[[nodiscard]] Eigen::Matrix<S, 4, 1> quaternion_of(const Matrix3<S>& R) {
  using std::sqrt;
  Eigen::Matrix<S, 4, 1> q;
  const S trace = R(0, 0) + R(1, 1) + R(2, 2);
  int largest = 0;
  for (int i = 1; i < 3; ++i) {
    if (R(i, i) > R(largest, largest)) largest = i;
  }
  if (trace > R(largest, largest)) {
    q[0] = sqrt(S(1) + trace) / S(2);
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3, k = (i + 2) % 3;
      q[i + 1] = (R(k, j) - R(j, k)) / (S(4) * q[0]);
    }
    return q;
  }
  const int i = largest, j = (i + 1) % 3, k = (i + 2) % 3;
  q[i + 1] = sqrt(S(1) + R(i, i) - R(j, j) - R(k, k)) / S(2);
  const S part = S(4) * q[i + 1];
  q[0] = (R(k, j) - R(j, k)) / part;
  q[j + 1] = (R(j, i) + R(i, j)) / part;
  q[k + 1] = (R(k, i) + R(i, k)) / part;
  return q[0] < S(0) ? Eigen::Matrix<S, 4, 1>(-q) : q;
}

/// The number that a controller reads.
template <class S>
[[nodiscard]] S number_of(const Reading& reading, const BodyTree& tree, const VectorOn<S>& y,
                          const MotionOfBodies<S>& motion) {
  const int c = reading.component;
  const auto read = [&](const auto& sensor) -> S {
    using Sensor = std::decay_t<decltype(sensor)>;
    if constexpr (std::is_same_v<Sensor, JointSensor>) {
      const JointPlace place = tree.place(sensor.body);
      const int first = sensor.is_rate ? tree.coordinates() + place.v : place.q;
      return y[first + sensor.component];
    } else if constexpr (std::is_same_v<Sensor, PointSensor>) {
      const PointReading<S> point = sensor(motion);
      return c < 3 ? point.position[c] : c < 6 ? point.velocity[c - 3] : point.acceleration[c - 6];
    } else if constexpr (std::is_same_v<Sensor, AttitudeSensor>) {
      return quaternion_of(sensor(motion))[c];
    } else if constexpr (std::is_same_v<Sensor, AttitudeAngles>) {
      const auto [yaw, pitch, roll] = YawPitchRoll<S>::of(sensor.sensor(motion));
      return c == 0 ? yaw : c == 1 ? pitch : roll;
    } else {
      return sensor(motion)[c];
    }
  };
  return std::visit(read, reading.sensor);
}

}  // namespace kreisel::detail
