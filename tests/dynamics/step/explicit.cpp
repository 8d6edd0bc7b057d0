#include <boost/test/unit_test.hpp>

#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include <dynamics/step/events.hpp>
#include <dynamics/step/explicit.hpp>

#include <support/near.hpp>
#include <support/perturbed.hpp>
#include <support/wide.hpp>
#include <support/worst.hpp>

using namespace kreisel;
using test::near;

namespace {

template <int n>
using State = Eigen::Matrix<double, n, 1>;

/// A circle of period 2 pi, entered at angle 0.
State<2> circle(double /*t*/, const State<2>& y) { return {-y[1], y[0]}; }

/// The error after a turn of the circle in steps held to `tolerance`, and their cost.
struct Turn {
  double error, evaluations;
};

Turn turn_of_a_circle(double tolerance) {
  ExplicitRungeKutta steps(circle, 0.0, State<2>(1, 0), {.relative = tolerance});
  steps.advance_to(2 * std::numbers::pi);
  return {(steps.y() - State<2>(1, 0)).norm(), steps.effort().evaluations};
}

}  // namespace

BOOST_AUTO_TEST_SUITE(verners_coefficients)

BOOST_AUTO_TEST_CASE(have_rows_that_sum_to_the_nodes) {
  for (std::size_t i = 0; i < Verner98::stages; ++i) {
    long double sum = 0;
    for (const DoubleDouble& a : Verner98::a[i]) sum += test::wide(a);
    BOOST_TEST(near(sum, test::wide(Verner98::node[i]), 64.0L, 4));
  }
}

// Quadrature of powers: the order conditions of a field that depends on time alone. The embedded
// weights have order 8. For t^8 they must be wrong, or the estimate would always be 0.
BOOST_AUTO_TEST_CASE(integrate_powers_of_time) {
  for (int power = 0; power < 9; ++power) {
    long double ninth = 0;
    long double difference = 0;
    for (std::size_t i = 0; i < Verner98::stages; ++i) {
      const long double x = std::pow(test::wide(Verner98::node[i]), power);
      ninth += test::wide(Verner98::b[i]) * x;
      difference += test::wide(Verner98::difference[i]) * x;
    }
    BOOST_TEST(near(ninth, 1.0L / (power + 1), 2.0L, 4));
    if (power < 8) BOOST_TEST(near(difference, 0.0L, 6.0L, 4));
    if (power == 8) BOOST_TEST(std::abs(difference) > 1e-8L);
  }
}

// sum b_i a_ij c_j^k = 1/((k+1)(k+2)): the conditions that combine b, a and c.
BOOST_AUTO_TEST_CASE(integrate_powers_of_time_twice) {
  for (int power = 0; power < 8; ++power) {
    long double sum = 0;
    for (std::size_t i = 0; i < Verner98::stages; ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        sum += test::wide(Verner98::b[i] * Verner98::a[i][j]) *
               std::pow(test::wide(Verner98::node[j]), power);
      }
    }
    BOOST_TEST(near(sum, 1.0L / ((power + 1) * (power + 2)), 8.0L, 4));
  }
}

// The stages of the polynomial have order 8 each, apart from the field's response to their own
// error. The ninth power occurs for t^8 alone.
BOOST_AUTO_TEST_CASE(integrate_powers_of_time_within_the_step) {
  const auto node = [](std::size_t j) {
    return test::wide(j < Verner98::stages ? Verner98::node[j]
                                           : Verner98::later_node[j - Verner98::stages]);
  };
  const auto sum = [&](const Verner98::LaterRow& row, int power) {
    long double all = 0;
    for (std::size_t j = 0; j < row.size(); ++j)
      all += test::wide(row[j]) * std::pow(node(j), power);
    return all;
  };
  for (int power = 0; power < 8; ++power) {
    for (std::size_t i = 0; i < Verner98::later_stages; ++i) {
      const long double end = test::wide(Verner98::later_node[i]);
      const long double integral = std::pow(end, power + 1) / (power + 1);
      BOOST_TEST(near(sum(Verner98::later[i], power), integral, 2.0L, 4));
    }
    BOOST_TEST(std::abs(sum(Verner98::ninth, power)) <= 1e-12L);  // given to 16 digits
  }
  BOOST_TEST(std::abs(sum(Verner98::ninth, 8) - 1 / 9.0L) <= 1e-12L);
}

