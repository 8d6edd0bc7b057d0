#pragma once

#include <Eigen/Geometry>

#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <limits>
#include <stop_token>
#include <utility>

#include <dynamics/step/explicit.hpp>
#include <dynamics/step/free_top_flow.hpp>
#include <dynamics/step/shared.hpp>
#include <dynamics/step/stop.hpp>

namespace kreisel {

/// A torque on body axes that depends on time and attitude alone. It must not depend on the
/// quaternion's norm, which is 1 up to 1e-7 if the start was normalised.
template <class T>
concept AttitudeTorque = requires(const T torque, double t, const Eigen::Quaterniond& q) {
  { torque(t, q) } -> std::convertible_to<Vector3<double>>;
};

/// Free motion for half the step, the whole kick, free motion for the other half. Order 2.
///
/// Source : G. Strang, SIAM J. Numer. Anal. 5 (1968) 506
struct Strang {
  static constexpr int order = 2;
  static constexpr std::array<DoubleDouble, 2> drift = {0.5_dd, 0.5_dd};
  static constexpr std::array<DoubleDouble, 1> kick = {1.0_dd};
};

/// Error O(e h^8 + e^2 h^6 + e^3 h^4) for a torque e times weaker than that of the spin; order 4
/// for other torques.
///
/// Source : S. Blanes, F. Casas, A. Farres, J. Laskar, J. Makazaga, A. Murua, New families of
///          symplectic splitting methods for numerical integration in dynamical astronomy, Appl.
///          Numer. Math. 68 (2013) 58, ABA(8,6,4). Checked by its order conditions and by
///          convergence (tests/dynamics/step/splitting.cpp)
struct Blanes864 {
  static constexpr int order = 4;
  static constexpr std::array<DoubleDouble, 8> drift = {
      0.0711334264982231177779387300061549964174_dd,  //
      0.241153427956640098736487795326289649618_dd,   //
      0.521411761772814789212136078067994229991_dd,   //
      -0.333698616227678005726562603400438876027_dd,  //
      -0.333698616227678005726562603400438876027_dd,  //
      0.521411761772814789212136078067994229991_dd,   //
      0.241153427956640098736487795326289649618_dd,   //
      0.0711334264982231177779387300061549964174_dd};
  static constexpr std::array<DoubleDouble, 7> kick = {
      0.183083687472197221961703757166430291072_dd,    //
      0.310782859898574869507522291054262796375_dd,    //
      -0.0265646185119588006972121379164987592663_dd,  //
      0.0653961422823734184559721793911134363710_dd,   //
      -0.0265646185119588006972121379164987592663_dd,  //
      0.310782859898574869507522291054262796375_dd,    //
      0.183083687472197221961703757166430291072_dd};
};

/// 17 steps of Strang in a row, some of them backwards. Order 8 for every torque.
///
/// Source : W. Kahan, R.-C. Li, Composition constants for raising the orders of unconventional
///          schemes for ordinary differential equations, Math. Comp. 66 (1997) 1089, s17odr8a
struct KahanLi8 {
  static constexpr int order = 8;
  static constexpr std::array<DoubleDouble, 17> kick = {
      0.13020248308889008087881763_dd,  0.56116298177510838456196441_dd,
      -0.38947496264484728640807860_dd, 0.15884190655515560089621075_dd,
      -0.39590389413323757733623154_dd, 0.18453964097831570709183254_dd,
      0.25837438768632204729397911_dd,  0.29501172360931029887096624_dd,
      -0.60550853383003451169892108_dd, 0.29501172360931029887096624_dd,
      0.25837438768632204729397911_dd,  0.18453964097831570709183254_dd,
      -0.39590389413323757733623154_dd, 0.15884190655515560089621075_dd,
      -0.38947496264484728640807860_dd, 0.56116298177510838456196441_dd,
      0.13020248308889008087881763_dd};
  static constexpr std::array<DoubleDouble, 18> drift = [] {
    std::array<DoubleDouble, 18> halves{};
    for (std::size_t i = 0; i < kick.size(); ++i) {
      halves[i] += kick[i] / 2;
      halves[i + 1] += kick[i] / 2;
    }
    return halves;
  }();
};

/// A rigid body under a torque that depends on its attitude: exact free motion, interrupted by
/// kicks.
///
///   Theta w' + w x Theta w = torque(t, q)
///
/// Fixed steps, symmetric in time. They must resolve the torque as seen from the body, not the
/// spin. Consecutive steps share a drift.
///
/// Flow   : SymmetricFreeFlow or another FreeFlow. A body with three moments has elliptic functions
///          to evaluate at each drift: ExplicitRungeKutta is faster there
/// Scheme : Blanes864 for fast tops, KahanLi8 for the last digits, Strang for 1e-4
/// Error  : top of 3000 rad/s (A = 3e-4, C = 1e-4 kg m^2, 0.049 N m) after 10 s, in rad: Blanes864
///          1.3e-8 and, in smaller steps, 2.2e-10; KahanLi8 8e-15
///          (tests/dynamics/step/splitting.cpp)
/// Cost   : 7 drifts and kicks a step, 17 with KahanLi8, 1 with Strang
/// Throws : InvalidInput for an invalid step or start; ComputationFailed naming the time at which
///          the torque is not finite: the last accepted time and state stay readable
template <FreeFlow Flow, AttitudeTorque Torque, class Scheme = Blanes864>
class SplittingSteps {
 public:
  SplittingSteps(Flow flow, Torque torque, double t, const Eigen::Quaterniond& attitude,
                 const Vector3<double>& angular_velocity, double step)
      : flow_(std::move(flow)),
        torque_(std::move(torque)),
        step_(step),
        time_{t, 0},
        state_(flow_.start(attitude, angular_velocity)) {
    detail::require_step(step);
    if (!std::isfinite(t)) detail::refuse_steps("the start time is not finite");
  }

