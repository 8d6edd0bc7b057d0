#pragma once

#include <array>
#include <cstddef>

#include <dynamics/guide/series.hpp>
#include <dynamics/rigid/packed_tensor.hpp>
#include <motor/simd.hpp>
#include <motor/static_zero.hpp>

namespace kreisel::detail {

/// The axes on which the angular velocity of a body is written.
enum class RateAxes {
  body,
  resal  ///< of a body of revolution: they follow its axis z, but do not spin with it
};

/// The Taylor series of the motion of a fixed-point body under apparent gravity alone, for
/// TaylorSteps. All terms are products of series, so each coefficient follows from those before it:
///
///   q' = q (0, u')/2,   Theta w' = -w x (Theta w + h) + s x R^t g',   u' = w - R^t u
///
/// R is quadratic in q, whose norm does not change. Resal's axes turn by (u'_x, u'_y, 0), and there
/// Theta w' = ((A n - C w_z) w_y, (C w_z - A n) w_x, 0) + s x R^t g',  n = (R^t u)_z.
///
/// Apparent : u and g' on guide axes; or at(t, h, order), which returns their series
/// Source   : recurrences for products: E. Hairer, S. P. Norsett, G. Wanner, Solving Ordinary
///            Differential Equations I, I.8
template <class Tensor, class FirstMoment, class Apparent, RateAxes axes = RateAxes::body,
          class Momentum = ZeroVector>
class AttitudeSeries {
 public:
  static constexpr int most_order = most_series_order;

  AttitudeSeries(const Tensor& tensor, const FirstMoment& first_moment, const Apparent& apparent,
                 const Momentum& momentum = {})
      : tensor_(tensor),
        first_moment_(vec4d(first_moment)),
        apparent_(apparent),
        momentum_(vec4d(momentum)) {}

  /// Fills the columns 1 to `order` of c with the coefficients of (quaternion x, y, z, w; u') in
  /// powers of (time - t)/h, for the motion that has column 0 at t.
  template <class Coefficients>
  void operator()(double t, double h, int order, Coefficients& c) {
    const auto apparent = apparent_now(t, h, order);
    Table s;
    const double norm2 = c.col(0).template head<4>().squaredNorm();
    s.put_attitude(0, {c(0, 0), c(1, 0), c(2, 0), c(3, 0)});
    // The initial state contains u', not w.
    Vec4d w(c(4, 0), c(5, 0), c(6, 0), 0);
    for (int k = 0;; ++k) {
      Sums sums;
      // Products of known coefficients come first, and the newest coefficients last: those may
      // still be on their way to memory.
      for (std::size_t i = 1, j = std::size_t(k) - 1; i < std::size_t(k); ++i, --j) {
        s.add_attitudes(i, j, sums);
        s.add_rates(i, j, sums);
        if constexpr (guide_changes) s.add_apparent(i, j, apparent, sums);
      }
      at_the_ends(k, [&](std::size_t i, std::size_t j) { s.add_attitudes(i, j, sums); });
      const Mat3dByDiagonals R =
          Mat3dByDiagonals::rotation_back(sums.square, sums.next, sums.by_w, 1 / norm2);
      if constexpr (guide_changes) {
        s.rotation_back[std::size_t(k)] = R;
        at_the_ends(k, [&](std::size_t i, std::size_t j) { s.add_apparent(i, j, apparent, sums); });
      } else {
        if constexpr (guide_turns) sums.guide = R * apparent.u;
        if constexpr (pulled) sums.gravity = R * apparent.g;
      }
      if (k == 0) w += sums.guide;
      const Vec4d u = w - sums.guide;
      for (int i = 0; i < 3; ++i) c(4 + i, k) = u[i];
      if (k == order) return;
      s.put_rates(k, w, by_whole_rate ? w : u);
      if constexpr (on_resal_axes) {
        s.excess[std::size_t(k)] = tensor_.along() * w[2] - tensor_.across() * sums.guide[2];
      }
      at_the_ends(k, [&](std::size_t i, std::size_t j) { s.add_rates(i, j, sums); });
      const double weight = h / (k + 1);
      w = weight * tensor_.solve(moment(w, sums));
      Vec4d dq = sums.x + sums.y + sums.z;
      if constexpr (by_whole_rate && guide_turns) dq = dq - s.rotated_along(k, apparent.u.as_is);
      dq = weight / 2 * dq;
      s.put_attitude(k + 1, dq);
      for (int i = 0; i < 4; ++i) c(i, k + 1) = dq[i];
    }
  }

 private:
  static constexpr bool on_resal_axes = axes == RateAxes::resal;
  static constexpr bool guide_changes = requires(Apparent & apparent) { apparent.at(0.0, 0.0, 0); };

  [[nodiscard]] static constexpr bool feels_a_turning() {
    if constexpr (guide_changes) {
      return true;
    } else {
      return !decltype(Apparent::u)::static_zero;
    }
  }
  [[nodiscard]] static constexpr bool feels_gravity() {
    if constexpr (guide_changes) {
      return true;
    } else {
      return !decltype(Apparent::g)::static_zero;
    }
  }
  static constexpr bool guide_turns = feels_a_turning();
  static constexpr bool pulled = !FirstMoment::static_zero && feels_gravity();

  /// q' is computed as  (q (0, w) - (0, u) q)/2,  which does not have to wait for R.
  static constexpr bool by_whole_rate = !on_resal_axes && !guide_changes;

  template <class T>
  using Of = std::array<T, most_order + 1>;

