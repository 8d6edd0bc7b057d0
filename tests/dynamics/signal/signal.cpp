// Functions of time against their closed forms.

#include <Eigen/Core>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <boost/test/unit_test.hpp>
#include <unsupported/Eigen/AutoDiff>

#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include <dynamics/signal/signal.hpp>

using namespace kreisel;

namespace {

using Exact = boost::multiprecision::cpp_bin_float_50;
using Number = Signal<double>;
using Vector = Signal<Vector3<double>>;

constexpr double u = std::numeric_limits<double>::epsilon() / 2;

}  // namespace

BOOST_AUTO_TEST_SUITE(signals)

BOOST_AUTO_TEST_CASE(constant_is_constant) {
  const Number f(3.5);
  BOOST_TEST(f.is_constant());
  BOOST_TEST(!f.jumps());
  BOOST_TEST(f.discontinuities().empty());
  BOOST_TEST(f(-1e9) == 3.5);
  BOOST_TEST(f.derivative(2, 1) == 0);
  BOOST_TEST(Number()(7.0) == 0);
}

BOOST_AUTO_TEST_CASE(oscillation_keeps_its_digits) {
  const Number f(0, 0, {{2.0, 0.785, 1.3}, {-0.5, 12.7, -2.1}});
  for (const double t : {0.0, 0.3, -17.9, 1e3 + 0.1, 31'556'952.25, -4.3e9, 1.7e15}) {
    const auto angle = [t](double w, double p) -> Exact { return Exact(w) * Exact(t) + Exact(p); };
    const Exact a = angle(0.785, 1.3), b = angle(12.7, -2.1);
    const Exact value = 2 * sin(a) - sin(b) / 2;
    const Exact rate = 2 * Exact(0.785) * cos(a) - Exact(12.7) * cos(b) / 2;
    const Exact bend =
        -2 * Exact(0.785) * Exact(0.785) * sin(a) + Exact(12.7) * Exact(12.7) * sin(b) / 2;
    BOOST_TEST(std::abs(double(Exact(f(t)) - value)) <= 3 * u * 2.5, "at " << t);
    BOOST_TEST(std::abs(double(Exact(f.derivative(t, 1)) - rate)) <= 4 * u * (1.57 + 6.35));
    BOOST_TEST(std::abs(double(Exact(f.derivative(t, 2)) - bend)) <= 5 * u * (1.24 + 80.7));
  }
}

BOOST_AUTO_TEST_CASE(line_and_oscillation_add_up) {
  const Vector f({1, 2, 3}, {0.5, 0, -1}, {{{0, 4, 0}, 2, 0}});
  const Vector3<double> now = f(3.0);
  BOOST_TEST(now.x() == 2.5);
  BOOST_TEST(std::abs(now.y() - (2 + 4 * std::sin(6.0))) <= 8 * u * 4);
  BOOST_TEST(now.z() == 0);
  BOOST_TEST(f.derivative(3, 1).z() == -1);
}

BOOST_AUTO_TEST_CASE(steps_jump_at_their_times) {
  const Number f = Number::steps({{0, 0.2}, {5, 0}, {6, 0}, {7, -1}});
  const double before_5 = std::nextafter(5.0, 0.0);
  BOOST_TEST(f(-1e-300) == 0);
  BOOST_TEST(f(0.0) == 0.2);
  BOOST_TEST(f(before_5) == 0.2);
  BOOST_TEST(f(5.0) == 0);
  BOOST_TEST(f(6.5) == 0);
  BOOST_TEST(f(1e9) == -1);
  BOOST_TEST(f.jumps());
  BOOST_TEST(f.discontinuities() == (std::vector<double>{0, 5, 7}),
             boost::test_tools::per_element());
}

BOOST_AUTO_TEST_CASE(broken_line_meets_its_points) {
  const Vector f = Vector::broken_line({{1, {0, 0, 1}}, {2, {0.5, 0, 1}}, {4, {0.5, -2, 1}}});
  BOOST_TEST((f(-3.0) == Vector3<double>(0, 0, 1)));
  BOOST_TEST((f(1.5) == Vector3<double>(0.25, 0, 1)));
  BOOST_TEST((f(2.0) == Vector3<double>(0.5, 0, 1)));
  BOOST_TEST((f(3.0) == Vector3<double>(0.5, -1, 1)));
  BOOST_TEST((f(9.0) == Vector3<double>(0.5, -2, 1)));
  BOOST_TEST((f.derivative(1, 1) == Vector3<double>(0.5, 0, 0)));
  BOOST_TEST((f.derivative(4, 1) == Vector3<double>(0, 0, 0)));
  BOOST_TEST(!f.jumps());
  BOOST_TEST(f.discontinuities() == (std::vector<double>{1, 2, 4}),
             boost::test_tools::per_element());
  BOOST_TEST(Number::broken_line({{3, 2}}).is_constant());
}

