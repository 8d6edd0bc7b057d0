// Sensors in the output of simulate: columns of CSV, keys of JSON, text.

#include <boost/test/unit_test.hpp>

#include <cmath>
#include <cstddef>
#include <sstream>
#include <string>
#include <vector>

#include <support/json.hpp>
#include <support/program.hpp>

using namespace kreisel;
using nlohmann::json;
using test::Outcome;
using test::Scratch;

namespace {

const std::string simulate = KREISEL_SIMULATE;

/// A wheel at constant rate with a gyro that has errors and a bearing that holds its weight.
const std::string wheel = R"(
[gravity]
kind = "uniform"
vector = [0, 0, -9.75]
[[body]]
name = "wheel"
joint = { kind = "revolute", axis = [0, 0, 1] }
mass = 2
inertia = [0.1, 0.1, 0.1]
drive = "constant-rate"
initial = { rate = 2 }
points = { rim = [0.5, 0, 0] }
[[sensor]]
name = "gyro"
kind = "gyro"
body = "wheel"
bias = [0, 0, 0.25]
noise = 0.001
seed = 3
[[sensor]]
name = "rim"
kind = "accelerometer"
body = "wheel"
at = "rim"
[[sensor]]
name = "point"
kind = "point"
body = "wheel"
at = "rim"
against = "inertial"
[[sensor]]
name = "bearing"
kind = "reaction"
joint = "wheel"
at = "rim"
[[sensor]]
name = "pickoff"
kind = "joint"
joint = "wheel"
[[sensor]]
name = "attitude"
kind = "attitude"
body = "wheel"
[solve]
t_end = 1
output_step = 0.1
)";

struct Table {
  std::vector<std::string> names;
  std::vector<std::vector<double>> rows;
};

Table table(const std::string& csv) {
  Table result;
  std::istringstream all(csv);
  for (std::string line; std::getline(all, line);) {
    std::istringstream fields(line);
    if (!result.names.empty()) result.rows.emplace_back();
    for (std::string field; std::getline(fields, field, ',');) {
      if (result.rows.empty()) {
        result.names.push_back(field);
      } else {
        result.rows.back().push_back(std::stod(field));
      }
    }
  }
  return result;
}

void check_near(const json& found, const std::vector<double>& wanted, double bound) {
  BOOST_REQUIRE(found.size() == wanted.size());
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    BOOST_TEST(std::abs(found.at(i).get<double>() - wanted[i]) <= bound, found << " " << i);
  }
}

}  // namespace

BOOST_AUTO_TEST_SUITE(sensors_of_simulate)

BOOST_AUTO_TEST_CASE(end_of_a_run_in_json) {
  const Scratch folder;
  const std::string file = folder.write("s.toml", wheel).string();
  const Outcome outcome = test::run(simulate + " " + file + " --json");
  BOOST_TEST_REQUIRE(outcome.status == 0, outcome.err);
  const json sensors = test::parsed(outcome.out).at("final").at("sensors");
  const double c = std::cos(2.0), s = std::sin(2.0);
  check_near(sensors.at("gyro").at("true"), {0, 0, 2}, 1e-15);
  // White noise of 0.001 per root of Hz over 0.1 s: 0.0032, here within five times of it.
  check_near(sensors.at("gyro").at("value"), {0, 0, 2.25}, 0.016);
  BOOST_TEST(sensors.at("gyro").at("value").at(0).get<double>() != 0);
  check_near(sensors.at("rim").at("value"), {-2, 0, 9.75}, 1e-14);
  BOOST_TEST(!sensors.at("rim").contains("true"));
  check_near(sensors.at("point").at("position"), {c / 2, s / 2, 0}, 1e-10);
  check_near(sensors.at("point").at("velocity"), {-s, c, 0}, 1e-10);
  check_near(sensors.at("point").at("acceleration"), {-2 * c, -2 * s, 0}, 1e-10);
  check_near(sensors.at("bearing").at("force"), {0, 0, 19.5}, 1e-13);
  check_near(sensors.at("bearing").at("torque"), {0, 9.75, 0}, 1e-13);
  check_near(sensors.at("pickoff").at("value"), {2, 2}, 1e-10);
  check_near(sensors.at("attitude").at("value"), {std::cos(1.0), 0, 0, std::sin(1.0)}, 1e-10);
}

