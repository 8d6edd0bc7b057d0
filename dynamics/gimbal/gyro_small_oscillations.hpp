#pragma once

#include <Eigen/Core>

#include <cmath>
#include <string>
#include <utility>

#include <dynamics/gimbal/cardan_gyro.hpp>
#include <dynamics/gimbal/gimbal_oscillation.hpp>
#include <dynamics/guide/motion.hpp>
#include <dynamics/guide/resting.hpp>
#include <dynamics/model/scene.hpp>
#include <dynamics/model/terms.hpp>

namespace kreisel {

/// The part of J_f that is kept: the momentum of the rotor due to the guide's rotation.
enum class GuideMomentum {
  none,        ///< Schuler: J_f = 0
  constant,    ///< (47): the tensor of the rotor that is not inclined
  first_order  ///< and its part of first order in alpha, beta, and the drive's torque
};

/// Small oscillations alpha, beta of a rotor on a guide that turns, its axis near the guide's z.
/// The rotor has the constant speed Omega against its suspension, whose rings have no mass.
///
///   oJ + u x J + oJ_f + u x J_f = M     (its components x and y)
///
///   J_x = P alpha' + R beta' + H beta   P = A cos^2 phi + B sin^2 phi   R = (A - B) sin(2 phi)/2
///   J_y = R alpha' + Q beta' - H alpha  Q = A sin^2 phi + B cos^2 phi   H = C Omega, phi = Omega t
///   J_fx = P u_x + R u_y + u_z g_a        g_a = (C - P) beta + R alpha
///   J_fy = R u_x + Q u_y + u_z g_b        g_b = (Q - C) alpha - R beta
///   J_fz = C u_z + u_x g_a + u_y g_b
///
/// M is the moment of springs and friction and, of first order, the drive's torque M_C, which lies
/// along the inclined axis: -alpha M_C is added to M_y.
///
///   M_C = C ou_z + R (u_x^2 - u_y^2) + (Q - P) u_x u_y
///
/// Source : paper 002 (44)-(48), with the terms of g that (47) lacks. Of J_z only H is in the
///          field: its terms of second order are multiplied by u and do not change the order of the
///          error. relative_momentum() contains them, with the term that (46) lacks
/// Frame  : guide axes, reduced where the axes meet
/// Units  : rad, rad/s
/// Error  : for angles and u of the size eps, of the order eps^k, k = 3 with first_order, also if
///          u_z is not small; 2 with constant, 1 if u_z is not small; 1 with none, but 2 for a
///          symmetric rotor and constant u. With first_order the field errs by the order eps^2
///          where the angles are of the size eps and u of any
///          (tests/dynamics/gimbal/gyro_small_oscillations.cpp).
///          greatest_deviation() measures it
/// Throws : InvalidInput for what CardanGyro refuses, references of the bearings other than 0, or a
///          speed that is not finite
template <class M>
class GyroSmallOscillations : public GimbalOscillation<CardanGyro<M, RegulatedRotor>> {
  static_assert(detail::is_guide<M>,
                "the guide of a gyro must return a FrameMotion<Guide, Inertial>");

  using Base = GimbalOscillation<CardanGyro<M, RegulatedRotor>>;

 public:
  using typename Base::State;
  using typename Base::Vector;

  /// mass x'' + damping x' + stiffness x = force,  x = (alpha, beta), at one time.
  struct Coefficients {
    Eigen::Matrix2d mass, damping, stiffness;
    Eigen::Vector2d force;
  };

  /// `rotor` has the moments A, B, C; `speed` is Omega.
  GyroSmallOscillations(const Vector3<double>& rotor, const CardanBearings& bearings, double speed,
                        M guide, GuideMomentum kept = GuideMomentum::first_order)
      : Base(typename Base::Exact(CardanMoments{rotor}, bearings, guide), speed,
             "small oscillations of a gyro"),
        guide_(std::move(guide)),
        kept_(kept) {}

