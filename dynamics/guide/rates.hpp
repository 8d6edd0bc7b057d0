#pragma once

#include <cmath>
#include <cstddef>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <dynamics/guide/pose_series.hpp>
#include <dynamics/guide/tabulated.hpp>
#include <motor/double_double_functions.hpp>

namespace kreisel {

/// A log of the gyros and accelerometers of a frame, on the frame's own axes.
///
/// Units  : s, rad/s, m/s^2
struct RatesLog {
  std::vector<double> times;
  std::vector<Vector3<double>> angular_velocities;
  std::vector<Vector3<double>> accelerations;  ///< of the origin; empty: it is not accelerated
  double late = 0;                             ///< s, as MotionLog::late
};

namespace detail {

/// Angular velocity, 0, acceleration of a sample.
[[nodiscard]] inline PiecewisePose<double>::Components rates_components(const RatesLog& log,
                                                                        std::size_t i) {
  const Vector3<double> rest = Vector3<double>::Zero();
  return (PiecewisePose<double>::Components() << log.angular_velocities[i], 0,
          log.accelerations.empty() ? rest : log.accelerations[i])
      .finished();
}

}  // namespace detail

/// The initial conditions that a log of rates does not contain. They are attitude and velocity of
/// the frame G in I at the log's first time, and the gravity missing in its accelerations.
///
/// Frame  : attitude G to I, the rest on I's axes
struct RatesStart {
  Eigen::Quaterniond attitude = Eigen::Quaterniond::Identity();
  Vector3<double> velocity = Vector3<double>::Zero();  ///< of G's origin, which begins at I's

  /// Added to the logged accelerations. Accelerometers give the specific force f, and the
  /// acceleration is f + gravity. For kinematic accelerations it is 0.
  Vector3<double> gravity = Vector3<double>::Zero();
};

/// A frame whose angular velocity and acceleration were logged (strapdown integration).
///
///   q' = q u / 2,   x'' = q f q^-1 + gravity
///
/// A spline runs through the samples of u and f or smooths them, as in TabulatedFrame. The spline
/// is a polynomial between its knots, and there the equations are solved by the power series of q
/// and x. The attitude and position are thus the exact motion for the spline.
///
/// Angular velocity and acceleration are the spline itself, so noise is not differentiated but
/// integrated: noise e of u causes an attitude error of about e sqrt(h t).
///
/// Error  : <= 1e-12 rad after 1e4 rad (tests/dynamics/guide/rates.cpp), plus the error of the
///          spline, O(h^6) of u
/// Throws : InvalidInput: under four samples, lengths that differ, a number that is not finite,
///          times that do not increase, an attitude whose norm is not 1 within 1 %, a turn of more
///          than 1e7 rad
template <class G = Guide, class I = Inertial>
class RatesFrame {
 public:
  explicit RatesFrame(const RatesLog& log, const RatesStart& start = {}, LogSpline spline = {})
      : pose_("log of rates", degree) {
    check(log, start);
    integrate(fitted(log, spline), start);
  }

  [[nodiscard]] FrameMotion<G, I> operator()(double t) const {
    return frame_motion<G, I>(pose_(t));
  }

  [[nodiscard]] double begin() const { return pose_.begin(); }
  [[nodiscard]] double end() const { return pose_.end(); }

 private:
  static constexpr int degree = 12;
  using Wide = DoubleDouble;
  using Taylor = std::vector<Vector3<Wide>>;

