// The Floquet chart as a reader runs it: its numbers are those of the reference.

#include <boost/test/unit_test.hpp>

#include <cmath>
#include <sstream>
#include <string>
#include <vector>

#include <support/program.hpp>

using namespace kreisel;

BOOST_AUTO_TEST_SUITE(the_example_of_the_unsymmetric_rotor)

// tests/data/floquet.json, ten decimals.
BOOST_AUTO_TEST_CASE(prints_the_boundaries_of_the_reference) {
  const test::Scratch folder;
  const std::string picture = (folder.path() / "chart.svg").string();
  const test::Outcome outcome = test::run(KREISEL_PROGRAMS "/unsymmetric_rotor " + picture);
  BOOST_REQUIRE_MESSAGE(outcome.status == 0, outcome.err);
  const std::vector<double> expected{0.8856789666, 0.8881356123, 1.1420336198, 1.1554647390,
                                     1.5243782782, 1.6806016561, 0.8875479371, 0.8925632598,
                                     1.1350304451, 1.1618323628, 1.4619698304, 1.7804757751};
  std::istringstream all(outcome.out);
  std::string line;
  std::getline(all, line);  // the heading
  std::string name;
  double unequal = 0, begin = 0, end = 0, growth = 0;
  for (std::size_t i = 0; i < expected.size(); i += 2) {
    all >> name >> unequal >> begin >> end >> growth;
    BOOST_TEST(std::abs(begin - expected[i]) < 1.1e-10);
    BOOST_TEST(std::abs(end - expected[i + 1]) < 1.1e-10);
    BOOST_TEST(growth > 1);
  }
  BOOST_TEST(folder.read("chart.svg").find("<svg") != std::string::npos);
}

BOOST_AUTO_TEST_SUITE_END()
