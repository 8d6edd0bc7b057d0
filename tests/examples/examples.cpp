// The examples as a reader runs them: their output must be correct, not only printed.

#include <boost/test/unit_test.hpp>

#include <cmath>
#include <sstream>
#include <string>
#include <vector>

#include <dynamics/exact/free_top.hpp>
#include <dynamics/file/csv.hpp>
#include <dynamics/step/explicit.hpp>
#include <motor/attitude.hpp>

#include <support/program.hpp>
#include <support/worst.hpp>

using namespace kreisel;

namespace {

std::string output(const std::string& command) {
  const test::Outcome outcome = test::run(std::string(KREISEL_PROGRAMS) + "/" + command);
  BOOST_REQUIRE_MESSAGE(outcome.status == 0, command << ": " << outcome.err);
  return outcome.out;
}

/// The numbers of each line that begins with `name`.
std::vector<std::vector<double>> lines(const std::string& text, const std::string& name) {
  std::vector<std::vector<double>> found;
  std::istringstream all(text);
  for (std::string line; std::getline(all, line);) {
    std::istringstream words(line);
    std::string first;
    words >> first;
    if (first != name) continue;
    found.emplace_back();
    for (double x = 0; words >> x;) found.back().push_back(x);
  }
  return found;
}

}  // namespace

BOOST_AUTO_TEST_SUITE(the_examples)

BOOST_AUTO_TEST_CASE(rate_in_two_frames_shows_u_cross_u) {
  const std::string text = output("rate_in_two_frames");
  BOOST_TEST(text.find("seen from the room     (0, 2, 0; 0, 0, 0)") != std::string::npos, text);
  BOOST_TEST(text.find("and back               (0, 0, 0; 0, 0, 0)") != std::string::npos, text);
}

BOOST_AUTO_TEST_CASE(euler_top_agrees_with_the_closed_form) {
  const test::Scratch folder;
  const std::string picture = (folder.path() / "polhodes.svg").string();
  const std::string text = output("euler_top " + picture);
  const auto period = lines(text, "period");
  BOOST_TEST(period.size() == 1U);
  std::istringstream all(text);
  std::string line;
  std::getline(all, line);  // the heading
  int rows = 0;
  for (double t = 0, p = 0, q = 0, r = 0, off = 0; all >> t >> p >> q >> r >> off; ++rows) {
    BOOST_TEST(off < 1e-9);  // near the separatrix rounding grows by 1e6 and more
    BOOST_TEST(std::abs(p * p + 4 * q * q + 9 * r * r - 16.00001) < 2e-5);  // L^2, six decimals
  }
  BOOST_TEST(rows == 13);
  BOOST_TEST(folder.read("polhodes.svg").find("<svg") != std::string::npos);
}

/// The lines below the heading, which are all numbers.
std::vector<std::vector<double>> rows(const std::string& text) {
  std::vector<std::vector<double>> found;
  std::istringstream all(text);
  for (std::string line; std::getline(all, line);) {
    std::istringstream words(line);
    std::vector<double> row;
    for (double x = 0; words >> x;) row.push_back(x);
    if (words.eof() && !row.empty()) found.push_back(row);
  }
  return found;
}

// The drifts of the reference (tests/data/cardan-gyro.json). A mean over 60 nutations is accurate
// to 1e-4, because they do not end in their initial phase.
BOOST_AUTO_TEST_CASE(cardan_gyro_drifts_as_the_reference) {
  const test::Scratch folder;
  const auto table = rows(output("cardan_gyro " + (folder.path() / "nutations.svg").string()));
  const std::vector<double> drifts{-2.311623203651e-4, -9.247687974572e-4, -3.700988820911e-3,
                                   -1.483466170336e-2, -5.983568374740e-2};
  BOOST_TEST_REQUIRE(table.size() == drifts.size());
  for (std::size_t i = 0; i < drifts.size(); ++i) {
    BOOST_TEST(std::abs(table[i].at(2) / drifts[i] - 1) < 1e-4);
  }
  BOOST_TEST(std::abs(table[2].at(3) / -3.698437802e-3 - 1) < 2e-5);  // Magnus's law, four decimals
  BOOST_TEST(folder.read("nutations.svg").find("<svg") != std::string::npos);
}

// An inertially fixed axis obeys n' = -u x n for observers on board. The rings' angles follow it,
// except for the 6e-5 rad by which massive rings deflect it.
BOOST_AUTO_TEST_CASE(gyro_on_ship_follows_an_inertial_axis) {
  const auto table = rows(output("gyro_on_ship"));
  BOOST_TEST_REQUIRE(table.size() == 11U);
  const double degree = std::acos(-1.0) / 180;
  const auto field = [degree](double t, const Vector3<double>& n) {
    const double roll = 360 * degree / 8, yaw = 360 * degree / 20;
    const Vector3<double> u(10 * degree * roll * std::cos(roll * t), 0,
                            2 * degree * yaw * std::cos(yaw * t));
    return Vector3<double>(n.cross(u));
  };
  ExplicitRungeKutta axis(field, 0.0,
                          Vector3<double>(std::sin(30 * degree), 0, std::cos(30 * degree)));
  for (const auto& row : table) {
    const Vector3<double> n = axis.advance_to(row.at(0));
    BOOST_TEST(std::abs(row.at(1) - std::atan2(-n.y(), n.z()) / degree) < 0.005);
    BOOST_TEST(std::abs(row.at(2) - std::asin(n.x()) / degree) < 0.005);
    BOOST_TEST(row.at(3) < 6e-5);
    BOOST_TEST(row.at(4) < 1e-14);
  }
}

