#include <boost/test/data/monomorphic.hpp>
#include <boost/test/data/test_case.hpp>
#include <boost/test/unit_test.hpp>

#include <cmath>
#include <string>

#include <dynamics/exact/free_top.hpp>
#include <dynamics/exact/gyrostat.hpp>

#include <support/near.hpp>
#include <support/sample.hpp>
#include <support/top_truth.hpp>

namespace data = boost::unit_test::data;
using namespace kreisel;
using exact::SymmetricGyrostat;

namespace {

constexpr double u = 0x1p-53;

// The result is rounded once: sqrt(4) u/2 in the quaternion, twice that in the angle. The inside
// has 64 bits.
constexpr double rounded = 4 * u;

const Eigen::Quaterniond anyhow(0.3, -0.5, 0.7, 1.1);

}  // namespace

BOOST_AUTO_TEST_SUITE(symmetric_gyrostat)

BOOST_DATA_TEST_CASE(motion_is_that_of_the_taylor_series, data::xrange(30u), seed) {
  test::Sample sample(seed);
  const double A = sample.uniform(0.5, 2);
  const double C = sample.uniform(0.1, 2) * A;
  const double rotor = sample.uniform(-10, 10);
  const Vector3<double> omega(sample.uniform(-2, 2), sample.uniform(-2, 2), sample.number(-1, 1));
  const SymmetricGyrostat top(A, C, rotor, omega, anyhow);
  test::TopTruth truth({A, A, C}, {0, 0, rotor}, 0, omega, anyhow);
  for (int i = 0; i < 8; ++i) {
    const auto motion = top.at(i * -0.75);
    BOOST_TEST(truth.attitude_error(motion.attitude) <= rounded);
    BOOST_TEST(truth.rate_error(motion.angular_velocity) <= rounded * omega.norm());
    truth.advance(-0.75);
  }
}

BOOST_AUTO_TEST_CASE(motion_after_1e4_periods_keeps_its_digits) {
  const SymmetricGyrostat top(2, 3, -4, {1, 2, 0.5}, anyhow);
  test::TopTruth truth({2, 2, 3}, {0, 0, -4}, 0, {1, 2, 0.5}, anyhow);
  truth.advance_far(4e4, top.period());
  BOOST_TEST(truth.attitude_error(top.at(4e4).attitude) <= 4 * 0x1p-64 * 1e5 + rounded);
}

// The two programs share no formula for the attitude.
BOOST_AUTO_TEST_CASE(gyrostat_with_its_rotor_at_rest_is_a_free_top) {
  const SymmetricGyrostat gyrostat(2, 3, 0, {1, 2, 0.5}, anyhow);
  const exact::FreeTop top({2, 2, 3}, {1, 2, 0.5}, anyhow);
  BOOST_TEST(std::abs(gyrostat.period() / top.period() - 1) <= 2 * u);
  for (const double time : {-7.0, 0.5, 100.0}) {
    const auto a = gyrostat.at(time);
    const auto b = top.at(time);
    BOOST_TEST(std::abs(a.attitude.dot(b.attitude)) >= 1 - rounded);
    BOOST_TEST((a.attitude.conjugate() * b.attitude).vec().norm() <= rounded);
    BOOST_TEST((a.angular_velocity - b.angular_velocity).norm() <= rounded * 3);
  }
}

// (A - C) omega3 = h: to the body its rotor makes up for the moment it lacks.
BOOST_AUTO_TEST_CASE(rotor_can_make_any_rotation_steady) {
  const Vector3<double> omega(1, -2, 0.5);
  const SymmetricGyrostat top(2, 1, 0.5, omega, anyhow);
  BOOST_TEST(test::same(top.at(1e9).angular_velocity, omega));
  BOOST_TEST(std::isinf(top.period()));
}

BOOST_AUTO_TEST_CASE(other_arguments_are_refused) {
  BOOST_CHECK_EXCEPTION(
      (void)SymmetricGyrostat(1, 1, std::nan(""), {1, 1, 1}, anyhow), InvalidInput,
      [](const auto& error) { return std::string(error.what()) == "rotor = nan must be finite"; });
  BOOST_CHECK_THROW((void)SymmetricGyrostat(1, 3, 1, {1, 1, 1}, anyhow), InvalidInput);
  BOOST_CHECK_THROW((void)SymmetricGyrostat(1, 1, 1, {1, 1, 1}, anyhow).at(std::nan("")),
                    InvalidInput);
}

BOOST_AUTO_TEST_SUITE_END()