// A nonlinear field at fixed steps: a coarse tolerance accepts every step. Halving the step divides
// the error by 2^9.
BOOST_AUTO_TEST_CASE(converge_with_order_nine) {
  using Wide = Eigen::Matrix<long double, 1, 1>;
  const auto error = [](int n) {
    const auto riccati = [](long double t, const Wide& y) {
      return Wide(1 + y[0] * y[0] * std::cos(t));
    };
    const auto run = [&](int steps) {
      ExplicitRungeKutta integration(riccati, 0.0L, Wide(0.1L),
                                     {.relative = 1e-2, .absolute_scale = 1e6});
      for (int i = 1; i <= steps; ++i) integration.advance_to(0.8L * i / steps);
      return integration.y()[0];
    };
    return std::abs(run(n) - run(64 * n));
  };
  const double order = std::log2(static_cast<double>(error(4) / error(8)));
  BOOST_TEST_MESSAGE("observed order " << order);
  BOOST_TEST(order > 8.5);
  BOOST_TEST(order < 9.8);
}

// The same within the steps: no worse than at their ends.
BOOST_AUTO_TEST_CASE(converge_with_order_nine_within_steps) {
  using Wide = Eigen::Matrix<long double, 1, 1>;
  const auto riccati = [](long double t, const Wide& y) {
    return Wide(1 + y[0] * y[0] * std::cos(t));
  };
  const auto errors = [&](int n) {
    ExplicitRungeKutta rough(riccati, 0.0L, Wide(0.1L), {.relative = 1e-2, .absolute_scale = 1e6});
    ExplicitRungeKutta exact(riccati, 0.0L, Wide(0.1L), {.relative = 1e-16});
    long double within = 0;
    for (int i = 1; i <= n; ++i) {
      const long double from = rough.t();
      rough.advance_to(0.8L * i / n);
      for (const long double share : {0.1L, 0.3L, 0.5L, 0.7L, 0.9L}) {
        const long double t = from + share * (rough.t() - from);
        within = test::worst_of(within, std::abs(rough.at(t)[0] - exact.advance_to(t)[0]));
      }
    }
    BOOST_TEST(rough.effort().evaluations <= 26 * n + 2);
    return std::array{within, std::abs(rough.y()[0] - exact.advance_to(0.8L)[0])};
  };
  const auto [coarse, coarse_end] = errors(4);
  const auto [fine, fine_end] = errors(8);
  BOOST_TEST_MESSAGE("within " << coarse << ", " << fine << ", at the end " << coarse_end << ", "
                               << fine_end);
  BOOST_TEST(std::log2(static_cast<double>(coarse / fine)) > 8.5);
  BOOST_TEST(coarse <= 2 * coarse_end);
  BOOST_TEST(fine <= 2 * fine_end);
}

BOOST_AUTO_TEST_SUITE_END()

BOOST_AUTO_TEST_SUITE(explicit_steps)

BOOST_AUTO_TEST_CASE(keep_the_accuracy) {
  for (const double tolerance : {1e-4, 1e-6, 1e-8, 1e-10, 1e-12, 1e-14}) {
    const Turn turn = turn_of_a_circle(tolerance);
    BOOST_TEST_MESSAGE(tolerance << ": " << turn.error << " for " << turn.evaluations);
    BOOST_TEST(turn.error < 20 * tolerance);  // a turn takes 3 to 20 steps
  }
  BOOST_TEST(turn_of_a_circle(1e-14).evaluations < 1100);
}

