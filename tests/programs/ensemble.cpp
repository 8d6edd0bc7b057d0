// ensemble from its user's side: a scene file with varied numbers.

#include <boost/test/unit_test.hpp>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>
#include <vector>

#include <support/json.hpp>
#include <support/program.hpp>

using namespace kreisel;
using nlohmann::json;

namespace {

test::Outcome run(const std::string& words) {
  return test::run(std::string(KREISEL_ENSEMBLE) + " " + words);
}

std::string scene(const std::string& name) {
  return std::string(KREISEL_SCENES) + "/" + name + ".toml";
}

/// The rows of a CSV file, split at every comma.
std::vector<std::vector<std::string>> rows(const std::string& text) {
  std::vector<std::vector<std::string>> result;
  std::istringstream all(text);
  for (std::string line; std::getline(all, line);) {
    result.emplace_back();
    std::istringstream row(line);
    for (std::string field; std::getline(row, field, ',');) result.back().push_back(field);
  }
  return result;
}

}  // namespace

BOOST_AUTO_TEST_SUITE(ensemble_of_a_scene)

// The rate of the wheel in closed form: torque/friction (1 - exp(-friction t/C)).
BOOST_AUTO_TEST_CASE(sweeps_a_number_of_the_file) {
  const test::Scratch folder;
  const std::string csv = (folder.path() / "out.csv").string();
  const test::Outcome outcome = run(
      scene("wheel_spun_up") +
      " --vary 'body.wheel.rotor.torque*=linear(1,3)' 'body.wheel.inertia[2]=linear(0.01,0.012)'"
      " --members 3 --json --csv " +
      csv);
  BOOST_REQUIRE_MESSAGE(outcome.status == 0, outcome.err);
  const auto table = rows(folder.read("out.csv"));
  BOOST_TEST_REQUIRE(table.size() == 4U);
  const std::vector<std::string> head{"member",
                                      "body.wheel.rotor.torque",
                                      "body.wheel.inertia[2]",
                                      "wheel.angle",
                                      "wheel.rate",
                                      "error_estimate",
                                      "message"};
  BOOST_TEST(table.front() == head, boost::test_tools::per_element());
  for (int i = 0; i < 3; ++i) {
    const auto& row = table.at(static_cast<std::size_t>(i) + 1);
    const double torque = 0.1 * (1 + i);
    const double moment = 0.01 + 0.001 * i;
    BOOST_TEST(std::stoi(row.at(0)) == i);
    BOOST_TEST(std::abs(std::stod(row.at(1)) - torque) <= 1e-16);
    BOOST_TEST(std::abs(std::stod(row.at(2)) - moment) <= 1e-17);
    const double wanted = torque / 0.01 * -std::expm1(-0.03 / moment);
    BOOST_TEST(std::abs(std::stod(row.at(4)) - wanted) <= 1e-12 * wanted);
    BOOST_TEST(std::stod(row.at(5)) <= 1e-12);
  }
  const json summary = test::parsed(outcome.out);
  BOOST_TEST(summary.at("complete") == 3);
  BOOST_TEST(summary.at("columns").at("wheel.rate").at("least").get<double>() ==
             std::stod(table.at(1).at(4)));
  // The first is the unchanged file.
  const json simulated =
      test::parsed(test::run(KREISEL_SIMULATE " " + scene("wheel_spun_up") + " --json").out);
  const json& wheel = simulated.at("final").at("joints").at("wheel");
  BOOST_TEST(std::stod(table.at(1).at(3)) == wheel.at("coordinate").get<double>());
  BOOST_TEST(std::stod(table.at(1).at(4)) == wheel.at("rate").get<double>());
  BOOST_TEST(std::stod(table.at(1).at(5)) == simulated.at("error_estimate").get<double>());
}

BOOST_AUTO_TEST_CASE(does_not_depend_on_threads) {
  const test::Scratch folder;
  const auto drawn = [&](const std::string& words) {
    const std::string csv = (folder.path() / "out.csv").string();
    const test::Outcome outcome =
        run(scene("cardan_gyro_springs") +
            " --vary 'body.rotor.rotor.speed,body.rotor.initial.rate*=normal(1,0.05)' "
            "'body.inner ring.initial.angle+=uniform(-0.1,0.1)' --members 20 --t-end 0.05 --csv " +
            csv + " " + words);
    BOOST_REQUIRE_MESSAGE(outcome.status == 0, outcome.err);
    return folder.read("out.csv");
  };
  const std::string one = drawn("--threads 1");
  BOOST_TEST(rows(one).size() == 21U);
  BOOST_TEST((drawn("--threads 3") == one));
  BOOST_TEST((drawn("--threads 2 --seed 2") != one));
}

