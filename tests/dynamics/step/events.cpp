#include <boost/test/unit_test.hpp>

#include <cmath>
#include <numbers>
#include <optional>

#include <dynamics/step/events.hpp>
#include <dynamics/step/explicit.hpp>

#include <support/near.hpp>
#include <support/worst.hpp>

using namespace kreisel;
using test::near;

namespace {

using State = Eigen::Vector2d;
constexpr double pi = std::numbers::pi;

State circle(double /*t*/, const State& y) { return {-y[1], y[0]}; }

auto turning() { return ExplicitRungeKutta(circle, 0.0, State(1, 0)); }

}  // namespace

BOOST_AUTO_TEST_SUITE(dense_output)

BOOST_AUTO_TEST_CASE(has_full_order_within_a_step) {
  ExplicitRungeKutta steps(circle, 0.0, State(1, 0), {.relative = 1e-12});
  double worst = 0;
  while (steps.t() < 10) {
    const double from = steps.t();
    steps.step_towards(10);
    for (int i = 0; i <= 20; ++i) {
      const double t = from + (steps.t() - from) * i / 20;
      worst = test::worst_of(worst, (steps.at(t) - State(std::cos(t), std::sin(t))).norm());
    }
  }
  BOOST_TEST_MESSAGE("worst " << worst);
  BOOST_TEST(worst < 1e-12);
}

// A million outputs do not shorten the steps.
BOOST_AUTO_TEST_CASE(does_not_change_the_steps) {
  auto alone = turning();
  alone.advance_to(100);
  auto watched = turning();
  while (watched.t() < 100) {
    const double from = watched.t();
    watched.step_towards(100);
    for (int i = 0; i < 1000; ++i) (void)watched.at(from + (watched.t() - from) * i / 1000);
  }
  BOOST_TEST(watched.y() == alone.y());
  BOOST_TEST(watched.effort().steps == alone.effort().steps);
}

BOOST_AUTO_TEST_CASE(ends_with_the_step) {
  auto steps = turning();
  steps.step_towards(1);
  BOOST_CHECK_THROW((void)steps.at(steps.t() + 1e-9), InvalidInput);
  BOOST_CHECK_THROW((void)steps.at(-1e-9), InvalidInput);
  BOOST_TEST(steps.at(0) == State(1, 0));
}

BOOST_AUTO_TEST_SUITE_END()

BOOST_AUTO_TEST_SUITE(jumps_of_the_field)

// A thrust of 1 from t = 1 on: y = (t - 1)^2 / 2. The declared discontinuity costs the steps no
// accuracy.
BOOST_AUTO_TEST_CASE(cost_nothing_if_declared) {
  const auto thrust = [](double t, const State& y) { return State(y[1], t < 1 ? 0 : std::cos(t)); };
  const auto run = [&](bool told) {
    ExplicitRungeKutta steps(thrust, 0.0, State(0, 0), {.relative = 1e-12});
    if (told) steps.stop_at({5, 1, -2});
    steps.advance_to(3);
    const double exact = -std::cos(3) + std::cos(1) - 2 * std::sin(1);
    return std::pair(std::abs(steps.y()[0] - exact), steps.effort().evaluations);
  };
  const auto [told_error, told_cost] = run(true);
  const auto [error, cost] = run(false);
  BOOST_TEST_MESSAGE("told: " << told_error << " for " << told_cost << ", else " << error << " for "
                              << cost);
  BOOST_TEST(told_error < 1e-13);
  BOOST_TEST(told_cost < cost / 2);
}

// A step would miss a pulse of 1 ms in 100 s.
BOOST_AUTO_TEST_CASE(are_not_stepped_over) {
  const auto pulse = [](double t, const State& y) {
    return State(y[1], t >= 50 && t < 50.001 ? 1000 : 0);
  };
  ExplicitRungeKutta steps(pulse, 0.0, State(0, 1));
  steps.stop_at({50, 50.001});
  steps.advance_to(100);
  BOOST_TEST(near(steps.y()[1], 1 + 1000 * (50.001 - 50), 2.0, 8));
}

BOOST_AUTO_TEST_CASE(are_hit_backwards_too) {
  const auto thrust = [](double t, const State& y) { return State(y[1], t <= 1 ? 0 : 1); };
  ExplicitRungeKutta steps(thrust, 3.0, State(2, 2));
  steps.stop_at({1});
  steps.advance_to(0);
  BOOST_TEST(near(steps.y()[0], 0.0, 2.0, 64));
}

BOOST_AUTO_TEST_SUITE_END()

BOOST_AUTO_TEST_SUITE(events)

BOOST_AUTO_TEST_CASE(are_found_to_the_last_places) {
  auto steps = turning();
  const auto height = [](double, const State& y) { return y[1]; };
  for (int k = 1; k <= 50; ++k) {
    const std::optional<double> t = advance_to_event(steps, height, 1000);
    BOOST_REQUIRE(t.has_value());
    BOOST_TEST(near(*t, k * pi, k * pi + 1, 64));
    BOOST_TEST(steps.t() == *t);
  }
}

BOOST_AUTO_TEST_CASE(count_in_the_given_direction) {
  auto steps = turning();
  const auto height = [](double, const State& y) { return y[1]; };
  BOOST_TEST(near(*advance_to_event(steps, height, 100, Crossing::rising), 2 * pi, 7.0, 64));
  BOOST_TEST(near(*advance_to_event(steps, height, 100, Crossing::falling), 3 * pi, 10.0, 64));
}

// g = 0 at the start is no event; the end of the run hides no event before it.
BOOST_AUTO_TEST_CASE(do_not_count_the_start) {
  auto steps = turning();
  const auto height = [](double, const State& y) { return y[1]; };
  BOOST_TEST(!advance_to_event(steps, height, 3).has_value());
  BOOST_TEST(steps.t() == 3);
  BOOST_TEST(advance_to_event(steps, height, 3.2).has_value());
}

// Two crossings in one step of a polynomial, whose steps are arbitrarily long.
BOOST_AUTO_TEST_CASE(are_both_found_in_one_step) {
  const auto clock = [](double, const State&) { return State(1, 0); };
  ExplicitRungeKutta steps(clock, 0.0, State(0, 0));
  const auto g = [](double, const State& y) { return (y[0] - 0.3) * (y[0] - 0.9); };
  BOOST_TEST(near(*advance_to_event(steps, g, 2), 0.3, 1.0, 16));
  BOOST_TEST(near(*advance_to_event(steps, g, 2), 0.9, 1.0, 16));
  BOOST_TEST(!advance_to_event(steps, g, 2).has_value());
}

BOOST_AUTO_TEST_CASE(are_found_backwards) {
  ExplicitRungeKutta steps(circle, 10.0, State(std::cos(10), std::sin(10)));
  const auto height = [](double, const State& y) { return y[1]; };
  BOOST_TEST(near(*advance_to_event(steps, height, 0), 3 * pi, 10.0, 64));
}

BOOST_AUTO_TEST_CASE(do_not_include_touching_zeros) {
  auto steps = turning();
  const auto square = [](double, const State& y) { return y[1] * y[1]; };
  BOOST_TEST(!advance_to_event(steps, square, 10).has_value());
}

BOOST_AUTO_TEST_CASE(are_refused_if_the_function_is_not_finite) {
  auto steps = turning();
  const auto ends = [](double t, const State& y) { return t > 1 ? std::sqrt(-1.0) : y[1] + 2; };
  BOOST_CHECK_THROW((void)advance_to_event(steps, ends, 10), ComputationFailed);
}

BOOST_AUTO_TEST_SUITE_END()