// A fast angle on which nothing depends, beside a circle. The start costs one Euler step for every
// hundredfold of its rate. Rounding of so large a change slows the growth of steps, which costs a
// step or two of 16 evaluations. 165 evaluations, not 1442 with first steps according to the rate.
BOOST_AUTO_TEST_CASE(start_by_curvature_not_by_a_running_angle) {
  const auto evaluations = [](double rate) {
    const auto field = [rate](double, const State<3>& y) { return State<3>(-y[1], y[0], rate); };
    ExplicitRungeKutta steps(field, 0.0, State<3>(1, 0, 0), {.relative = 1e-12},
                             std::array<int, 2>{2, 1});
    steps.advance_to(1);
    BOOST_TEST(near(steps.y()[0], std::cos(1), 1.0, 2e4));
    BOOST_TEST(near(steps.y()[2], rate, std::abs(rate), 8));
    BOOST_TEST(steps.effort().rejected == 0);
    return steps.effort().evaluations;
  };
  const double still = evaluations(0);
  for (const double rate : {1.0, 1e3, 1e6, 1e9}) BOOST_TEST(evaluations(rate) <= still + 40);
  BOOST_TEST(evaluations(-1e6) == evaluations(1e6));
}

// From rest, or if an Euler step leaves the field: sqrt(1 - y^2) has no value beyond y = 1.
BOOST_AUTO_TEST_CASE(start_at_rest_and_at_the_field_edge) {
  const auto from_rest = [](double t, const State<1>& /*y*/) { return State<1>(t * t); };
  ExplicitRungeKutta resting(from_rest, 0.0, State<1>(0.0), {.relative = 1e-12});
  BOOST_TEST(near(resting.advance_to(3)[0], 9.0, 9.0, 64));
  const auto sine = [](double /*t*/, const State<1>& y) {
    return State<1>(std::sqrt(1 - y[0] * y[0]));
  };
  ExplicitRungeKutta rising(sine, std::asin(0.999), State<1>(0.999), {.relative = 1e-12});
  BOOST_TEST(near(rising.advance_to(1.57)[0], std::sin(1.57), 1.0, 1e5));
  ExplicitRungeKutta still(circle, 0.0, State<2>(0, 0));
  BOOST_TEST(still.advance_to(-7) == State<2>(0, 0));
}

BOOST_AUTO_TEST_CASE(go_there_and_back) {
  ExplicitRungeKutta steps(circle, 0.0, State<2>(1, 0));
  steps.advance_to(100);
  steps.advance_to(-3);
  BOOST_TEST(near(steps.y()[0], std::cos(3), 1.0, 2000));
  BOOST_TEST(near(steps.y()[1], -std::sin(3), 1.0, 2000));
}

BOOST_AUTO_TEST_CASE(stay_if_the_end_is_the_start) {
  ExplicitRungeKutta steps(circle, 5.0, State<2>(1, 0));
  BOOST_TEST(steps.advance_to(5) == State<2>(1, 0));
  steps.step_towards(5);
  BOOST_TEST(steps.t() == 5);
  BOOST_TEST(steps.effort().evaluations == 0);
}

// 1e6 additions of 0.1 in plain double are off by 1e-6: the time must not be.
BOOST_AUTO_TEST_CASE(keep_time) {
  const auto clock = [](double, const State<1>&) { return State<1>(1.0); };
  ExplicitRungeKutta steps(clock, 0.0, State<1>(0.0));
  for (int i = 1; i <= 100000; ++i) steps.advance_to(i * 0.1);
  BOOST_TEST(near(steps.y()[0], 10000.0, 10000.0, 2));
}

// Coefficients rounded to 53 bits err to the same side in each step. Uncorrected, the energy
// drifted by 7e-14, and in a thousand periods the phase by 8e-12.
BOOST_AUTO_TEST_CASE(do_not_drift) {
  const double amplitude = 0.7;
  const auto swing = [](double, const State<2>& y) { return State<2>(y[1], -std::sin(y[0])); };
  const auto energy = [](const State<2>& y) {
    const double sine = std::sin(y[0] / 2);
    return y[1] * y[1] / 2 + 2 * sine * sine;
  };
  const State<2> start(amplitude, 0);
  ExplicitRungeKutta steps(swing, 0.0, start, {.relative = 1e-16});
  steps.advance_to(1000 * 4 * std::comp_ellint_1(std::sin(amplitude / 2)));
  const double drift = energy(steps.y()) / energy(start) - 1;
  BOOST_TEST_MESSAGE("energy off by " << drift << ", phase by " << steps.y()[1] / amplitude);
  // A random walk of half a last digit in each of 8e4 steps.
  BOOST_TEST(std::abs(drift) <= 3e-14);
  // The time of so many periods itself is rounded to 1e-12.
  BOOST_TEST(std::abs(steps.y()[1]) <= 3e-12);
}

