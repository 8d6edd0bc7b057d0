#pragma once

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

#include <dynamics/exact/elliptic.hpp>
#include <dynamics/exact/free_top.hpp>
#include <dynamics/exact/refuse.hpp>
#include <dynamics/exact/top_motion.hpp>
#include <motor/double_double_functions.hpp>

namespace kreisel::exact {

namespace detail {

/// A rotation since time 0 and the angular velocity, on axes of the body.
struct TurnAndRate {
  RealQuaternion turn;
  RealVector omega;
};

/// The solution of Theta omega' + omega x (Theta omega + h e_z) = 0  for moments A, A, C: omega =
/// L/A + s e_z.
class SymmetricRotation {
 public:
  SymmetricRotation(Real A, Real C, Real h, const RealVector& omega0)
      : omega0_(omega0), about_momentum_(omega0) {
    // The transverse parts of L/A and of omega are equal. s comes from a difference of moments,
    // because the difference of the rates would cancel.
    against_ = ((A - C) * omega0.z() - h) / A;
    about_momentum_.z() -= against_;
  }

  [[nodiscard]] TurnAndRate at(Real time) const {
    const Real angle = against_ * time;
    const Real s = sin(angle);
    const Real c = cos(angle);
    const Real x = omega0_.x();
    const Real y = omega0_.y();
    return {steady_turn(about_momentum_, time) * about_z(angle),
            {c * x + s * y, c * y - s * x, omega0_.z()}};
  }

  [[nodiscard]] Real period() const { return scaled(std::numbers::pi_v<Real>, 2) / abs(against_); }

 private:
  RealVector omega0_;
  Real against_;               ///< s, about the axis against the turn about L
  RealVector about_momentum_;  ///< L/A on body axes at time 0
};

}  // namespace detail

/// The symmetric gyrostat without torques: a body of moments A, A, C with a rotor on its axis of
/// symmetry at constant relative speed,
///
///   Theta omega' + omega x (Theta omega + h e_z) = 0,   Theta including the rotor.
///
/// omega = L/A + s e_z with s = omega3 - L3/A, L3 = C omega3 + h. The body turns steadily about L,
/// and relative to that steadily about its axis; in the body omega circles the axis with -s. The
/// rotor acts like a change of the axial moment, even to 0 or below, which no body has.
///
/// Source : Wangerin 1889, Volterra 1899; Wittenburg, Dynamics of Multibody Systems, sect. 4.6
/// Frame  : body z is the axis of symmetry and of the rotor; attitudes rotate body to inertial
/// Units  : kg m^2, N m s, rad/s, s
/// Error  : attitude <= 2u rad, rate <= 2u relative, and 2^-67 of the angle of rotation
///          (tests/dynamics/exact/gyrostat.cpp)
class SymmetricGyrostat {
 public:
  /// `rotor` is h, the rotor's angular momentum relative to the body.
  ///
  /// Throws : InvalidInput for moments that no body has (see FreeTop), an attitude that is 0, and
  ///          numbers that are not finite
  SymmetricGyrostat(double A, double C, double rotor, const Vector3<double>& omega0,
                    const Eigen::Quaterniond& attitude0)
      : attitude0_(detail::unit(attitude0)), rotation_(A, C, rotor, omega0.cast<Real>()) {
    detail::require_body({A, A, C});
    detail::require_finite("rotor", rotor);
    detail::require_finite(omega0);
  }

  /// Throws : InvalidInput for a time that is not finite
  [[nodiscard]] TopMotion at(double time) const {
    detail::require_finite("time", time);
    const auto [turn, omega] = rotation_.at(time);
    return {(attitude0_ * turn).cast<double>(), omega.cast<double>()};
  }

  /// 2 pi/|s|, after which omega repeats on body axes: infinite if the rotor makes the body act
  /// like one without a preferred axis.
  [[nodiscard]] double period() const { return static_cast<double>(rotation_.period()); }

