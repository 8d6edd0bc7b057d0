#include <boost/test/data/monomorphic.hpp>
#include <boost/test/data/test_case.hpp>
#include <boost/test/unit_test.hpp>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <limits>
#include <string>
#include <vector>

#include <dynamics/exact/lagrange_top.hpp>

#include <support/near.hpp>
#include <support/sample.hpp>
#include <support/top_truth.hpp>
#include <support/worst.hpp>

namespace data = boost::unit_test::data;
using namespace kreisel;
using exact::LagrangeTop;

namespace {

constexpr double u = 0x1p-53;

// The result is rounded once: sqrt(4) u/2 in the quaternion, twice that in the angle. The inner
// calculation with 64 bits may add as much if the phase grows to 1e3.
constexpr double rounded = 4 * u;

const Eigen::Quaterniond anyhow(0.3, -0.5, 0.7, 1.1);
const Eigen::Quaterniond upright(1, 0, 0, 0);
const Eigen::Quaterniond hanging(0, 1, 0, 0);

struct Case {
  const char* name;
  double A, C, weight_moment;
  Vector3<double> omega;
  Eigen::Quaterniond attitude;

  friend std::ostream& operator<<(std::ostream& out, const Case& c) { return out << c.name; }
};

struct Errors {
  double attitude = 0;
  double rate = 0;
  double fastest = 0;

  void take(const test::TopTruth& truth, const exact::TopMotion& motion) {
    attitude = test::worst_of(attitude, truth.attitude_error(motion.attitude));
    rate = test::worst_of(rate, truth.rate_error(motion.angular_velocity));
    fastest = std::max(fastest, motion.angular_velocity.norm());
  }
};

/// Total angle of all phases in a time. Their relative error is some 2^-69 of this angle and of the
/// angle of one nutation, because they are counted from a turning point.
double angle(const Case& c, double time) {
  return (c.omega.norm() * (1 + c.C / c.A) + std::sqrt(4 * c.weight_moment / c.A)) * time;
}

/// At 16 times up to the last, whose sixteenth should be a double.
Errors errors(const Case& c, double last) {
  const LagrangeTop top(c.A, c.C, c.weight_moment, c.omega, c.attitude);
  test::TopTruth truth({c.A, c.A, c.C}, Vector3<double>::Zero(), c.weight_moment, c.omega,
                       c.attitude);
  Errors worst;
  worst.take(truth, top.at(0));
  for (int i = 1; i <= 16; ++i) {
    truth.advance(last / 16);
    worst.take(truth, top.at(i * (last / 16)));
  }
  return worst;
}

Case random_case(unsigned seed) {
  test::Sample sample(seed);
  const double A = sample.uniform(0.5, 2);
  Case c{"random",
         A,
         sample.uniform(0.1, 1.9) * A,
         sample.magnitude(-1, 1),
         {sample.uniform(-2, 2), sample.uniform(-2, 2), sample.number(-1, 1)},
         anyhow};
  for (double& q : c.attitude.coeffs()) q = sample.uniform(-1, 1);
  return c;
}

const auto cases = data::make(std::vector<Case>{
    {"cusps", 2, 1, 3, {0, 0, 9}, anyhow},
    {"flat body", 2, 3, 3, {1, 2, 0.5}, anyhow},
    {"sphere", 2, 2, 3, {1, 2, 0.5}, anyhow},
    {"almost no weight", 2, 1, 1e-20, {1, 2, 5}, anyhow},
    {"almost without tilt", 2, 1, 3, {0, 0, 9}, {1, 1e-9, 0, 0.2}},
    {"pendulum that swings", 2, 1, 3, {0, 0, 0}, {0.3, 1, 0, 0}},
    {"pendulum that turns over", 2, 1, 3, {3, 0, 0}, {0.3, 1, 0, 0}},
    {"pendulum pushed at its lowest point", 2, 1, 3, {1, 0, 0}, hanging},
    {"pendulum pushed at its upper rest point", 2, 1, 3, {1, 0.5, 0}, upright},
    {"pendulum let go 1e-8 off its upper rest point", 2, 1, 3, {0, 0, 0}, {1, 1e-8, 0, 0.2}},
    {"spinning, hit when upright", 2, 1, 3, {1, 0, 4}, upright},
    {"spinning slowly, hit softly when upright", 2, 1, 3, {1e-9, 0, 4}, upright},
    {"spinning fast, hit softly when upright", 2, 1, 3, {1e-9, 0, 12}, upright},
    {"spinning, hit softly when hanging", 2, 1, 3, {1e-3, 0, 4}, hanging},
    {"passing close by the vertical", 2, 1, 3, {1, 0.5, 1e-7}, {1, 1e-4, 0, 0.2}},
    {"passing very close by the vertical", 2, 1, 3, {1, 0.5, 1e-12}, {1, 1e-4, 0, 0.2}},
    {"turning over fast, 1e-11 off the vertical", 2, 1, 3, {10, 0, 1e-10}, hanging},
    {"swinging with hardly any spin", 2, 1, 3, {1, 0, 1e-10}, hanging},
    {"homoclinic with spin", 2, 1, 2, {1, 1, 2}, {1, 1, 0, 0}},
    {"sleeping", 2, 1, 3, {0, 0, 4}, upright},
    {"sleeping upside down", 2, 1, 3, {0, 0, 4}, hanging},
    {"sleeping just stably", 2, 1, 3, {1e-6, 0, std::sqrt(24.0) * (1 + 1e-12)}, upright},
    {"sleeping just not stably", 2, 1, 3, {1e-6, 0, std::sqrt(24.0) * (1 - 1e-12)}, upright},
    {"spinning at sleep's limit, 1e-8 off", 2, 1, 3, {0, 0, std::sqrt(24.0)}, {1, 5e-9, 0, 0}},
    {"the same, hit softly", 2, 1, 3, {1e-9, 2e-9, std::sqrt(24.0)}, {1, 5e-9, 3e-9, 0.1}},
    {"spinning 1e-12 above it", 2, 1, 3, {0, 0, std::sqrt(24.0) * (1 + 1e-12)}, {1, 5e-9, 0, 0}},
    {"spinning 1e-12 below it", 2, 1, 3, {0, 0, std::sqrt(24.0) * (1 - 1e-12)}, {1, 5e-9, 0, 0}}});

}  // namespace

