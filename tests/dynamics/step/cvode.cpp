#include <boost/test/unit_test.hpp>

#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <string>

#include <dynamics/step/cvode.hpp>

using namespace kreisel;

namespace {

template <int n>
using State = Eigen::Matrix<double, n, 1>;

constexpr std::array methods = {CvodeMethod::adams, CvodeMethod::bdf};

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

State<2> circle(double /*t*/, const State<2>& y) { return {-y[1], y[0]}; }

State<2> on_the_circle(double t) { return {std::cos(t), std::sin(t)}; }

bool starts_with(const Error& e, const std::string& words) {
  return std::string(e.what()).find(words) == 0;
}

}  // namespace

BOOST_AUTO_TEST_SUITE(cvode_steps)

// bdf, of order 5 at most, is not suitable for the last line.
BOOST_AUTO_TEST_CASE(keep_the_accuracy_there_and_back) {
  for (const double tolerance : {1e-4, 1e-8, 1e-12}) {
    for (const CvodeMethod method : methods) {
      if (method == CvodeMethod::bdf && tolerance < 1e-8) continue;
      CvodeSteps steps(method, circle, 0.0, State<2>(1, 0), {.relative = tolerance});
      steps.advance_to(2 * std::numbers::pi);
      const double error = (steps.y() - State<2>(1, 0)).norm();
      BOOST_TEST_MESSAGE(static_cast<int>(method) << " at " << tolerance << ": " << error << " for "
                                                  << steps.effort().evaluations);
      BOOST_TEST(steps.t() == 2 * std::numbers::pi);
      BOOST_TEST(error < 1000 * tolerance);
      steps.advance_to(0);
      BOOST_TEST(steps.t() == 0);
      BOOST_TEST((steps.y() - State<2>(1, 0)).norm() < 2000 * tolerance);
    }
  }
}

// y' = -k (y - cos t) - sin t has the solution cos t. Stability limits explicit steps to 1/k.
BOOST_AUTO_TEST_CASE(ignore_stiffness_by_bdf) {
  for (const double k : {1e3, 1e6, 1e9}) {
    const auto field = [k](const auto& t, const auto& y) {
      using std::cos, std::sin;
      using S = typename std::decay_t<decltype(y)>::Scalar;
      return Eigen::Matrix<S, 1, 1>(S(-k * (y[0] - cos(t)) - sin(t)));
    };
    CvodeSteps exactly(CvodeMethod::bdf, field, forward_jacobian<1>(field), 0.0, State<1>(1.0),
                       {.relative = 1e-8});
    CvodeSteps by_differences(CvodeMethod::bdf, field, 0.0, State<1>(1.0), {.relative = 1e-8});
    BOOST_TEST(std::abs(exactly.advance_to(10)[0] - std::cos(10)) < 1e-6);
    BOOST_TEST(std::abs(by_differences.advance_to(10)[0] - std::cos(10)) < 1e-6);
    BOOST_TEST(exactly.effort().evaluations < 1500);
    BOOST_TEST(exactly.effort().jacobians > 0);
  }
}

// y'' + k y' + k y = 0: the Jacobian is not symmetric, so that its transpose would fail.
BOOST_AUTO_TEST_CASE(follow_the_slow_part_of_a_stiff_pair) {
  constexpr double k = 1e6;
  const auto field = [](const auto& /*t*/, const auto& y) {
    using S = typename std::decay_t<decltype(y)>::Scalar;
    return Eigen::Matrix<S, 2, 1>(y[1], S(-k * (y[1] + y[0])));
  };
  const double slow = -2 / (1 + std::sqrt(1 - 4 / k));
  CvodeSteps steps(CvodeMethod::bdf, field, forward_jacobian<2>(field), 0.0, State<2>(1, 0),
                   {.relative = 1e-8});
  steps.advance_to(3);
  BOOST_TEST(std::abs(steps.y()[0] - std::exp(3 * slow) * k / (k - slow * slow)) < 1e-6);
  BOOST_TEST(steps.effort().evaluations < 2000);
}

BOOST_AUTO_TEST_CASE(give_output_that_does_not_change_the_steps) {
  for (const CvodeMethod method : methods) {
    CvodeSteps asked(method, circle, 0.0, State<2>(1, 0), {.relative = 1e-8});
    CvodeSteps alone(method, circle, 0.0, State<2>(1, 0), {.relative = 1e-8});
    double from = 0;
    while (asked.t() != 3) {
      from = asked.t();
      asked.step_towards(3);
      for (const double part : {0.0, 0.3, 1.0}) {
        const double t = from + part * (asked.t() - from);
        BOOST_TEST((asked.at(t) - on_the_circle(t)).norm() < 1e-5);
      }
    }
    BOOST_TEST(!asked.covers(from - 0.1));
    BOOST_CHECK_THROW((void)asked.at(3.1), InvalidInput);
    BOOST_TEST((asked.y() == alone.advance_to(3)));
  }
}

