#include <cmath>

#include "reference_numbers.hpp"
#include "reference_tree.hpp"

/// Elements in maximal coordinates: forces on both bodies from their poses on inertial axes.

namespace differential::reference {

namespace {

Mat cross_matrix(const Vec& a) {
  Mat result;
  result << 0, -a.z(), a.y(), a.z(), 0, -a.x(), -a.y(), a.x(), 0;
  return result;
}

/// The rotation vector of a rotation, by its quaternion.
Vec rotation_vector(const Mat& R) {
  Quat q(R);
  if (q.w() < 0) q.coeffs() = -q.coeffs();
  const Real sine = q.vec().norm();
  return sine == 0 ? Vec(Vec::Zero()) : Vec(2 * std::atan2(sine, q.w()) / sine * q.vec());
}

/// The matrix J with w = J theta', from the series of exp.
Mat to_angular_velocity(const Vec& theta) {
  const Mat K = cross_matrix(theta);
  Mat term = Mat::Identity();
  Mat sum = term;
  for (int n = 2; n < 40; ++n) {
    term = term * K / Real(n);
    sum += term;
  }
  return sum;
}

Real pull(const Element& e, Real length, Real unloaded) {
  if (e.table.empty()) return Real(e.stiffness) * (length - unloaded);
  std::size_t piece = 1;
  while (piece + 1 < e.table.size() && length > Real(e.table[piece].first)) ++piece;
  const auto [from, low] = e.table[piece - 1];
  const auto [to, high] = e.table[piece];
  return Real(low) + (length - Real(from)) * (Real(high) - Real(low)) / (Real(to) - Real(from));
}

}  // namespace

Tree::Pose Tree::pose_of(int body) const {
  return body < 0 ? guide_pose_ : poses_[static_cast<std::size_t>(body)];
}

Vec Tree::centre_of(int body) const {
  return body < 0 ? Vec(Vec::Zero()) : parts_[static_cast<std::size_t>(body)].centre;
}

Vec Tree::spring_force(const Element& e) const {
  const Pose a = pose_of(e.bodies[0]);
  const Pose b = pose_of(e.bodies[1]);
  const Vec arm_a = a.R * (wide(e.at[0]) - centre_of(e.bodies[0]));
  const Vec arm_b = b.R * (wide(e.at[1]) - centre_of(e.bodies[1]));
  const Vec reach = b.x + arm_b - a.x - arm_a;
  const Real length = reach.norm();
  if (length == 0) return Vec::Zero();
  const Vec v = b.v + b.w.cross(arm_b) - a.v - a.w.cross(arm_a);
  const Course winch = course_of(e.length_in_time, now_, within_);
  const Real given = e.length_in_time.empty() ? Real(e.length) : winch.value.x();
  const Real unloaded = given + paid_out(e);
  const Real rate = reach.dot(v) / length - winch.rate.x();
  const Real tension = pull(e, length, unloaded) + Real(e.damping) * rate;
  const bool is_slack = e.kind == ElementKind::rope && (length <= unloaded || tension <= 0);
  return is_slack ? Vec(Vec::Zero()) : Vec(-tension * reach / length);
}

std::pair<Vec, Vec> Tree::mount_force(const Element& e) const {
  const Pose a = pose_of(e.bodies[0]);
  const Pose b = pose_of(e.bodies[1]);
  const Mat A = a.R * unit_quaternion(e.axes).toRotationMatrix();  // the mount's axes
  const Vec arm = b.R * (wide(e.at[1]) - centre_of(e.bodies[1]));
  const Vec lever = b.x + arm - a.x;
  const Vec d = A.transpose() * (lever - a.R * (wide(e.at[0]) - centre_of(e.bodies[0])));
  const Vec v = A.transpose() * (b.v + b.w.cross(arm) - a.v - a.w.cross(lever));
  const Vec w = A.transpose() * (b.w - a.w);
  const Vec theta = A.transpose() * a.R * rotation_vector(a.R.transpose() * b.R);
  const Mat C = e.coupling.cast<Real>();
  const Vec force = wide(e.force) - e.linear.cast<Real>() * d - C * theta -
                    wide(e.linear_damping).cwiseProduct(v);
  const Vec elastic = wide(e.torque) - C.transpose() * d - e.turning.cast<Real>() * theta;
  const Vec torque = to_angular_velocity(theta).transpose().inverse() * elastic -
                     wide(e.turning_damping).cwiseProduct(w);
  return {A * force, A * torque};
}

std::pair<Vec, Vec> Tree::element_force(const Element& e) const {
  if (e.kind == ElementKind::mount) return mount_force(e);
  return {spring_force(e), Vec::Zero()};
}

void Tree::add_on_body(int body, const Vec& point, const Vec& force, const Vec& torque) {
  if (body < 0) return;
  const Vec lever = point - pose_of(body).x;
  right_.segment<3>(6 * body) += force;
  right_.segment<3>(6 * body + 3) += torque + lever.cross(force);
}

void Tree::add_elements() {
  for (const Element& e : scene_.elements) {
    if (e.kind == ElementKind::gear) continue;
    if (e.kind == ElementKind::mount && rotation_of(e) > 3) mounts_hold_ = false;
    const auto [force, torque] = element_force(e);
    const Pose b = pose_of(e.bodies[1]);
    const Vec point = b.x + b.R * (wide(e.at[1]) - centre_of(e.bodies[1]));
    add_on_body(e.bodies[1], point, force, torque);
    add_on_body(e.bodies[0], point, -force, -torque);
  }
}

Real Tree::rotation_of(const Element& mount) const {
  const Mat R = pose_of(mount.bodies[0]).R.transpose() * pose_of(mount.bodies[1]).R;
  return rotation_vector(R).norm();
}

bool Tree::element_works(const Element& e) {
  if (e.kind == ElementKind::gear) return true;
  const State y = start();
  State none(size_);
  read(y, guide_.at(Real(scene_.t_begin), y, none));
  const Pose a = pose_of(e.bodies[0]);
  const Pose b = pose_of(e.bodies[1]);
  if (e.kind == ElementKind::mount) return rotation_of(e) < 2;
  const Vec reach = b.x + b.R * (wide(e.at[1]) - centre_of(e.bodies[1])) - a.x -
                    a.R * (wide(e.at[0]) - centre_of(e.bodies[0]));
  return reach.norm() > 0.01L;
}

std::pair<Real, Real> Tree::coordinate_of(int body, const State& y) const {
  const Relative r = relative(body);
  if (scene_.bodies[static_cast<std::size_t>(body)].kind == JointKind::prismatic) {
    return {r.axis.dot(r.place), r.axis.dot(r.v)};
  }
  return {y[parts_[static_cast<std::size_t>(body)].angles], r.axis.dot(r.w)};
}

Real Tree::gear_force(const Element& e, const State& y) const {
  const auto [q_a, v_a] = coordinate_of(e.bodies[0], y);
  const auto [q_b, v_b] = coordinate_of(e.bodies[1], y);
  return -Real(e.stiffness) * (q_a - Real(e.ratio) * q_b) -
         Real(e.damping) * (v_a - Real(e.ratio) * v_b);
}

void Tree::add_along_joint(int body, Real force) {
  const Relative r = relative(body);
  if (scene_.bodies[static_cast<std::size_t>(body)].kind == JointKind::prismatic) {
    add_force(body, r, force * r.axis);
  } else {
    add_torque(body, force * r.axis);
  }
}

void Tree::add_gears(const State& y) {
  for (const Element& e : scene_.elements) {
    if (e.kind != ElementKind::gear) continue;
    const Real force = gear_force(e, y);
    add_along_joint(e.bodies[0], force);
    add_along_joint(e.bodies[1], -Real(e.ratio) * force);
  }
}

Real Tree::element_energy(const Element& e, const State& y) const {
  if (e.kind == ElementKind::gear) {
    const Real q = std::abs(coordinate_of(e.bodies[0], y).first) +
                   std::abs(Real(e.ratio) * coordinate_of(e.bodies[1], y).first);
    return Real(e.stiffness) * q * q;
  }
  const Pose a = pose_of(e.bodies[0]);
  const Pose b = pose_of(e.bodies[1]);
  const Real way = (b.x - a.x).norm() + wide(e.at[0]).norm() + wide(e.at[1]).norm() +
                   centre_of(e.bodies[0]).norm() + centre_of(e.bodies[1]).norm() + Real(e.length);
  const Real angle = rotation_vector(a.R.transpose() * b.R).norm();
  Real steepest = std::abs(Real(e.stiffness)) + Real(e.linear.norm());
  for (const auto& [length, force] : e.table) steepest += std::abs(Real(force)) / way;
  return steepest * way * way + Real(e.turning.norm()) * angle * angle +
         Real(e.coupling.norm()) * angle * way + Real(e.force.norm()) * way +
         Real(e.torque.norm()) * angle;
}

std::pair<Vec, Vec> Tree::element_reading(const Sensor& sensor, const State& y) const {
  const Element& e = scene_.elements[static_cast<std::size_t>(sensor.element)];
  const Mat to_first = pose_of(e.bodies[0]).R.transpose();
  const Mat R = pose_of(e.bodies[1]).R;
  if (e.kind == ElementKind::gear) {
    const Vec along = -Real(e.ratio) * gear_force(e, y) * relative(e.bodies[1]).axis;
    const bool slides =
        scene_.bodies[static_cast<std::size_t>(e.bodies[1])].kind == JointKind::prismatic;
    const Vec force = slides ? along : Vec(Vec::Zero());
    const Vec torque = slides ? Vec(Vec::Zero()) : along;
    return {to_first * force, to_first * (torque - (R * wide(sensor.at)).cross(force))};
  }
  const auto [force, torque] = element_force(e);
  // Without `at` the torque is about the element's own point.
  const Vec shift = sensor.at.isZero(0) ? Vec(Vec::Zero()) : Vec(R * wide(sensor.at - e.at[1]));
  return {to_first * force, to_first * (torque - shift.cross(force))};
}

}  // namespace differential::reference

namespace differential {

bool last_element_works(const Scene& scene) {
  reference::Tree tree(scene);
  tree.stay_within(reference::Real(scene.t_begin));
  return tree.element_works(scene.elements.back());
}

}  // namespace differential
