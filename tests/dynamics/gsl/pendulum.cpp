#include <boost/multiprecision/cpp_bin_float.hpp>
#include <boost/test/data/monomorphic.hpp>
#include <boost/test/data/test_case.hpp>
#include <boost/test/unit_test.hpp>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_sf_gamma.h>

#include <array>
#include <cmath>
#include <iomanip>
#include <iostream>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include <dynamics/exact/pendulum_motion.hpp>
#include <dynamics/gsl/pendulum.hpp>
#include <dynamics/pendulum/pendulum_period.hpp>

#include <support/near.hpp>
#include <support/worst.hpp>

namespace data = boost::unit_test::data;
using namespace kreisel;
using Exact = boost::multiprecision::cpp_bin_float_50;

namespace {

constexpr double u = 0x1p-53;

/// |value - truth| <= k u |scale| with u = 2^-53, truth being more precise.
test::Verdict near(double value, const Exact& truth, double scale, double k) {
  return test::near(Exact(value), truth, Exact(std::abs(scale)),
                    k * u / test::u<Exact>.convert_to<double>());
}

/// 2 pi/(omega agm(1, cos(amplitude/2))): Gauss, in 50 digits.
Exact period_by_agm(double amplitude) {
  Exact a = 1;
  Exact b = cos(Exact(Exact(amplitude) / 2));
  for (int i = 0; i < 12; ++i) {
    const Exact mean = (a + b) / 2;
    b = sqrt(Exact(a * b));
    a = mean;
  }
  return 2 * acos(Exact(-1)) / a;
}

/// phi.. = -sin(phi) by Taylor series of order 40 in 50 digits.
struct Motion {
  Exact angle;
  Exact rate;

  void step(const Exact& h) {
    constexpr int order = 40;
    std::array<Exact, order + 2> p;
    std::array<Exact, order + 2> w;
    std::array<Exact, order + 2> s;
    std::array<Exact, order + 2> c;
    p[0] = angle;
    w[0] = rate;
    s[0] = sin(angle);
    c[0] = cos(angle);
    for (std::size_t k = 0; k <= order; ++k) {
      p[k + 1] = w[k] / static_cast<int>(k + 1);
      w[k + 1] = -s[k] / static_cast<int>(k + 1);
      Exact ds = 0;
      Exact dc = 0;
      for (std::size_t i = 0; i <= k; ++i) {
        ds += w[i] * c[k - i];
        dc -= w[i] * s[k - i];
      }
      s[k + 1] = ds / static_cast<int>(k + 1);
      c[k + 1] = dc / static_cast<int>(k + 1);
    }
    angle = 0;
    rate = 0;
    for (std::size_t k = order + 1; k-- > 0;) {
      angle = angle * h + p[k];
      rate = rate * h + w[k];
    }
  }
};

const auto amplitudes = data::make(
    {1e-8, 0.01, 0.1, 0.5, 1.0, 1.5707963267948966, 2.0, 2.5, 3.0, 3.1, 3.14, 3.1415, 3.141592});

}  // namespace

BOOST_AUTO_TEST_SUITE(plain_pendulum)

BOOST_DATA_TEST_CASE(period_agrees_with_gauss, amplitudes, amplitude) {
  const exact::PlainPendulum pendulum(amplitude, 1);
  // d(log T)/d amplitude grows like 1/(pi - amplitude).
  const double condition = 4 + 1 / (std::numbers::pi - amplitude);
  const Exact truth = period_by_agm(amplitude);
  BOOST_TEST(near(pendulum.period(), truth, truth.convert_to<double>(), condition));
  std::cout << "K: amplitude " << amplitude << " error "
            << abs(Exact(pendulum.period() / truth - 1)).convert_to<double>() / u << " u\n";
}

// Anchor: amplitude 90 degrees, K(1/sqrt 2) = Gamma(1/4)^2/(4 sqrt pi).
BOOST_AUTO_TEST_CASE(quarter_turn_has_the_lemniscate_period) {
  const double gamma = gsl_sf_gamma(0.25);
  const exact::PlainPendulum pendulum(std::numbers::pi / 2, 2);
  BOOST_TEST(near(pendulum.period(), gamma * gamma / std::sqrt(std::numbers::pi) / 2, 4, 8));
}

