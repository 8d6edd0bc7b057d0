// A compass with two gyros that a gear couples, against its linear equations derived by hand.

#include <Eigen/Core>
#include <Eigen/LU>
#include <boost/test/unit_test.hpp>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <string>
#include <vector>

#include <dynamics/decompositions.hpp>
#include <dynamics/guide/rotating.hpp>
#include <dynamics/study/equilibrium.hpp>
#include <dynamics/study/linearize.hpp>
#include <dynamics/study/spectrum.hpp>
#include <dynamics/tree/body_system.hpp>

using namespace kreisel;

namespace {

// Angles of x north, y west, z up, at 50 degrees of latitude.
constexpr double earth_rate = 7.292115e-5, g = 9.81;
const double north = earth_rate * std::cos(50 * std::numbers::pi / 180);
const double up = earth_rate * std::sin(50 * std::numbers::pi / 180);
constexpr double mass = 12, depth = 0.008;      ///< of the float, and of its centre of mass
constexpr double J = 0.25, I = 0.02, C = 0.03;  ///< float, ring, rotor: isotropic about the origin
constexpr double H = 16, spread = 0.8, stiffness = 6;

InertiaTensor<Body> isotropic(double m, double lowered, double moment) {
  return InertiaTensor<Body>::about_origin(m, {0, 0, -lowered},
                                           moment * Matrix3<double>::Identity());
}

BodyDescription turning(const std::string& name, const std::string& parent,
                        const Vector3<double>& axis, const InertiaTensor<Body>& inertia) {
  BodyDescription body;
  body.name = name;
  body.parent = parent;
  body.joint = {.kind = JointKind::revolute, .axis = axis};
  body.inertia = inertia;
  return body;
}

/// A pendulous float that turns by the azimuth, the tilt and the roll. It carries two rings about its
/// vertical, which springs hold at +spread and -spread and a gear turns in opposite senses.
BodySystem<RotatingFrame<>> compass() {
  std::vector<BodyDescription> bodies{
      turning("azimuth", "guide", {0, 0, 1}, {}), turning("tilt", "azimuth", {0, 1, 0}, {}),
      turning("float", "tilt", {1, 0, 0}, isotropic(mass, depth, J))};
  for (const double side : {1.0, -1.0}) {
    const std::string name = side > 0 ? "left" : "right";
    BodyDescription ring = turning(name, "float", {0, 0, 1}, isotropic(1, 0, I));
    ring.forces = {{.stiffness = stiffness / 2, .rest = side * spread}};
    bodies.push_back(ring);
    BodyDescription gyro = turning(name + " gyro", name, {1, 0, 0}, isotropic(2, 0, C));
    gyro.rotor = Rotor{.mode = RotorMode::regulated};
    bodies.push_back(gyro);
  }
  return {RotatingFrame<>{{north, 0, up}},
          bodies,
          UniformGravity<Guide>{{0, 0, -g}},
          {},
          {{"gear", "left", "right", constraint::Gear{-1, 0}}}};
}

/// The tilt b and the rings' deflection d at rest, where a function F of them is stationary:
///
///   F = -m g h cos(b) + k d^2/2 - 2 H cos(spread + d) (n cos(b) - v sin(b))
///
/// n and v are the earth's rates on north and up.
struct Rest {
  double tilt = 0, deflection = 0;
};

Rest rest_by_hand() {
  Rest rest;
  // Both are below 0.02. Each turn of the iteration makes the error 0.01 times as large.
  for (int i = 0; i < 20; ++i) {
    const double angle = spread + rest.deflection;
    const double momentum = 2 * H * std::cos(angle);
    rest.tilt = -std::atan2(momentum * up, mass * g * depth + momentum * north);
    const double along = north * std::cos(rest.tilt) - up * std::sin(rest.tilt);
    rest.deflection = -2 * H * std::sin(angle) * along / stiffness;
  }
  return rest;
}

/// The linear equations  M q'' + (N^t - N) q' + K q = 0  of small azimuth, tilt, roll and deflection,
/// the second derivatives of the Lagrangian
///
///   L = P |w + u|^2/2 + D d'^2 + 2 H cos(spread + d) x.(w + u) + m g h cos(b) cos(c) - k d^2/2
///
/// P is the moment of all bodies, D that of ring and rotor. x is the float's axis between the gyros and
/// w its angular velocity on guide axes, u that of the earth:
///
///   x.w = c' - a' sin(b),   x.u = n cos(a) cos(b) - v sin(b)
///   |w|^2 = a'^2 + b'^2 + c'^2 - 2 a' c' sin(b)
///   u.w = v a' + n (c' cos(a) cos(b) - b' sin(a)) - v c' sin(b)
///
/// The rings' rates d' and -d' cancel in the sum about the vertical. This is the gear's purpose.
Eigen::VectorXcd roots_by_hand(const Rest& rest) {
  const double all = J + 2 * (I + C), sine = std::sin(rest.tilt), cosine = std::cos(rest.tilt);
  const double s = 2 * H * std::sin(spread + rest.deflection);
  const double c = 2 * H * std::cos(spread + rest.deflection);
  const double along = north * cosine - up * sine, across = north * sine + up * cosine;
  const double pendulum = mass * g * depth * cosine;
  Eigen::Matrix4d M = Eigen::Vector4d(all, all, all, 2 * (I + C)).asDiagonal();
  M(0, 2) = M(2, 0) = -all * sine;
  Eigen::Matrix4d N = Eigen::Matrix4d::Zero();  // of the terms q_i q_j'
  N(0, 1) = -all * north;
  N(1, 2) = -all * across;
  N(1, 0) = -c * cosine;
  N(3, 2) = -s;
  N(3, 0) = s * sine;
  Eigen::Matrix4d K =
      Eigen::Vector4d(c * north * cosine, pendulum + c * along, pendulum, stiffness + c * along)
          .asDiagonal();
  K(1, 3) = K(3, 1) = -s * across;
  Eigen::Matrix<double, 8, 8> A = Eigen::Matrix<double, 8, 8>::Zero();
  A.topRightCorner<4, 4>().setIdentity();
  A.bottomLeftCorner<4, 4>() = -M.inverse() * K;
  A.bottomRightCorner<4, 4>() = -M.inverse() * (N.transpose() - N);
  return eigenvalues(A);
}

/// The state with both gyros at their momentum.
Eigen::VectorXd state_at(const BodySystem<RotatingFrame<>>& system, const Rest& rest) {
  auto state = system.rest();
  const auto place = [&system](const char* name) {
    return system.tree().place(system.tree().index(name));
  };
  state.coordinates[place("tilt").q] = rest.tilt;
  state.coordinates[place("left").q] = spread + rest.deflection;
  state.coordinates[place("right").q] = -spread - rest.deflection;
  state.rates[place("left gyro").v] = state.rates[place("right gyro").v] = H / C;
  return system.to_vector(state);
}

}  // namespace

