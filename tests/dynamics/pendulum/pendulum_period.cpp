#include <boost/test/data/monomorphic.hpp>
#include <boost/test/data/test_case.hpp>
#include <boost/test/unit_test.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <string>

#include <dynamics/pendulum/pendulum_cases.hpp>
#include <dynamics/pendulum/pendulum_equilibria.hpp>
#include <dynamics/pendulum/pendulum_period.hpp>

#include <support/worst.hpp>

using namespace kreisel;
using namespace kreisel::test::pendulum;
using test::Sample;
namespace data = boost::unit_test::data;

BOOST_AUTO_TEST_SUITE(finite_amplitude)

const PendulumBody<double> rod = PendulumBody<double>::thin_rod(0.75);

FiniteOscillation<double> swing(const PendulumCoefficients<double>& c, double amplitude) {
  const auto all = equilibria(c);
  return period_at_amplitude(rod, c, all, nearest_stable(all), amplitude);
}

BOOST_DATA_TEST_CASE(both_turning_points_have_the_same_height, data::xrange(300u), seed) {
  Sample sample(seed);
  const PendulumCoefficients<double> c{1, sample.uniform(-0.5, 0.5), sample.uniform(-1, 1),
                                       sample.uniform(-1, 1), sample.uniform(-1, 1)};
  const auto all = equilibria(c);
  const auto rest = nearest_stable(all);
  const double amplitude = sample.uniform(-3, 3);
  const auto there = period_at_amplitude(rod, c, all, rest, amplitude);
  const double release = rest.angle + amplitude;
  const double other = rest.angle + there.other_turning_point;
  const double size = std::abs(c.e()) + std::abs(c.f) + std::abs(c.h) + std::abs(c.k);
  BOOST_TEST(near(c.potential(other), c.potential(release), size, 64));
  // It falls at the release, and no point between is as high.
  BOOST_TEST((c.moment(release) > 0) == (other < release));
  for (int i = 1; i < 200; ++i) {
    BOOST_TEST_REQUIRE(c.potential(release + (other - release) * i / 200) < c.potential(release));
  }
  // Released at the other point it returns in the same time.
  if (std::abs(there.other_turning_point) < 3.14) {
    const auto back = period_at_amplitude(rod, c, all, rest, there.other_turning_point);
    const double steepest = std::min(std::abs(c.moment(release)), std::abs(c.moment(other)));
    BOOST_TEST(near(back.period, there.period, there.period * size / steepest, 64));
  }
}

BOOST_AUTO_TEST_CASE(a_small_amplitude_gives_the_small_period) {
  const PendulumCoefficients<double> c{3.7, 1e-3, -0.02, 0.01, 0.3};
  const double rest = nearest_stable(equilibria(c)).angle;
  const double small = small_period(rod, c, rest);
  for (const double amplitude : {1e-9, -1e-9, 1e-15, 1e-30, 1e-200}) {
    const auto there = swing(c, amplitude);
    BOOST_TEST(near(there.period, small, small, 16));
    BOOST_TEST(
        near(there.other_turning_point, -amplitude, amplitude, 16 + std::abs(amplitude) / u));
  }
  BOOST_TEST(swing(c, 0).period == small);
}

// Mirror: phi -> -phi takes F -> -F, H -> -H.
BOOST_AUTO_TEST_CASE(the_mirrored_pendulum_swings_alike) {
  const PendulumCoefficients<double> c{3.7, 0.1, -0.3, 0.2, -1.1};
  const PendulumCoefficients<double> mirrored{3.7, 0.1, 0.3, -0.2, -1.1};
  for (const double amplitude : {-2.5, -0.4, 0.7, 2.9}) {
    BOOST_TEST(near(swing(mirrored, -amplitude).period, swing(c, amplitude).period, 1, 16));
  }
}

// Two wells at +-arccos(1/1.8), with the barrier between them at 0: released above it, it passes.
BOOST_AUTO_TEST_CASE(a_high_release_passes_the_barrier) {
  const PendulumCoefficients<double> c{1, 0, 0, 0, -0.9};
  const double rest = nearest_stable(equilibria(c)).angle;
  const auto low = swing(c, 0.1);
  BOOST_TEST(rest + low.other_turning_point > 0);
  const auto high = swing(c, 2.5 - rest);
  BOOST_TEST(near(rest + high.other_turning_point, -2.5, 2.5, 8));
}