BOOST_AUTO_TEST_SUITE(lagrange_top)

BOOST_DATA_TEST_CASE(motion_agrees_with_the_taylor_series, data::xrange(24u), seed) {
  const Errors worst = errors(random_case(seed), seed % 2 == 0 ? 8 : -8);
  BOOST_TEST(worst.attitude <= rounded);
  BOOST_TEST(worst.rate <= rounded * worst.fastest);
}

BOOST_DATA_TEST_CASE(limiting_motions_keep_their_digits, cases, c) {
  // No longer: on the homoclinic motion exp(sqrt(kappa) t) consumes 50 digits.
  const Errors worst = errors(c, 16);
  const double period = LagrangeTop(c.A, c.C, c.weight_moment, c.omega, c.attitude).period();
  const double in_nutation = std::isinf(period) ? 0 : angle(c, period);
  BOOST_TEST(worst.attitude <= rounded + 0x1p-67 * in_nutation);
  BOOST_TEST(worst.rate <= rounded * worst.fastest);
  const LagrangeTop top(c.A, c.C, c.weight_moment, c.omega, c.attitude);
  BOOST_TEST(worst.attitude <= rounded + 0x1p-67 * angle(c, 16) + 0x1p-64 * top.starting_angle());
  std::cout << c.name << ": attitude " << worst.attitude << " rad, rate " << worst.rate
            << ", angle at the start " << top.starting_angle() << " rad\n";
}

