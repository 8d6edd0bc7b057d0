#include "reference_tree.hpp"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <utility>

#include "reference_numbers.hpp"

namespace differential::reference {

namespace {

int rows_of(const Body& body, bool held, bool driven) {
  if (held) return 6;
  switch (body.kind) {
    case JointKind::fixed: return 6;
    case JointKind::revolute: return driven ? 6 : 5;
    case JointKind::prismatic: return 5;
    case JointKind::universal: return 4;
    case JointKind::spherical: return 3;
    case JointKind::free: break;
    case JointKind::cylindrical: return 4;
    case JointKind::planar: return 3;
    case JointKind::screw: return 5;
  }
  return 0;
}

/// The first direction in the plane of a planar joint, perpendicular to its axis. It is along the
/// second axis or along the unit vector after the one nearest to the axis.
Vec first_in_plane(const Vec& axis, const Vector& second_axis) {
  Vec along = wide(second_axis);
  if (second_axis.isZero(0)) {
    const Vec size = axis.cwiseAbs();
    const bool x = size.x() >= size.y() && size.x() >= size.z();
    const bool y = !x && size.y() >= size.z();
    along = x ? Vec::UnitY() : y ? Vec::UnitZ() : Vec::UnitX();
  }
  return axis.cross(along).cross(axis).normalized();
}

/// Six masses along the principal axes; the sum of m x x^t is that of the tensor.
Mat six_masses(const Mat& inertia, Real mass) {
  if (!(mass > 0)) return Mat::Zero();
  const Mat second = inertia.trace() / 2 * Mat::Identity() - inertia;
  const Eigen::SelfAdjointEigenSolver<Mat> axes(second);
  Mat masses = axes.eigenvectors();
  for (int k = 0; k < 3; ++k) {
    masses.col(k) *= std::sqrt(std::max<Real>(0, 3 * axes.eigenvalues()[k] / mass));
  }
  return masses;
}

}  // namespace

Tree::Tree(const Scene& scene) : scene_(scene), guide_(scene), poses_(scene.bodies.size()) {
  const auto n = static_cast<Eigen::Index>(scene.bodies.size());
  size_ = guide_.size() + 13 * n;
  Eigen::Index rows = 0;
  for (const Body& body : scene.bodies) {
    Part part;
    part.mass = Real(body.mass);
    part.centre = wide(body.centre);
    part.inertia = tensor(body.inertia);
    part.masses = six_masses(part.inertia, body.mass);
    part.zero = turn_by(body.orientation);
    part.axis = wide(body.axis).normalized();
    part.second_axis = body.kind == JointKind::planar ? first_in_plane(part.axis, body.second_axis)
                                                      : Vec(wide(body.second_axis).normalized());
    part.pitch = Real(body.pitch);
    part.position = wide(body.position);
    part.angles = size_;
    part.held = body.hold || body.kind == JointKind::fixed;
    part.driven = body.drive || (body.rotor && body.rotor->mode == RotorMode::regulated);
    part.speed = body.rotor ? number(body.rotor->speed) : at_or(body.rate, 0);
    size_ += angle_count(body.kind);
    rows += rows_of(body, part.held, part.driven);
    parts_.push_back(part);
    parents_.push_back(body.parent);
  }
  for (const Servo& servo : scene.servos) {
    memories_.push_back({size_});
    if (servo.period > 0) memories_.back().size += servo.whole_periods() + 1;
    size_ += memories_.back().size;
  }
  for (const Constraint& constraint : scene.constraints) {
    holds_.push_back({Mat::Identity(), rows, rows_of(constraint.kind)});
    rows += holds_.back().rows;
  }
  matrix_.resize(6 * n + rows, 6 * n + rows);
  right_.resize(6 * n + rows);
  off_place_.resize(static_cast<std::size_t>(rows));
  off_velocity_.resize(static_cast<std::size_t>(rows));
}

double Tree::work() const {
  const auto n = static_cast<double>(matrix_.rows());
  return n * n * n / 10 + 10 * n * n + 500;
}

State Tree::start() {
  State y = State::Zero(size_);
  guide_.start(y);
  std::vector<Pose> poses(scene_.bodies.size());
  for (int i = 0; i < static_cast<int>(scene_.bodies.size()); ++i) start_body(i, y, poses);
  start_constraints(y);
  sample(Real(scene_.t_begin), y);
  return y;
}

void Tree::start_body(int body, State& y, std::vector<Pose>& poses) {
  State none(size_);
  const Motion guide = guide_.at(Real(scene_.t_begin), y, none);
  const Body& b = scene_.bodies[static_cast<std::size_t>(body)];
  Part& part = parts_[static_cast<std::size_t>(body)];
  const Pose base = b.parent < 0 ? Pose{guide.R, Vec::Zero(), Vec::Zero(), guide.w}
                                 : poses[static_cast<std::size_t>(b.parent)];
  const Vec from =
      b.parent < 0 ? Vec(Vec::Zero()) : parts_[static_cast<std::size_t>(b.parent)].centre;
  Mat turn = part.zero;
  Vec place = part.position;
  Vec v = Vec::Zero();
  Vec w = Vec::Zero();  // on the parent's axes
  const auto angle = [&b](std::size_t i) {
    return i < b.angle.size() ? Real(b.angle[i].radian()) : Real(0);
  };
  switch (b.kind) {
    case JointKind::revolute:
      turn = about(part.axis, angle(0)) * part.zero;
      w = part.axis * part.speed;
      y[part.angles] = angle(0);
      break;
    case JointKind::universal: {
      const Mat first = about(part.axis, angle(0));
      turn = first * about(part.second_axis, angle(1)) * part.zero;
      w = part.axis * at_or(b.rate, 0) + first * part.second_axis * at_or(b.rate, 1);
      y[part.angles] = angle(0);
      y[part.angles + 1] = angle(1);
      break;
    }
    case JointKind::prismatic:
      place += part.axis * at_or(b.displacement, 0);
      v = part.axis * at_or(b.rate, 0);
      break;
    case JointKind::free:
      if (b.place) place = wide(*b.place);
      v = wide(b.velocity);
      [[fallthrough]];
    case JointKind::spherical:
      if (b.attitude) turn = turn_by(b.attitude);
      w = turn * wide(radian(b.angular_velocity, b.turns_in_degrees));
      break;
    case JointKind::cylindrical:
    case JointKind::planar:
    case JointKind::screw: {
      const bool planar = b.kind == JointKind::planar;
      const bool screw = b.kind == JointKind::screw;
      const Real spin = at_or(b.rate, planar ? 2 : 0);
      turn = about(part.axis, angle(0)) * part.zero;
      w = part.axis * spin;
      y[part.angles] = angle(0);
      const Vec along = planar ? part.second_axis : part.axis;
      place += along * (screw ? part.pitch * angle(0) : at_or(b.displacement, 0));
      v = along * (screw ? part.pitch * spin : at_or(b.rate, planar ? 0 : 1));
      if (!planar) break;
      place += part.axis.cross(along) * at_or(b.displacement, 1);
      v += part.axis.cross(along) * at_or(b.rate, 1);
      break;
    }
    case JointKind::fixed: break;
  }
  Pose& pose = poses[static_cast<std::size_t>(body)];
  pose.R = base.R * turn;
  pose.w = base.w + base.R * w;
  const Vec reach = base.R * (place - from);
  const Vec arm = -(pose.R * part.centre);
  pose.x = base.x + reach - arm;
  pose.v = base.v + base.w.cross(reach) + base.R * v - pose.w.cross(arm);
  const Eigen::Index k = at(body);
  y.segment<3>(k) = pose.x;
  y.segment<4>(k + 3) = Quat(pose.R).normalized().coeffs();
  y.segment<3>(k + 7) = pose.v;
  y.segment<3>(k + 10) = pose.R.transpose() * pose.w;
  part.start_turn = part.held && b.kind != JointKind::fixed ? turn : part.zero;
  part.start_place = part.held ? Vec(place - part.position) : Vec(Vec::Zero());
}

Tree::Pose Tree::pose(const State& y, int body) const {
  const Eigen::Index k = at(body);
  Pose result;
  result.R = attitude(y.data() + k + 3).normalized().toRotationMatrix();
  result.x = y.segment<3>(k);
  result.v = y.segment<3>(k + 7);
  result.w = result.R * y.segment<3>(k + 10);
  return result;
}

void Tree::read(const State& y, const Motion& guide) {
  guide_pose_ = {guide.R, Vec::Zero(), Vec::Zero(), guide.w};
  first_angles_.assign(poses_.size(), 0);
  for (std::size_t i = 0; i < poses_.size(); ++i) {
    poses_[i] = pose(y, static_cast<int>(i));
    if (angle_count(scene_.bodies[i].kind) > 0) first_angles_[i] = y[parts_[i].angles];
  }
  set_servo_outputs(y);
}

const Tree::Pose& Tree::parent(int body) const {
  const int index = parents_[static_cast<std::size_t>(body)];
  return index < 0 ? guide_pose_ : poses_[static_cast<std::size_t>(index)];
}

Tree::Relative Tree::relative(int body) const {
  const Part& part = parts_[static_cast<std::size_t>(body)];
  const Pose& b = poses_[static_cast<std::size_t>(body)];
  const Pose& p = parent(body);
  const int index = parents_[static_cast<std::size_t>(body)];
  const Vec from = index < 0 ? Vec(Vec::Zero()) : parts_[static_cast<std::size_t>(index)].centre;
  Relative r;
  r.body = body;
  r.base = index;
  r.arm = -(b.R * part.centre);
  const Vec origin = b.x + r.arm;
  r.reach = origin - p.x;
  r.place = r.reach - p.R * (part.position - from);
  r.off = r.place - p.R * part.start_place;
  r.v = b.v + b.w.cross(r.arm) - p.v - p.w.cross(r.reach);
  r.w = b.w - p.w;
  r.turn = p.R.transpose() * b.R * part.zero.transpose();
  r.axis = p.R * part.axis;
  r.second_axis = b.R * (part.zero.transpose() * part.second_axis);
  r.near = first_angles_[static_cast<std::size_t>(body)];
  return r;
}

std::pair<Real, Real> Tree::angles_of(int body, const Relative& r) const {
  const Part& part = parts_[static_cast<std::size_t>(body)];
  if (is_hinge(scene_.bodies[static_cast<std::size_t>(body)].kind)) {
    const Vec side = across(part.axis).first;
    return {turn_between(part.axis, side, r.turn * side), 0};
  }
  const Real first = turn_between(part.axis, part.second_axis, r.turn * part.second_axis);
  const Mat rest = about(part.axis, first).transpose() * r.turn;
  const Vec side = across(part.second_axis).first;
  return {first, turn_between(part.second_axis, side, rest * side)};
}

std::pair<Vec, Vec> Tree::plane_of(int body, const Relative& r) const {
  const Vec first = parent(body).R * parts_[static_cast<std::size_t>(body)].second_axis;
  return {first, r.axis.cross(first)};
}

// Eigen's blocks are slow in long double, and most factors are 0 here. Columns without a pivot belong
// to conditions that follow from others; their multipliers are 0.
void Tree::solve() {
  const Real least = scene_.constraints.empty() ? 0 : 1e-11L;
  const Eigen::Index n = matrix_.rows();
  pivots_.clear();
  for (Eigen::Index k = 0; k < n; ++k) {
    const auto row = static_cast<Eigen::Index>(pivots_.size());
    Eigen::Index pivot = 0;
    const Real size = matrix_.col(k).tail(n - row).cwiseAbs().maxCoeff(&pivot);
    if (size < least) continue;
    pivots_.push_back(k);
    if (pivot != 0) {
      matrix_.row(row).swap(matrix_.row(row + pivot));
      std::swap(right_[row], right_[row + pivot]);
    }
    for (Eigen::Index i = row + 1; i < n; ++i) {
      const Real factor = matrix_(i, k) / matrix_(row, k);
      if (factor == 0) continue;
      const Real* const from = &matrix_(row, 0);
      Real* const to = &matrix_(i, 0);
      for (Eigen::Index j = k + 1; j < n; ++j) to[j] -= factor * from[j];
      right_[i] -= factor * right_[row];
    }
  }
  solution_.setZero(n);
  for (std::size_t i = pivots_.size(); i-- > 0;) {
    const auto row = static_cast<Eigen::Index>(i);
    const Eigen::Index k = pivots_[i];
    Real sum = right_[row];
    for (Eigen::Index j = k + 1; j < n; ++j) sum -= matrix_(row, j) * solution_[j];
    solution_[k] = sum / matrix_(row, k);
  }
}

void Tree::rates(Real t, const State& y, State& result) {
  result.setZero(size_);
  const Motion guide = guide_.at(t, y, result);
  now_ = t;
  read(y, guide);
  assemble(guide);
  add_forces(t, y, guide);
  solve();
  set_servo_rates(y, result);
  for (int i = 0; i < static_cast<int>(poses_.size()); ++i) {
    const Eigen::Index k = at(i);
    const Vec w = y.segment<3>(k + 10);
    const Quat q = attitude(y.data() + k + 3);
    result.segment<3>(k) = y.segment<3>(k + 7);
    result.segment<4>(k + 3) = (q * Quat(0, w.x() / 2, w.y() / 2, w.z() / 2)).coeffs();
    result.segment<3>(k + 7) = solution_.segment<3>(6 * i);
    const Mat R = poses_[static_cast<std::size_t>(i)].R;
    result.segment<3>(k + 10) = R.transpose() * solution_.segment<3>(6 * i + 3);
    const Part& part = parts_[static_cast<std::size_t>(i)];
    const JointKind kind = scene_.bodies[static_cast<std::size_t>(i)].kind;
    if (angle_count(kind) == 0) continue;
    const Relative r = relative(i);
    const Real left = r.axis.dot(r.w);
    if (is_hinge(kind)) {
      result[part.angles] = left;
      continue;
    }
    const Real c = r.axis.dot(r.second_axis);
    const Real right = r.second_axis.dot(r.w);
    result[part.angles] = (left - c * right) / (1 - c * c);
    result[part.angles + 1] = (right - c * left) / (1 - c * c);
  }
}

void Tree::project(Real t, State& y) {
  guide_.project(y);
  State none(size_);
  const Motion guide = guide_.at(t, y, none);
  now_ = t;
  const auto N = static_cast<Eigen::Index>(6 * poses_.size());
  const auto respond = [&](const std::vector<Real>& off) {
    right_.setZero();
    for (Eigen::Index i = 0; i < rows_; ++i) right_[N + i] = -off[static_cast<std::size_t>(i)];
    solve();
  };
  for (int iteration = 0; iteration < 2; ++iteration) {
    read(y, guide);
    assemble(guide);
    respond(off_place_);
    for (int i = 0; i < static_cast<int>(poses_.size()); ++i) {
      const Eigen::Index k = at(i);
      y.segment<3>(k) += solution_.segment<3>(6 * i);
      const Vec turn = solution_.segment<3>(6 * i + 3) / 2;
      const Quat q = Quat(1, turn.x(), turn.y(), turn.z()) * attitude(y.data() + k + 3);
      y.segment<4>(k + 3) = q.normalized().coeffs();
    }
  }
  read(y, guide);
  assemble(guide);
  respond(off_velocity_);
  for (int i = 0; i < static_cast<int>(poses_.size()); ++i) {
    const Eigen::Index k = at(i);
    y.segment<3>(k + 7) += solution_.segment<3>(6 * i);
    const Mat R = poses_[static_cast<std::size_t>(i)].R;
    y.segment<3>(k + 10) += R.transpose() * solution_.segment<3>(6 * i + 3);
    const Part& part = parts_[static_cast<std::size_t>(i)];
    const JointKind kind = scene_.bodies[static_cast<std::size_t>(i)].kind;
    if (angle_count(kind) == 0) continue;
    const auto [first, second] = angles_of(i, relative(i));
    y[part.angles] = nearest_turn(first, y[part.angles]);
    if (kind == JointKind::universal) {
      y[part.angles + 1] = nearest_turn(second, y[part.angles + 1]);
    }
  }
}

}  // namespace differential::reference
