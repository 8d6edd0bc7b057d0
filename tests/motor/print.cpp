#include <boost/test/unit_test.hpp>

#include <iomanip>
#include <sstream>
#include <string>

#include <motor/print.hpp>
#include <motor/rate.hpp>

using namespace kreisel;

namespace {

template <class T>
std::string printed(const T& x) {
  std::ostringstream text;
  text << x;
  return text.str();
}

}  // namespace

BOOST_AUTO_TEST_SUITE(a_printed_motor)

BOOST_AUTO_TEST_CASE(has_its_resultant_first) {
  BOOST_TEST(printed(Motor<>{{1, 2, 3}, {4, 5, 6}}) == "(1, 2, 3; 4, 5, 6)");
}

BOOST_AUTO_TEST_CASE(takes_the_format_of_the_stream) {
  std::ostringstream text;
  text << std::fixed << std::setprecision(2) << Motor<>{{1, -2, 0.125}, {0, 1e3, 0}};
  BOOST_TEST(text.str() == "(1.00, -2.00, 0.12; 0.00, 1000.00, 0.00)");
}

BOOST_AUTO_TEST_CASE(looks_the_same_with_a_tag) {
  const Motor<> a{{1, 2, 3}, {4, 5, 6}};
  BOOST_TEST(printed(Force<Body>{a}) == printed(a));
  BOOST_TEST(printed(Velocity<Body, Guide, Inertial>{a}) == printed(a));
  BOOST_TEST(printed(Rate<Guide, Momentum<Body>>{a}) == printed(a));
  BOOST_TEST(printed(PlainRate<Guide, Momentum<Body>>{a}) == printed(a));
}

BOOST_AUTO_TEST_SUITE_END()
