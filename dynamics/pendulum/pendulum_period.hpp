#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <sstream>
#include <utility>
#include <vector>

#include <dynamics/pendulum/pendulum_equilibria.hpp>

namespace kreisel {

/// The relative excess of the stiffness at an equilibrium over the simple pendulum's:
///
///   x = (delta_E cos p - 2 m a g' sin^2(p/2) - F sin p - 2 H sin 2p + 2 K cos 2p)/(m a g')
///
/// with p = angle.
///
/// Error  : <= 8u of the terms, measured 6u: x = 1e-20 has 14 correct digits where K = 0
/// Throws : InvalidInput if m a g' is 0
template <class S>
[[nodiscard]] S stiffness_excess(const PendulumCoefficients<S>& c, const S& angle) {
  using std::cos, std::sin;
  if (!(c.weight > S(0))) {
    throw InvalidInput(
        "m a g' must be above 0: without effective gravity there is no simple pendulum "
        "to compare with");
  }
  const S half = sin(S(angle / S(2)));
  const S s = sin(angle);
  const S cs = cos(angle);
  return (c.delta_e * cs - S(2) * c.weight * half * half - c.f * s - S(4) * c.h * s * cs +
          S(2) * c.k * (cs - s) * (cs + s)) /
         c.weight;
}

/// Relative change  T/T_00 - 1 = (1 + x)^(-1/2) - 1  of the period of small oscillations.
///
/// Error  : that of stiffness_excess, and 2u
/// Throws : ComputationFailed if the equilibrium is not stable in first order: 1 + x <= 0
template <class S>
[[nodiscard]] S small_period_change(const PendulumCoefficients<S>& c, const S& angle) {
  using std::expm1, std::log1p;
  const S x = stiffness_excess(c, angle);
  if (!(x > S(-1))) {
    throw ComputationFailed("no period of small oscillations: the stiffness there is not above 0");
  }
  return expm1(S(log1p(x) / S(-2)));
}

/// The period of small oscillations about an equilibrium:  2 pi sqrt(Theta_C/stiffness).
///
/// Error  : <= 4u + 3u (|E cos| + |F sin| + 2|H sin 2phi| + 2|K cos 2phi|)/stiffness, relative
/// Throws : ComputationFailed if the stiffness is not above 0
template <class S>
[[nodiscard]] S small_period(const PendulumBody<S>& body, const PendulumCoefficients<S>& c,
                             const S& angle) {
  using std::acos, std::sqrt;
  const S stiffness = c.stiffness(angle);
  if (!(stiffness > S(0))) {
    throw ComputationFailed("no period of small oscillations: the stiffness there is not above 0");
  }
  return S(2) * acos(S(-1)) * sqrt(S(body.theta_c / stiffness));
}

/// A finite oscillation between two turning points, both counted from the equilibrium.
template <class S = double>
struct FiniteOscillation {
  S period;
  S release;              ///< where it was released at rest
  S other_turning_point;  ///< where it comes to rest next
  S quadrature_error;     ///< of the trapezoidal rule, rounding apart  [s]
  int nodes;
};

namespace detail {

/// The moment as a function of x = phi - phi_0 and the differences of its potential:
///   m(x) = E' sin x + K' sin 2x + F' (cos x - cos 2x)
template <class S>
struct ShiftedMoment {
  S e, k, f;

  static ShiftedMoment at(const PendulumCoefficients<S>& c, const S& angle) {
    using std::abs, std::cos, std::sin;
    const S s = sin(angle);
    const S cs = cos(angle);
    const S c2 = (cs - s) * (cs + s);
    const S s2 = S(2) * s * cs;
    // F' appears twice, and E s + F c = -(H c2 + K s2): use the sum with the smaller rounding
    // error.
    const bool first = abs(c.e() * s) + abs(c.f * cs) < abs(c.h * c2) + abs(c.k * s2);
    return {c.e() * cs - c.f * s, c.k * c2 - c.h * s2,
            first ? S(c.e() * s + c.f * cs) : S(S(0) - c.h * c2 - c.k * s2)};
  }

  /// The mirror image, x -> -x.
  [[nodiscard]] ShiftedMoment mirrored() const { return {e, k, S(0) - f}; }

  [[nodiscard]] S size() const {
    using std::abs;
    return abs(e) + S(2) * abs(k) + S(2) * abs(f);
  }

  [[nodiscard]] S moment(const S& x) const { return slope(x, S(0)); }

  /// The relative amplification of the rounding of m and d in slope(m, d).
  [[nodiscard]] S condition(const S& m, const S& d, const S& slope) const {
    using std::abs;
    return ((abs(e) + S(2) * abs(k)) * abs(m) + S(2) * abs(f) * (m * m + d * d)) / abs(slope);
  }