// Readings at the end, with the noise of each member. Its seed is the sensor's plus the member.
BOOST_AUTO_TEST_CASE(has_the_readings_of_sensors) {
  const test::Scratch folder;
  const auto text = [](int seed) {
    return "[guide]\nkind = \"rotating\"\nangular_velocity = [0, 0, 2]\n"
           "[[body]]\nname = \"unit\"\nmass = 1\ninertia = [1, 1, 1]\njoint = { kind = \"fixed\" "
           "}\n"
           "[[sensor]]\nname = \"gyro\"\nkind = \"gyro\"\nbody = \"unit\"\nperiod = 0.25\n"
           "increments = true\nnoise = 0.01\nseed = " +
           std::to_string(seed) + "\n[solve]\nt_end = 1.1\n";
  };
  const std::string file = folder.write("s.toml", text(7)).string();
  const std::string csv = (folder.path() / "out.csv").string();
  const test::Outcome outcome =
      run(file + " --vary 'guide.angular_velocity[2]*=linear(1,2)' --members 2 --csv " + csv);
  BOOST_REQUIRE_MESSAGE(outcome.status == 0, outcome.err);
  const auto table = rows(folder.read("out.csv"));
  BOOST_TEST_REQUIRE(table.size() == 3U);
  BOOST_TEST(table[0].at(2) == "gyro.dtheta x");
  BOOST_TEST(std::abs(std::stod(table[1].at(7)) - 0.5) <= 1e-14);  // true z
  BOOST_TEST(std::abs(std::stod(table[2].at(7)) - 1.0) <= 1e-14);
  const std::string second = folder.write("t.toml", text(8)).string();
  const json alone = test::parsed(test::run(KREISEL_SIMULATE " " + second + " --json").out);
  const json& dtheta = alone.at("final").at("sensors").at("gyro").at("dtheta");
  BOOST_TEST(std::stod(table[2].at(2)) == dtheta.at(0).get<double>());
  BOOST_TEST(std::stod(table[2].at(2)) != std::stod(table[1].at(2)));
}

// A member that cannot be made or computed has a row with the reason.
BOOST_AUTO_TEST_CASE(lists_failed_members) {
  const test::Scratch folder;
  const test::Outcome outcome = run(scene("wheel_spun_up") +
                                    " --vary 'body.wheel.inertia[2]=linear(-0.01,0.01)' "
                                    "--members 3 --csv " +
                                    (folder.path() / "out.csv").string());
  BOOST_TEST(outcome.status == 3);
  BOOST_TEST(outcome.err.find("2 of 3 members failed; member 0: ") != std::string::npos,
             outcome.err);
  const auto table = rows(folder.read("out.csv"));
  BOOST_TEST_REQUIRE(table.size() == 4U);
  BOOST_TEST(table.at(1).at(1) == "-0.01");
  BOOST_TEST(table.at(1).at(2) == "");
  BOOST_TEST(table.at(1).at(5).find("wheel_spun_up.toml:10:") != std::string::npos,
             table.at(1).at(5));
  BOOST_TEST(table.at(3).size() == 5U);  // and an empty message
  BOOST_TEST(outcome.out.find("1 of 3 members, 2 failed") != std::string::npos, outcome.out);
}

// The file leaves the damping at its default, 0. The rate decays by it: w = w_0 exp(-d t/C).
BOOST_AUTO_TEST_CASE(varies_keys_that_the_file_leaves_out) {
  const test::Scratch folder;
  const auto file = folder.write(
      "s.toml",
      "[[body]]\nname = \"wheel\"\njoint = { kind = \"revolute\", axis = [0, 0, 1] }\nmass = 1\n"
      "inertia = [2, 2, 3]\ninitial = { rate = 5 }\n[solve]\nt_end = 2\n");
  const test::Outcome outcome = run(file.string() +
                                    " --vary body.wheel.damping=linear\\(0.3,0.6\\) --members 2 "
                                    "--set body.wheel.initial.rate=4 --json");
  BOOST_REQUIRE_MESSAGE(outcome.status == 0, outcome.err);
  const json rate = test::parsed(outcome.out).at("columns").at("wheel.rate");
  BOOST_TEST(std::abs(rate.at("greatest").get<double>() - 4 * std::exp(-0.2)) < 1e-9);
  BOOST_TEST(std::abs(rate.at("least").get<double>() - 4 * std::exp(-0.4)) < 1e-9);
}

// Rounding alone exceeds 1e-15.
BOOST_AUTO_TEST_CASE(missed_tolerances_exit_with_4) {
  const test::Outcome outcome = run(scene("double_pendulum") +
                                    " --vary 'body.upper.initial.angle=linear(2,2.1)' "
                                    "--members 2 --tolerance 1e-15 --json");
  BOOST_TEST(outcome.status == 4, outcome.err);
  BOOST_TEST(outcome.err.find("2 of 2 members did not reach the tolerance") != std::string::npos,
             outcome.err);
  BOOST_TEST(test::parsed(outcome.out).at("tolerance_not_kept") == 2);
}

