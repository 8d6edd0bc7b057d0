#include <boost/test/unit_test.hpp>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <dynamics/guide/resting.hpp>
#include <dynamics/rigid/euler_top.hpp>
#include <dynamics/rigid/fixed_point_body.hpp>
#include <dynamics/step/integrator.hpp>

#include <support/near.hpp>
#include <support/worst.hpp>

using namespace kreisel;
using test::near;

namespace {

const Eigen::Quaterniond tilted(std::cos(0.25), std::sin(0.25), 0, 0);

/// The greatest drift of each invariant over a run.
TopInvariants<> drift(const EulerTop& top, const EulerTop::State& start, double t_end) {
  const TopInvariants<> at_start = top.invariants(start);
  TopInvariants<> most{0, 0, 0, 0, {0, 0, 0}};
  Integrator run(top, 0, start);
  for (int i = 1; i <= 100; ++i) {
    const TopInvariants<> now = top.invariants(run.to(t_end * i / 100));
    const auto note = [](double& worst, double off) {
      worst = test::worst_of(worst, std::abs(off));
    };
    note(most.energy, now.energy - at_start.energy);
    note(most.vertical_momentum, now.vertical_momentum - at_start.vertical_momentum);
    note(most.axial_momentum, now.axial_momentum - at_start.axial_momentum);
    note(most.kovalevskaya, now.kovalevskaya - at_start.kovalevskaya);
    most.momentum = most.momentum.cwiseMax((now.momentum - at_start.momentum).cwiseAbs());
  }
  return most;
}

}  // namespace

BOOST_AUTO_TEST_SUITE(eulers_top)

BOOST_AUTO_TEST_CASE(keeps_energy_and_momentum_when_free) {
  const auto d = drift(EulerTop({1, 2, 2.9}), {tilted, {0.3, 2, -0.4}}, 100);
  BOOST_TEST(d.energy < 1e-12);
  BOOST_TEST(d.momentum.maxCoeff<Eigen::PropagateNaN>() < 1e-12);
}

BOOST_AUTO_TEST_CASE(turns_for_ever_about_a_principal_axis) {
  const EulerTop top({1, 2, 3});
  for (int axis = 0; axis < 3; ++axis) {
    const Vector3<double> w = 3 * Vector3<double>::Unit(axis);
    BOOST_TEST(Integrator(top, 0, {tilted, w}).to(1000).angular_velocity == w);
  }
}

// Spherical: w is exactly constant. Symmetric: the axial spin is.
BOOST_AUTO_TEST_CASE(keeps_the_invariants_of_its_symmetry) {
  const Vector3<double> w(0.1, 0.7, -0.3);
  const EulerTop sphere({2, 2, 2});
  BOOST_TEST(Integrator(sphere, 0, {tilted, w}).to(100).angular_velocity == w);
  const EulerTop symmetric({2, 2, 3});
  BOOST_TEST(Integrator(symmetric, 0, {tilted, w}).to(100).angular_velocity.z() == w.z());
  const EulerTop lagrange({2, 2, 3}, {0, 0, 5});
  BOOST_TEST(Integrator(lagrange, 0, {tilted, w}).to(100).angular_velocity.z() == w.z());
}

BOOST_AUTO_TEST_CASE(keeps_kovalevskayas_invariant) {
  const EulerTop top({2, 2, 1}, {0.7, -0.3, 0});
  const auto d = drift(top, {tilted, {0.5, 1, 2}}, 1000);
  BOOST_TEST_MESSAGE("over 1000 s: energy " << d.energy << ", L_z " << d.vertical_momentum
                                            << ", Kovalevskaya " << d.kovalevskaya);
  BOOST_TEST(d.kovalevskaya < 1e-11);
  BOOST_TEST(d.energy < 1e-11);
  BOOST_TEST(d.vertical_momentum < 1e-11);
  // A top of another kind does not keep it.
  BOOST_TEST(drift(EulerTop({2, 2, 1.1}, {0.7, -0.3, 0}), {tilted, {0.5, 1, 2}}, 10).kovalevskaya >
             0.01);
}

// With weight and a rotor's momentum in general directions.
BOOST_AUTO_TEST_CASE(keeps_energy_and_vertical_momentum) {
  const auto d =
      drift(EulerTop({1, 2, 2.5}, {0.7, -0.3, 1.1}, {0.2, -1, 0.5}), {tilted, {0.5, 1, 2}}, 100);
  BOOST_TEST_MESSAGE("over 100 s: energy " << d.energy << ", L_z " << d.vertical_momentum);
  BOOST_TEST(d.energy < 1e-12);
  BOOST_TEST(d.vertical_momentum < 1e-12);
}