// Quadrature and elliptic integral are independent.
BOOST_DATA_TEST_CASE(period_agrees_with_quadrature, amplitudes, amplitude) {
  const PendulumBody<double> body = PendulumBody<double>::thin_rod(1.0, 3.0);
  const PendulumCoefficients<double> c{4.0, 0, 0, 0, 0};
  const auto all = equilibria(c);
  const auto swing = period_at_amplitude(body, c, all, nearest_stable(all), amplitude);
  const exact::PlainPendulum pendulum(amplitude, std::sqrt(c.e() / body.theta_c));
  const double condition = 8 + 8 / (std::numbers::pi - amplitude);
  BOOST_TEST(near(swing.period, pendulum.period(), pendulum.period(), condition));
  BOOST_TEST(near(swing.other_turning_point, -amplitude, amplitude, condition));
  std::cout << "quadrature: amplitude " << amplitude << " nodes " << swing.nodes << " difference "
            << std::abs(swing.period / pendulum.period() - 1) / u << " u\n";
}

BOOST_DATA_TEST_CASE(motion_agrees_with_the_taylor_series, data::make({0.1, 1.0, 2.0, 3.0}),
                     amplitude) {
  const exact::PlainPendulum pendulum(amplitude, 1);
  Motion truth{amplitude, 0};
  double worst_angle = 0;
  double worst_rate = 0;
  for (int i = 1; i * 0.0625 < pendulum.period(); ++i) {
    truth.step(Exact("0.0625"));
    const auto state = pendulum.at(i * 0.0625);
    worst_angle =
        test::worst_of(worst_angle, abs(Exact(state.angle - truth.angle)).convert_to<double>());
    worst_rate =
        test::worst_of(worst_rate, abs(Exact(state.rate - truth.rate)).convert_to<double>());
  }
  std::cout << "motion: amplitude " << amplitude << " error " << worst_angle / u << " u angle, "
            << worst_rate / u << " u rate\n";
  const double bound = (amplitude <= 2 ? 16 : 64) * u;
  BOOST_TEST(worst_angle < bound);
  BOOST_TEST(worst_rate < bound);
}

BOOST_AUTO_TEST_CASE(motion_starts_at_rest_and_returns) {
  const exact::PlainPendulum pendulum(-2, 3);
  BOOST_TEST(near(pendulum.at(0).angle, -2, 2, 2));
  BOOST_TEST(pendulum.at(0).rate == 0);
  BOOST_TEST(pendulum.at(0.01).rate > 0);
  BOOST_TEST(near(pendulum.at(pendulum.period() / 2).angle, 2, 2, 4));
  BOOST_TEST(near(pendulum.at(pendulum.period() / 4).angle, 0, 2, 16));
  BOOST_TEST(near(pendulum.at(-0.3).angle, pendulum.at(0.3).angle, 2, 0));
}

BOOST_AUTO_TEST_CASE(invalid_arguments_are_refused) {
  const auto message = [](double amplitude, double omega) -> std::string {
    try {
      (void)exact::PlainPendulum(amplitude, omega);
    } catch (const InvalidInput& error) {
      return error.what();
    }
    return "nothing was thrown";
  };
  BOOST_TEST(message(0, 1) == "amplitude = 0 rad: 0 < |amplitude| < pi is required");
  BOOST_TEST(message(3.2, 1).starts_with("amplitude = 3.2"));
  BOOST_TEST(message(std::nan(""), 1) == "amplitude = nan rad: 0 < |amplitude| < pi is required");
  BOOST_TEST(message(1, 0) == "omega = 0 rad/s must be a finite number above 0");
  BOOST_TEST(message(1, 1) == "nothing was thrown");
  BOOST_CHECK_THROW((void)exact::PlainPendulum(1, 1).at(std::numeric_limits<double>::infinity()),
                    InvalidInput);
}

BOOST_AUTO_TEST_SUITE_END()

BOOST_AUTO_TEST_SUITE(pendulum_motion)

struct Start {
  double angle;
  double rate;

  friend std::ostream& operator<<(std::ostream& out, const Start& s) {
    return out << s.angle << " rad, " << s.rate << " rad/s";
  }
};

// Swings, rotations in both directions, starts far away, motions near the top from both sides,
// rest.
BOOST_DATA_TEST_CASE(motion_agrees_with_the_taylor_series,
                     data::make(std::vector<Start>{{0, 0},
                                                   {1e-9, 0},
                                                   {2, 0},
                                                   {-3, 0.1},
                                                   {0.3, -1},
                                                   {0, 3},
                                                   {3.1, -2},
                                                   {20, 2.5},
                                                   {-20, 0.5},
                                                   {0, 1.999999999},
                                                   {0, 2.000000001},
                                                   {0, std::nextafter(2.0, 0.0)},
                                                   {0, std::nextafter(2.0, 3.0)},
                                                   {0, 2},
                                                   {0, -2},
                                                   {3.14, 0},
                                                   {std::numbers::pi, 0}}),
                     start) {
  const exact::PendulumMotion pendulum(1, start.angle, start.rate);
  Motion truth{start.angle, start.rate};
  double worst_angle = 0;
  double worst_rate = 0;
  for (int i = 1; i <= 320; ++i) {
    truth.step(Exact("0.125"));
    const auto state = pendulum.at(i * 0.125);
    // One rounding of the result, and some 2^-64 of the angle 40 inside.
    BOOST_TEST(near(state.angle, truth.angle, std::abs(state.angle) + 0.125, 1.5));
    BOOST_TEST(near(state.rate, truth.rate, std::abs(state.rate) + 0.125, 1.5));
    worst_angle =
        test::worst_of(worst_angle, abs(Exact(state.angle - truth.angle)).convert_to<double>());
    worst_rate =
        test::worst_of(worst_rate, abs(Exact(state.rate - truth.rate)).convert_to<double>());
  }
  std::cout << "any start: " << start << ": error " << worst_angle / u << " u angle, "
            << worst_rate / u << " u rate\n";
}