  [[nodiscard]] Coefficients coefficients(double t) const {
    // In single numbers, because matrix expressions take a quarter longer to compile.
    const auto [P, Q, R] = across_inclined(t);
    const auto [dP, dQ, dR] = across_rate(t);
    const auto [u, du] = turning(guide_, t);
    const auto& [about_a, about_b] = this->exact().bearings();
    const double C = this->exact().moments().rotor.z();
    const double H = C * this->speed();
    const double x = u.x();
    const double y = u.y();
    const double z = u.z();
    const double dz = du.z();
    Coefficients c;
    c.mass << P, R, R, Q;
    c.damping << dP - z * R + about_a.damping, dR + H - z * Q,  //
        dR - H + z * P, dQ + z * R + about_b.damping;
    c.stiffness << z * H + about_a.stiffness, 0, 0, z * H + about_b.stiffness;
    c.force << -H * y, H * x;
    if (kept_ == GuideMomentum::none) return c;
    c.force[0] -= dP * x + dR * y + P * du.x() + R * du.y() - z * (R * x + Q * y) + C * z * y;
    c.force[1] -= dR * x + dQ * y + R * du.x() + Q * du.y() + z * (P * x + R * y) - C * z * x;
    if (kept_ == GuideMomentum::constant) return c;
    const double drive = C * dz + R * (x * x - y * y) + (Q - P) * x * y;
    // g_a and g_b: J_f gains u_z g across z, and along z  along = u_x g_a + u_y g_b.
    const double along_a = x * R + y * (Q - C);
    const double along_b = x * (C - P) - y * R;
    c.damping(0, 0) += z * R;
    c.damping(0, 1) += z * (C - P);
    c.damping(1, 0) += z * (Q - C);
    c.damping(1, 1) -= z * R;
    c.stiffness(0, 0) += z * dR + dz * R - z * z * (Q - C) + y * along_a;
    c.stiffness(0, 1) += -z * dP + dz * (C - P) + z * z * R + y * along_b;
    c.stiffness(1, 0) += z * dQ + dz * (Q - C) + z * z * R - x * along_a + drive;
    c.stiffness(1, 1) += -z * dR - dz * R - z * z * (P - C) - x * along_b;
    return c;
  }

  /// The vector field  y' = rates(t, y)  on  y = (alpha, beta, alpha', beta').
  [[nodiscard]] Vector rates(double t, const Vector& y) const {
    const Coefficients c = coefficients(t);
    const auto torque = [&](int i) {
      return c.force[i] - c.damping(i, 0) * y[2] - c.damping(i, 1) * y[3] -
             c.stiffness(i, 0) * y[0] - c.stiffness(i, 1) * y[1];
    };
    const double first = torque(0);
    const double second = torque(1);
    const double P = c.mass(0, 0);
    const double R = c.mass(0, 1);
    const double Q = c.mass(1, 1);
    const double determinant = P * Q - R * R;
    return {y[2], y[3], (Q * first - R * second) / determinant,
            (P * second - R * first) / determinant};
  }

  /// The terms of rates(): see kreisel::terms.
  [[nodiscard]] Terms terms() const {
    const bool constant = kept_ != GuideMomentum::none;
    const bool first_order = kept_ == GuideMomentum::first_order;
    const std::string of_order = first_order ? "" : "of first order in alpha, beta";
    const std::string omitted = constant ? "" : "GuideMomentum::none";
    Terms list = Base::linear_terms();
    list.add("relative", "moments of inertia of both rings", false, "they have no mass");
    list.add("relative", "A - B, which turns with phi");
    list.add("Coriolis", "u x J");
    list.add("guide", "oJ_f + u x J_f of the rotor not inclined", constant, omitted);
    list.add("guide", "g_a, g_b in J_f", first_order, of_order);
    list.add("load", "torque of the drive, along the inclined axis", first_order, of_order);
    return list;
  }

  /// J, the rotor's momentum relative to the guide, about the point where the axes meet.
  ///
  ///   J_z = (R alpha - P beta) alpha' + (Q alpha - R beta) beta'
  ///         + C u'_C (1 - (alpha^2 + beta^2)/2)
  ///
  /// Source : paper 002 (46); the term with alpha^2 + beta^2 is missing there. Without it the third
  ///          line of (46) is no better than C u'_C alone
  /// Units  : N m s
  /// Error  : of third order across, of fourth along z; with u'_C = Omega + alpha' beta
  [[nodiscard]] Vector3<double> relative_momentum(double t, const State& s) const {
    const auto [P, Q, R] = across_inclined(t);
    const double spin = this->exact().moments().rotor.z() * (this->speed() + s.alpha_rate * s.beta);
    const double x = P * s.alpha_rate + R * s.beta_rate;
    const double y = R * s.alpha_rate + Q * s.beta_rate;
    const double squares = s.alpha * s.alpha + s.beta * s.beta;
    return {x + spin * s.beta, y - spin * s.alpha,
            s.alpha * y - s.beta * x + spin * (1 - squares / 2)};
  }

 private:
  /// The rotor's moments across its axis, in the axes of the rings.
  struct Across {
    double P, Q, R;
  };

  [[nodiscard]] Across across_inclined(double t) const {
    const auto& rotor = this->exact().moments().rotor;
    const double mean = (rotor.x() + rotor.y()) / 2;
    const double half = (rotor.x() - rotor.y()) / 2;
    const double angle = 2 * this->speed() * t;
    const double c = half * std::cos(angle);
    return {mean + c, mean - c, half * std::sin(angle)};
  }

  [[nodiscard]] Across across_rate(double t) const {
    const auto& rotor = this->exact().moments().rotor;
    const double swing = (rotor.x() - rotor.y()) * this->speed();
    const double angle = 2 * this->speed() * t;
    const double s = swing * std::sin(angle);
    return {-s, s, swing * std::cos(angle)};
  }

  M guide_;
  GuideMomentum kept_;
};

static_assert(Scene<GyroSmallOscillations<RestingFrame<>>>);

}  // namespace kreisel