 private:
  detail::RealQuaternion attitude0_;
  detail::SymmetricRotation rotation_;
};

/// The gyrostat without torques, for any body, with its rotor on a principal axis at constant
/// relative speed:
///
///   Theta omega' + omega x (Theta omega + h) = 0,   Theta including the rotor.
///
/// Axis 3 is the rotor's and A <= B. Energy and L = |Theta omega + h| make omega1 and omega2
/// functions of v = omega3(t) - omega3(0), where everything else is taken at time 0:
///
///   A (B - A) omega1^2 = F1(v) = A (B - A) omega1^2 + 2 C ((C - B) omega3 + h) v + C (C - B) v^2,
///   B (B - A) omega2^2 = F2(v) = B (B - A) omega2^2 - 2 C ((C - A) omega3 + h) v - C (C - A) v^2,
///   A B C^2 v'^2 = F1(v) F2(v).
///
/// v oscillates between two roots e0 and e1. A fractional-linear substitution fixes both, and its
/// kappa reduces the rest to an elliptic integral in Legendre's form, with u = lambda t + u0:
///
///   v = (e0 p0 + e1 p1)/D,   D = p0 + p1,   omega1 D and omega2 D  products of sn, cn, dn,
///
///   four real roots:  F1 F2 = f0 f1 l1 l2, all linear and >= 0, f0(e0) = f1(e1) = 0,
///     p0 = cn^2, p1 = kappa sn^2,   kappa = l1(e0)/l1(e1),
///     4 A B C^2 lambda^2 = |f0' f1'| l1(e1) l2(e0),   1 - m = kappa l2(e1)/l2(e0),
///   two real roots:  F1 F2 = f (v - e0)(e1 - v) S(v), S > 0 with the polar form S(v, w),
///     p0 = 1 + cn, p1 = kappa (1 - cn),   kappa^2 = S(e0)/S(e1),   g^2 = S(e0) S(e1),
///     A B C^2 lambda^2 = |f| g,   1 - m = (g + S(e0, e1))/(2 g).
///
/// The shortest rotation takes L on body axes to e_z. The rest is a precession with a single pole,
///
///   psi' = (omega . L + L omega3)/(L + L3) = (L + h)/C + (2 E - (L + h)^2/C)/(L + L3),
///
/// by one integral of the third kind. Axis 3 points to the side of the greater |L3|.
///
/// Source : Zhukovsky 1885, Volterra 1899; Wittenburg, Dynamics of Multibody Systems, sect. 4.6
/// Frame  : body axes are principal axes; attitudes rotate body components into inertial ones
/// Units  : kg m^2, N m s, rad/s, s
/// Error  : attitude <= 2u rad, rate <= 2u relative to the greatest: the rounding of the result,
///          for exact inputs, near separatrices and steady rotations (tested to 1e-15) and for
///          nearly symmetric bodies as elsewhere. In addition 2^-67 of the angle (L + |h|)
///          t/I_min (tests/dynamics/exact/gyrostat.cpp)
/// Cost   : at() 1.4 us, to construct 4.1 us (g++ 12 -O3, EPYC)
/// Limits : as with FreeTop, near a separatrix an input's own rounding decides; on the separatrix
///          the motion may return after the time in which 2^-120 grows to 1
class Gyrostat {
 public:
  /// Moments on the three body axes, in any order. `rotor` is h, the rotor's angular momentum
  /// relative to the body, on these axes. The attitude may have any norm.
  ///
  /// Throws : InvalidInput for a rotor not on one of the axes, moments that no body has (see
  ///          FreeTop), an attitude that is 0, and numbers that are not finite
  Gyrostat(const Vector3<double>& moments, const Vector3<double>& rotor,
           const Vector3<double>& omega0, const Eigen::Quaterniond& attitude0)
      : omega0_(omega0), attitude0_(detail::unit(attitude0)) {
    detail::require_body(moments);
    detail::require_finite("rotor.x", rotor.x());
    detail::require_finite("rotor.y", rotor.y());
    detail::require_finite("rotor.z", rotor.z());
    detail::require_finite(omega0);
    int axis = 0;
    rotor.cwiseAbs().maxCoeff(&axis);
    constexpr std::array names{"rotor.x", "rotor.y", "rotor.z"};
    for (int i = 0; i < 3; ++i) {
      if (i != axis && rotor[i] != 0) {
        detail::refuse(names[static_cast<std::size_t>(i)], rotor[i],
                       "must be 0: the rotor's axis must be one principal axis");
      }
    }
    if (rotor[axis] == 0) {
      free_.emplace(moments, omega0, attitude0);
      return;
    }
    axes_ = {moments, axis};
    const double moment = detail::power_of_2(moments.maxCoeff());
    unit_ =
        detail::power_of_2(std::max(omega0.cwiseAbs().maxCoeff(), std::abs(rotor[axis]) / moment));
    const Vector3<double> I = moments / moment;
    const Vector3<double> h = rotor / moment / unit_;
    const Vector3<double> rate = detail::in_unit(omega0, unit_);
    const System system = axes_.system(I, h, rate);
    if (steady(system)) return;
    if ((system.B - system.A) == 0) {
      symmetric_.emplace(system.A, system.C, system.h, system.omega());
      return;
    }
    motion_.emplace(system);
    if (motion_->beyond_equator()) {
      axes_.turn_over();
      motion_.emplace(axes_.system(I, h, rate));
    }
  }

