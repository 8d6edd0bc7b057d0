#include <boost/test/data/monomorphic.hpp>
#include <boost/test/data/test_case.hpp>
#include <boost/test/unit_test.hpp>

#include <cmath>
#include <iostream>
#include <limits>
#include <string>

#include <dynamics/exact/free_top.hpp>

#include <support/near.hpp>
#include <support/sample.hpp>
#include <support/top_truth.hpp>
#include <support/worst.hpp>

namespace data = boost::unit_test::data;
using namespace kreisel;
using exact::FreeTop;

namespace {

constexpr double u = 0x1p-53;

// The result is rounded once: sqrt(4) u/2 in the quaternion, twice that in the angle. The inner
// calculation with 64 bits may add as much if the phase grows to 1e3.
constexpr double rounded = 4 * u;

const Eigen::Quaterniond anyhow(0.3, -0.5, 0.7, 1.1);

struct Errors {
  double attitude = 0;
  double rate = 0;  ///< relative

  void take(const test::TopTruth& truth, const exact::TopMotion& motion) {
    attitude = test::worst_of(attitude, truth.attitude_error(motion.attitude));
    rate = test::worst_of(
        rate, truth.rate_error(motion.angular_velocity) / motion.angular_velocity.norm());
  }
};

/// At 8 times up to the last, whose eighth should be a double.
Errors errors(const Vector3<double>& moments, const Vector3<double>& omega0, double last) {
  const FreeTop top(moments, omega0, anyhow);
  test::TopTruth truth(moments, Vector3<double>::Zero(), 0, omega0, anyhow);
  Errors worst;
  worst.take(truth, top.at(0));
  for (int i = 1; i <= 8; ++i) {
    truth.advance(last / 8);
    worst.take(truth, top.at(i * (last / 8)));
  }
  return worst;
}

/// A body of four masses on each axis: moments b + c, c + a, a + b.
Vector3<double> moments(test::Sample& sample) {
  const double a = sample.magnitude(-2, 0);
  const double b = sample.magnitude(-2, 0);
  const double c = sample.magnitude(-2, 0);
  return {b + c, c + a, a + b};
}

}  // namespace

BOOST_AUTO_TEST_SUITE(free_top)

// Random bodies and rates fall on both sides of the separatrix and on all axes in any order.
BOOST_DATA_TEST_CASE(motion_agrees_with_the_taylor_series, data::xrange(40u), seed) {
  test::Sample sample(seed);
  const Vector3<double> I = moments(sample);
  const Vector3<double> omega = sample.direction();
  const Errors worst = errors(I, omega, seed % 2 == 0 ? 8 : -8);
  BOOST_TEST(worst.attitude <= rounded);
  BOOST_TEST(worst.rate <= rounded);
}

// 100 s of Dzhanibekov's nut. The angular velocity passes the saddle up to ten times and leaves it
// according to the last digit of L^2 - 2 E I2 = 2 eps^2.
BOOST_DATA_TEST_CASE(motion_near_the_separatrix_keeps_its_digits,
                     data::make({1e-3, 1e-5, 1e-8, 1e-12}), eps) {
  const Errors worst = errors({1, 2, 3}, {eps, 2, eps}, 100);
  BOOST_TEST(worst.attitude <= rounded);
  BOOST_TEST(worst.rate <= rounded);
  std::cout << "near the separatrix: eps " << eps << " attitude " << worst.attitude << " rad, rate "
            << worst.rate << '\n';
}

// Here L^2 - 2 E I2 = 6 (omega3^2 - omega1^2) is a small difference of large numbers.
BOOST_DATA_TEST_CASE(distance_from_the_separatrix_is_exact,
                     data::make({-1e-6, 1e-9, -1e-13, 1e-15}), distance) {
  const Errors worst = errors({2, 5, 6}, {1, 0.3, 1 + distance}, 128);
  BOOST_TEST(worst.attitude <= rounded);
  BOOST_TEST(worst.rate <= rounded);
}

BOOST_AUTO_TEST_CASE(separatrix_ends_at_the_middle_axis) {
  const Errors worst = errors({2, 5, 6}, {-1, 0.3, 1}, 16);
  BOOST_TEST(worst.attitude <= rounded);
  BOOST_TEST(worst.rate <= rounded);
  const FreeTop top({2, 5, 6}, {-1, 0.3, 1}, anyhow);
  BOOST_TEST(std::isinf(top.period()));
  const Vector3<double> end = top.at(1e6).angular_velocity;
  BOOST_TEST(end.x() == 0);
  BOOST_TEST(end.z() == 0);
  BOOST_TEST(std::abs(end.y()) == top.momentum() / 5, boost::test_tools::tolerance(4 * u));
}

BOOST_DATA_TEST_CASE(motion_after_1e4_periods_keeps_its_digits, data::xrange(12u), seed) {
  test::Sample sample(seed);
  const Vector3<double> I = moments(sample);
  const Vector3<double> omega(sample.uniform(0.1, 1), sample.uniform(0.1, 1),
                              sample.uniform(0.1, 1));
  const FreeTop top(I, omega, anyhow);
  const double time = 1e4 * top.period() + 1;
  test::TopTruth truth(I, Vector3<double>::Zero(), 0, omega, anyhow);
  truth.advance_far(time, top.period());
  Errors worst;
  worst.take(truth, top.at(time));
  // The phase and the angle about L, which grows like L t/I1, have relative errors of some 2^-69.
  const double angle = top.momentum() / I.minCoeff() * time;
  BOOST_TEST(worst.attitude <= rounded + 0x1p-67 * angle);
  BOOST_TEST(worst.rate <= rounded + 0x1p-67 * angle);
  std::cout << "1e4 periods: attitude " << worst.attitude << " rad, rate " << worst.rate
            << ", angle " << angle << " rad\n";
}