BOOST_DATA_TEST_CASE(motion_after_1e4_nutations_keeps_its_digits, data::xrange(8u), seed) {
  const Case c = random_case(seed);
  const LagrangeTop top(c.A, c.C, c.weight_moment, c.omega, c.attitude);
  const double time = 1e4 * top.period() + 0.5;
  test::TopTruth truth({c.A, c.A, c.C}, Vector3<double>::Zero(), c.weight_moment, c.omega,
                       c.attitude);
  truth.advance_far(time, top.period());
  Errors worst;
  worst.take(truth, top.at(time));
  const double inside = 0x1p-67 * angle(c, time);
  BOOST_TEST(worst.attitude <= rounded + inside);
  BOOST_TEST(worst.rate <= (rounded + inside) * worst.fastest);
  std::cout << "1e4 nutations: attitude " << worst.attitude << " rad, rate " << worst.rate
            << ", angle " << angle(c, time) << " rad\n";
}

// The gyro of numerics.md S2: 3000 rad/s, released at rest with tilt 0.5.
BOOST_AUTO_TEST_CASE(fast_top_keeps_its_digits_over_1600_nutations) {
  const Case c{"fast", 3e-4, 1e-4, 0.049, {0, 0, 3000}, {std::cos(0.25), std::sin(0.25), 0, 0}};
  const LagrangeTop top(c.A, c.C, c.weight_moment, c.omega, c.attitude);
  test::TopTruth truth({c.A, c.A, c.C}, Vector3<double>::Zero(), c.weight_moment, c.omega,
                       c.attitude);
  truth.advance_far(10, top.period());
  Errors worst;
  worst.take(truth, top.at(10));
  BOOST_TEST(worst.attitude <= rounded + 0x1p-67 * angle(c, 10));
  BOOST_TEST(worst.rate <= rounded * worst.fastest);
  std::cout << "fast top: attitude " << worst.attitude << " rad, rate " << worst.rate << '\n';
}

// A cos(theta) psi'^2 - L3 psi' + mgl = 0: the nutation's amplitude is the rounding of the input.
BOOST_AUTO_TEST_CASE(regular_precession_keeps_its_tilt) {
  const double tilt = 1;
  const double precession = 0.5;
  const double L3 = (3 + 2 * std::cos(tilt) * precession * precession) / precession;
  const double spin = L3 / 1;
  const Case c{"regular precession",
               2,
               1,
               3,
               {0, precession * std::sin(tilt), spin},
               {std::cos(tilt / 2), std::sin(tilt / 2), 0, 0}};
  const Errors worst = errors(c, 64);
  BOOST_TEST(worst.attitude <= rounded);
  const auto q = LagrangeTop(c.A, c.C, c.weight_moment, c.omega, c.attitude).at(1e3).attitude;
  const double cosine = 1 - 2 * (q.x() * q.x() + q.y() * q.y());
  BOOST_TEST(std::abs(cosine - std::cos(tilt)) <= 16 * u);
}

BOOST_AUTO_TEST_CASE(sleeping_top_is_steady_to_the_bit) {
  const Vector3<double> omega(0, 0, -4);
  for (const auto& q : {upright, hanging, Eigen::Quaterniond(0.6, 0, 0, 0.7)}) {
    const LagrangeTop top(2, 1, 3, omega, q);
    BOOST_TEST(test::same(top.at(1e9).angular_velocity, omega));
    BOOST_TEST(top.period() == 0);
  }
}

