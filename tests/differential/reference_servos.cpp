#include <algorithm>
#include <cmath>

#include "reference_numbers.hpp"
#include "reference_tree.hpp"

/// Servos: the formulas of docs/scene_files.md, written once more.

namespace differential::reference {

namespace {

/// True if t is one of the times begin + k period.
bool is_due(Real t, Real begin, double period) {
  const Real k = std::round((t - begin) / Real(period));
  return k >= 0 && std::abs(begin + k * Real(period) - t) <= 1e-13L * std::max<Real>(1e-3L, t);
}

/// The output within its limit.
Real limited(const Servo& servo, Real u) {
  return servo.limit > 0 ? std::clamp(u, -Real(servo.limit), Real(servo.limit)) : u;
}

/// How far an output is beyond its limit, if the integral of e would drive it further; else 0.
Real winds_up(const Servo& servo, Real u, Real e) {
  const bool drives = servo.limit > 0 && u * Real(servo.integral) * e > 0;
  return drives ? std::max<Real>(0, std::abs(u) - Real(servo.limit)) : 0;
}

struct Output {
  Real u = 0;
  Real ds = 0;  ///< rates of the integral and of the filter
  Real df = 0;
};

Output continuous(const Servo& servo, Real e, const Real* memory) {
  Output result;
  if (servo.derivative != 0) result.df = (e - memory[1]) / Real(servo.filter);
  result.u = Real(servo.proportional) * e + Real(servo.integral) * memory[0] +
             Real(servo.derivative) * result.df;
  const Real faded =
      servo.limit > 0 ? winds_up(servo, result.u, e) / (1e-6L * Real(servo.limit)) : 0;
  result.ds = e * std::max<Real>(0, 1 - faded);
  result.u = limited(servo, result.u);
  return result;
}

}  // namespace

Real Tree::servo_error(const Servo& servo, const State& y) const {
  const auto [q, v] = coordinate_of(servo.reads, y);
  return Real(servo.reference) - (servo.reads_rate ? v : q);
}

void Tree::set_servo_outputs(const State& y) {
  outputs_.resize(memories_.size());
  for (std::size_t k = 0; k < memories_.size(); ++k) {
    const Servo& servo = scene_.servos[k];
    const Real* const memory = y.data() + memories_[k].at;
    outputs_[k] = servo.period > 0 ? memory[3] : continuous(servo, servo_error(servo, y), memory).u;
  }
}

Real Tree::paid_out(const Element& element) const {
  const auto index = static_cast<int>(&element - scene_.elements.data());
  Real sum = 0;
  for (std::size_t k = 0; k < memories_.size(); ++k) {
    if (scene_.servos[k].rope == index) sum += outputs_[k];
  }
  return sum;
}

void Tree::add_servos(bool at_joints) {
  for (std::size_t k = 0; k < memories_.size(); ++k) {
    const Servo& servo = scene_.servos[k];
    if (servo.rope >= 0) continue;
    if (servo.load >= 0) {
      add_servo_load(servo, outputs_[k]);
    } else if (at_joints) {
      add_along_joint(servo.drives, outputs_[k]);
    }
  }
}

void Tree::add_servo_load(const Servo& servo, Real u) {
  const Pose& b = poses_[static_cast<std::size_t>(servo.drives)];
  const Vec along = u * b.R.col(servo.load % 3);
  const Eigen::Index row = 6 * servo.drives;
  if (servo.load >= 3) {
    right_.segment<3>(row + 3) += along;
    return;
  }
  const Vec lever = -(b.R * parts_[static_cast<std::size_t>(servo.drives)].centre);
  right_.segment<3>(row) += along;
  right_.segment<3>(row + 3) += lever.cross(along);
}

void Tree::set_servo_rates(const State& y, State& result) const {
  for (std::size_t k = 0; k < memories_.size(); ++k) {
    const Servo& servo = scene_.servos[k];
    if (servo.period > 0) continue;
    const Eigen::Index at = memories_[k].at;
    const Output now = continuous(servo, servo_error(servo, y), y.data() + at);
    result[at] = now.ds;
    result[at + 1] = now.df;
  }
}

void Tree::sample_servo(const Servo& servo, Real e, Real* memory) const {
  const Real T = servo.period;
  const Real stays = servo.filter > 0 ? std::exp(-T / Real(servo.filter)) : 0;
  const Real s = memory[0] + T * e;
  memory[1] = stays * memory[1] + (1 - stays) * (e - memory[2]) / T;
  memory[2] = e;
  const auto output = [&](Real integral) {
    return Real(servo.proportional) * e + Real(servo.integral) * integral +
           Real(servo.derivative) * memory[1];
  };
  memory[0] = s;
  if (const Real beyond = winds_up(servo, output(s), e); beyond > 0) {
    const Real too_much = beyond / std::abs(Real(servo.integral));
    memory[0] -= std::copysign(std::min(too_much, std::abs(T * e)), e);
  }
  Real* const waiting = memory + 4;
  const int whole = servo.whole_periods();
  for (int i = whole; i > 0; --i) waiting[i] = waiting[i - 1];
  waiting[0] = limited(servo, output(memory[0]));
  if (servo.rest() == 0) memory[3] = waiting[whole];
}

void Tree::sample(Real t, State& y) {
  if (memories_.empty()) return;
  State none(size_);
  read(y, guide_.at(t, y, none));
  const State before = y;
  const auto begin = Real(scene_.t_begin);
  for (std::size_t k = 0; k < memories_.size(); ++k) {
    const Servo& servo = scene_.servos[k];
    if (!(servo.period > 0)) continue;
    Real* const memory = y.data() + memories_[k].at;
    if (is_due(t, begin, servo.period)) {
      sample_servo(servo, servo_error(servo, before), memory);
    } else if (servo.rest() > 0 && is_due(t, begin + Real(servo.rest()), servo.period)) {
      memory[3] = memory[4 + servo.whole_periods()];
    }
  }
}

}  // namespace differential::reference
