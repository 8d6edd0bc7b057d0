#include <boost/test/unit_test.hpp>

#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include <dynamics/exact/pendulum_motion.hpp>
#include <dynamics/step/gauss.hpp>

#include <support/near.hpp>
#include <support/wide.hpp>
#include <support/worst.hpp>

using namespace kreisel;
using test::near;

namespace {

template <int n, class S = double>
using State = Eigen::Matrix<S, n, 1>;

State<2> circle(double /*t*/, const State<2>& y) { return {-y[1], y[0]}; }

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

/// phi'' + k sin(phi) = 0.
struct Pendulum {
  double k = 19.62;

  State<2> operator()(double /*t*/, const State<2>& y) const { return {y[1], -k * std::sin(y[0])}; }

  [[nodiscard]] double energy(const State<2>& y) const {
    const double s = std::sin(y[0] / 2);
    return y[1] * y[1] / 2 + 2 * k * s * s;
  }
};

/// The error after `periods` of a pendulum released at `amplitude`.
struct Drift {
  double phase;   ///< rad
  double energy;  ///< relative
  double evaluations;
};

template <class Steps>
Drift drift(Steps& steps, const Pendulum& pendulum, double amplitude, double periods) {
  const exact::PendulumMotion exact(pendulum.k, amplitude, 0);
  const double end = periods * exact.period() + 0.1;
  const State<2> start = steps.y();
  const State<2> y = steps.advance_to(end);
  const auto [angle, rate] = exact.at(end);
  const double root_k = std::sqrt(pendulum.k);
  return {std::hypot(y[0] - angle, (y[1] - rate) / root_k) / amplitude,
          pendulum.energy(y) / pendulum.energy(start) - 1, steps.effort().evaluations};
}

}  // namespace

BOOST_AUTO_TEST_SUITE(gauss_coefficients)

template <int s>
void hold() {
  const GaussCoefficients<s> gauss;
  const auto node = [&](std::size_t i) { return test::wide(gauss.node[i]); };
  for (int power = 0; power < 2 * s; ++power) {
    long double sum = 0;
    for (std::size_t i = 0; i < s; ++i)
      sum += test::wide(gauss.weight[i]) * std::pow(node(i), power);
    BOOST_TEST(near(sum, 1.0L / (power + 1), 1.0L, 16));
  }
  for (std::size_t i = 0; i < s; ++i) {
    for (int power = 0; power < s; ++power) {
      long double within = 0;
      long double ahead = 0;
      for (std::size_t j = 0; j < s; ++j) {
        const long double x = test::wide(gauss.weight[j]) * std::pow(node(j), power);
        within += test::wide(gauss.ratio[i][j]) * x;
        ahead += test::wide(gauss.ahead[i][j]) * x;
      }
      BOOST_TEST(near(within, std::pow(node(i), power + 1.0L) / (power + 1), 1.0L, 8));
      BOOST_TEST(
          near(ahead, test::wide(gauss.weight[i]) * std::pow(1 + node(i), 1.0L * power), 1e5L, 8));
    }
  }
}

BOOST_AUTO_TEST_CASE(integrate_and_continue_powers_of_time) {
  hold<1>();
  hold<6>();
  hold<8>();
}

BOOST_AUTO_TEST_SUITE_END()

BOOST_AUTO_TEST_SUITE(gauss_steps)

// A swing in long double. Even so, order 16 shows little more than one halving.
template <int stages>
double observed_order(long double amplitude, double coarse) {
  using Wide = State<2, long double>;
  const auto swing = [](long double, const Wide& y) { return Wide(y[1], -std::sin(y[0])); };
  const auto run = [&]<int s>(double step) {
    GaussIRK<Wide, decltype(swing), s> steps(swing, 0, Wide(amplitude, 0), step);
    return steps.advance_to(12);
  };
  const Wide best = run.template operator()<8>(0.05);
  const auto error = [&](double step) {
    return static_cast<double>((run.template operator()<stages>(step) - best).norm());
  };
  const double order = std::log2(error(coarse) / error(coarse / 2));
  BOOST_TEST_MESSAGE(stages << " stages: observed order " << order);
  return order;
}