// The last row equals the JSON values; a sensor with the name of a point or a body is separate from
// it.
BOOST_AUTO_TEST_CASE(columns_of_csv) {
  const Scratch folder;
  const std::string file = folder.write("s.toml", wheel).string();
  const auto csv = (folder.path() / "s.csv").string();
  const Outcome outcome = test::run(simulate + " " + file + " --json --reactions --csv " + csv);
  BOOST_TEST_REQUIRE(outcome.status == 0, outcome.err);
  const Table all = table(folder.read("s.csv"));
  BOOST_REQUIRE(all.names.size() == 1U + 2 + 7 + 6 + 3 + 9 + 6 + 2 + 4);
  BOOST_TEST(all.names.at(10) == "gyro.x");
  BOOST_TEST(all.names.at(13) == "gyro.true x");
  BOOST_TEST(all.names.at(16) == "rim.x");
  BOOST_TEST(all.names.at(19) == "point.position x");
  BOOST_TEST(all.names.back() == "attitude.qz");
  BOOST_REQUIRE(all.rows.size() == 11U);
  const json sensors = test::parsed(outcome.out).at("final").at("sensors");
  std::size_t at = 10;
  for (const auto& [sensor, part] : std::vector<std::pair<std::string, std::string>>{
           {"gyro", "value"}, {"gyro", "true"}, {"rim", "value"}, {"point", "position"}}) {
    for (const json& x : sensors.at(sensor).at(part)) {
      BOOST_TEST(all.rows.back().at(at++) == x.get<double>());
    }
  }
}

BOOST_AUTO_TEST_CASE(columns_that_are_chosen) {
  const Scratch folder;
  const std::string file =
      folder.write("s.toml", wheel + "[output]\ncolumns = [\"rim\", \"wheel.rate\"]\n").string();
  const auto csv = (folder.path() / "s.csv").string();
  const Outcome outcome = test::run(simulate + " " + file + " --csv " + csv);
  BOOST_TEST_REQUIRE(outcome.status == 0, outcome.err);
  const Table all = table(folder.read("s.csv"));
  BOOST_TEST((all.names == std::vector<std::string>{"t", "rim.x", "rim.y", "rim.z", "wheel.rate"}));
  BOOST_TEST(all.rows.back().at(4) == 2);
  const Outcome again = test::run(simulate + " " + file + " --resume --csv " + csv);
  BOOST_TEST(again.status == 2);
  BOOST_TEST(again.err.find("--resume: the rows hold the columns of [output] alone") !=
             std::string::npos);
}

// The noise of a row depends on its time, whether the run began there or at 0.
BOOST_AUTO_TEST_CASE(noise_goes_on_after_a_resume) {
  const Scratch folder;
  const std::string file = folder.write("s.toml", wheel).string();
  const auto csv = (folder.path() / "s.csv").string();
  BOOST_TEST(test::run(simulate + " " + file + " --csv " + csv).status == 0);
  const std::string text = folder.read("s.csv");
  std::size_t end = 0;
  for (int line = 0; line < 6; ++line) end = text.find('\n', end) + 1;
  folder.write("s.csv", text.substr(0, end));
  const Outcome again = test::run(simulate + " " + file + " --resume --csv " + csv);
  BOOST_TEST_REQUIRE(again.status == 0, again.err);
  const Table before = table(text);
  const Table after = table(folder.read("s.csv"));
  BOOST_REQUIRE(after.rows.size() == before.rows.size());
  for (std::size_t i = 0; i < after.rows.size(); ++i) {
    for (std::size_t k = 3; k < 9; ++k) BOOST_TEST(after.rows[i].at(k) == before.rows[i].at(k));
  }
}

