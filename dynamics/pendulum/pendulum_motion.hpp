#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <dynamics/pendulum/pendulum_equilibria.hpp>
#include <dynamics/pendulum/pendulum_period.hpp>

namespace kreisel {

/// The motion of an undamped pendulum on a steady guide, from any angle and rate. The pendulum
/// swings between two turning points, over one well or several, or it turns over.
///
///   Theta_C phi.^2/2 + U(phi) = const.,  dU/dphi = E sin phi + F cos phi + H cos 2phi + K sin 2phi
///
/// The motion is a function of a phase theta. In a swing, phi = (l + r)/2 - (r - l)/2 cos(theta)
/// between the turning points l and r; in turning over, phi = phi(0) +- theta. In both cases
/// dt/dtheta is smooth and has the period 2 pi, so few terms of its Fourier series are needed. Its
/// integral is
///
///   t = T theta/(2 pi) + sum_k (s_k sin(k theta) + c_k cos(k theta)),
///
/// and Newton's method inverts it. There are no steps: the state after 1e6 periods costs as much as
/// the state after one.
///
/// S      : number type of the computation; exact::Real keeps the digits of a phase of 1e4 periods
/// Source : paper 002 (23), the first integral
/// Units  : rad, rad/s, s
/// Error  : of the phase  (4 |theta| + 32) epsilon condition()
///          (tests/dynamics/pendulum/physical_pendulum)
/// Throws : InvalidInput if there is no moment at all, or the start is not finite;
///          ComputationFailed at rest at an equilibrium, or so near a barrier that 1024 terms are
///          not enough: between 2e-6 and 2e-7 of its height (case pendulum-barrier of the
///          catalogue)
template <class S>
class SteadyPendulumMotion {
 public:
  struct Point {
    S angle;  ///< whole turns counted
    S rate;
  };

  SteadyPendulumMotion(const PendulumBody<S>& body, const PendulumCoefficients<S>& c,
                       const S& angle, const S& rate)
      : theta_c_(body.theta_c), forwards_(!(rate < S(0))) {
    require_finite(angle, "angle");
    require_finite(rate, "rate");
    const std::vector<Equilibrium<S>> all = equilibria(c);
    count_from_nearest(all, angle);
    moment_ = detail::ShiftedMoment<S>::at(c, origin_);
    start_ = angle - origin_;
    kinetic_ = theta_c_ * rate * rate / S(2);
    const auto [left, right] = turning_points(all);
    if (left && right) {
      using std::atan2, std::sqrt;
      swing_ = detail::Swing<S>{moment_, *left, *right, theta_c_};
      // The rate is used as well: near a turning point the angle depends little on the phase.
      const S width = *right - *left;
      const S to_left = std::clamp(S((start_ - *left) / width), S(0), S(1));
      const S pace = swing_->pace(S(sqrt(to_left)), S(sqrt(S(S(1) - to_left)))).time;
      begin_phase_ = atan2(S(S(2) * rate * pace / width), S(S(1) - S(2) * to_left));
    }
    find_series();
    begin_time_ = at_phase(begin_phase_).time;
  }

  /// The period of a swing there and back, or of one turn over the top.
  [[nodiscard]] S period() const { return S(2) * pi() * pace_; }

  /// The amplification of rounding errors in the phase: 1 far from barriers, and great near them.
  [[nodiscard]] S condition() const { return condition_; }

  /// The phase in radians after a time.
  [[nodiscard]] S phase(const S& time) const {
    using std::abs;
    return abs(S(time / pace_));
  }

  /// A bound of the rounding error of the phase at a time.
  [[nodiscard]] S phase_error(const S& time) const {
    return (S(4) * phase(time) + S(32)) * std::numeric_limits<S>::epsilon() * condition_;
  }

  /// The greatest change of angle and rate per radian of phase.
  [[nodiscard]] S angle_per_phase() const {
    return swing_ ? S((swing_->right - swing_->left) / S(2)) : S(1);
  }
  [[nodiscard]] S rate_per_phase() const { return rate_per_phase_; }

  /// Throws : InvalidInput for a time that is not finite
  [[nodiscard]] Point at(const S& time) const {
    using std::round, std::sin;
    require_finite(time, "time");
    const S from_zero = time + begin_time_;
    const S turns = round(S(from_zero / period()));
    const auto [theta, pace] = phase_at(S(from_zero - turns * period()));
    if (swing_) {
      const S radius = (swing_->right - swing_->left) / S(2);
      const S half = sin(S(theta / S(2)));
      return {origin_ + (swing_->left + S(2) * radius * half * half), radius * sin(theta) / pace};
    }
    const S turned = theta + turns * S(2) * pi();
    return {origin_ + (forwards_ ? S(start_ + turned) : S(start_ - turned)),
            (forwards_ ? S(1) : S(-1)) / pace};
  }