  static void check(const RatesLog& log, const RatesStart& start) {
    const std::size_t n = log.times.size();
    const auto refuse = [](const auto&... words) {
      std::ostringstream text;
      text.precision(10);
      text << "log of rates: ";
      (text << ... << words);
      throw InvalidInput(text.str());
    };
    if (n < 4) refuse(n, " samples where a motion needs 4 or more");
    if (log.angular_velocities.size() != n ||
        (!log.accelerations.empty() && log.accelerations.size() != n)) {
      refuse(n, " times, ", log.angular_velocities.size(), " angular velocities, ",
             log.accelerations.size(), " accelerations");
    }
    for (std::size_t i = 0; i < n; ++i) {
      const bool known = std::isfinite(log.times[i]) && log.angular_velocities[i].allFinite() &&
                         (log.accelerations.empty() || log.accelerations[i].allFinite());
      if (!known) refuse("sample ", i + 1, ": not a finite number");
      if (i > 0 && !(log.times[i] > log.times[i - 1])) {
        refuse("sample ", i + 1, ", t = ", log.times[i],
               " s: must be later than the sample before, t = ", log.times[i - 1], " s");
      }
    }
    if (!start.velocity.allFinite() || !start.gravity.allFinite()) {
      refuse("the start must be finite");
    }
    if (!(std::abs(start.attitude.norm() - 1) <= 0.01)) {
      refuse("the first attitude has norm ", start.attitude.norm(), ", not 1");
    }
  }

  /// The spline with u in the first three components and f in the last three.
  [[nodiscard]] static PiecewisePose<double> fitted(const RatesLog& log, const LogSpline& how) {
    std::vector<PiecewisePose<double>::Components> values;
    for (std::size_t i = 0; i < log.times.size(); ++i) {
      values.push_back(detail::rates_components(log, i));
    }
    const std::size_t p = how.degree_for(log.times.size());
    const detail::SplineInterpolation<double> u(log.times, values, p, how.attitude_every);
    if (how.attitude_every == how.position_every) return u.pieces("log of rates");
    const detail::SplineInterpolation<double> f(log.times, values, p, how.position_every);
    return u.pieces_with(f, "log of rates");
  }

  void integrate(const PiecewisePose<double>& rates, const RatesStart& start) {
    detail::PoseChain<Wide> chain{start.attitude.cast<Wide>(), Vector3<Wide>::Zero(),
                                  start.velocity.cast<Wide>()};
    const Vector3<Wide> gravity = start.gravity.cast<Wide>();
    const auto& begins = rates.breakpoints();
    double pieces = 0;
    for (std::size_t k = 0; k < begins.size(); ++k) {
      const double end = k + 1 < begins.size() ? begins[k + 1] : rates.end();
      const double length = end - begins[k];
      double turn = 0;
      double power = length;
      for (const auto& c : rates.coefficients(k)) {
        turn += c.template head<3>().norm() * power;
        power *= length;
      }
      // The series of a quarter of a radian has a remainder of 1e-17 after its twelfth power.
      const double parts = std::ceil(std::max(4 * turn, 1.0));
      pieces += parts;
      if (!(pieces < 1e8)) throw InvalidInput("log of rates: turns by more than 1e7 rad");
      for (double part = 0; part < parts; ++part) {
        const double t = begins[k] + length * (part / parts);
        const double next = part + 1 < parts ? begins[k] + length * ((part + 1) / parts) : end;
        const auto [u, f] = shifted(rates, k, Wide(t) - Wide(begins[k]));
        append_piece(pose_, chain, t, Wide(next) - Wide(t), u, f, gravity);
      }
    }
    pose_.end_at(rates.end());
  }

  /// The polynomials of u and f about a time that lies `by` after the begin of their piece.
  [[nodiscard]] static std::pair<Taylor, Taylor> shifted(const PiecewisePose<double>& rates,
                                                         std::size_t piece, Wide by) {
    Taylor u(degree + 1, Vector3<Wide>::Zero());
    Taylor f = u;
    const auto coefficients = rates.coefficients(piece);
    for (std::size_t n = 0; n < coefficients.size(); ++n) {
      u[n] = coefficients[n].template head<3>().template cast<Wide>();
      f[n] = coefficients[n].template tail<3>().template cast<Wide>();
    }
    for (std::size_t i = 0; i + 1 < coefficients.size(); ++i) {
      for (std::size_t n = coefficients.size() - 1; n-- > i;) {
        u[n] += by * u[n + 1];
        f[n] += by * f[n + 1];
      }
    }
    return {std::move(u), std::move(f)};
  }

  PiecewisePose<double> pose_;
};

}  // namespace kreisel
