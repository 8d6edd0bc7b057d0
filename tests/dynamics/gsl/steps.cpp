#include <boost/test/unit_test.hpp>

#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include <dynamics/gsl/steps.hpp>

#include <support/near.hpp>

using namespace kreisel;
using test::near;

namespace {

template <int n>
using State = Eigen::Matrix<double, n, 1>;

constexpr std::array methods = {GslMethod::rkf45, GslMethod::rk8pd, GslMethod::msadams,
                                GslMethod::msbdf, GslMethod::bsimp};

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

State<2> circle(double /*t*/, const State<2>& y) { return {-y[1], y[0]}; }

Jacobian<2> circle_jacobian(double /*t*/, const State<2>& /*y*/) {
  Jacobian<2> jacobian;
  jacobian.of_state << 0, -1, 1, 0;
  jacobian.of_time.setZero();
  return jacobian;
}

State<2> on_the_circle(double t) { return {std::cos(t), std::sin(t)}; }

/// y' = -k (y - cos t) - sin t, with the solution cos t.
struct Stiff {
  double k;

  template <class S>
  Eigen::Matrix<S, 1, 1> operator()(const S& t, const Eigen::Matrix<S, 1, 1>& y) const {
    using std::cos;
    using std::sin;
    return Eigen::Matrix<S, 1, 1>(S(-k * (y[0] - cos(t)) - sin(t)));
  }
};

bool starts_with(const Error& e, const char* words) {
  return std::string(e.what()).find(words) == 0;
}

}  // namespace

BOOST_AUTO_TEST_SUITE(gsl_steps)

// msbdf, of order 5 at most, is not suitable for the last line.
BOOST_AUTO_TEST_CASE(keep_the_accuracy_there_and_back) {
  for (const double tolerance : {1e-4, 1e-8, 1e-12}) {
    for (const GslMethod method : methods) {
      if (method == GslMethod::msbdf && tolerance < 1e-8) continue;
      GslSteps steps(method, circle, circle_jacobian, 0.0, State<2>(1, 0), {.relative = tolerance});
      steps.advance_to(2 * std::numbers::pi);
      const double error = (steps.y() - State<2>(1, 0)).norm();
      BOOST_TEST_MESSAGE(static_cast<int>(method) << " at " << tolerance << ": " << error << " for "
                                                  << steps.effort().evaluations);
      // The errors of multistep methods exceed their estimates.
      const bool multistep = method == GslMethod::msadams || method == GslMethod::msbdf;
      BOOST_TEST(error < (multistep ? 500 : 10) * tolerance);
      steps.advance_to(0);
      BOOST_TEST(steps.t() == 0);
      BOOST_TEST((steps.y() - State<2>(1, 0)).norm() < (multistep ? 500 : 10) * tolerance);
    }
  }
}

// Stability limits explicit steps to some 1/k: they would take 1e9 of them.
BOOST_AUTO_TEST_CASE(ignore_stiffness_if_implicit) {
  for (const double k : {1e3, 1e6, 1e9}) {
    for (const GslMethod method : {GslMethod::msbdf, GslMethod::bsimp}) {
      const Stiff field{k};
      GslSteps steps(method, field, forward_jacobian<1>(field), 0.0, State<1>(1.0),
                     {.relative = 1e-8});
      steps.advance_to(10);
      const double error = steps.y()[0] - std::cos(10);
      BOOST_TEST_MESSAGE("k = " << k << ", " << static_cast<int>(method) << ": " << error << " for "
                                << steps.effort().evaluations);
      BOOST_TEST(std::abs(error) < 2e-8);
      BOOST_TEST(steps.effort().evaluations < 2000);
    }
  }
}

// y'' + k y' + k y = 0: the Jacobian is not symmetric, so that its transpose would fail.
BOOST_AUTO_TEST_CASE(follow_the_slow_part_of_a_stiff_pair) {
  for (const double k : {1e4, 1e8}) {
    const auto field = [k](const auto& /*t*/, const auto& y) {
      using S = typename std::decay_t<decltype(y)>::Scalar;
      return Eigen::Matrix<S, 2, 1>(y[1], S(-k * (y[1] + y[0])));
    };
    const double slow = -2 / (1 + std::sqrt(1 - 4 / k));
    for (const GslMethod method : {GslMethod::msbdf, GslMethod::bsimp}) {
      GslSteps steps(method, field, forward_jacobian<2>(field), 0.0, State<2>(1, 0),
                     {.relative = 1e-8});
      steps.advance_to(3);
      const double error = steps.y()[0] - std::exp(3 * slow) * k / (k - slow * slow);
      BOOST_TEST_MESSAGE("k = " << k << ", " << static_cast<int>(method) << ": " << error << " for "
                                << steps.effort().evaluations);
      BOOST_TEST(std::abs(error) < 1e-6);
      BOOST_TEST(steps.effort().evaluations < 5000);
    }
  }
}

