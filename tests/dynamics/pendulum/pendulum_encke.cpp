#include <boost/multiprecision/cpp_bin_float.hpp>
#include <boost/test/unit_test.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include <dynamics/pendulum/pendulum_encke.hpp>
#include <dynamics/solve/solve.hpp>

using namespace kreisel;

namespace {

using Real = boost::multiprecision::cpp_bin_float_50;

const double k = 19.62;
const double earth_rate = 7.292115e-5;
const double latitude = std::acos(-1.0) / 4;

/// The centrifugal torque on a plane pendulum on the rotating earth.
const auto earth = []<class S>(const S& /*t*/, const S& angle, const S& /*rate*/) -> S {
  using std::cos;
  using std::sin;
  const S place = angle - latitude;
  const S s = sin(place);
  return earth_rate * earth_rate * s * cos(place);
};

struct Series {
  std::array<Real, 42> terms = {};

  Real& operator[](int i) { return terms[static_cast<std::size_t>(i)]; }
};

/// angle'' = -k sin(angle) + w^2/2 sin(2 (angle - latitude)) by Taylor series in 50 digits.
Real swing(Real angle, Real w2, double end) {
  constexpr int order = 40;
  constexpr int steps = 400;
  const Real h = Real(end) / steps;
  Real rate = 0;
  for (int step = 0; step < steps; ++step) {
    Series y, s, c, s2, c2;
    y[0] = angle;
    y[1] = rate;
    s[0] = sin(angle);
    c[0] = cos(angle);
    s2[0] = sin(2 * (angle - latitude));
    c2[0] = cos(2 * (angle - latitude));
    for (int n = 0; n < order; ++n) {
      if (n > 0) {
        for (int j = 1; j <= n; ++j) {
          s[n] += j * y[j] * c[n - j] / n;
          c[n] -= j * y[j] * s[n - j] / n;
          s2[n] += 2 * j * y[j] * c2[n - j] / n;
          c2[n] -= 2 * j * y[j] * s2[n - j] / n;
        }
      }
      y[n + 2] = (-k * s[n] + w2 / 2 * s2[n]) / ((n + 1) * (n + 2));
    }
    angle = 0;
    rate = 0;
    for (int n = order + 1; n >= 0; --n) angle = angle * h + y[n];
    for (int n = order + 1; n >= 1; --n) rate = rate * h + n * y[n];
  }
  return angle;
}

}  // namespace

BOOST_AUTO_TEST_SUITE(pendulum_encke)

BOOST_AUTO_TEST_CASE(keeps_the_digits_of_a_small_effect) {
  const EnckePendulum pendulum(k, earth);
  for (const double amplitude : {0.1, 1.0}) {
    const double end = 30;
    const Real w2 = Real(earth_rate) * earth_rate;
    const Real truth = swing(amplitude, w2, end) - swing(amplitude, 0, end);
    const auto run = solve(pendulum, {amplitude},
                           {.output_times = {end}, .tolerance = 1e-12, .absolute_scale = 0});
    const double d = run.states[0].deviation;
    const double off = static_cast<double>(abs(d - truth) / abs(truth));
    BOOST_TEST_MESSAGE("amplitude " << amplitude << ": deviation " << d << ", off by " << off);
    BOOST_TEST(off <= 1e-12);
    BOOST_TEST(run.report.tolerance_kept);
  }
}

// Both parts together are the disturbed pendulum; a brake depends on its whole rate.
BOOST_AUTO_TEST_CASE(adds_up_to_the_disturbed_pendulum) {
  const EnckePendulum pendulum(k, []<class S>(const S& t, const S& angle, const S& rate) -> S {
    return S(t - S(0.3) * angle - S(0.2) * rate);
  });
  const double a = 0.7, da = -1.1, d = 0.2, dd = 0.4;
  const auto rates = pendulum.rates(2.0, pendulum.to_vector({a, da, d, dd}));
  const double whole = -k * std::sin(a + d) + 2 - 0.3 * (a + d) - 0.2 * (da + dd);
  BOOST_TEST(std::abs(rates[1] + rates[3] - whole) <= 8 * 0x1p-53 * k);
  BOOST_TEST(rates[1] == -k * std::sin(a));
}

BOOST_AUTO_TEST_CASE(is_zero_without_disturbance) {
  const EnckePendulum pendulum(
      k, []<class S>(const S& /*t*/, const S& /*angle*/, const S& /*rate*/) -> S { return S(0); });
  const auto run = solve(pendulum, {0.3}, {.output_times = {10}, .tolerance = 1e-10});
  BOOST_TEST(run.states[0].deviation == 0);
}

BOOST_AUTO_TEST_CASE(refuses_motions_that_do_not_swing) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  BOOST_CHECK_THROW(EnckePendulum(-1, earth), InvalidInput);
  BOOST_CHECK_THROW(EnckePendulum(nan, earth), InvalidInput);
}

BOOST_AUTO_TEST_SUITE_END()
