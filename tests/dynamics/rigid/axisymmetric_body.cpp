#include <boost/test/unit_test.hpp>

#include <cmath>

#include <dynamics/exact/lagrange_top.hpp>
#include <dynamics/guide/harmonic.hpp>
#include <dynamics/guide/resting.hpp>
#include <dynamics/rigid/axisymmetric_body.hpp>
#include <dynamics/solve/solve.hpp>

#include <support/near.hpp>
#include <support/sample.hpp>

using namespace kreisel;
using test::near;

namespace {

double angle_between(const Eigen::Quaterniond& a, const Eigen::Quaterniond& b) {
  return 2 * (a.normalized().conjugate() * b.normalized()).vec().norm();
}

HarmonicFrame<> rolling_ship() {
  HarmonicSeries<> turn;
  turn.terms.push_back({{0.2, 0.03, 0.05}, 0.7, 0.1});
  turn.terms.push_back({{0.01, 0.1, 0}, 1.1, 0.4});
  HarmonicSeries<> heave;
  heave.constant = {0, 0, 0.1};
  heave.terms.push_back({{0.3, 0.2, 1.5}, 0.8, 0});
  return HarmonicFrame<>(turn, heave, 0, 4);
}

const UniformGravity<Guide> weight{{0, 0, -9.81}};
const ViscousDrag<> drag{.torque_per_rate = 1e-6};
const Vector3<double> place(0.3, -0.2, 1);

}  // namespace

BOOST_AUTO_TEST_SUITE(axisymmetric_body)

// The same body in its own axes, on a ship that rolls and heaves, with weight and drag.
BOOST_AUTO_TEST_CASE(agrees_with_a_body_on_its_own_axes) {
  const InertiaTensor<Body> inertia{{0.1, {0, 0, 5e-3}, {3e-4, 3e-4, 1e-4}}};
  const FixedPointBody held(inertia, place, rolling_ship(), weight, drag);
  const AxisymmetricBody<HarmonicFrame<>, UniformGravity<Guide>, ViscousDrag<>> round(
      0.1, 0.05, 3e-4, 1e-4, place, rolling_ship(), weight, drag);
  for (unsigned seed = 0; seed < 5; ++seed) {
    test::Sample sample(seed);
    const Eigen::Quaterniond q(Eigen::AngleAxisd(sample.uniform(0, 1), sample.direction()));
    const Vector3<double> u = Vector3<double>(0, 0, 200) + 5 * sample.direction();
    Integrator own_axes(held, 0, {q, u}, {.relative = 1e-13});
    Integrator resal(round, 0, {q, u, 0}, {.relative = 1e-13});
    for (const double t : {0.5, 1.0, 3.0}) {
      const auto expected = own_axes.to(t);
      const auto found = round.on_body_axes(resal.to(t));
      const double angle = 200 * t;  // turned through
      BOOST_TEST(angle_between(found.attitude, expected.attitude) <= 1e-13 * angle + 1e-12);
      BOOST_TEST((found.angular_velocity - expected.angular_velocity).norm() <= 1e-10);
    }
    const auto a = held.body_outputs(0.3, {q, u});
    const auto b = round.body_outputs(0.3, {q, u, 0});
    BOOST_TEST((a.reaction.value.resultant - b.reaction.value.resultant).norm() <= 1e-14);
  }
}

// The fast top of 3000 rad/s, with the attitude of a closed form to the last digits.
BOOST_AUTO_TEST_CASE(does_not_resolve_the_spin) {
  const double weight_moment = 0.1 * 9.81 * 0.05;
  const Eigen::Quaterniond q(std::cos(0.25), std::sin(0.25), 0, 0);
  const Vector3<double> w(0, 0, 3000);
  const exact::LagrangeTop truth(3e-4, 1e-4, weight_moment, w, q);
  const AxisymmetricBody round(0.1, 0.05, 3e-4, 1e-4, Vector3<double>::Zero(), RestingFrame<>{},
                               weight);
  const FixedPointBody held(InertiaTensor<Body>{{0.1, {0, 0, 5e-3}, {3e-4, 3e-4, 1e-4}}},
                            Vector3<double>::Zero(), RestingFrame<>{}, weight);
  Integrator resal(round, 0, {q, w, 0}, {.relative = 1e-12});
  Integrator own_axes(held, 0, {q, w}, {.relative = 1e-12});
  const double t = 1;
  const double error =
      angle_between(round.on_body_axes(resal.to(t)).attitude, truth.at(t).attitude);
  const double error_own = angle_between(own_axes.to(t).attitude, truth.at(t).attitude);
  BOOST_TEST_MESSAGE("error " << error << " in " << resal.effort().evaluations
                              << " evaluations, in the body's axes " << error_own << " in "
                              << own_axes.effort().evaluations);
  BOOST_TEST(error <= 1e-10);
  BOOST_TEST(resal.effort().evaluations < 0.4 * own_axes.effort().evaluations);
}

// With ten times the spin and the same angular momentum, nothing changes but the spin.
BOOST_AUTO_TEST_CASE(costs_as_much_as_its_nutation) {
  const Eigen::Quaterniond q(std::cos(0.25), std::sin(0.25), 0, 0);
  double slow = 0;
  for (const double spin : {1e2, 1e4, 1e6}) {
    const double C = 3e-2 / spin;
    const AxisymmetricBody round(0.1, 0.05, 3e-3, C, Vector3<double>::Zero(), RestingFrame<>{},
                                 weight);
    const auto found =
        solve(round, {q, {0, 0, spin}, 0}, {.output_times = {5, 10}, .tolerance = 1e-9});
    BOOST_TEST(found.report.tolerance_kept);
    BOOST_TEST_MESSAGE(spin << " rad/s: " << found.report.effort.evaluations << " evaluations");
    if (slow == 0) slow = found.report.effort.evaluations;
    BOOST_TEST(std::abs(found.report.effort.evaluations - slow) <= 0.1 * slow);
  }
}

BOOST_AUTO_TEST_SUITE_END()