  /// Throws : InvalidInput for a time that is not finite
  [[nodiscard]] TopMotion at(double time) const {
    detail::require_finite("time", time);
    if (free_) return free_->at(time);
    if (symmetric_) return on_body(symmetric_->at(time * unit_));
    if (motion_) return on_body(motion_->at(time * unit_));
    const auto turn = detail::steady_turn(omega0_.cast<Real>(), time);
    return {(attitude0_ * turn).cast<double>(), omega0_};
  }

  /// The time after which omega repeats on body axes: infinite on a separatrix, 0 for a steady
  /// rotation.
  [[nodiscard]] double period() const {
    if (free_) return free_->period();
    if (symmetric_) return static_cast<double>(symmetric_->period()) / unit_;
    return motion_ ? static_cast<double>(motion_->period()) / unit_ : 0.0;
  }

 private:
  /// Body, rotor and rates on the axes 1, 2, 3.
  struct System {
    Real A, B, C;
    Real h;
    Real w1, w2, w3;

    [[nodiscard]] detail::RealVector omega() const { return {w1, w2, w3}; }

    /// (C - B) omega3 + h, the factor of omega2 in -A omega1', and (C - A) omega3 + h, the factor
    /// of omega1 in B omega2'.
    [[nodiscard]] Real k1() const { return (C - B) * w3 + h; }
    [[nodiscard]] Real k2() const { return (C - A) * w3 + h; }
  };

  [[nodiscard]] static bool steady(const System& s) {
    const auto none = [](const Real& a, const Real& b) { return a == 0 || b == 0; };
    return none(s.w1, s.k2()) && none(s.w2, s.k1()) && (none(s.w1, s.w2) || (s.B - s.A) == 0);
  }

  /// The body axes in the order 1, 2, 3.
  class Axes {
   public:
    Axes() = default;
    Axes(const Vector3<double>& moments, int rotor)
        : body_{(rotor + 1) % 3, (rotor + 2) % 3, rotor} {
      if (moments[body_[0]] > moments[body_[1]]) {
        std::swap(body_[0], body_[1]);
        sign_[1] = -1;
      }
    }

    /// Rotates the axes by half a turn about axis 1.
    void turn_over() {
      sign_[1] = -sign_[1];
      sign_[2] = -sign_[2];
    }

    [[nodiscard]] System system(const Vector3<double>& moments, const Vector3<double>& rotor,
                                const Vector3<double>& omega) const {
      const auto signed_at = [&](const Vector3<double>& v, std::size_t i) {
        return sign_[i] * v[body_[i]];
      };
      return {.A = moments[body_[0]],
              .B = moments[body_[1]],
              .C = moments[body_[2]],
              .h = signed_at(rotor, 2),
              .w1 = signed_at(omega, 0),
              .w2 = signed_at(omega, 1),
              .w3 = signed_at(omega, 2)};
    }

    [[nodiscard]] detail::RealVector to_body(const detail::RealVector& v) const {
      detail::RealVector body;
      for (std::size_t i = 0; i < 3; ++i) body[body_[i]] = sign_[i] * v[static_cast<int>(i)];
      return body;
    }

   private:
    std::array<int, 3> body_{0, 1, 2};
    std::array<int, 3> sign_{1, 1, 1};
  };

  /// value + slope v, not negative at v = 0.
  struct Linear {
    Real value, slope;

