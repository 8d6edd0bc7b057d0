#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <span>

#include <dynamics/guide/series.hpp>
#include <dynamics/load/analytic_load.hpp>
#include <motor/simd.hpp>

namespace kreisel::detail {

[[nodiscard]] inline Vec4d packed(const Vector3<double>& v) { return {v[0], v[1], v[2], 0}; }

/// The Taylor series of a linear drag, on axes that are fixed in its link. The guide is at rest.
///
/// The velocity v of the link's origin follows from its acceleration a less the gravity g:
///
///   v' = a + g + v x w,   g' = g x w
///
/// Cost : for each order k some 2 (k + 1) cross products
class DragSeries {
 public:
  /// own_axes : from the body's axes to those of the link
  DragSeries(const AnalyticLoad& load, const Matrix3<double>& own_axes)
      : point_(packed(own_axes * load.point)),
        linear_(Mat3dByDiagonals::of(own_axes * load.linear * own_axes.transpose())),
        angular_(Mat3dByDiagonals::of(own_axes * load.angular * own_axes.transpose())) {}

  /// v, g at the series' time, on the link's axes
  void begin(const Vector3<double>& v, const Vector3<double>& g) {
    v_[0] = packed(v);
    g_[0] = packed(g);
  }

  /// Computes the velocity of order k + 1. w: coefficients up to k; acceleration: that of order k;
  /// weight = h/(k + 1).
  void advance(std::size_t k, double weight, std::span<const Vec4d> w, const Vec4d& acceleration) {
    Vec4d v = acceleration + g_[k];
    Vec4d g(0, 0, 0, 0);
    for (std::size_t j = 0; j <= k; ++j) {
      v += cross(v_[k - j], w[j]);
      g += cross(g_[k - j], w[j]);
    }
    v_[k + 1] = weight * v;
    g_[k + 1] = weight * g;
  }

  /// Computes force and torque of order k.
  void prepare(std::size_t k, std::span<const Vec4d> w) {
    newest_force_ = -1.0 * (linear_ * CyclicVec4d(v_[k] + cross(w[k], point_)));
    newest_moment_ = cross(point_, newest_force_) - angular_ * CyclicVec4d(w[k]);
  }

  /// On the link's own axes, about its origin.
  [[nodiscard]] const Vec4d& force() const { return newest_force_; }
  [[nodiscard]] const Vec4d& moment() const { return newest_moment_; }

 private:
  template <class T>
  using Of = std::array<T, most_series_order + 1>;

  Vec4d point_;  ///< on the link's axes
  Mat3dByDiagonals linear_, angular_;
  Of<Vec4d> v_, g_;
  Vec4d newest_force_, newest_moment_;
};

/// The Taylor series of an AnalyticLoad, on axes that are fixed in its link.
///
/// Loads on guide axes turn against the link. Their unit vectors e_x, e_y, e_z on the link's axes
/// follow from the angular velocities w of the link and u of the guide, both inertial:
///
///   e_i' = e_i x w + sum_j u_j (e_j x e_i)
///
/// For inertial axes u = 0.
///
/// Cost : for each order k some 3 (k + 1) products of vectors with numbers, and as many cross
///        products; none for a load on body axes
class LoadSeries {
 public:
  /// own_axes : from the body's axes to those of the link
  LoadSeries(const AnalyticLoad& load, std::size_t link, const Matrix3<double>& own_axes)
      : load_(load),
        link_(link),
        point_(packed(own_axes * load.point)),
        is_magnet_(!load.moment.isZero(0)),
        magnet_(packed(own_axes * load.moment)) {
    if (load.axes == LoadAxes::body) set_axes(own_axes);
    if (load.is_drag()) drag_.emplace(load, own_axes);
  }

  [[nodiscard]] std::size_t link() const { return link_; }
  [[nodiscard]] LoadAxes axes() const { return load_.axes; }
  [[nodiscard]] DragSeries* drag() { return drag_ ? &*drag_ : nullptr; }

  /// to_own : from the load's axes to those of the link, at t
  void begin(double t, double h, int order, const Matrix3<double>& to_own) {
    const auto count = static_cast<std::size_t>(order);
    load_.force.coefficients(t, h, std::span(force_).first(count));
    load_.torque.coefficients(t, h, std::span(torque_).first(count));
    if (is_magnet_) load_.field.coefficients(t, h, std::span(magnetic_field_).first(count));
    if (load_.axes != LoadAxes::body) set_axes(to_own);
  }

  /// Computes force and torque of order k. w: coefficients up to k; u, for guide axes alone, the
  /// same, or empty on a guide at rest. weight = h/(k + 1).
  void prepare(std::size_t k, double weight, std::span<const Vec4d> w,
               std::span<const Components<double>> u) {
    newest_force_ = along_axes(force_, k);
    newest_moment_ = along_axes(torque_, k) + cross(point_, newest_force_);
    if (is_magnet_) add_magnet(k);
    if (drag_) add_drag(k, w);
    if (load_.axes != LoadAxes::body) turn_axes(k, weight, w, u);
  }

  /// On the link's own axes, about its origin.
  [[nodiscard]] const Vec4d& force() const { return newest_force_; }
  [[nodiscard]] const Vec4d& moment() const { return newest_moment_; }

 private:
  template <class T>
  using Of = std::array<T, most_series_order + 1>;

  [[gnu::noinline]] void add_magnet(std::size_t k) {
    newest_moment_ += cross(magnet_, along_axes(magnetic_field_, k));
  }

  [[gnu::noinline]] void add_drag(std::size_t k, std::span<const Vec4d> w) {
    drag_->prepare(k, w);
    newest_force_ += drag_->force();
    newest_moment_ += drag_->moment();
  }

  void set_axes(const Matrix3<double>& turn) {
    for (int i = 0; i < 3; ++i) axes_[static_cast<std::size_t>(i)][0] = packed(turn.col(i));
  }

  /// The k-th coefficient of a vector given on the axes of the load.
  [[nodiscard]] Vec4d along_axes(const Of<Vector3<double>>& given, std::size_t k) const {
    const auto& [x, y, z] = axes_;
    Vec4d sum(0, 0, 0, 0);
    for (std::size_t j = load_.axes == LoadAxes::body ? k : 0; j <= k; ++j) {
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

  const AnalyticLoad& load_;
  std::size_t link_;
  Vec4d point_;  ///< on the link's axes
  bool is_magnet_;
  Vec4d magnet_;
  Of<Vector3<double>> force_, torque_, magnetic_field_;
  std::optional<DragSeries> drag_;
  std::array<Of<Vec4d>, 3> axes_;  ///< the load's unit vectors on the link's axes
  Vec4d newest_force_, newest_moment_;
};

}  // namespace kreisel::detail
