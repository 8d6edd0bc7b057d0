#pragma once

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <optional>

#include <dynamics/exact/elliptic.hpp>
#include <dynamics/exact/free_top.hpp>
#include <dynamics/exact/refuse.hpp>
#include <dynamics/exact/top_motion.hpp>
#include <motor/complex.hpp>
#include <motor/double_double_functions.hpp>

namespace kreisel::exact {

/// The heavy symmetric top with a fixed point and its weight on the axis of symmetry.
///
/// Let q = (w; x, y, z) be the attitude. The Cayley-Klein parameters  alpha = w + i z  and beta = x
/// + i y  give the tilt theta of the axis by  r = |beta|^2 = sin^2(theta/2)  and p = |alpha|^2 =
/// cos^2(theta/2).  By energy and both angular momenta
///
///   r'^2 = kappa (r - r3)(r - r1)(r2 - r),   kappa = 4 mgl/A,   r3 <= 0 <= r1 <= r2 <= 1,
///   r = r2 - (r2 - r1) sn^2 u,   u = lambda t + u0,   4 lambda^2 = kappa (r2 - r3),
///   m = (r2 - r1)/(r2 - r3),     1 - m = (r1 - r3)/(r2 - r3).
///
/// The phases of alpha and beta are integrals of the third kind. Their poles are at p = 0 and r =
/// 0. An exchange of parameter splits off the part of each that jumps there. Combined with |alpha|
/// and |beta|, this part is a factor with a plain zero, so the attitude is as accurate at the
/// vertical as elsewhere. With p_k = 1 - r_k:
///
///   alpha = (sqrt(p2) cn dn +- i sqrt(p1 p3/(r2 - r3)) sn) / sqrt(Q) exp(i psi),
///   Q = 1 + p2/(r2 - r3) sn^2,
///   beta  = sqrt(r2) (cn -+ i W sn dn) / sqrt(Q) exp(i psi),   W^2 = r1/(-r3) (r2 - r3)/r2,
///   Q = 1 + (r1 - r1 r2/r3)/(r2 - r3) sn^2,
///
/// Both psi have no other poles within reach. For r1 > -r3, when the top stays away from the upper
/// vertical, beta needs no exchange.
///
/// Source : Lagrange 1788; Klein and Sommerfeld, Theorie des Kreisels, ch. IV and VI; Jacobi's
///          exchange of parameter as the relation between R_J of p and of q, DLMF 19.21.12
/// Frame  : body z is the axis of symmetry, gravity acts along -z of the inertial frame
/// Units  : kg m^2, N m, rad/s, s
/// Error  : attitude <= 2u rad, rate <= 2u of the greatest: the rounding of the result, for exact
///          inputs, at cusps, through and within 1e-12 of the vertical, in small nutations and near
///          the motion that ends upright. In addition 2^-67 of the angle of rotation in the
///          time and 2^-64 of starting_angle() (tests/dynamics/exact/lagrange_top.cpp)
/// Cost   : at() 2.6 us, to construct 8 us (g++ 12 -O3, EPYC)
/// Limits : as with FreeTop, next to the motion that ends upright an input's own rounding decides;
///          a weight below 1e-80 of the rotation's moment counts as 0
class LagrangeTop {
 public:
  /// Moments about the fixed point, A across and C along the axis of symmetry. The centre of mass
  /// lies at +l on body z, weight_moment = m g l.
  ///
  /// Throws : InvalidInput for moments that no body has (see FreeTop), a weight moment below 0
  ///          (reverse the body axes instead), an attitude that is 0, and numbers that are not
  ///          finite
  LagrangeTop(double A, double C, double weight_moment, const Vector3<double>& omega0,
              const Eigen::Quaterniond& attitude0)
      : omega0_(omega0), attitude0_(detail::unit(attitude0)) {
    detail::require_body({A, A, C});
    detail::require_finite(omega0);
    if (!(weight_moment >= 0 && std::isfinite(weight_moment))) {
      detail::refuse("weight_moment", weight_moment, "N m must be a finite number, 0 or above");
    }
    const bool vertical =
        (attitude0.x() == 0 && attitude0.y() == 0) || (attitude0.w() == 0 && attitude0.z() == 0);
    const bool sleeping = vertical && omega0.x() == 0 && omega0.y() == 0;
    const double moment = detail::power_of_2(A);
    unit_ =
        detail::power_of_2(std::max(omega0.cwiseAbs().maxCoeff(), std::sqrt(weight_moment / A)));
    // Its effect after n radians is n^2 times this at most.
    constexpr double no_weight = 1e-80;
    if (weight_moment / moment / unit_ / unit_ <= no_weight || weight_moment == 0) {
      free_.emplace(Vector3<double>(A, A, C), omega0, attitude0);
    } else if (!sleeping) {
      nutation_.emplace(A / moment, C / moment, weight_moment / moment / unit_ / unit_,
                        detail::in_unit(omega0, unit_), attitude0);
    }
  }