// sqrt(1 - y) has no value beyond y = 1: a step to such a point is repeated, not accepted.
BOOST_AUTO_TEST_CASE(retry_a_step_that_leaves_the_field) {
  const auto field = [](double, const State<1>& y) { return State<1>(-std::sqrt(y[0])); };
  ExplicitRungeKutta steps(field, 0.0, State<1>(1.0), {.relative = 1e-10});
  steps.advance_to(1.8);  // y = (1 - t/2)^2
  BOOST_TEST(near(steps.y()[0], 0.01, 1.0, 1e6));
}

// The same with a field that throws there. If it throws at every step, however short, its message
// is the reason.
BOOST_AUTO_TEST_CASE(retry_a_step_at_which_the_field_throws) {
  const auto field = [](double, const State<1>& y) {
    if (y[0] < 0) throw ComputationFailed("no root below 0");
    return State<1>(-std::sqrt(y[0]));
  };
  ExplicitRungeKutta steps(field, 0.0, State<1>(1.0), {.relative = 1e-10});
  steps.advance_to(1.8);
  BOOST_TEST(near(steps.y()[0], 0.01, 1.0, 1e6));

  const auto ends = [](double t, const State<1>& y) {
    if (t > 1) throw ComputationFailed("the road ends");
    return State<1>(y);
  };
  ExplicitRungeKutta last(ends, 0.0, State<1>(1.0));
  BOOST_CHECK_EXCEPTION(last.advance_to(2), ComputationFailed, [](const ComputationFailed& e) {
    const std::string text = e.what();
    return text.starts_with("integration stopped at t = ") && text.ends_with(" s: the road ends");
  });
  BOOST_TEST(std::abs(last.t() - 1) < 1e-12);
}

BOOST_AUTO_TEST_CASE(keep_the_last_state_at_the_field_edge) {
  const auto field = [](double t, const State<1>& y) {
    return t > 1 ? State<1>(std::numeric_limits<double>::quiet_NaN()) : State<1>(y);
  };
  ExplicitRungeKutta steps(field, 0.0, State<1>(1.0));
  BOOST_CHECK_EXCEPTION(steps.advance_to(2), ComputationFailed, [](const ComputationFailed& e) {
    return std::string(e.what()).find("integration stopped at t = ") == 0;
  });
  BOOST_TEST(std::abs(steps.t() - 1) < 1e-12);
  BOOST_TEST(near(steps.y()[0], std::exp(steps.t()), 3.0, 20));
  BOOST_TEST(steps.effort().evaluations < 1e4);
}

BOOST_AUTO_TEST_CASE(refuse_a_field_that_is_not_finite) {
  const auto field = [](double, const State<1>&) {
    return State<1>(std::numeric_limits<double>::quiet_NaN());
  };
  ExplicitRungeKutta steps(field, 3.0, State<1>(1.0));
  BOOST_CHECK_EXCEPTION(steps.advance_to(4), ComputationFailed, [](const ComputationFailed& e) {
    return std::string(e.what()) == "integration stopped at t = 3 s: the field is not finite";
  });
  BOOST_TEST(steps.effort().evaluations == 1);
}

// A block of 1e-9 beside one of 1: its error is measured relative to its own size, if requested.
BOOST_AUTO_TEST_CASE(measure_errors_relative_to_each_block) {
  const auto field = [](double, const State<4>& y) {
    return State<4>(-y[1], y[0], -3 * y[3], 3 * y[2]);
  };
  ExplicitRungeKutta steps(field, 0.0, State<4>(1, 0, 1e-9, 0),
                           {.relative = 1e-13, .absolute_scale = 0}, std::array<int, 2>{2, 2});
  steps.advance_to(2 * std::numbers::pi);
  BOOST_TEST(near(steps.y()[2], 1e-9, 1e-9, 1e5));
}