 private:
  template <class N>
  struct Phase {
    N time;  ///< t(theta)
    N pace;  ///< dt/dtheta
  };

  static constexpr std::size_t most_nodes = 2048;

  [[nodiscard]] static S pi() {
    using std::acos;
    return acos(S(-1));
  }

  static void require_finite(const S& number, const char* what) {
    if (number - number == S(0)) return;
    throw InvalidInput(std::string("motion of a pendulum: the ") + what + " is not finite");
  }

  void count_from_nearest(const std::vector<Equilibrium<S>>& all, const S& angle) {
    using std::abs, std::round;
    std::optional<S> least;
    for (const Equilibrium<S>& candidate : all) {
      if (!candidate.stable) continue;
      const S origin =
          candidate.angle + S(2) * pi() * round(S((angle - candidate.angle) / (S(2) * pi())));
      const S away = abs(S(angle - origin));
      if (least && !(away < *least)) continue;
      least = away;
      origin_ = origin;
    }
  }

  /// The turning points left and right of the start, counted from the origin; neither if it turns
  /// over.
  ///
  /// Throws : ComputationFailed if it rests, or ends on a barrier
  [[nodiscard]] std::pair<std::optional<S>, std::optional<S>> turning_points(
      const std::vector<Equilibrium<S>>& all) const {
    using std::abs, std::ceil, std::floor;
    const S turn = S(2) * pi();
    const S epsilon = std::numeric_limits<S>::epsilon();
    if (kinetic_ == S(0) &&
        abs(moment_.moment(start_)) <= S(4) * epsilon * moment_.size() * abs(start_)) {
      throw ComputationFailed("the pendulum rests at an equilibrium");
    }
    std::vector<S> below;
    std::vector<S> above;  // mirrored
    for (const Equilibrium<S>& other : all) {
      const S at = other.angle - origin_;
      const S first = at + turn * floor(S((start_ - at) / turn));
      for (int turns = -1; turns <= 2; ++turns) {
        const S stop = first + S(turns) * turn;
        if (stop < start_) below.push_back(stop);
        if (stop > start_) above.push_back(-stop);
      }
    }
    const auto descending = [](const S& a, const S& b) { return a > b; };
    std::sort(below.begin(), below.end(), descending);
    std::sort(above.begin(), above.end(), descending);
    const auto left = detail::climb(moment_, start_, kinetic_, below, S(1), origin_);
    auto right = detail::climb(moment_.mirrored(), S(-start_), kinetic_, above, S(-1), origin_);
    if (right) right = -*right;
    return {left, right};
  }

  /// dt/dtheta.
  [[nodiscard]] typename detail::Swing<S>::Pace pace_at(const S& theta) const {
    using std::abs, std::cos, std::sin, std::sqrt;
    if (swing_) return swing_->pace(sin(S(theta / S(2))), cos(S(theta / S(2))));
    const S d = (forwards_ ? theta : S(-theta)) / S(2);
    const S gained = S(-2) * d * moment_.slope(S(start_ + d), d);
    const S left = kinetic_ + gained;
    return {sqrt(S(theta_c_ / (S(2) * left))), (kinetic_ + abs(gained)) / left};
  }

