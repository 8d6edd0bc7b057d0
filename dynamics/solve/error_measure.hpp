#pragma once

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include <dynamics/step/advance.hpp>

namespace kreisel::detail {

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
        const Eigen::Vector4d unit_p = p / p.norm();
        const Eigen::Vector4d unit_q = q / (p.dot(q) < 0 ? -q.norm() : q.norm());
        worst = worse(worst, 4 * std::asin(std::min(1.0, (unit_p - unit_q).norm() / 2)));
      } else {
        double difference2 = 0;
        double size2 = 0;
        for (int k = begin; k < begin + n; ++k) {
          difference2 += (a[k] - b[k]) * (a[k] - b[k]);
          size2 += b[k] * b[k];
        }
        size_[i] = std::max(size_[i], std::sqrt(size2));
        worst = worse(worst, difference2 == 0 ? 0 : std::sqrt(difference2) / size_[i]);
      }
      begin += n;
    }
    return worst;
  }

 private:
  template <class Blocks>
  ErrorMeasure(const Blocks& blocks, double smallest)
      : blocks_(blocks.begin(), blocks.end()), size_(blocks_.size(), smallest) {}

  /// The greater; a NaN stays.
  [[nodiscard]] static double worse(double a, double b) { return b <= a || a != a ? a : b; }

  [[nodiscard]] static Eigen::Vector4d attitude_at(const Vector& v, int begin) {
    return {v[begin], v[begin + 1], v[begin + 2], v[begin + 3]};
  }

  std::vector<int> blocks_;
  std::vector<double> size_;
};

}  // namespace kreisel::detail