// From delta below the top to the lowest point: K = L + (L - 1) delta^2/16 + ..,  L = ln(8/delta).
BOOST_DATA_TEST_CASE(fall_from_near_the_top_takes_logarithmic_time, data::make({1e-4, 1e-8, 1e-12}),
                     delta) {
  const double start = std::numbers::pi - delta;
  const exact::PendulumMotion pendulum(4, start, 0);
  const double off = (acos(Exact(-1)) - start).convert_to<double>();
  const double time = std::log(8 / off) / 2;
  const double left_out = time * off * off / 16;
  BOOST_TEST(std::abs(pendulum.period() / 4 - time) <= time * 2 * u + left_out);
  // Its rate there is 4 rad/s.
  BOOST_TEST(std::abs(pendulum.at(time).angle) <= 4 * (time * 2 * u + left_out));
}

BOOST_AUTO_TEST_CASE(separatrix_ends_at_the_top) {
  const exact::PendulumMotion pendulum(1, 0, -2);
  BOOST_TEST(std::isinf(pendulum.period()));
  BOOST_TEST(pendulum.at(1e6).angle == -std::numbers::pi);
  BOOST_TEST(pendulum.at(1e6).rate == 0);
}

BOOST_AUTO_TEST_CASE(turns_are_counted) {
  const exact::PendulumMotion pendulum(1, 0.5, 3);
  const double turns = 1000 * pendulum.period();
  const Exact angle = 0.5 + 2000 * acos(Exact(-1));
  BOOST_TEST(near(pendulum.at(turns).angle, angle, 6283, 4));
  BOOST_TEST(near(pendulum.at(turns).rate, 3, 3, 4 * 1000));
}

BOOST_AUTO_TEST_CASE(release_at_rest_gives_the_plain_pendulum) {
  const exact::PendulumMotion motion(9, -2, 0);
  const exact::PlainPendulum plain(-2, 3);
  BOOST_TEST(near(motion.period(), plain.period(), plain.period(), 4));
  for (const double time : {-0.3, 0.01, 1.0}) {
    BOOST_TEST(near(motion.at(time).angle, plain.at(time).angle, 1, 24));
    BOOST_TEST(near(motion.at(time).rate, plain.at(time).rate, 3, 24));
  }
}

BOOST_AUTO_TEST_CASE(invalid_arguments_are_refused) {
  BOOST_CHECK_THROW((void)exact::PendulumMotion(0, 1, 1), InvalidInput);
  BOOST_CHECK_THROW((void)exact::PendulumMotion(1, std::nan(""), 1), InvalidInput);
  BOOST_CHECK_THROW((void)exact::PendulumMotion(1, 1, std::nan("")), InvalidInput);
  BOOST_CHECK_THROW((void)exact::PendulumMotion(1, 1, 1).at(std::nan("")), InvalidInput);
}

BOOST_AUTO_TEST_SUITE_END()

BOOST_AUTO_TEST_SUITE(gsl)

int calls = 0;

BOOST_AUTO_TEST_CASE(errors_become_exceptions) {
  gsl_error_handler_t* const before =
      gsl_set_error_handler([](const char*, const char*, int, int) { ++calls; });
  BOOST_CHECK_EXCEPTION(
      {
        const detail::GslErrorsReturned guard;
        gsl_sf_result result;
        exact::detail::require_success(gsl_sf_ellint_RF_e(-1, 1, 1, GSL_PREC_DOUBLE, &result),
                                       "integral of nothing");
      },
      ComputationFailed,
      [](const auto& error) {
        return std::string(error.what()) == "integral of nothing: input domain error";
      });
  BOOST_TEST(calls == 0);
  gsl_sf_result result;
  (void)gsl_sf_ellint_RF_e(-1, 1, 1, GSL_PREC_DOUBLE, &result);
  BOOST_TEST(calls == 1);
  gsl_set_error_handler(before);
}

BOOST_AUTO_TEST_SUITE_END()
