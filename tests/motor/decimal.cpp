#include <boost/multiprecision/cpp_bin_float.hpp>
#include <boost/test/unit_test.hpp>

#include <string>

#include <motor/decimal.hpp>

using kreisel::decimal;
using kreisel::operator""_dd;

namespace {

using Truth = boost::multiprecision::cpp_bin_float_100;

/// The relative error of a decimal text.
double error(const std::string& text) {
  const kreisel::DoubleDouble found = decimal(text);
  const Truth exact(text);
  return static_cast<double>(abs((Truth(found.hi) + Truth(found.lo)) / exact - 1));
}

}  // namespace

BOOST_AUTO_TEST_SUITE(decimals)

BOOST_AUTO_TEST_CASE(decimals_keep_98_bits) {
  for (const char* text :
       {"0.1", "-9.80665", "7.292115e-5", "3.14159265358979323846264338327950", "1e22", "5E+3",
        "0.0000000000000000000000000000001234567890123456789", "123456789012345678901234567890.125",
        "1.5e-270", "-2.25e270", "+.5", "6.", "0.97024350638780445948283616771006"}) {
    BOOST_TEST(error(text) <= 0x1p-98, text);
  }
}

BOOST_AUTO_TEST_CASE(literals_are_decimals) {
  static_assert((0.25_dd).hi == 0.25 && (0.25_dd).lo == 0);
  static_assert((0.1_dd).hi == 0.1 && (0.1_dd).lo != 0);
  BOOST_TEST((decimal("-0.1") == -0.1_dd));
  BOOST_TEST((decimal("0") == 0));
}

BOOST_AUTO_TEST_SUITE_END()