BOOST_AUTO_TEST_CASE(keep_the_last_state_at_the_field_edge) {
  const auto ends = [](double t, const State<2>& y) {
    return t > 1 ? State<2>(not_a_number, not_a_number) : circle(t, y);
  };
  for (const CvodeMethod method : methods) {
    CvodeSteps steps(method, ends, 0.0, State<2>(1, 0), {.relative = 1e-8});
    BOOST_CHECK_EXCEPTION(steps.advance_to(2), ComputationFailed, [](const ComputationFailed& e) {
      return starts_with(e, "integration stopped at t = ");
    });
    BOOST_TEST(steps.t() <= 1);
    BOOST_TEST((steps.y() - on_the_circle(steps.t())).norm() < 1e-5);
    BOOST_TEST(steps.effort().evaluations < 1e4);
    BOOST_CHECK_THROW(steps.advance_to(2), ComputationFailed);
    steps.advance_to(0);
    BOOST_TEST((steps.y() - State<2>(1, 0)).norm() < 1e-5);
  }
}

BOOST_AUTO_TEST_CASE(pass_on_exceptions_of_the_field) {
  const auto field = [](double t, const State<2>& y) {
    if (t > 1) throw std::out_of_range("beyond the table");
    return circle(t, y);
  };
  for (const CvodeMethod method : methods) {
    CvodeSteps steps(method, field, 0.0, State<2>(1, 0), {.relative = 1e-8});
    BOOST_CHECK_THROW(steps.advance_to(2), std::out_of_range);
    BOOST_TEST(steps.t() <= 1);
    BOOST_TEST((steps.y() - on_the_circle(steps.t())).norm() < 1e-5);
  }
}

// A block of 1e-9 beside one of 1: its error is measured relative to its own size, if requested.
BOOST_AUTO_TEST_CASE(measure_errors_relative_to_each_block) {
  const auto field = [](double, const State<4>& y) {
    return State<4>(-y[1], y[0], -3 * y[3], 3 * y[2]);
  };
  const auto error = [&](std::span<const int> blocks) {
    CvodeSteps steps(CvodeMethod::adams, field, 0.0, State<4>(1, 0, 1e-9, 0),
                     {.relative = 1e-8, .absolute_scale = 0}, blocks);
    steps.advance_to(2 * std::numbers::pi);
    return (steps.y().tail<2>() / 1e-9 - State<2>(1, 0)).norm();
  };
  BOOST_TEST(error(std::array{2, 2}) < 1e-5);
  BOOST_TEST(error(std::array{4}) > 1e-5);
}

BOOST_AUTO_TEST_CASE(accept_fields_of_dynamic_size) {
  const auto field = [](double, const Eigen::VectorXd& y, Eigen::VectorXd& rate) { rate = -y; };
  for (const CvodeMethod method : methods) {
    CvodeSteps steps(method, field, 0.0, Eigen::VectorXd(Eigen::VectorXd::Ones(3)),
                     {.relative = 1e-8});
    BOOST_TEST((steps.advance_to(1).array() - std::exp(-1)).abs().maxCoeff() < 1e-6);
  }
}

BOOST_AUTO_TEST_CASE(refuse_invalid_accuracies) {
  const auto with = [](const Accuracy& accuracy) {
    CvodeSteps steps(CvodeMethod::adams, circle, 0.0, State<2>(1, 0), accuracy);
    return steps.t();
  };
  BOOST_CHECK_THROW(with({.relative = 1e-17}), InvalidInput);
  BOOST_CHECK_THROW(with({.relative = not_a_number}), InvalidInput);
  BOOST_CHECK_THROW(with({.absolute_scale = not_a_number}), InvalidInput);
  BOOST_CHECK_THROW(CvodeSteps(CvodeMethod::adams, circle, not_a_number, State<2>(1, 0)),
                    InvalidInput);
  BOOST_CHECK_THROW(CvodeSteps(CvodeMethod::adams, circle, 0.0, State<2>(not_a_number, 0)),
                    InvalidInput);
  BOOST_CHECK_THROW(
      CvodeSteps(CvodeMethod::adams, circle, 0.0, State<2>(1, 0), Accuracy{}, std::array{1}),
      InvalidInput);
  CvodeSteps few(CvodeMethod::adams, circle, 0.0, State<2>(1, 0), {.max_evaluations = 100});
  BOOST_CHECK_THROW(few.advance_to(not_a_number), InvalidInput);
  BOOST_CHECK_THROW(few.advance_to(1e6), ComputationFailed);
  BOOST_TEST((few.advance_to(few.t()) - on_the_circle(few.t())).norm() < 1e-9);
}

BOOST_AUTO_TEST_SUITE_END()
