#include <boost/test/data/monomorphic.hpp>
#include <boost/test/data/test_case.hpp>
#include <boost/test/unit_test.hpp>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <limits>
#include <string>

#include <dynamics/exact/free_top.hpp>
#include <dynamics/exact/gyrostat.hpp>

#include <support/near.hpp>
#include <support/sample.hpp>
#include <support/top_truth.hpp>
#include <support/worst.hpp>

namespace data = boost::unit_test::data;
using namespace kreisel;
using exact::Gyrostat;
using exact::SymmetricGyrostat;

namespace {

constexpr double u = 0x1p-53;

// The result is rounded once: sqrt(4) u/2 in the quaternion, twice that in the angle. The inner
// calculation has 64 bits.
constexpr double rounded = 4 * u;

const Eigen::Quaterniond anyhow(0.3, -0.5, 0.7, 1.1);

struct Gyro {
  Vector3<double> moments;
  Vector3<double> rotor;
  Vector3<double> omega;

  [[nodiscard]] Gyrostat exact() const { return {moments, rotor, omega, anyhow}; }
  [[nodiscard]] test::TopTruth truth() const { return {moments, rotor, 0, omega, anyhow}; }

  /// An upper limit of the angle through which L turns, relative to the body and in space.
  [[nodiscard]] double angle(double time) const {
    const double L = (moments.cwiseProduct(omega) + rotor).norm();
    return (L + rotor.norm()) / moments.minCoeff() * time;
  }

  /// True if two of the four roots are complex. As omega3 changes, energy and momentum then leave
  /// omega1 or omega2, both transverse to the rotor, without a real zero.
  [[nodiscard]] bool has_complex_roots() const {
    int k = 0;
    rotor.cwiseAbs().maxCoeff(&k);
    const int i = (k + 1) % 3;
    const int j = (k + 2) % 3;
    const auto discriminant = [&](int m, int n) {
      const double b = (moments[k] - moments[n]) * omega[k] + rotor[k];
      return moments[k] * b * b - moments[m] * (moments[k] - moments[n]) *
                                      (moments[n] - moments[m]) * omega[m] * omega[m];
    };
    return discriminant(i, j) < 0 || discriminant(j, i) < 0;
  }
};

/// The body of four masses on each axis, as in the test of FreeTop; the rotor lies on any axis.
Gyro any_gyro(unsigned seed) {
  test::Sample sample(seed);
  const double a = sample.magnitude(-2, 0);
  const double b = sample.magnitude(-2, 0);
  const double c = sample.magnitude(-2, 0);
  Gyro g{{b + c, c + a, a + b}, Vector3<double>::Zero(), {}};
  g.omega = {sample.uniform(-1, 1), sample.uniform(-1, 1), sample.uniform(-1, 1)};
  // Complex roots need a weak rotor.
  const double h = sample.magnitude(-2, 0) * g.moments.cwiseProduct(g.omega).norm();
  g.rotor[static_cast<int>(seed % 3)] = sample.once_in(2) ? h : -h;
  return g;
}

/// The same with body axes x, y, z called y, z, x.
Gyro renamed(const Gyro& g) {
  const auto shift = [](const Vector3<double>& v) { return Vector3<double>(v[2], v[0], v[1]); };
  return {shift(g.moments), shift(g.rotor), shift(g.omega)};
}

struct Errors {
  double attitude = 0;
  double rate = 0;  ///< relative to the greatest

  Errors(const Gyro& gyro, double last) {
    const Gyrostat top = gyro.exact();
    test::TopTruth truth = gyro.truth();
    double greatest = 0;
    for (int i = 0; i <= 8; ++i) {
      const auto [q, omega] = top.at(i * (last / 8));
      attitude = test::worst_of(attitude, truth.attitude_error(q));
      rate = test::worst_of(rate, truth.rate_error(omega));
      greatest = std::max(greatest, omega.norm());
      truth.advance(last / 8);
    }
    rate /= greatest;
  }
};

}  // namespace

BOOST_AUTO_TEST_SUITE(symmetric_gyrostat)

BOOST_DATA_TEST_CASE(motion_agrees_with_the_taylor_series, data::xrange(30u), seed) {
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
  BOOST_TEST(truth.attitude_error(top.at(4e4).attitude) <= 0x1p-67 * 1e5 + rounded);
}

