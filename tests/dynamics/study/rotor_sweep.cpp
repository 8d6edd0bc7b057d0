#include <Eigen/Dense>
#include <boost/test/unit_test.hpp>

#include <algorithm>
#include <cmath>
#include <complex>
#include <vector>

#include <dynamics/study/rotor_sweep.hpp>
#include <dynamics/tree/tree.hpp>
#include <motor/error.hpp>

using namespace kreisel;

namespace {

/// A disc on a universal joint: tilts a about x and b about y, spin about z. If `on_shaft`, the
/// joint is on a shaft that turns, else the disc is a rotor.
BodyTree disc(bool on_shaft) {
  BodyDescription shaft;
  shaft.name = "shaft";
  shaft.joint = {.kind = JointKind::revolute, .axis = {0, 0, 1}};
  shaft.rule = JointRule::driven;
  shaft.inertia = InertiaTensor<Body>::about_centre(1, {0, 0, 0}, Matrix3<double>::Identity());
  BodyDescription tilt;
  tilt.name = "tilt";
  tilt.joint = {.kind = JointKind::universal, .axis = {1, 0, 0}, .second_axis = {0, 1, 0}};
  BodyDescription wheel;
  wheel.name = "wheel";
  wheel.parent = "tilt";
  wheel.joint = {.kind = JointKind::revolute, .axis = {0, 0, 1}};
  wheel.rotor = Rotor{.mode = RotorMode::free};
  const Matrix3<double> I = Vector3<double>(2, 2, 3).asDiagonal();
  if (on_shaft) {
    tilt.parent = "shaft";
    tilt.inertia = InertiaTensor<Body>::about_centre(4, {0, 0, 0.5}, I);
    return BodyTree({shaft, tilt});
  }
  wheel.inertia = InertiaTensor<Body>::about_centre(4, {0, 0, 0.5}, I);
  return BodyTree({tilt, wheel});
}

/// A state at rest but for the spin: the last rate of the rotor, the first of the shaft.
Eigen::VectorXd spinning_at(const BodyTree& tree, double rate, bool on_shaft) {
  Eigen::VectorXd y = Eigen::VectorXd::Zero(tree.coordinates() + tree.rates());
  y[tree.coordinates() + tree.place(tree.index(on_shaft ? "shaft" : "wheel")).v] = rate;
  return y;
}

/// The whirl of tilts a and b, as complex amplitudes.
WhirlOfMode whirl_of(bool on_shaft, double rate, double frequency, std::complex<double> a,
                     std::complex<double> b) {
  const BodyTree tree = disc(on_shaft);
  const auto bodies = spinning_bodies(tree, spinning_at(tree, rate, on_shaft));
  Eigen::VectorXcd shape = Eigen::VectorXcd::Zero(2 * tree.rates());
  const int first = tree.place(tree.index("tilt")).v;
  shape[first] = a;
  shape[first + 1] = b;
  return whirl(bodies, frequency, shape);
}

constexpr std::complex<double> i(0, 1);

}  // namespace

BOOST_AUTO_TEST_SUITE(whirl_of_a_disc)

// The tip moves to x = b, y = -a: it circles about +z if x = 1 and y = -i.
BOOST_AUTO_TEST_CASE(has_the_sense_of_the_spin) {
  BOOST_TEST((whirl_of(false, 5, 2, i, 1).sense == Whirl::forward));
  BOOST_TEST((whirl_of(false, -5, 2, i, 1).sense == Whirl::backward));
  BOOST_TEST((whirl_of(false, 5, 2, -i, 1).sense == Whirl::backward));
  BOOST_TEST((whirl_of(false, 5, 2, 1, 1).sense == Whirl::plane));
  BOOST_TEST((whirl_of(false, 0, 2, i, 1).sense == Whirl::plane));
  BOOST_TEST((whirl_of(false, 5, 2, 0, 0).sense == Whirl::none));
}

// An ellipse with semi-axes 1 and q has the circulation 2 q/(1 + q^2).
BOOST_AUTO_TEST_CASE(on_an_ellipse_has_its_circulation) {
  for (const double q : {0.1, 0.5, 0.9}) {
    const double c = whirl_of(false, 5, 2, q * i, 1).circulation;
    BOOST_TEST(std::abs(c - 2 * q / (1 + q * q)) < 1e-15);
  }
}

// On a shaft that turns with W a circle of the frequency w has W + w or W - w against the guide.
BOOST_AUTO_TEST_CASE(on_a_shaft_is_seen_from_the_guide) {
  const WhirlOfMode along = whirl_of(true, 5, 2, i, 1);
  const WhirlOfMode slow = whirl_of(true, 5, 2, -i, 1);
  const WhirlOfMode against = whirl_of(true, 5, 7, -i, 1);
  BOOST_TEST(std::abs(along.frequency - 7) < 1e-14);
  BOOST_TEST(std::abs(slow.frequency - 3) < 1e-14);
  BOOST_TEST(std::abs(against.frequency + 2) < 1e-14);
  BOOST_TEST((along.sense == Whirl::forward && slow.sense == Whirl::forward));
  BOOST_TEST((against.sense == Whirl::backward));
}