BOOST_AUTO_TEST_CASE(distinguish_stiff_from_fast_fields) {
  const auto with = [](double spring, double damping, double accuracy) {
    const auto field = [=](double, const State<2>& y) {
      return State<2>(y[1], -spring * y[0] - damping * y[1]);
    };
    ExplicitRungeKutta steps(field, 0.0, State<2>(1, 0), {.relative = accuracy});
    const double end = spring == 1 ? 1000 : 10;
    bool tells = false;
    while (steps.t() != end) {
      steps.step_towards(end);
      tells = tells || steps.stiff();
    }
    return tells;
  };
  for (const double accuracy : {1e-3, 1e-6, 1e-10, 1e-14}) {
    BOOST_TEST(with(1, 0, accuracy) == false);
    BOOST_TEST(with(1e4, 0, accuracy) == false);
    BOOST_TEST(with(1e4, 1e4, accuracy) == true);
  }
}

// The field is a difference of terms with a rounding of 1e-12, and the solution stays below
// absolute_scale = 1e-3. The required 1e-17 a step would need steps of 1e-5 s.
BOOST_AUTO_TEST_CASE(do_not_shorten_steps_for_rounding) {
  const auto field = [](double t, const State<2>& y) {
    return State<2>(y[1], -y[0] + 1e-3 * (((1e4 + std::cos(7 * t)) - 1e4) - std::cos(7 * t)));
  };
  ExplicitRungeKutta steps(field, 0.0, State<2>(1e-5, 0), {.relative = 1e-14},
                           std::array<int, 2>{1, 1});
  steps.advance_to(10);
  BOOST_TEST_MESSAGE(steps.effort().evaluations << " evaluations");
  BOOST_TEST(steps.effort().evaluations < 2e4);
  BOOST_TEST(std::abs(steps.y()[0] - 1e-5 * std::cos(10.0)) < 1e-14);
}

// Perturbations of 10 units in the last digit of each step, up or down, are a random walk; a state
// at rest stays at rest. In this measure 1 % of 20000 plane walks lie below 0.38 and 1 % above 1.9.
BOOST_AUTO_TEST_CASE(deviate_by_their_perturbation) {
  const auto made = [](double digits) {
    const auto field = [](double, const Eigen::Vector3d& y) {
      return Eigen::Vector3d(y[1], -y[0], y[2]);
    };
    return ExplicitRungeKutta(field, 0.0, Eigen::Vector3d(1, 0, 0),
                              {.relative = 1e-12, .perturbed = digits});
  };
  const double off = test::perturbed_deviation(made);
  BOOST_TEST_MESSAGE("off by " << off << " of the walk's length");
  BOOST_TEST(off > 0.3);
  BOOST_TEST(off < 2);
  BOOST_TEST(test::perturbed_deviation(made) == off);
  BOOST_TEST(made(10).advance_to(500)[2] == 0);
}

BOOST_AUTO_TEST_CASE(refuse_invalid_accuracies) {
  const auto with = [](const Accuracy& accuracy) {
    return ExplicitRungeKutta(circle, 0.0, State<2>(1, 0), accuracy);
  };
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  BOOST_CHECK_THROW(with({.relative = 1e-21}), InvalidInput);
  BOOST_CHECK_THROW(with({.relative = 0}), InvalidInput);
  BOOST_CHECK_THROW(with({.relative = nan}), InvalidInput);
  BOOST_CHECK_THROW(with({.relative = 0.1}), InvalidInput);
  BOOST_CHECK_THROW(with({.absolute_scale = nan}), InvalidInput);
  BOOST_CHECK_THROW(with({.max_evaluations = nan}), InvalidInput);
  BOOST_CHECK_THROW(with({.max_evaluations = 0}), InvalidInput);
  BOOST_CHECK_THROW(ExplicitRungeKutta(circle, nan, State<2>(1, 0)), InvalidInput);
  BOOST_CHECK_THROW(ExplicitRungeKutta(circle, 0.0, State<2>(nan, 0)), InvalidInput);
  ExplicitRungeKutta steps(circle, 0.0, State<2>(1, 0));
  BOOST_CHECK_THROW(steps.advance_to(nan), InvalidInput);
  ExplicitRungeKutta few(circle, 0.0, State<2>(1, 0), {.max_evaluations = 100});
  BOOST_CHECK_THROW(few.advance_to(1e6), ComputationFailed);
}

