#pragma once

#include <Eigen/Core>
#include <Eigen/LU>

#include <cmath>
#include <numbers>
#include <utility>

#include <dynamics/gimbal/gimbal_oscillation.hpp>
#include <dynamics/gimbal/pendulous_gyro.hpp>
#include <dynamics/guide/resting.hpp>
#include <dynamics/model/scene.hpp>
#include <dynamics/model/terms.hpp>

namespace kreisel {

/// Small oscillations alpha, beta of a gyro in two rings, exact to first order on any guide.
/// Centres of mass may be off the axes, the rotor unbalanced, the rings heavy. The rotor has the
/// constant speed Omega; its phi is Omega t.
///
/// A body with the tensor Theta and the first moment s, at zero angles on guide axes, turned by the
/// small vector a, takes the torque
///
///   K = Theta a'' + (oTheta + Theta [u] - [Theta n] + [u] Theta) a'
///     + (oTheta [u] + Theta [ou] - [Theta n][u] + [u] Theta [u] - [s][g']) a
///     + oTheta n + Theta ou + u x Theta n - s x g',
///
///   n = u + Omega e_z for the rotor, u for a ring;  [x] y = x x y;  oTheta as Theta turns with phi
///
/// on its own axes. a = (alpha, beta, 0), of the outer ring (alpha, 0, 0), and about the inclined
/// axes
///
///   Q_alpha = sum K_x + beta (K_z of inner ring, rotor),   Q_beta = sum K_y of inner ring, rotor
///
/// Products of inertia Theta_xz, Theta_yz change the mass matrix with beta. The accelerations that
/// the constant part causes make of this the stiffness  2 Theta_xz alpha'' + Theta_yz beta''  of
/// alpha by beta, and  Theta_yz alpha''  of beta by beta.
///
/// On a guide at rest a symmetric rotor has Foeppl's equations (50), an unsymmetric one (49). With
/// its centre of mass at s e_z its weight is a spring of stiffness -m g s, below 0 if s is above.
///
/// Source : paper 002 (42)-(48), with [v (G + G_f)] in (48), which the print leaves out
/// Frame  : guide axes, reduced where the axes meet
/// Units  : rad, rad/s
/// Error  : the field is exact to first order: its error is of second order in the angles and
///          rates, for u, ou and g' of any size (tests/dynamics/gimbal/pendulous_gyro.cpp)
/// Throws : InvalidInput for what PendulousGyro refuses, references of the bearings other than 0,
///          or a speed that is not finite
template <class M, class... Loads>
class PendulousOscillations : public GimbalOscillation<PendulousGyro<M, RegulatedRotor, Loads...>> {
  using Base = GimbalOscillation<PendulousGyro<M, RegulatedRotor, Loads...>>;

 public:
  using typename Base::Vector;

  /// mass x'' + damping x' + stiffness x = force,  x = (alpha, beta), at one time.
  struct Coefficients {
    Eigen::Matrix2d mass, damping, stiffness;
    Eigen::Vector2d force;
  };

  PendulousOscillations(const PendulousBodies& bodies, const CardanBearings& bearings, double speed,
                        M guide, const Loads&... gravity)
      : Base(typename Base::Exact(bodies, bearings, std::move(guide), {}, gravity...), speed,
             "small oscillations of a pendulous gyro") {}

  /// The period of the coefficients on a guide at rest, in seconds; infinite without spin.
  [[nodiscard]] double period() const { return 2 * std::numbers::pi / std::abs(this->speed()); }

  [[nodiscard]] Coefficients coefficients(double t) const {
    const auto now = this->exact().apparent(t);
    const Vector3<double> u = detail::vector<double>(now.u);
    const Vector3<double> du = detail::vector<double>(now.du);
    const Vector3<double> g = detail::vector<double>(now.g);
    const PendulousBodies& bodies = this->exact().bodies();
    const Torque outer = torque(bodies.outer_ring, 0, 0, u, du, g);
    const Torque inner = torque(bodies.inner_ring, 0, 0, u, du, g) +
                         torque(bodies.rotor, this->speed(), this->speed() * t, u, du, g);
    const auto& [about_a, about_b] = this->exact().bearings();
    Coefficients c{
        inner.mass.template topLeftCorner<2, 2>(), inner.damping.template topLeftCorner<2, 2>(),
        inner.stiffness.template topLeftCorner<2, 2>(), -inner.constant.template head<2>()};
    c.mass(0, 0) += outer.mass(0, 0);
    c.damping(0, 0) += outer.damping(0, 0) + about_a.damping;
    c.damping(1, 1) += about_b.damping;
    c.stiffness(0, 0) += outer.stiffness(0, 0) + about_a.stiffness;
    c.stiffness(1, 1) += about_b.stiffness;
    c.stiffness(0, 1) += inner.constant.z();
    c.force[0] -= outer.constant.x();
    const double xz = inner.mass(0, 2);
    const double yz = inner.mass(1, 2);
    if (xz != 0 || yz != 0) {
      const Eigen::Vector2d at_once = c.mass.inverse() * c.force;
      c.stiffness(0, 1) += 2 * xz * at_once[0] + yz * at_once[1];
      c.stiffness(1, 1) += yz * at_once[0];
    }
    return c;
  }

