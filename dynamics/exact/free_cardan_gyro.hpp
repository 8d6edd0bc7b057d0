#pragma once

#include <cstddef>
#include <numbers>
#include <vector>

#include <dynamics/exact/elliptic.hpp>
#include <motor/error.hpp>
#include <motor/motor.hpp>

namespace kreisel::exact {

/// The free gyro in Cardan's suspension on a frame at rest: a symmetric rotor in two rings with
/// mass, without springs, friction and torques. Its motion is one quadrature, for nutations of any
/// size.
///
/// H is the momentum of the spin, p that of everything about the outer axis, e twice the energy
/// without the part of H. With s = sin(beta):
///
///   p = J alpha' + H s,   e = B beta'^2 + J alpha'^2,   J = j_0 - j_1 s^2,   B = A_1 + B_2,
///   j_0 = A_1 + A_2 + A_3,   j_1 = A_1 + A_2 - C,   C = C_2, or C_2 + C_1 for a regulated rotor,
///   H = C_1 (phi' + alpha' s), or C_1 phi' for a regulated rotor
///
///   B J s'^2 = K (1 - s^2) (s - s_1)(s_2 - s),   K = H^2 + e j_1
///
/// s oscillates between s_1 and s_2, so that  s = (s_1 + s_2)/2 - (s_2 - s_1)/2 cos(theta)  and
///
///   dt/dtheta = sqrt(B J/(K (1 - s^2))),   dalpha/dt = (p - H s)/J,   dphi/dt = H/C_1 - alpha' s
///
/// are smooth functions with the period 2 pi. Their Fourier series are integrated term by term. No
/// difference of nearly equal numbers occurs. The drift about the outer axis is the ratio of two
/// means, exact for every amplitude: gimbal_drift() is its limit for small ones.
///
/// Source : paper 002 (35)-(40) corrected, with their three first integrals
/// Units  : kg m^2, rad, rad/s, s
/// Error  : of the phase 2^-58 (|theta| + 16), far from the upright rings
///          (tests/dynamics/exact/free_cardan_gyro.cpp)
/// Throws : ComputationFailed if the rings turn over, or come so near to beta = 90 degrees that
///          1024 terms are not enough
class FreeCardanGyro {
 public:
  struct State {
    Real alpha, beta, phi;
    Real alpha_rate, beta_rate, phi_rate;
  };

  /// Moments (A, B, C) of the bodies, on the axes of CardanMoments; the rotor is symmetric.
  FreeCardanGyro(const Vector3<double>& rotor, const Vector3<double>& inner_ring,
                 const Vector3<double>& outer_ring, bool regulated, const State& start)
      : regulated_(regulated), start_(start) {
    const Real A = rotor.x();
    const Real carried = Real(inner_ring.z()) + (regulated ? Real(rotor.z()) : 0);
    spin_moment_ = rotor.z();
    ring_moment_ = A + inner_ring.y();
    j_0_ = A + inner_ring.x() + outer_ring.x();
    j_1_ = A + inner_ring.x() - carried;
    half_turns_ = round(start.beta / pi);
    side_ = fmod(half_turns_, Real(2)) == 0 ? 1 : -1;
    const Real s = sin(start.beta);
    spin_momentum_ = spin_moment_ * (start.phi_rate + (regulated ? 0 : start.alpha_rate * s));
    const Real J = moment(s);
    const Real e =
        ring_moment_ * start.beta_rate * start.beta_rate + J * start.alpha_rate * start.alpha_rate;
    p_ = J * start.alpha_rate + spin_momentum_ * s;
    factor_ = spin_momentum_ * spin_momentum_ + e * j_1_;
    if (!(factor_ > 0)) throw ComputationFailed("free Cardan gyro: its rings turn over or rest");
    middle_ = p_ * spin_momentum_ / factor_;
    // (middle - s) and the sine's part: their sum of squares is the amplitude's.
    const Real cosine = (J * start.alpha_rate * spin_momentum_ - e * j_1_ * s) / factor_;
    const Real sine = side_ * start.beta_rate * sqrt(ring_moment_ * J / factor_);
    amplitude_ = hypot(cosine, sine);
    const Real begin = atan2(sine, cosine);
    if (!(abs(middle_) + amplitude_ < 1)) {
      throw ComputationFailed("free Cardan gyro: its rings turn over");
    }
    find_series();
    begin_ = integrals(begin);
  }

  /// The period of beta.
  [[nodiscard]] Real period() const { return 2 * pi * means_.time; }
  /// The mean of alpha': the drift about the outer axis.
  [[nodiscard]] Real drift() const { return means_.alpha / means_.time; }
  /// The phase theta that passes in a time.
  [[nodiscard]] Real phase(Real time) const { return abs(time / means_.time); }

  /// Throws : ComputationFailed for a time that is not finite
  [[nodiscard]] State at(Real time) const {
    if (!isfinite(time)) throw ComputationFailed("free Cardan gyro: the time is not finite");
    const Real from_zero = time + begin_.time;
    const Real turns = round(from_zero / period());
    const Real theta = phase_at(from_zero - turns * period());
    const Integrals now = integrals(theta);
    const Real s = middle_ - amplitude_ * cos(theta);
    const Real alpha_rate = rate_of_alpha(theta);
    const Real whole = 2 * pi * turns;
    State state{};
    state.alpha = start_.alpha + (now.alpha - begin_.alpha) + whole * means_.alpha;
    state.beta = pi * half_turns_ + side_ * atan2(s, sqrt((1 - s) * (1 + s)));
    state.phi = regulated_ ? start_.phi + start_.phi_rate * time
                           : start_.phi + (now.phi - begin_.phi) + whole * means_.phi;
    state.alpha_rate = alpha_rate;
    state.beta_rate = side_ * amplitude_ * sin(theta) * sqrt(factor_ / (ring_moment_ * moment(s)));
    state.phi_rate = regulated_ ? start_.phi_rate : spin_momentum_ / spin_moment_ - alpha_rate * s;
    return state;
  }