BOOST_AUTO_TEST_CASE(infinite_periods_are_refused) {
  const PendulumCoefficients<double> plain{1, 0, 0, 0, 0};
  BOOST_TEST(message_of([&] { (void)swing(plain, std::acos(-1.0)); }) ==
             "amplitude = 3.141592654 rad releases the pendulum at the equilibrium phi = "
             "3.141592654 rad: it stays there");
  BOOST_TEST(message_of([&] { (void)swing(plain, 3.2); }) ==
             "amplitude = 3.2 rad lies outside [-3.141592654, 3.141592654] rad");
  // This close to the top it is, to rounding, as high as the top.
  BOOST_CHECK_EXCEPTION((void)swing(plain, std::acos(-1.0) - 4.4e-14), ComputationFailed,
                        [](const auto& error) {
                          return std::string(error.what()).starts_with("the period is infinite");
                        });
  // E = 1, K = -1: the height of the barrier at 0 is reached again where
  // 1 - cos p = sin^2 p, p = pi/2: E (1 - cos p) + K sin^2 p = 1 - 1 = 0.
  const PendulumCoefficients<double> wells{1, 0, 0, 0, -1};
  const double rest = nearest_stable(equilibria(wells)).angle;
  // From either side, to the same barrier.
  for (const double release : {std::acos(0.0), -std::acos(0.0)}) {
    BOOST_CHECK_EXCEPTION((void)swing(wells, release - rest), ComputationFailed,
                          [](const auto& error) {
                            const std::string text = error.what();
                            BOOST_TEST_MESSAGE(text);
                            return text.starts_with("the period is infinite") &&
                                   std::abs(std::stod(text.substr(text.find("phi = ") + 6))) < 1e-9;
                          });
  }
}

// Also if no point on the other side is as far.
BOOST_AUTO_TEST_CASE(a_release_at_another_equilibrium_is_refused) {
  const PendulumCoefficients<double> c{1, 0, 0.2, 0.3, 0.7};
  const auto all = equilibria(c);
  const auto rest = nearest_stable(all);
  int others = 0;
  for (const auto& other : all) {
    if (other.angle == rest.angle) continue;
    const double amplitude = std::remainder(other.angle - rest.angle, 4 * std::acos(0.0));
    BOOST_TEST(message_of([&] {
                 (void)period_at_amplitude(rod, c, all, rest, amplitude);
               }).ends_with("it stays there"));
    ++others;
  }
  BOOST_TEST(others == 3);
}

// The slope is m (E' + 2 K') + F' (3 m^2 + d^2)/2 next to the equilibrium. If m and d are off by a
// part delta, the slope is off by at most delta (|m| |E' + 2 K'| + |F'| (3 m^2 + d^2)).
BOOST_DATA_TEST_CASE(rounding_is_amplified_as_predicted, data::xrange(100u), seed) {
  Sample sample(seed);
  const bool third = seed % 2 == 0;  // E' + 2 K' = 0: the moment is of second order
  const detail::ShiftedMoment<double> moment{
      third ? 0 : sample.uniform(-1, 1), third ? 0 : sample.uniform(-1, 1), sample.uniform(-1, 1)};
  const double m = sample.uniform(-0.3, 0.3);
  const double d = sample.uniform(0, 0.3);
  const double slope = moment.slope(m, d);
  constexpr double delta = 1e-6;
  double worst = 0;
  for (const double off : {m * (1 + delta), m * (1 - delta)}) {
    worst = test::worst_of(worst, std::abs(moment.slope(off, d * (1 + delta)) - slope),
                           std::abs(moment.slope(off, d * (1 - delta)) - slope));
  }
  const double foretold = moment.condition(m, d, slope) * std::abs(slope) * delta;
  BOOST_TEST(worst <= 1.6 * foretold);
  if (third) BOOST_TEST(worst >= 0.4 * foretold);
}

BOOST_AUTO_TEST_CASE(size_bounds_the_moment) {
  Sample sample(7);
  for (const auto& moment :
       {detail::ShiftedMoment<double>{-1, 0, 0}, {0, 0, -1}, {1, -1, 0}, {0, 1, 1}, {0, -1, -1}}) {
    for (int i = 0; i < 1000; ++i) {
      const double m = sample.uniform(-3.2, 3.2);
      BOOST_TEST_REQUIRE(std::abs(moment.slope(m, sample.uniform(-3.2, 3.2))) <= moment.size());
      BOOST_TEST_REQUIRE(std::abs(moment.moment(m)) <= moment.size());
    }
  }
}

// Two equal barriers of K alone: E and F do not count in the comparison of heights.
BOOST_AUTO_TEST_CASE(release_at_barrier_height_is_refused) {
  BOOST_CHECK_EXCEPTION((void)swing({0, 0, 0, 0, 1}, std::acos(0.0) - 1e-9), ComputationFailed,
                        [](const auto& error) {
                          BOOST_TEST_MESSAGE(error.what());
                          return std::string(error.what()).starts_with("the period is infinite");
                        });
}