    [[nodiscard]] Real operator()(const Real& v) const { return (value + slope * v); }
    [[nodiscard]] Real zero() const { return -value / slope; }
  };

  /// a v^2 + 2 b v + c,  c >= 0.
  struct Quadratic {
    Real a, b, c;

    [[nodiscard]] Real discriminant() const { return b * b - a * c; }

    [[nodiscard]] Real polar(const Real& v, const Real& w) const {
      return (c + b * (v + w) + a * v * w);
    }

    [[nodiscard]] std::array<Linear, 2> factors() const {
      const Real s = sqrt(discriminant());
      const Real t = b < 0 ? b - s : b + s;
      return {Linear{c, t}, Linear{1, t == 0 ? Real(0) : a / t}};
    }
  };

  /// The factors with the zeros nearest to v = 0, below and above.
  template <std::size_t n>
  [[nodiscard]] static std::array<std::size_t, 2> around(const std::array<Linear, n>& f) {
    std::array<std::size_t, 2> found{n, n};
    for (std::size_t i = 0; i < n; ++i) {
      if (f[i].slope == 0) continue;
      auto& next = found[f[i].slope < 0];
      // For slopes s > 0 the zero nearest to 0 is the greatest, for s < 0 the least.
      if (next == n || (f[i].zero() - f[next].zero()) * f[i].slope > 0) next = i;
    }
    return found;
  }

  /// A motion in which L moves against the body.
  class Motion {
   public:
    explicit Motion(const System& s) : moment1_(s.A), moment2_(s.B), spin_(s.w3) {
      const Quadratic f1{s.C * (s.C - s.B), s.C * s.k1(), s.A * (s.B - s.A) * s.w1 * s.w1};
      const Quadratic f2{-(s.C * (s.C - s.A)), -(s.C * s.k2()), s.B * (s.B - s.A) * s.w2 * s.w2};
      const Real scale = moment1_ * moment2_ * s.C * s.C;
      if (f1.discriminant() < 0) {
        between_complex(f1, f2, 0, scale);
      } else if (f2.discriminant() < 0) {
        between_complex(f2, f1, 1, scale);
      } else {
        between_real(f1, f2, scale);
      }
      const Real b_a = (s.B - s.A);
      amplitude_[0] /= sqrt(moment1_ * b_a);
      amplitude_[1] /= sqrt(moment2_ * b_a);
      start_at(s.w1, s.w2);

      const Real l1 = s.A * s.w1;
      const Real l2 = s.B * s.w2;
      const Real l3 = s.C * s.w3 + s.h;
      const Real L = sqrt(l1 * l1 + l2 * l2 + l3 * l3);
      equator_ = (l3 + l3 + s.C * (e0_ + e1_));
      g0_ = (L + l3 + s.C * e0_);
      g1_ = (L + l3 + s.C * e1_);
      steady_precession_ = (L + s.h) / s.C;
      const Real excess =
          s.C * (l1 * s.w1 + l2 * s.w2) - (L + l3) * (L + s.h + s.h - l3);  // 2 E C - (L + h)^2
      unsteady_precession_ = excess / (s.C * lambda_);
      const Real M = g0_ + kappa_ * g1_;
      pole_ = complex_ ? M * M / (4 * kappa_ * g0_ * g1_) : kappa_ * g1_ / g0_;
      third_kind_ = {functions_, pole_};
      start_ = state(0).turn.conjugate();
    }

    /// True if L3 reaches farther to the negative side.
    [[nodiscard]] bool beyond_equator() const { return equator_ < 0; }

    [[nodiscard]] detail::TurnAndRate at(Real time) const {
      const auto [attitude, omega] = state(time);
      return {start_ * attitude, omega};
    }

    [[nodiscard]] Real period() const {
      // sn cn on one axis, dn on the other: they repeat after 2 K.
      const bool half = std::any_of(factors_.begin(), factors_.end(), [](const auto& f) {
        return f == std::array{sine, cosine};
      });
      return scaled(functions_.quarter(), half ? 2 : 4) / lambda_;
    }

   private:
    /// The factors of F1 or F2 as Jacobi functions, without 1/D.
    enum Factor : std::size_t { sine, cosine, one, delta };

