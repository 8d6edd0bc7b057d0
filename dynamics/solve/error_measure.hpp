#pragma once

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include <dynamics/solve/error_rules.hpp>
#include <dynamics/solve/report.hpp>
#include <dynamics/step/integrator.hpp>
#include <motor/api.hpp>

namespace kreisel {

namespace detail {

/// The greater of two errors; keeps a NaN, which std::max may drop.
[[nodiscard]] inline double max_or_nan(double a, double b) { return b <= a || a != a ? a : b; }

/// The global error of a run, from its difference `off` to a run with `finer_by` times less error.
///
/// The finer run's own error is part of the difference, hence 1 - 1/finer_by. Rounding is added,
/// because two runs dominated by it agree by chance. Without growth it is a random walk, `rounding`
/// units of 2^-53 a step; the estimate `noise` of the steps counts if it is greater.
[[nodiscard]] inline ErrorParts error_of_pair(double off, double finer_by, double rounding,
                                              double steps, double noise = 0) {
  constexpr double unit_roundoff = std::numeric_limits<double>::epsilon() / 2;
  return {rules::caution / (1 - 1 / finer_by) * off,
          std::max(rounding * unit_roundoff * std::sqrt(steps), noise)};
}

/// The state with its components changed by so many units in the last digit.
template <class Scene>
[[nodiscard]] typename Scene::State perturbed_by_ulps(const Scene& scene,
                                                      const typename Scene::State& state,
                                                      double by) {
  typename Scene::Vector y = scene.to_vector(state);
  move_last_digits(y, by);
  return scene.from_vector(y);
}

/// The distance of two states in the measure of RunReport::error_estimate.
///
/// Attitudes (blocks of four) are compared by the angle between them, whatever their norms; q and
/// -q are equal.
class BlockDistance {
 public:
  BlockDistance(std::vector<int> blocks, double smallest)
      : blocks_(std::move(blocks)), size_(blocks_.size(), smallest) {}

  template <class Checkpoint>
  void pass(Checkpoint& checkpoint) {
    checkpoint(size_);
  }

  KREISEL_API double operator()(std::span<const double> a, std::span<const double> b);

  /// Takes over the sizes of blocks between the compared states.
  void note_sizes(std::span<const double> sizes) {
    const std::size_t count = std::min(sizes.size(), size_.size());
    for (std::size_t i = 0; i < count; ++i) size_[i] = std::max(size_[i], sizes[i]);
  }

  [[nodiscard]] const std::vector<double>& sizes() const { return size_; }

 private:
  std::vector<int> blocks_;
  std::vector<double> size_;
  Eigen::VectorXd difference_;
};

}  // namespace detail

/// The distance of two states of a scene in the measure of RunReport::error_estimate. Attitudes are
/// measured by the angle between them in radian, other blocks relative to their greatest size in the
/// states given so far.
///
/// absolute_scale : as SolveOptions::absolute_scale
template <class Scene>
class ErrorMeasure {
  using Vector = typename Scene::Vector;

 public:
  ErrorMeasure(const Scene& scene, double absolute_scale)
      : ErrorMeasure(detail::blocks_of(scene), absolute_scale) {}

  /// For a type of scene whose blocks are constant.
  explicit ErrorMeasure(double absolute_scale) : ErrorMeasure(Scene::blocks, absolute_scale) {}

  double operator()(const Vector& a, const Vector& b) {
    return distance_({a.data(), std::size_t(a.size())}, {b.data(), std::size_t(b.size())});
  }

  /// Takes the sizes that blocks have had between the states given.
  void note_sizes(std::span<const double> sizes) { distance_.note_sizes(sizes); }

 private:
  template <class Blocks>
  ErrorMeasure(const Blocks& blocks, double absolute_scale)
      : distance_({blocks.begin(), blocks.end()}, absolute_scale) {}

  detail::BlockDistance distance_;
};

}  // namespace kreisel