// At the start the load hangs straight down, so that gravity moves nothing. The deck carries the
// weight of jib (5 m out) and load (10 m out) at the jib's angle of 0.3 rad.
BOOST_AUTO_TEST_CASE(three_bodies_weigh_on_the_deck) {
  const auto table = rows(output("three_bodies"));
  BOOST_TEST_REQUIRE(table.size() == 11U);
  const double torque = (1500 * 5 + 2000 * 10) * std::cos(0.3) * 9.81 / 1e3;
  BOOST_TEST_REQUIRE(table[0].size() == 10U);
  BOOST_TEST(std::abs(table[0][9] + torque) < 0.006);
  BOOST_TEST(table[0][8] == 0);
}

BOOST_AUTO_TEST_CASE(ship_on_earth_shows_parts_that_add_up) {
  const std::string text = output("ship_on_earth");
  const auto relative = lines(text, "relative");
  const auto guide = lines(text, "guide");
  const auto coriolis = lines(text, "Coriolis");
  const auto loads = lines(text, "loads");
  BOOST_TEST(relative.size() == 3U);
  for (std::size_t i = 0; i < relative.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      const double sum = relative[i][k] + guide[i][k] + coriolis[i][k];
      BOOST_TEST(std::abs(sum - loads[i][k]) < 3e-9);  // four numbers of nine decimals
    }
  }
}

// The tumbling brick by an independent calculation. Its attitude is in closed form, its fall a
// plane orbit in long double. The local level of a point on the equator follows from the longitude.
// Agreement to 2e-12 degrees confirms all but the last of the 12 printed decimals.
BOOST_AUTO_TEST_CASE(tumbling_brick_agrees_with_the_closed_form) {
  const test::Scratch folder;
  const CsvTable table =
      CsvTable::read(folder.write("brick.csv", output("tumbling_brick")),
                     {"t", "yaw_deg", "pitch_deg", "roll_deg", "p_deg_s", "q_deg_s", "r_deg_s"});
  BOOST_TEST(table.size() == 301U);

  using Real = long double;
  constexpr Real degree = 0.0174532925199432957692L;
  constexpr Real u = 7.292115e-5L;
  constexpr Real GM = 3.986004418e14L, R = 6378137, J2 = 1.08262982131e-3L;
  constexpr Real r0 = R + 9144;
  using State = Eigen::Matrix<Real, 4, 1>;
  const auto orbit = [&](Real, const State& y) {
    const Real r2 = y[0] * y[0] + y[1] * y[1];
    const Real pull = -GM / (r2 * std::sqrt(r2)) * (1 + 1.5L * J2 * R * R / r2);
    return State(y[2], y[3], pull * y[0], pull * y[1]);
  };
  ExplicitRungeKutta fall(orbit, Real(0), State(r0, 0, 0, u * r0), {.relative = 1e-16},
                          std::array<int, 2>{2, 2});

  // North, east and down at longitude 0 on inertial axes; then turned about the pole.
  const Matrix3<double> level0 = (Matrix3<double>() << 0, 0, -1, 0, 1, 0, 1, 0, 0).finished();
  const double d = static_cast<double>(degree);
  const exact::FreeTop top({0.00189422, 0.006211019, 0.007194665}, {10 * d, 20 * d, 30 * d},
                           Eigen::Quaterniond(level0));
  double worst_angle = 0;
  double worst_rate = 0;
  for (std::size_t i = 0; i < table.size(); ++i) {
    const double t = table.number(i, "t");
    const State y = fall.advance_to(t);
    const double longitude = static_cast<double>(std::atan2(y[1], y[0]));
    const auto [attitude, rate] = top.at(t);
    const Matrix3<double> level = YawPitchRoll<>{longitude, 0, 0}.rotation() * level0;
    const auto angles = YawPitchRoll<>::of(level.transpose() * attitude.toRotationMatrix());
    const auto note = [&](double& worst, const char* column, double truth) {
      const double off = std::abs(table.number(i, column) - truth / d);
      worst = test::worst_of(worst, std::min(off, std::abs(off - 360)));
    };
    note(worst_angle, "yaw_deg", angles.yaw);
    note(worst_angle, "pitch_deg", angles.pitch);
    note(worst_angle, "roll_deg", angles.roll);
    note(worst_rate, "p_deg_s", rate.x());
    note(worst_rate, "q_deg_s", rate.y());
    note(worst_rate, "r_deg_s", rate.z());
  }
  BOOST_TEST_MESSAGE("off by " << worst_angle << " degrees and " << worst_rate << " degrees/s");
  BOOST_TEST(worst_angle < 2e-12);
  BOOST_TEST(worst_rate < 2e-12);
}

BOOST_AUTO_TEST_SUITE_END()
