#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#include <dynamics/guide/series.hpp>
#include <dynamics/scene/cardan_parts.hpp>
#include <motor/absent.hpp>
#include <motor/four.hpp>

namespace kreisel::detail {

/// Products of series  (l r)_k = sum_i l_i r_{k-i},  four in each group.
///
/// What waits for nothing is summed up first, of all groups, when order k begins: the processor does
/// it while it waits for the coefficients before. The newest ones come last, and those of order k from
/// registers, for they are on their way to memory still.
template <std::size_t groups>
class ProductsOfSeries {
 public:
  [[gnu::always_inline]] void begin(int k) {
    sums_.fill(Four(0, 0, 0, 0));
    const auto last = static_cast<std::size_t>(k) - 1;
    for (std::size_t i = 2; i + 1 < std::size_t(k); ++i) add(i, std::size_t(k) - i);
    if (k > 2) add(1, last);
    if (k > 1) add(last, 1);
  }

  /// Those of order k, with the factors' coefficients of that order, the right ones of which are
  /// waited for longer.
  [[nodiscard, gnu::always_inline]] Four of(std::size_t group, int k, const Four& left,
                                            const Four& right) {
    const auto at = static_cast<std::size_t>(k);
    left_[at][group] = left;
    right_[at][group] = right;
    if (k == 0) return left * right;
    return (sums_[group] + left * right_[0][group]) + left_[0][group] * right;
  }

  /// Puts in what right factors were not known yet and given as 0.
  [[gnu::always_inline]] void complete(std::size_t group, int k, const Four& right) {
    right_[std::size_t(k)][group] = right;
  }

 private:
  [[gnu::always_inline]] void add(std::size_t i, std::size_t j) {
    for (std::size_t g = 0; g < groups; ++g) sums_[g] += left_[i][g] * right_[j][g];
  }

  using Coefficients = std::array<std::array<Four, groups>, most_series_order + 1>;

  Coefficients left_;
  Coefficients right_;
  std::array<Four, groups> sums_;
};

/// The numbers in the equations of a CardanGyro.
struct CardanConstants {
  CardanMoments moments;
  CardanBearings bearings;
  RingMoments<double> ring;  ///< the inner one's with the rotor's mean (A_1 + B_1)/2, regulated C_1
  double n;                  ///< (A_1 - B_1)/2
  double singular;           ///< how small a determinant counts as 0
  bool regulated;
  double torque = 0;    ///< of the drive, on a rotor that is not regulated
  double friction = 0;  ///< of such a rotor
};

/// The Taylor series of the motion of a CardanGyro, for TaylorSteps. All is products of series, so
/// that each coefficient comes from those before it. x, y, z are angular velocities of the outer (3)
/// and the inner ring (2) on their own axes, d their rates without what alpha'' and beta'' do to them:
///
///   x_3 = alpha' + u_x,   dy_3 = alpha' z_3 + (ou_y cos alpha + ou_z sin alpha),   and so on
///
/// With the mean of A_1 and B_1 in the ring, what is left of the rotor's tensor on the ring's axes is
/// n (cos 2 phi, sin 2 phi; sin 2 phi, -cos 2 phi).
///
/// Turning : Absent where the guide does not turn; u where it does so steadily; or at(t, h, order),
///           which gives the series of u
/// Source  : the equations are those of CardanGyro in another form; recurrences for products:
///           E. Hairer, S. P. Norsett, G. Wanner, Solving Ordinary Differential Equations I, I.8
/// Throws  : ComputationFailed where the mass matrix is singular, as CardanGyro::rates
template <class Turning>
class CardanSeries {
 public:
  static constexpr int most_order = most_series_order;

  CardanSeries(const CardanConstants& gyro, const Turning& turning)
      : gyro_(gyro), turning_(turning) {}

  /// Fills the columns 1 to `order` of c with the coefficients of (alpha, beta, phi; their rates) in
  /// powers of (time - t)/h, for the motion that has column 0 at t.
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
  static constexpr bool turns = !is_absent<Turning>;
  static constexpr bool turns_unsteadily = requires(Turning & turning) { turning.at(0.0, 0.0, 0); };

