#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#include <dynamics/gimbal/cardan_parts.hpp>
#include <dynamics/guide/series.hpp>
#include <motor/simd.hpp>
#include <motor/static_zero.hpp>

namespace kreisel::detail {

/// Products of series  (l r)_k = sum_i l_i r_{k-i},  four in each group.
///
/// Terms that wait for nothing are summed first, for all groups, when order k begins. The processor
/// does this while it waits for the coefficients of the order before. The newest coefficients come
/// last, and those of order k from registers, because they are still on their way to memory.
template <std::size_t groups>
class ProductsOfSeries {
 public:
  [[gnu::always_inline]] void begin(int k) {
    // Two sums, so that a term does not wait for the one before.
    Sums even = zeros();
    Sums odd = even;
    const auto last = static_cast<std::size_t>(k) - 1;
    std::size_t i = 2;
    for (; i + 2 < std::size_t(k); i += 2) {
      add(i, std::size_t(k) - i, even);
      add(i + 1, std::size_t(k) - i - 1, odd);
    }
    if (i + 1 < std::size_t(k)) add(i, std::size_t(k) - i, even);
    if (k > 2) add(1, last, odd);
    if (k > 1) add(last, 1, even);
    for (std::size_t g = 0; g < groups; ++g) sums_[g] = even[g] + odd[g];
  }

  /// The products of order k, with the factors' coefficients of that order. The right factors are
  /// available later than the left.
  [[nodiscard, gnu::always_inline]] Vec4d of(std::size_t group, int k, const Vec4d& left,
                                             const Vec4d& right) {
    const auto at = static_cast<std::size_t>(k);
    left_[at][group] = left;
    right_[at][group] = right;
    if (k == 0) return left * right;
    return (sums_[group] + left * right_[0][group]) + left_[0][group] * right;
  }

  /// Adds the terms of right factors that were not known yet and were given as 0.
  [[gnu::always_inline]] void complete(std::size_t group, int k, const Vec4d& right) {
    right_[std::size_t(k)][group] = right;
  }

 private:
  using Sums = std::array<Vec4d, groups>;

  [[nodiscard]] static Sums zeros() {
    Sums sums;
    sums.fill(Vec4d(0, 0, 0, 0));
    return sums;
  }

  [[gnu::always_inline]] void add(std::size_t i, std::size_t j, Sums& sums) const {
    for (std::size_t g = 0; g < groups; ++g) sums[g] += left_[i][g] * right_[j][g];
  }

  using Coefficients = std::array<std::array<Vec4d, groups>, most_series_order + 1>;

  Coefficients left_;
  Coefficients right_;
  Sums sums_;
};

/// The constants in the equations of a CardanGyro.
struct CardanConstants {
  CardanMoments moments;
  CardanBearings bearings;
  RingMoments<double> ring;  ///< the inner one's with the rotor's mean (A_1 + B_1)/2, regulated C_1
  double n;                  ///< (A_1 - B_1)/2
  double singular;           ///< bound below which a determinant counts as 0
  bool regulated;
  double torque = 0;    ///< of the drive, on a rotor that is not regulated
  double friction = 0;  ///< of such a rotor
};

/// The Taylor series of the motion of a CardanGyro, for TaylorSteps. All terms are products of
/// series, so each coefficient follows from those before it. x, y, z are angular velocities of the
/// outer (3) and the inner ring (2) on their own axes:
///
///   x_3 = alpha' + u_x,   x_2 = x_3 cos beta - z_3 sin beta,   z_2 = x_3 sin beta + z_3 cos beta
///
/// Their coefficients of order k + 1, and the momenta and torques of order k, are linear in alpha''
/// and beta'' of order k. The mass matrix is the one at the begin of the step.
///
/// The mean of A_1 and B_1 is added to the ring. The rest of the rotor's tensor on the ring's axes
/// is n (cos 2 phi, sin 2 phi; sin 2 phi, -cos 2 phi).
///
/// Turning : StaticZero if the guide does not turn; u if it turns steadily; or at(t, h, order),
///           which returns the series of u
/// Source  : the equations are those of CardanGyro in another form; recurrences for products:
///           E. Hairer, S. P. Norsett, G. Wanner, Solving Ordinary Differential Equations I, I.8
/// Throws  : ComputationFailed if the mass matrix is singular, as CardanGyro::rates
template <class Turning>
class CardanSeries {
 public:
  static constexpr int most_order = most_series_order;

