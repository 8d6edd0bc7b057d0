#include <boost/test/unit_test.hpp>

#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include <dynamics/step/checkpoint.hpp>
#include <dynamics/step/events.hpp>
#include <dynamics/step/taylor.hpp>

#include <support/near.hpp>
#include <support/perturbed.hpp>

using namespace kreisel;
using test::near;

namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

using Vector = Eigen::Matrix<double, 2, 1>;

/// y'' = -y, by its series.
struct Circle {
  static constexpr int most_order = 24;

  template <class Coefficients>
  void operator()(double /*t*/, double h, int order, Coefficients& c) const {
    for (int k = 0; k < order; ++k) {
      c(0, k + 1) = h * c(1, k) / (k + 1);
      c(1, k + 1) = -h * c(0, k) / (k + 1);
    }
  }
};

/// y' = y^2, which ends at t = 1/y(0); and a clock beside it.
struct Pole {
  static constexpr int most_order = 24;

  template <class Coefficients>
  void operator()(double /*t*/, double h, int order, Coefficients& c) const {
    for (int k = 0; k < order; ++k) {
      double sum = 0;
      for (int i = 0; i <= k; ++i) sum += c(0, i) * c(0, k - i);
      c(0, k + 1) = h * sum / (k + 1);
      c(1, k + 1) = k == 0 ? h : 0;
    }
  }
};

/// y' = 0 before t = 1, then 1.
struct Switched {
  static constexpr int most_order = 24;

  template <class Coefficients>
  void operator()(double t, double h, int order, Coefficients& c) const {
    c.middleCols(1, order).setZero();
    if (t >= 1) c(0, 1) = h;
  }
};

/// y'' = 1 - y from t = 0 on, and at rest before.
struct Late {
  static constexpr int most_order = 24;

  template <class Coefficients>
  void operator()(double t, double h, int order, Coefficients& c) const {
    c.middleCols(1, order).setZero();
    if (t < 0) return;
    for (int k = 0; k < order; ++k) {
      c(0, k + 1) = h * c(1, k) / (k + 1);
      c(1, k + 1) = h * ((k == 0 ? 1 : 0) - c(0, k)) / (k + 1);
    }
  }
};

/// y' = cos(64 t).
struct Driven {
  static constexpr int most_order = 24;
  static constexpr double frequency = 64;  // a power of 2: its phase is exact

  template <class Coefficients>
  void operator()(double t, double h, int order, Coefficients& c) const {
    double derivative = std::cos(frequency * t);
    double next = -std::sin(frequency * t);
    double factor = h;
    for (int k = 0; k < order; ++k) {
      c(0, k + 1) = factor * derivative;
      c(1, k + 1) = 0;
      factor *= frequency * h / (k + 2);
      derivative = std::exchange(next, -derivative);
    }
  }
};

}  // namespace

BOOST_AUTO_TEST_SUITE(taylor)

// A hundred turns. In the worst case the errors of steps add up.
BOOST_AUTO_TEST_CASE(keeps_the_accuracy) {
  for (const double accuracy : {1e-3, 1e-6, 1e-9, 1e-12, 1e-15}) {
    TaylorSteps steps(Circle{}, 0, Vector(1, 0), {.relative = accuracy});
    const Vector y = steps.advance_to(628);
    const double error = (y - Vector(std::cos(628), -std::sin(628))).norm();
    BOOST_TEST_MESSAGE(accuracy << ": off by " << error << " in " << steps.effort().steps
                                << " steps of order "
                                << steps.effort().evaluations / steps.effort().steps);
    BOOST_TEST(error <= steps.effort().steps * (accuracy + 1e-16));
    BOOST_TEST(error >= 1e-4 * accuracy);
  }
}

// Steps from times between two numbers had the phase of the next number, off by up to 9e-13 s at
// t = 1e4 s. The result was off by 1e-10.
BOOST_AUTO_TEST_CASE(keeps_the_phase_of_what_drives_it) {
  const double begin = 1e4;
  const double end = begin + 1000;
  TaylorSteps<Vector, Driven> steps({}, begin, Vector(0, 0), {1e-15, 0.02});
  const double y = steps.advance_to(end)[0];
  const double exact = (std::sin(64 * end) - std::sin(64 * begin)) / 64;
  BOOST_TEST(steps.effort().steps > 3000);
  BOOST_TEST(std::abs(y - exact) < 2e-15);
}

