#include <Eigen/Core>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <boost/test/data/monomorphic.hpp>
#include <boost/test/data/test_case.hpp>
#include <boost/test/unit_test.hpp>
#include <unsupported/Eigen/AutoDiff>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include <support/cast.hpp>
#include <support/everything.hpp>
#include <support/near.hpp>
#include <support/sample.hpp>

/// All functions accept Eigen's dual numbers, and those of exp and log are the derivatives.

using namespace kreisel;
using test::cast;
using test::near;
using test::same;
namespace data = boost::unit_test::data;

using Digits50 = boost::multiprecision::cpp_bin_float_50;
using Vector6 = Eigen::Matrix<double, 6, 1>;
using Dual = Eigen::AutoDiffScalar<Vector6>;

namespace {

template <class S>
std::vector<S> all() {
  std::vector<S> numbers;
  test::everything(test::Inputs<S>{}, [&](const S& x) { numbers.push_back(x); });
  return numbers;
}

/// A motor of six independent variables.
Motor<Dual> variables(const Motor<>& a) {
  Motor<Dual> v;
  for (int i = 0; i < 3; ++i) {
    v.resultant[i] = Dual(a.resultant[i], 6, i);
    v.moment[i] = Dual(a.moment[i], 6, 3 + i);
  }
  return v;
}

template <class S>
Motor<S> unit(int variable) {
  Motor<S> unit;
  (variable < 3 ? unit.resultant : unit.moment)[variable % 3] = S(1);
  return unit;
}

/// The derivative of every entry by one variable.
template <int Rows, int Columns>
Eigen::Matrix<double, Rows, Columns> slope(const Eigen::Matrix<Dual, Rows, Columns>& m,
                                           int variable) {
  return m.unaryExpr([=](const Dual& x) { return x.derivatives()[variable]; });
}

const double angles[] = {0,    1e-12, 1e-3, 2.46e-3, 2.47e-3, 0.01, 0.1, 0.5,
                         0.99, 1.01,  2,    2.09,    2.1,     3,    3.14};

/// Differentiated formulas lose digits by cancellation: u / theta, outside the series.
double error_at(double theta) { return theta < 2.4607e-3 ? 16 : 16 + 2 / theta; }

}  // namespace

BOOST_AUTO_TEST_SUITE(dual_numbers)

BOOST_AUTO_TEST_CASE(agree_with_double_in_all_functions) {
  const std::vector<double> plain = all<double>();
  const std::vector<Dual> dual = all<Dual>();
  BOOST_TEST_REQUIRE(dual.size() == plain.size());
  for (std::size_t i = 0; i < plain.size(); ++i) {
    BOOST_TEST_CONTEXT("number " << i) {
      BOOST_TEST(near(dual[i].value(), plain[i], std::max(1.0, std::abs(plain[i])), 40));
      BOOST_TEST(dual[i].derivatives().norm() == 0);  // no input was a variable
    }
  }
}

// At the identity the tangent of exp is the motor itself, exactly, and so is that of log.
BOOST_AUTO_TEST_CASE(are_exact_at_the_identity) {
  const Pose<Dual> X = exp(variables(Motor<>{}));
  const Motor<Dual> A = log(X);
  for (int i = 0; i < 6; ++i) {
    BOOST_TEST(same(slope(X.rotation, i), skew(unit<double>(i).resultant)));
    BOOST_TEST(same(slope(X.translation, i), unit<double>(i).moment));
    BOOST_TEST(same(slope(A.resultant, i), unit<double>(i).resultant));
    BOOST_TEST(same(slope(A.moment, i), unit<double>(i).moment));
  }
}

// Against central differences in 50 digits.
BOOST_DATA_TEST_CASE(are_the_derivatives_of_the_exponential, data::make(angles), theta) {
  test::Sample sample(1);
  const Motor<> A{theta * sample.direction(), sample.vector(-1, 1)};
  const Pose<Dual> X = exp(variables(A));
  const Digits50 h("1e-20");
  for (int i = 0; i < 6; ++i) {
    const Pose<Digits50> forth = exp(cast<Digits50>(A) + h * unit<Digits50>(i));
    const Pose<Digits50> back = exp(cast<Digits50>(A) - h * unit<Digits50>(i));
    const Matrix3<Digits50> dR = (forth.rotation - back.rotation) / (2 * h);
    const Vector3<Digits50> dx = (forth.translation - back.translation) / (2 * h);
    BOOST_TEST(near(slope(X.rotation, i), cast<double>(dR), 1.0, error_at(theta)));
    BOOST_TEST(
        near(slope(X.translation, i), cast<double>(dx), 1 + A.moment.norm(), error_at(theta)));
  }
}

// log(exp(A)) = A: at zero, in every branch, and near the half turn, where log has a corner.
BOOST_DATA_TEST_CASE(derivatives_of_log_invert_those_of_exp, data::make(angles), theta) {
  test::Sample sample(1);
  const Motor<> A{theta * sample.direction(), sample.vector(-1, 1)};
  const Motor<Dual> B = log(exp(variables(A)));
  for (int i = 0; i < 6; ++i) {
    BOOST_TEST(near(slope(B.resultant, i), unit<double>(i).resultant, 1.0, error_at(theta)));
    BOOST_TEST(
        near(slope(B.moment, i), unit<double>(i).moment, 1 + A.moment.norm(), error_at(theta)));
  }
}

BOOST_AUTO_TEST_SUITE_END()
