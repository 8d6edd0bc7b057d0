// The instruments of docs/site/instruments.md: the exact motion of each scene against its law, and the
// order in which what the law leaves out goes to 0.

#include <boost/test/unit_test.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <programs/instruments_bodies.hpp>
#include <programs/instruments_gyros.hpp>
#include <programs/instruments_loops.hpp>
#include <sstream>
#include <string>
#include <vector>

#include <support/program.hpp>

using namespace kreisel::test;

namespace {

Json answer_of(const Instrument& row, double size) {
  const std::string program = row.analyzed ? KREISEL_ANALYZE : KREISEL_SIMULATE;
  const std::string command =
      program + " " KREISEL_SCENES "/" + row.scene + ".toml --json" + row.options(size);
  const Outcome outcome = run(command);
  BOOST_TEST_REQUIRE(outcome.status == 0, command << ": " << outcome.err);
  return parsed(outcome.out);
}

/// The part of the law by which the exact motion differs from it.
double left_out(const Instrument& row, double size) {
  return std::abs(row.measured(answer_of(row, size)) / row.law(size) - 1);
}

const std::vector<Instrument>& instruments() {
  static const std::vector<Instrument> all{rate_gyro(),
                                           bandwidth(),
                                           integrating_gyro(),
                                           directional_gyro(),
                                           earth_drift(),
                                           horizon_in_turn(),
                                           erection(),
                                           gyrocompass(),
                                           course_error(),
                                           platform_stiffness(),
                                           platform_drift(),
                                           servo_stiffness(),
                                           servo_compliance(),
                                           servo_decoupling(),
                                           servo_bandwidth(),
                                           servo_drift(),
                                           damping_error(),
                                           damped_oscillation(),
                                           damping_ratio(),
                                           swing_in_orbit(),
                                           control_moment_gyros(),
                                           nutation(),
                                           kamerlingh_onnes(),
                                           foucault(),
                                           engine_block(),
                                           heavy_rotor(),
                                           propeller(),
                                           rolling_disc(),
                                           pendulous_gyrocompass(),
                                           schuler_pendulum(),
                                           bicycle()};
  return all;
}

}  // namespace

BOOST_AUTO_TEST_SUITE(instruments_of_the_papers)

BOOST_AUTO_TEST_CASE(laws_hold_in_their_order) {
  for (const Instrument& row : instruments()) {
    BOOST_TEST_CONTEXT(row.scene) {
      const double whole = left_out(row, 1);
      BOOST_TEST(whole <= row.bound);
      BOOST_TEST_MESSAGE(row.scene << ": " << whole);
      if (row.order == 0) continue;
      const double half = left_out(row, 0.5);
      const double quarter = left_out(row, 0.25);
      const double order = std::log2(half / quarter);
      BOOST_TEST_MESSAGE("  order " << order);
      if (!row.rest) {
        BOOST_TEST(std::abs(order - row.order) < 0.2, order);
        continue;
      }
      const double wanted = std::log2(row.rest(0.5) / row.rest(0.25));
      BOOST_TEST(std::abs(order - wanted) < 0.1, order << " for " << wanted);
      BOOST_TEST(std::abs(quarter / row.rest(0.25) - 1) < 0.1, quarter << " " << row.rest(0.25));
    }
  }
}

// Each row of the page is tested above, and each test has its row: the scene, then the order.
BOOST_AUTO_TEST_CASE(page_has_the_same_instruments) {
  std::vector<std::string> told;
  std::ifstream page(KREISEL_PAGE);
  for (std::string line; std::getline(page, line);) {
    std::vector<std::string> cells;
    std::istringstream row(line);
    for (std::string cell; std::getline(row, cell, '|');) cells.push_back(cell);
    if (cells.size() == 8 && cells[2].find('`') != std::string::npos) {
      told.push_back(cells[2] + cells[7]);
    }
  }
  std::vector<std::string> tested;
  for (const Instrument& row : instruments()) {
    const std::string order = row.order == 0 ? "exact" : std::to_string(int(row.order));
    tested.push_back(" `" + std::string(row.scene) + "`  " + order + " ");
    BOOST_TEST(std::filesystem::exists(std::string(KREISEL_SCENES) + "/" + row.scene + ".toml"));
  }
  std::sort(told.begin(), told.end());
  std::sort(tested.begin(), tested.end());
  BOOST_TEST(told == tested, boost::test_tools::per_element());
}

BOOST_AUTO_TEST_SUITE_END()
