#include <boost/test/unit_test.hpp>

// Written out, because BOOST_TEST_MODULE does nothing once the header is precompiled.
int main(int argc, char* argv[]) {
  return boost::unit_test::unit_test_main([] { return true; }, argc, argv);
}