  /// y' = state_matrix(t) y + forces  on  y = (alpha, beta, alpha', beta').
  [[nodiscard]] Eigen::Matrix4d state_matrix(double t) const {
    const Coefficients c = coefficients(t);
    const Eigen::Matrix2d inverse = c.mass.inverse();
    Eigen::Matrix4d A;
    A << Eigen::Matrix2d::Zero(), Eigen::Matrix2d::Identity(), -inverse * c.stiffness,
        -inverse * c.damping;
    return A;
  }

  /// The vector field  y' = rates(t, y).
  [[nodiscard]] Vector rates(double t, const Vector& y) const {
    const Coefficients c = coefficients(t);
    Vector dy;
    const Eigen::Vector2d x = y.template head<2>();
    const Eigen::Vector2d dx = y.template tail<2>();
    dy << dx, c.mass.inverse() * (c.force - c.damping * dx - c.stiffness * x);
    return dy;
  }

  /// The terms of rates(): see kreisel::terms.
  [[nodiscard]] Terms terms() const {
    Terms list = Base::linear_terms();
    list.add("relative", "moments and products of inertia of both rings and the rotor");
    list.add("guide", "u, ou and g', of first order in alpha, beta");
    return list;
  }

 private:
  /// K = mass a'' + damping a' + stiffness a + constant
  struct Torque {
    Matrix3<double> mass, damping, stiffness;
    Vector3<double> constant;

    friend Torque operator+(const Torque& a, const Torque& b) {
      return {a.mass + b.mass, a.damping + b.damping, a.stiffness + b.stiffness,
              a.constant + b.constant};
    }
  };

  [[nodiscard]] static Torque torque(const Inertia<>& body, double speed, double phi,
                                     const Vector3<double>& u, const Vector3<double>& du,
                                     const Vector3<double>& g) {
    Matrix3<double> R = Matrix3<double>::Identity();
    R.topLeftCorner<2, 2>() << std::cos(phi), -std::sin(phi), std::sin(phi), std::cos(phi);
    const Matrix3<double> T = R * body.tensor.matrix() * R.transpose();
    const Vector3<double> s = R * body.first_moment;
    const Vector3<double> n = u + Vector3<double>(0, 0, speed);
    const Matrix3<double> Z = skew(Vector3<double>(0, 0, speed));
    const Matrix3<double> turning = Z * T - T * Z;
    const Matrix3<double> U = skew(u);
    const Matrix3<double> L = skew(Vector3<double>(T * n));
    return {T, turning + T * U - L + U * T,
            turning * U + T * skew(du) - L * U + U * T * U - skew(s) * skew(g),
            turning * n + T * du + u.cross(T * n) - s.cross(g)};
  }
};

/// Stability of a rotor without rings in two equal springs c, or under its weight, c = -m g s with
/// the centre of mass at s on the axis, above. On axes of the rotor the coefficients are constant:
///
///   A B x^4 + (A k_2 + B k_1 + Omega^2 (A + B - C)^2) x^2 + k_1 k_2 = 0,
///   k_1 = c + Omega^2 (C - B),   k_2 = c + Omega^2 (C - A)
///
/// The rotor is stable if all x^2 are real, different and below 0. A heavy one is unstable where
/// k_1 k_2 < 0, and also at slow spins. For c > 0 EqualSpringsRange has the limits.
///
/// Source : paper 002 (49) with springs, section 8b: Fuchs' heavy unsymmetric gyro
/// Units  : kg m^2, N m/rad, rad/s
/// Throws : InvalidInput if a moment is not above 0
[[nodiscard]] inline bool is_stable_in_equal_springs(const Vector3<double>& rotor, double stiffness,
                                                     double speed) {
  if (!(rotor.minCoeff() > 0)) {
    throw InvalidInput("stability of an unsymmetric rotor: moments have to be above 0");
  }
  const double A = rotor.x(), B = rotor.y(), C = rotor.z();
  const double square = speed * speed;
  const double k_1 = stiffness + square * (C - B);
  const double k_2 = stiffness + square * (C - A);
  const double sum = A * k_2 + B * k_1 + square * (A + B - C) * (A + B - C);
  return k_1 * k_2 > 0 && sum > 0 && sum * sum > 4 * A * B * k_1 * k_2;
}

static_assert(Scene<PendulousOscillations<RestingFrame<>, UniformGravity<Guide>>>);

}  // namespace kreisel
