#pragma once

#include <Eigen/Core>

#include <algorithm>
#include <cmath>

#include <dynamics/rigid/euler_top.hpp>
#include <dynamics/solve/levels.hpp>
#include <dynamics/solve/run.hpp>
#include <dynamics/solve/solve_options.hpp>
#include <dynamics/step/checkpoint.hpp>
#include <dynamics/step/splitting.hpp>

namespace kreisel::detail {

/// True if splitting applies to a scene: a symmetric top under weight.
[[nodiscard]] inline bool splits(const EulerTop& top) {
  return top.moments().x() == top.moments().y() && !top.weight_moment().isZero(0) &&
         top.rotor_momentum().isZero(0);
}

/// True if splitting pays: the spin dominates the weight.
///
/// The weight's share of the nutation is  A k / L^2.
[[nodiscard]] inline bool is_fast(const EulerTop& top, const EulerTop::State& start) {
  const double L = top.moments().cwiseProduct(start.angular_velocity).norm();
  return L * L > 1000 * top.moments().x() * top.weight_moment().norm();
}

/// A run of SplittingSteps.
class SplittingRun final : public Run {
  struct Weight {
    const EulerTop* top;

    [[nodiscard]] Vector3<double> operator()(double /*t*/, const Eigen::Quaterniond& q) const {
      return top->weight_torque(q);
    }
  };

 public:
  SplittingRun(const EulerTop& top, const SolveOptions& options, const EulerTop::State& start,
               const EqualLength& length)
      : length_(length),
        steps_(SymmetricFreeFlow(top.moments().x(), top.moments().z()), {&top}, options.begin,
               start.attitude, start.angular_velocity, length.longest) {
    steps_.give_up_after(options.max_evaluations);
    steps_.stop_by(options.stop);
  }

  void on_the_way(double t, double /*end*/, double* y) override {
    length_.advance(steps_, t);
    const auto there = EulerTop::to_vector({steps_.attitude(), steps_.angular_velocity()});
    std::copy_n(there.data(), there.size(), y);
  }

  [[nodiscard]] IntegrationStatistics effort() const override { return steps_.effort(); }
  void pass(Checkpoint& /*checkpoint*/) override {}

 private:
  EqualLength length_;
  SplittingSteps<SymmetricFreeFlow, Weight> steps_;
};

/// The lengths of splitting steps.
[[nodiscard]] inline StepLengths splitting_lengths(const EulerTop& top, const SolveOptions& options,
                                                   const EulerTop::State& start) {
  // The rate at which the torque rotates on body axes.
  const Vector3<double>& I = top.moments();
  const bool axial = top.weight_moment().x() == 0 && top.weight_moment().y() == 0;
  const double nutation = I.cwiseProduct(start.angular_velocity).norm() / I.x();
  const double spin = axial ? 0 : start.angular_velocity.norm();
  const double rate = std::max(nutation, spin) + std::sqrt(top.weight_moment().norm() / I.x());
  // Steps of 2/rate have an error of some 1e-9.
  return {2 / rate * std::clamp(std::pow(options.tolerance / 1e-9, 1.0 / 8), 0.2, 4.0),
          0.02 / rate};
}

}  // namespace kreisel::detail
