#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <dynamics/file/log_stamps.hpp>
#include <dynamics/guide/log_noise.hpp>

namespace kreisel::detail {

namespace {

using Eigen::ArrayXd;

/// The mean of the steps without gaps.
double mean_step(const ArrayXd& steps) {
  std::vector<double> sorted(steps.begin(), steps.end());
  std::sort(sorted.begin(), sorted.end());
  const auto gap = std::upper_bound(sorted.begin(), sorted.end(), 1.6 * sorted[sorted.size() / 2]);
  const auto count = gap - sorted.begin();
  return Eigen::Map<const ArrayXd>(sorted.data(), count).mean();
}

/// The samples' numbers at a regular rate, missing ones counted.
ArrayXd numbers_of(const ArrayXd& steps) {
  const double step = mean_step(steps);
  ArrayXd numbers = ArrayXd::Zero(steps.size() + 1);
  for (Eigen::Index i = 0; i < steps.size(); ++i) {
    numbers[i + 1] = numbers[i] + std::round(steps[i] / step);
  }
  return numbers;
}

/// The median size of the fourth differences of values over times.
double roughness(const std::vector<double>& times, const std::vector<double>& values) {
  constexpr std::size_t order = 4;
  const std::size_t stride = 1 + times.size() / 20'000;
  std::vector<double> sizes;
  for (std::size_t i = 0; i + order < times.size(); i += stride) {
    const std::vector<double> weight = difference_weights(times, i, order);
    double sum = 0;
    for (std::size_t k = 0; k <= order; ++k) sum += weight[k] * (values[i + k] - values[i]);
    sizes.push_back(std::abs(sum));
  }
  const auto middle = sizes.begin() + std::ssize(sizes) / 2;
  std::nth_element(sizes.begin(), middle, sizes.end());
  return *middle;
}

/// True if a column of the log is at least twice as smooth over other times, and none rougher.
bool are_better(const std::vector<double>& times, const std::vector<LogColumn>& columns) {
  constexpr double clearly = 2;
  bool better = false;
  for (std::size_t i = 1; i < columns.size(); ++i) {
    const double before = roughness(columns.front().values, columns[i].values);
    const double after = roughness(times, columns[i].values);
    if (after > clearly * before) return false;
    better = better || before > clearly * after;
  }
  return better;
}

}  // namespace

std::optional<std::vector<double>> regular_times(const std::vector<LogColumn>& columns,
                                                 double unit) {
  const std::vector<double>& stamps = columns.front().values;
  // So many stamps have rounded steps in the order of a regular rate by chance once in 2^20 logs.
  constexpr std::size_t least = 20;
  if (stamps.size() < least) return std::nullopt;
  const auto n = static_cast<Eigen::Index>(stamps.size());
  const Eigen::Map<const ArrayXd> time(stamps.data(), n);
  const ArrayXd number = numbers_of(time.tail(n - 1) - time.head(n - 1));
  const ArrayXd from_middle = number - number.mean();
  const double step = (from_middle * (time - time.mean())).sum() / from_middle.square().sum();
  const ArrayXd off = time - step * number;
  const double spread = off.maxCoeff() - off.minCoeff();
  constexpr double of_a_double = 1e-3;  // of the unit: regular stamps
  constexpr double of_the_line = 1.25;  // the line follows the rounding of few stamps
  if (spread < of_a_double * unit || spread > of_the_line * unit) return std::nullopt;
  std::vector<double> times(stamps.size());
  Eigen::Map<ArrayXd>(times.data(), n) =
      time[0] + (time[n - 1] - time[0]) * (number / number[n - 1]);
  times.back() = stamps.back();
  if (!are_better(times, columns)) return std::nullopt;
  return times;
}

}  // namespace kreisel::detail
