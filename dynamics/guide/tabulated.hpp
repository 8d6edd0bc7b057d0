#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <dynamics/guide/spline.hpp>

namespace kreisel {

/// A logged motion: times, attitudes (G to I) and positions of G's origin on I's axes.
template <class S = double>
struct MotionLog {
  std::vector<S> times;
  std::vector<Eigen::Quaternion<S>> attitudes;
  std::vector<Vector3<S>> positions;  ///< empty: the origin rests

  /// s; the first and the last time may be late or early by up to this much, and those between them
  /// in proportion. The error of the log contains it.
  S late = S(0);
};

/// The spline that follows a log: its degree, and the number of samples per knot. One sample per
/// knot interpolates; more samples per knot smooth their noise. See smoothing() in log_noise.hpp.
struct LogSpline {
  std::size_t degree = 5;  ///< odd; less where the log is too short for it
  std::size_t attitude_every = 1;
  std::size_t position_every = 1;

  /// The degree for this number of samples.
  [[nodiscard]] std::size_t degree_for(std::size_t samples) const {
    return std::min(degree, samples < 6 ? 3 : (samples - 2) / 2 * 2 + 1);
  }
};

/// The greatest error of an interpolated motion over the table.
///
/// Units  : radian, rad/s, rad/s^2; metre, m/s, m/s^2
template <class S = double>
struct InterpolationError {
  S attitude;
  S angular_velocity;
  S angular_acceleration;
  S position;
  S velocity;
  S acceleration;
};

/// A frame whose motion was logged.
///
/// A quintic spline runs through the samples, both of the quaternion's four components and of the
/// position. It has four continuous derivatives, and is cubic for less than six samples. The
/// quaternion is then divided by its norm, which differs from 1 only by the interpolation error.
///
/// The motion does therefore not depend on the choice of either frame's axes, and angular velocity
/// and acceleration are exact derivatives of the attitude. Samples may be unevenly spaced; q and -q
/// count as the same attitude.
///
/// By default the spline does not smooth. Noise e of the samples causes about e/h in the velocity
/// and e/h^2 in the acceleration, and the error estimate contains both. A LogSpline with fewer
/// knots smooths.
///
/// Error  : O(h^6) attitude, O(h^5) angular velocity, O(h^4) angular acceleration, h the spacing;
///          interpolation_error() estimates them
/// Throws : InvalidInput: under four samples, lengths that differ, a number that is not finite,
///          times that do not increase, a quaternion whose norm is not 1 within 1 %, a rotation of
///          more than 90 degrees from one sample to the next (the motion between them is then
///          unknown)
template <class G = Guide, class I = Inertial, class S = double>
class TabulatedFrame {
 public:
  explicit TabulatedFrame(MotionLog<S> log, LogSpline spline = {})
      : log_(checked(std::move(log))), pose_(fitted(log_, spline)) {}

  [[nodiscard]] FrameMotion<G, I, S> operator()(const S& t) const {
    return frame_motion<G, I>(pose_(t));
  }

  /// The spline itself; the norm of its quaternion is not exactly 1.
  [[nodiscard]] PoseDerivatives<S> derivatives(const S& t) const { return pose_(t); }

  [[nodiscard]] const S& begin() const { return pose_.begin(); }
  [[nodiscard]] const S& end() const { return pose_.end(); }

  /// The log with unit quaternions that do not change sign from one sample to the next.
  [[nodiscard]] const MotionLog<S>& samples() const { return log_; }

  /// The error that interpolation adds to the error of the samples, estimated from the samples
  /// themselves.
  ///
  /// The motion is interpolated again from every second and every fourth sample. The ratio of the
  /// two distances from the spline is the factor of convergence: near 2^6, 2^5, 2^4 for smooth
  /// motion and fine sampling, near 1 for noise. The estimate is the first distance divided by this
  /// factor, times a safety factor of 1.6. For less than 24 samples it is the distance from the
  /// cubic spline, which is too careful.
  ///
  /// Error  : estimate / true error 1.5 to 2.8 where the log is fine enough for an estimate under
  ///          1e-8, 1 to 15 where the log is coarse (tests/dynamics/guide/tabulated.cpp)
  [[nodiscard]] InterpolationError<S> interpolation_error() const {
    using std::max;
    const std::size_t n = log_.times.size();
    if (n < 24) return distance(fitted(log_, {full_degree(n) - 2}));
    const InterpolationError<S> half = distance(fitted(thinned(2), {5}));
    const InterpolationError<S> quarter = distance(fitted(thinned(4), {5}));
    const auto shrunk = [](const S& coarse, const S& fine, double most) {
      if (fine == S(0)) return S(0);
      return S(S(1.6) * fine / std::clamp(S(coarse / fine), S(1), S(most)));
    };
    return {shrunk(quarter.attitude, half.attitude, 64),
            shrunk(quarter.angular_velocity, half.angular_velocity, 32),
            shrunk(quarter.angular_acceleration, half.angular_acceleration, 16),
            shrunk(quarter.position, half.position, 64),
            shrunk(quarter.velocity, half.velocity, 32),
            shrunk(quarter.acceleration, half.acceleration, 16)};
  }

 private:
  [[nodiscard]] static std::size_t full_degree(std::size_t samples) { return samples < 6 ? 3 : 5; }