  /// The relative cost of an order. An order waits for the one before about as long as its sums
  /// take, so high orders pay.
  static constexpr double relative_order = 1.1;

  CardanSeries(const CardanConstants& gyro, const Turning& turning)
      : gyro_(gyro), turning_(turning) {}

  /// Fills the columns 1 to `order` of c with the coefficients of (alpha, beta, phi; their rates)
  /// in powers of (time - t)/h, for the motion that has column 0 at t.
  template <class Coefficients>
  void operator()(double t, double h, int order, Coefficients& c) {
    const auto u = [&] {
      if constexpr (turns_unsteadily) {
        return turning_.at(t, h, order).u;
      } else {
        return turning_;
      }
    }();
    if (gyro_.n == 0) {
      expand<true>(u, h, order, c);
    } else {
      expand<false>(u, h, order, c);
    }
  }

 private:
  static constexpr bool turns = !is_static_zero<Turning>;
  static constexpr bool turns_unsteadily = requires(Turning & turning) { turning.at(0.0, 0.0, 0); };

  /// The inverse of the mass matrix of alpha'' and beta''; ab with opposite sign.
  struct Inverse {
    double aa, ab, bb;
  };

  template <bool round, class U, class Coefficients>
  void expand(const U& u, double h, int order, Coefficients& c) const {
    const CardanConstants& g = gyro_;
    const auto& [outer, inner] = g.bearings;
    const Vector3<double>& outer_ring = g.moments.outer_ring;
    const RingMoments<double>& ring = g.ring;
    const double C_1 = g.moments.rotor.z();
    constexpr std::size_t blades = 3;
    constexpr std::size_t guide = round ? 3 : 5;
    ProductsOfSeries<guide + (turns_unsteadily ? 3 : turns ? 2 : 0)> products;
    [[maybe_unused]] ProductsOfSeries<1> spin;

    // The coefficients of order k, and the first one of factors whose products reach one order
    // further.
    double da = c(3, 0), db = c(4, 0), df = c(5, 0);
    const auto [first_sb, first_cb] = sin_cos(inner.reference, c(1, 0));
    double sb = first_sb, cb = first_cb;
    [[maybe_unused]] double sa = 0, ca = 0, y3 = 0, z3 = 0;
    const Components<double> first_u = first(u);
    if constexpr (turns) {
      const auto alpha = sin_cos(outer.reference, c(0, 0));
      sa = alpha.sin;
      ca = alpha.cos;
      y3 = first_u.y * ca + first_u.z * sa;
      z3 = first_u.z * ca - first_u.y * sa;
    }
    const double first_x3 = da + first_u.x, first_z3 = z3;
    double x2 = cb * first_x3 - sb * z3, y2 = db + y3, z2 = sb * first_x3 + cb * z3;
    const double first_x2 = x2, first_y2 = y2, first_df = df;
    [[maybe_unused]] double s2 = 0, c2 = 0, X = 0, Y = 0;
    SinCos<double> spun;
    if constexpr (!round) {
      spun = {std::sin(c(2, 0)), std::cos(c(2, 0))};
      s2 = 2 * spun.sin * spun.cos;
      c2 = (spun.cos - spun.sin) * (spun.cos + spun.sin);
      X = c2 * x2 + s2 * y2;
      Y = s2 * x2 - c2 * y2;
    }
    const double first_s2 = s2, first_c2 = c2;
    const Inverse inverse = inverted<round>(c(1, 0), sb, cb, spun);

    for (int k = 0; k < order; ++k) {
      const double w = h / (k + 1);
      const double per = 1 / w;

      // Coefficients of order k + 1, without the contribution of alpha'' and beta'' of order k.
      products.begin(k);
      const Vec4d angles = products.of(0, k, {cb, sb, cb, sb}, {db, db, 0, 0});
      const double next_sb = w * angles[0];
      const double next_cb = -w * angles[1];
      double next_x2 = angles[2] + next_cb * first_x3;
      double next_z2 = angles[3] + next_sb * first_x3;
      double next_x3 = 0, next_y2 = 0;
      [[maybe_unused]] double y3z3 = 0;
      if constexpr (turns) {
        const Vec4d turned = products.of(guide, k, {z3, y3, cb, sb}, {da, da, 0, 0});
        const Vec4d beside = products.of(guide + 1, k, {y3, ca, sa, 0}, {z3, da, da, 0});
        y3z3 = beside[0];
        if constexpr (turns_unsteadily) {
          const Components<double>& next_u = u[std::size_t(k) + 1];
          const Vec4d field =
              products.of(guide + 2, k, {ca, sa, ca, sa}, {next_u.y, next_u.z, next_u.z, next_u.y});
          sa = w * beside[1];
          ca = -w * beside[2];
          y3 = (field[0] + field[1]) + (ca * first_u.y + sa * first_u.z);
          z3 = (field[2] - field[3]) + (ca * first_u.z - sa * first_u.y);
          next_x3 = next_u.x;
        } else {
          y3 = w * turned[0];
          z3 = -w * turned[1];
        }
        products.complete(guide, k, {da, da, z3, z3});
        next_x2 -= turned[3] + first_sb * z3 + next_sb * first_z3;
        next_z2 += turned[2] + first_cb * z3 + next_cb * first_z3;
        next_x2 += first_cb * next_x3;
        next_z2 += first_sb * next_x3;
        next_y2 = y3;
      }

      // Torques that turn inner ring and rotor, on the ring's axes: rates of their angular
      // momentum, and w x of it.
      const double L = C_1 * (g.regulated ? df : z2 + df);
      const Vec4d gyro = products.of(1, k, {y2, y2, x2, 0},
                                     {x2, (ring.c - ring.b) * z2 + L, ring.a_less_c * z2 - L, 0});
      double on_a = per * ring.a * next_x2 + gyro[1];
      double on_b = per * ring.b * next_y2 + gyro[2];
      const double on_c = per * ring.c * next_z2 + (ring.b - ring.a) * gyro[0];
      [[maybe_unused]] double next_s2 = 0, next_c2 = 0, next_x = 0, next_y = 0;
      double twist = 0;
      if constexpr (!round) {
        if (g.regulated) {
          next_s2 = 2 * w * first_df * c2;
          next_c2 = -2 * w * first_df * s2;
        } else {
          spin.begin(k);
          const Vec4d turned = spin.of(0, k, {c2, s2, 0, 0}, {df, df, 0, 0});
          next_s2 = 2 * w * turned[0];
          next_c2 = -2 * w * turned[1];
        }
        const Vec4d by_w =
            products.of(blades, k, {c2, s2, s2, c2}, {next_x2, next_y2, next_x2, next_y2});
        next_x = (by_w[0] + by_w[1]) + (next_c2 * first_x2 + next_s2 * first_y2);
        next_y = (by_w[2] - by_w[3]) + (next_s2 * first_x2 - next_c2 * first_y2);
        const Vec4d turned = products.of(blades + 1, k, {z2, z2, x2, y2}, {Y, X, Y, X});
        on_a += g.n * (per * next_x - turned[0]);
        on_b += g.n * (per * next_y + turned[1]);
        twist = g.n * (turned[2] - turned[3]);
      }
      const double torque = (k == 0 ? g.torque : 0) - g.friction * df;
      double along = on_c + (g.regulated ? twist : torque);

      const Vec4d on_outer = products.of(2, k, {cb, sb, 0, 0}, {on_a, along, 0, 0});
      const double left_a =
          resistance(outer, c(0, k), da) + (on_outer[0] + on_outer[1]) +
          (per * outer_ring.x() * next_x3 + (outer_ring.z() - outer_ring.y()) * y3z3);
      const double left_b = resistance(inner, c(1, k), db) + on_b;
      double dda = -inverse.aa * left_a;
      double ddb = -inverse.bb * left_b;
      if constexpr (!round) {
        dda += inverse.ab * left_b;
        ddb += inverse.ab * left_a;
      }

      // Add the contribution of alpha'' and beta''.
      da = w * dda;
      db = w * ddb;
      const double more_x2 = first_cb * da;
      const double more_z2 = first_sb * da;
      x2 = next_x2 + more_x2;
      y2 = next_y2 + db;
      z2 = next_z2 + more_z2;
      next_x3 += da;
      on_a += per * ring.a * more_x2;
      along += per * ring.c * more_z2;
      if constexpr (!round) {
        const double more_x = first_c2 * more_x2 + first_s2 * db;
        on_a += g.n * per * more_x;
        X = next_x + more_x;
        Y = next_y + (first_s2 * more_x2 - first_c2 * db);
        s2 = next_s2;
        c2 = next_c2;
        products.complete(blades, k, {x2, y2, x2, y2});
      }
      products.complete(0, k, {c(4, k), c(4, k), next_x3, next_x3});
      products.complete(2, k, {on_a, along, 0, 0});
      sb = next_sb;
      cb = next_cb;

      for (int i = 0; i < 3; ++i) c(i, k + 1) = w * c(i + 3, k);
      df = g.regulated ? 0 : w * (torque - twist) / C_1 - z2;
      c(3, k + 1) = da;
      c(4, k + 1) = db;
      c(5, k + 1) = df;
    }
  }

