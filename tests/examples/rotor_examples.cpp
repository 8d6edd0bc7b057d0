// The examples with fast rotors as a reader runs them: their numbers are those of the reference.

#include <boost/test/unit_test.hpp>

#include <cmath>
#include <sstream>
#include <string>
#include <vector>

#include <support/program.hpp>

using namespace kreisel;

namespace {

/// The numbers of each line after `heading` lines, without words.
std::vector<std::vector<double>> table(const std::string& text, int heading) {
  std::istringstream all(text);
  std::vector<std::vector<double>> rows;
  for (std::string line; std::getline(all, line);) {
    if (heading-- > 0) continue;
    rows.emplace_back();
    std::istringstream words(line);
    for (std::string word; words >> word;) {
      char* end = nullptr;
      const double x = std::strtod(word.c_str(), &end);
      if (*end == 0) rows.back().push_back(x);
    }
  }
  return rows;
}

test::Outcome run(const std::string& command) {
  test::Outcome outcome = test::run(KREISEL_PROGRAMS "/" + command);
  BOOST_REQUIRE_MESSAGE(outcome.status == 0, outcome.err);
  return outcome;
}

}  // namespace

BOOST_AUTO_TEST_SUITE(the_examples_with_rotors)

// tests/data/rotors.json, P_free_base_springs_only.
BOOST_AUTO_TEST_CASE(print_the_modes_of_the_platform_and_draw) {
  const test::Scratch folder;
  const auto rows =
      table(run("platform_stability " + (folder.path() / "modes.svg").string()).out, 1);
  BOOST_REQUIRE(rows.size() == 8U);
  BOOST_TEST(std::abs(rows[2][0] - 0.44268648) < 1e-8);
  BOOST_TEST(std::abs(rows[3][0] - 2.64334443) < 1e-8);
  BOOST_TEST(std::abs(rows[4][0] - 3.34065680) < 1e-8);
  BOOST_TEST(std::abs(rows[4][1] - 3.40833) < 1e-5);  // as printed
  BOOST_TEST(folder.read("modes.svg").find("<svg") != std::string::npos);
}

// precession_order of the same file has an additional force; the orders are the same.
BOOST_AUTO_TEST_CASE(print_the_error_of_precession_equations) {
  const test::Scratch folder;
  const auto rows = table(run("precession_error " + (folder.path() / "error.svg").string()).out, 1);
  BOOST_REQUIRE(rows.size() == 5U);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const double error = rows[i][1], bound = rows[i][2];
    BOOST_TEST(error < bound);
    BOOST_TEST(error > 0.4 * bound);
    BOOST_TEST(rows[i][3] < rows[i][4] / 2);  // steps
    if (i > 0) {
      const double order = std::log2(rows[i - 1][1] / error);
      BOOST_TEST(order > 1.9);
      BOOST_TEST(order < 3.1);
    }
  }
  BOOST_TEST(folder.read("error.svg").find("<svg") != std::string::npos);
}

// By hand: h = 2 C speed cos(20 degrees); A* has the wheels' C, A has not.
BOOST_AUTO_TEST_CASE(print_the_modes_of_the_satellite) {
  const auto rows = table(run("momentum_wheel_satellite").out, 2);
  BOOST_REQUIRE(rows.size() == 2U);
  const double slant = 0.349, C = 0.1, across = 0.06, speed = 200;
  const double c = std::cos(slant), s = std::sin(slant), h = 2 * C * speed * c;
  const double x = 120 + 2 * across;
  for (std::size_t i = 0; i < 2; ++i) {
    const double about = i == 0 ? 0 : C;
    const double z = 150 + 2 * (across * c * c + about * s * s);
    const double nutation = h / std::sqrt(x * z);
    BOOST_TEST(std::abs(rows[i][0] - nutation) < 1e-8);
    BOOST_TEST(std::abs(rows[i][1] - nutation) < 1e-5);
    BOOST_TEST(std::abs(rows[i][4] - rows[i][5]) < 2e-3);
  }
  // A motor resists C sin(slant) w_z', which oscillates with the impulse; a free wheel does not.
  const double swing = 1e-3 * s;
  BOOST_TEST(std::abs(rows[1][2] - C * swing * rows[1][0]) < 0.01 * C * swing);
  BOOST_TEST(rows[1][3] == 0);
  BOOST_TEST(std::abs(rows[0][3] - 2 * swing) < 0.01 * swing);
  BOOST_TEST(rows[0][2] == 0);
}

BOOST_AUTO_TEST_SUITE_END()
