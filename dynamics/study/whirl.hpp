#pragma once

#include <Eigen/Core>

#include <vector>

#include <dynamics/tree/tree.hpp>
#include <motor/api.hpp>

/// Whirl: the sense in which the deflection of a spinning body's axis turns in a mode.

namespace kreisel {

enum class Whirl {
  none,      ///< no spinning body is deflected
  plane,     ///< to and fro, or the body does not spin
  forward,   ///< in the sense of the spin
  backward,  ///< against the spin
  mixed      ///< some bodies forward, some backward
};

[[nodiscard]] constexpr const char* name(Whirl whirl) {
  constexpr const char* names[] = {"", "plane", "forward", "backward", "mixed"};
  return names[static_cast<int>(whirl)];
}

/// A body that spins about its axis: a rotor, a body that turns in a revolute joint, or a body that
/// such a body carries. Two points c +- rho e of the axis, each with half of the mass, have the
/// body's mass and its moment of inertia A across the axis, rho^2 = A/m.
///
/// Frame  : guide axes
/// Units  : rad/s, kg, m
struct SpinningBody {
  int body = 0;
  Vector3<double> axis = Vector3<double>::Zero();  ///< e, of length 1, in the sense of the spin
  double spin = 0;       ///< of the body against the guide, about e; 0: e is the joint's axis
  double carrier = 0;    ///< rate of the frame in which the deflection varies, about e
  double half_mass = 0;  ///< of each point
  /// The displacement of both points by each direction of the state (study/tangent.hpp), at the
  /// moment of the state: six rows.
  Eigen::MatrixXd displacement;
};

/// The spinning bodies of a system in a steady motion.
///
/// y : coordinates and rates; whatever follows is not read
KREISEL_API [[nodiscard]] std::vector<SpinningBody> spinning_bodies(const BodyTree& tree,
                                                                    const Eigen::VectorXd& y);

/// The whirl of a mode exp(s t) shape. A point d exp(i w t) = (a + i b) exp(i w t) moves on an
/// ellipse, and turns about e by the sense of
///
///   c = sum m (b x a).e / (sum m (a^2 + b^2)/2),   a, b across e,   -1 <= c <= 1
///
/// c is w L/(2 T), where L is the angular momentum of the deflection about e, and T its mean kinetic
/// energy. It is 1 for circles in the sense of the spin, -1 against it, and 0 for lines.
struct WhirlOfMode {
  Whirl sense = Whirl::none;
  double circulation = 0;  ///< c, of all bodies together

  /// The frequency against the guide, negative if backward. An ellipse is composed of two circles,
  /// and this is the frequency of the greater one: w, or carrier +- w on a carrier that turns.
  double frequency = 0;
};

/// frequency : of the mode, rad/s
/// shape     : its amplitudes in the directions of the state, coordinates first
/// Error     : |c| below 1e-6 counts as a line
KREISEL_API [[nodiscard]] WhirlOfMode whirl(const std::vector<SpinningBody>& bodies,
                                            double frequency, const Eigen::VectorXcd& shape);

}  // namespace kreisel
