#pragma once

#include <Eigen/Core>

#include <array>
#include <cstddef>

#include <dynamics/guide/series.hpp>
#include <motor/absent.hpp>

namespace kreisel::detail {

/// The axes that the rates of a body stand on.
enum class RateAxes {
  body,
  resal  ///< of a body of revolution: they follow its axis z, but do not spin with it
};

/// The Taylor series of the motion of a held body on which nothing acts but gravity as felt in its
/// guide, for TaylorSteps. All is products of series, so that each coefficient comes from those
/// before it:
///
///   q' = q (0, u')/2,   Theta w' = -w x (Theta w + h) + s x R^t g',   u' = w - R^t u
///
/// with R quadratic in q, whose norm does not change. On Resal's axes those turn by (u'_x, u'_y, 0),
/// and  Theta w' = ((A n - C w_z) w_y, (C w_z - A n) w_x, 0) + s x R^t g',  n = (R^t u)_z.
///
/// Felt   : u and g' on guide axes; or at(t, h, order), which gives their series
/// Source : recurrences for products: E. Hairer, S. P. Norsett, G. Wanner, Solving Ordinary
///          Differential Equations I, I.8
template <class Tensor, class FirstMoment, class Felt, RateAxes axes = RateAxes::body,
          class Momentum = NoVector>
class AttitudeSeries {
 public:
  static constexpr int most_order = most_series_order;

  AttitudeSeries(const Tensor& tensor, const FirstMoment& first_moment, const Felt& felt,
                 const Momentum& momentum = {})
      : tensor_(tensor), first_moment_(first_moment), felt_(felt), momentum_(momentum) {}

  /// Fills the columns 1 to `order` of c with the coefficients of (quaternion x, y, z, w; u') in
  /// powers of (time - t)/h, for the motion that has column 0 at t.
  template <class Coefficients>
  void operator()(double t, double h, int order, Coefficients& c) {
    const auto felt = felt_now(t, h, order);
    Table s;
    const double norm2 = c.col(0).template head<4>().squaredNorm();
    s.put_attitude(0, c.col(0).template head<4>());
    // At the beginning it is u' that is known, not w.
    Components<double> w{c(4, 0), c(5, 0), c(6, 0)};
    for (int k = 0;; ++k) {
      Sums sums;
      // What is known already comes first, and the newest coefficients last: they may still be on
      // their way to memory.
      for (std::size_t i = 1, j = std::size_t(k) - 1; i < std::size_t(k); ++i, --j) {
        s.add_attitudes(i, j, sums);
        s.add_rates(i, j, sums);
        if constexpr (guide_changes) s.add_felt(i, j, felt, sums);
      }
      at_the_ends(k, [&](std::size_t i, std::size_t j) { s.add_attitudes(i, j, sums); });
      const Turn<double> R = turn(sums, 1 / norm2);
      if constexpr (guide_changes) {
        s.put_rows(k, R);
        at_the_ends(k, [&](std::size_t i, std::size_t j) { s.add_felt(i, j, felt, sums); });
      }
      const auto guide = turned_back(R, felt.u, sums.guide);
      if (k == 0) w = w + guide;
      const Components<double> u = w - guide;
      c(4, k) = u.x;
      c(5, k) = u.y;
      c(6, k) = u.z;
      if (k == order) return;
      s.put_rates(k, w, by_whole_rate ? w : u);
      if constexpr (on_resal_axes) {
        const auto [A, C] = tensor_.across_and_along();
        s.excess[std::size_t(k)] = C * w.z - A * (0.0 + guide.z);
      }
      at_the_ends(k, [&](std::size_t i, std::size_t j) { s.add_rates(i, j, sums); });
      const double weight = h / (k + 1);
      const Components<double> moment = gyroscopic_torque(sums) + cross(momentum_, w) +
                                        cross(first_moment_, turned_back(R, felt.g, sums.gravity));
      w = weight * tensor_.solve(moment);
      Four dq = sums.x + sums.y + sums.z;
      if constexpr (by_whole_rate) dq -= s.turned_along(k, felt.u);
      dq *= weight / 2;
      s.put_attitude(k + 1, dq);
      c.col(k + 1).template head<4>() = dq;
    }
  }

 private:
  static constexpr bool on_resal_axes = axes == RateAxes::resal;
  static constexpr bool guide_changes = requires(Felt & felt) { felt.at(0.0, 0.0, 0); };

  /// q' is taken as  (q (0, w) - (0, u) q)/2,  which does not have to wait for R.
  static constexpr bool by_whole_rate = !on_resal_axes && !guide_changes;

  using Four = Eigen::Array<double, 4, 1>;
  using Fours = std::array<Four, most_order + 1>;
  using Numbers = std::array<double, most_order + 1>;

  /// The k-th coefficients of products.
  struct Sums {
    Four square = Four::Zero();  ///< of q: xx, yy, zz
    Four next = Four::Zero();    ///< xy, yz, zx
    Four by_w = Four::Zero();    ///< xw, yw, zw, ww
    Four x = Four::Zero();       ///< q (0, u') or q (0, w), by the components of u' or w
    Four y = Four::Zero();
    Four z = Four::Zero();
    Four mixed = Four::Zero();     ///< of w: yz, zx, xy; on Resal's axes (n A - C w_z)(w_y, -w_x)
    Four w_square = Four::Zero();  ///< xx, yy, zz
    Four guide = Four::Zero();     ///< R^t u
    Four gravity = Four::Zero();   ///< R^t g'
  };

