#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "reference_numbers.hpp"
#include "reference_tree.hpp"

namespace differential::reference {

Tree::Frame Tree::at_point(int body, const Vec& at, const State& accelerations) const {
  const Pose& b = poses_[static_cast<std::size_t>(body)];
  const Vec arm = b.R * (at - parts_[static_cast<std::size_t>(body)].centre);
  const Vec dw = accelerations.segment<3>(6 * body + 3);
  const Vec a = accelerations.segment<3>(6 * body);
  return {b.R, b.x + arm, b.v + b.w.cross(arm), a + dw.cross(arm) + b.w.cross(b.w.cross(arm)),
          b.w, dw};
}

Tree::Frame Tree::frame(int index, const Motion& guide, const State& accelerations) const {
  const Vec zero = Vec::Zero();
  if (index == inertial_frame) return {Mat::Identity(), -guide.x, -guide.v, -guide.a, zero, zero};
  if (index == guide_frame) return {guide.R, zero, zero, zero, guide.w, guide.dw};
  return at_point(index, zero, accelerations);
}

namespace {

constexpr Real unknown = std::numeric_limits<Real>::quiet_NaN();

/// The reading of an instrument with errors; unknown if they are random, or if rounding to the
/// resolution is not clear.
Vec misread(const SensorErrors& errors, const Vec& truth) {
  if (errors.is_random()) return Vec::Constant(unknown);
  const Vec turn = wide(errors.misalignment);
  Vec y = truth;
  if (turn.norm() > 0) y = about(turn.normalized(), turn.norm()).transpose() * y;
  y += wide(errors.scale).cwiseProduct(y) + wide(radian(errors.bias, errors.is_in_degrees));
  for (Real& x : y) {
    if (errors.resolution > 0) {
      const Real steps = x / Real(errors.resolution);
      const Real clear = Real(0.5) - std::abs(steps - std::round(steps));
      x = clear > 1e-6L * (1 + std::abs(steps)) ? std::round(steps) * Real(errors.resolution)
                                                : unknown;
    }
    const auto range = Real(errors.range);
    if (range > 0) x = std::isnan(x) ? x : std::min(std::max(x, -range), range);
  }
  return y;
}

/// The place of a body's first number in JointValues.
std::ptrdiff_t first_value(const Scene& scene, int body) {
  std::ptrdiff_t sum = 0;
  for (int i = 0; i < body; ++i) {
    const std::vector<int> own = blocks(scene.bodies[static_cast<std::size_t>(i)].free_kind());
    sum = std::accumulate(own.begin(), own.end(), sum);
  }
  return sum;
}

/// A joint's values as the file has them: attitude and position are relative to the parent.
std::vector<double> joint_reading(const Scene& scene, const JointValues& all, int body) {
  const auto begin = all.begin();
  std::vector<double> own(begin + first_value(scene, body), begin + first_value(scene, body + 1));
  const Body& b = scene.bodies[static_cast<std::size_t>(body)];
  if ((b.kind != JointKind::free && b.kind != JointKind::spherical) || b.loose) return own;
  Eigen::Map<Eigen::Quaterniond> attitude(own.data());
  attitude = unit_quaternion(b.orientation).cast<double>() * attitude;
  if (b.kind == JointKind::free) Eigen::Map<Vector>(own.data() + 4) += b.position;
  return own;
}

/// A quadratic form's principal direction as an angle; unknown for a form that is nearly round
/// against `size`.
Real principal_angle(const Eigen::Matrix<Real, 2, 2>& form, Real size) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<Real, 2, 2>> solver(form);
  const auto spread = solver.eigenvalues()[1] - solver.eigenvalues()[0];
  if (!(spread > 1e-3L * size)) return unknown;
  return std::atan2(solver.eigenvectors()(1, 1), solver.eigenvectors()(0, 1));
}

}  // namespace

Vec Tree::plumb_line(Real t, const Motion& guide, const Vec& pivot, Real length) const {
  const auto apparent = [&](const Vec& x) -> Vec {
    const Vec turn = guide.dw.cross(x) + guide.w.cross(guide.w.cross(x));
    return guide_.gravity(t, guide, x) - guide.a - turn;
  };
  Vec down = apparent(pivot).normalized();
  Real before = 1;
  for (int i = 0; i < 100; ++i) {
    const Vec next = apparent(pivot + length * down).normalized();
    const Real change = (next - down).norm();
    down = next;
    if (change < 1e-17L) return down;
    if (change > before / 2) break;  // it does not hang there
    before = change;
  }
  return Vec::Constant(unknown);
}