  [[nodiscard]] static PiecewisePose<S> fitted(const MotionLog<S>& log, const LogSpline& how) {
    const std::size_t p = how.degree_for(log.times.size());
    const detail::SplineInterpolation<S> attitude(log.times, components(log), p,
                                                  how.attitude_every);
    if (how.attitude_every == how.position_every) return attitude.pieces("motion log");
    const detail::SplineInterpolation<S> position(log.times, components(log), p,
                                                  how.position_every);
    return attitude.pieces_with(position, "motion log");
  }

  [[nodiscard]] static std::vector<typename PiecewisePose<S>::Components> components(
      const MotionLog<S>& log) {
    std::vector<typename PiecewisePose<S>::Components> values;
    for (std::size_t i = 0; i < log.times.size(); ++i) {
      values.push_back(PiecewisePose<S>::components(log.attitudes[i], log.positions[i]));
    }
    return values;
  }

  /// Every step-th sample, and the last.
  [[nodiscard]] MotionLog<S> thinned(std::size_t step) const {
    MotionLog<S> result;
    const std::size_t last = log_.times.size() - 1;
    for (std::size_t i = 0; i <= last; i += (last - i < 2 * step && i != last) ? last - i : step) {
      result.times.push_back(log_.times[i]);
      result.attitudes.push_back(log_.attitudes[i]);
      result.positions.push_back(log_.positions[i]);
    }
    return result;
  }

  /// The greatest differences from another interpolation, taken at and between the samples.
  [[nodiscard]] InterpolationError<S> distance(const PiecewisePose<S>& other) const {
    using std::max;
    InterpolationError<S> most{S(0), S(0), S(0), S(0), S(0), S(0)};
    const auto compare = [&](const S& t) {
      const FrameMotion<G, I, S> a = frame_motion<G, I>(pose_(t));
      const FrameMotion<G, I, S> b = frame_motion<G, I>(other(t));
      const Pose<S>& A = a.X.value;
      const Pose<S>& B = b.X.value;
      const S turn = log(Pose<S>{A.rotation.transpose() * B.rotation}).resultant.norm();
      most.attitude = max(most.attitude, turn);
      const Motor<S> V = a.V.value - b.V.value;
      const Motor<S> dV = a.dV.value - b.dV.value;
      most.angular_velocity = max(most.angular_velocity, V.resultant.norm());
      most.angular_acceleration = max(most.angular_acceleration, dV.resultant.norm());
      most.position = max(most.position, (A.translation - B.translation).norm());
      most.velocity = max(most.velocity,
                          (A.rotation * a.V.value.moment - B.rotation * b.V.value.moment).norm());
      most.acceleration =
          max(most.acceleration,
              (A.rotation * a.origin_acceleration() - B.rotation * b.origin_acceleration()).norm());
    };
    for (std::size_t i = 0; i + 1 < log_.times.size(); ++i) {
      compare(log_.times[i]);
      compare(log_.times[i] + (log_.times[i + 1] - log_.times[i]) / S(2));
    }
    compare(log_.times.back());
    return most;
  }

  /// The log with unit quaternions that do not change sign from one sample to the next.
  [[nodiscard]] static MotionLog<S> checked(MotionLog<S> log) {
    using std::abs;
    const std::size_t n = log.times.size();
    const auto refuse = [&log](std::size_t i, const auto&... words) {
      std::ostringstream text;
      text.precision(10);
      text << "motion log: ";
      if (i < log.times.size()) text << "sample " << i + 1 << ", t = " << log.times[i] << " s: ";
      (text << ... << words);
      throw InvalidInput(text.str());
    };
    const auto finite = [](const auto& v) { return (v - v).isZero(S(0)); };
    if (n < 4) refuse(n, n, " samples where a motion needs 4 or more");
    if (log.positions.empty()) log.positions.assign(n, Vector3<S>::Zero());
    if (log.attitudes.size() != n || log.positions.size() != n) {
      refuse(n, n, " times, ", log.attitudes.size(), " attitudes, ", log.positions.size(),
             " positions");
    }
    for (std::size_t i = 0; i < n; ++i) {
      Eigen::Quaternion<S>& q = log.attitudes[i];
      const bool known =
          log.times[i] - log.times[i] == S(0) && finite(q.coeffs()) && finite(log.positions[i]);
      if (!known) refuse(i, "not a finite number");
      if (i > 0 && !(log.times[i] > log.times[i - 1])) {
        refuse(i, "must be later than the sample before, t = ", log.times[i - 1], " s");
      }
      const S norm = q.norm();
      if (!(abs(norm - S(1)) <= S(0.01))) refuse(i, "the quaternion has norm ", norm, ", not 1");
      q.coeffs() /= norm;
      if (i == 0) continue;
      const S cosine = q.dot(log.attitudes[i - 1]);
      if (abs(cosine) < S(0.70710678118654752)) {
        refuse(i, "rotated by more than 90 degrees since the sample before: the log is too coarse");
      }
      if (cosine < S(0)) q.coeffs() = -q.coeffs();
    }
    return log;
  }

  MotionLog<S> log_;
  PiecewisePose<S> pose_;
};

}  // namespace kreisel
