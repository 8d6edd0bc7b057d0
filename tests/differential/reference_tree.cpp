#include "reference_tree.hpp"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <utility>

namespace differential::reference {

namespace {

constexpr Real two_pi = 2 * 3.14159265358979323846264338327950288L;

Vec wide(const Vector& v) { return v.cast<Real>(); }

Mat turn_by(const std::optional<Eigen::Vector4d>& q) {
  return unit_quaternion(q).toRotationMatrix();
}

Mat about(const Vec& axis, Real angle) {
  return Eigen::AngleAxis<Real>(angle, axis).toRotationMatrix();
}

Mat tensor(const std::vector<double>& t) {
  Mat result = Mat::Zero();
  for (int i = 0; i < 3; ++i) result(i, i) = Real(t[static_cast<std::size_t>(i)]);
  if (t.size() == 6) {
    result(0, 1) = result(1, 0) = Real(t[3]);
    result(0, 2) = result(2, 0) = Real(t[4]);
    result(1, 2) = result(2, 1) = Real(t[5]);
  }
  return result;
}

Quat attitude(const Real* q) { return {q[3], q[0], q[1], q[2]}; }

/// Two unit vectors perpendicular to a third.
std::pair<Vec, Vec> across(const Vec& axis) {
  const Vec first = axis.unitOrthogonal();
  return {first, axis.cross(first)};
}

/// The angle of rotation from `from` to `to` about `axis`.
Real turn_between(const Vec& axis, const Vec& from, const Vec& to) {
  const Vec a = from - axis.dot(from) * axis;
  const Vec b = to - axis.dot(to) * axis;
  return std::atan2(axis.dot(a.cross(b)), a.dot(b));
}

Real number(double x) { return Real(x); }
Real number(const Angle& angle) { return Real(angle.radian()); }

template <class T>
Real at_or(const std::vector<T>& list, std::size_t i) {
  return i < list.size() ? number(list[i]) : Real(0);
}

Real nearest_turn(Real measured, Real near) {
  return near + std::remainder(measured - near, two_pi);
}

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

/// True if a joint rotates about `axis` alone.
bool is_hinge(JointKind kind) {
  return kind == JointKind::revolute || kind == JointKind::cylindrical ||
         kind == JointKind::planar || kind == JointKind::screw;
}

int angle_count(JointKind kind) {
  if (kind == JointKind::universal) return 2;
  return is_hinge(kind) ? 1 : 0;
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
  r.arm = -(b.R * part.centre);
  const Vec origin = b.x + r.arm;
  r.reach = origin - p.x;
  r.place = r.reach - p.R * (part.position - from);
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

Vec Tree::turned_off(int body, const Relative& r) const {
  const Part& part = parts_[static_cast<std::size_t>(body)];
  const Mat wanted = part.start_turn * part.zero.transpose();  // of r.turn
  Quat q(Mat(r.turn * wanted.transpose()));
  if (q.w() < 0) q.coeffs() = -q.coeffs();
  return parent(body).R * (2 * q.vec());
}

void Tree::add_translation(int body, const Relative& r, const Motion& guide, const Vec& n) {
  const auto N = static_cast<Eigen::Index>(6 * poses_.size());
  const Eigen::Index row = N + rows_;
  const Pose& b = poses_[static_cast<std::size_t>(body)];
  const Pose& p = parent(body);
  const int index = parents_[static_cast<std::size_t>(body)];
  const auto put = [&](int to, const Vec& force, const Vec& torque) {
    matrix_.block<1, 3>(row, 6 * to) += force.transpose();
    matrix_.block<1, 3>(row, 6 * to + 3) += torque.transpose();
  };
  put(body, n, r.arm.cross(n));
  right_[row] +=
      n.dot(p.w.cross(p.w.cross(r.reach)) + 2 * p.w.cross(r.v) - b.w.cross(b.w.cross(r.arm)));
  if (index >= 0) {
    put(index, -n, -r.reach.cross(n));
  } else {
    right_[row] += n.dot(guide.dw.cross(r.reach));
  }
  const auto at_row = static_cast<std::size_t>(rows_);
  off_place_[at_row] += n.dot(r.place - p.R * parts_[static_cast<std::size_t>(body)].start_place);
  off_velocity_[at_row] += n.dot(r.v);
  rows_ += 1;
}

void Tree::add_rotation(int body, const Relative& r, const Motion& guide, const Vec& n, Real extra,
                        Real off, Real speed) {
  const auto N = static_cast<Eigen::Index>(6 * poses_.size());
  const Eigen::Index row = N + rows_;
  const int index = parents_[static_cast<std::size_t>(body)];
  matrix_.block<1, 3>(row, 6 * body + 3) += n.transpose();
  const Pose& p = parent(body);
  right_[row] += n.dot(p.w.cross(poses_[static_cast<std::size_t>(body)].w)) - extra;
  if (index >= 0) {
    matrix_.block<1, 3>(row, 6 * index + 3) -= n.transpose();
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
    add_translation(body, r, guide, r.axis);
  } else if (!part.held && slides_along) {
    add_translation(body, r, guide, first);
    add_translation(body, r, guide, second);
  } else {
    for (int i = 0; i < 3; ++i) add_translation(body, r, guide, Vec::Unit(i));
  }
  if (stiff) {
    const Vec off = turned_off(body, r);
    for (int i = 0; i < 3; ++i) add_rotation(body, r, guide, Vec::Unit(i), 0, off[i], 0);
  } else if (is_hinge(kind)) {
    const Vec image = parent(body).R * (r.turn * part.axis);
    const Vec off = r.axis.cross(image);
    add_rotation(body, r, guide, first, 0, off.dot(first), 0);
    add_rotation(body, r, guide, second, 0, off.dot(second), 0);
    if (part.driven) {
      const auto [speed, acceleration] = drive(body);
      add_rotation(body, r, guide, r.axis, -acceleration, 0, speed);
    }
    if (kind == JointKind::screw) {
      // One row: the advance less the pitch times the angle.
      const Real turned = nearest_turn(angles_of(body, r).first, r.near);
      add_translation(body, r, guide, r.axis);
      rows_ -= 1;
      add_rotation(body, r, guide, -part.pitch * r.axis, 0, -part.pitch * turned, 0);
    }
  } else if (kind == JointKind::universal) {
    const Vec n = r.axis.cross(r.second_axis);
    const Real off = part.axis.dot(part.second_axis) - r.axis.dot(r.second_axis);
    add_rotation(body, r, guide, n, r.w.dot(r.axis.cross(r.w.cross(r.second_axis))), off, 0);
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
  const auto N = static_cast<Eigen::Index>(6 * poses_.size());
  matrix_.topRightCorner(N, rows_) = matrix_.bottomLeftCorner(rows_, N).transpose();
}

/// Gravity on the centre of mass, or on six masses: the neglected terms are of fourth order in the
/// size.
void Tree::add_gravity(int body, Real t, const Motion& guide) {
  const Part& part = parts_[static_cast<std::size_t>(body)];
  const Pose& b = poses_[static_cast<std::size_t>(body)];
  if (!(part.mass > 0)) return;
  if (!guide_.has_gradient()) {
    right_.segment<3>(6 * body) += part.mass * (guide_.gravity(t, guide, b.x) - guide.a);
    return;
  }
  for (int k = 0; k < 6; ++k) {
    const Vec reach = (k % 2 == 0 ? 1 : -1) * (b.R * part.masses.col(k / 2));
    const Vec force = part.mass / 6 * (guide_.gravity(t, guide, b.x + reach) - guide.a);
    right_.segment<3>(6 * body) += force;
    right_.segment<3>(6 * body + 3) += reach.cross(force);
  }
}

void Tree::add_torque(int body, const Vec& torque) {
  right_.segment<3>(6 * body + 3) += torque;
  const int index = parents_[static_cast<std::size_t>(body)];
  if (index >= 0) right_.segment<3>(6 * index + 3) -= torque;
}

void Tree::add_force(int body, const Relative& r, const Vec& force) {
  right_.segment<3>(6 * body) += force;
  right_.segment<3>(6 * body + 3) += r.arm.cross(force);
  const int index = parents_[static_cast<std::size_t>(body)];
  if (index < 0) return;
  right_.segment<3>(6 * index) -= force;
  right_.segment<3>(6 * index + 3) -= r.reach.cross(force);
}

/// Drag of a medium that moves with the guide.
void Tree::add_drag(const Load& load, int body, const Motion& guide) {
  const Pose& b = poses_[static_cast<std::size_t>(body)];
  const Vec lever = b.R * (wide(load.point) - parts_[static_cast<std::size_t>(body)].centre);
  const Vec v = b.R.transpose() * (b.v + b.w.cross(lever) - guide.w.cross(b.x + lever));
  const Vec w = b.R.transpose() * (b.w - guide.w);
  const Vec force = -(b.R * (wide(load.linear) + v.norm() * wide(load.quadratic)).cwiseProduct(v));
  right_.segment<3>(6 * body) += force;
  right_.segment<3>(6 * body + 3) += lever.cross(force) - b.R * wide(load.angular).cwiseProduct(w);
}

void Tree::add_load(Real t, const Load& load, int body, const Motion& guide) {
  if (load.kind == LoadKind::drag) return add_drag(load, body, guide);
  if (load.kind == LoadKind::magnet) {
    const Mat R = poses_[static_cast<std::size_t>(body)].R;
    right_.segment<3>(6 * body + 3) +=
        (R * wide(load.moment)).cross(guide.R * course_of(load.field, t, within_).value);
    return;
  }
  const Pose& b = poses_[static_cast<std::size_t>(body)];
  const Mat axes = load.axes == Axes::body    ? b.R
                   : load.axes == Axes::guide ? guide.R
                                              : Mat(Mat::Identity());
  const bool is_timed = !load.force_in_time.empty();
  const Vec force =
      axes * (is_timed ? course_of(load.force_in_time, t, within_).value : wide(load.force));
  const Vec lever = b.R * (wide(load.point) - parts_[static_cast<std::size_t>(body)].centre);
  right_.segment<3>(6 * body) += force;
  right_.segment<3>(6 * body + 3) += axes * wide(load.torque) + lever.cross(force);
}

void Tree::add_joint_force(Real t, int body, const State& y) {
  const Body& b = scene_.bodies[static_cast<std::size_t>(body)];
  const Part& part = parts_[static_cast<std::size_t>(body)];
  const bool is_timed = !b.force_in_time.empty();
  if (b.stiffness.empty() && b.damping.empty() && b.force.empty() && !b.rotor && !is_timed) return;
  const Relative r = relative(body);
  const auto force = [&](std::size_t i, Real q, Real rate) {
    const auto one = [i](const auto& list) { return at_or(list, list.size() == 1 ? 0 : i); };
    const Real given = is_timed ? course_of(b.force_in_time, t, within_).value.x() : one(b.force);
    return given - one(b.stiffness) * (q - one(b.rest)) - one(b.damping) * rate;
  };
  if (b.kind == JointKind::spherical) {
    add_torque(body, -at_or(b.damping, 0) * r.w);
  } else if (b.kind == JointKind::revolute) {
    Real motor = 0;
    if (b.rotor && b.rotor->mode == RotorMode::torque) {
      const Signal& torque = b.rotor->torque_in_time;
      motor = torque.empty() ? Real(b.rotor->torque) : course_of(torque, t, within_).value.x();
    }
    add_torque(body, (motor + force(0, y[part.angles], r.axis.dot(r.w))) * r.axis);
  } else if (b.kind == JointKind::prismatic) {
    add_force(body, r, force(0, r.axis.dot(r.place), r.axis.dot(r.v)) * r.axis);
  } else if (b.kind == JointKind::cylindrical) {
    add_torque(body, force(0, y[part.angles], r.axis.dot(r.w)) * r.axis);
    add_force(body, r, force(1, r.axis.dot(r.place), r.axis.dot(r.v)) * r.axis);
  } else if (b.kind == JointKind::planar) {
    const auto [first, second] = plane_of(body, r);
    add_force(body, r, force(0, first.dot(r.place), first.dot(r.v)) * first);
    add_force(body, r, force(1, second.dot(r.place), second.dot(r.v)) * second);
    add_torque(body, force(2, y[part.angles], r.axis.dot(r.w)) * r.axis);
  } else if (b.kind == JointKind::screw) {
    add_torque(body, force(0, y[part.angles], r.axis.dot(r.w)) * r.axis);
  } else if (b.kind == JointKind::universal) {
    // A torque in the plane of both axes that does the work of both forces.
    const Real c = r.axis.dot(r.second_axis);
    const Real left = r.axis.dot(r.w);
    const Real right = r.second_axis.dot(r.w);
    const Real d = 1 - c * c;
    const Real first = force(0, y[part.angles], (left - c * right) / d);
    const Real second = force(1, y[part.angles + 1], (right - c * left) / d);
    add_torque(body, (first - c * second) / d * r.axis + (second - c * first) / d * r.second_axis);
  }
}

void Tree::add_forces(Real t, const State& y, const Motion& guide) {
  for (int i = 0; i < static_cast<int>(poses_.size()); ++i) {
    const Part& part = parts_[static_cast<std::size_t>(i)];
    add_gravity(i, t, guide);
    for (const Load& load : scene_.bodies[static_cast<std::size_t>(i)].loads) {
      add_load(t, load, i, guide);
    }
    if (!part.held) add_joint_force(t, i, y);
  }
  add_elements();
  add_gears(y);
}

// Eigen's blocks are slow in long double, and most factors are 0 here.
void Tree::solve() {
  const Eigen::Index n = matrix_.rows();
  for (Eigen::Index k = 0; k < n; ++k) {
    Eigen::Index pivot = 0;
    matrix_.col(k).tail(n - k).cwiseAbs().maxCoeff(&pivot);
    if (pivot != 0) {
      matrix_.row(k).swap(matrix_.row(k + pivot));
      std::swap(right_[k], right_[k + pivot]);
    }
    for (Eigen::Index i = k + 1; i < n; ++i) {
      const Real factor = matrix_(i, k) / matrix_(k, k);
      if (factor == 0) continue;
      const Real* const from = &matrix_(k, 0);
      Real* const to = &matrix_(i, 0);
      for (Eigen::Index j = k + 1; j < n; ++j) to[j] -= factor * from[j];
      right_[i] -= factor * right_[k];
    }
  }
  solution_.resize(n);
  for (Eigen::Index k = n; k-- > 0;) {
    Real sum = right_[k];
    for (Eigen::Index j = k + 1; j < n; ++j) sum -= matrix_(k, j) * solution_[j];
    solution_[k] = sum / matrix_(k, k);
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

Sizes Tree::sizes(Real t, const State& y) {
  State none(size_);
  const Motion guide = guide_.at(t, y, none);
  read(y, guide);
  Sizes sum;
  for (std::size_t i = 0; i < poses_.size(); ++i) {
    const Part& part = parts_[i];
    const Pose& b = poses_[i];
    const Body& body = scene_.bodies[i];
    const Vec spin = part.inertia * (b.R.transpose() * b.w);
    const Real g = guide_.gravity(t, guide, b.x).norm();
    sum.energy += part.mass * (b.v.squaredNorm() / 2 + g * guide_.depth(guide, b.x)) +
                  b.w.norm() * spin.norm();
    sum.momentum += part.mass * b.v.norm() * (1 + b.x.norm()) + spin.norm();
    for (const Load& load : body.loads) {
      sum.energy += wide(load.moment).norm() * course_of(load.field, t, t).value.norm();
    }
    for (std::size_t k = 0; k < body.stiffness.size(); ++k) {
      const Eigen::Index angle = body.kind == JointKind::universal ? Eigen::Index(k) : 0;
      Real stretch = angle_count(body.kind) > 0 ? std::abs(y[part.angles + angle]) : 0;
      if (slides(body.kind)) stretch += relative(static_cast<int>(i)).place.norm();
      const Real whole = stretch + std::abs(at_or(body.rest, k));
      sum.energy += std::abs(Real(body.stiffness[k])) * whole * whole;
    }
  }
  for (const Element& element : scene_.elements) sum.energy += element_energy(element, y);
  return sum;
}

std::vector<double> Tree::reactions(Real t, const State& y) {
  State rate(size_);
  rates(t, y, rate);
  const Motion guide = guide_.at(t, y, rate);
  const auto n = static_cast<Eigen::Index>(poses_.size());
  const State accelerations = solution_.head(6 * n);
  // The remaining terms of each body's balance without its joints, about its centre of mass.
  right_.setZero();
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto at_body = static_cast<std::size_t>(i);
    const Part& part = parts_[at_body];
    const Pose& b = poses_[at_body];
    const Mat I = b.R * part.inertia * b.R.transpose();
    add_gravity(static_cast<int>(i), t, guide);
    right_.segment<3>(6 * i) -= part.mass * accelerations.segment<3>(6 * i);
    right_.segment<3>(6 * i + 3) -= I * accelerations.segment<3>(6 * i + 3) + b.w.cross(I * b.w);
    for (const Load& load : scene_.bodies[at_body].loads) {
      add_load(t, load, static_cast<int>(i), guide);
    }
  }
  add_elements();
  std::vector<double> result(static_cast<std::size_t>(6 * n));
  for (Eigen::Index i = n; i-- > 0;) {
    const Relative r = relative(static_cast<int>(i));
    const Vec force = -right_.segment<3>(6 * i);
    const Vec torque = -right_.segment<3>(6 * i + 3) - r.arm.cross(force);
    const int parent = parents_[static_cast<std::size_t>(i)];
    if (parent >= 0) {
      right_.segment<3>(6 * parent) -= force;
      right_.segment<3>(6 * parent + 3) -= torque + r.reach.cross(force);
    }
    const Mat to_body = poses_[static_cast<std::size_t>(i)].R.transpose();
    const auto begin = result.begin() + 6 * i;
    const Vec on_axes[] = {to_body * force, to_body * torque};
    for (int k = 0; k < 6; ++k) *(begin + k) = static_cast<double>(on_axes[k / 3][k % 3]);
  }
  return result;
}

State Tree::free_values(int body, const Motion& guide) const {
  const Pose& b = poses_[static_cast<std::size_t>(body)];
  const Vec arm = -(b.R * parts_[static_cast<std::size_t>(body)].centre);
  const Vec x = b.x + arm;
  const Vec v = b.v + b.w.cross(arm) - guide.w.cross(x);
  const Mat to_guide = guide.R.transpose();
  State result(13);
  result << Quat(Mat(to_guide * b.R)).coeffs(), to_guide * x, b.R.transpose() * (b.w - guide.w),
      to_guide * v;
  return result;
}

JointValues Tree::values(Real t, const State& y) {
  State none(size_);
  read(y, guide_.at(t, y, none));
  JointValues result;
  const auto put = [&result](Real x) { result.push_back(static_cast<double>(x)); };
  const auto put_all = [&put](const auto& v) {
    for (Eigen::Index i = 0; i < v.size(); ++i) put(v[i]);
  };
  for (int i = 0; i < static_cast<int>(poses_.size()); ++i) {
    if (scene_.bodies[static_cast<std::size_t>(i)].loose) {
      put_all(free_values(i, guide_.at(t, y, none)));
      continue;
    }
    const Relative r = relative(i);
    const Part& part = parts_[static_cast<std::size_t>(i)];
    const Mat P = parent(i).R;
    const Real left = r.axis.dot(r.w);
    const Real right = r.second_axis.dot(r.w);
    const Real c = r.axis.dot(r.second_axis);
    switch (scene_.bodies[static_cast<std::size_t>(i)].kind) {
      case JointKind::fixed: break;
      case JointKind::revolute:
      case JointKind::screw:
        put(y[part.angles]);
        put(left);
        break;
      case JointKind::cylindrical:
        put(y[part.angles]);
        put(r.axis.dot(r.place));
        put(left);
        put(r.axis.dot(r.v));
        break;
      case JointKind::planar: {
        const auto [first, second] = plane_of(i, r);
        put(first.dot(r.place));
        put(second.dot(r.place));
        put(y[part.angles]);
        put(first.dot(r.v));
        put(second.dot(r.v));
        put(left);
        break;
      }
      case JointKind::prismatic:
        put(r.axis.dot(r.place));
        put(r.axis.dot(r.v));
        break;
      case JointKind::universal:
        put(y[part.angles]);
        put(y[part.angles + 1]);
        put((left - c * right) / (1 - c * c));
        put((right - c * left) / (1 - c * c));
        break;
      case JointKind::spherical:
      case JointKind::free: {
        const Mat R = poses_[static_cast<std::size_t>(i)].R;
        put_all(Quat(Mat(part.zero.transpose() * P.transpose() * R)).coeffs());
        const bool free = scene_.bodies[static_cast<std::size_t>(i)].kind == JointKind::free;
        if (free) put_all(Vec(P.transpose() * r.place));
        put_all(Vec(R.transpose() * r.w));
        if (free) put_all(Vec(P.transpose() * r.v));
      }
    }
  }
  return result;
}

}  // namespace differential::reference