// Without spin, a velocity with v^2 = kappa at the lowest point leads exactly to the upper rest
// point. sqrt(6) is no double, and its last digit decides to which side the top falls.
BOOST_AUTO_TEST_CASE(homoclinic_motion_ends_upright) {
  const LagrangeTop top(3, 1, 3, {2, 0, 0}, hanging);
  BOOST_TEST(std::isinf(top.period()));
  BOOST_TEST(errors({"homoclinic", 3, 1, 3, {2, 0, 0}, hanging}, 16).attitude <= rounded);
  const auto end = top.at(1e6);
  BOOST_TEST(end.angular_velocity.norm() == 0);
  BOOST_TEST(std::abs(end.attitude.w()) == 1);
  const Errors nearly = errors({"nearly", 2, 1, 3, {std::sqrt(6), 0, 0}, hanging}, 64);
  BOOST_TEST(nearly.attitude <= rounded);
  BOOST_TEST(nearly.rate <= rounded * nearly.fastest);
}

// L3 - L_vertical and the energy both differ from the homoclinic motion by 1e-13. Relative to so
// small a distance the truth's own 1e-27 in each step matters.
BOOST_AUTO_TEST_CASE(near_homoclinic_motion_returns_in_time) {
  const Errors worst = errors({"", 2, 1, 2, {1, 1 + 1e-13, 2}, {1, 1, 0, 0}}, 64);
  BOOST_TEST(worst.attitude <= 32 * u);
}

// The axis is vertical or nearly so, tilted about x or about y. Seen from axes turned about the
// vertical, with the body's axes turned too, it is one motion.
BOOST_AUTO_TEST_CASE(motion_does_not_depend_on_the_horizontal_axes) {
  const Eigen::Quaterniond quarter(std::sqrt(0.5), 0, 0, std::sqrt(0.5));
  const auto turned = [&](const Eigen::Quaterniond& q) {
    return Eigen::Quaterniond(quarter * q * quarter.conjugate());
  };
  const Eigen::Quaterniond attitudes[] = {upright, hanging, {0, 0.6, 0, 0.8}, {0.8, 0.6, 0, 0}};
  for (const Eigen::Quaterniond& q : attitudes) {
    for (const Vector3<double>& w :
         {Vector3<double>(0.7, 0, 3), Vector3<double>(0, 0.7, 3), Vector3<double>(0, 0, 3)}) {
      const auto one = LagrangeTop(2, 1, 3, w, q).at(1.5);
      const auto other = LagrangeTop(2, 1, 3, quarter * w, turned(q)).at(1.5);
      // The rotation itself is rounded, and the motion amplifies the rounding.
      BOOST_TEST(other.attitude.angularDistance(turned(one.attitude)) <= 128 * u);
      BOOST_TEST((other.angular_velocity - quarter * one.angular_velocity).norm() <= 128 * u * 3);
    }
  }
}

BOOST_AUTO_TEST_CASE(top_without_weight_is_free) {
  const exact::FreeTop free({2, 2, 1}, {1, 2, 5}, anyhow);
  const LagrangeTop top(2, 1, 0, {1, 2, 5}, anyhow);
  BOOST_TEST(test::same(top.at(3).attitude.coeffs(), free.at(3).attitude.coeffs()));
}

BOOST_AUTO_TEST_CASE(invalid_arguments_are_refused) {
  const auto message = [](double A, double C, double weight_moment) -> std::string {
    try {
      (void)LagrangeTop(A, C, weight_moment, {1, 1, 1}, anyhow);
    } catch (const InvalidInput& error) {
      return error.what();
    }
    return "nothing was thrown";
  };
  BOOST_TEST(message(1, 2.5, 1) ==
             "the largest moment = 2.5 must not exceed the sum of the other two");
  BOOST_TEST(message(1, 0, 1) == "moments.z = 0 must be a finite number above 0");
  BOOST_TEST(message(1, 1, -1) == "weight_moment = -1 N m must be a finite number, 0 or above");
  BOOST_TEST(message(1, 1, std::nan("")).starts_with("weight_moment = nan "));
  BOOST_CHECK_THROW((void)LagrangeTop(1, 1, 1, {1, 1, 1}, anyhow).at(std::nan("")), InvalidInput);
}

BOOST_AUTO_TEST_SUITE_END()