// GSL itself returns success with a NaN.
BOOST_AUTO_TEST_CASE(keep_the_last_state_at_the_field_edge) {
  const auto ends = [](double t, const State<2>& y) {
    return t > 1 ? State<2>(not_a_number, not_a_number) : circle(t, y);
  };
  for (const GslMethod method : methods) {
    GslSteps steps(method, ends, circle_jacobian, 0.0, State<2>(1, 0), {.relative = 1e-8});
    BOOST_CHECK_EXCEPTION(steps.advance_to(2), ComputationFailed, [](const ComputationFailed& e) {
      return starts_with(e, "integration stopped at t = ");
    });
    BOOST_TEST(std::abs(steps.t() - 1) < 1e-12);
    BOOST_TEST((steps.y() - on_the_circle(steps.t())).norm() < 1e-6);
    BOOST_TEST(steps.effort().evaluations < 1e4);
    BOOST_CHECK_THROW(steps.advance_to(2), ComputationFailed);
    steps.advance_to(0);
    BOOST_TEST((steps.y() - State<2>(1, 0)).norm() < 2e-6);
  }
}

// sqrt(y) has no value below y = 0: a step to such a point is repeated, not accepted.
BOOST_AUTO_TEST_CASE(retry_a_step_that_leaves_the_field) {
  const auto field = [](double, const State<1>& y) { return State<1>(-std::sqrt(y[0])); };
  const auto jacobian = [](double, const State<1>& y) {
    return Jacobian<1>{State<1>(-0.5 / std::sqrt(y[0])), State<1>(0.0)};
  };
  for (const GslMethod method : methods) {
    GslSteps steps(method, field, jacobian, 0.0, State<1>(1.0), {.relative = 1e-8});
    steps.advance_to(1.8);  // y = (1 - t/2)^2
    BOOST_TEST(std::abs(steps.y()[0] - 0.01) < 1e-5);
  }
}

BOOST_AUTO_TEST_CASE(pass_on_exceptions_of_the_field) {
  const auto field = [](double t, const State<2>& y) {
    if (t > 1) throw std::out_of_range("beyond the table");
    return circle(t, y);
  };
  const auto jacobian = [](double t, const State<2>& y) {
    if (t > 0.5) throw std::domain_error("no derivative");
    return circle_jacobian(t, y);
  };
  for (const GslMethod method : methods) {
    GslSteps steps(method, field, circle_jacobian, 0.0, State<2>(1, 0), {.relative = 1e-8});
    BOOST_CHECK_THROW(steps.advance_to(2), std::out_of_range);
    BOOST_TEST(steps.t() <= 1);
    BOOST_TEST((steps.y() - on_the_circle(steps.t())).norm() < 1e-6);
  }
  GslSteps steps(GslMethod::bsimp, circle, jacobian, 0.0, State<2>(1, 0), {.relative = 1e-8});
  BOOST_CHECK_THROW(steps.advance_to(2), std::domain_error);
}

// A block of 1e-9 beside one of 1: its error is measured relative to its own size, if requested.
BOOST_AUTO_TEST_CASE(measure_errors_relative_to_each_block) {
  const auto field = [](double, const State<4>& y) {
    return State<4>(-y[1], y[0], -3 * y[3], 3 * y[2]);
  };
  GslSteps steps(GslMethod::rk8pd, field, 0.0, State<4>(1, 0, 1e-9, 0),
                 {.relative = 1e-12, .absolute_scale = 0}, std::array<int, 2>{2, 2});
  steps.advance_to(2 * std::numbers::pi);
  BOOST_TEST(near(steps.y()[2], 1e-9, 1e-9, 1e6));
}

// msadams and msbdf read the allowed error of each component and control it themselves.
BOOST_AUTO_TEST_CASE(measure_blocks_in_multistep_methods) {
  const auto field = [](const auto& /*t*/, const auto& y) {
    using S = typename std::decay_t<decltype(y)>::Scalar;
    return Eigen::Matrix<S, 4, 1>(-y[1], y[0], -3 * y[3], 3 * y[2]);
  };
  const auto error = [&](GslMethod method, const auto& blocks) {
    GslSteps steps(method, field, forward_jacobian<4>(field), 0.0, State<4>(1, 0, 1e-9, 0),
                   {.relative = 1e-6, .absolute_scale = 0}, blocks);
    steps.advance_to(2 * std::numbers::pi);
    return (steps.y().template tail<2>() / 1e-9 - State<2>(1, 0)).norm();
  };
  for (const GslMethod method : {GslMethod::msadams, GslMethod::msbdf}) {
    const double apart = error(method, std::array{2, 2});
    const double together = error(method, std::array{4});
    BOOST_TEST_MESSAGE(static_cast<int>(method) << ": " << apart << ", as one block " << together);
    BOOST_TEST(apart < 1e-3);
    BOOST_TEST(together > 10 * apart);
  }
}