BOOST_AUTO_TEST_CASE(runs_back_to_the_start) {
  TaylorSteps steps(Circle{}, 3, Vector(1, 0.5));
  steps.advance_to(20);
  const Vector y = steps.advance_to(3);
  BOOST_TEST(steps.t() == 3);
  BOOST_TEST(near(y, Vector(1, 0.5), 1.0, 40));
}

// Output is the series itself: as accurate as the steps, without effect on them.
BOOST_AUTO_TEST_CASE(gives_output_within_steps) {
  TaylorSteps undisturbed(Circle{}, 0, Vector(1, 0));
  undisturbed.advance_to(10);
  TaylorSteps steps(Circle{}, 0, Vector(1, 0));
  for (double t = 0; t < 10; t += 0.03125) {
    while (!steps.covers(t)) steps.step_towards(10);
    BOOST_TEST(near(steps.at(t), Vector(std::cos(t), -std::sin(t)), 1.0, 20));
  }
  steps.advance_to(10);
  BOOST_TEST(steps.y() == undisturbed.y());
  BOOST_TEST(steps.effort().evaluations == undisturbed.effort().evaluations);
  BOOST_CHECK_THROW((void)steps.at(11), InvalidInput);
  BOOST_CHECK_THROW((void)steps.at(0), InvalidInput);
  TaylorSteps first(Circle{}, 0, Vector(1, 0));
  first.step_towards(0);
  BOOST_TEST(first.effort().steps == 0);
  first.step_towards(10);
  BOOST_TEST(first.at(0) == Vector(1, 0));
}

BOOST_AUTO_TEST_CASE(finds_events) {
  TaylorSteps steps(Circle{}, 0, Vector(1, 0));
  const auto first = advance_to_event(
      steps, [](double /*t*/, const Vector& y) { return y[0]; }, 100, Crossing::rising);
  BOOST_REQUIRE(first);
  BOOST_TEST(near(*first, 4.71238898038468985769, 1.0, 40));
  steps.advance_to(6);
  BOOST_TEST(near(steps.y(), Vector(std::cos(6), -std::sin(6)), 1.0, 40));
}

// Near the end of the series steps get ever shorter: the solution is accurate up to there, and the
// steps stop. An error of a last digit in time causes y^2 times that in y.
BOOST_AUTO_TEST_CASE(stops_just_before_a_pole) {
  TaylorSteps steps(Pole{}, 0, Vector(1, 0));
  const std::array<int, 2> blocks = {1, 1};
  TaylorSteps apart(Pole{}, 0, Vector(1, 0), {}, blocks);
  BOOST_TEST(near(apart.advance_to(0.999)[0], 1000.0, 1e6, 40));
  BOOST_TEST(near(apart.y()[1], 0.999, 1.0, 2));
  BOOST_CHECK_EXCEPTION(steps.advance_to(2), ComputationFailed, [&](const ComputationFailed& e) {
    BOOST_TEST_MESSAGE(e.what());
    return std::string(e.what()).find("integration stopped at t = 0.99999999") == 0;
  });
  BOOST_TEST(steps.y()[0] > 1e8);
  BOOST_TEST(steps.t() < 1);
}

BOOST_AUTO_TEST_CASE(ends_steps_at_jumps_of_the_field) {
  TaylorSteps steps(Switched{}, 0, Vector(0, 1));
  steps.stop_at({1});
  BOOST_TEST(near(steps.advance_to(3)[0], 2.0, 1.0, 2));
}

// A state at rest needs one step for any time; an interval of length 0 needs none.
BOOST_AUTO_TEST_CASE(takes_no_more_steps_than_needed) {
  TaylorSteps steps(Circle{}, 0, Vector(0, 0), {.absolute_scale = 0});
  BOOST_TEST(steps.advance_to(1e9).isZero(0));
  BOOST_TEST(steps.effort().steps == 1);
  steps.advance_to(1e9);
  BOOST_TEST(steps.effort().steps == 1);
}

