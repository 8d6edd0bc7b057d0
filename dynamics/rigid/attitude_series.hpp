#pragma once

#include <array>
#include <cstddef>

#include <dynamics/guide/series.hpp>
#include <dynamics/rigid/diagonals.hpp>
#include <dynamics/rigid/tensor_of_four.hpp>
#include <motor/four.hpp>
#include <motor/static_zero.hpp>

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
      : tensor_(tensor),
        first_moment_(four(first_moment)),
        felt_(felt),
        momentum_(four(momentum)) {}

  /// Fills the columns 1 to `order` of c with the coefficients of (quaternion x, y, z, w; u') in
  /// powers of (time - t)/h, for the motion that has column 0 at t.
  template <class Coefficients>
  void operator()(double t, double h, int order, Coefficients& c) {
    const auto felt = felt_now(t, h, order);
    Table s;
    const double norm2 = c.col(0).template head<4>().squaredNorm();
    s.put_attitude(0, {c(0, 0), c(1, 0), c(2, 0), c(3, 0)});
    // At the beginning it is u' that is known, not w.
    Four w(c(4, 0), c(5, 0), c(6, 0), 0);
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
      const Diagonals R = Diagonals::turn_back(sums.square, sums.next, sums.by_w, 1 / norm2);
      if constexpr (guide_changes) {
        s.turn_back[std::size_t(k)] = R;
        at_the_ends(k, [&](std::size_t i, std::size_t j) { s.add_felt(i, j, felt, sums); });
      } else {
        if constexpr (guide_turns) sums.guide = R * felt.u;
        if constexpr (pulled) sums.gravity = R * felt.g;
      }
      if (k == 0) w += sums.guide;
      const Four u = w - sums.guide;
      for (int i = 0; i < 3; ++i) c(4 + i, k) = u[i];
      if (k == order) return;
      s.put_rates(k, w, by_whole_rate ? w : u);
      if constexpr (on_resal_axes) {
        s.excess[std::size_t(k)] = tensor_.along() * w[2] - tensor_.across() * sums.guide[2];
      }
      at_the_ends(k, [&](std::size_t i, std::size_t j) { s.add_rates(i, j, sums); });
      const double weight = h / (k + 1);
      w = weight * tensor_.solve(moment(w, sums));
      Four dq = sums.x + sums.y + sums.z;
      if constexpr (by_whole_rate && guide_turns) dq = dq - s.turned_along(k, felt.u.as_is);
      dq = weight / 2 * dq;
      s.put_attitude(k + 1, dq);
      for (int i = 0; i < 4; ++i) c(i, k + 1) = dq[i];
    }
  }

 private:
  static constexpr bool on_resal_axes = axes == RateAxes::resal;
  static constexpr bool guide_changes = requires(Felt & felt) { felt.at(0.0, 0.0, 0); };

  [[nodiscard]] static constexpr bool feels_a_turning() {
    if constexpr (guide_changes) {
      return true;
    } else {
      return !decltype(Felt::u)::absent;
    }
  }
  [[nodiscard]] static constexpr bool feels_gravity() {
    if constexpr (guide_changes) {
      return true;
    } else {
      return !decltype(Felt::g)::absent;
    }
  }
  static constexpr bool guide_turns = feels_a_turning();
  static constexpr bool pulled = !FirstMoment::absent && feels_gravity();

  /// q' is taken as  (q (0, w) - (0, u) q)/2,  which does not have to wait for R.
  static constexpr bool by_whole_rate = !on_resal_axes && !guide_changes;

  template <class T>
  using Of = std::array<T, most_order + 1>;

  struct SteadyFelt {
    Cycles u, g;
  };
  struct ChangingFelt {
    Of<Cycles> u, g;
  };

  /// The k-th coefficients of products.
  struct Sums {
    Four square = {0, 0, 0, 0};  ///< of q: xx, yy, zz, ww
    Four next = {0, 0, 0, 0};    ///< xy, yz, zx
    Four by_w = {0, 0, 0, 0};    ///< xw, yw, zw
    Four x = {0, 0, 0, 0};       ///< q (0, u') or q (0, w), by the components of u' or w
    Four y = {0, 0, 0, 0};
    Four z = {0, 0, 0, 0};
    Four mixed = {0, 0, 0, 0};     ///< of w: yz, zx, xy; Resal's: (n A - C w_z)(w_y, -w_x)
    Four w_square = {0, 0, 0, 0};  ///< xx, yy, zz
    Four guide = {0, 0, 0, 0};     ///< R^t u
    Four gravity = {0, 0, 0, 0};   ///< R^t g'
  };

  /// The coefficients so far, as the products take them. Of the functions that add up the compiler
  /// would not put all in their places by itself, and what they add up is in no register then.
  struct Table {
    Of<Four> q, q_next;      ///< (x, y, z, w), (y, z, x, w)
    Of<Four> q_i, q_j, q_k;  ///< the products with the quaternion units
    Of<Four> w, w_next, w_after;
    Of<Four> u;  ///< u', or w where that is taken for it
    Of<Diagonals> turn_back;
    Of<Four> aside;     ///< on Resal's axes: (-w_y, w_x)
    Of<double> excess;  ///< there: C w_z - A n

    void put_attitude(int k, const Four& a) {
      const auto at = static_cast<std::size_t>(k);
      q[at] = a;
      q_next[at] = a.next();
      q_i[at] = Four(a[3], a[2], -a[1], -a[0]);
      q_j[at] = Four(-a[2], a[3], a[0], -a[1]);
      if constexpr (!on_resal_axes) q_k[at] = Four(a[1], -a[0], a[3], -a[2]);
    }

    void put_rates(int k, const Four& a, const Four& rate) {
      const auto at = static_cast<std::size_t>(k);
      if constexpr (on_resal_axes) {
        aside[at] = Four(-a[1], a[0], 0, 0);
      } else {
        w[at] = a;
        w_next[at] = a.next();
        w_after[at] = a.after();
      }
      u[at] = rate;
    }

    /// (0, v) q
    [[nodiscard]] Four turned_along(int k, const Four& v) const {
      const auto at = static_cast<std::size_t>(k);
      return Four(v[0], -v[0], -v[0], v[0]) * q_i[at] + Four(-v[1], v[1], -v[1], v[1]) * q_j[at] +
             Four(-v[2], -v[2], v[2], v[2]) * q_k[at];
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

    [[gnu::always_inline]] void add_felt(std::size_t i, std::size_t j, const ChangingFelt& felt,
                                         Sums& s) const {
      s.guide += turn_back[i] * felt.u[j];
      if constexpr (pulled) s.gravity += turn_back[i] * felt.g[j];
    }
  };

  /// The terms of a product that have the newest coefficients.
  template <class Term>
  static void at_the_ends(int k, const Term& term) {
    term(0, std::size_t(k));
    if (k > 0) term(std::size_t(k), 0);
  }

  [[nodiscard]] Four moment(const Four& w, const Sums& sums) const {
    Four sum = sums.mixed;
    if constexpr (!on_resal_axes) sum = tensor_.gyroscopic_torque(sums.mixed, sums.w_square);
    if constexpr (!Momentum::absent) sum += cross(momentum_, w);
    if constexpr (pulled) sum += cross(first_moment_, sums.gravity);
    return sum;
  }

  [[nodiscard]] auto felt_now(double t, double h, int order) {
    if constexpr (guide_changes) {
      const GuideSeries series = felt_.at(t, h, order);
      ChangingFelt felt;
      for (std::size_t k = 0; k <= std::size_t(order); ++k) {
        felt.u[k] = Cycles(four(series.u[k]));
        felt.g[k] = Cycles(four(series.g[k]));
      }
      return felt;
    } else {
      return SteadyFelt{Cycles(four(felt_.u)), Cycles(four(felt_.g))};
    }
  }

  TensorOfFour<Tensor> tensor_;
  Four first_moment_;
  Felt felt_;
  Four momentum_;
};

}  // namespace kreisel::detail