  /// Throws : InvalidInput for a time that is not finite
  [[nodiscard]] TopMotion at(double time) const {
    detail::require_finite("time", time);
    if (free_) return free_->at(time);
    if (nutation_) {
      TopMotion motion = nutation_->at(time * unit_);
      motion.angular_velocity *= unit_;
      return motion;
    }
    const auto turn = detail::steady_turn(omega0_.cast<Real>(), time);
    return {(attitude0_ * turn).cast<double>(), omega0_};
  }

  /// 2 K/lambda, after which the tilt repeats: infinite for a motion that ends upright. 0 for a top
  /// that spins about the vertical and for one without weight, which do not nutate.
  [[nodiscard]] double period() const {
    return nutation_ ? static_cast<double>(nutation_->period()) / unit_ : 0.0;
  }

  /// 2 (|psi_alpha(0)| + sqrt(r2) |psi_beta(0)|), in rad, with the psi counted from the greatest
  /// tilt. It is subtracted at every time, because the motion begins within a nutation; the
  /// rounding error is 2^-64 of it (tests/dynamics/exact/lagrange_top). It is above 1e4 rad for
  /// tops that hardly nutate.
  [[nodiscard]] double starting_angle() const {
    return nutation_ ? static_cast<double>(nutation_->starting_angle()) : 0.0;
  }

 private:
  using Complex = ComplexOf<Real>;

  /// A Cayley-Klein parameter and its rate of change.
  struct Parameter {
    Complex value;
    Complex rate;

    friend Parameter operator*(const Complex& factor, const Parameter& p) {
      return {factor * p.value, factor * p.rate};
    }
  };

  /// N / sqrt(Q) exp(i psi) and its rate of change, from its parts and their rates.
  [[nodiscard]] static Parameter assembled(Complex N, Complex dN, Real Q, Real dQ, Real psi,
                                           Real d_psi) {
    const auto [sine, cosine] = kreisel::detail::sine_cosine(psi);
    const Complex factor = Complex(cosine, sine) / sqrt(Q);
    return {factor * N, factor * (dN - N * (dQ / (2 * Q)) + Complex(0, d_psi) * N)};
  }

  /// r1, r2, r3 of the tilt, p_k = 1 - r_k, and the position of r0 between them. Every difference
  /// has its own digits, because small differences decide near the vertical and in a nutation of
  /// small amplitude.
  struct TurningPoints {
    Real r1, r2, minus_r3;
    Real p1, p2, p3;
    Real r2_r1, r1_r3, r2_r3;
    Real r2_r0, r0_r1, r0_r3;
  };

  /// The cubic  r'^2 = F(r)  and the point r0 on it.
  struct Cubic {
    Real kappa;
    Real r0, p0;
    Real square_at_r0;     ///< F(r0) = r0'^2
    Real slope_at_r0;      ///< F'(r0)
    Real curvature_at_r0;  ///< F''(r0)/2
    Real at_0;             ///< -F(0)
    Real slope_at_0;       ///< F'(0)
    Real at_1;             ///< -F(1)