// A state of 1e-200 among units of 1, and one at the upper end of the range.
BOOST_AUTO_TEST_CASE(does_not_depend_on_the_size_of_the_state) {
  for (const double size : {1e-200, 1e200}) {
    TaylorSteps steps(Circle{}, 0, Vector(size, 0), {.absolute_scale = 0});
    BOOST_TEST(
        near(Vector(steps.advance_to(6) / size), Vector(std::cos(6), -std::sin(6)), 1.0, 20));
  }
}

BOOST_AUTO_TEST_CASE(goes_back_within_a_step) {
  TaylorSteps steps(Circle{}, 0, Vector(1, 0));
  steps.step_towards(10);
  const double half = steps.t() / 2;
  steps.back_to(half);
  BOOST_TEST(steps.t() == half);
  BOOST_TEST(near(steps.advance_to(6), Vector(std::cos(6), -std::sin(6)), 1.0, 20));
}

BOOST_AUTO_TEST_CASE(continues_from_a_checkpoint_exactly) {
  TaylorSteps whole(Circle{}, 0, Vector(1, 0));
  for (int i = 0; i < 5; ++i) whole.step_towards(100);
  detail::Checkpoint taken;
  whole.pass(taken);
  TaylorSteps resumed(Circle{}, 0, Vector(1, 0));
  detail::Checkpoint set(taken.numbers());
  resumed.pass(set);
  set.finish();
  BOOST_TEST(resumed.at(resumed.t() - 0.01) == whole.at(whole.t() - 0.01));
  BOOST_TEST(resumed.advance_to(100) == whole.advance_to(100));
  BOOST_TEST(resumed.effort().steps == whole.effort().steps);
}

// Its series is in units of the last step, powers of which may overflow or underflow.
BOOST_AUTO_TEST_CASE(changes_its_unit_after_a_long_rest) {
  TaylorSteps steps(Late{}, -1e21, Vector(0, 0), {.relative = 1e-15});
  steps.stop_at({0});
  steps.advance_to(10);
  BOOST_TEST(near(steps.y()[0], 1 - std::cos(10.0), 1.0, 40));
  BOOST_TEST(near(steps.y()[1], std::sin(10.0), 1.0, 40));
}

// Perturbations of 10 units in the last digit of each step, up or down, are a random walk.
BOOST_AUTO_TEST_CASE(deviates_by_its_perturbation) {
  const auto made = [](double digits) {
    return TaylorSteps(Circle{}, 0, Vector(1, 0), {.relative = 1e-12, .perturbed = digits});
  };
  const double off = test::perturbed_deviation(made);
  BOOST_TEST_MESSAGE("off by " << off << " of the walk's length");
  BOOST_TEST(off > 0.3);
  BOOST_TEST(off < 1.5);
  BOOST_TEST(test::perturbed_deviation(made) == off);
}

BOOST_AUTO_TEST_CASE(refuses_invalid_arguments) {
  const Vector y(1, 0);
  BOOST_CHECK_THROW(TaylorSteps(Circle{}, 0, y, {.perturbed = -1}), InvalidInput);
  BOOST_CHECK_THROW(TaylorSteps(Circle{}, 0, y, {.perturbed = not_a_number}), InvalidInput);
  BOOST_CHECK_THROW(TaylorSteps(Circle{}, not_a_number, y), InvalidInput);
  BOOST_CHECK_THROW(TaylorSteps(Circle{}, 0, Vector(1, not_a_number)), InvalidInput);
  BOOST_CHECK_THROW(TaylorSteps(Circle{}, 0, y, {.relative = 1e-21}), InvalidInput);
  TaylorSteps steps(Circle{}, 0, y);
  BOOST_CHECK_THROW(steps.advance_to(not_a_number), InvalidInput);
  TaylorSteps few(Circle{}, 0, y, {.max_evaluations = 100});
  BOOST_CHECK_THROW(few.advance_to(1000), ComputationFailed);
  TaylorSteps infinite(Pole{}, 0, Vector(1e200, 0));
  BOOST_CHECK_THROW(infinite.advance_to(1), ComputationFailed);
}

BOOST_AUTO_TEST_SUITE_END()
