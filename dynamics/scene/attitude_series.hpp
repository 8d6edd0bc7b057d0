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
    s.put_attitude(0, c(0, 0), c(1, 0), c(2, 0), c(3, 0));
    // At the beginning it is u' that is known, not w.
    Components<double> w{c(4, 0), c(5, 0), c(6, 0)};
    for (int k = 0;; ++k) {
      const Turn<double> R = s.turn(k, 1 / norm2);
      if constexpr (guide_changes) s.put_rows(k, R);
      const auto guide = turned_back(s, k, R, felt.u);
      if (k == 0) w = w + guide;
      s.put_rate(k, w);
      const Components<double> u = w - guide;
      s.put_relative(k, u);
      c(4, k) = u.x;
      c(5, k) = u.y;
      c(6, k) = u.z;
      if (k == order) return;
      const double weight = h / (k + 1);
      const Components<double> moment = gyroscopic_torque(s, k, guide) + cross(momentum_, w) +
                                        cross(first_moment_, turned_back(s, k, R, felt.g));
      w = weight * tensor_.solve(moment);
      const Four dq = (weight / 2) * s.attitude_rate(k);
      s.put_attitude(k + 1, dq[0], dq[1], dq[2], dq[3]);
      for (int i = 0; i < 4; ++i) c(i, k + 1) = dq[i];
    }
  }

 private:
  static constexpr bool on_resal_axes = axes == RateAxes::resal;
  static constexpr bool guide_changes = requires(Felt & felt) { felt.at(0.0, 0.0, 0); };

  using Four = Eigen::Array<double, 4, 1>;
  using Fours = std::array<Four, most_order + 1>;
  using Numbers = std::array<double, most_order + 1>;

  /// sum of term(i, k - i) over i. Those with the newest coefficients come last: they may still be
  /// on their way to memory.
  template <class Term>
  static void convolve(int k, const Term& term) {
    const auto last = static_cast<std::size_t>(k);
    for (std::size_t i = 1; i < last; ++i) term(i, last - i);
    term(0, last);
    if (last > 0) term(last, 0);
  }

  /// The coefficients so far, as the products take them.
  struct Table {
    Fours q, q_next;      ///< (x, y, z, w), (y, z, x, 0)
    Fours q_i, q_j, q_k;  ///< the products with the quaternion units
    Fours w, w_next, w_after;
    Fours row_x, row_y, row_z;  ///< of R
    Numbers q_w, u_x, u_y, u_z;
    Fours aside;     ///< on Resal's axes: (-w_y, w_x)
    Numbers excess;  ///< there: C w_z - A n

    void put_attitude(int k, double x, double y, double z, double r) {
      const auto at = static_cast<std::size_t>(k);
      q[at] = Four(x, y, z, r);
      q_next[at] = Four(y, z, x, 0);
      q_i[at] = Four(r, z, -y, -x);
      q_j[at] = Four(-z, r, x, -y);
      if constexpr (!on_resal_axes) q_k[at] = Four(y, -x, r, -z);
      q_w[at] = r;
    }

    void put_rate(int k, const Components<double>& a) {
      const auto at = static_cast<std::size_t>(k);
      if constexpr (on_resal_axes) {
        aside[at] = Four(-a.y, a.x, 0, 0);
      } else {
        w[at] = Four(a.x, a.y, a.z, 0);
        w_next[at] = Four(a.y, a.z, a.x, 0);
        w_after[at] = Four(a.z, a.x, a.y, 0);
      }
    }

    void put_relative(int k, const Components<double>& a) {
      const auto at = static_cast<std::size_t>(k);
      u_x[at] = a.x;
      u_y[at] = a.y;
      u_z[at] = a.z;
    }

    void put_rows(int k, const Turn<double>& R) {
      const auto at = static_cast<std::size_t>(k);
      row_x[at] = Four(R.xx, R.xy, R.xz, 0);
      row_y[at] = Four(R.yx, R.yy, R.yz, 0);
      row_z[at] = Four(R.zx, R.zy, R.zz, 0);
    }

    /// R, of a quaternion whose norm is 1/sqrt(scale).
    [[nodiscard]] Turn<double> turn(int k, double scale) const {
      Four square = Four::Zero();  // xx, yy, zz
      Four next = Four::Zero();    // xy, yz, zx
      Four by_w = Four::Zero();    // xw, yw, zw, ww
      convolve(k, [&](std::size_t i, std::size_t j) {
        square += q[i] * q[j];
        next += q[i] * q_next[j];
        by_w += q[i] * q_w[j];
      });
      const double xx = square[0], yy = square[1], zz = square[2], ww = by_w[3];
      const double twice = 2 * scale;
      return {
          scale * (ww + xx - yy - zz), twice * (next[0] - by_w[2]), twice * (next[2] + by_w[1]),
          twice * (next[0] + by_w[2]), scale * (ww - xx + yy - zz), twice * (next[1] - by_w[0]),
          twice * (next[2] - by_w[1]), twice * (next[1] + by_w[0]), scale * (ww - xx - yy + zz)};
    }

    /// q (0, u'), on Resal's axes without u'_z.
    [[nodiscard]] Four attitude_rate(int k) const {
      Four x = Four::Zero();
      Four y = Four::Zero();
      Four z = Four::Zero();
      convolve(k, [&](std::size_t i, std::size_t j) {
        x += q_i[i] * u_x[j];
        y += q_j[i] * u_y[j];
        if constexpr (!on_resal_axes) z += q_k[i] * u_z[j];
      });
      return x + y + z;
    }
  };

  template <class U>
  [[nodiscard]] Components<double> gyroscopic_torque(Table& s, int k, const U& guide) const {
    if constexpr (on_resal_axes) {
      // w_z is u'_z and the guide's part together.
      const auto at = static_cast<std::size_t>(k);
      const auto [A, C] = tensor_.across_and_along();
      s.excess[at] = C * (s.u_z[at] + guide.z) - A * guide.z;
      Four sum = Four::Zero();
      convolve(k, [&](std::size_t i, std::size_t j) { sum += s.aside[i] * s.excess[j]; });
      return {sum[0], sum[1], 0};
    } else {
      Four mixed = Four::Zero();
      Four square = Four::Zero();
      convolve(k, [&](std::size_t i, std::size_t j) {
        mixed += s.w_next[i] * s.w_after[j];
        square += s.w[i] * s.w[j];
      });
      return tensor_.gyroscopic_torque(Components<double>{mixed[0], mixed[1], mixed[2]},
                                       Components<double>{square[0], square[1], square[2]});
    }
  }

  [[nodiscard]] auto felt_now(double t, double h, int order) {
    if constexpr (guide_changes) {
      return felt_.at(t, h, order);
    } else {
      return felt_;
    }
  }

  /// The k-th coefficient of R^t v, of a vector that rests in the guide or of a series.
  template <class V>
  [[nodiscard]] static auto turned_back(const Table& s, int k, const Turn<double>& R, const V& v) {
    if constexpr (guide_changes) {
      Four sum = Four::Zero();
      convolve(k, [&](std::size_t i, std::size_t j) {
        sum += s.row_x[i] * v[j].x + s.row_y[i] * v[j].y + s.row_z[i] * v[j].z;
      });
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
