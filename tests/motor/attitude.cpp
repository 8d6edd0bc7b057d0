#include <boost/multiprecision/cpp_bin_float.hpp>
#include <boost/test/data/monomorphic.hpp>
#include <boost/test/data/test_case.hpp>
#include <boost/test/unit_test.hpp>

#include <cmath>
#include <numbers>

#include <motor/attitude.hpp>
#include <motor/displacement.hpp>

#include <support/cast.hpp>
#include <support/near.hpp>
#include <support/sample.hpp>

using namespace kreisel;
using test::near;
namespace data = boost::unit_test::data;

namespace {

using Digits50 = boost::multiprecision::cpp_bin_float_50;

/// The rotation of a quaternion of any norm, in 50 digits.
Matrix3<Digits50> rotation(const Eigen::Quaterniond& q) {
  return Pose<Digits50>::from(q.cast<Digits50>()).rotation;
}

}  // namespace

BOOST_AUTO_TEST_SUITE(an_attitude)

// Turns from 1e-12 to 30 rad, against the exponential in 50 digits.
BOOST_DATA_TEST_CASE(is_turned_by_the_exponential, data::xrange(300u), seed) {
  test::Sample sample(seed);
  const Eigen::Quaterniond q(sample.rotation());
  const Vector3<double> w = sample.magnitude(-12, 1.5) * sample.direction();
  const Matrix3<Digits50> exact =
      rotation(q) * exp(Motor<Digits50>{test::cast<Digits50>(w), {}}).rotation;
  const Matrix3<double> found = Pose<double>::from(rotated(q, w)).rotation;
  // The sine and cosine of the rotation contain the rounding of their argument |w|.
  BOOST_TEST(near(found, test::cast<double>(exact), std::max(1.0, w.norm()), 12));
}

// The requirement of strapdown computations: 1e6 equal rotations, 2700 rad in all. The attitude's
// error is below a random walk of 1u a step, 1.1e-13, and the norm's below 1e-9.
BOOST_AUTO_TEST_CASE(does_not_drift_in_a_million_turns) {
  const Vector3<double> w(0.001, -0.002, 0.0015);
  constexpr int n = 1000000;
  Eigen::Quaterniond q = Eigen::Quaterniond::Identity();
  for (int i = 0; i < n; ++i) q = rotated(q, w);
  const Vector3<Digits50> whole = test::cast<Digits50>(w) * Digits50(n);
  const Matrix3<Digits50> exact = exp(Motor<Digits50>{whole, {}}).rotation;
  const Matrix3<Digits50> off = exact.transpose() * rotation(q);
  const double error = double(log(Pose<Digits50>{off}).resultant.norm());
  BOOST_TEST_MESSAGE("attitude off by " << error << " rad, norm by " << q.norm() - 1);
  BOOST_TEST(error < 1.1e-13);
  BOOST_TEST(std::abs(q.norm() - 1) < 1e-9);
}

BOOST_AUTO_TEST_SUITE_END()

BOOST_AUTO_TEST_SUITE(aerospace_angles)

BOOST_DATA_TEST_CASE(come_back_from_their_rotation, data::xrange(200u), seed) {
  test::Sample sample(seed);
  constexpr double pi = std::numbers::pi;
  const YawPitchRoll<double> a{sample.uniform(-pi, pi), sample.uniform(-1.4, 1.4),
                               sample.uniform(-pi, pi)};
  const auto b = YawPitchRoll<double>::of(a.rotation());
  BOOST_TEST(near(b.pitch, a.pitch, 1.0, 8, "pitch "));
  BOOST_TEST(near(b.yaw, a.yaw, pi / std::cos(a.pitch), 4, "yaw "));
  BOOST_TEST(near(b.roll, a.roll, pi / std::cos(a.pitch), 4, "roll "));
}

// At pitch +-90 degrees only yaw -+ roll is defined: the angles may differ, the rotation must not.
BOOST_DATA_TEST_CASE(describe_the_rotation_at_the_poles, data::xrange(200u), seed) {
  test::Sample sample(seed);
  const double distance = sample.once_in(3) ? 0 : sample.magnitude(-17, -3);
  const double pitch = (std::numbers::pi / 2 - distance) * (sample.once_in(2) ? 1 : -1);
  const Matrix3<double> R =
      YawPitchRoll<double>{sample.uniform(-3, 3), pitch, sample.uniform(-3, 3)}.rotation();
  BOOST_TEST(near(YawPitchRoll<double>::of(R).rotation(), R, 1.0, 16));
}

// Nose up by 90 degrees from level north: the body's x axis points up, which is -z of level axes.
BOOST_AUTO_TEST_CASE(pitch_the_nose_up) {
  const Matrix3<double> R = YawPitchRoll<double>{0, std::numbers::pi / 2, 0}.rotation();
  BOOST_TEST(near(Vector3<double>(R.col(0)), Vector3<double>(0, 0, -1), 1.0, 2));
}

BOOST_AUTO_TEST_SUITE_END()