    void between_real(const Quadratic& f1, const Quadratic& f2, Real scale) {
      const auto [a, b] = f1.factors();
      const auto [c, d] = f2.factors();
      const std::array f{a, b, c, d};
      auto [i0, i1] = around(f);
      std::size_t j1 = 0;
      while (j1 == i0 || j1 == i1) ++j1;
      std::size_t j2 = 6 - i0 - i1 - j1;
      e0_ = f[i0].zero();
      e1_ = f[i1].zero();
      if (f[j1](e0_) * f[j2](e1_) > f[j1](e1_) * f[j2](e0_)) std::swap(j1, j2);
      // The same from the other end: the end next to a separatrix must be e1.
      if (f[j1](e0_) * f[j2](e0_) < f[j1](e1_) * f[j2](e1_)) {
        std::swap(i0, i1);
        std::swap(j1, j2);
        std::swap(e0_, e1_);
      }
      kappa_ = f[j1](e0_) / f[j1](e1_);
      const Real m1 = kappa_ * f[j2](e1_) / f[j2](e0_);
      functions_ = {1 - m1, m1};
      lambda_ = sqrt(abs(f[i0].slope * f[i1].slope) * f[j1](e1_) * f[j2](e0_) / scale) / 2;
      const Real way = abs((e1_ - e0_));
      std::array<Real, 4> strength{};
      std::array<Factor, 4> is{};
      const auto set = [&](std::size_t i, Factor factor, Real value) {
        is[i] = factor;
        strength[i] = value;
      };
      set(i0, sine, kappa_ * way * abs(f[i0].slope));
      set(i1, cosine, way * abs(f[i1].slope));
      set(j1, one, f[j1](e0_));
      set(j2, delta, f[j2](e0_));
      for (std::size_t i = 0; i < 2; ++i) {
        factors_[i] = {std::min(is[2 * i], is[2 * i + 1]), std::max(is[2 * i], is[2 * i + 1])};
        amplitude_[i] = sqrt(strength[2 * i] * strength[2 * i + 1]);
      }
    }

    /// S has no real roots; f has e0 and e1.
    void between_complex(const Quadratic& S, const Quadratic& f, std::size_t of_s, Real scale) {
      complex_ = true;
      const auto ends = f.factors();
      const auto [i0, i1] = around(ends);
      e0_ = ends[i0].zero();
      e1_ = ends[i1].zero();
      const Real way = abs((e1_ - e0_));
      const Real s0 = S.polar(e0_, e0_);
      const Real s1 = S.polar(e1_, e1_);
      const Real s01 = S.polar(e0_, e1_);
      const Real g = sqrt(s0 * s1);
      const Real product = -S.discriminant() * way * way;  // g^2 - s01^2
      const Real plus = s01 < 0 ? product / (g - s01) : g + s01;
      const Real minus = s01 < 0 ? g - s01 : product / (g + s01);
      functions_ = {minus / (2 * g), plus / (2 * g)};
      kappa_ = sqrt(s0 / s1);
      lambda_ = sqrt(abs(f.a) * g / scale);
      factors_[of_s] = {one, delta};
      amplitude_[of_s] = 2 * sqrt(kappa_ * g);
      factors_[1 - of_s] = {sine, one};
      amplitude_[1 - of_s] = way * sqrt(abs(f.a) * kappa_);
    }

    /// u0 and the signs of the amplitudes. For u from 0 to K, v goes from e0 towards e1, and
    /// C v' = (A - B) omega1 omega2.
    void start_at(Real w1, Real w2) {
      const std::array w{w1, w2};
      const std::size_t odd = factors_[0][0] == sine ? 0 : 1;
      const std::size_t even = 1 - odd;
      const Real way = (e1_ - e0_);
      if (w[even] < 0) amplitude_[even] = -amplitude_[even];
      if ((way > 0) == (amplitude_[even] > 0)) amplitude_[odd] = -amplitude_[odd];
      const Real side = (w[odd] < 0) == (amplitude_[odd] < 0) ? 1 : -1;

      const Real from_0 = abs(e0_);
      const Real from_1 = kappa_ * abs(e1_);
      const Real sum = from_0 + from_1;
      const Real m = functions_.m();
      const Real m1 = functions_.m1();
      if (complex_) {
        const Real sn = side * 2 * sqrt(from_0 * from_1) / sum;
        const Real cn = (from_1 - from_0) / sum;
        const Real dn = sqrt(m1 + m * cn * cn);
        const Real u = EllipticFunctions::argument({sn, abs(cn), dn});
        u0_ = cn < 0 ? side * 2 * functions_.quarter() - u : u;
      } else {
        const Real s2 = from_0 / sum;
        const Real c2 = from_1 / sum;
        u0_ = EllipticFunctions::argument({side * sqrt(s2), sqrt(c2), sqrt(c2 + m1 * s2)});
      }
    }