BOOST_AUTO_TEST_CASE(names_its_invariants) {
  using Names = std::vector<std::string>;
  const auto kept = [](const EulerTop& top) {
    Names names;
    for (const auto& [name, value] : top.conserved(0, {tilted, {0.5, 1, 2}})) {
      names.emplace_back(name);
    }
    return names;
  };
  const Names always{"energy", "vertical momentum"};
  const Names axial{"energy", "vertical momentum", "axial momentum"};
  BOOST_TEST(kept(EulerTop({1, 2, 2.5}, {0.7, -0.3, 1.1})) == always);
  BOOST_TEST(kept(EulerTop({1, 2, 2.5}, {0, 0, 1.1})) == always);
  BOOST_TEST(kept(EulerTop({2, 2, 3}, {0, 0, 5})) == axial);
  BOOST_TEST(kept(EulerTop({2, 2, 3}, {0, 0, 5}, {0, 0, 1})) == axial);
  BOOST_TEST(kept(EulerTop({2, 2, 3}, {0, 0, 5}, {0, 1, 0})) == always);
  BOOST_TEST(kept(EulerTop({1, 2, 2.5})) == (Names{"energy", "vertical momentum", "momentum"}));
  BOOST_TEST(kept(EulerTop({2, 2, 1}, {0.7, -0.3, 0})) ==
             (Names{"energy", "vertical momentum", "kovalevskaya"}));
  BOOST_TEST(kept(EulerTop({2, 2, 2}, {0.7, -0.3, 0})) == always);
  BOOST_TEST(kept(EulerTop({2, 2, 1}, {0.7, -0.3, 0}, {0, 0, 0.5})) == always);
}

// A sleeping top stands for any time. Just below the critical spin it falls, just above it does
// not.
BOOST_AUTO_TEST_CASE(sleeps_above_the_critical_spin) {
  const double A = 2, C = 1, k = 3;
  const double critical = std::sqrt(4 * A * k) / C;
  const EulerTop top({A, A, C}, {0, 0, k});
  const auto upright =
      Integrator(top, 0, {Eigen::Quaterniond::Identity(), {0, 0, critical / 2}}).to(100);
  BOOST_TEST(upright.attitude.x() == 0);
  const Eigen::Quaterniond nearly(1, 1e-6, 0, 0);
  const auto tilt = [&](double spin) {
    double most = 0;
    Integrator run(top, 0, {nearly, {0, 0, spin}});
    for (int i = 1; i <= 200; ++i) {
      const auto s = run.to(0.2 * i);
      most =
          test::worst_of(most, 2 * std::hypot(s.attitude.x(), s.attitude.y()) / s.attitude.norm());
    }
    return most;
  };
  BOOST_TEST(tilt(1.05 * critical) < 1e-4);
  BOOST_TEST(tilt(0.95 * critical) > 0.1);
}

// With a rotor at constant relative speed the total momentum is constant in space, not the
// carrier's.
BOOST_AUTO_TEST_CASE(may_carry_a_regulated_rotor) {
  const Vector3<double> h(0.2, -1, 0.5);
  const EulerTop gyrostat({1, 2, 2.5}, {0, 0, 0}, h);
  const auto d = drift(gyrostat, {tilted, {0.3, 0.2, -0.4}}, 100);
  BOOST_TEST(d.energy < 1e-12);
  BOOST_TEST(d.momentum.maxCoeff<Eigen::PropagateNaN>() < 1e-12);
}

// The same top as a body with a fixed point in a guide at rest.
BOOST_AUTO_TEST_CASE(agrees_with_a_body_on_a_guide_at_rest) {
  const Vector3<double> moments(0.45, 0.47, 0.08), r_s(0.05, -0.02, 0.3);
  const double m = 2, g = 9.81;
  const auto T = InertiaTensor<Body>::about_origin(m, r_s, Matrix3<double>(moments.asDiagonal()));
  const EulerTop top(moments, m * g * r_s);
  const FixedPointBody held(T, {0, 0, 0}, RestingFrame<>{}, UniformGravity<Inertial>{{0, 0, -g}});
  const Vector3<double> w(1, 2, 8);
  const auto a = Integrator(top, 0, {tilted, w}).to(2);
  const auto b = Integrator(held, 0, {tilted, w}).to(2);
  BOOST_TEST(near(a.angular_velocity, b.angular_velocity, 10.0, 1e-12 / test::u<>));
  BOOST_TEST(near(Eigen::Vector4d(a.attitude.coeffs()), Eigen::Vector4d(b.attitude.coeffs()), 1.0,
                  1e-12 / test::u<>));
}

BOOST_AUTO_TEST_CASE(is_refused_with_impossible_moments) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  BOOST_CHECK_THROW(EulerTop({1, 2, 4}), InvalidInput);
  BOOST_CHECK_THROW(EulerTop({-1, 2, 2}), InvalidInput);
  BOOST_CHECK_THROW(EulerTop({0, 1, 1}), InvalidInput);
  BOOST_CHECK_THROW(EulerTop({nan, 1, 1}), InvalidInput);
  BOOST_CHECK_THROW(EulerTop({1, 1, 1}, {nan, 0, 0}), InvalidInput);
  BOOST_CHECK_THROW(EulerTop({1, 1, 1}, {0, 0, 0}, {0, nan, 0}), InvalidInput);
}

BOOST_AUTO_TEST_SUITE_END()