// Both points of the axis have the mass, its centre, and the moment across the axis.
BOOST_AUTO_TEST_CASE(weighs_bodies_by_mass_and_moment) {
  const BodyTree tree = disc(false);
  const auto bodies = spinning_bodies(tree, spinning_at(tree, 5, false));
  BOOST_TEST_REQUIRE(bodies.size() == 1U);
  const auto tilt = tree.place(tree.index("tilt")).v;
  double moment = 0;
  for (int end = 0; end < 2; ++end) {
    moment +=
        bodies[0].half_mass * bodies[0].displacement.col(tilt).segment<3>(3 * end).squaredNorm();
  }
  BOOST_TEST(std::abs(moment - (2 + 4 * 0.25)) < 1e-14);
}

BOOST_AUTO_TEST_SUITE_END()

BOOST_AUTO_TEST_SUITE(sweep_over_the_speed)

namespace {

/// A rotor with w^2 -+ 2 g W w - 1 = 0 for its forward and backward mode, and a third mode whose
/// growth is W - limit.
std::vector<WhirlingMode> modes_at(double W, double g, double limit) {
  std::vector<WhirlingMode> modes(3);
  for (int k = 0; k < 2; ++k) {
    const double sense = k == 0 ? 1 : -1;
    const double w = std::sqrt(1 + g * g * W * W) + sense * g * W;
    modes[static_cast<std::size_t>(k)].root = {-0.5, w};
    modes[static_cast<std::size_t>(k)].shape = Eigen::Vector3cd(1, -sense * i, 0).normalized();
    modes[static_cast<std::size_t>(k)].whirl = {k == 0 ? Whirl::forward : Whirl::backward, sense,
                                                sense * w};
  }
  modes[2].root = {W - limit, 20};
  modes[2].shape = Eigen::Vector3cd(0, 0, 1);
  modes[2].whirl.frequency = 20;
  for (WhirlingMode& mode : modes) mode.error = 1e-14;
  return modes;
}

}  // namespace

// n W = sqrt(1 + g^2 W^2) +- g W:  W = 1/sqrt(n^2 -+ 2 n g).
BOOST_AUTO_TEST_CASE(finds_critical_speeds_of_all_orders) {
  const double g = 0.3;
  const auto sweep =
      rotor_sweep([&](double W) { return modes_at(W, g, 100); }, {0, 1, 2, 3}, {.orders = {1, 2}});
  std::vector<double> wanted;
  for (const double n : {1.0, 2.0}) {
    for (const double sense : {1.0, -1.0})
      wanted.push_back(1 / std::sqrt(n * n - sense * 2 * n * g));
  }
  std::sort(wanted.begin(), wanted.end());
  BOOST_TEST_REQUIRE(sweep.critical.size() == 4U);
  for (std::size_t k = 0; k < 4; ++k) {
    BOOST_TEST(std::abs(sweep.critical[k].speed / wanted[k] - 1) < 1e-10);
  }
}

BOOST_AUTO_TEST_CASE(finds_where_motions_begin_to_grow) {
  const auto sweep =
      rotor_sweep([](double W) { return modes_at(W, 0.3, 1.7); }, {0, 1, 2, 3}, {.orders = {1}});
  BOOST_TEST_REQUIRE(sweep.limits.size() == 1U);
  BOOST_TEST(std::abs(sweep.limits[0].speed - 1.7) < 1e-9);
  BOOST_TEST(sweep.limits[0].begins);
  const auto back =
      rotor_sweep([](double W) { return modes_at(W, 0.3, 1.7); }, {3, 2, 1, 0}, {.orders = {1}});
  BOOST_TEST_REQUIRE(back.limits.size() == 1U);
  BOOST_TEST(!back.limits[0].begins);
}

// A speed of the sweep may be a critical speed itself.
BOOST_AUTO_TEST_CASE(finds_a_critical_speed_of_its_list) {
  const auto sweep =
      rotor_sweep([](double W) { return modes_at(W, 0, 100); }, {0, 1, 2}, {.orders = {1}});
  BOOST_TEST(sweep.critical.size() == 2U);
  for (const auto& one : sweep.critical) BOOST_TEST(one.speed == 1);
}

BOOST_AUTO_TEST_CASE(refuses_orders_and_speeds_that_are_none) {
  const auto modes = [](double W) { return modes_at(W, 0.3, 100); };
  BOOST_CHECK_THROW((void)rotor_sweep(modes, {0, 1}, {.orders = {0}}), InvalidInput);
  BOOST_CHECK_THROW((void)rotor_sweep(modes, {0, 1, 1}), InvalidInput);
  BOOST_CHECK_THROW((void)rotor_sweep(modes, {0, 2, 1}), InvalidInput);
}

BOOST_AUTO_TEST_SUITE_END()
