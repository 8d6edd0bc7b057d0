#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <random>
#include <vector>

#include <dynamics/guide/rates.hpp>
#include <dynamics/guide/tabulated.hpp>
#include <dynamics/guide/value_log.hpp>

namespace kreisel {

/// The errors of a log's samples, by component: quaternion x, y, z, w, then position x, y, z. For a
/// log of rates: angular velocity, 0, acceleration. For a log of values: 0, values.
struct LogNoise {
  using Components = PiecewisePose<double>::Components;
  Components white = Components::Zero();  ///< standard deviation, independent from sample to sample
  Components step = Components::Zero();   ///< unit of the last written decimal, 0 if there is none
  double late = 0;                        ///< s, as MotionLog::late

  /// True where the estimate is of noise; else the samples are too coarse to separate noise from
  /// motion.
  Eigen::Array<bool, 7, 1> resolved = Eigen::Array<bool, 7, 1>::Constant(true);
};

namespace detail {

using LogComponents = LogNoise::Components;

/// A log by components: its written values and the values that a spline follows.
struct LogSamples {
  std::vector<double> times;
  std::vector<LogComponents> written;
  std::vector<LogComponents> values;
  double late = 0;  ///< as MotionLog::late
};

[[nodiscard]] inline LogSamples samples_of(const MotionLog<double>& log) {
  LogSamples result;
  const TabulatedFrame<> frame(log);
  result.times = log.times;
  result.late = log.late;
  for (std::size_t i = 0; i < log.times.size(); ++i) {
    const auto components = [i](const MotionLog<double>& of) {
      const Vector3<double> rest = Vector3<double>::Zero();
      return PiecewisePose<double>::components(of.attitudes[i],
                                               of.positions.empty() ? rest : of.positions[i]);
    };
    result.written.push_back(components(log));
    result.values.push_back(components(frame.samples()));
  }
  return result;
}

/// Angular velocities in place of the vectors of quaternions, accelerations in place of positions.
[[nodiscard]] inline LogSamples samples_of(const RatesLog& log) {
  LogSamples result;
  result.times = log.times;
  result.late = log.late;
  for (std::size_t i = 0; i < log.times.size(); ++i) {
    result.written.push_back(rates_components(log, i));
  }
  result.values = result.written;
  return result;
}

/// Values in place of positions.
[[nodiscard]] inline LogSamples samples_of(const ValueLog& log) {
  const auto values = value_components(log);
  return {log.times, values, values, log.late};
}

[[nodiscard]] inline MotionLog<double> with_values(MotionLog<double> log,
                                                   const std::vector<LogComponents>& values) {
  log.positions.resize(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    log.attitudes[i].coeffs() = values[i].head<4>().normalized();
    log.positions[i] = values[i].tail<3>();
  }
  return log;
}

[[nodiscard]] inline RatesLog with_values(RatesLog log, const std::vector<LogComponents>& values) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    log.angular_velocities[i] = values[i].head<3>();
    if (!log.accelerations.empty()) log.accelerations[i] = values[i].tail<3>();
  }
  return log;
}

[[nodiscard]] inline ValueLog with_values(ValueLog log, const std::vector<LogComponents>& values) {
  for (std::size_t i = 0; i < values.size(); ++i) log.values[i] = values[i].tail<3>();
  return log;
}

/// The greatest power of ten, from 1e-1 to 1e-12, of which all values are multiples. It is 0 if
/// there is none or if the values do not change.
[[nodiscard]] inline double decimal_step(const std::vector<LogComponents>& values, int first,
                                         int count) {
  const bool rests = std::all_of(values.begin(), values.end(), [&](const LogComponents& value) {
    return value.segment(first, count) == values.front().segment(first, count);
  });
  double scale = 10;
  for (int decimals = 1; !rests && decimals <= 12; ++decimals, scale *= 10) {
    const bool all = std::all_of(values.begin(), values.end(), [&](const LogComponents& value) {
      return (value.segment(first, count).array() * scale)
          .unaryExpr([](double x) {
            return std::abs(x - std::round(x)) <=
                   4 * std::numeric_limits<double>::epsilon() * std::max(std::abs(x), 1.0);
          })
          .all();
    });
    if (all) return 1 / scale;
  }
  return 0;
}