BOOST_AUTO_TEST_SUITE_END()

// States of dynamic size.
BOOST_AUTO_TEST_SUITE(explicit_steps_of_any_size)

namespace {

using Eigen::VectorXd;

/// Five pendulums in a row with springs between them, the first one driven: 10 components.
template <class Vector>
void chain(double t, const Vector& y, Vector& rate) {
  const Eigen::Index n = y.size() / 2;
  for (Eigen::Index i = 0; i < n; ++i) {
    const double before = i == 0 ? std::cos(1.5 * t) : y[i - 1];
    const double after = i == n - 1 ? 0 : y[i + 1];
    rate[i] = y[n + i];
    rate[n + i] = -std::sin(y[i]) + 3 * (before - 2 * y[i] + after);
  }
}

const std::vector<int> ones(10, 1);

State<10> start() {
  State<10> y;
  for (int i = 0; i < 10; ++i) y[i] = std::sin(3.0 * i + 1);
  return y;
}

auto fixed_steps(const Accuracy& accuracy = {.relative = 1e-12}) {
  const auto field = [](double t, const State<10>& y) {
    State<10> rate;
    chain(t, y, rate);
    return rate;
  };
  return ExplicitRungeKutta(field, 0.0, start(), accuracy, ones);
}

auto steps_in_place(const Accuracy& accuracy = {.relative = 1e-12}) {
  const auto field = [](double t, const VectorXd& y, VectorXd& rate) { chain(t, y, rate); };
  return ExplicitRungeKutta(field, 0.0, VectorXd(start()), accuracy, ones);
}

auto steps_by_value() {
  const auto field = [](double t, const VectorXd& y) {
    VectorXd rate(y.size());
    chain(t, y, rate);
    return rate;
  };
  return ExplicitRungeKutta(field, 0.0, VectorXd(start()), {.relative = 1e-12}, ones);
}

}  // namespace

BOOST_AUTO_TEST_CASE(agree_with_steps_of_fixed_size) {
  auto fixed = fixed_steps();
  auto in_place = steps_in_place();
  auto by_value = steps_by_value();
  double worst = 0;
  const auto compare = [&](const VectorXd& truth) {
    BOOST_TEST((in_place.y() == by_value.y()));
    worst = test::worst_of(worst, (in_place.y() - truth).norm() / truth.norm());
  };
  for (const double t : {5.0, 20.0, -3.0}) {
    fixed.advance_to(t);
    in_place.advance_to(t);
    by_value.advance_to(t);
    compare(fixed.y());
    BOOST_TEST(in_place.effort().evaluations == fixed.effort().evaluations);
  }
  // Within a step, and further from there.
  fixed.step_towards(10);
  in_place.step_towards(10);
  const double length = fixed.t() + 3;
  for (const double share : {0.0, 0.3, 0.8, 0.1, 0.5, 0.99, 1.0}) {
    const double t = -3 + share * length;
    const VectorXd truth = fixed.at(t);
    worst = test::worst_of(worst, (in_place.at(t) - truth).norm() / truth.norm());
  }
  fixed.back_to(-3 + 0.4 * length);
  in_place.back_to(-3 + 0.4 * length);
  fixed.advance_to(0);
  in_place.advance_to(0);
  by_value.advance_to(0);
  worst = test::worst_of(worst, (in_place.y() - fixed.y()).norm() / fixed.y().norm());
  BOOST_TEST_MESSAGE("fixed and run-time size differ by " << worst);
  BOOST_TEST(worst < 1e-13);
  // and back to the start, by steps of 1e-12
  BOOST_TEST((in_place.y() - start()).norm() < 1e-9);
}