    /// int du / (L + L3).
    [[nodiscard]] Real inverse_height(const Phase& phase) const {
      const Real J = third_kind_(phase);
      if (!complex_) return (phase.u - kappa_ * (g1_ - g0_) / g0_ * J) / g0_;
      const Real M = g0_ + kappa_ * g1_;
      const Real alpha = (g0_ - kappa_ * g1_) / M;
      const Real root = sqrt(functions_.m() + pole_ * alpha * alpha);
      const Real x = phase.at.sn / phase.at.dn;
      const Real elementary = root == 0 ? x : atan(root * x) / root;
      // int cn / (1 + alpha cn) du
      const Real Y = pole_ * (elementary - alpha * (phase.u - pole_ * J));
      return ((1 + kappa_) * phase.u + 2 * kappa_ * (g1_ - g0_) / M * Y) / M;
    }

    /// The state on the axes 1, 2, 3; the attitude refers to non-rotating axes whose z is along L.
    [[nodiscard]] detail::TurnAndRate state(Real time) const {
      const Phase phase = functions_.phase(lambda_ * time + u0_);
      const auto [sn, cn, dn] = phase.at;
      const Real p0 = complex_ ? 1 + cn : cn * cn;
      const Real p1 = kappa_ * (complex_ ? 1 - cn : sn * sn);
      const Real D = p0 + p1;
      const std::array values{sn, cn, Real(1), dn};
      const auto rate = [&](std::size_t i) {
        return amplitude_[i] * values[factors_[i][0]] * values[factors_[i][1]] / D;
      };
      const detail::RealVector omega(rate(0), rate(1), spin_ + (e0_ * p0 + e1_ * p1) / D);
      const Real height = (g0_ * p0 + g1_ * p1) / D;
      const Real precession =
          steady_precession_ * time + unsteady_precession_ * inverse_height(phase);
      const auto [s, c] = kreisel::detail::sine_cosine(scaled(precession, 0.5));
      return {detail::to_z_and_about_z(height, moment1_ * omega.x(), moment2_ * omega.y(), c, s),
              omega};
    }

    Real moment1_, moment2_;
    Real spin_;  ///< omega3 at time 0
    bool complex_ = false;
    Real e0_ = 0, e1_ = 0;
    Real kappa_;
    EllipticFunctions functions_;
    Real lambda_;
    Real u0_;
    std::array<std::array<Factor, 2>, 2> factors_;  ///< of omega1 D and omega2 D, in order
    std::array<Real, 2> amplitude_;
    Real equator_;  ///< the sum of L3 at both ends
    Real g0_, g1_;  ///< L + L3 at both ends
    Real steady_precession_;
    Real unsteady_precession_;
    Real pole_;  ///< 1 + nu
    ThirdKind third_kind_{functions_, 1};
    detail::RealQuaternion start_;  ///< the inverse of the attitude at time 0
  };

  [[nodiscard]] TopMotion on_body(const detail::TurnAndRate& m) const {
    const detail::RealVector v = axes_.to_body(m.turn.vec());
    const detail::RealQuaternion turn(m.turn.w(), v.x(), v.y(), v.z());
    return {(attitude0_ * turn).cast<double>(), axes_.to_body(m.omega).cast<double>() * unit_};
  }

  Vector3<double> omega0_;
  detail::RealQuaternion attitude0_;
  Axes axes_;
  double unit_ = 1;                                     ///< of rates in both motions
  std::optional<FreeTop> free_;                         ///< with the rotor at rest
  std::optional<detail::SymmetricRotation> symmetric_;  ///< for A = B
  std::optional<Motion> motion_;                        ///< none of the three: a steady rotation
};

}  // namespace kreisel::exact
