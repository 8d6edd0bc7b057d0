#include <algorithm>

#include "reference_numbers.hpp"
#include "reference_tree.hpp"

/// The conditions of joints.

namespace differential::reference {

Vec Tree::turned_off(int body, const Relative& r) const {
  const Part& part = parts_[static_cast<std::size_t>(body)];
  const Mat wanted = part.start_turn * part.zero.transpose();  // of r.turn
  Quat q(Mat(r.turn * wanted.transpose()));
  if (q.w() < 0) q.coeffs() = -q.coeffs();
  return parent(body).R * (2 * q.vec());
}

void Tree::add_translation(const Relative& r, const Motion& guide, const Vec& n) {
  const auto N = static_cast<Eigen::Index>(6 * poses_.size());
  const Eigen::Index row = N + rows_;
  const Pose b = pose_of(r.body);
  const Pose p = pose_of(r.base);
  const auto put = [&](int to, const Vec& force, const Vec& torque) {
    matrix_.block<1, 3>(row, 6 * to) += force.transpose();
    matrix_.block<1, 3>(row, 6 * to + 3) += torque.transpose();
  };
  if (r.body >= 0) {
    put(r.body, n, r.arm.cross(n));
  } else {
    right_[row] -= n.dot(guide.dw.cross(r.arm));
  }
  right_[row] +=
      n.dot(p.w.cross(p.w.cross(r.reach)) + 2 * p.w.cross(r.v) - b.w.cross(b.w.cross(r.arm)));
  if (r.base >= 0) {
    put(r.base, -n, -r.reach.cross(n));
  } else {
    right_[row] += n.dot(guide.dw.cross(r.reach));
  }
  const auto at_row = static_cast<std::size_t>(rows_);
  off_place_[at_row] += n.dot(r.off);
  off_velocity_[at_row] += n.dot(r.v);
  rows_ += 1;
}

void Tree::add_rotation(const Relative& r, const Motion& guide, const Vec& n, Real extra, Real off,
                        Real speed) {
  const auto N = static_cast<Eigen::Index>(6 * poses_.size());
  const Eigen::Index row = N + rows_;
  if (r.body >= 0) {
    matrix_.block<1, 3>(row, 6 * r.body + 3) += n.transpose();
  } else {
    right_[row] -= n.dot(guide.dw);
  }
  right_[row] += n.dot(pose_of(r.base).w.cross(pose_of(r.body).w)) - extra;
  if (r.base >= 0) {
    matrix_.block<1, 3>(row, 6 * r.base + 3) -= n.transpose();
  } else {
    right_[row] += n.dot(guide.dw);
  }
  const auto at_row = static_cast<std::size_t>(rows_);
  off_place_[at_row] += off;
  off_velocity_[at_row] += n.dot(r.w) - speed;
  rows_ += 1;
}

std::pair<Real, Real> Tree::drive(int body) const {
  const Body& b = scene_.bodies[static_cast<std::size_t>(body)];
  if (b.motion.empty()) return {parts_[static_cast<std::size_t>(body)].speed, 0};
  const Course course = course_of(b.motion, now_, within_);
  return b.is_rate ? std::pair(course.value.x(), course.rate.x())
                   : std::pair(course.rate.x(), course.second_rate.x());
}

void Tree::add_rows(int body, const Relative& r, const Motion& guide) {
  const Part& part = parts_[static_cast<std::size_t>(body)];
  const JointKind kind = scene_.bodies[static_cast<std::size_t>(body)].kind;
  const bool stiff = part.held || kind == JointKind::prismatic;
  if (!part.held && kind == JointKind::free) return;
  const auto [first, second] = across(r.axis);
  const bool slides_along =
      kind == JointKind::prismatic || kind == JointKind::cylindrical || kind == JointKind::screw;
  if (!part.held && kind == JointKind::planar) {
    add_translation(r, guide, r.axis);
  } else if (!part.held && slides_along) {
    add_translation(r, guide, first);
    add_translation(r, guide, second);
  } else {
    for (int i = 0; i < 3; ++i) add_translation(r, guide, Vec::Unit(i));
  }
  if (stiff) {
    const Vec off = turned_off(body, r);
    for (int i = 0; i < 3; ++i) add_rotation(r, guide, Vec::Unit(i), 0, off[i], 0);
  } else if (is_hinge(kind)) {
    const Vec image = parent(body).R * (r.turn * part.axis);
    const Vec off = r.axis.cross(image);
    add_rotation(r, guide, first, 0, off.dot(first), 0);
    add_rotation(r, guide, second, 0, off.dot(second), 0);
    if (part.driven) {
      const auto [speed, acceleration] = drive(body);
      add_rotation(r, guide, r.axis, -acceleration, 0, speed);
    }
    if (kind == JointKind::screw) {
      // One row: the advance less the pitch times the angle.
      const Real turned = nearest_turn(angles_of(body, r).first, r.near);
      add_translation(r, guide, r.axis);
      rows_ -= 1;
      add_rotation(r, guide, -part.pitch * r.axis, 0, -part.pitch * turned, 0);
    }
  } else if (kind == JointKind::universal) {
    const Vec n = r.axis.cross(r.second_axis);
    const Real off = part.axis.dot(part.second_axis) - r.axis.dot(r.second_axis);
    add_rotation(r, guide, n, r.w.dot(r.axis.cross(r.w.cross(r.second_axis))), off, 0);
  }
}

void Tree::assemble(const Motion& guide) {
  matrix_.setZero();
  right_.setZero();
  std::fill(off_place_.begin(), off_place_.end(), Real(0));
  std::fill(off_velocity_.begin(), off_velocity_.end(), Real(0));
  rows_ = 0;
  for (std::size_t i = 0; i < poses_.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(6 * i);
    const Part& part = parts_[i];
    const Pose& b = poses_[i];
    const Mat I = b.R * part.inertia * b.R.transpose();
    matrix_.block<3, 3>(k, k) = part.mass * Mat::Identity();
    matrix_.block<3, 3>(k + 3, k + 3) = I;
    right_.segment<3>(k + 3) = -b.w.cross(I * b.w);
    const int body = static_cast<int>(i);
    add_rows(body, relative(body), guide);
  }
  add_constraint_rows(guide);
  const auto N = static_cast<Eigen::Index>(6 * poses_.size());
  matrix_.topRightCorner(N, rows_) = matrix_.bottomLeftCorner(rows_, N).transpose();
}

}  // namespace differential::reference
