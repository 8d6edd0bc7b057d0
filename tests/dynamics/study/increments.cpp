// Increments of inertial units against closed forms of coning, sculling and spin.

#include <Eigen/Geometry>
#include <boost/math/special_functions/bessel.hpp>
#include <boost/test/unit_test.hpp>

#include <cmath>
#include <numbers>
#include <vector>

#include <dynamics/study/increments.hpp>

using namespace kreisel;

namespace {

using Vector = Vector3<double>;

double off(const Vector& found, const Vector& expected) { return (found - expected).norm(); }

Eigen::Quaterniond rotation_of(const Vector& vector) {
  return Eigen::Quaterniond(Eigen::AngleAxisd(vector.norm(), vector.normalized()));
}

/// The attitude (cos a/2; sin a/2 cos wt, sin a/2 sin wt, 0), whose rate on its own axes is
/// w (-sin a sin wt, sin a cos wt, -2 sin^2 a/2).
struct Coning {
  double a;
  double w;

  [[nodiscard]] Eigen::Quaterniond attitude(double t) const {
    const double s = std::sin(a / 2);
    return {std::cos(a / 2), s * std::cos(w * t), s * std::sin(w * t), 0};
  }
  [[nodiscard]] Vector axis_angle(double t) const {  // integral of the rate
    const double s = std::sin(a / 2);
    return {std::sin(a) * std::cos(w * t), std::sin(a) * std::sin(w * t), -2 * w * s * s * t};
  }
  InertialReading operator()(double t) const {
    const double s = std::sin(a / 2);
    return {w * Vector(-std::sin(a) * std::sin(w * t), std::sin(a) * std::cos(w * t), -2 * s * s)};
  }
};

}  // namespace

BOOST_AUTO_TEST_SUITE(increments_in_closed_form)

BOOST_AUTO_TEST_CASE(attitude_and_angle_in_coning) {
  for (const Coning& coning : {Coning{0.1, 3}, Coning{1e-3, 30}, Coning{1, 12}, Coning{2.5, 100}}) {
    for (const double period : {1e-3, 0.01, 0.2}) {
      const double begin = 0.3;
      const double end = begin + period;
      const Increments found = increments(coning, begin, end);
      const Eigen::Quaterniond turn = coning.attitude(begin).conjugate() * coning.attitude(end);
      const double size = coning(begin).angular_velocity.norm() * period;
      const Eigen::Quaterniond by = rotation_of(found.rotation);
      const double same = turn.dot(by) < 0 ? -1 : 1;
      BOOST_TEST((by.coeffs() - same * turn.coeffs()).norm() <= 1e-15 + 1e-14 * size);
      const Vector angle = coning.axis_angle(end) - coning.axis_angle(begin);
      BOOST_TEST(off(found.angle, angle) <= 1e-15 * coning.a + 1e-14 * size);
      BOOST_TEST(found.velocity.norm() == 0);
    }
  }
}

// After a whole turn of the cone the rotation is 0. The angular velocity's integral is not: its mean
// about z is -2 w sin^2 a/2.
BOOST_AUTO_TEST_CASE(whole_cone) {
  const Coning coning{0.02, 8 * std::numbers::pi};
  const Increments found = increments(coning, 0, 0.25);
  BOOST_TEST(found.rotation.norm() <= 1e-13 * 2 * std::numbers::pi * coning.a);
  const double drift = -4 * std::numbers::pi * std::pow(std::sin(coning.a / 2), 2);
  BOOST_TEST(off(found.angle, {0, 0, drift}) <= 1e-13 * 2 * std::numbers::pi * coning.a);
}

// theta = A sin wt about x, f = B sin wt along y:  in a whole turn B J1(A) 2 pi/w along z.
BOOST_AUTO_TEST_CASE(velocity_in_sculling) {
  const double w = 10;
  const double cycle = 2 * std::numbers::pi / w;
  for (const double A : {1e-4, 0.05, 0.8}) {
    const double B = 9.5;
    const auto reading = [&](double t) {
      return InertialReading{{A * w * std::cos(w * t), 0, 0}, {0, B * std::sin(w * t), 0}};
    };
    const Increments found = increments(reading, 0, cycle);
    const Vector expected(0, 0, B * boost::math::cyl_bessel_j(1, A) * cycle);
    BOOST_TEST(off(found.velocity, expected) <= 1e-14 * B * cycle);
    BOOST_TEST(found.force.norm() <= 1e-14 * B * cycle);
    BOOST_TEST(found.rotation.norm() <= 1e-14 * A * w * cycle);
  }
}

// A spin of many turns: the rotation vector is the angle, and f on fixed axes gives f t.
BOOST_AUTO_TEST_CASE(spin_of_many_turns) {
  const Vector axis = Vector(1, -2, 2) / 3;
  const double spin = 1000;
  const Vector f(1, 2, 3);
  const auto reading = [&](double t) {
    return InertialReading{spin * axis, Eigen::AngleAxisd(-spin * t, axis) * f};
  };
  const Increments found = increments(reading, 0, 0.1);
  BOOST_TEST(off(found.rotation, 100 * axis) <= 1e-14 * 100);
  BOOST_TEST(off(found.angle, 100 * axis) <= 1e-14 * 100);
  BOOST_TEST(off(found.velocity, 0.1 * f) <= 1e-14 * 0.1 * f.norm() * 100);
}

// Earth rate in a short period: 16 digits of a rotation of 1e-7 rad.
BOOST_AUTO_TEST_CASE(slow_rates_keep_their_digits) {
  const Vector rate(7.2921e-5, -3e-5, 1e-6);
  const auto reading = [&](double) { return InertialReading{rate, {0, 0, 9.8}}; };
  const Increments found = increments(reading, 5, 5.0078125);
  BOOST_TEST(off(found.rotation, rate * 0.0078125) <= 1e-15 * rate.norm() * 0.0078125);
  BOOST_TEST(off(found.angle, rate * 0.0078125) <= 1e-15 * rate.norm() * 0.0078125);
}

BOOST_AUTO_TEST_CASE(readings_that_jump) {
  const double jump = 0.37;
  const auto reading = [&](double t) {
    return InertialReading{{0, 0, t < jump ? 0.5 : -2}, {t < jump ? 1.0 : 3.0, 0, 0}};
  };
  const Increments found = increments(reading, 0, 1, std::vector{jump});
  const double angle = 0.5 * jump - 2 * (1 - jump);
  BOOST_TEST(off(found.rotation, {0, 0, angle}) <= 4e-15);
  BOOST_TEST(off(found.force, {jump + 3 * (1 - jump), 0, 0}) <= 4e-15);
  // Rotates at 0.5 rad/s up to the jump, then at -2 rad/s back through the angle there.
  const double top = 0.5 * jump;
  const auto x = [&] { return std::sin(top) / 0.5 + 1.5 * (std::sin(top) - std::sin(angle)); };
  const auto y = [&] {
    return (1 - std::cos(top)) / 0.5 + 1.5 * (std::cos(angle) - std::cos(top));
  };
  BOOST_TEST(off(found.velocity, {x(), y(), 0}) <= 4e-15 * 3);
}

BOOST_AUTO_TEST_SUITE_END()