  /// [U(m + d) - U(m - d)]/(2 d), without cancellation:
  ///   sin(d)/d {sin m (E' + 2 K' cos d cos m) + 2 F' [sin(3m/2) sin(m/2) + cos 2m sin^2(d/2)]}
  [[nodiscard]] S slope(const S& m, const S& d) const {
    using std::cos, std::sin;
    const S sin_hm = sin(S(m / S(2)));
    const S cos_hm = cos(S(m / S(2)));
    const S sin_hd = sin(S(d / S(2)));
    const S cos_hd = cos(S(d / S(2)));
    const S sin_m = S(2) * sin_hm * cos_hm;
    const S cos_m = (cos_hm - sin_hm) * (cos_hm + sin_hm);
    const S cos_2m = (cos_m - sin_m) * (cos_m + sin_m);
    const S sin_3hm = sin_m * cos_hm + cos_m * sin_hm;
    const S cos_d = (cos_hd - sin_hd) * (cos_hd + sin_hd);
    const S sinc = d == S(0) ? S(1) : S(S(2) * sin_hd * cos_hd / d);
    return sinc * (sin_m * (e + S(2) * k * cos_d * cos_m) +
                   S(2) * f * (sin_3hm * sin_hm + cos_2m * sin_hd * sin_hd));
  }
};

/// A swing between two turning points as a function of its phase theta:
///   x = (left + right)/2 - (right - left)/2 cos(theta)
template <class S>
struct Swing {
  ShiftedMoment<S> moment;
  S left, right;
  S theta_c;

  struct Pace {
    S time;       ///< dt/dtheta
    S condition;  ///< how much of its rounding the moment's is
  };