    [[nodiscard]] TurningPoints turning_points() const {
      const Real middle = curvature_at_r0 / (3 * kappa);
      const Real spread = sqrt(std::max<Real>(0, middle * middle + slope_at_r0 / (3 * kappa)));
      TurningPoints t{};
      // The mean of the roots lies on the side of the two closer roots.
      if (value(middle) < 0) {
        t.r0_r3 = -outer_root(middle - 2 * spread);
        const Real product = square_at_r0 / (kappa * t.r0_r3);
        const Real difference = (product - slope_at_r0 / kappa) / t.r0_r3;
        split(difference, product, t.r0_r1, t.r2_r0);
        t.r2 = r0 + t.r2_r0;
        t.r1 = r0 - t.r0_r1;
        t.minus_r3 = t.r0_r3 - r0;
        // Their product is known best, so the smaller root follows from it.
        if (t.r1 < t.minus_r3) {
          t.r1 = at_0 / (kappa * t.r2 * t.minus_r3);
        } else {
          t.minus_r3 = at_0 / (kappa * t.r2 * t.r1);
        }
        t.r1_r3 = t.r0_r3 - t.r0_r1;
      } else {
        t.r2_r0 = outer_root(middle + 2 * spread);
        t.r2 = r0 + t.r2_r0;
        const Real product = at_0 / (kappa * t.r2);
        split((slope_at_0 / kappa - product) / t.r2, product, t.minus_r3, t.r1);
        t.r1_r3 = t.r1 + t.minus_r3;
        t.r0_r3 = r0 + t.minus_r3;
        t.r0_r1 = r0 - t.r1;
        if (t.r2_r0 > t.r0_r1) t.r0_r1 = square_at_r0 / (kappa * t.r0_r3 * t.r2_r0);
      }
      t.r2_r1 = t.r2_r0 + t.r0_r1;
      t.r2_r3 = t.r2_r0 + t.r0_r3;
      t.p1 = p0 + t.r0_r1;
      t.p3 = p0 + t.r0_r3;
      t.p2 = at_1 / (kappa * t.p1 * t.p3);
      return t;
    }

   private:
    /// F(r0 + x).
    [[nodiscard]] Real value(Real x) const {
      return square_at_r0 + x * (slope_at_r0 + x * (curvature_at_r0 - x * kappa));
    }

    /// The outermost root r - r0 by Newton's method, which converges from one side when started
    /// beyond it.
    [[nodiscard]] Real outer_root(Real x) const {
      while (true) {
        const Real slope = slope_at_r0 + x * (2 * curvature_at_r0 - 3 * x * kappa);
        const Real next = x - value(x) / slope;
        // Only rounding can reverse the direction.
        if (!(abs(next) < abs(x))) return x;
        x = next;
      }
    }

    /// a, b >= 0 of a - b and a b.
    static void split(Real difference, Real product, Real& a, Real& b) {
      const Real sum = sqrt(difference * difference + 4 * product);
      if (difference > 0) {
        a = (sum + difference) / 2;
        b = product / a;
      } else {
        b = (sum - difference) / 2;
        a = b == 0 ? 0 : product / b;
      }
    }
  };

  /// Numbers that may be small differences of large ones, and then decide; each has its own digits.
  struct Exact {
    Real minus;  ///< (L3 - L_vertical)/2A
    Real plus;   ///< (L3 + L_vertical)/2A
    Real slope;  ///< F'(0) = v^2 - kappa r0 + 2 L3/A minus,  v^2 = omega1^2 + omega2^2

    Exact(Real A, Real C, Real weight_moment, const Vector3<double>& omega,
          const Eigen::Quaterniond& q) {
      const Real w = q.w();
      const Real x = q.x();
      const Real y = q.y();
      const Real z = q.z();
      const Real w1 = omega.x();
      const Real w2 = omega.y();
      const Real tilted = x * x + y * y;
      const Real straight = w * w + z * z;
      const Real norm2 = tilted + straight;
      const Real axial = C * omega.z();
      const Real across = A * (w1 * (x * z - w * y) + w2 * (y * z + w * x));
      const Real above = A * norm2 * (w1 * w1 + w2 * w2) - 4 * weight_moment * tilted;
      const Real A_norm2 = (A * norm2);
      minus = (axial * tilted - across) / A_norm2;
      plus = (axial * straight + across) / A_norm2;
      slope = (A * above + 2 * axial * (axial * tilted - across)) / (A * A_norm2);
    }
  };