// A wheel at constant rate: dtheta = w T about the axle; the accelerometer at the rim reads
// (-w^2 r, 0, g), integrated on the axes at the beginning of the period.
BOOST_AUTO_TEST_CASE(increments_in_csv_and_json) {
  const Scratch folder;
  const std::string keys = "period = 0.25\nincrements = true\n[[sensor]]\n";
  std::string text = wheel.substr(0, wheel.find("bias ="));
  text += keys + "name = \"rim\"\nkind = \"accelerometer\"\nbody = \"wheel\"\nat = \"rim\"\n" +
          keys + "name = \"tooth\"\nkind = \"joint\"\njoint = \"wheel\"\nperiod = 0.5\n" +
          "[solve]\nt_end = 1.1\n";
  const std::string file = folder.write("s.toml", text).string();
  const auto csv = (folder.path() / "s.csv").string();
  const Outcome outcome = test::run(simulate + " " + file + " --json --csv " + csv);
  BOOST_TEST_REQUIRE(outcome.status == 0, outcome.err);
  const Table all = table(folder.read("s.csv"));
  BOOST_REQUIRE(all.rows.size() == 6U);  // 0, 0.25, 0.5, 0.75, 1, 1.1
  BOOST_TEST(all.names.at(3) == "gyro.dtheta x");
  BOOST_TEST(all.names.at(6) == "rim.dv x");
  const std::vector<double> dv{-std::sin(0.5), -(1 - std::cos(0.5)), 9.75 * 0.25};
  for (std::size_t i = 0; i < all.rows.size(); ++i) {
    const bool ends = i > 0 && i < 5;
    BOOST_TEST(std::abs(all.rows[i].at(5) - (ends ? 0.5 : 0)) <= 1e-14);
    for (std::size_t k = 0; k < 3; ++k) {
      BOOST_TEST(std::abs(all.rows[i].at(6 + k) - (ends ? dv[k] : 0)) <= 1e-14);
    }
    const double held = i == 5 ? 2 : 0.25 * 2 * static_cast<double>(i - i % 2);
    BOOST_TEST(std::abs(all.rows[i].at(9) - held) <= 1e-14);
  }
  const json sensors = test::parsed(outcome.out).at("final").at("sensors");
  check_near(sensors.at("gyro").at("dtheta"), {0, 0, 0.5}, 1e-14);
  check_near(sensors.at("rim").at("dv"), dv, 1e-14);
  check_near(sensors.at("tooth").at("value"), {2, 2}, 1e-10);
}

// The page has the readings of the CSV file, to nine digits.
BOOST_AUTO_TEST_CASE(in_pictures_and_on_the_page) {
  const Scratch folder;
  const std::string file = folder.write("s.toml", wheel).string();
  const auto csv = (folder.path() / "s.csv").string();
  const Outcome outcome =
      test::run(simulate + " " + file + " --csv " + csv + " --plot " + folder.path().string());
  BOOST_TEST_REQUIRE(outcome.status == 0, outcome.err);
  const std::string picture = folder.read("sensors.svg");
  for (const char* const title : {"gyro", "gyro, true", "point, position", "bearing, torque"}) {
    BOOST_TEST(picture.find(std::string(">") + title + "<") != std::string::npos, title);
  }
  const std::string page = folder.read("view.html");
  const std::string opening = R"(<script type="application/json" id="run">)";
  const std::size_t begin = page.find(opening) + opening.size();
  const json shown = test::parsed(page.substr(begin, page.find("</script>", begin) - begin));
  BOOST_TEST(shown.at("sensors").at(0).at("name") == "gyro");
  BOOST_TEST(shown.at("sensors").at(0).at("shown").at(3) == json({"true x", "rad/s"}));
  const Table all = table(folder.read("s.csv"));
  BOOST_TEST_REQUIRE(shown.at("readings").size() == all.rows.size());
  for (std::size_t i = 0; i < all.rows.size(); ++i) {
    const auto& row = all.rows[i];
    const auto& found = shown.at("readings").at(i);
    BOOST_TEST_REQUIRE(found.size() == row.size() - 3);
    for (std::size_t k = 0; k < found.size(); ++k) {
      const double wanted = row[k + 3];
      BOOST_TEST(std::abs(found.at(k).get<double>() - wanted) <= 5e-9 * std::abs(wanted));
    }
  }
}

BOOST_AUTO_TEST_CASE(stand_in_the_text) {
  const Scratch folder;
  const std::string file = folder.write("s.toml", wheel).string();
  const Outcome outcome = test::run(simulate + " " + file);
  BOOST_TEST(outcome.out.find("sensors, SI\n") != std::string::npos);
  BOOST_TEST(outcome.out.find("  bearing              torque            (0, 9.75, 0)\n") !=
                 std::string::npos,
             outcome.out);
}

BOOST_AUTO_TEST_SUITE_END()
