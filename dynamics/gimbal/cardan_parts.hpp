#pragma once

#include <Eigen/Core>

#include <array>
#include <cmath>
#include <sstream>

#include <dynamics/inertia.hpp>
#include <motor/error.hpp>
#include <motor/lanes.hpp>
#include <motor/static_zero.hpp>

/// The parts of a CardanGyro, its state, and its outputs.

namespace kreisel {

/// The principal moments of inertia (A, B, C) of a Cardan gyro's three bodies about the point where
/// its axes meet. This point is the centre of mass of each body.
///
/// C of the rotor lies along its spin axis, B of the inner ring along the inner bearing, A of the
/// outer ring along the outer one. A ring of zeros has no mass.
///
/// Source : paper 002 section 7: Theta_A .. Theta_C with the indices 1, 2 and 3
/// Units  : kg m^2
template <class P>
struct BasicCardanMoments {
  Vector3<P> rotor = Vector3<P>::Zero();
  Vector3<P> inner_ring = Vector3<P>::Zero();
  Vector3<P> outer_ring = Vector3<P>::Zero();
};
using CardanMoments = BasicCardanMoments<double>;

/// The torque of a bearing about its axis:  torque = -stiffness q - damping q',  q from
/// `reference`.
///
/// The state counts the angle from `reference` too, so that the torque of a stiff bearing keeps its
/// digits. At 1e12 N m/rad the last digit of an angle of 0.3 is worth 5.5e-5 N m.
///
/// Units  : N m/rad, N m s/rad, radian
template <class P>
struct BasicCardanBearing {
  P stiffness = P(0);
  P damping = P(0);
  P reference = P(0);  ///< where the spring is slack and the state's angle is 0
};
using CardanBearing = BasicCardanBearing<double>;

template <class P>
struct BasicCardanBearings {
  BasicCardanBearing<P> outer = {};  ///< of alpha, between the guide and the outer ring
  BasicCardanBearing<P> inner = {};  ///< of beta, between both rings
};
using CardanBearings = BasicCardanBearings<double>;

/// The state of a Cardan gyro.
struct CardanState {
  double alpha = 0;       ///< of the outer ring, from bearings().outer.reference
  double beta = 0;        ///< of the inner ring, from bearings().inner.reference
  double phi = 0;         ///< of the rotor
  double alpha_rate = 0;  ///< against the guide
  double beta_rate = 0;   ///< against the outer ring
  double phi_rate = 0;    ///< against the inner ring
};

namespace detail {

/// The state of a Cardan gyro as numbers, for integrators.
struct CardanStates {
  using Vector = Eigen::Matrix<double, 6, 1>;
  using State = CardanState;

  /// Each component is a block of its own: the angle of a stiff bearing is far smaller than the
  /// other, and phi far greater.
  static constexpr std::array<int, 6> blocks = {1, 1, 1, 1, 1, 1};

  [[nodiscard]] static Vector to_vector(const State& s) {
    return (Vector() << s.alpha, s.beta, s.phi, s.alpha_rate, s.beta_rate, s.phi_rate).finished();
  }

  [[nodiscard]] static State from_vector(const Vector& y) {
    return {y[0], y[1], y[2], y[3], y[4], y[5]};
  }
};

}  // namespace detail

/// A free rotor. Friction acts between rotor and inner ring, in N m s/rad.
struct FreeRotor {
  double friction = 0;
};

/// A free rotor in a bearing without friction: a FreeRotor with 0, at compile time.
struct FrictionlessRotor {
  static constexpr double friction = 0;
};

/// A rotor driven from the inner ring by a torque in N m: a number, or a function of the time and
/// of phi'. For an exact Jacobian the function must accept dual numbers.
template <class Torque = double>
struct DrivenRotor {
  Torque torque = {};
  double friction = 0;
};
template <class Torque>
DrivenRotor(Torque) -> DrivenRotor<Torque>;
template <class Torque>
DrivenRotor(Torque, double) -> DrivenRotor<Torque>;

/// A rotor whose speed against the inner ring a motor keeps constant.
struct RegulatedRotor {
  double friction = 0;  ///< also overcome by the motor
};

/// The moments in the bearings of a Cardan gyro, including springs, friction and drive. The
/// reaction on the other body is the negative.
///
/// Source : paper 002 (35)-(40); the comments give its names
/// Units  : N m, W
struct CardanReactions {
  Vector3<double> rotor_on_inner_ring;       ///< M_A21, M_B21, M_C21 on the axes of the inner ring
  Vector3<double> inner_ring_on_outer_ring;  ///< M_A32, M_B32, M_C32 on the axes of the outer ring
  Vector3<double> guide_on_outer_ring;       ///< M_A3, M_BL, M_CL on the axes of the outer ring