/// Weights of the divided difference over times i to i + order; the sum of their squares is 1.
[[nodiscard]] inline std::vector<double> difference_weights(const std::vector<double>& times,
                                                            std::size_t i, std::size_t order) {
  const double span = times[i + order] - times[i];
  std::vector<double> weight(order + 1, 1);
  double squares = 0;
  for (std::size_t k = 0; k <= order; ++k) {
    for (std::size_t j = 0; j <= order; ++j) {
      if (j != k) weight[k] *= 0.25 * span / (times[i + k] - times[i + j]);
    }
    squares += weight[k] * weight[k];
  }
  for (double& w : weight) w /= std::sqrt(squares);
  return weight;
}

/// The root mean square of the differences of this order, without gaps. Nothing if the log has less
/// than ten of them.
[[nodiscard]] inline std::optional<LogComponents> difference_size(
    const std::vector<double>& times, const std::vector<LogComponents>& values, std::size_t order,
    double step) {
  LogComponents squares = LogComponents::Zero();
  std::size_t count = 0;
  const std::size_t n = times.size();
  const std::size_t stride = 1 + n / 20'000;
  std::size_t since_gap = 0;
  for (std::size_t end = 1; end < n; ++end) {
    since_gap = times[end] - times[end - 1] > 3 * step ? 0 : since_gap + 1;
    if (since_gap < order || end % stride != 0) continue;
    const std::vector<double> weight = difference_weights(times, end - order, order);
    LogComponents sum = LogComponents::Zero();
    for (std::size_t k = 0; k <= order; ++k) {
      sum += weight[k] * (values[end - order + k] - values[end]);
    }
    squares += sum.cwiseAbs2();
    ++count;
  }
  if (count < 10) return std::nullopt;
  return LogComponents((squares / static_cast<double>(count)).cwiseSqrt());
}

}  // namespace detail

/// The errors of a log's samples, MotionLog or RatesLog, estimated from the log itself.
///
/// High-order differences of a smooth motion are small; those of noise are not. The noise is
/// therefore the least value left by the orders 4 to 24, each scaled for independent errors. If no
/// two successive orders agree, the samples are too coarse, and the noise is an upper bound. Errors
/// as smooth as the motion cannot be detected.
///
/// Error  : some 20 % for independent errors and 100 samples
///          (tests/dynamics/guide/log_noise.cpp)
/// Units  : those of the samples
template <class Log>
[[nodiscard]] LogNoise noise_of(const Log& log) {
  LogNoise noise;
  const auto [times, written, values, late] = detail::samples_of(log);
  noise.late = late;
  noise.step.head<4>().setConstant(detail::decimal_step(written, 0, 4));
  noise.step.tail<3>().setConstant(detail::decimal_step(written, 4, 3));
  std::vector<double> steps;
  for (std::size_t i = 1; i < times.size(); ++i) steps.push_back(times[i] - times[i - 1]);
  std::nth_element(steps.begin(), steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2),
                   steps.end());
  const double step = steps[steps.size() / 2];
  LogNoise::Components before = LogNoise::Components::Constant(-1);
  noise.white.setConstant(std::numeric_limits<double>::infinity());
  noise.resolved.setConstant(false);
  for (const std::size_t order : {4U, 6U, 8U, 10U, 12U, 14U, 16U, 18U, 20U, 22U, 24U}) {
    const auto size = detail::difference_size(times, values, order, step);
    if (!size) break;
    for (int c = 0; c < 7; ++c) {
      // Two orders with the same result have found noise.
      noise.resolved[c] = noise.resolved[c] || (*size)[c] > 0.7 * before[c];
      noise.white[c] = std::min(noise.white[c], (*size)[c]);
    }
    before = *size;
  }
  for (double& white : noise.white) {
    if (!std::isfinite(white)) white = 0;  // too few samples, or times too close for differences
  }
  return noise;
}

namespace detail {

/// The sum of squared distances of a spline from its samples.
[[nodiscard]] inline LogComponents squared_residual(const SplineInterpolation<double>& spline,
                                                    const std::vector<double>& times,
                                                    const std::vector<LogComponents>& values) {
  LogComponents sum = LogComponents::Zero();
  for (std::size_t i = 0; i < times.size(); ++i) {
    sum += (spline.value(times[i]) - values[i]).cwiseAbs2();
  }
  return sum;
}

}  // namespace detail