  /// dt/dtheta at the phase whose half has this sine and cosine. It is smooth and even in theta:
  /// with Q = (U_right - U)/((right - x)(x - left)) it is 1/sqrt(2 Q/Theta_C).
  [[nodiscard]] Pace pace(const S& sin_half, const S& cos_half) const {
    using std::sqrt;
    // Distances to the ends and the difference from the nearer end, each without cancellation.
    const S radius = (right - left) / S(2);
    const S to_right = radius * cos_half * cos_half;  // half of right - x
    const S to_left = radius * sin_half * sin_half;   // half of x - left
    const bool nearer_right = to_right <= to_left;
    const S m = nearer_right ? S(right - to_right) : S(left + to_left);
    const S d = nearer_right ? to_right : to_left;
    const S slope = moment.slope(m, d);
    const S q = nearer_right ? S(slope / to_left) : S(-slope / to_right);  // 2 Q
    return {S(1) / sqrt(S(q / theta_c)), moment.condition(m, d, slope)};
  }
};

template <class S>
[[noreturn]] void fail_at_separatrix(const S& angle) {
  std::ostringstream text;
  text.precision(10);
  text << "the period is infinite: released there, the pendulum just reaches the unstable "
          "equilibrium "
       << "at phi = " << angle << " rad";
  throw ComputationFailed(text.str());
}

/// The turning point of a pendulum that moves from `start` towards smaller x with this kinetic
/// energy. Nothing if it turns over, which needs kinetic energy.
///
/// `stops` are the equilibria below `start`, descending, over at least one turn: U is monotone
/// between them.
template <class S>
[[nodiscard]] std::optional<S> climb(const ShiftedMoment<S>& moment, const S& start,
                                     const S& kinetic, const std::vector<S>& stops, const S& sense,
                                     const S& phi_0) {
  using std::abs, std::sqrt;
  // The remaining kinetic energy at x, divided by the distance: for tiny swings both would
  // underflow.
  const auto left = [&](const S& x) {
    const S slope = moment.slope(S((start + x) / S(2)), S((start - x) / S(2)));
    return kinetic == S(0) ? slope : S(kinetic / (start - x) + slope);
  };
  const S epsilon = std::numeric_limits<S>::epsilon();
  S high = start;
  S low = start;
  S at_low(0);
  S barrier(0);
  for (const S& stop : stops) {
    high = low;
    low = stop;
    at_low = left(stop);
    barrier = phi_0 + sense * stop;
    const S way = start - stop;
    if (abs(at_low) <= S(4) * epsilon * (kinetic / way + moment.size() * way)) {
      fail_at_separatrix(barrier);
    }
    if (at_low < S(0)) break;
  }
  if (!(at_low < S(0))) {
    if (kinetic == S(0)) fail_at_separatrix(barrier);  // the rest is rounding
    return {};
  }
  // Starts at the turning point of a spring with the stiffness at equilibrium. From far away
  // Newton's method would need a step for each factor 2 of the distance.
  const S stiffness = moment.e + S(2) * moment.k;
  const S spring =
      kinetic == S(0) ? S(-abs(start)) : S(-sqrt(S(start * start + S(2) * kinetic / stiffness)));
  const bool inside = spring > low && spring <= high;
  return root_in_bracket(
      low, high, inside ? spring : S((low + high) / S(2)), S(0), [&](const S& x) {
        const S slope = left(x);
        return std::pair(slope > S(0), S(x + (start - x) * slope / moment.moment(x)));
      });
}

}  // namespace detail

/// The period of the undamped pendulum released at rest at  equilibrium + amplitude.
///
///   T = 2 int dx/sqrt(2 (U_r - U)/Theta_C)  between the turning points l and r. With x = c + R sin
///   s and Q = (U_r - U)/((r - x)(x - l)) the integrand 1/sqrt(2 Q/Theta_C) is smooth and periodic
///   in s. The trapezoidal rule, doubled until it converges, then converges geometrically.
///
/// The other turning point need not lie in the same well: a pendulum released high passes lower
/// barriers. Angles are counted from the equilibrium, so that an amplitude of 1e-12 keeps all
/// digits.
///
/// Source : paper 002 (23), the first integral
/// Error  : quadrature_error and <= 8u away from barriers (measured 3u); released at a distance d
///          from a barrier, u/d more, which is the effect of the amplitude's own rounding
/// Cost   : 1.6 us (amplitude 0.1), 10 us (amplitude 3) in double, 2.5 GHz Xeon
/// Throws : InvalidInput: |amplitude| > pi, or release at another equilibrium (infinite period);
///          ComputationFailed: the energy equals that of a barrier (infinite period), or 2^18 nodes
///          were not enough, with the error that was reached
template <class S>
[[nodiscard]] FiniteOscillation<S> period_at_amplitude(const PendulumBody<S>& body,
                                                       const PendulumCoefficients<S>& c,
                                                       const std::vector<Equilibrium<S>>& all,
                                                       const Equilibrium<S>& equilibrium,
                                                       const std::type_identity_t<S>& amplitude) {
  using std::abs, std::acos, std::exp, std::log, std::sin, std::sqrt;
  const S epsilon = std::numeric_limits<S>::epsilon();
  constexpr int most_nodes = 1 << 18;
  const S pi = acos(S(-1));
  detail::require_within("amplitude", amplitude, S(-pi), pi, "rad");
  if (amplitude == S(0)) {
    return {small_period(body, c, equilibrium.angle), S(0), S(0), S(0), 0};
  }

  // Mirrored if necessary, so that the pendulum falls towards smaller x.
  const auto upright = detail::ShiftedMoment<S>::at(c, equilibrium.angle);
  const S sense = upright.moment(amplitude) >= S(0) ? S(1) : S(-1);
  const auto moment = sense > S(0) ? upright : upright.mirrored();
  const S release = sense * amplitude;

  std::vector<S> stops;
  for (const Equilibrium<S>& other : all) {
    const bool own = other.angle == equilibrium.angle;
    const S at = own ? S(0) : S(sense * (other.angle - equilibrium.angle));
    for (int turn = -2; turn <= 2; ++turn) {
      const S stop = at + S(2 * turn) * pi;
      const bool same = abs(S(stop - release)) <= S(16) * epsilon * pi;
      if (same && !(own && turn == 0)) {
        std::ostringstream text;
        text.precision(10);
        text << "amplitude = " << amplitude
             << " rad releases the pendulum at the equilibrium phi = " << other.angle
             << " rad: it stays there";
        throw InvalidInput(text.str());
      }
      if (stop < release) stops.push_back(stop);
    }
  }
  std::sort(stops.begin(), stops.end(), [](const S& a, const S& b) { return a > b; });
  const S other = *detail::climb(moment, release, S(0), stops, sense, equilibrium.angle);

  const detail::Swing<S> swing{moment, other, release, body.theta_c};
  S worst_condition(1);
  const auto integrand = [&](const S& s) {
    const auto pace = swing.pace(sin(S(pi / S(4) + s / S(2))), sin(S(pi / S(4) - s / S(2))));
    worst_condition = std::max(worst_condition, pace.condition);
    return pace.time;
  };

  // Each doubling squares the error of the rule, up to a factor: 1e4 allows for a slow start.
  const S converged = exp(S(log(epsilon) * S(2) / S(3)));
  S sum = (integrand(S(-pi / S(2))) + integrand(S(pi / S(2)))) / S(2);
  S lost(0);
  const auto add = [&](const S& term) {  // compensated: there may be 2^18 terms
    const S corrected = term - lost;
    const S next = sum + corrected;
    lost = (next - sum) - corrected;
    sum = next;
  };
  int intervals = 8;
  for (int i = 1; i < intervals; ++i) {
    add(integrand(S(pi * S(2 * i - intervals) / S(2 * intervals))));
  }
  S period = S(2) * pi * sum / S(intervals);
  for (;;) {
    for (int i = 0; i < intervals; ++i) {
      add(integrand(S(pi * S(2 * i + 1 - intervals) / S(2 * intervals))));
    }
    intervals *= 2;
    const S refined = S(2) * pi * sum / S(intervals);
    const S change = abs(S(refined - period));
    period = refined;
    if (change <= converged * period) {
      return {period, amplitude, sense * other, S(10000) * change * change / period, intervals + 1};
    }
    if (change <= S(4) * epsilon * worst_condition * period) {
      return {period, amplitude, sense * other, change, intervals + 1};
    }
    if (!(intervals < most_nodes)) {
      std::ostringstream text;
      text.precision(3);
      text << "the period at amplitude " << amplitude << " rad did not converge: " << intervals + 1
           << " nodes leave an error of " << change << " s; the release is too near a barrier";
      throw ComputationFailed(text.str());
    }
  }
}

}  // namespace kreisel