Real Tree::azimuth(Real t, const Sensor& sensor, const Motion& guide, const Frame& p) const {
  int first = sensor.body;
  while (parents_[static_cast<std::size_t>(first)] >= 0 &&
         !scene_.bodies[static_cast<std::size_t>(first)].loose) {
    first = parents_[static_cast<std::size_t>(first)];
  }
  const Body& base = scene_.bodies[static_cast<std::size_t>(first)];
  const Vec pivot = guide.R * (base.loose ? Vec(Vec::Zero()) : wide(base.position));
  const Vec r = p.x - pivot;
  const Vec down = plumb_line(t, guide, pivot, r.norm());
  const Mat to_guide = guide.R.transpose();
  const Real upright = std::abs((to_guide * down).z());
  if (!(std::abs(upright - 0.9L) > 1e-9L)) return unknown;
  const Vec axis = guide.R * (upright < 0.9L ? Vec::UnitZ() : Vec::UnitX());
  // The frame of the guide's vertical that does not turn about it.
  const Real turn = down.dot(guide.w);
  const Vec w = guide.w - turn * down;
  const Vec dw = guide.dw - down.dot(guide.dw) * down - turn * guide.w.cross(down);
  const Vec dr = p.v - guide.w.cross(pivot) - w.cross(r);
  const Vec ddr = p.a - guide.dw.cross(pivot) - guide.w.cross(guide.w.cross(pivot)) - dw.cross(r) -
                  w.cross(w.cross(r)) - 2 * w.cross(dr);
  Eigen::Matrix<Real, 2, 3> level;
  level.row(0) = (axis - down.dot(axis) * down).normalized().transpose();
  level.row(1) = down.cross(Vec(level.row(0).transpose())).transpose();
  const Mat form = dr * dr.transpose() - (ddr * r.transpose() + r * ddr.transpose()) / 2;
  // The terms of velocity and acceleration in the guide, which may cancel.
  const Real speed = p.v.norm() + guide.w.norm() * r.norm();
  const Real pull = p.a.norm() + guide.dw.norm() * r.norm() + guide.w.norm() * speed +
                    guide_.gravity(t, guide, pivot).norm() + guide.a.norm();
  const Real reach = r.norm() + 1e-12L * pivot.norm();  // where r is 0 but for rounding
  const Real angle =
      principal_angle(level * form * level.transpose(), speed * speed + pull * reach);
  const bool on_earth = !scene_.guide.empty() && scene_.guide.front().kind == LinkKind::earth;
  return on_earth ? angle + Real(scene_.guide.front().azimuth) * two_pi / 360 : angle;
}

std::vector<double> Tree::readings(Real t, const State& y) {
  const std::vector<double> carried = reactions(t, y);
  const JointValues all_joints = values(t, y);
  State rate(size_);
  rates(t, y, rate);
  const Motion guide = guide_.at(t, y, rate);
  const State accelerations = solution_.head(static_cast<Eigen::Index>(6 * poses_.size()));
  const State multipliers = solution_.tail(rows_);
  assemble(guide);
  std::vector<double> result;
  const auto put = [&result](const auto& numbers) {
    for (Eigen::Index i = 0; i < numbers.size(); ++i) {
      result.push_back(static_cast<double>(numbers[i]));
    }
  };
  const auto put_instrument = [&put](const Sensor& sensor, const Vec& truth) {
    if (sensor.errors) put(misread(*sensor.errors, truth));
    put(truth);
  };
  for (const Sensor& sensor : scene_.sensors) {
    const Frame p = at_point(sensor.body, wide(sensor.at), accelerations);
    const Frame own = frame(sensor.body, guide, accelerations);
    const Frame seen = frame(sensor.against, guide, accelerations);
    const Mat axes = unit_quaternion(sensor.axes).toRotationMatrix().transpose();
    switch (sensor.kind) {
      case SensorKind::gyro: put_instrument(sensor, axes * (own.R.transpose() * own.w)); break;
      case SensorKind::accelerometer:
        put_instrument(
            sensor, axes * (own.R.transpose() * (p.a + guide.a - guide_.gravity(t, guide, p.x))));
        break;
      case SensorKind::joint: {
        const std::vector<double> joint = joint_reading(scene_, all_joints, sensor.body);
        result.insert(result.end(), joint.begin(), joint.end());
        break;
      }
      case SensorKind::azimuth:
        result.push_back(static_cast<double>(azimuth(t, sensor, guide, p)));
        break;
      case SensorKind::point: {
        // By the rates of the components r_A = R_A^t r:  W is the skew matrix of the frame.
        const Mat to_axes = frame(sensor.on, guide, accelerations).R.transpose();
        const auto skew = [](const Vec& w) {
          Mat W;
          W << 0, -w.z(), w.y(), w.z(), 0, -w.x(), -w.y(), w.x(), 0;
          return W;
        };
        const Mat W = skew(seen.w);
        const Vec r = p.x - seen.x;
        const Vec dr = p.v - seen.v;
        put(Vec(to_axes * r));
        put(Vec(to_axes * (dr - W * r)));
        put(Vec(to_axes * (p.a - seen.a - 2 * W * dr + (W * W - skew(seen.dw)) * r)));
        break;
      }
      case SensorKind::attitude: put(Quat(Mat(seen.R.transpose() * own.R)).coeffs()); break;
      case SensorKind::reaction: {
        if (sensor.element >= 0 || sensor.constraint >= 0) {
          const auto [force, torque] = sensor.element >= 0
                                           ? element_reading(sensor, y)
                                           : constraint_reading(sensor, multipliers);
          put(Vec(axes * force));
          put(Vec(axes * torque));
          break;
        }
        const double* const six = carried.data() + 6 * sensor.body;
        const Vec force(six[0], six[1], six[2]);
        const Vec torque(six[3], six[4], six[5]);
        put(Vec(axes * force));
        put(Vec(axes * (torque - wide(sensor.at).cross(force))));
      }
    }
  }
  return result;
}

}  // namespace differential::reference
