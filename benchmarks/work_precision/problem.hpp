#pragma once

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include <tests/support/worst.hpp>

namespace work_precision {

/// The measure of the error of a block of the state.
enum class Unit {
  attitude,  ///< the angle between two quaternions, of any norm, in rad
  angle,     ///< the distance, which is one in rad
  relative   ///< the distance in proportion to the block's greatest size
};

/// A scene, its start, and the truth at some times, which no method has computed.
template <class Scene_>
struct Problem {
  using Scene = Scene_;
  using Vector = typename Scene::Vector;

  std::string name;
  Scene scene;
  Vector start;
  std::vector<double> times;
  std::vector<Vector> truth;
  std::array<Unit, Scene::blocks.size()> units;
  double period;  ///< s, of what has to be resolved: steps of fixed length are parts of it
  double absolute_scale = 1e-3;  ///< a part of the state smaller than this counts as being so large

  /// The greatest error of a block at times[i].
  [[nodiscard]] double distance(std::size_t i, const Vector& y) const {
    double worst = 0;
    int begin = 0;
    for (std::size_t b = 0; b < units.size(); ++b) {
      const int n = Scene::blocks[b];
      const double error = units[b] == Unit::attitude ? angle_between(y, truth[i], begin)
                           : units[b] == Unit::angle
                               ? distance_of(y, truth[i], begin, n)
                               : distance_of(y, truth[i], begin, n) / size(begin, n);
      worst = kreisel::test::worst_of(worst, error);
      begin += n;
    }
    return worst;
  }

 private:
  [[nodiscard]] static double distance_of(const Vector& a, const Vector& b, int begin, int n) {
    double sum = 0;
    for (int k = begin; k < begin + n; ++k) sum += (a[k] - b[k]) * (a[k] - b[k]);
    return std::sqrt(sum);
  }

  [[nodiscard]] double size(int begin, int n) const {
    double greatest = std::max(absolute_scale, distance_of(start, Vector::Zero(), begin, n));
    for (const Vector& y : truth) {
      greatest = std::max(greatest, distance_of(y, Vector::Zero(), begin, n));
    }
    return greatest;
  }

  [[nodiscard]] static double angle_between(const Vector& a, const Vector& b, int begin) {
    Eigen::Vector4d p;
    Eigen::Vector4d q;
    for (int k = 0; k < 4; ++k) p[k] = a[begin + k], q[k] = b[begin + k];
    const Eigen::Vector4d unit_p = p / p.norm();
    const Eigen::Vector4d unit_q = q / (p.dot(q) < 0 ? -q.norm() : q.norm());
    return 4 * std::asin(std::min(1.0, (unit_p - unit_q).norm() / 2));
  }
};

}  // namespace work_precision