  [[nodiscard]] static Components<double> first(const StaticZero& /*u*/) { return {}; }
  [[nodiscard]] static Components<double> first(const Components<double>& u) { return u; }
  [[nodiscard]] static Components<double> first(const GuideSeries::Coefficients& u) { return u[0]; }

  [[nodiscard]] static double resistance(const CardanBearing& bearing, double q, double dq) {
    return bearing.stiffness * q + bearing.damping * dq;
  }

  template <bool round>
  [[nodiscard]] Inverse inverted(double beta, double sb, double cb,
                                 const SinCos<double>& spun) const {
    const auto& [rotor, inner, outer] = gyro_.moments;
    const double across = outer.x() + gyro_.ring.c * (sb * sb);
    const double cc = cb * cb;
    if constexpr (round) {
      const double M_aa = across + cc * gyro_.ring.a;
      if (M_aa <= gyro_.singular) stop(beta);
      return {1 / M_aa, 0, 1 / gyro_.ring.b};
    } else {
      const auto& [s, c] = spun;
      const double P = rotor.x() * c * c + rotor.y() * s * s;
      const double Q = rotor.x() * s * s + rotor.y() * c * c;
      const double M_bb = inner.y() + Q;
      const double det =
          across * M_bb + cc * (inner.x() * M_bb + inner.y() * P + rotor.x() * rotor.y());
      if (det <= gyro_.singular) stop(beta);
      return {M_bb / det, 2 * gyro_.n * s * c * cb / det, (across + cc * (inner.x() + P)) / det};
    }
  }

  [[noreturn]] void stop(double beta) const {
    stop_where_singular(gyro_.moments, gyro_.regulated, gyro_.bearings.inner.reference, beta);
  }

  CardanConstants gyro_;
  Turning turning_;
};

}  // namespace kreisel::detail
