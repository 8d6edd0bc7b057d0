#include <algorithm>
#include <cmath>

#include "reference_numbers.hpp"
#include "reference_tree.hpp"

/// The results of the independent integrator.

namespace differential::reference {

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
  const State multipliers = solution_.tail(rows_);
  assemble(guide);
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
  add_servos(false);
  add_constraint_forces(multipliers);
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