BOOST_AUTO_TEST_SUITE(gyro_compass)
// The compass is at rest where the function F is stationary. The torques are below 10 N m, the moments
// 0.05 kg m^2.
BOOST_AUTO_TEST_CASE(rest_is_that_by_hand) {
  const auto system = compass();
  const Eigen::VectorXd rates = system.rates(0, state_at(system, rest_by_hand()));
  BOOST_TEST(rates.tail(system.tree().rates()).cwiseAbs().maxCoeff() <= 1e-13);
}

// Roots of 123, 63.7, 0.103 and 0.00141 rad/s: two nutations, the roll and the search for north with a
// period of 74 minutes. Rounding makes 1e-13 of the 64 rad/s that the slow roots are differences of.
BOOST_AUTO_TEST_CASE(roots_are_those_by_hand) {
  const auto system = compass();
  const Rest rest = rest_by_hand();
  const auto linear = linearize<Guide, Body>(system, 0, state_at(system, rest));
  const auto found = eigenvalues(linear.A);
  double slowest = INFINITY;
  for (const std::complex<double>& wanted : roots_by_hand(rest)) {
    double off = INFINITY;
    for (const std::complex<double>& root : found) off = std::min(off, std::abs(root - wanted));
    BOOST_TEST(off <= 1e-12 + 1e-14 * std::abs(wanted), wanted << " is missed by " << off);
    slowest = std::min(slowest, std::abs(wanted));
  }
  // The horizontal momentum in the earth's rate on north, and the pendulum: as for one gyro.
  const double S = 2 * H * std::cos(spread), pendulum = mass * g * depth;
  BOOST_TEST(std::abs(slowest / std::sqrt(north * pendulum / S) - 1) <= 1e-3);
}

// The gyros turn in opposite senses when the float rolls. Their springs then hold it as a moment of
// S^2/k would, S = 2 H sin(spread): it rolls at 0.1034 rad/s in place of 1.640. The tilt of 1.3e-3 rad
// at rest and the deflection of 1.8e-4 rad change this by less than 1e-3 of it.
BOOST_AUTO_TEST_CASE(geared_gyros_slow_down_the_roll) {
  const auto system = compass();
  const auto linear = linearize<Guide, Body>(system, 0, state_at(system, rest_by_hand()));
  const double S = 2 * H * std::sin(spread), all = J + 2 * (I + C);
  const double wanted = std::sqrt(mass * g * depth / (all + S * S / stiffness));
  double off = INFINITY;
  for (const std::complex<double>& root : eigenvalues(linear.A)) {
    off = std::min(off, std::abs(root - std::complex<double>(0, wanted)));
  }
  BOOST_TEST(off <= 1e-3 * wanted);
}

BOOST_AUTO_TEST_SUITE_END()