BOOST_AUTO_TEST_CASE(near_a_barrier_the_error_reached_is_named) {
  const PendulumCoefficients<double> wells{1, 0, 0, 0, -1};
  const double rest = nearest_stable(equilibria(wells)).angle;
  BOOST_CHECK_EXCEPTION(
      (void)swing(wells, std::acos(0.0) + 1e-13 - rest), ComputationFailed, [](const auto& error) {
        BOOST_TEST_MESSAGE(error.what());
        return std::string(error.what()).find("leave an error of") != std::string::npos;
      });
  BOOST_CHECK_NO_THROW((void)swing(wells, std::acos(0.0) + 1e-6 - rest));
}

// So near a barrier that rounding exceeds the change by doubling the nodes.
BOOST_AUTO_TEST_CASE(quadrature_ends_at_rounding) {
  const PendulumCoefficients<double> wells{1, 0, 0, 0, -1};
  const auto all = equilibria(wells);
  const auto rest = nearest_stable(all);
  const double amplitude = std::acos(0.0) + 1e-8 - rest.angle;
  const auto found = period_at_amplitude(rod, wells, all, rest, amplitude);
  BOOST_TEST_MESSAGE(found.nodes << " nodes, error " << found.quadrature_error << " of "
                                 << found.period);
  BOOST_TEST(std::has_single_bit(unsigned(found.nodes - 1)));
  BOOST_TEST(found.nodes > 1000);
  BOOST_TEST(found.quadrature_error > 0);
  BOOST_TEST(found.quadrature_error < 1e-6 * found.period);
}

BOOST_AUTO_TEST_CASE(a_small_swing_needs_few_nodes) {
  BOOST_TEST(swing({1, 0, 0, 0, 0}, 1e-9).nodes == 17);  // 8 intervals and twice as many
}

// By the arithmetic-geometric mean, T = 2 pi/agm(1, cos(amplitude/2)): rounding in sums of many
// terms does not grow with their number.
BOOST_AUTO_TEST_CASE(great_swings_do_not_accumulate_rounding) {
  using L = long double;
  const PendulumCoefficients<double> c{1, 0, 0, 0, 0};
  const auto all = equilibria(c);
  for (const double below : {1.0, 0.137, 0.1}) {
    const double amplitude = std::acos(-1.0) - below;
    const auto found = period_at_amplitude(PendulumBody<double>{.arm = 1, .theta_c = 1}, c, all,
                                           nearest_stable(all), amplitude);
    L a = 1;
    L g = std::cos(L(amplitude) / 2);
    for (int i = 0; i < 8; ++i) {
      const L mean = (a + g) / 2;
      g = std::sqrt(a * g);
      a = mean;
    }
    const L off = found.period / (2 * std::acos(L(-1)) / a) - 1;
    BOOST_TEST(std::abs(off) <= L(1.8) * u, below << " rad below: off by " << double(off) / u
                                                  << " u with " << found.nodes << " nodes");
  }
}

// Upside down nothing is stable, and without weight there is no reference period.
BOOST_AUTO_TEST_CASE(undefined_periods_are_refused) {
  const PendulumCoefficients<double> c{.weight = 3};
  const double up = std::acos(-1.0);
  BOOST_CHECK_THROW((void)stiffness_excess(PendulumCoefficients<double>{}, 0.1), InvalidInput);
  BOOST_CHECK_THROW((void)small_period_change(c, up), ComputationFailed);
  BOOST_CHECK_THROW((void)small_period(rod, c, up), ComputationFailed);
  const double infinite = std::numeric_limits<double>::infinity();
  BOOST_CHECK_THROW((void)equilibria(PendulumCoefficients<double>{.weight = infinite}),
                    InvalidInput);
}

template <class S>
void agrees(double k) {
  const Json& c = cases()[4];
  const Given<S> in = given<S>(c);
  const auto all = equilibria(coefficients(in.body, in.guide));
  const auto rest = nearest_stable(all);
  const auto swing_ =
      period_at_amplitude(in.body, coefficients(in.body, in.guide), all, rest, S(1) / S(10));
  BOOST_TEST(near(Exact(rest.angle), number(c.at("phi0_exact_rad")), 1, k));
  BOOST_TEST(near(Exact(swing_.period), number(c.at("finite_amplitude").at("period_s")), 1, k));
  const PendulumField<S> f(in.body, in.guide);
  const PendulumState<S> rate = f(S(0), PendulumState<S>(rest.angle, S(0)));
  BOOST_TEST(near(Exact(rate[1]), 0, 20, k));
}

BOOST_AUTO_TEST_CASE(every_scalar_agrees) {
  agrees<float>(8 * 0x1p29);
  agrees<double>(8);
  agrees<long double>(8 * 0x1p-11);
  agrees<Exact>(1e-24 / u);  // the reference's digits
}

BOOST_AUTO_TEST_SUITE_END()