BOOST_AUTO_TEST_CASE(converge_with_order_two_s) {
  BOOST_TEST(std::abs(observed_order<2>(1, 0.5) - 4) < 0.1);
  BOOST_TEST(std::abs(observed_order<6>(1, 0.5) - 12) < 0.5);
  BOOST_TEST(std::abs(observed_order<8>(2, 2) - 16) < 1);
}

// The energy of the explicit steps falls all the time. That of these steps is a random walk; here
// it returns after 300 swings of every size to its start, to the last digits.
BOOST_AUTO_TEST_CASE(keep_energy_and_phase_over_many_swings) {
  const Pendulum pendulum;
  double worst_energy = 0;
  double worst_phase = 0;
  for (const double amplitude : {0.1, 0.4, 1.0, 1.7}) {
    GaussIRK steps(pendulum, 0.0, State<2>(amplitude, 0), 0.12);
    const Drift d = drift(steps, pendulum, amplitude, 300);
    BOOST_TEST_MESSAGE("Gauss 16, amplitude " << amplitude << ": phase " << d.phase << ", energy "
                                              << d.energy << " for " << d.evaluations);
    worst_energy = test::worst_of(worst_energy, std::abs(d.energy));
    worst_phase = test::worst_of(worst_phase, d.phase);
  }
  BOOST_TEST(worst_energy < 2e-14);
  BOOST_TEST(worst_phase < 3e-12);
}

// Six steps a swing, with an error no larger than rounding. The energy of the explicit steps has
// ten times that error after a fifth of the time.
BOOST_AUTO_TEST_CASE(are_better_than_explicit_in_long_runs) {
  const Pendulum pendulum;
  GaussIRK gauss(pendulum, 0.0, State<2>(0.1, 0), 0.236);
  const Drift implicit = drift(gauss, pendulum, 0.1, 10000);
  ExplicitRungeKutta verner(pendulum, 0.0, State<2>(0.1, 0),
                            {.relative = 1e-15, .absolute_scale = 0});
  const Drift explicit_ = drift(verner, pendulum, 0.1, 2000);
  BOOST_TEST_MESSAGE("Gauss 16, 10000 swings: phase " << implicit.phase << ", energy "
                                                      << implicit.energy << " for "
                                                      << implicit.evaluations);
  BOOST_TEST_MESSAGE("Verner98 at 1e-15, 2000 swings: phase " << explicit_.phase << ", energy "
                                                              << explicit_.energy << " for "
                                                              << explicit_.evaluations);
  BOOST_TEST(std::abs(implicit.energy) < 5e-14);
  BOOST_TEST(implicit.phase < 3e-12);
  BOOST_TEST(std::abs(implicit.energy) < std::abs(explicit_.energy));
  BOOST_TEST(implicit.evaluations < 5 * explicit_.evaluations);
}

BOOST_AUTO_TEST_CASE(go_there_and_back) {
  const Pendulum pendulum;
  GaussIRK steps(pendulum, 0.0, State<2>(1, 0), 0.1);
  steps.advance_to(1000);
  steps.advance_to(0);
  BOOST_TEST(near(steps.y()[0], 1.0, 1.0, 10000));
  BOOST_TEST(steps.t() == 0);
}

// 20000 additions of 0.1 in plain double are off by 1e-10: neither state nor time may be.
BOOST_AUTO_TEST_CASE(sum_state_and_time_without_loss) {
  const auto field = [](double t, const State<2>&) { return State<2>(1, 2 * t); };
  GaussIRK steps(field, 0.0, State<2>(0, 0), 0.1);
  steps.advance_to(2000);
  BOOST_TEST(near(steps.y()[0], 2000.0, 2000.0, 2));
  BOOST_TEST(near(steps.y()[1], 4e6, 4e6, 4));
}

BOOST_AUTO_TEST_CASE(take_time_into_account) {
  const auto field = [](double t, const State<1>& y) { return State<1>(-2 * t * y[0]); };
  GaussIRK steps(field, -2.0, State<1>(std::exp(-4)), 0.1);
  for (int i = -19; i <= 20; ++i) steps.advance_to(0.1 * i);
  BOOST_TEST(near(steps.y()[0], std::exp(-4), 1.0, 20));
  BOOST_TEST(steps.effort().steps == 40);
}

