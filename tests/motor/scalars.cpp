#include <boost/multiprecision/cpp_bin_float.hpp>
#include <boost/test/unit_test.hpp>

#include <cmath>
#include <cstddef>
#include <sstream>
#include <vector>

#include <motor/print.hpp>

#include <support/everything.hpp>
#include <support/near.hpp>

/// All functions agree with their formulas, for every scalar type.

using namespace kreisel;
using test::near;

using Digits50 = boost::multiprecision::cpp_bin_float_50;

namespace {

template <class S>
std::vector<S> all() {
  std::vector<S> numbers;
  test::everything(test::Inputs<S>{}, [&](const S& x) { numbers.push_back(x); });
  return numbers;
}

/// The errors of all numbers against 50 digits, in u of S and of max(1, |number|).
template <class S>
void check_against_fifty_digits() {
  static const std::vector<Digits50> exact = all<Digits50>();
  const std::vector<S> numbers = all<S>();
  BOOST_TEST_REQUIRE(numbers.size() == exact.size());
  BOOST_TEST(numbers.size() > 800u);
  for (std::size_t i = 0; i < exact.size(); ++i) {
    const S expected = static_cast<S>(exact[i]);
    using std::abs;
    const S scale = S(1) > S(abs(expected)) ? S(1) : S(abs(expected));
    BOOST_TEST_CONTEXT("number " << i) { BOOST_TEST(near(numbers[i], expected, scale, 40)); }
  }
}

}  // namespace

BOOST_AUTO_TEST_SUITE(all_functions_agree_with_fifty_digits)

BOOST_AUTO_TEST_CASE(in_float) { check_against_fifty_digits<float>(); }
BOOST_AUTO_TEST_CASE(in_double) { check_against_fifty_digits<double>(); }
BOOST_AUTO_TEST_CASE(in_long_double) { check_against_fifty_digits<long double>(); }

BOOST_AUTO_TEST_CASE(in_print) {
  std::ostringstream text;
  text << Motor<Digits50>{{1, 2, 3}, {4, 5, 6}} << Motor<float>{{1, 2, 3}, {4, 5, 6}};
  BOOST_TEST(text.str() == "(1, 2, 3; 4, 5, 6)(1, 2, 3; 4, 5, 6)");
}

BOOST_AUTO_TEST_SUITE_END()