/// The spline that follows a noisy log best. Its knots are so far apart that the expected error
///
///   sum of squared residuals + 2 sigma^2 (control points)
///
/// is least (C. L. Mallows); the residuals are then as great as the noise. Every sample is a knot
/// where interpolation is best, or where the noise is the rounding of doubles. If the last decimal
/// stays constant over many samples, its steps are no noise for a sum of squares. Knots are then at
/// least four steps apart.
///
/// Units  : sigma as LogNoise
template <class Log>
[[nodiscard]] LogSpline smoothing(const Log& log, const LogNoise::Components& sigma) {
  LogSpline best;
  const detail::LogSamples samples = detail::samples_of(log);
  const auto& values = samples.values;
  const std::size_t n = values.size();
  LogNoise::Components size = LogNoise::Components::Zero();
  for (const auto& value : values) size = size.cwiseMax(value.cwiseAbs());
  LogNoise::Components way = LogNoise::Components::Constant(std::numeric_limits<double>::min());
  for (std::size_t i = 1; i < n; ++i) way += (values[i] - values[i - 1]).cwiseAbs();
  const auto choose = [&](const LogNoise::Components& group, double step, std::size_t& every) {
    const double variance = sigma.cwiseAbs2().dot(group);
    const double rounding = 1e-14 * size.cwiseProduct(group).norm();
    if (n < 12 || variance <= rounding * rounding) return;
    double least = 2 * variance * static_cast<double>(n);
    const double apart = 4 * static_cast<double>(n) * step / way.cwiseProduct(group).maxCoeff();
    const std::size_t first = apart < static_cast<double>(n) / 8
                                  ? std::max<std::size_t>(2, static_cast<std::size_t>(apart))
                                  : 2;
    for (std::size_t m = first; m < n; m += 1 + m / 3) {
      const detail::SplineInterpolation<double> spline(samples.times, values, best.degree, m);
      const double residual = detail::squared_residual(spline, samples.times, values).dot(group);
      const double expected = residual + 2 * variance * static_cast<double>(spline.controls());
      if (expected < least) {
        least = expected;
        every = m;
      }
      if (residual > 4 * variance * static_cast<double>(n)) break;
    }
  };
  const auto attitude = (LogNoise::Components() << 1, 1, 1, 1, 0, 0, 0).finished();
  choose(attitude, detail::decimal_step(samples.written, 0, 4), best.attitude_every);
  choose(LogNoise::Components::Ones() - attitude, detail::decimal_step(samples.written, 4, 3),
         best.position_every);
  return best;
}

/// The standard deviations for smoothing a log when the user gives none, from its differences and
/// its last decimals. 0 for components whose samples are too coarse.
[[nodiscard]] inline LogNoise::Components smoothing_sigma(const LogNoise& noise) {
  const double uniform = 1 / std::sqrt(12.0);
  LogNoise::Components sigma = noise.white;
  for (int c = 0; c < 7; ++c) {
    if (!noise.resolved[c]) sigma[c] = 0;
    if (sigma[c] > 0) sigma[c] = std::max(sigma[c], uniform * noise.step[c]);
  }
  return sigma;
}

/// The samples of the spline at the times of the log, or `later` by so many seconds, from the first
/// sample to the last. The polynomials at the ends continue beyond them.
template <class Log>
[[nodiscard]] Log smoothed(const Log& log, const LogSpline& how,
                           const std::array<double, 2>& later = {}) {
  const detail::LogSamples samples = detail::samples_of(log);
  const std::size_t p = how.degree_for(samples.times.size());
  const detail::SplineInterpolation<double> first(samples.times, samples.values, p,
                                                  how.attitude_every);
  const detail::SplineInterpolation<double> last(samples.times, samples.values, p,
                                                 how.position_every);
  std::vector<detail::LogComponents> values;
  const double begin = samples.times.front();
  const double rate = (later[1] - later[0]) / (samples.times.back() - begin);
  for (const double time : samples.times) {
    const double t = time + (later[0] + rate * (time - begin));
    values.push_back(first.value(t));
    values.back().tail<3>() = last.value(t).tail<3>();
  }
  return detail::with_values(log, values);
}

