#pragma once

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <type_traits>
#include <utility>
#include <vector>

#include <dynamics/exact/elliptic.hpp>
#include <dynamics/model/closed_form.hpp>
#include <dynamics/model/scene.hpp>
#include <dynamics/model/terms.hpp>
#include <dynamics/pendulum/pendulum.hpp>
#include <dynamics/pendulum/pendulum_motion.hpp>
#include <dynamics/pendulum/pendulum_series.hpp>

namespace kreisel {

namespace detail {

/// The error of a SteadyPendulumMotion at output times, which must be given in order, by the
/// measure of RunReport::error_estimate. It is relative to the greatest angle and rate so far, at
/// outputs and during the first period.
template <class S>
class SteadyPendulumMotionError {
 public:
  /// inputs : error of the phase per radian, from the rounding of the inputs
  SteadyPendulumMotionError(const SteadyPendulumMotion<S>& motion, double begin, double inputs = 0)
      : motion_(motion), begin_(begin), inputs_(inputs) {}

  [[nodiscard]] double operator()(double t, double smallest) {
    const S time = S(t) - begin_;
    angle_ = std::max(angle_, smallest);
    rate_ = std::max(rate_, smallest);
    note_way(time);
    note(time);
    constexpr double u = std::numeric_limits<double>::epsilon() / 2;
    const double off = double(motion_.phase_error(time) + inputs_ * motion_.phase(time));
    return 2 * u + off * double(std::max(motion_.angle_per_phase() / angle_,
                                         motion_.rate_per_phase() / rate_));
  }

 private:
  void note(const S& time) {
    const auto point = motion_.at(time);
    angle_ = std::max(angle_, std::abs(double(point.angle)));
    rate_ = std::max(rate_, std::abs(double(point.rate)));
  }

  /// After the first period only angles that count whole turns grow; they are greatest at the end.
  void note_way(const S& time) {
    using std::abs;
    constexpr int parts = 32;  // of a period, within which sizes change by 1 %
    const S part = motion_.period() / parts;
    for (; noted_ <= parts; ++noted_) {
      const S on_the_way = noted_ * part;
      if (!(on_the_way < S(abs(time)))) return;
      note(time < 0 ? S(-on_the_way) : on_the_way);
    }
  }

  SteadyPendulumMotion<S> motion_;
  double begin_;
  double inputs_;
  int noted_ = 0;     ///< parts of a period
  double angle_ = 0;  ///< the greatest so far
  double rate_ = 0;
};

}  // namespace detail

/// The physical pendulum on a moving guide, as a scene for solve():
///
///   Theta_C phi.. + f(phi.) + E sin phi + F cos phi + H cos 2phi + K sin 2phi = -Theta_C ou_z
///
///   const PhysicalPendulum pendulum(PendulumBody<>::thin_rod(1), pendulum_guide(earth_guide(site)));
///   const auto run = solve(pendulum, {.angle = 0.1}, {.output_times = {3600}, .tolerance = 1e-12});
///
/// Motion is a PendulumGuide or a RestingPendulumGuide if the guide moves steadily, or a function
/// of time that returns one of them. Damping is a function phi. -> f(phi.) [N m]; Known are the
/// Without<> of the body, as for PendulumField. On a steady guide without damping the motion has a
/// closed form (SteadyPendulumMotion): a year of swings costs as much as one.
///
/// Source : paper 002 (23)
/// Units  : rad, rad/s, s
/// Error  : closed form: 2u of angle and rate, and the effect of the phase error, which is 4e-19 of
///          the phase's radians, more near a barrier
///          (tests/dynamics/pendulum/physical_pendulum.cpp)
/// Throws : InvalidInput for parameters that no body can have: see check(PendulumBody)
template <class Motion = PendulumGuide<>, class Damping = NoDamping, class... Known>
class PhysicalPendulum {
 public:
  using Vector = Eigen::Vector2d;
  static constexpr bool is_steady = detail::is_steady_pendulum_guide<Motion>;
  static constexpr bool undamped = std::is_same_v<Damping, NoDamping>;
  template <class N>
  static constexpr bool takes = undamped || std::is_invocable_v<const Damping&, N>;

  struct State {
    double angle = 0;  ///< phi, whole turns counted
    double rate = 0;   ///< phi.
  };