BOOST_AUTO_TEST_CASE(accept_fields_that_write_in_place) {
  const auto field = [](double t, const State<10>& y, State<10>& rate) { chain(t, y, rate); };
  ExplicitRungeKutta in_place(field, 0.0, start(), {.relative = 1e-12}, ones);
  auto by_value = fixed_steps();
  BOOST_TEST((in_place.advance_to(5) == by_value.advance_to(5)));
}

BOOST_AUTO_TEST_CASE(find_events_and_stop_at_jumps) {
  auto fixed = fixed_steps();
  auto in_place = steps_in_place();
  const auto first = [](double, const auto& y) { return y[0]; };
  for (int i = 0; i < 5; ++i) {
    const auto truth = advance_to_event(fixed, first, 30.0);
    const auto found = advance_to_event(in_place, first, 30.0);
    BOOST_REQUIRE((truth.has_value() && found.has_value()));
    BOOST_TEST(std::abs(*found - *truth) < 1e-12);
  }
  const auto thrust = [](double t, const VectorXd& y, VectorXd& rate) {
    rate[0] = y[1];
    rate[1] = t < 1 ? 0 : 2;
  };
  ExplicitRungeKutta steps(thrust, 0.0, VectorXd(VectorXd::Zero(2)));
  steps.stop_at({1.0});
  steps.advance_to(3);
  BOOST_TEST(near(steps.y()[0], 4.0, 4.0, 8));
  BOOST_TEST(steps.effort().rejected == 0);
}

// No step fits between times that differ by rounding.
BOOST_AUTO_TEST_CASE(take_a_jump_beside_an_end_as_at_the_end) {
  for (const double jump : {std::nextafter(1.0, 0.0), 1.0, std::nextafter(1.0, 2.0)}) {
    const auto thrust = [jump](double t, const VectorXd& y, VectorXd& rate) {
      rate[0] = y[1];
      rate[1] = t < jump ? 0 : 2;
    };
    ExplicitRungeKutta steps(thrust, 0.0, VectorXd(VectorXd::Zero(2)));
    steps.stop_at({jump});
    BOOST_TEST(steps.advance_to(1)[1] == 0);
    BOOST_TEST(near(steps.advance_to(3)[0], 4.0, 4.0, 8));
    BOOST_TEST(near(steps.advance_to(1)[1], 0.0, 4.0, 8));
    BOOST_TEST(near(steps.advance_to(-1)[0], 0.0, 4.0, 16));
    BOOST_TEST(steps.effort().rejected == 0);
  }
}

BOOST_AUTO_TEST_CASE(recognise_a_stiff_field) {
  for (const double damping : {0.0, 1e4}) {
    const auto field = [=](double, const VectorXd& y, VectorXd& rate) {
      rate[0] = y[1];
      rate[1] = -1e4 * y[0] - damping * y[1];
    };
    ExplicitRungeKutta steps(field, 0.0, VectorXd(VectorXd::Unit(2, 0)), {.relative = 1e-6});
    steps.advance_to(10);
    BOOST_TEST(steps.stiff() == (damping > 0));
  }
}

BOOST_AUTO_TEST_CASE(refuse_wrong_blocks_and_rates) {
  const auto field = [](double, const VectorXd& y) { return VectorXd(y.head(2)); };
  const VectorXd y = VectorXd::Ones(3);
  BOOST_CHECK_THROW(ExplicitRungeKutta(field, 0.0, y, {}, std::vector<int>{2, 2}), InvalidInput);
  ExplicitRungeKutta steps(field, 0.0, y);
  BOOST_CHECK_EXCEPTION(steps.advance_to(1), InvalidInput, [](const InvalidInput& e) {
    return e.what() == std::string("the field gives 2 rates of 3 components");
  });
}

BOOST_AUTO_TEST_SUITE_END()