BOOST_AUTO_TEST_CASE(motion_after_1e6_seconds_keeps_its_digits) {
  const FreeTop top({1, 2, 3}, {1e-3, 2, 1e-3}, anyhow);
  test::TopTruth truth({1, 2, 3}, Vector3<double>::Zero(), 0, {1e-3, 2, 1e-3}, anyhow);
  truth.advance_far(1e6, top.period());
  Errors worst;
  worst.take(truth, top.at(1e6));
  BOOST_TEST(worst.attitude <= 0x1p-67 * 4e6);
  std::cout << "1e6 s: attitude " << worst.attitude << " rad, rate " << worst.rate << '\n';
}

BOOST_AUTO_TEST_CASE(rotation_about_principal_axes_is_steady) {
  for (int axis = 0; axis < 3; ++axis) {
    const Vector3<double> omega = -0.7 * Vector3<double>::Unit(axis);
    const FreeTop top({2, 5, 6}, omega, anyhow);
    test::TopTruth truth({2, 5, 6}, Vector3<double>::Zero(), 0, omega, anyhow);
    truth.advance(16);
    BOOST_TEST(test::same(top.at(1e9).angular_velocity, omega));
    BOOST_TEST(truth.attitude_error(top.at(16).attitude) <= rounded);
    BOOST_TEST(top.period() == 0);
  }
}

BOOST_AUTO_TEST_CASE(spheres_and_bodies_at_rest_are_steady) {
  const Vector3<double> omega(1, -2, 0.5);
  BOOST_TEST(test::same(FreeTop({2, 2, 2}, omega, anyhow).at(1e9).angular_velocity, omega));
  BOOST_TEST(errors({2, 2, 2}, omega, 16).attitude <= rounded);
  const FreeTop rest({1, 2, 3}, {0, 0, 0}, anyhow);
  BOOST_TEST(test::same(rest.at(1e9).attitude.coeffs(), rest.at(0).attitude.coeffs()));
}

// Axis of symmetry on each body axis, flat and long, exactly and to 1e-15: one formula for all.
BOOST_DATA_TEST_CASE(symmetric_bodies_need_no_special_case,
                     data::xrange(3) * data::make({1.0, 1 + 1e-15, 1 - 1e-15}) *
                         data::make({1.0, 3.0}),
                     axis, nearly, along) {
  Vector3<double> I(2, 2 * nearly, 2);
  I[axis] = along;
  const Errors worst = errors(I, {0.5, -0.2, -2}, 16);
  BOOST_TEST(worst.attitude <= rounded);
  BOOST_TEST(worst.rate <= rounded);
}

BOOST_AUTO_TEST_CASE(tiny_rates_do_not_vanish) {
  const FreeTop top({1, 2, 3}, {1, 2, 0.5}, anyhow);
  const FreeTop slow({1, 2, 3}, Vector3<double>(1, 2, 0.5) * 0x1p-600, anyhow);
  BOOST_TEST(test::same(slow.at(0x1p602).attitude.coeffs(), top.at(4).attitude.coeffs()));
}

BOOST_AUTO_TEST_CASE(energy_and_momentum_are_correct) {
  const FreeTop top({1, 2, 3}, {3, -2, 1}, anyhow);
  BOOST_TEST(top.energy() == 10);
  BOOST_TEST(top.momentum() == std::sqrt(34.0));
}

BOOST_AUTO_TEST_CASE(invalid_arguments_are_refused) {
  const auto message = [](const Vector3<double>& I, const Vector3<double>& omega,
                          const Eigen::Quaterniond& q) -> std::string {
    try {
      (void)FreeTop(I, omega, q);
    } catch (const InvalidInput& error) {
      return error.what();
    }
    return "nothing was thrown";
  };
  const double nan = std::nan("");
  BOOST_TEST(message({0, 2, 2}, {1, 1, 1}, anyhow) ==
             "moments.x = 0 must be a finite number above 0");
  BOOST_TEST(message({1, -2, 2}, {1, 1, 1}, anyhow).starts_with("moments.y = -2 "));
  BOOST_TEST(message({1, 2, nan}, {1, 1, 1}, anyhow).starts_with("moments.z = nan "));
  BOOST_TEST(message({1, 2, 3.5}, {1, 1, 1}, anyhow) ==
             "the largest moment = 3.5 must not exceed the sum of the other two");
  BOOST_TEST(message({1, 2, 3}, {1, nan, 1}, anyhow) == "omega0.y = nan must be finite");
  BOOST_TEST(message({1, 2, 3}, {1, 1, 1}, Eigen::Quaterniond(0, 0, 0, 0)) ==
             "|attitude0| = 0 must be a finite number above 0");
  BOOST_TEST(message({1, 2, 3 + 1e-12}, {1, 1, 1}, anyhow) == "nothing was thrown");
  BOOST_CHECK_THROW(
      (void)FreeTop({1, 2, 3}, {1, 1, 1}, anyhow).at(std::numeric_limits<double>::infinity()),
      InvalidInput);
}

BOOST_AUTO_TEST_SUITE_END()