BOOST_AUTO_TEST_CASE(take_equal_steps_up_to_the_limit) {
  GaussIRK steps(circle, 0.0, State<2>(1, 0), 0.3);
  steps.advance_to(1);
  BOOST_TEST(steps.effort().steps == 4);
  steps.advance_to(1);
  BOOST_TEST(steps.effort().steps == 4);
  BOOST_TEST(steps.t() == 1);
  steps.take_steps_of(0.1);
  steps.advance_to(2);
  BOOST_TEST(steps.effort().steps == 14);
  BOOST_CHECK_THROW(steps.take_steps_of(not_a_number), InvalidInput);
}

// Great forces that cancel leave their rounding, here as a function that no iteration resolves.
BOOST_AUTO_TEST_CASE(bear_the_rounding_of_forces) {
  constexpr double rounding = 1e-12;
  const auto spring = [](double /*t*/, const State<2>& y) {
    return State<2>(y[1], -y[0] + rounding * std::sin(1e18 * y[0]));
  };
  GaussIRK<State<2>, decltype(spring)> steps(spring, 0, State<2>(1e-4, 0), 0.3, {}, 1e-3);
  BOOST_TEST(std::abs(steps.advance_to(10)[0] - 1e-4 * std::cos(10)) <= 10 * rounding);
}

BOOST_AUTO_TEST_CASE(stop_if_the_stages_do_not_converge) {
  GaussIRK wide(circle, 0.0, State<2>(1, 0), 50);
  BOOST_CHECK_THROW(wide.advance_to(50), ComputationFailed);
  BOOST_TEST(wide.t() == 0);
  BOOST_TEST(wide.y() == State<2>(1, 0));

  const auto ends = [](double t, const State<2>& y) {
    return t > 1 ? State<2>(not_a_number, not_a_number) : circle(t, y);
  };
  GaussIRK steps(ends, 0.0, State<2>(1, 0), 0.125);
  BOOST_CHECK_EXCEPTION(steps.advance_to(2), ComputationFailed, [](const ComputationFailed& e) {
    return std::string(e.what()).find("integration stopped at t = 1 s: ") == 0;
  });
  BOOST_TEST(steps.t() == 1);
  BOOST_TEST(near(steps.y()[0], std::cos(1), 1.0, 8));
  BOOST_TEST(steps.effort().evaluations < 2000);
}

BOOST_AUTO_TEST_CASE(refuse_invalid_steps) {
  const auto with = [](double t, double y, double step) {
    return GaussIRK(circle, t, State<2>(y, 0), step);
  };
  BOOST_CHECK_THROW(with(not_a_number, 1, 0.1), InvalidInput);
  BOOST_CHECK_THROW(with(0, not_a_number, 0.1), InvalidInput);
  BOOST_CHECK_THROW(with(0, 1, not_a_number), InvalidInput);
  BOOST_CHECK_THROW(with(0, 1, 0), InvalidInput);
  BOOST_CHECK_THROW(with(0, 1, -0.1), InvalidInput);
  BOOST_CHECK_THROW(GaussIRK(circle, 0.0, State<2>(1, 0), 0.1, std::array{3}), InvalidInput);
  BOOST_CHECK_THROW(with(0, 1, 0.1).advance_to(not_a_number), InvalidInput);
  BOOST_CHECK_THROW(with(0, 1, 1e-300).advance_to(1), ComputationFailed);
  BOOST_CHECK_THROW(with(1e16, 1, 0.1).advance_to(1e16 + 100), ComputationFailed);
}

BOOST_AUTO_TEST_CASE(give_up_at_the_limit) {
  GaussIRK steps(circle, 0.0, State<2>(1, 0), 0.125);
  steps.give_up_after(1000);
  BOOST_CHECK_THROW(steps.advance_to(1e9), ComputationFailed);
  BOOST_TEST(steps.effort().evaluations < 1300);
  BOOST_TEST(near(steps.y()[0], std::cos(steps.t()), 1.0, 64));
}

BOOST_AUTO_TEST_SUITE_END()