 private:
  static constexpr Real pi = std::numbers::pi_v<Real>;
  static constexpr std::size_t most_nodes = 2048;
  static constexpr double rounding = 0x1p-64;  ///< of the series, far below that of a double

  /// Time and angles as functions of theta, or their means and terms.
  struct Integrals {
    Real time = 0, alpha = 0, phi = 0;
  };

  [[nodiscard]] Real moment(Real s) const { return j_0_ - j_1_ * s * s; }

  /// alpha' = (p - H s)/J, with p - H middle = p (1 - H^2/K).
  [[nodiscard]] Real rate_of_alpha(Real theta) const {
    const Real c = amplitude_ * cos(theta);
    return (p_ * ((factor_ - spin_momentum_ * spin_momentum_) / factor_) + spin_momentum_ * c) /
           moment(middle_ - c);
  }

  /// The derivatives with respect to theta.
  [[nodiscard]] Integrals slopes(Real theta) const {
    const Real s = middle_ - amplitude_ * cos(theta);
    const Real time = sqrt(ring_moment_ * moment(s) / (factor_ * (1 - s) * (1 + s)));
    const Real alpha = rate_of_alpha(theta);
    return {time, alpha * time, (spin_momentum_ / spin_moment_ - alpha * s) * time};
  }

  /// Doubles the nodes until the last terms are as small as rounding.
  void find_series() {
    for (std::size_t n = 32; n <= most_nodes; n *= 2) {
      std::vector<Integrals> nodes(n);
      std::vector<Real> cosines(n);
      for (std::size_t j = 0; j < n; ++j) {
        const Real theta = 2 * pi * Real(j) / Real(n);
        cosines[j] = cos(theta);
        nodes[j] = slopes(theta);
      }
      terms_.clear();
      means_ = mean(nodes, cosines, 0);
      const Real small = 4 * rounding * means_.time;
      std::size_t last = 0;  // that counts
      for (std::size_t k = 1; k < n / 2; ++k) {
        const Integrals term = mean(nodes, cosines, k);
        const Real weight = 2 / Real(k);
        terms_.push_back({weight * term.time, weight * term.alpha, weight * term.phi});
        const Real size =
            abs(term.time) + abs(term.alpha) * means_.time / (abs(means_.alpha) + means_.time);
        if (size > small) last = k;
      }
      if (!(last < 3 * n / 8)) continue;
      terms_.resize(last);
      return;
    }
    throw ComputationFailed("free Cardan gyro: its rings come too near to 90 degrees");
  }

  [[nodiscard]] static Integrals mean(const std::vector<Integrals>& nodes,
                                      const std::vector<Real>& cosines, std::size_t k) {
    const std::size_t n = nodes.size();
    Integrals sum;
    for (std::size_t j = 0; j < n; ++j) {
      const Real c = cosines[j * k % n];
      sum.time += nodes[j].time * c;
      sum.alpha += nodes[j].alpha * c;
      sum.phi += nodes[j].phi * c;
    }
    return {sum.time / Real(n), sum.alpha / Real(n), sum.phi / Real(n)};
  }

  [[nodiscard]] Integrals integrals(Real theta) const {
    Integrals sum{means_.time * theta, means_.alpha * theta, means_.phi * theta};
    const Real twice = 2 * cos(theta);
    Real before = 0, s = sin(theta);  // sin((k - 1) theta), sin(k theta)
    for (const Integrals& term : terms_) {
      sum.time += term.time * s;
      sum.alpha += term.alpha * s;
      sum.phi += term.phi * s;
      const Real next = twice * s - before;
      before = s;
      s = next;
    }
    return sum;
  }

  /// The phase at a time within half a period of 0: Newton's method in a bracket. The time
  /// increases with the phase, and both are odd, so the phase lies within half a turn as well.
  [[nodiscard]] Real phase_at(Real time) const {
    Real low = -pi * (1 + Real(1e-6)), high = -low;
    Real theta = time / means_.time;
    for (int i = 0; i < 100; ++i) {
      const Real off = integrals(theta).time - time;
      (off > 0 ? high : low) = theta;
      const Real next = theta - off / slopes(theta).time;
      const Real to = next > low && next < high ? next : (low + high) / 2;
      if (abs(to - theta) <= 16 * rounding * pi) return to;
      theta = to;
    }
    return theta;
  }

  bool regulated_;
  State start_;
  Real spin_moment_ = 0;                         ///< C_1
  Real ring_moment_ = 0, j_0_ = 0, j_1_ = 0;     ///< B, j_0, j_1
  Real spin_momentum_ = 0, p_ = 0, factor_ = 0;  ///< H, p, K, conserved
  Real half_turns_ = 0;                          ///< whole ones of beta at the start
  Real side_ = 1;                                ///< of cos(beta)
  Real middle_ = 0;                              ///< (s_1 + s_2)/2
  Real amplitude_ = 0;                           ///< (s_2 - s_1)/2
  Integrals means_ = {};                         ///< of the slopes
  std::vector<Integrals> terms_;                 ///< of sin(k theta) in the integrals, k = 1, 2, ..
  Integrals begin_ = {};                         ///< at the start's phase
};

}  // namespace kreisel::exact
