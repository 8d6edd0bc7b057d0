#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>

#include <dynamics/guide/series.hpp>
#include <dynamics/load/timed_load.hpp>
#include <motor/simd.hpp>

namespace kreisel::detail {

/// The Taylor series of a TimedLoad, on axes that are fixed in its link.
///
/// Loads on guide axes turn against the link. Their unit vectors e_x, e_y, e_z on the link's axes
/// follow from the angular velocities w of the link and u of the guide, both inertial:
///
///   e_i' = e_i x w + sum_j u_j (e_j x e_i)
///
/// Cost : for each order k some 3 (k + 1) products of vectors with numbers, and as many cross
///        products; none for a load on body axes
class TimedLoadSeries {
 public:
  /// own_axes : from the body's axes to those of the link
  TimedLoadSeries(const TimedLoad& load, std::size_t link, const Matrix3<double>& own_axes)
      : load_(load), link_(link), point_(packed(own_axes * load.point)) {
    if (load.on_body_axes) set_axes(own_axes);
  }

  [[nodiscard]] std::size_t link() const { return link_; }

  /// guide_to_own : from the guide's axes to those of the link, at t
  void begin(double t, double h, int order, const Matrix3<double>& guide_to_own) {
    const auto count = static_cast<std::size_t>(order);
    load_.force.coefficients(t, h, std::span(force_).first(count));
    load_.torque.coefficients(t, h, std::span(torque_).first(count));
    if (!load_.on_body_axes) set_axes(guide_to_own);
  }

  /// Computes force and torque of order k. w, u: coefficients up to k; u is empty on a guide at
  /// rest. weight = h/(k + 1).
  void prepare(std::size_t k, double weight, std::span<const Vec4d> w,
               std::span<const Components<double>> u) {
    newest_force_ = along_axes(force_, k);
    newest_moment_ = along_axes(torque_, k) + cross(point_, newest_force_);
    if (!load_.on_body_axes) turn_axes(k, weight, w, u);
  }

  /// On the link's own axes, about its origin.
  [[nodiscard]] const Vec4d& force() const { return newest_force_; }
  [[nodiscard]] const Vec4d& moment() const { return newest_moment_; }

 private:
  template <class T>
  using Of = std::array<T, most_series_order + 1>;

  [[nodiscard]] static Vec4d packed(const Vector3<double>& v) { return {v[0], v[1], v[2], 0}; }

  void set_axes(const Matrix3<double>& turn) {
    for (int i = 0; i < 3; ++i) axes_[static_cast<std::size_t>(i)][0] = packed(turn.col(i));
  }

  /// The k-th coefficient of a vector given on the axes of the load.
  [[nodiscard]] Vec4d along_axes(const Of<Vector3<double>>& given, std::size_t k) const {
    const auto& [x, y, z] = axes_;
    Vec4d sum(0, 0, 0, 0);
    for (std::size_t j = load_.on_body_axes ? k : 0; j <= k; ++j) {
      const Vector3<double>& v = given[j];
      sum += v[0] * x[k - j] + v[1] * y[k - j] + v[2] * z[k - j];
    }
    return sum;
  }

  void turn_axes(std::size_t k, double weight, std::span<const Vec4d> w,
                 std::span<const Components<double>> u) {
    auto& [x, y, z] = axes_;
    std::array<Vec4d, 3> sum{Vec4d(0, 0, 0, 0), Vec4d(0, 0, 0, 0), Vec4d(0, 0, 0, 0)};
    for (std::size_t j = 0; j <= k; ++j) {
      for (std::size_t i = 0; i < 3; ++i) sum[i] += cross(axes_[i][k - j], w[j]);
      if (u.empty()) continue;
      sum[0] += u[j].z * y[k - j] - u[j].y * z[k - j];
      sum[1] += u[j].x * z[k - j] - u[j].z * x[k - j];
      sum[2] += u[j].y * x[k - j] - u[j].x * y[k - j];
    }
    for (std::size_t i = 0; i < 3; ++i) axes_[i][k + 1] = weight * sum[i];
  }

  const TimedLoad& load_;
  std::size_t link_;
  Vec4d point_;  ///< on the link's axes
  Of<Vector3<double>> force_, torque_;
  std::array<Of<Vec4d>, 3> axes_;  ///< the load's unit vectors on the link's axes
  Vec4d newest_force_, newest_moment_;
};

}  // namespace kreisel::detail
