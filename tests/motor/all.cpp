#include <boost/test/unit_test.hpp>

#include <sstream>

#include <motor/all.hpp>

using namespace kreisel;

// One header is enough to write with the calculus.
BOOST_AUTO_TEST_CASE(calculus_from_one_header) {
  const Motor<> a{{1, 0, 0}, {0, 2, 0}};
  std::ostringstream out;
  out << cross(a, a);
  BOOST_TEST(out.str().find('0') != std::string::npos);
  BOOST_TEST((opening(a) == a.resultant));
  BOOST_TEST((Pose<>{}.rotation == Matrix3<double>::Identity()));
}