  /// Of the mass matrix of alpha'' and beta''; ab with its sign turned.
  struct Inverse {
    double aa, ab, bb;
  };

  template <bool round, class U, class Coefficients>
  void expand(const U& u, double h, int order, Coefficients& c) const {
    const CardanConstants& g = gyro_;
    const auto& [outer, inner] = g.bearings;
    const Vector3<double>& outer_ring = g.moments.outer_ring;
    const double C_1 = g.moments.rotor.z();
    ProductsOfSeries<3> rings;
    [[maybe_unused]] ProductsOfSeries<turns_unsteadily ? 5 : 3> guide;
    [[maybe_unused]] ProductsOfSeries<5> blades;

    // Of series that are not in c: the coefficient of order k.
    auto [sb, cb] = sin_cos(inner.reference, c(1, 0));
    const double first_sb = sb;
    [[maybe_unused]] double sa = 0, ca = 0, y3 = 0, z3 = 0;
    if constexpr (turns) {
      const auto alpha = sin_cos(outer.reference, c(0, 0));
      sa = alpha.sin;
      ca = alpha.cos;
      const Components<double> now = first(u);
      y3 = now.y * ca + now.z * sa;
      z3 = now.z * ca - now.y * sa;
    }
    [[maybe_unused]] double s2 = 0, c2 = 0;
    if constexpr (!round) {
      s2 = std::sin(2 * c(2, 0));
      c2 = std::cos(2 * c(2, 0));
    }
    const Inverse inverse = inverted<round>(c(1, 0), sb, cb, c(2, 0));

    double da = c(3, 0), db = c(4, 0), df = c(5, 0);
    for (int k = 0; k < order; ++k) {
      const double w = h / (k + 1);

      // The rings' angular velocities, and what is known of their rates.
      double x3 = da;
      [[maybe_unused]] Components<double> du = {};
      if constexpr (turns_unsteadily) {
        x3 += u[std::size_t(k)].x;
        du = (1 / w) * u[std::size_t(k) + 1];
      } else if constexpr (turns) {
        if (k == 0) x3 += u.x;
      }
      rings.begin(k);
      const Four angles = rings.of(0, k, {cb, sb, cb, sb}, {db, db, x3, x3});
      double x2 = angles[2], y2 = db, z2 = angles[3];
      double dy3 = 0, fx = 0, fz = 0, y3z2 = 0, y3x2 = 0, y3z3 = 0;
      if constexpr (turns) {
        guide.begin(k);
        const Four turned = guide.of(0, k, {z3, y3, cb, sb}, {da, da, z3, z3});
        x2 -= turned[3];
        y2 += y3;
        z2 += turned[2];
        dy3 = turned[0];
        double dz3 = -turned[1];
        if constexpr (turns_unsteadily) {
          const Four rate = guide.of(3, k, {ca, sa, ca, sa}, {du.y, du.z, du.z, du.y});
          dy3 += rate[0] + rate[1];
          dz3 += rate[2] - rate[3];
          const Four alpha = guide.of(4, k, {ca, sa, 0, 0}, {da, da, 0, 0});
          sa = w * alpha[0];
          ca = -w * alpha[1];
        }
        const Four by_z3 = guide.of(1, k, {cb, sb, y3, y3}, {dz3, dz3, z2, x2});
        const Four by_du = guide.of(2, k, {du.x, du.x, y3, 0}, {cb, sb, z3, 0});
        fx = by_du[0] - by_z3[1];
        fz = by_du[1] + by_z3[0];
        y3z2 = by_z3[2];
        y3x2 = by_z3[3];
        y3z3 = by_du[2];
        y3 = w * dy3;
        z3 = w * dz3;
      }

      // What turns inner ring and rotor, on the ring's axes.
      const double L = C_1 * (g.regulated ? df : z2 + df);
      const Four ring = rings.of(1, k, {y2, y2, x2, sb},
                                 {x2, g.ring.c_less_ab * z2 + L, g.ring.a_less_c * z2 - L, sb});
      const double dz2 = fz + (ring[0] - y3x2);
      double on_a = g.ring.a * (fx + y3z2) + ring[1];
      double on_b = g.ring.b * dy3 + ring[2];
      const double on_c = g.ring.c * (fz - y3x2) + g.ring.bc_less_a * ring[0];
      // Of the mass matrix the first coefficient is inverted already; cos^2 + sin^2 = 1.
      const double cc = k == 0 ? cb * cb : -ring[3];
      double M_aa = (g.ring.c - g.ring.a) * ring[3];
      double twist = 0, M_a_rest = 0, M_b_rest = 0;
      [[maybe_unused]] Four spun;
      if constexpr (!round) {
        blades.begin(k);
        spun = blades.of(0, k, {c2, s2, db, s2}, {df, df, z2, cb});
        const double dx2 = fx - spun[2];
        const Four by_w = blades.of(1, k, {c2, s2, s2, c2}, {x2, y2, x2, y2});
        const Four by_dw = blades.of(2, k, {c2, s2, s2, c2}, {dx2, dy3, dx2, dy3});
        const double X = by_w[0] + by_w[1];
        const double Y = by_w[2] - by_w[3];
        const double both = 2 * df + z2;
        const Four gyro = blades.of(3, k, {both, both, x2, y2}, {Y, X, Y, X});
        on_a += g.n * ((by_dw[0] + by_dw[1]) - gyro[0]);
        on_b += g.n * ((by_dw[2] - by_dw[3]) + gyro[1]);
        twist = g.n * (gyro[2] - gyro[3]);
        const double M_ab = g.n * spun[3];
        const Four mass = blades.of(4, k, {cc, M_ab, M_ab, -g.n * c2}, {c2, 0, 0, 0});
        M_aa += g.n * mass[0];
        M_a_rest = mass[1];
        M_b_rest = mass[2] + mass[3];
      }
      const double torque = (k == 0 ? g.torque : 0) - g.friction * df;
      const double along = on_c + (g.regulated ? twist : torque);

      // alpha'' and beta'', of which the products lack the newest coefficient.
      const Four known = rings.of(2, k, {cb, sb, M_aa, sb}, {on_a, along, 0, 0});
      const double resisted_a = resistance(outer, c(0, k), da) + M_a_rest +
                                (outer_ring.x() * du.x + (outer_ring.z() - outer_ring.y()) * y3z3);
      const double left_a = (resisted_a + known[2]) + (known[0] + known[1]);
      const double left_b = resistance(inner, c(1, k), db) + on_b + M_b_rest;
      double dda = -inverse.aa * left_a;
      double ddb = -inverse.bb * left_b;
      if constexpr (!round) {
        dda += inverse.ab * left_b;
        ddb += inverse.ab * left_a;
      }
      rings.complete(2, k, {on_a, along, dda, dda});
      if constexpr (!round) {
        blades.complete(4, k, {c2, ddb, dda, ddb});
        s2 = 2 * w * spun[0];
        c2 = -2 * w * spun[1];
      }
      const double ddf = (torque - twist) / C_1 - ((dz2 + known[3]) + first_sb * dda);

      c(0, k + 1) = w * da;
      c(1, k + 1) = w * db;
      c(2, k + 1) = w * df;
      c(3, k + 1) = da = w * dda;
      c(4, k + 1) = db = w * ddb;
      c(5, k + 1) = df = g.regulated ? 0 : w * ddf;
      sb = w * angles[0];
      cb = -w * angles[1];
    }
  }

  [[nodiscard]] static Components<double> first(const Components<double>& u) { return u; }
  [[nodiscard]] static Components<double> first(const GuideSeries::Coefficients& u) { return u[0]; }

  [[nodiscard]] static double resistance(const CardanBearing& bearing, double q, double dq) {
    return bearing.stiffness * q + bearing.damping * dq;
  }

  template <bool round>
  [[nodiscard]] Inverse inverted(double beta, double sb, double cb, double phi) const {
    const auto& [rotor, inner, outer] = gyro_.moments;
    const double across = outer.x() + gyro_.ring.c * (sb * sb);
    const double cc = cb * cb;
    if constexpr (round) {
      const double M_aa = across + cc * gyro_.ring.a;
      if (M_aa <= gyro_.singular) stop(beta);
      return {1 / M_aa, 0, 1 / gyro_.ring.b};
    } else {
      const double s = std::sin(phi);
      const double c = std::cos(phi);
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