  /// Doubles the nodes until the last terms are as small as rounding.
  void find_series() {
    using std::abs, std::cos, std::sin;
    const S epsilon = std::numeric_limits<S>::epsilon();
    std::vector<S> paces;
    condition_ = S(1);
    for (std::size_t n = 16; n <= most_nodes; n *= 2) {
      std::vector<S> finer(n);
      std::vector<S> cosines(n);
      std::vector<S> sines(n);
      for (std::size_t j = 0; j < n; ++j) {
        // From -pi to pi: farther away a pendulum that turns over would lose digits of phi.
        const S theta = pi() * (S(2) * S(double(j)) / S(double(n)) - (2 * j < n ? S(0) : S(2)));
        cosines[j] = cos(theta);
        sines[j] = sin(theta);
        if (!paces.empty() && j % 2 == 0) {
          finer[j] = paces[j / 2];
          continue;
        }
        const auto pace = pace_at(theta);
        condition_ = std::max(condition_, pace.condition);
        finer[j] = pace.time;
      }
      paces = std::move(finer);
      S sum(0);
      for (const S& pace : paces) sum += pace;
      pace_ = sum / S(double(n));
      if (!(pace_ > S(0) && pace_ <= std::numeric_limits<S>::max())) {
        throw ComputationFailed("the pendulum's period is not a number: its motion is too small");
      }
      sine_terms_.clear();
      cosine_terms_.clear();
      const S small = S(4) * epsilon * condition_ * pace_;
      std::size_t last = 0;  // that counts
      for (std::size_t k = 1; k < n / 2; ++k) {
        S a(0);
        S b(0);
        for (std::size_t j = 0; j < n; ++j) {
          a += paces[j] * cosines[j * k % n];
          b += paces[j] * sines[j * k % n];
        }
        a *= S(2) / S(double(n));
        b *= S(2) / S(double(n));
        if (abs(a) + abs(b) > small) last = k;
        sine_terms_.push_back(a / S(double(k)));
        cosine_terms_.push_back(-b / S(double(k)));
      }
      if (!(last < 3 * n / 8)) continue;
      sine_terms_.resize(last);
      cosine_terms_.resize(last);
      const auto rate = [&](std::size_t j) {
        return swing_ ? S(angle_per_phase() * sines[j] / paces[j]) : S(S(1) / paces[j]);
      };
      for (std::size_t j = 0; j < n; ++j) {
        const S change = abs(S(rate((j + 1) % n) - rate(j))) * S(double(n)) / (S(2) * pi());
        rate_per_phase_ = std::max(rate_per_phase_, change);
      }
      return;
    }
    throw ComputationFailed("the pendulum is so near a barrier that its series does not converge");
  }

  /// In S, or with the digits of another number type.
  template <class N>
  [[nodiscard]] Phase<N> at_phase(const N& theta) const {
    using std::cos, std::sin;
    const N c = cos(theta);
    const N s = sin(theta);
    N ck = c;  // cos(k theta)
    N sk = s;
    Phase<N> sum{N(0), N(0)};
    for (std::size_t i = 0; i < sine_terms_.size(); ++i) {
      const N k(double(i + 1));
      const N of_sine(sine_terms_[i]);
      const N of_cosine(cosine_terms_[i]);
      sum.time += of_sine * sk + of_cosine * ck;
      sum.pace += k * (of_sine * ck - of_cosine * sk);
      const N next = ck * c - sk * s;
      sk = ck * s + sk * c;
      ck = next;
    }
    const N pace(pace_);
    return {pace * theta + sum.time, pace + sum.pace};
  }

  /// The phase at a time, by Newton's method: t(theta) increases and differs from its mean by less
  /// than a period.
  /// With more digits than double the iterations begin in double.
  struct PhaseAt {
    S theta;
    S pace;
  };
  [[nodiscard]] PhaseAt phase_at(const S& time) const {
    const S mean = time / pace_;
    S start = mean;
    if constexpr (std::numeric_limits<S>::digits > std::numeric_limits<double>::digits) {
      double pace = 0;
      start = phase_from(double(mean), double(time), double(mean), pace);
    }
    S pace(0);
    const S theta = phase_from(mean, time, start, pace);
    return {theta, pace};
  }
  template <class N>
  [[nodiscard]] N phase_from(const N& mean, const N& time, const N& start, N& pace) const {
    const N turn(S(2) * pi());
    return detail::root_in_bracket(N(mean - turn), N(mean + turn), start,
                                   N(N(2) * std::numeric_limits<N>::epsilon() * turn),
                                   [&](const N& theta) {
                                     const Phase<N> phase = at_phase(theta);
                                     const N off = phase.time - time;
                                     pace = phase.pace;
                                     return std::pair(off > N(0), N(theta - off / phase.pace));
                                   });
  }

  S theta_c_;
  bool forwards_;
  S origin_ = S(0);                       ///< the equilibrium that x is counted from
  detail::ShiftedMoment<S> moment_ = {};  ///< of x
  S start_ = S(0);                        ///< x at the start
  S kinetic_ = S(0);                      ///< Theta_C phi.^2/2 at the start
  std::optional<detail::Swing<S>> swing_;
  S pace_ = S(0);       ///< mean dt/dtheta
  S condition_ = S(1);  ///< greatest of all nodes
  S rate_per_phase_ = S(0);
  std::vector<S> sine_terms_;    ///< s_1, s_2, ..
  std::vector<S> cosine_terms_;  ///< c_1, c_2, ..
  S begin_phase_ = S(0);
  S begin_time_ = S(0);  ///< t(begin_phase)
};

}  // namespace kreisel
