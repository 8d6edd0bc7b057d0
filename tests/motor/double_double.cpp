#include <boost/multiprecision/cpp_bin_float.hpp>
#include <boost/test/data/monomorphic.hpp>
#include <boost/test/data/test_case.hpp>
#include <boost/test/unit_test.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>

#include <motor/double_double_functions.hpp>

using kreisel::DoubleDouble;

namespace {

using Truth = boost::multiprecision::cpp_bin_float_100;

Truth exactly(const DoubleDouble& x) { return Truth(x.hi) + Truth(x.lo); }

/// Numbers of 106 bits, down to 5e-5 of the greatest.
class Numbers {
 public:
  DoubleDouble next(double greatest) {
    const double leading = greatest * any_(random_) * std::exp(-10 * std::abs(any_(random_)));
    return DoubleDouble(leading) + leading * 0x1p-54 * any_(random_);
  }

 private:
  std::mt19937_64 random_{1};
  std::uniform_real_distribution<double> any_{-1, 1};
};

/// The greatest relative error in 4000 numbers; of results below `least` it is relative to that.
template <class Function, class True>
double worst(double greatest, const Function& function, const True& truth, double least = 0) {
  Numbers numbers;
  double most = 0;
  for (int i = 0; i < 4000; ++i) {
    const DoubleDouble x = numbers.next(greatest);
    const Truth exact = truth(exactly(x));
    const Truth size = std::max<Truth>(abs(exact), least);
    most = std::max(most, static_cast<double>(abs(exactly(function(x)) - exact) / size));
  }
  return most;
}

}  // namespace

BOOST_AUTO_TEST_SUITE(double_double)

// Products whose rounding matters must not be contracted: a compiler that does so leaves 2^-53.
BOOST_AUTO_TEST_CASE(operations_keep_102_bits) {
  constexpr double bound = 0x1p-102;
  const DoubleDouble other = DoubleDouble(1) / 3;
  const Truth third = exactly(other);
  BOOST_TEST(worst(
                 10, [&](auto x) { return x * other; },
                 [&](Truth x) -> Truth { return x * third; }) <= bound);
  BOOST_TEST(worst(
                 10, [&](auto x) { return x * x + other * other; },
                 [&](Truth x) -> Truth { return x * x + third * third; }) <= bound);
  BOOST_TEST(worst(
                 10, [&](auto x) { return x * 0.1 - 0.1 * other; },
                 [&](Truth x) -> Truth { return Truth(0.1) * (x - third); }, 0.1) <= bound);
  BOOST_TEST(worst(
                 10, [&](auto x) { return other / x; },
                 [&](Truth x) -> Truth { return third / x; }) <= bound);
  BOOST_TEST(worst(
                 10, [&](auto x) { return x / 0.7; },
                 [&](Truth x) -> Truth { return x / Truth(0.7); }) <= bound);
  BOOST_TEST(worst(
                 10, [&](auto x) { return sqrt(x * x); },
                 [&](Truth x) -> Truth { return abs(x); }) <= bound);
  BOOST_TEST(worst(
                 10, [&](auto x) { return hypot(x, other); },
                 [&](Truth x) -> Truth { return sqrt(x * x + third * third); }) <= bound);
}

BOOST_AUTO_TEST_CASE(functions_keep_74_bits) {
  constexpr double bound = 0x1p-74;
#define KEEPS(name, greatest, least)                                        \
  BOOST_TEST(worst(                                                         \
                 greatest, [](auto x) { return name(x); },                  \
                 [](Truth x) -> Truth { return name(x); }, least) <= bound, \
             #name)
  KEEPS(sin, 0.78, 0);
  KEEPS(sin, 1e3, 1);
  KEEPS(cos, 0.78, 0);
  KEEPS(cos, 1e3, 1);
  KEEPS(tan, 1.5, 0);
  KEEPS(atan, 50, 0);
  KEEPS(asin, 0.999, 0);
  KEEPS(acos, 0.9, 0);
  KEEPS(exp, 100, 0);
  KEEPS(expm1, 1, 0);
  KEEPS(sinh, 3, 0);
  KEEPS(cosh, 3, 0);
  KEEPS(tanh, 3, 0);
  KEEPS(atanh, 0.999, 0);
  KEEPS(log1p, 0.9, 0);
#undef KEEPS
  BOOST_TEST(worst(
                 10, [](auto x) { return log(abs(x)); },
                 [](Truth x) -> Truth { return log(abs(x)); }, 1) <= bound);
  // An angle of 1e12 rad has an error of its own of 2^-105 times as much.
  BOOST_TEST(worst(
                 1e12, [](auto x) { return sin(x); }, [](Truth x) -> Truth { return sin(x); }, 1) <=
             1e12 * 0x1p-105);
}

BOOST_AUTO_TEST_CASE(limits_of_double_are_kept) {
  const DoubleDouble infinite = std::numeric_limits<DoubleDouble>::infinity();
  BOOST_TEST(isinf(1 / DoubleDouble(0)));
  BOOST_TEST((1 / infinite == 0));
  BOOST_TEST(isinf(infinite / 3));
  BOOST_TEST((sqrt(DoubleDouble(0)) == 0));
  BOOST_TEST(isnan(sqrt(DoubleDouble(-1))));
  BOOST_TEST(isinf(exp(DoubleDouble(1e6))));
  BOOST_TEST((1 / cosh(DoubleDouble(1e6)) == 0));
  BOOST_TEST((hypot(DoubleDouble(3e-300), DoubleDouble(4e-300)).hi == 5e-300));
  BOOST_TEST((sin(DoubleDouble(1e-300)).hi == 1e-300));
}

BOOST_AUTO_TEST_CASE(integers_are_exact) {
  constexpr std::int64_t great = 0x7fff'ffff'ffff'fffd;
  BOOST_TEST((exactly(DoubleDouble(great)) == Truth(great)));
  BOOST_TEST((exactly(DoubleDouble(-great)) == -Truth(great)));
  BOOST_TEST((floor(DoubleDouble(1) - 0x1p-80) == 0));
  BOOST_TEST((floor(DoubleDouble(great)) == DoubleDouble(great)));
  BOOST_TEST((round(DoubleDouble(2.5)) == 3));
  BOOST_TEST((round(DoubleDouble(0.5) - 0x1p-80) == 0));
  BOOST_TEST((round(DoubleDouble(-2.5)) == -3));
  BOOST_TEST((fmod(DoubleDouble(-7.5), DoubleDouble(2)) == -1.5));
  BOOST_TEST((remainder(DoubleDouble(7.5), DoubleDouble(2)) == -0.5));
}

BOOST_AUTO_TEST_SUITE_END()