  class Nutation {
   public:
    Nutation(double A, double C, double weight_moment, const Vector3<double>& omega,
             const Eigen::Quaterniond& attitude0)
        : spin_(omega.z()) {
      const detail::RealQuaternion q = detail::unit(attitude0);
      const Complex alpha(q.w(), q.z());
      const Complex beta(q.x(), q.y());
      const Complex across(omega.x(), omega.y());
      // (gamma1 + i gamma2) of the vertical on body axes; with omega it gives the rate of the tilt.
      const Complex vertical = Complex(0, 2) * conj(alpha) * beta;
      const Complex moving = across * conj(vertical);
      const Exact exact(A, C, weight_moment, omega, attitude0);
      const Real l = C * spin_ / A;
      const Real r0 = norm(beta);
      const Real p0 = norm(alpha);
      const Real v2 = norm(across);
      const Real kappa = 4 * Real(weight_moment) / A;
      const Cubic cubic{.kappa = kappa,
                        .r0 = r0,
                        .p0 = p0,
                        .square_at_r0 = moving.imag() * moving.imag() / 4,
                        .slope_at_r0 = (p0 - r0) * v2 + kappa * r0 * p0 - l * moving.real(),
                        .curvature_at_r0 = kappa * (p0 - r0) - v2 - l * l,
                        .at_0 = exact.minus * exact.minus,
                        .slope_at_0 = exact.slope,
                        .at_1 = exact.plus * exact.plus};
      t_ = cubic.turning_points();
      const TurningPoints& t = t_;
      functions_ = {t.r2_r1 / t.r2_r3, t.r1_r3 / t.r2_r3};
      lambda_ = sqrt(kappa * t.r2_r3) / 2;
      half_excess_ = (Real(A) - Real(C)) / A * spin_ / 2;
      if (t.r2_r1 > 0) {
        u0_ = EllipticFunctions::argument({copysign(sqrt(t.r2_r0 / t.r2_r1), moving.imag()),
                                           sqrt(t.r0_r1 / t.r2_r1), sqrt(t.r0_r3 / t.r2_r3)});
      }

      plus_ = exact.plus < 0 ? -1 : 1;
      minus_ = exact.minus < 0 ? -1 : 1;
      of_alpha_ = {functions_, 1 + t.p2 / t.r2_r3};
      jumps_ = t.r1 <= t.minus_r3;
      ratio_ = t.r1 == 0 ? 0 : t.r1 / t.minus_r3;
      alpha_slope_ = plus_ * sqrt(t.p1 * t.p3 / t.r2_r3) * sqrt(t.p2) / t.r2_r3;
      if (jumps_) {
        const Real W = -minus_ * sqrt(ratio_ * t.r2_r3 / t.r2);
        beta_slope_ = -W * t.r2 / t.r2_r3;
        beta_swing_ = W * (1 + ratio_) * t.r2 / t.r2_r3;
      } else {
        beta_slope_ = -minus_ * sqrt(t.r1 * t.minus_r3 / (t.r2 * t.r2_r3));
        beta_swing_ = beta_slope_ * t.r2_r1 / t.r2;
      }
      of_beta_ = {functions_, jumps_ ? 1 + (t.r1 + ratio_ * t.r2) / t.r2_r3 : t.r1 / t.r2};

      const Phase phase = functions_.phase(u0_);
      const Parameter a = alpha_shape(phase, 0);
      const Parameter b = beta_shape(phase, 0);
      const Complex d_alpha = (Complex(0, spin_) * alpha - beta * conj(across)) / Real(2);
      const Complex d_beta = (alpha * across - Complex(0, spin_) * beta) / Real(2);
      alpha_turn_ = turn(a, {alpha, d_alpha});
      beta_turn_ = turn(b, {beta, d_beta});
    }

    [[nodiscard]] TopMotion at(Real time) const {
      const Phase phase = functions_.phase(lambda_ * time + u0_);
      const Parameter alpha = alpha_turn_ * alpha_shape(phase, time);
      const Parameter beta = beta_turn_ * beta_shape(phase, time);
      const detail::RealQuaternion q(alpha.value.real(), beta.value.real(), beta.value.imag(),
                                     alpha.value.imag());
      // Both formulas are equivalent; each is divided by the larger parameter.
      const Complex half_spin(0, spin_ / 2);
      const Complex across =
          norm(alpha.value) > norm(beta.value)
              ? Real(2) * (beta.rate + half_spin * beta.value) / alpha.value
              : Real(-2) * conj((alpha.rate - half_spin * alpha.value) / beta.value);
      const detail::RealVector omega(across.real(), across.imag(), spin_);
      return {q.normalized().cast<double>(), omega.cast<double>()};
    }