// A rate of 1.7e308 m/s overflows.
BOOST_AUTO_TEST_CASE(a_member_that_is_not_finite_has_failed) {
  const test::Outcome outcome =
      run(scene("damped_slide") +
          " --vary 'body.slide.initial.rate=linear(0,1.7e308)' --members 2 --json");
  BOOST_TEST(outcome.status == 3, outcome.err);
  BOOST_TEST(test::parsed(outcome.out).at("failed") == 1);
}

BOOST_AUTO_TEST_CASE(keeps_its_results_when_interrupted) {
  const test::Scratch folder;
  std::size_t computed = 0;
  // On a busy machine the first member may not have started yet.
  for (const char* const pause : {"0.5", "4", "32"}) {
    const test::Outcome outcome =
        test::run("( " KREISEL_ENSEMBLE " " + scene("damped_slide") +
                  " --vary 'body.slide.mass*=normal(1,0.1)' --members 1000000 --csv " +
                  (folder.path() / "out.csv").string() + " & pid=$!; sleep " + pause +
                  "; while kill -INT $pid; do sleep 0.1; done; wait $pid )");
    BOOST_TEST(outcome.status == 130);
    BOOST_TEST(outcome.err.find(" of 1000000 members were computed") != std::string::npos,
               outcome.err);
    computed = rows(folder.read("out.csv")).size() - 1;
    if (computed > 0) break;
  }
  BOOST_TEST(computed > 0U);
}

BOOST_AUTO_TEST_CASE(draws_the_members_over_what_was_drawn) {
  const test::Scratch folder;
  const std::string pictures = (folder.path() / "pictures").string();
  const std::string wheel = scene("wheel_spun_up") + " --members 9 --t-end 5 --plot " + pictures;
  test::Outcome outcome =
      run(wheel + " --vary 'body.wheel.rotor.torque=linear(1,3)' 'body.wheel.mass=uniform(1,2)'");
  BOOST_TEST(outcome.status == 0, outcome.err);
  BOOST_TEST(outcome.err == "wrote " + pictures + "/members.svg and .png\n");
  const std::string picture = folder.read("pictures/members.svg");
  for (const char* const text : {"body.wheel.rotor.torque", "body.wheel.mass", "wheel.rate"}) {
    BOOST_TEST(picture.find(text) != std::string::npos, text);
  }
  BOOST_TEST(folder.read("pictures/members.png").substr(1, 3) == "PNG");

  outcome = run(wheel + " --vary 'body.wheel.rotor.torque=linear(1,1)'");
  BOOST_TEST(outcome.status == 0, outcome.err);
  BOOST_TEST(outcome.err == "ensemble: nothing to draw: no two complete members end apart\n");

  folder.write("file", "");
  outcome = run(wheel + "/../file/pictures --vary 'body.wheel.rotor.torque=linear(1,3)'");
  BOOST_TEST(outcome.status == 2, outcome.err);
}

BOOST_AUTO_TEST_CASE(bad_input_exits_with_2_and_writes_nothing) {
  const test::Scratch folder;
  const std::string csv = " --csv " + (folder.path() / "out.csv").string();
  const std::string wheel = scene("wheel_spun_up") + " --vary ";
  const std::pair<std::string, std::string> cases[] = {
      {scene("wheel_spun_up"), "--vary is required"},
      {"none.toml --vary 'x=normal(0,1)'", "none.toml: cannot be read"},
      {wheel + "'body.wheel.mas=normal(0,1)'",
       "'wheel'.mas: is no key here (did you mean 'mass'?)"},
      {wheel + "'body.wheel.stiffness*=normal(0,1)'",
       "has no number at body.wheel.stiffness: vary it"},
      {wheel + "'body.weel.mass=normal(0,1)'", "no 'weel' in the file (did you mean 'wheel'?)"},
      {wheel + "'body.wheel.inertia[3]=normal(0,1)'", "no '[3]' in the file"},
      {wheel + "'title=normal(0,1)'", "title: is no number"},
      {wheel + "'solve.t_end=gauss(0,1)'", "'gauss' is none of normal, uniform, linear"},
      {wheel + "'solve.t_end=normal(0,x)'", "is not a finite number"},
      {wheel + "'solve.t_end=normal(0,-1)'", "the deviation must not be below 0"},
      {wheel + "solve.t_end", "wanted KEY=normal"},
      {wheel + "'body.wheel.mass=normal(1,0)' 'body[0].mass=normal(1,0)'",
       "body[0].mass: is given twice"},
      {wheel + "'body.wheel.mass=normal(1,0)' --t-end -1", "--t-end must be above 0"}};
  for (const auto& [words, reason] : cases) {
    const test::Outcome outcome = run(words + csv);
    BOOST_TEST(outcome.status == 2, words << " exits with " << outcome.status);
    BOOST_TEST(outcome.err.find(reason) != std::string::npos, words << ": " << outcome.err);
    BOOST_TEST(std::count(outcome.err.begin(), outcome.err.end(), '\n') == 1, outcome.err);
  }
  BOOST_TEST(folder.size() == 0U);
}

BOOST_AUTO_TEST_SUITE_END()