/// Another log that could have been written as well: smoothed, with noise, rounding and delays drawn
/// anew.
///
/// Rounding is drawn as an offset of the decimal grid. The rounding error of a slow motion then
/// stays in steps, and the rounding error of a motion at rest is a constant.
template <class Log>
[[nodiscard]] Log drawn_again(const Log& written, const LogNoise& noise, const LogSpline& smooth,
                              std::uint64_t seed) {
  std::mt19937_64 engine(seed);
  // Sums of twelve draws: equal on every machine, unlike std::normal_distribution.
  const auto uniform = [&engine] { return static_cast<double>(engine() >> 11) * 0x1p-53 - 0.5; };
  const auto normal = [&uniform] {
    double sum = 0;
    for (int i = 0; i < 12; ++i) sum += uniform();
    return sum;
  };
  std::array<double, 2> later{};
  if (noise.late > 0) later = {2 * noise.late * uniform(), 2 * noise.late * uniform()};
  const Log log = smoothed(written, smooth, later);
  auto values = detail::samples_of(log).values;
  LogNoise::Components white = noise.white;
  LogNoise::Components offset;
  for (int c = 0; c < 7; ++c) {
    const double rounded = 0.35 * noise.step[c];  // a last digit's noise, and what drawing it adds
    white[c] = white[c] > rounded ? std::sqrt(white[c] * white[c] - rounded * rounded) : 0;
    offset[c] = noise.step[c] * uniform();
  }
  for (detail::LogComponents& value : values) {
    for (int c = 0; c < 7; ++c) {
      const double step = noise.step[c];
      value[c] += white[c] > 0 ? white[c] * normal() : 0;
      if (step > 0) value[c] = std::round((value[c] + offset[c]) / step) * step - offset[c];
    }
  }
  return detail::with_values(log, values);
}

namespace detail {

/// The log without the part of its samples that only the highest power of time gives. A polynomial
/// through all samples then has one degree less.
template <class Log>
[[nodiscard]] Log without_highest_power(const Log& log) {
  std::vector<LogComponents> values = samples_of(log).values;
  const std::vector<double> weight = difference_weights(log.times, 0, values.size() - 1);
  LogComponents part = LogComponents::Zero();
  for (std::size_t i = 0; i < values.size(); ++i) part += weight[i] * values[i];
  for (std::size_t i = 0; i < values.size(); ++i) values[i] -= weight[i] * part;
  return with_values(log, values);
}

}  // namespace detail

/// The error of a result that comes from the log's own errors.
///
/// The result is computed again with other logs that are as plausible as the given one. Some are
/// the smoothed samples with noise and rounding drawn anew; they differ as the samples differ from
/// the motion. Another is a spline two degrees higher on the same knots. It differs by about the
/// truncation error of the lower degree and by noise; the noise is known from the draws and
/// subtracted. A log too short for two degrees more is compared with one degree less.
///
/// Small errors are thus propagated by the linear equations along the motion, as differences of
/// whole runs, and great errors by the nonlinear equations. Pose, velocity and acceleration have
/// consistent errors, as in reality.
///
///   sqrt((2 degree)^2 + (2 root mean square of draws)^2)
///
/// True errors are as a rule a third of this estimate up to the whole of it. A single number that
/// depends on one random number lies outside 0.1 to 1.2 times the estimate once in five.
///
/// `result`   : the result for the given log and spline
/// `follow`   : computes the result for another log and spline
/// `distance` : of two results, as numbers not below 0
/// Cost       : thirteen times follow()
/// Error      : see tests/dynamics/guide/log_noise.cpp
template <class Log, class Result, class Follow, class Distance>
[[nodiscard]] Eigen::VectorXd error_of_log(const Log& log, const LogSpline& spline,
                                           const Result& result, const Follow& follow,
                                           const Distance& distance) {
  constexpr int draws = 5;
  const LogNoise noise = noise_of(log);
  LogSpline higher = spline;
  higher.degree += 2;
  const auto square = [&](const Result& a, const Result& b) {
    return Eigen::VectorXd(distance(a, b).cwiseAbs2());
  };
  const std::size_t n = log.times.size();
  const bool is_short = higher.degree_for(n) == spline.degree_for(n);
  const auto follow_degree = [&](const Log& other) {
    return is_short ? follow(detail::without_highest_power(other), spline) : follow(other, higher);
  };
  Eigen::VectorXd degree = square(follow_degree(log), result);
  if (noise.white.isZero(0) && noise.step.isZero(0) && noise.late == 0) {
    return 2 * degree.cwiseSqrt();
  }
  const LogSpline smooth = smoothing(log, smoothing_sigma(noise));
  const Log middle_log = smoothed(log, smooth);
  const Result middle = follow(middle_log, spline);
  degree += square(follow_degree(middle_log), middle);
  Eigen::VectorXd drawn = 0 * degree;
  for (std::uint64_t i = 1; i <= draws; ++i) {
    const Log again = drawn_again(log, noise, smooth, i);
    const Result one = follow(again, spline);
    drawn += square(one, middle) / draws;
    degree -= square(follow_degree(again), one) / draws;
  }
  return (4 * degree.cwiseMax(0) + 4 * drawn).cwiseSqrt();
}

}  // namespace kreisel