    [[nodiscard]] Real period() const { return scaled(functions_.quarter(), 2) / lambda_; }

    [[nodiscard]] Real starting_angle() const {
      const Phase start = functions_.phase(u0_);
      return 2 * (abs(alpha_angle(start, 0)) + sqrt(t_.r2) * abs(beta_angle(start, 0)));
    }

   private:
    /// The constant phase between a parameter and its shape, from value and rate: one of them may
    /// be 0.
    [[nodiscard]] Complex turn(const Parameter& shape, const Parameter& is) const {
      const Complex c =
          is.value * conj(shape.value) + is.rate * conj(shape.rate) / (lambda_ * lambda_);
      return c / abs(c);
    }

    [[nodiscard]] Real alpha_angle(const Phase& phase, Real time) const {
      return half_excess_ * time + alpha_slope_ * of_alpha_(phase);
    }

    [[nodiscard]] Real beta_angle(const Phase& phase, Real time) const {
      return -half_excess_ * time + beta_slope_ * phase.u + beta_swing_ * of_beta_(phase);
    }

    [[nodiscard]] Parameter alpha_shape(const Phase& phase, Real time) const {
      const auto [s, c, d] = phase.at;
      const Real m = functions_.m();
      const Real root = sqrt(t_.p2);
      const Real g = plus_ * sqrt(t_.p1 * t_.p3 / t_.r2_r3);
      const Real eps = t_.p2 / t_.r2_r3;
      const Real Q = 1 + eps * s * s;
      return assembled({root * c * d, g * s},
                       lambda_ * Complex(-root * s * (d * d + m * c * c), g * c * d), Q,
                       2 * lambda_ * eps * s * c * d, alpha_angle(phase, time),
                       half_excess_ + lambda_ * alpha_slope_ * s * s / Q);
    }

    /// The shape of beta. Its zero, at the upper vertical, is split off if r1 <= -r3; else no zero
    /// is within reach.
    [[nodiscard]] Parameter beta_shape(const Phase& phase, Real time) const {
      const auto [s, c, d] = phase.at;
      const Real m = functions_.m();
      const Real root = sqrt(t_.r2);
      if (!jumps_) {
        const Real nu = -t_.r2_r1 / t_.r2;
        const Real Q = c * c + t_.r1 / t_.r2 * s * s;
        const Real dQ = 2 * lambda_ * nu * s * c * d;
        return assembled(root * Q, root * dQ, Q, dQ, beta_angle(phase, time),
                         -half_excess_ + lambda_ * beta_slope_ / Q);
      }
      const Real W = -minus_ * sqrt(ratio_ * t_.r2_r3 / t_.r2);
      const Real eps = (t_.r1 + ratio_ * t_.r2) / t_.r2_r3;
      const Real Q = 1 + eps * s * s;
      return assembled({root * c, root * W * s * d},
                       lambda_ * root * Complex(-s * d, W * c * (d * d - m * s * s)), Q,
                       2 * lambda_ * eps * s * c * d, beta_angle(phase, time),
                       -half_excess_ + lambda_ * (beta_slope_ + beta_swing_ * s * s / Q));
    }

    Real spin_;  ///< omega3
    TurningPoints t_;
    EllipticFunctions functions_;
    Real lambda_;
    Real half_excess_;  ///< (1 - C/A) omega3 / 2
    Real u0_ = 0;
    int plus_;          ///< the sign of L3 + L_vertical
    int minus_;         ///< the sign of L3 - L_vertical
    bool jumps_;        ///< r1 <= -r3
    Real ratio_;        ///< r1/(-r3)
    Real alpha_slope_;  ///< factor of the integral in the angle of alpha
    Real beta_slope_;   ///< factor of u in the angle of beta
    Real beta_swing_;   ///< factor of the integral in the angle of beta
    ThirdKind of_alpha_{functions_, 1};
    ThirdKind of_beta_{functions_, 1};
    Complex alpha_turn_;
    Complex beta_turn_;
  };

  Vector3<double> omega0_;
  detail::RealQuaternion attitude0_;
  double unit_ = 1;                   ///< of rates in the nutation
  std::optional<FreeTop> free_;       ///< without weight
  std::optional<Nutation> nutation_;  ///< none for a top that spins about the vertical
};

}  // namespace kreisel::exact