  struct SteadyApparent {
    CyclicVec4d u, g;
  };
  struct ChangingApparent {
    Of<CyclicVec4d> u, g;
  };

  /// The k-th coefficients of products.
  struct Sums {
    Vec4d square = {0, 0, 0, 0};  ///< of q: xx, yy, zz, ww
    Vec4d next = {0, 0, 0, 0};    ///< xy, yz, zx
    Vec4d by_w = {0, 0, 0, 0};    ///< xw, yw, zw
    Vec4d x = {0, 0, 0, 0};       ///< q (0, u') or q (0, w), by the components of u' or w
    Vec4d y = {0, 0, 0, 0};
    Vec4d z = {0, 0, 0, 0};
    Vec4d mixed = {0, 0, 0, 0};     ///< of w: yz, zx, xy; Resal's: (n A - C w_z)(w_y, -w_x)
    Vec4d w_square = {0, 0, 0, 0};  ///< xx, yy, zz
    Vec4d guide = {0, 0, 0, 0};     ///< R^t u
    Vec4d gravity = {0, 0, 0, 0};   ///< R^t g'
  };

  /// The coefficients so far, arranged as the products read them. The summing functions are always
  /// inlined: otherwise the compiler calls some of them, and their sums are then not in registers.
  struct Table {
    Of<Vec4d> q, q_next;      ///< (x, y, z, w), (y, z, x, w)
    Of<Vec4d> q_i, q_j, q_k;  ///< the products with the quaternion units
    Of<Vec4d> w, w_next, w_after;
    Of<Vec4d> u;  ///< u', or w in its place
    Of<Mat3dByDiagonals> rotation_back;
    Of<Vec4d> aside;    ///< on Resal's axes: (-w_y, w_x)
    Of<double> excess;  ///< there: C w_z - A n

    void put_attitude(int k, const Vec4d& a) {
      const auto at = static_cast<std::size_t>(k);
      q[at] = a;
      q_next[at] = a.next();
      q_i[at] = Vec4d(a[3], a[2], -a[1], -a[0]);
      q_j[at] = Vec4d(-a[2], a[3], a[0], -a[1]);
      if constexpr (!on_resal_axes) q_k[at] = Vec4d(a[1], -a[0], a[3], -a[2]);
    }

    void put_rates(int k, const Vec4d& a, const Vec4d& rate) {
      const auto at = static_cast<std::size_t>(k);
      if constexpr (on_resal_axes) {
        aside[at] = Vec4d(-a[1], a[0], 0, 0);
      } else {
        w[at] = a;
        w_next[at] = a.next();
        w_after[at] = a.after();
      }
      u[at] = rate;
    }

    /// (0, v) q
    [[nodiscard]] Vec4d rotated_along(int k, const Vec4d& v) const {
      const auto at = static_cast<std::size_t>(k);
      return Vec4d(v[0], -v[0], -v[0], v[0]) * q_i[at] + Vec4d(-v[1], v[1], -v[1], v[1]) * q_j[at] +
             Vec4d(-v[2], -v[2], v[2], v[2]) * q_k[at];
    }

    [[gnu::always_inline]] void add_attitudes(std::size_t i, std::size_t j, Sums& s) const {
      s.square += q[i] * q[j];
      s.next += q[i] * q_next[j];
      s.by_w += q[j][3] * q[i];
    }

    [[gnu::always_inline]] void add_rates(std::size_t i, std::size_t j, Sums& s) const {
      s.x += u[j][0] * q_i[i];
      s.y += u[j][1] * q_j[i];
      if constexpr (on_resal_axes) {
        s.mixed += excess[j] * aside[i];
      } else {
        s.z += u[j][2] * q_k[i];
        s.mixed += w_next[i] * w_after[j];
        s.w_square += w[i] * w[j];
      }
    }

    [[gnu::always_inline]] void add_apparent(std::size_t i, std::size_t j,
                                             const ChangingApparent& apparent, Sums& s) const {
      s.guide += rotation_back[i] * apparent.u[j];
      if constexpr (pulled) s.gravity += rotation_back[i] * apparent.g[j];
    }
  };

  /// Adds the terms of a product that contain the newest coefficients.
  template <class Term>
  static void at_the_ends(int k, const Term& term) {
    term(0, std::size_t(k));
    if (k > 0) term(std::size_t(k), 0);
  }

  [[nodiscard]] Vec4d moment(const Vec4d& w, const Sums& sums) const {
    Vec4d sum = sums.mixed;
    if constexpr (!on_resal_axes) sum = tensor_.gyroscopic_torque(sums.mixed, sums.w_square);
    if constexpr (!Momentum::static_zero) sum += cross(momentum_, w);
    if constexpr (pulled) sum += cross(first_moment_, sums.gravity);
    return sum;
  }

  [[nodiscard]] auto apparent_now(double t, double h, int order) {
    if constexpr (guide_changes) {
      const GuideSeries series = apparent_.at(t, h, order);
      ChangingApparent apparent;
      for (std::size_t k = 0; k <= std::size_t(order); ++k) {
        apparent.u[k] = CyclicVec4d(vec4d(series.u[k]));
        apparent.g[k] = CyclicVec4d(vec4d(series.g[k]));
      }
      return apparent;
    } else {
      return SteadyApparent{CyclicVec4d(vec4d(apparent_.u)), CyclicVec4d(vec4d(apparent_.g))};
    }
  }

  PackedTensor<Tensor> tensor_;
  Vec4d first_moment_;
  Apparent apparent_;
  Vec4d momentum_;
};

}  // namespace kreisel::detail