  /// The coefficients so far, as the products take them.
  struct Table {
    Fours q, q_next;      ///< (x, y, z, w), (y, z, x, 0)
    Fours q_i, q_j, q_k;  ///< the products with the quaternion units
    Fours w, w_next, w_after;
    Fours row_x, row_y, row_z;  ///< of R
    Numbers q_w, u_x, u_y, u_z;
    Fours aside;     ///< on Resal's axes: (-w_y, w_x)
    Numbers excess;  ///< there: C w_z - A n

    void put_attitude(int k, const Four& a) {
      const auto at = static_cast<std::size_t>(k);
      q[at] = a;
      q_next[at] = Four(a[1], a[2], a[0], 0);
      q_i[at] = Four(a[3], a[2], -a[1], -a[0]);
      q_j[at] = Four(-a[2], a[3], a[0], -a[1]);
      if constexpr (!on_resal_axes) q_k[at] = Four(a[1], -a[0], a[3], -a[2]);
      q_w[at] = a[3];
    }

    void put_rates(int k, const Components<double>& a, const Components<double>& u) {
      const auto at = static_cast<std::size_t>(k);
      if constexpr (on_resal_axes) {
        aside[at] = Four(-a.y, a.x, 0, 0);
      } else {
        w[at] = Four(a.x, a.y, a.z, 0);
        w_next[at] = Four(a.y, a.z, a.x, 0);
        w_after[at] = Four(a.z, a.x, a.y, 0);
      }
      u_x[at] = u.x;
      u_y[at] = u.y;
      u_z[at] = u.z;
    }

    /// (0, u) q
    template <class U>
    [[nodiscard]] Four turned_along(int k, const U& u) const {
      const Four& a = q[std::size_t(k)];
      const double x = a[0], y = a[1], z = a[2], r = a[3];
      return {0.0 + (r * u.x + u.y * z - u.z * y), 0.0 + (r * u.y + u.z * x - u.x * z),
              0.0 + (r * u.z + u.x * y - u.y * x), 0.0 - (u.x * x + u.y * y + u.z * z)};
    }

    void put_rows(int k, const Turn<double>& R) {
      const auto at = static_cast<std::size_t>(k);
      row_x[at] = Four(R.xx, R.xy, R.xz, 0);
      row_y[at] = Four(R.yx, R.yy, R.yz, 0);
      row_z[at] = Four(R.zx, R.zy, R.zz, 0);
    }

    void add_attitudes(std::size_t i, std::size_t j, Sums& s) const {
      s.square += q[i] * q[j];
      s.next += q[i] * q_next[j];
      s.by_w += q[i] * q_w[j];
    }

    void add_rates(std::size_t i, std::size_t j, Sums& s) const {
      s.x += q_i[i] * u_x[j];
      s.y += q_j[i] * u_y[j];
      if constexpr (on_resal_axes) {
        s.mixed += aside[i] * excess[j];
      } else {
        s.z += q_k[i] * u_z[j];
        s.mixed += w_next[i] * w_after[j];
        s.w_square += w[i] * w[j];
      }
    }

    template <class Series>
    void add_felt(std::size_t i, std::size_t j, const Series& felt, Sums& s) const {
      const Components<double>& u = felt.u[j];
      const Components<double>& g = felt.g[j];
      s.guide += row_x[i] * u.x + row_y[i] * u.y + row_z[i] * u.z;
      s.gravity += row_x[i] * g.x + row_y[i] * g.y + row_z[i] * g.z;
    }
  };

  /// The terms of a product that have the newest coefficients.
  template <class Term>
  static void at_the_ends(int k, const Term& term) {
    term(0, std::size_t(k));
    if (k > 0) term(std::size_t(k), 0);
  }

  /// R, of a quaternion whose norm is 1/sqrt(scale).
  [[nodiscard]] static Turn<double> turn(const Sums& s, double scale) {
    const double xx = s.square[0], yy = s.square[1], zz = s.square[2], ww = s.by_w[3];
    const double xy = s.next[0], yz = s.next[1], zx = s.next[2];
    const double xw = s.by_w[0], yw = s.by_w[1], zw = s.by_w[2];
    const double twice = 2 * scale;
    return {scale * (ww + xx - yy - zz), twice * (xy - zw),           twice * (zx + yw),
            twice * (xy + zw),           scale * (ww - xx + yy - zz), twice * (yz - xw),
            twice * (zx - yw),           twice * (yz + xw),           scale * (ww - xx - yy + zz)};
  }

  [[nodiscard]] Components<double> gyroscopic_torque(const Sums& s) const {
    const Components<double> mixed{s.mixed[0], s.mixed[1], s.mixed[2]};
    if constexpr (on_resal_axes) {
      return mixed;
    } else {
      return tensor_.gyroscopic_torque(
          mixed, Components<double>{s.w_square[0], s.w_square[1], s.w_square[2]});
    }
  }

  [[nodiscard]] auto felt_now(double t, double h, int order) {
    if constexpr (guide_changes) {
      return felt_.at(t, h, order);
    } else {
      return felt_;
    }
  }

  /// R^t v, of a vector that rests in the guide; of a series it has been summed up.
  template <class V>
  [[nodiscard]] static auto turned_back(const Turn<double>& R, const V& v, const Four& sum) {
    if constexpr (guide_changes) {
      return Components<double>{sum[0], sum[1], sum[2]};
    } else {
      return detail::turned_back(R, v);
    }
  }

  Tensor tensor_;
  FirstMoment first_moment_;
  Felt felt_;
  Momentum momentum_;
};

}  // namespace kreisel::detail
