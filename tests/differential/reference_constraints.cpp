#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/SVD>

#include <cmath>

#include "reference_numbers.hpp"
#include "reference_tree.hpp"

/// Constraints in maximal coordinates: their conditions differentiated to accelerations, on inertial
/// axes.

namespace differential::reference {

Tree::Relative Tree::between(const Constraint& c) const {
  const Pose a = pose_of(c.bodies[0]);
  const Pose b = pose_of(c.bodies[1]);
  Relative r;
  r.body = c.bodies[1];
  r.base = c.bodies[0];
  r.arm = b.R * (wide(c.at[1]) - centre_of(r.body));
  r.reach = b.x + r.arm - a.x;
  r.place = r.off = r.reach - a.R * (wide(c.at[0]) - centre_of(r.base));
  r.v = b.v + b.w.cross(r.arm) - a.v - a.w.cross(r.reach);
  r.w = b.w - a.w;
  r.axis = a.R * wide(c.axis).normalized();
  r.second_axis = b.R * wide(c.second_axis).normalized();
  return r;
}

void Tree::start_constraints(const State& y) {
  State none(size_);
  read(y, guide_.at(Real(scene_.t_begin), y, none));
  for (std::size_t i = 0; i < holds_.size(); ++i) {
    const auto& [first, second] = scene_.constraints[i].bodies;
    holds_[i].attitude = pose_of(first).R.transpose() * pose_of(second).R;
  }
}

void Tree::add_constraint_rows(const Motion& guide) {
  for (std::size_t i = 0; i < holds_.size(); ++i) {
    const Constraint& c = scene_.constraints[i];
    switch (c.kind) {
      case ConstraintKind::distance: add_distance(c, guide); break;
      case ConstraintKind::gear: add_gear_row(c, guide); break;
      case ConstraintKind::rolling: add_rolling_rows(c, guide); break;
      case ConstraintKind::blade: add_blade_row(c, guide); break;
      default: add_joint_rows(c, holds_[i], guide);
    }
  }
}

void Tree::add_joint_rows(const Constraint& c, const Hold& hold, const Motion& guide) {
  const Relative r = between(c);
  if (c.kind == ConstraintKind::prismatic) {
    const auto [first, second] = across(r.axis);
    add_translation(r, guide, first);
    add_translation(r, guide, second);
  } else {
    for (int i = 0; i < 3; ++i) add_translation(r, guide, Vec::Unit(i));
  }
  if (c.kind == ConstraintKind::fixed || c.kind == ConstraintKind::prismatic) {
    add_equal_attitude(r, hold, guide);
  }
  if (c.kind == ConstraintKind::revolute) {
    const Vec image = pose_of(r.body).R * (hold.attitude.transpose() * wide(c.axis).normalized());
    add_parallel(r, guide, r.axis, image);
  }
  if (c.kind == ConstraintKind::universal) {
    const Vec n = r.axis.cross(r.second_axis);
    const Real extra = r.w.dot(r.axis.cross(r.w.cross(r.second_axis)));
    add_rotation(r, guide, n, extra, -r.axis.dot(r.second_axis), 0);
  }
}

void Tree::add_parallel(const Relative& r, const Motion& guide, const Vec& axis, const Vec& image) {
  const auto [first, second] = across(axis);
  const Vec off = axis.cross(image);
  add_rotation(r, guide, first, 0, off.dot(first), 0);
  add_rotation(r, guide, second, 0, off.dot(second), 0);
}

void Tree::add_equal_attitude(const Relative& r, const Hold& hold, const Motion& guide) {
  const Mat R = pose_of(r.base).R;
  Quat q(Mat(R.transpose() * pose_of(r.body).R * hold.attitude.transpose()));
  if (q.w() < 0) q.coeffs() = -q.coeffs();
  const Vec off = R * (2 * q.vec());
  for (int i = 0; i < 3; ++i) add_rotation(r, guide, Vec::Unit(i), 0, off[i], 0);
}

/// (d.d - L^2)/2L = 0, and differentiated twice d.d''/L + d'.d'/L = 0.
void Tree::add_distance(const Constraint& c, const Motion& guide) {
  const Relative r = between(c);
  const auto L = Real(c.length);
  const auto row = static_cast<Eigen::Index>(6 * poses_.size()) + rows_;
  const auto at_row = static_cast<std::size_t>(rows_);
  add_translation(r, guide, r.place / L);
  right_[row] -= r.v.squaredNorm() / L;
  off_place_[at_row] = (r.place.squaredNorm() - L * L) / (2 * L);
}

/// q_a - ratio q_b = offset: one row, made of both.
void Tree::add_gear_row(const Constraint& c, const Motion& guide) {
  const auto at_row = static_cast<std::size_t>(rows_);
  const Real factors[] = {1, -Real(c.ratio)};
  off_place_[at_row] = -Real(c.offset);
  for (std::size_t i = 0; i < 2; ++i) {
    const int body = c.bodies[i];
    const Relative r = relative(body);
    const Vec along = factors[i] * r.axis;
    if (scene_.bodies[static_cast<std::size_t>(body)].kind == JointKind::prismatic) {
      add_translation(r, guide, along);
    } else {
      const Real angle = nearest_turn(angles_of(body, r).first, r.near);
      add_rotation(r, guide, along, 0, factors[i] * angle, 0);
    }
    rows_ -= 1;
  }
  rows_ += 1;
}

void Tree::add_contact(const std::array<int, 2>& bodies, const Vec& point, const Vec& dpoint,
                       const Vec& n, const Vec& dn, const Motion& guide) {
  const auto N = static_cast<Eigen::Index>(6 * poses_.size());
  const Eigen::Index row = N + rows_;
  const Pose a = pose_of(bodies[0]);
  const Pose b = pose_of(bodies[1]);
  const Vec reach_a = point - a.x;
  const Vec reach_b = point - b.x;
  const Vec slip = b.v + b.w.cross(reach_b) - a.v - a.w.cross(reach_a);
  matrix_.block<1, 3>(row, 6 * bodies[1]) = n.transpose();
  matrix_.block<1, 3>(row, 6 * bodies[1] + 3) = reach_b.cross(n).transpose();
  right_[row] = -n.dot(b.w.cross(dpoint - b.v) - a.w.cross(dpoint - a.v)) - dn.dot(slip);
  if (bodies[0] >= 0) {
    matrix_.block<1, 3>(row, 6 * bodies[0]) = -n.transpose();
    matrix_.block<1, 3>(row, 6 * bodies[0] + 3) = -reach_a.cross(n).transpose();
  } else {
    right_[row] += n.dot(guide.dw.cross(reach_a));
  }
  off_velocity_[static_cast<std::size_t>(rows_)] = n.dot(slip);
  rows_ += 1;
}

std::pair<Vec, Vec> Tree::contact_of(const Constraint& c) const {
  const Pose on = pose_of(c.bodies[0]);
  const Pose b = pose_of(c.bodies[1]);
  const Vec n = on.R * wide(c.normal).normalized();
  const Vec dn = on.w.cross(n);
  const Vec arm = b.R * (wide(c.at[1]) - centre_of(c.bodies[1]));
  const Vec centre = b.x + arm;
  const Vec dcentre = b.v + b.w.cross(arm);
  const auto radius = Real(c.radius);
  if (c.is_ball) return {centre - radius * n, dcentre - radius * dn};
  const Vec a = b.R * wide(c.axis).normalized();
  const Vec da = b.w.cross(a);
  const Vec across_axis = n - n.dot(a) * a;
  const Vec change = dn - (dn.dot(a) + n.dot(da)) * a - n.dot(a) * da;
  const Real size = across_axis.norm();
  const Vec e = across_axis / size;
  const Vec de = (change - e.dot(change) * e) / size;
  return {centre - radius * e - Real(c.tube) * n, dcentre - radius * de - Real(c.tube) * dn};
}

void Tree::add_rolling_rows(const Constraint& c, const Motion& guide) {
  const Pose on = pose_of(c.bodies[0]);
  const auto [point, dpoint] = contact_of(c);
  const Vec n = on.R * wide(c.normal).normalized();
  const Vec of_plane = on.x + on.R * (wide(c.at[0]) - centre_of(c.bodies[0]));
  off_place_[static_cast<std::size_t>(rows_)] = n.dot(point - of_plane);
  const auto [first, second] = across(n);
  for (const Vec& e : {n, first, second}) {
    add_contact(c.bodies, point, dpoint, e, on.w.cross(e), guide);
  }
}

void Tree::add_blade_row(const Constraint& c, const Motion& guide) {
  const Pose b = pose_of(c.bodies[1]);
  const Vec arm = b.R * (wide(c.at[1]) - centre_of(c.bodies[1]));
  const Vec e = b.R * wide(c.axis).normalized();
  add_contact(c.bodies, b.x + arm, b.v + b.w.cross(arm), e, b.w.cross(e), guide);
}

void Tree::add_constraint_forces(const State& multipliers) {
  const auto N = static_cast<Eigen::Index>(6 * poses_.size());
  for (std::size_t i = 0; i < holds_.size(); ++i) {
    if (scene_.constraints[i].kind == ConstraintKind::gear) continue;  // a force in the joints
    const Hold& hold = holds_[i];
    right_.head(N) -= matrix_.block(N + hold.first_row, 0, hold.rows, N).transpose() *
                      multipliers.segment(hold.first_row, hold.rows);
  }
}

std::pair<Vec, Vec> Tree::constraint_reading(const Sensor& sensor, const State& multipliers) {
  const auto index = static_cast<std::size_t>(sensor.constraint);
  const Constraint& c = scene_.constraints[index];
  const Hold& hold = holds_[index];
  const Mat to_first = pose_of(c.bodies[0]).R.transpose();
  const Pose b = pose_of(c.bodies[1]);
  const Vec given = b.x + b.R * (wide(sensor.at) - centre_of(c.bodies[1]));
  if (c.kind == ConstraintKind::gear) {
    const Vec along = Real(c.ratio) * multipliers[hold.first_row] * relative(c.bodies[1]).axis;
    const bool is_slide =
        scene_.bodies[static_cast<std::size_t>(c.bodies[1])].kind == JointKind::prismatic;
    if (!is_slide) return {Vec::Zero(), to_first * along};
    const Vec origin = b.x - b.R * centre_of(c.bodies[1]);
    return {to_first * along, to_first * (origin - given).cross(along)};
  }
  // Force and torque on one of the bodies, about its centre of mass.
  const bool on_second = c.bodies[1] >= 0;
  const int body = on_second ? c.bodies[1] : c.bodies[0];
  const auto N = static_cast<Eigen::Index>(6 * poses_.size());
  const State six = (on_second ? -1 : 1) *
                    matrix_.block(N + hold.first_row, 6 * body, hold.rows, 6).transpose() *
                    multipliers.segment(hold.first_row, hold.rows);
  const Vec own =
      c.kind == ConstraintKind::rolling ? contact_of(c).first : Vec(b.x + between(c).arm);
  const Vec point = sensor.at.isZero(0) ? own : given;
  const Vec force = six.head<3>();
  const Vec torque = six.tail<3>() - (point - pose_of(body).x).cross(force);
  return {to_first * force, to_first * torque};
}

std::vector<std::pair<Mat, Vec>> Tree::start_poses() {
  const State y = start();
  State none(size_);
  const Motion guide = guide_.at(Real(scene_.t_begin), y, none);
  read(y, guide);
  std::vector<std::pair<Mat, Vec>> result;
  for (std::size_t i = 0; i < poses_.size(); ++i) {
    const Pose& b = poses_[i];
    const Mat to_guide = guide.R.transpose();
    result.emplace_back(to_guide * b.R, to_guide * (b.x - b.R * parts_[i].centre));
  }
  return result;
}

void Tree::assemble_start() {
  const State y = start();
  State none(size_);
  const Motion guide = guide_.at(Real(scene_.t_begin), y, none);
  now_ = Real(scene_.t_begin);
  read(y, guide);
  assemble(guide);
}

Eigen::VectorXd Tree::condition_values() {
  assemble_start();
  const auto N = static_cast<Eigen::Index>(6 * poses_.size());
  Eigen::MatrixXd rows = matrix_.bottomLeftCorner(rows_, N).cast<double>();
  rows.rowwise().normalize();
  Eigen::VectorXd values = Eigen::VectorXd::Zero(rows_);
  const Eigen::VectorXd some = Eigen::JacobiSVD<Eigen::MatrixXd>(rows).singularValues();
  values.head(some.size()) = some;
  return values;
}

bool Tree::has_idle_motion() {
  assemble_start();
  const auto N = static_cast<Eigen::Index>(6 * poses_.size());
  const Eigen::MatrixXd rows = matrix_.bottomLeftCorner(rows_, N).cast<double>();
  const Eigen::MatrixXd mass = matrix_.topLeftCorner(N, N).cast<double>();
  const Eigen::MatrixXd free =
      rows_ > 0 ? Eigen::MatrixXd(Eigen::FullPivLU<Eigen::MatrixXd>(rows).kernel())
                : Eigen::MatrixXd(Eigen::MatrixXd::Identity(N, N));
  const Eigen::MatrixXd on_free = free.transpose() * mass * free;
  const Eigen::VectorXd moved =
      Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(on_free).eigenvalues();
  return moved[0] <= 1e-12 * moved[moved.size() - 1];
}

}  // namespace differential::reference
