#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <sstream>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <dynamics/guide/pose_series.hpp>
#include <dynamics/guide/series.hpp>
#include <motor/double_double_functions.hpp>

namespace kreisel {

/// A vector as a sum of oscillations:  constant + sum amplitude sin(frequency t + phase).
///
/// Units  : rad/s, radian
template <class S = double>
struct HarmonicSeries {
  struct Term {
    Vector3<S> amplitude = Vector3<S>::Zero();
    S frequency = S(0);
    S phase = S(0);
  };

  Vector3<S> constant = Vector3<S>::Zero();
  std::vector<Term> terms = {};

  [[nodiscard]] Vector3<S> operator()(const S& t) const {
    using std::sin;
    Vector3<S> sum = constant;
    for (const Term& k : terms) sum += k.amplitude * sin(k.frequency * t + k.phase);
    return sum;
  }

  /// The value and the rate. Sine and cosine of an angle cost little more than one of them.
  [[nodiscard]] std::pair<Vector3<S>, Vector3<S>> with_rate(const S& t) const {
    using std::cos;
    using std::sin;
    Vector3<S> sum = constant;
    Vector3<S> rate = Vector3<S>::Zero();
    for (const Term& k : terms) {
      const S angle = k.frequency * t + k.phase;
      sum += k.amplitude * sin(angle);
      rate += k.amplitude * (k.frequency * cos(angle));
    }
    return {sum, rate};
  }

  [[nodiscard]] Vector3<S> rate(const S& t) const { return with_rate(t).second; }

  /// The coefficients up to `order`, in powers of (time - t)/h.
  [[nodiscard]] std::vector<Vector3<S>> coefficients(const S& t, const S& h, int order) const {
    using std::cos;
    using std::sin;
    std::vector<Vector3<S>> result(static_cast<std::size_t>(order) + 1, Vector3<S>::Zero());
    result[0] = constant;
    for (const Term& k : terms) {
      const S s = sin(k.frequency * t + k.phase);
      const S c = cos(k.frequency * t + k.phase);
      const S cycle[] = {s, c, -s, -c};
      S factor(1);  // (w h)^n / n!
      for (std::size_t n = 0; n < result.size(); ++n) {
        result[n] += k.amplitude * (factor * cycle[n % 4]);
        factor *= k.frequency * h / S(static_cast<double>(n + 1));
      }
    }
    return result;
  }

  /// The same series in another scalar.
  template <class T>
  [[nodiscard]] HarmonicSeries<T> cast() const {
    HarmonicSeries<T> result{constant.template cast<T>(), {}};
    for (const Term& k : terms) {
      result.terms.push_back({k.amplitude.template cast<T>(), T(k.frequency), T(k.phase)});
    }
    return result;
  }
};

/// A frame in harmonic motion: roll, pitch, heave. Angular velocity u(t) and inertial acceleration
/// a(t) of the origin are given on the frame's OWN axes, as strapdown sensors measure them.
///
/// u, ou and a are sums of the series. Attitude and position have no closed form if u has more than
/// one axis. They are Taylor series in pieces of 1/(2 Omega), Omega = |u|/2 + the greatest
/// frequency, computed over [begin, end] by the constructor.
///
/// Units  : rad/s, m/s^2, second
/// Error  : attitude <= 40u, position <= 20u of the path, against long double integration over 62
///          s; <= 90u after 2000 s against a closed form     (tests/dynamics/guide/kinds.cpp)
/// Cost   : 1.1 kB for each piece
/// Throws : InvalidInput: a number that is not finite, end before begin; a time outside [begin,
///          end]
template <class G = Guide, class I = Inertial, class S = double>
class HarmonicFrame {
 public:
  /// `X` and `origin_velocity` (on I's axes) are the values at the time `begin`.
  HarmonicFrame(HarmonicSeries<S> angular_velocity, HarmonicSeries<S> origin_acceleration,
                const S& begin, const S& end, const Displacement<I, G, S>& X = {},
                const Vector3<S>& origin_velocity = Vector3<S>::Zero())
      : u_(std::move(angular_velocity)),
        a_(std::move(origin_acceleration)),
        pose_("harmonic frame", degree) {
    check(u_, "angular velocity");
    check(a_, "origin acceleration");
    if (!(begin <= end && begin - begin == end - end)) {
      std::ostringstream text;
      text << "harmonic frame: begin = " << begin << " s, end = " << end
           << " s: begin must not be after end";
      throw InvalidInput(text.str());
    }
    integrate(begin, end, X.value, origin_velocity);
  }