  [[nodiscard]] double t() const { return time_.value; }

  /// Body to inertial, with the norm of the start, up to 1e-7.
  [[nodiscard]] Eigen::Quaterniond attitude() const { return flow_.attitude(state_); }

  /// On body axes.
  [[nodiscard]] Vector3<double> angular_velocity() const { return flow_.angular_velocity(state_); }

  [[nodiscard]] const IntegrationStatistics& effort() const { return effort_; }

  /// Limit of the evaluations, after which the integration gives up.
  void give_up_after(double evaluations) { max_evaluations_ = evaluations; }

  /// advance_to() throws StopRequested before its next step once this token requests a stop.
  void stop_by(std::stop_token stop) { stop_ = std::move(stop); }

  /// Upper limit of the step length from here on.
  void take_steps_of(double step) {
    detail::require_step(step);
    step_ = step;
  }

  /// Integrates to `end` exactly, in equal steps no longer than the limit, forwards or backwards.
  void advance_to(double end) {
    const detail::EqualSteps steps(time_, end, step_);
    if (end == t()) return;
    const DoubleDouble h = steps.length;
    const DoubleDouble outer = Scheme::drift[0] * h;
    double done = 0;
    while (done < steps.count) {
      const bool spent = effort_.evaluations > max_evaluations_;
      if (spent || stop_.stop_requested()) {
        if (done > 0) flow_.drift(state_, outer);
        if (!spent) throw StopRequested{};
        detail::stop_without_evaluations(t(), max_evaluations_);
      }
      const auto before = state_;
      const bool first = done == 0;
      if (!step(h, first ? outer : 2 * outer)) {
        state_ = before;
        if (!first) flow_.drift(state_, outer);
        detail::stop_integration(t(), "the torque is not finite");
      }
      time_.add(static_cast<double>(h));
      effort_.steps += 1;
      done += 1;
    }
    flow_.drift(state_, outer);
    time_ = {end, 0};
  }

 private:
  /// All but the last drift; returns true if all torques were finite.
  [[nodiscard]] bool step(DoubleDouble h, DoubleDouble first_drift) {
    DoubleDouble passed = 0;
    for (std::size_t i = 0; i < Scheme::kick.size(); ++i) {
      flow_.drift(state_, i == 0 ? first_drift : Scheme::drift[i] * h);
      passed += Scheme::drift[i];
      const Vector3<double> torque =
          torque_(t() + (static_cast<double>(passed * h) + time_.rest), attitude());
      effort_.evaluations += 1;
      if (!detail::finite(torque)) return false;
      flow_.kick(state_, static_cast<double>(Scheme::kick[i] * h) * torque);
    }
    return true;
  }

  Flow flow_;
  Torque torque_;
  double step_;
  detail::Compensated<double> time_;
  typename Flow::State state_;
  double max_evaluations_ = std::numeric_limits<double>::infinity();
  std::stop_token stop_;
  IntegrationStatistics effort_;
};

}  // namespace kreisel