  explicit PhysicalPendulum(const PendulumBody<>& body, Motion motion = {}, Damping damping = {},
                            Known... known)
      : body_(checked(body)), motion_(motion), field_(body, std::move(motion), damping, known...) {}

  [[nodiscard]] const PendulumBody<>& body() const { return body_; }

  /// E, F, H and K of a steady guide, computed in S.
  template <class S>
  requires is_steady [[nodiscard]] PendulumCoefficients<S> coefficients() const {
    return kreisel::coefficients(body_.template cast<S>(), steady_guide().template cast<S>());
  }

  /// ou_z of a steady guide.
  [[nodiscard]] double drive() const requires is_steady {
    return steady_guide().angular_acceleration.z();
  }

  /// The vector field on  y = (phi, phi.), for double and, on a steady guide, for dual numbers.
  template <class N>
  requires(std::is_same_v<N, double> || (is_steady && takes<N>))
      [[nodiscard]] Eigen::Matrix<N, 2, 1> rates(const std::type_identity_t<N>& t,
                                                 const Eigen::Matrix<N, 2, 1>& y) const {
    if constexpr (is_steady) {
      return field_(0, y);
    } else {
      return field_(t, y);
    }
  }
  [[nodiscard]] Vector rates(double t, const Vector& y) const { return rates<double>(t, y); }

  /// The Taylor series of the motion, for TaylorSteps, on a steady guide without damping.
  [[nodiscard]] detail::PendulumSeries series() const requires(is_steady&& undamped) {
    return field_.series();
  }

  /// Theta_C phi.^2/2 and the potential, if they are conserved.
  [[nodiscard]] std::vector<std::pair<const char*, double>> conserved(const double& /*t*/,
                                                                      const State& state) const {
    if constexpr (is_steady && undamped) {
      if (drive() == 0)
        return {{"energy", energy(body_, coefficients<double>(), to_vector(state))}};
    }
    return {};
  }

  /// The terms of rates(): see kreisel::terms.
  [[nodiscard]] Terms terms() const { return field_.terms(); }

  /// For integrators: components that share unit and size.
  static constexpr std::array<int, 2> blocks = {1, 1};

  [[nodiscard]] static Vector to_vector(const State& s) { return {s.angle, s.rate}; }
  [[nodiscard]] static State from_vector(const Vector& y) { return {y[0], y[1]}; }

 private:
  [[nodiscard]] static const PendulumBody<>& checked(const PendulumBody<>& body) {
    check(body);
    return body;
  }

  [[nodiscard]] PendulumGuide<> steady_guide() const {
    if constexpr (std::is_same_v<Motion, PendulumGuide<>>) {
      return motion_;
    } else {
      return {.effective_gravity = {motion_.gravity, 0, 0}};
    }
  }

  PendulumBody<> body_;
  Motion motion_;
  PendulumField<double, Motion, Damping, Known...> field_;
};

/// The motion on a steady guide, undamped; nothing where the series of SteadyPendulumMotion does
/// not converge.
template <class Motion, class... Known>
requires detail::is_steady_pendulum_guide<Motion>
[[nodiscard]] std::optional<
    ClosedForm<typename PhysicalPendulum<Motion, NoDamping, Known...>::State>>
closed_form(const PhysicalPendulum<Motion, NoDamping, Known...>& pendulum, double begin,
            const typename PhysicalPendulum<Motion, NoDamping, Known...>::State& start) {
  using State = typename PhysicalPendulum<Motion, NoDamping, Known...>::State;
  using exact::Real;
  const auto c = pendulum.template coefficients<Real>();
  const bool pulled = c.e() != 0 || c.f != 0 || c.h != 0 || c.k != 0;
  if (!pulled || pendulum.drive() != 0) return std::nullopt;
  if (!std::isfinite(start.angle) || !std::isfinite(start.rate)) return std::nullopt;
  try {
    const SteadyPendulumMotion<Real> motion(pendulum.body().template cast<Real>(), c, start.angle,
                                            start.rate);
    return ClosedForm<State>{"energy integral, Fourier series",
                             [motion, begin](double t) {
                               const auto point = motion.at(Real(t) - begin);
                               return State{double(point.angle), double(point.rate)};
                             },
                             detail::SteadyPendulumMotionError(motion, begin)};
  } catch (const ComputationFailed&) {  // too near a barrier
    return std::nullopt;
  }
}

static_assert(Scene<PhysicalPendulum<>>);

}  // namespace kreisel