  double motor_torque;  ///< of the motor on the rotor, without friction
  double motor_power;   ///< motor_torque phi', the output of the motor
};

/// Energies and momenta of a Cardan gyro.
///
/// Units  : J, N m s
struct CardanBalance {
  double kinetic_energy;             ///< absolute
  double potential_energy;           ///< of the springs
  double alpha_momentum;             ///< dT/d alpha': of everything, about the outer axis
  double beta_momentum;              ///< dT/d beta': of inner ring and rotor, about the inner axis
  double rotor_momentum;             ///< dT/d phi' = C_1 u_C1: of the rotor, about its own axis
  Vector3<double> angular_momentum;  ///< of everything, absolute, on guide axes
};

namespace detail {

template <class S>
struct SinCos {
  S sin = {};
  S cos = {};
};

/// Sine and cosine of reference + deviation, both relatively exact to 2u. This holds even
/// where one of them is nearly 0. The rounding error of the sum is added to first order.
template <class S>
[[nodiscard, gnu::always_inline]] inline SinCos<S> sin_cos(StaticZero /*reference*/,
                                                           const S& deviation) {
  using std::cos, std::sin;
  return {S(sin(deviation)), S(cos(deviation))};
}
template <class P, class S>
[[nodiscard, gnu::always_inline]] inline SinCos<S> sin_cos(const P& reference, const S& deviation) {
  using std::cos, std::sin;
  if (all(reference == P(0))) return sin_cos(StaticZero{}, deviation);
  const S sum = reference + deviation;
  const S back = sum - reference;
  const S rest = (reference - S(sum - back)) + S(deviation - back);
  const S s = sin(sum);
  const S c = cos(sum);
  return {S(s + rest * c), S(c - rest * s)};
}

/// Moments of inertia of a ring, with those of a symmetric rotor without its spin.
template <class P>
struct RingMoments {
  P a, b, c;
  P c_less_ab;  ///< c - b - a
  P a_less_c;   ///< a - c
  P bc_less_a;  ///< b + c - a, from the ring's b - a

  /// The ring's moments J, the rotor's A, and C where the rotor's speed is regulated.
  RingMoments(const Vector3<P>& J, const P& rotor_a, const P& rotor_c)
      : a(J.x() + rotor_a),
        b(J.y() + rotor_a),
        c(J.z() + rotor_c),
        c_less_ab(c - b - a),
        a_less_c(a - c),
        bc_less_a(c + (J.y() - J.x())) {}
};

/// Out of line, with the whole message: rates() counts every instruction.
template <class P, class S>
[[noreturn]] EIGEN_DONT_INLINE void stop_where_singular(const BasicCardanMoments<P>& moments,
                                                        bool regulated, const P& reference,
                                                        const S& beta) {
  std::ostringstream text;
  text.precision(17);
  text << "Cardan gyro: at beta = " << number_in(reference) + static_cast<double>(number_in(beta))
       << " rad the mass matrix is singular: ";
  const bool light =
      any(moments.outer_ring.x() == P(0)) && any(moments.inner_ring.z() == P(0)) && !regulated;
  text << (light ? "nothing resists the rotation alpha of the outer ring (A_3 + C_2 sin^2 beta = 0 "
                   "and cos beta = 0: gimbal lock of rings without mass)"
                 : "nothing resists the rotation beta of the inner ring (B_2 + Q = 0)");
  throw ComputationFailed(text.str());
}

}  // namespace detail

}  // namespace kreisel
