#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <random>
#include <vector>

#include <dynamics/guide/tabulated.hpp>

namespace kreisel {

/// The errors of a log's samples, by component: quaternion x, y, z, w, then position x, y, z.
struct LogNoise {
  using Components = PiecewisePose<double>::Components;
  Components white = Components::Zero();  ///< standard deviation, independent from sample to sample
  Components step = Components::Zero();   ///< unit of the last written decimal, 0 if there is none

  /// Whether the estimate is of noise; else the samples are too coarse to tell it from the motion.
  Eigen::Array<bool, 7, 1> resolved = Eigen::Array<bool, 7, 1>::Constant(true);
};

namespace detail {

using LogComponents = LogNoise::Components;

/// The components of a log as it was written.
[[nodiscard]] inline std::vector<LogComponents> log_components(const MotionLog<double>& log) {
  std::vector<LogComponents> values;
  for (std::size_t i = 0; i < log.times.size(); ++i) {
    values.push_back(PiecewisePose<double>::components(
        log.attitudes[i],
        log.positions.empty() ? Vector3<double>(Vector3<double>::Zero()) : log.positions[i]));
  }
  return values;
}

/// The greatest power of ten, from 1e-1 to 1e-12, of which all values are multiples; 0 if there is
/// none, or nothing changes.
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

/// Weights of the divided difference over times i to i + order, of square sum 1.
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

/// The root mean square of the differences of that order, gaps left out; nothing where the log has
/// less than ten of them.
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

/// The errors of a log's samples, from the log itself.
///
/// High-order differences of a smooth motion are small, those of noise are not: the noise is the
/// least of what the orders 4 to 24 leave, each scaled for independent errors. Where the least two
/// orders still fall, the samples are too coarse for it and the noise is an upper bound. Errors that
/// are as smooth as the motion cannot be seen.
///
/// Error  : some 20 % for independent errors and 100 samples
///          (tests/dynamics/guide/log_noise.cpp)
/// Units  : 1 (quaternion), metre
[[nodiscard]] inline LogNoise noise_of(const MotionLog<double>& written) {
  LogNoise noise;
  const auto raw = detail::log_components(written);
  noise.step.head<4>().setConstant(detail::decimal_step(raw, 0, 4));
  if (!written.positions.empty()) {
    noise.step.tail<3>().setConstant(detail::decimal_step(raw, 4, 3));
  }
  const MotionLog<double> log = TabulatedFrame<>(written).samples();
  const auto values = detail::log_components(log);
  std::vector<double> steps;
  for (std::size_t i = 1; i < log.times.size(); ++i) {
    steps.push_back(log.times[i] - log.times[i - 1]);
  }
  std::nth_element(steps.begin(), steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2),
                   steps.end());
  const double step = steps[steps.size() / 2];
  LogNoise::Components before = LogNoise::Components::Constant(-1);
  noise.white.setConstant(std::numeric_limits<double>::infinity());
  noise.resolved.setConstant(false);
  for (const std::size_t order : {4, 6, 8, 10, 12, 14, 16, 18, 20, 22, 24}) {
    const auto size = detail::difference_size(log.times, values, order, step);
    if (!size) break;
    for (int c = 0; c < 7; ++c) {
      // Two orders that find the same have found noise.
      noise.resolved[c] = noise.resolved[c] || (*size)[c] > 0.7 * before[c];
      noise.white[c] = std::min(noise.white[c], (*size)[c]);
    }
    before = *size;
  }
  if (before[0] < 0) {
    noise.white.setZero();
    noise.resolved.setConstant(false);
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

/// The spline that follows a noisy log best: knots so far apart that the expected error
///
///   sum of squared residuals + 2 sigma^2 (control points)
///
/// is least (C. L. Mallows); its residuals are then as great as the noise. Where interpolation is
/// best, or the noise is that of rounded doubles, every sample is a knot. Where the last decimal
/// stays for many samples, its steps are no noise for a sum of squares: knots are then at least four
/// steps apart.
///
/// Units  : sigma as LogNoise
[[nodiscard]] inline LogSpline smoothing(const MotionLog<double>& written,
                                         const LogNoise::Components& sigma) {
  LogSpline best;
  const MotionLog<double> log = TabulatedFrame<>(written).samples();
  const auto values = detail::log_components(log);
  const std::size_t n = log.times.size();
  LogNoise::Components size = LogNoise::Components::Zero();
  for (const auto& value : values) size = size.cwiseMax(value.cwiseAbs());
  LogNoise::Components way = LogNoise::Components::Constant(std::numeric_limits<double>::min());
  for (std::size_t i = 1; i < n; ++i) way += (values[i] - values[i - 1]).cwiseAbs();
  const auto raw = detail::log_components(written);
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
      const detail::SplineInterpolation<double> spline(log.times, values, best.degree, m);
      const double residual = detail::squared_residual(spline, log.times, values).dot(group);
      const double expected = residual + 2 * variance * static_cast<double>(spline.controls());
      if (expected < least) {
        least = expected;
        every = m;
      }
      if (residual > 4 * variance * static_cast<double>(n)) break;
    }
  };
  const auto attitude = (LogNoise::Components() << 1, 1, 1, 1, 0, 0, 0).finished();
  choose(attitude, detail::decimal_step(raw, 0, 4), best.attitude_every);
  choose(LogNoise::Components::Ones() - attitude, detail::decimal_step(raw, 4, 3),
         best.position_every);
  return best;
}

/// The standard deviations by which a log is smoothed if nobody gives them: what its differences
/// and its last decimals say; 0 for what the samples are too coarse to tell.
[[nodiscard]] inline LogNoise::Components smoothing_sigma(const LogNoise& noise) {
  const double uniform = 1 / std::sqrt(12.0);
  LogNoise::Components sigma = noise.white;
  for (int c = 0; c < 7; ++c) {
    if (!noise.resolved[c]) sigma[c] = 0;
    if (sigma[c] > 0) sigma[c] = std::max(sigma[c], uniform * noise.step[c]);
  }
  return sigma;
}

/// The samples that a spline of the log has at its times.
[[nodiscard]] inline MotionLog<double> smoothed(const MotionLog<double>& written,
                                                const LogSpline& smooth) {
  const TabulatedFrame<> frame(written, smooth);
  MotionLog<double> log = frame.samples();
  for (std::size_t i = 0; i < log.times.size(); ++i) {
    const PoseDerivatives<double> pose = frame.derivatives(log.times[i]);
    log.attitudes[i] = pose.q.normalized();
    log.positions[i] = pose.x;
  }
  return log;
}

/// The log as it might as well have been written: smoothed, its noise and its rounding drawn anew.
///
/// Rounding is drawn by where the decimals begin, so that of a slow motion it stays in steps as it
/// is, and of one at rest it is an offset.
[[nodiscard]] inline MotionLog<double> drawn_again(const MotionLog<double>& written,
                                                   const LogNoise& noise, const LogSpline& smooth,
                                                   std::uint64_t seed) {
  MotionLog<double> log = smoothed(written, smooth);
  std::mt19937_64 engine(seed);
  // Sums of twelve draws: the same on every machine, which std::normal_distribution is not.
  const auto uniform = [&engine] { return static_cast<double>(engine() >> 11) * 0x1p-53 - 0.5; };
  const auto normal = [&uniform] {
    double sum = 0;
    for (int i = 0; i < 12; ++i) sum += uniform();
    return sum;
  };
  LogNoise::Components white = noise.white;
  LogNoise::Components offset;
  for (int c = 0; c < 7; ++c) {
    const double rounded = 0.35 * noise.step[c];  // a last digit's noise, and what drawing it adds
    white[c] = white[c] > rounded ? std::sqrt(white[c] * white[c] - rounded * rounded) : 0;
    offset[c] = noise.step[c] * uniform();
  }
  for (std::size_t i = 0; i < log.times.size(); ++i) {
    for (int c = 0; c < 7; ++c) {
      double& x = c < 4 ? log.attitudes[i].coeffs()[c] : log.positions[i][c - 4];
      const double step = noise.step[c];
      x += (white[c] > 0 ? white[c] * normal() : 0);
      if (step > 0) x = std::round((x + offset[c]) / step) * step - offset[c];
    }
    log.attitudes[i].normalize();
  }
  return log;
}

/// How far a result that follows a log may be off for the log's own errors.
///
/// The log is taken in other ways that are as good as the one used, and the result is computed again
/// with each: from the smoothed samples with noise and rounding drawn anew, which differ as the
/// samples do from the motion; and by a spline two degrees higher on the same knots, which differs
/// by about what the degree leaves out, and by noise, whose part is known from the draws and taken
/// off. Small errors are so carried by the linear equations along the motion, as differences of
/// whole runs, great ones by the equations themselves; pose, velocity and acceleration err together
/// as they do in truth.
///
///   sqrt((2 degree)^2 + (2 root mean square of draws)^2)
///
/// True errors are a third to once that as a rule. A single number that one random number decides is
/// outside 0.1 to 1.2 times it once in five.
///
/// `result`   : that of the log and spline which are asked about
/// `follow`   : the result of another log and spline
/// `distance` : of two results, as numbers not below 0
/// Cost       : thirteen times follow()
/// Error      : see tests/dynamics/guide/log_noise.cpp
template <class Result, class Follow, class Distance>
[[nodiscard]] Eigen::VectorXd error_of_log(const MotionLog<double>& log, const LogSpline& spline,
                                           const Result& result, const Follow& follow,
                                           const Distance& distance) {
  constexpr int draws = 5;
  const LogNoise noise = noise_of(log);
  LogSpline higher = spline;
  higher.degree += 2;
  const auto square = [&](const Result& a, const Result& b) {
    return Eigen::VectorXd(distance(a, b).cwiseAbs2());
  };
  Eigen::VectorXd degree = square(follow(log, higher), result);
  if (noise.white.isZero(0) && noise.step.isZero(0)) return 2 * degree.cwiseSqrt();
  const LogSpline smooth = smoothing(log, smoothing_sigma(noise));
  const MotionLog<double> middle_log = smoothed(log, smooth);
  const Result middle = follow(middle_log, spline);
  degree += square(follow(middle_log, higher), middle);
  Eigen::VectorXd drawn = 0 * degree;
  for (std::uint64_t i = 1; i <= draws; ++i) {
    const MotionLog<double> again = drawn_again(log, noise, smooth, i);
    const Result one = follow(again, spline);
    drawn += square(one, middle) / draws;
    degree -= square(follow(again, higher), one) / draws;
  }
  return (4 * degree.cwiseMax(0) + 4 * drawn).cwiseSqrt();
}

}  // namespace kreisel