  [[nodiscard]] FrameMotion<G, I, S> operator()(const S& t) const {
    const PoseDerivatives<S> pose = pose_(t);
    FrameMotion<G, I, S> motion;
    motion.X.value = Pose<S>::from(pose.q, pose.x);
    const auto [u, du] = u_.with_rate(t);
    const Vector3<S> v = motion.X.value.rotation.transpose() * pose.dx;
    motion.V.value = {u, v};
    motion.dV.value = {du, a_(t) - u.cross(v)};
    return motion;
  }

  /// A vector at rest in the inertial frame turns on these axes:  og = -u x g.
  [[nodiscard]] GuideSeries series(
      double t, double h, int order,
      const detail::Components<double>& g) const requires std::is_same_v<S, double> {
    const std::vector<Vector3<double>> u = u_.coefficients(t, h, order);
    const std::vector<Vector3<double>> a = a_.coefficients(t, h, order);
    GuideSeries result;
    GuideSeries::Coefficients down;
    down[0] = rotated_back(detail::Rotation<double>::from(pose_(t).q), g);
    for (std::size_t n = 0; n < u.size(); ++n) {
      result.u[n] = detail::components(u[n]);
      result.g[n] = down[n] - detail::components(a[n]);
      if (n + 1 == u.size()) break;
      detail::Components<double> sum;
      for (std::size_t k = 0; k <= n; ++k) sum = sum + cross(down[n - k], result.u[k]);
      down[n + 1] = (h / double(n + 1)) * sum;
    }
    return result;
  }

  [[nodiscard]] FrameTurning<S> turning(const S& t) const {
    pose_.require(t);
    const auto [u, du] = u_.with_rate(t);
    return {u, du};
  }

 private:
  static constexpr int degree = 18;

  // The chain of pieces is computed with more digits than it is evaluated with.
  using Wide =
      std::conditional_t<std::is_same_v<S, double> || std::is_same_v<S, float>, DoubleDouble, S>;

  static void check(const HarmonicSeries<S>& series, const char* what) {
    const auto finite = [](const auto& x) { return x - x == S(0); };
    bool good = (series.constant - series.constant).isZero(S(0));
    for (const auto& k : series.terms) {
      good = good && (k.amplitude - k.amplitude).isZero(S(0)) && finite(k.frequency) &&
             finite(k.phase);
    }
    if (!good) throw InvalidInput(std::string("harmonic frame: ") + what + " is not finite");
  }

  void integrate(const S& begin, const S& end, const Pose<S>& X, const Vector3<S>& velocity) {
    using std::abs;
    const HarmonicSeries<Wide> u = u_.template cast<Wide>();
    const HarmonicSeries<Wide> a = a_.template cast<Wide>();
    S size = u_.constant.norm();
    S frequency(0);
    for (const auto& k : u_.terms) {
      size += k.amplitude.norm();
      frequency = std::max(frequency, S(abs(k.frequency)));
    }
    for (const auto& k : a_.terms) frequency = std::max(frequency, S(abs(k.frequency)));
    const S omega = size / S(2) + frequency;
    const S span = end - begin;
    const S wanted = 2 * omega * span;
    if (!(wanted < S(1e8))) {
      throw InvalidInput(
          "harmonic frame: more than 1e8 pieces of 1/(2 Omega) between begin and end");
    }
    const auto pieces = static_cast<std::size_t>(wanted) + 1;

    detail::PoseChain<Wide> chain{quaternion(X.rotation).template cast<Wide>(),
                                  X.translation.template cast<Wide>(),
                                  velocity.template cast<Wide>()};
    for (std::size_t piece = 0; piece < pieces; ++piece) {
      const auto at = [&](std::size_t k) {
        return k == pieces ? end : S(begin + span * (S(double(k)) / S(double(pieces))));
      };
      const S t = at(piece);
      const Wide step = Wide(at(piece + 1)) - Wide(t);
      detail::append_piece(pose_, chain, t, step, u.coefficients(Wide(t), Wide(1), degree),
                           a.coefficients(Wide(t), Wide(1), degree),
                           Vector3<Wide>(Vector3<Wide>::Zero()));
    }
    pose_.end_at(end);
  }

  HarmonicSeries<S> u_;
  HarmonicSeries<S> a_;
  PiecewisePose<S> pose_;
};

}  // namespace kreisel
