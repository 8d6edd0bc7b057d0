#pragma once

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include <dynamics/step/advance.hpp>

namespace kreisel::detail {

/// How much finer the run is beside which another is held.
inline constexpr double times_finer = 30;

/// The greater of two errors; a NaN stays, which std::max may forget.
[[nodiscard]] inline double worse(double a, double b) { return b <= a || a != a ? a : b; }

/// The global error of a run after so many steps, `off` from one beside it whose error is so many
/// times finer: what the coarser errs by, less that part of it, and half as much again for what is
/// not so much finer, as where stability keeps explicit steps short; and a random walk of rounding,
/// in units of 2^-53 a step, where nothing grows, or what `noise` the steps know of: two runs in which
/// it outweighs all else agree by chance.
[[nodiscard]] inline double error_of_pair(double off, double finer_by, double rounding,
                                          double steps, double noise = 0) {
  const double caution = 1.5 / (1 - 1 / finer_by);
  constexpr double unit_roundoff = std::numeric_limits<double>::epsilon() / 2;
  return caution * off + std::max(rounding * unit_roundoff * std::sqrt(steps), noise);
}

/// The state with its components moved by so much in the last digit.
template <class Scene>
[[nodiscard]] typename Scene::State off_by_last_digits(const Scene& scene,
                                                       const typename Scene::State& state,
                                                       double by) {
  typename Scene::Vector y = scene.to_vector(state);
  move_last_digits<double>(y, by);
  return scene.from_vector(y);
}

/// The distance of two states in the measure of RunReport::error_estimate.
///
/// Attitudes (blocks of four) by the angle between them, whatever their norms; q and -q are one.
template <class Scene>
class ErrorMeasure {
  using Vector = typename Scene::Vector;

 public:
  ErrorMeasure(const Scene& scene, double smallest) : ErrorMeasure(blocks_of(scene), smallest) {}

  /// For scenes that all have the same blocks.
  explicit ErrorMeasure(double smallest) : ErrorMeasure(Scene::blocks, smallest) {}

  template <class Bookmark>
  void pass(Bookmark& bookmark) {
    bookmark(size_);
  }

  double operator()(const Vector& a, const Vector& b) {
    double worst = 0;
    int begin = 0;
    for (std::size_t i = 0; i < blocks_.size(); ++i) {
      const int n = blocks_[i];
      const bool attitude = n == 4;
      if (attitude) {
        const Eigen::Vector4d p = attitude_at(a, begin);
        const Eigen::Vector4d q = attitude_at(b, begin);
        // |p -+ q| / 2 of unit quaternions is the sine of a quarter of the angle between.
        const Eigen::Vector4d unit_p = p.stableNormalized();
        Eigen::Vector4d unit_q = q.stableNormalized();
        if (unit_p.dot(unit_q) < 0) unit_q = -unit_q;
        worst = worse(worst, 4 * std::asin(std::min(1.0, (unit_p - unit_q).norm() / 2)));
      } else {
        const double off = norm(Vector(a - b), begin, n);
        size_[i] = std::max(size_[i], norm(b, begin, n));
        worst = worse(worst, off == 0 ? 0 : off / size_[i]);
      }
      begin += n;
    }
    return worst;
  }

 private:
  template <class Blocks>
  ErrorMeasure(const Blocks& blocks, double smallest)
      : blocks_(blocks.begin(), blocks.end()), size_(blocks_.size(), smallest) {}

  [[nodiscard]] static Eigen::Vector4d attitude_at(const Vector& v, int begin) {
    return {v[begin], v[begin + 1], v[begin + 2], v[begin + 3]};
  }

  std::vector<int> blocks_;
  std::vector<double> size_;
};

}  // namespace kreisel::detail