BOOST_AUTO_TEST_CASE(dual_numbers_carry_derivatives) {
  using First = Eigen::AutoDiffScalar<Eigen::Matrix<double, 1, 1>>;
  using Second = Eigen::AutoDiffScalar<Eigen::Matrix<First, 1, 1>>;
  const Vector f({1, 0, 0}, {0.5, 0, 0}, {{{2, 0, 1}, 3, 0.4}});
  First now(0.7);
  now.derivatives()[0] = 2;
  const Vector3<First> once = f(now);
  BOOST_TEST(once.x().value() == f(0.7).x());
  BOOST_TEST(once.x().derivatives()[0] == 2 * f.derivative(0.7, 1).x());
  Second time;
  time.value() = now;
  time.derivatives()[0] = First(1);
  const Vector3<Second> twice = f(time);
  BOOST_TEST(twice.z().derivatives()[0].derivatives()[0] == 2 * f.derivative(0.7, 2).z());
}

BOOST_AUTO_TEST_CASE(coefficients_sum_up_to_it) {
  const Number smooth(1, -0.5, {{2.0, 3, 0.4}});
  std::array<double, 25> c;
  smooth.coefficients(0.7, 0.1, c);
  double sum = 0;
  for (std::size_t k = c.size(); k-- > 0;) sum = sum * 1.5 + c[k];
  BOOST_TEST(std::abs(sum - smooth(0.85)) <= 16 * u);
  const Number line = Number::broken_line({{1, 0}, {2, 3}});
  line.coefficients(1, 0.5, c);
  BOOST_TEST((c[0] == 0 && c[1] == 1.5 && c[2] == 0));
}

// t^3 on [0, 1], then its own Taylor polynomial on [1, 3].
BOOST_AUTO_TEST_CASE(polynomials_hold_piece_by_piece) {
  const Number f = Number::polynomials({{0, 1}, 3, 4, {0, 0, 0, 1, 1, 3, 3, 1}});
  for (const double t : {0.0, 0.5, 1.0, 1.5, 3.0}) {
    BOOST_TEST(f(t) == t * t * t);
    BOOST_TEST(f.derivative(t, 1) == 3 * t * t);
    BOOST_TEST(f.derivative(t, 2) == 6 * t);
    BOOST_TEST(f.derivative(t, 3) == 6);
    BOOST_TEST(f.derivative(t, 4) == 0);
    BOOST_TEST(f.scaled(-2)(t) == -2 * t * t * t);
  }
  BOOST_TEST(!f.is_constant());
  BOOST_TEST(!f.is_analytic());
  BOOST_TEST(Number(1).is_analytic());
  BOOST_TEST(f.discontinuities().empty());
  BOOST_TEST(std::abs(f(3 + 1e-13) - 27) < 1e-11);
  BOOST_CHECK_THROW((void)f(3.001), InvalidInput);
  BOOST_CHECK_THROW((void)f(-0.001), InvalidInput);
  BOOST_CHECK_THROW((void)Number::polynomials({{0, 1}, 3, 4, {0, 0, 0, 1}}), InvalidInput);
}

BOOST_AUTO_TEST_CASE(scaling_scales_all) {
  const Number f = Number(1, 2, {{3, 4, 5}}).scaled(10);
  BOOST_TEST(std::abs(f(0.5) - (20 + 30 * std::sin(7.0))) <= 60 * u);
  BOOST_TEST(Number::steps({{1, 2}}).scaled(3)(1.0) == 6);
}

BOOST_AUTO_TEST_CASE(bad_numbers_are_refused) {
  const double nan = std::nan("");
  BOOST_CHECK_THROW(Number(0, nan, {}), InvalidInput);
  BOOST_CHECK_THROW(Number(0, 0, {{1, nan, 0}}), InvalidInput);
  BOOST_CHECK_THROW((void)Number::steps({}), InvalidInput);
  BOOST_CHECK_THROW((void)Number::steps({{0, 1}, {0, 2}}), InvalidInput);
  BOOST_CHECK_THROW((void)Number::steps({{nan, 1}}), InvalidInput);
  BOOST_CHECK_THROW((void)Vector::broken_line({{0, {0, 0, nan}}}), InvalidInput);
}

BOOST_AUTO_TEST_SUITE_END()