BOOST_AUTO_TEST_CASE(stay_if_the_end_is_the_start) {
  GslSteps steps(GslMethod::rkf45, circle, 5.0, State<2>(1, 0));
  BOOST_TEST(steps.advance_to(5) == State<2>(1, 0));
  BOOST_TEST(steps.effort().evaluations == 0);
}

BOOST_AUTO_TEST_CASE(refuse_a_field_that_is_not_finite) {
  const auto field = [](double, const State<1>&) { return State<1>(not_a_number); };
  GslSteps steps(GslMethod::rkf45, field, 3.0, State<1>(1.0));
  BOOST_CHECK_EXCEPTION(steps.advance_to(4), ComputationFailed, [](const ComputationFailed& e) {
    return std::string(e.what()) == "integration stopped at t = 3 s: the field is not finite";
  });
  BOOST_TEST(steps.effort().evaluations == 1);
}

BOOST_AUTO_TEST_CASE(refuse_invalid_accuracies) {
  const auto with = [](const Accuracy& accuracy) {
    GslSteps steps(GslMethod::rkf45, circle, 0.0, State<2>(1, 0), accuracy);
    return steps.t();
  };
  BOOST_CHECK_THROW(with({.relative = 1e-17}), InvalidInput);
  BOOST_CHECK_THROW(with({.relative = not_a_number}), InvalidInput);
  BOOST_CHECK_THROW(with({.relative = 0.1}), InvalidInput);
  BOOST_CHECK_THROW(with({.absolute_scale = not_a_number}), InvalidInput);
  BOOST_CHECK_THROW(with({.max_evaluations = not_a_number}), InvalidInput);
  BOOST_CHECK_THROW(GslSteps(static_cast<GslMethod>(9), circle, 0.0, State<2>(1, 0)), InvalidInput);
  BOOST_CHECK_EXCEPTION(
      GslSteps(GslMethod::bsimp, circle, 0.0, State<2>(1, 0)), InvalidInput,
      [](const InvalidInput& e) { return starts_with(e, "GSL bsimp needs a Jacobian"); });
  BOOST_CHECK_THROW(GslSteps(GslMethod::rkf45, circle, not_a_number, State<2>(1, 0)), InvalidInput);
  BOOST_CHECK_THROW(GslSteps(GslMethod::rkf45, circle, 0.0, State<2>(not_a_number, 0)),
                    InvalidInput);
  BOOST_CHECK_THROW(
      GslSteps(GslMethod::rkf45, circle, 0.0, State<2>(1, 0), Accuracy{}, std::array{1}),
      InvalidInput);
  GslSteps few(GslMethod::rkf45, circle, 0.0, State<2>(1, 0), {.max_evaluations = 100});
  BOOST_CHECK_THROW(few.advance_to(not_a_number), InvalidInput);
  BOOST_CHECK_THROW(few.advance_to(1e6), ComputationFailed);
  BOOST_TEST((few.y() - on_the_circle(few.t())).norm() < 1e-12);
}

BOOST_AUTO_TEST_SUITE_END()

BOOST_AUTO_TEST_SUITE(forward_jacobians)

BOOST_AUTO_TEST_CASE(agree_with_hand_computed_ones) {
  const auto field = [](const auto& t, const auto& y) {
    using std::sin;
    using S = std::decay_t<decltype(t)>;
    return Eigen::Matrix<S, 2, 1>(S(y[1] * t * t), S(-sin(y[0]) * y[1]));
  };
  const Jacobian<2> jacobian = forward_jacobian<2>(field)(2, State<2>(0.3, 0.7));
  Eigen::Matrix2d of_state;
  of_state << 0, 4, -std::cos(0.3) * 0.7, -std::sin(0.3);
  BOOST_TEST(near(jacobian.of_state, of_state, 1.0, 2));
  BOOST_TEST(near(jacobian.of_time, State<2>(0.7 * 4, 0), 1.0, 4));
}

BOOST_AUTO_TEST_SUITE_END()