// The two programs share no formula for the attitude.
BOOST_AUTO_TEST_CASE(rotor_at_rest_gives_the_free_top) {
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

// (A - C) omega3 = h: the rotor makes up for the moment that the body lacks.
BOOST_AUTO_TEST_CASE(a_rotor_can_make_any_rotation_steady) {
  const Vector3<double> omega(1, -2, 0.5);
  const SymmetricGyrostat top(2, 1, 0.5, omega, anyhow);
  BOOST_TEST(test::same(top.at(1e9).angular_velocity, omega));
  BOOST_TEST(std::isinf(top.period()));
}

BOOST_AUTO_TEST_CASE(invalid_arguments_are_refused) {
  BOOST_CHECK_EXCEPTION(
      (void)SymmetricGyrostat(1, 1, std::nan(""), {1, 1, 1}, anyhow), InvalidInput,
      [](const auto& error) { return std::string(error.what()) == "rotor = nan must be finite"; });
  BOOST_CHECK_THROW((void)SymmetricGyrostat(1, 3, 1, {1, 1, 1}, anyhow), InvalidInput);
  BOOST_CHECK_THROW((void)SymmetricGyrostat(1, 1, 1, {1, 1, 1}, anyhow).at(std::nan("")),
                    InvalidInput);
}

BOOST_AUTO_TEST_SUITE_END()

BOOST_AUTO_TEST_SUITE(gyrostat)

BOOST_AUTO_TEST_CASE(motion_agrees_with_the_taylor_series) {
  int complex = 0;
  double attitude = 0;
  double rate = 0;
  for (unsigned seed = 0; seed < 48; ++seed) {
    const Gyro gyro = any_gyro(seed);
    complex += gyro.has_complex_roots();
    BOOST_TEST_CONTEXT("seed " << seed) {
      const Errors worst(gyro, seed % 2 == 0 ? 8 : -8);
      BOOST_TEST(worst.attitude <= rounded);
      BOOST_TEST(worst.rate <= rounded);
      attitude = test::worst_of(attitude, worst.attitude);
      rate = test::worst_of(rate, worst.rate);
    }
  }
  BOOST_TEST(complex >= 6);
  BOOST_TEST(complex <= 42);
  std::cout << "48 bodies, " << complex << " with complex roots: attitude " << attitude
            << " rad, rate " << rate << '\n';
}

// The phase and the angle about L have relative errors of some 2^-69.
BOOST_DATA_TEST_CASE(gyrostat_after_1e4_periods_keeps_its_digits, data::xrange(12u), seed) {
  const Gyro gyro = any_gyro(seed);
  const Gyrostat top = gyro.exact();
  const double time = 1e4 * top.period() + 1;
  test::TopTruth truth = gyro.truth();
  truth.advance_far(time, top.period());
  const auto [q, omega] = top.at(time);
  const double limit = rounded + 0x1p-67 * gyro.angle(time);
  BOOST_TEST(truth.attitude_error(q) <= limit);
  BOOST_TEST(truth.rate_error(omega) <= limit * gyro.omega.norm());
  std::cout << "1e4 periods: attitude " << truth.attitude_error(q) << " rad, rate "
            << truth.rate_error(omega) / gyro.omega.norm() << ", angle " << gyro.angle(time)
            << " rad\n";
}

// C ((C - B) omega3 + h)^2 = A (C - B)(B - A) omega1^2, exactly at 0: the motion ends at omega1 =
// 0, omega3 = -h/(C - B). After 24 s the truth of 50 digits leaves that point as well.
BOOST_DATA_TEST_CASE(motion_near_a_saddle_keeps_its_digits,
                     data::make({0.0, 1e-3, -1e-6, 1e-9, -1e-12, 1e-15}) *
                         data::make({3.75, -4.25}),
                     distance, omega3) {
  Gyro gyro{{2, 4, 4.5}, {0, 0, 0.125}, {3 * (1 + distance), 1, omega3}};
  for (int axis = 0; axis < 3; ++axis) {
    const Errors worst(gyro, distance == 0 ? 24 : 64);
    BOOST_TEST(worst.attitude <= rounded);
    BOOST_TEST(worst.rate <= rounded);
    BOOST_TEST(std::isinf(gyro.exact().period()) == (distance == 0));
    gyro = renamed(gyro);
  }
}

// Equal moments transverse to a rotor that makes up for the third: any rotation is steady. A
// rotation about a transverse axis is not steady if the rotor drives it.
BOOST_AUTO_TEST_CASE(is_steady_if_its_momentum_is_constant) {
  const Vector3<double> any(1, -2, 0.5);
  BOOST_TEST(
      test::same(Gyrostat({2, 2, 1}, {0, 0, 0.5}, any, anyhow).at(1e9).angular_velocity, any));
  for (const Vector3<double>& w : {Vector3<double>(0, 1, 0), Vector3<double>(1, 0, 0)}) {
    const Gyro pushed{{2, 3, 4}, {0, 0, 0.5}, w};
    const Errors worst(pushed, 8);
    BOOST_TEST(worst.attitude <= rounded);
    BOOST_TEST(worst.rate <= rounded);
    BOOST_TEST((pushed.exact().at(1).angular_velocity - w).norm() > 0.01);
  }
}

BOOST_AUTO_TEST_CASE(separatrix_ends_at_the_saddle) {
  const Vector3<double> end =
      Gyrostat({2, 4, 4.5}, {0, 0, 0.125}, {3, 1, 3.75}, anyhow).at(1e6).angular_velocity;
  BOOST_TEST(end.x() == 0);
  BOOST_TEST(std::abs(end.z() + 0.25) <= 4 * u);
}

// The saddle on the rotor's axis: 2 E C = (|L| - h)^2 with |L| = 7, and the rates near it.
BOOST_AUTO_TEST_CASE(saddle_on_the_rotor_axis_keeps_its_digits) {
  for (const double side : {1.0, -1.0}) {
    const Gyro gyro{{2, 4, 4}, {0, 0, -2 * side}, {1, 0.75, 2 * side}};
    const Errors worst(gyro, 32);
    BOOST_TEST(worst.attitude <= rounded);
    BOOST_TEST(worst.rate <= rounded);
    BOOST_TEST(std::isinf(gyro.exact().period()));
    for (const double eps : {1e-3, 1e-8, 1e-15}) {
      const Errors near({{2, 4, 3}, {0, 0, 0.3}, {eps, eps, side}}, 100);
      BOOST_TEST(near.attitude <= rounded);
      BOOST_TEST(near.rate <= rounded);
    }
  }
}

// Nutations so small that both ends, or L and the axis, are almost one.
BOOST_DATA_TEST_CASE(near_steady_motion_keeps_its_digits, data::make({1e-3, 1e-8, 1e-15}), eps) {
  for (const Gyro& gyro :
       {Gyro{{2, 4, 3}, {0, 0, 5}, {eps, eps, 1}}, Gyro{{2, 4, 3}, {0, 0, 5}, {eps, eps, -2}},
        Gyro{{2, 4, 3}, {0, 0, 2}, {eps, 1, 2 + eps}},
        Gyro{{2, 4, 3}, {0, 0, 1}, {1, eps, -1 + eps}}}) {
    const Errors worst(gyro, 16);
    BOOST_TEST(worst.attitude <= rounded);
    BOOST_TEST(worst.rate <= rounded);
  }
}

BOOST_DATA_TEST_CASE(nearly_symmetric_bodies_keep_their_digits,
                     data::make({0.0, 1e-3, -1e-8, 1e-15}), eps) {
  for (const Gyro& gyro : {Gyro{{2, 2 + 2 * eps, 3}, {0, 0, 1}, {1, 2, 1.3}},
                           Gyro{{2, 2 + 2 * eps, 3}, {0, 0.5, 0}, {1, 2, 1.3}},
                           Gyro{{2 + 2 * eps, 2 - 2 * eps, 2}, {-0.5, 0, 0}, {1, 2, 1.3}}}) {
    const Errors worst(gyro, 16);
    BOOST_TEST(worst.attitude <= rounded);
    BOOST_TEST(worst.rate <= rounded);
  }
}

// Both formulas share nothing: one goes along omega3, the other along the axis that L circles.
BOOST_AUTO_TEST_CASE(a_weak_rotor_gives_the_free_top) {
  for (int axis = 0; axis < 3; ++axis) {
    for (const double middle : {0.1, 3.0}) {
      const Gyro gyro{{2, 3, 4}, 1e-40 * Vector3<double>::Unit(axis), {1, middle, -1.5}};
      const exact::FreeTop top(gyro.moments, gyro.omega, anyhow);
      const Gyrostat still(gyro.moments, {0, 0, 0}, gyro.omega, anyhow);
      BOOST_TEST(std::abs(gyro.exact().period() / top.period() - 1) <= 2 * u);
      BOOST_TEST(still.period() == top.period());
      for (const double time : {-7.0, 0.5, 100.0}) {
        const auto a = gyro.exact().at(time);
        const auto b = top.at(time);
        BOOST_TEST(2 * (a.attitude.conjugate() * b.attitude).vec().norm() <= 2 * rounded);
        BOOST_TEST((a.angular_velocity - b.angular_velocity).norm() <= rounded * 4);
        BOOST_TEST(test::same(still.at(time).attitude.coeffs(), b.attitude.coeffs()));
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(symmetric_bodies_give_the_symmetric_gyrostat) {
  const SymmetricGyrostat symmetric(2, 3, -4, {1, 2, 0.5}, anyhow);
  const Gyrostat any({2, 2, 3}, {0, 0, -4}, {1, 2, 0.5}, anyhow);
  BOOST_TEST(any.period() == symmetric.period());
  BOOST_TEST(test::same(any.at(9).attitude.coeffs(), symmetric.at(9).attitude.coeffs()));
  BOOST_TEST(test::same(any.at(9).angular_velocity, symmetric.at(9).angular_velocity));
}

// On an axis, and inclined if the rotor makes up for the moments: (C - B) omega3 + h = 0.
BOOST_AUTO_TEST_CASE(steady_rotations_are_exactly_steady) {
  for (Gyro gyro :
       {Gyro{{2, 5, 6}, {0, 0, 3}, {0, 0, -0.7}}, Gyro{{2, 5, 6}, {0, 0, 3}, {0, 2, -3}},
        Gyro{{2, 5, 6}, {0, 0, 3}, {2, 0, -0.75}}}) {
    for (int axis = 0; axis < 3; ++axis) {
      const Gyrostat top = gyro.exact();
      BOOST_TEST(test::same(top.at(1e9).angular_velocity, gyro.omega));
      BOOST_TEST(top.period() == 0);
      BOOST_TEST(Errors(gyro, 16).attitude <= rounded);
      gyro = renamed(gyro);
    }
  }
  BOOST_TEST(Gyrostat({2, 5, 6}, {0, 0, 3}, {1e-9, 2, -3}, anyhow).period() > 0);
}

BOOST_AUTO_TEST_CASE(tiny_rates_do_not_vanish) {
  for (const double h : {0.3, 3.0}) {
    const Gyrostat top({1, 2, 2.5}, {0, 0, h}, {1, 2, 0.5}, anyhow);
    const Gyrostat slow({1, 2, 2.5}, {0, 0, h * 0x1p-600}, Vector3<double>(1, 2, 0.5) * 0x1p-600,
                        anyhow);
    BOOST_TEST(test::same(slow.at(0x1p602).attitude.coeffs(), top.at(4).attitude.coeffs()));
  }
}

BOOST_AUTO_TEST_CASE(invalid_gyrostats_are_refused) {
  const auto message = [](const Vector3<double>& moments, const Vector3<double>& rotor,
                          const Vector3<double>& omega) -> std::string {
    try {
      (void)Gyrostat(moments, rotor, omega, anyhow);
    } catch (const InvalidInput& error) {
      return error.what();
    }
    return "nothing was thrown";
  };
  const double nan = std::nan("");
  BOOST_TEST(message({1, 2, 2.5}, {0.5, 0, -1}, {1, 1, 1}) ==
             "rotor.x = 0.5 must be 0: the rotor's axis must be one principal axis");
  BOOST_TEST(message({1, 2, 2.5}, {0, nan, 0}, {1, 1, 1}) == "rotor.y = nan must be finite");
  BOOST_TEST(message({1, 2, 2.5}, {0, 1, 0}, {1, nan, 1}) == "omega0.y = nan must be finite");
  BOOST_TEST(message({1, 2, 3.5}, {0, 1, 0}, {1, 1, 1}).starts_with("the largest moment = 3.5 "));
  BOOST_TEST(message({1, 2, 2.5}, {0, 1, 0}, {1, 1, 1}) == "nothing was thrown");
  BOOST_CHECK_THROW((void)Gyrostat({1, 2, 2.5}, {0, 0, 1}, {1, 1, 1}, anyhow)
                        .at(std::numeric_limits<double>::infinity()),
                    InvalidInput);
}

BOOST_AUTO_TEST_SUITE_END()
