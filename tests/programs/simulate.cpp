// The program from its user's side: scene file in, numbers, files and exit status out.

#include <boost/test/unit_test.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <tuple>
#include <vector>

#include <dynamics/guide/resting.hpp>
#include <dynamics/solve/solve.hpp>
#include <dynamics/tree/body_system.hpp>

#include <support/json.hpp>
#include <support/program.hpp>

using namespace kreisel;
using nlohmann::json;
using test::number;
using test::Outcome;
using test::reference_file;
using test::Scratch;

namespace {

Outcome run(const std::string& arguments) {
  return test::run(std::string(KREISEL_SIMULATE) + " " + arguments);
}

std::string scene(const std::string& name) {
  return std::string(KREISEL_SCENES) + "/" + name + ".toml";
}

json answer(const std::string& arguments) {
  const Outcome outcome = run(arguments + " --json");
  const bool complete = outcome.status == 0 || outcome.status == 4;
  BOOST_REQUIRE_MESSAGE(complete, arguments << ": " << outcome.err);
  const json result = test::parsed(outcome.out);
  BOOST_TEST(result.at("tolerance_kept").get<bool>() == (outcome.status == 0), arguments);
  return result;
}

void check_near(const std::string& what, double found, double wanted, double bound) {
  BOOST_TEST(std::abs(found - wanted) <= bound, what << ": " << found << " differs from " << wanted
                                                     << " by " << found - wanted << ", allowed "
                                                     << bound);
}

std::vector<std::string> lines(const std::string& text) {
  std::vector<std::string> result;
  std::istringstream all(text);
  for (std::string line; std::getline(all, line);) result.push_back(line);
  return result;
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  return text.replace(text.find(from), from.size(), to);
}

}  // namespace

BOOST_AUTO_TEST_SUITE(simulate_against_references)

// 25 digits by two programs in 44 and 54 digits; see the file.
BOOST_AUTO_TEST_CASE(gyros_in_cardan_suspension) {
  const json cases = reference_file("cardan-gyro.json").at("trajectories");
  const std::pair<const char*, const char*> names[] = {
      {"cardan_gyro_free", "T1_free_symmetric"},
      {"cardan_gyro_springs", "T4b_springs_large"},
      {"cardan_gyro_driven", "T8b_regulated_inertial"},
      {"cardan_gyro_shaken", "T6b_fast_base_free"},
      {"gimbal_lock", "T7b_through_lock"},
      {"massless_rings", "T3s_massless_symmetric"}};
  for (const auto& [file, name] : names) {
    const auto found = std::find_if(cases.begin(), cases.end(),
                                    [name = name](const json& c) { return c.at("name") == name; });
    BOOST_TEST_REQUIRE((found != cases.end()));
    const json& end = found->at("points").back();
    const json result = answer(scene(file) + " --reactions");
    const json& joints = result.at("final").at("joints");
    int k = 0;
    for (const char* const body : {"outer ring", "inner ring", "rotor"}) {
      const auto at = static_cast<std::size_t>(k++);
      const double q = number(end.at("q").at(at));
      const double qd = number(end.at("qd").at(at));
      const std::string what = std::string(file) + ", " + body;
      check_near(what, joints.at(body).at("coordinate"), q, 1e-12 * std::max(1.0, std::abs(q)));
      check_near(what, joints.at(body).at("rate"), qd, 1e-12 * std::max(1.0, std::abs(qd)));
    }
    const json& reactions = result.at("final").at("reactions");
    const json& wanted = end.at("reactions");
    check_near("A3", reactions.at("outer ring").at("torque").at(0), number(wanted.at("M_A3")),
               1e-11);
    check_near("BL", reactions.at("outer ring").at("torque").at(1), number(wanted.at("M_BL")),
               1e-11);
    check_near("CL", reactions.at("outer ring").at("torque").at(2), number(wanted.at("M_CL")),
               1e-11);
    check_near("drive", joints.at("rotor").at("drive_torque"), number(end.at("M_C12_drive_total")),
               1e-11);
  }
}

BOOST_AUTO_TEST_CASE(tops_and_a_pendulum) {
  const json scenes = reference_file("ode-scenes.json").at("scenes");
  const auto state = [&scenes](const char* name) {
    std::vector<double> numbers;
    for (const json& x : scenes.at(name).at("states").at(0)) numbers.push_back(number(x));
    return numbers;
  };
  const auto check_body = [&](const char* file, const char* body, const char* name, double off,
                              double rate_off) {
    const json result = answer(scene(file)).at("final").at("joints").at(body);
    const std::vector<double> wanted = state(name);
    for (std::size_t i = 0; i < 4; ++i) {
      check_near(file, result.at("attitude").at(i), wanted.at(i), off);
    }
    for (std::size_t i = 0; i < 3; ++i) {
      check_near(file, result.at("angular_velocity").at(i), wanted.at(4 + i), rate_off);
    }
  };
  check_body("tumbling_body", "body", "S1_dzhanibekov", 1e-8, 2e-8);
  check_body("heavy_top", "top", "S2_fasttop_body", 1e-9, 3e-6);  // of 3000 rad/s
  const json rod = answer(scene("earth_pendulum")).at("final").at("joints").at("rod");
  check_near("rod", rod.at("coordinate"), state("S3_earthpend").at(0), 1e-9);
  check_near("rod", rod.at("rate"), state("S3_earthpend").at(1), 4e-9);
}

/// The angle of the compass of sailing_gyrocompass.toml at its end, 2500 m north of its start.
///
///   angle = e - d/(H w) e',   tan e = -v/(M u cos(lat)),   w^2 = (u cos(lat))^2 + (v/M)^2
///
/// The ring follows the error e of the speed behind the lag of its damper d. The next term of this
/// expansion is (d/(H w))^2 e'', below 1e-12; the ring's own oscillation has decayed by 1e-13.
double course_error() {
  const double a = 6378137, f = 1 / 298.257223563, e2 = f * (2 - f);
  const double u = 7.292115e-5, v = 10;
  const auto M = [=](double lat) {
    return a * (1 - e2) / std::pow(1 - e2 * std::sin(lat) * std::sin(lat), 1.5);
  };
  const auto error = [&](double lat) { return -std::atan(v / (M(lat) * u * std::cos(lat))); };
  const double start = 50 * std::acos(-1.0) / 180;
  const double lat = start + 2500 / M(start);
  const double slope = (error(lat + 1e-5) - error(lat - 1e-5)) / 2e-5 * v / M(lat);
  return error(lat) - 1.5e-3 / (12 * std::hypot(u * std::cos(lat), v / M(lat))) * slope;
}

// Closed forms, with an exponential to 40 digits. For the last four: Runge-Kutta steps in 18 digits
// with Richardson extrapolation twice, of equations without bodies. Relative error 1e-10 or better.
BOOST_AUTO_TEST_CASE(examples) {
  struct Case {
    const char* file;
    const char* value;
    double wanted;
    double bound;
  };
  const double pi = std::acos(-1.0);
  const double w = std::sqrt(25 / 0.5 - 1);
  const double slide = 0.04 * (1 - std::exp(-2.0) * (std::cos(2 * w) + std::sin(2 * w) / w));
  const Case cases[] = {
      {"turntable", "/outer ring/coordinate", -0.46221711420209527, 1e-13},
      {"turntable", "/inner ring/coordinate", 0.40492936929014556, 1e-13},
      {"turntable", "/rotor/rate", 59.610124589994791, 1e-11},
      {"damped_slide", "/slide/coordinate", slide, 1e-14},
      {"wheel_spun_up", "/wheel/rate", 10 * (1 - std::exp(-3.0)), 1e-13},
      {"wheel_spun_up", "/wheel/coordinate", 10 * (2 + std::exp(-3.0)), 1e-13},
      {"torque_step", "/satellite/angular_velocity/2", -0.8 / 4, 1e-12},
      {"torque_step", "/wheel/rate", 0.8 / 0.01 + 0.8 / 4, 1e-10},
      {"torque_step", "/wheel/coordinate", 4 * (0.8 / 0.01 + 0.8 / 4), 1e-9},
      {"crane_on_ship", "/column/coordinate", 2, 1e-12},
      {"crane_on_ship", "/jib/coordinate", -0.3, 0},
      {"gyrocompass", "/ring/coordinate", -0.0905804740612723065, 1e-11},
      {"gyrocompass", "/rotor/coordinate", 240000, 1e-6},
      {"sailing_gyrocompass", "/ring/coordinate", course_error(), 2e-9},
      {"satellite", "/satellite/angular_velocity/0", -0.00162200887961949882, 1e-12},
      {"satellite", "/satellite/angular_velocity/1", 0.00104709487436355220, 1e-12},
      {"satellite", "/satellite/angular_velocity/2", 0.0099678816409924653, 1e-12},
      {"foeppl_gyro", "/outer ring/coordinate", -0.00070099062791860394, 1e-14},
      {"foeppl_gyro", "/inner ring/coordinate", -0.016606655564617444, 1e-14},
      {"double_pendulum", "/upper/coordinate", 8.1910784594, 1e-9},
      {"double_pendulum", "/lower/coordinate", -8.1760615388, 1e-9},
      {"device_on_logged_ship", "/pendulum/coordinate", -0.214564370970795929, 1e-9},
  };
  std::string file;
  json joints;
  for (const Case& c : cases) {
    if (file != c.file) joints = answer(scene(file = c.file)).at("final").at("joints");
    check_near(std::string(c.file) + c.value, joints.at(json::json_pointer(c.value)), c.wanted,
               c.bound);
  }
  // The plane of Foucault's pendulum: 15.04 degrees an hour times the sine of the latitude. The
  // bob's own oval path reduces it by a thousandth.
  const json bob =
      answer(scene("foucault_pendulum")).at("final").at("joints").at("bob").at("coordinate");
  const double turned = std::atan(bob.at(1).get<double>() / bob.at(0).get<double>()) * 180 / pi;
  check_near("Foucault", turned, 15.041067 * std::sin(48.846222 * pi / 180), 0.06);
}

BOOST_AUTO_TEST_CASE(elements_are_reported) {
  const std::string engine = scene("engine_on_mounts") + " --t-end 0.1";
  const json elements = answer(engine).at("final").at("elements");
  BOOST_TEST(elements.size() == 4U);
  double weight = 0;
  for (const auto& [name, load] : elements.items()) {
    BOOST_TEST(load.at("torque").size() == 3U);
    weight += load.at("force").at(2).get<double>();
  }
  BOOST_TEST(std::abs(weight - 160 * 9.81) < 100);  // the block moves
  const Outcome text = run(engine);
  BOOST_TEST(text.out.find("elements on their second bodies, N and N m") != std::string::npos);
  BOOST_TEST(text.out.find("load: elements between bodies") != std::string::npos);
}

BOOST_AUTO_TEST_CASE(constraints_are_reported) {
  const std::string bicycle = scene("bicycle") + " --t-end 0.1";
  const json result = answer(bicycle);
  BOOST_TEST(result.at("warnings").empty());
  double weight = 0;
  for (const auto& [name, load] : result.at("final").at("constraints").items()) {
    weight += load.at("force").at(2).get<double>();
  }
  BOOST_TEST(std::abs(weight - 94 * 9.81) < 20);  // the frame leans over
  BOOST_TEST(run(bicycle).out.find("constraints on their second bodies") != std::string::npos);
}

BOOST_AUTO_TEST_CASE(every_example_runs) {
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(KREISEL_SCENES)) {
    if (entry.path().extension() != ".toml") continue;
    ++count;
    const json result = answer("'" + entry.path().string() + "' --t-end 0.1");
    BOOST_TEST(result.at("tolerance_kept").get<bool>(), entry.path());
    BOOST_TEST(result.at("final").at("t").get<double>() == 0.1);
    BOOST_TEST(result.at("title").get<std::string>().size() > 5U);
  }
  BOOST_TEST(count >= 15);
}

BOOST_AUTO_TEST_SUITE_END()

BOOST_AUTO_TEST_SUITE(simulate_from_a_command_line)

const std::string two_rods = R"(
[gravity]
kind = "uniform"
vector = [0, 0, -9.81]
[[body]]
name = "upper"
joint = { kind = "revolute", axis = [0, 1, 0] }
mass = 1
centre = [0, 0, -1]
inertia = [0.1, 0.1, 0.1]
initial = { angle = 0.5 }
[[body]]
name = "lower"
parent = "upper"
joint = { kind = "revolute", axis = [0, 1, 0], position = [0, 0, -1] }
mass = 1
centre = [0, 0, -1]
inertia = [0.1, 0.1, 0.1]
[solve]
t_end = 2
tolerance = 1e-9
output_step = 0.01
)";

BOOST_AUTO_TEST_CASE(agrees_with_the_library_to_the_bit) {
  const auto rod = InertiaTensor<Body>::about_centre(
      1, {0, 0, -1}, 0.1 * Matrix3<double>::Identity(), Mass::zero_allowed);
  const Joint joint{.kind = JointKind::revolute, .axis = {0, 1, 0}};
  Joint hinge = joint;
  hinge.position = {0, 0, -1};
  const BodySystem system(RestingFrame<>{},
                          {{.name = "upper", .joint = joint, .inertia = rod},
                           {.name = "lower", .parent = "upper", .joint = hinge, .inertia = rod}},
                          UniformGravity<Guide>{{0, 0, -9.81}});
  SolveOptions options;
  options.tolerance = 1e-9;
  for (int i = 0; i <= 200; ++i) options.output_times.push_back(std::min(i * 0.01, 2.0));
  auto start = system.rest();
  start.coordinates[0] = 0.5;
  const auto wanted = kreisel::solve(system, start, options);

  const Scratch folder;
  const auto file = folder.write("scene.toml", two_rods);
  const auto csv = folder.path() / "out.csv";
  const json result = answer(file.string() + " --csv " + csv.string());
  const json& joints = result.at("final").at("joints");
  const auto& end = wanted.states.back();
  BOOST_TEST(joints.at("upper").at("coordinate").get<double>() == end.coordinates[0]);
  BOOST_TEST(joints.at("lower").at("coordinate").get<double>() == end.coordinates[1]);
  BOOST_TEST(joints.at("upper").at("rate").get<double>() == end.rates[0]);
  BOOST_TEST(joints.at("lower").at("rate").get<double>() == end.rates[1]);
  BOOST_TEST(result.at("error_estimate").get<double>() == wanted.report.error_estimate);
  BOOST_TEST(result.at("steps").get<double>() == wanted.report.effort.steps);
  BOOST_TEST(result.at("invariants").at(0).at("name") == "energy");

  const auto rows = lines(folder.read("out.csv"));
  BOOST_TEST(rows.size() == 202U);
  BOOST_TEST(rows.at(0) == "t,upper.angle,upper.rate,lower.angle,lower.rate");
  for (std::size_t i = 1; i < rows.size(); ++i) {
    std::istringstream row(rows[i]);
    std::string field;
    std::getline(row, field, ',');
    std::getline(row, field, ',');
    BOOST_TEST(std::stod(field) == wanted.states[i - 1].coordinates[0]);
  }
}

BOOST_AUTO_TEST_CASE(prints_reactions_and_terms_on_request) {
  const Scratch folder;
  const std::string file = folder.write("scene.toml", two_rods).string();
  BOOST_TEST(!answer(file).at("final").contains("reactions"));
  const json final = answer(file + " --reactions --terms --t-end 0.5").at("final");
  BOOST_TEST(final.at("t").get<double>() == 0.5);
  BOOST_TEST(final.at("reactions").at("lower").at("force").size() == 3U);
  BOOST_TEST(final.at("terms").at("lower").at("coriolis").at("torque").size() == 3U);
  const Outcome text = run(file + " --reactions --terms");
  BOOST_TEST(text.status == 0);
  for (const char* const word :
       {"taylor", "energy", "reactions", "terms kept", "Coriolis", "the guide rests"}) {
    BOOST_TEST(text.out.find(word) != std::string::npos, word);
  }
  BOOST_TEST(text.err == "");
}

// Rows and report of a run killed at any time, and killed twice.
BOOST_AUTO_TEST_CASE(continues_exactly_after_a_kill) {
  const Scratch folder;
  std::string longer = two_rods;
  longer.replace(longer.find("output_step = 0.01"), 18, "output_step = 0.05");
  // Until this machine needs two seconds, which are ten checkpoints.
  int t_end = 400;
  std::string file;
  json whole;
  do {
    t_end *= 2;
    std::string scene = longer;
    scene.replace(scene.find("t_end = 2"), 9, "t_end = " + std::to_string(t_end));
    file = folder.write("scene.toml", scene).string();
    whole = answer(file + " --csv " + (folder.path() / "whole.csv").string());
  } while (whole.at("run_time_s") < 2);
  const std::string csv = (folder.path() / "part.csv").string();
  // After it has written a checkpoint that is not of its first row, or a later one than before.
  const auto kill = [&](const std::string& option, const std::string& after) {
    return test::run("( " + std::string(KREISEL_SIMULATE) + " " + file + option + " --csv " + csv +
                     " & pid=$!; until awk 'NR == 1 && $3 > " + after +
                     " { found = 1 } END { exit !found }' " + csv +
                     ".resume 2>/dev/null || ! kill -0 $pid; do sleep 0.02; done; "
                     "kill -KILL $pid; wait $pid )");
  };
  BOOST_TEST(kill("", "0").status == 137);
  BOOST_TEST(folder.read("part.csv").size() < folder.read("whole.csv").size());
  std::istringstream checkpoint(folder.read("part.csv.resume"));
  std::string word, reached;
  checkpoint >> word >> word >> reached;
  BOOST_TEST(kill(" --resume", reached).status == 137);
  BOOST_TEST(folder.read("part.csv").size() < folder.read("whole.csv").size());
  const Outcome outcome = run(file + " --json --resume --csv " + csv);
  BOOST_TEST(outcome.status == 0, outcome.err);
  BOOST_TEST(outcome.err.find("going on from t = ") != std::string::npos, outcome.err);
  BOOST_TEST((folder.read("part.csv") == folder.read("whole.csv")));
  const json resumed = test::parsed(outcome.out);
  for (const char* const key : {"final", "steps", "rejected", "evaluations", "all_evaluations",
                                "error_estimate", "invariants", "method"}) {
    BOOST_TEST(resumed.at(key) == whole.at(key), key);
  }
  BOOST_TEST(!std::filesystem::exists(csv + ".resume"));
}

// Rows without a checkpoint: the missing part is computed again from the last whole row, to the
// tolerance.
BOOST_AUTO_TEST_CASE(continues_a_stopped_run) {
  const Scratch folder;
  const std::string file = folder.write("scene.toml", two_rods).string();
  const json whole = answer(file + " --csv " + (folder.path() / "whole.csv").string());
  const std::string all = folder.read("whole.csv");
  const std::size_t middle = all.size() / 2;  // in the midst of a row
  const auto part = folder.write("part.csv", all.substr(0, middle));
  const Outcome outcome = run(file + " --json --resume --csv " + part.string());
  BOOST_TEST(outcome.status == 0, outcome.err);
  BOOST_TEST(outcome.err.find(" s with new steps, for ") != std::string::npos, outcome.err);
  const json rest = test::parsed(outcome.out);
  for (const char* const body : {"upper", "lower"}) {
    for (const char* const quantity : {"coordinate", "rate"}) {
      check_near(body, rest.at("final").at("joints").at(body).at(quantity),
                 whole.at("final").at("joints").at(body).at(quantity), 1e-8);
    }
  }
  const auto rows = lines(folder.read("part.csv"));
  BOOST_TEST(rows.size() == lines(all).size());
  BOOST_TEST(folder.read("part.csv").substr(0, middle - 100) == all.substr(0, middle - 100));
  // A complete run stays unchanged.
  BOOST_TEST(run(file + " --resume --csv " + (folder.path() / "whole.csv").string()).status == 0);
  BOOST_TEST(folder.read("whole.csv") == all);
  // Rows of another scene are refused, and kept.
  const auto other = folder.write("other.toml", "title = \"x\"\n" + two_rods);
  folder.write("other.csv", "t,upper.angle,upper.rate,lower.angle,lower.rate\n0,1,0,0,0\n");
  const Outcome refused =
      run(other.string() + " --resume --csv " + (folder.path() / "other.csv").string());
  BOOST_TEST(refused.status == 2);
  BOOST_TEST(lines(folder.read("other.csv")).size() == 2U);
}

BOOST_AUTO_TEST_CASE(leaves_whole_rows_when_stopped) {
  std::string endless = two_rods;
  endless.replace(endless.find("t_end = 2"), 9, "t_end = 1e4");
  for (const char* const signal : {"INT", "KILL"}) {
    const Scratch folder;
    const std::string file = folder.write("scene.toml", endless).string();
    const std::string csv = (folder.path() / "out.csv").string();
    const Outcome outcome =
        test::run("( " + std::string(KREISEL_SIMULATE) + " " + file + " --csv " + csv +
                  " & pid=$!; until awk 'END { exit NR < 4 }' " + csv +
                  " 2>/dev/null || ! kill -0 $pid; do sleep 0.02; done; kill -" + signal +
                  " $pid; wait $pid )");
    const std::string text = folder.read("out.csv");
    BOOST_TEST(lines(text).size() > 2U);
    if (std::string(signal) == "KILL") continue;
    BOOST_TEST(outcome.status == 130);
    BOOST_TEST(text.back() == '\n');
    BOOST_TEST(std::count(text.begin(), text.end(), ',') ==
               4 * std::count(text.begin(), text.end(), '\n'));
    BOOST_TEST(outcome.err.find("interrupted after t = ") != std::string::npos, outcome.err);
    BOOST_TEST(lines(outcome.err).size() == 1U);
  }
}

BOOST_AUTO_TEST_CASE(a_full_disk_exits_with_3) {
  const Scratch folder;
  const std::string file = folder.write("scene.toml", two_rods).string();
  const Outcome csv = run(file + " --csv /dev/full");
  BOOST_TEST(csv.status == 3);
  BOOST_TEST(csv.err.find("/dev/full: No space left on device") != std::string::npos, csv.err);
  BOOST_TEST(lines(csv.err).size() == 1U);
  BOOST_TEST(
      test::run("( " + std::string(KREISEL_SIMULATE) + " " + file + " >/dev/full )").status == 3);
  // A file limited to 4 kB keeps its whole rows.
  const std::string out = (folder.path() / "out.csv").string();
  const Outcome limited =
      test::run("bash -c \"trap '' XFSZ; ulimit -f 4; " + std::string(KREISEL_SIMULATE) + " " +
                file + " --csv " + out + "\"");
  BOOST_TEST(limited.status == 3);
  BOOST_TEST(limited.err.find("it holds the rows up to there") != std::string::npos, limited.err);
  const std::string text = folder.read("out.csv");
  BOOST_TEST(text.size() > 3000U);
  BOOST_TEST(text.back() == '\n');
}

// If steps have been shortened, the accepted run may have started a last digit beside the start.
// Its first row is nevertheless that of the scene, and rows cut off by a full disk continue.
namespace {

/// A ship that rolls by 0.2 rad with 8 s, logged at 100 Hz with 4 decimals, and a pendulum in it.
struct RollingShip {
  static constexpr const char* pendulum = R"(
[gravity]
kind = "inertial"
vector = [0, 0, -9.81]
[[body]]
name = "pendulum"
joint = { kind = "revolute", axis = [1, 0, 0] }
mass = 2.0
centre = [0, 0, -0.5]
inertia = [0.05, 0.05, 0.01]
damping = 0.1
[solve]
t_end = 12
tolerance = 1e-9
[report]
reactions = true
)";

  Scratch folder;
  double truth = 0;

  RollingShip() {
    std::string log = "t,qw,qx,qy,qz\n";
    const auto rounded = [](double x) { return std::to_string(std::round(x * 1e4) / 1e4); };
    const double w = 0.785398163397448;
    for (int i = 0; i <= 1300; ++i) {
      const double half = 0.1 * std::sin(w * i / 100);
      log += std::to_string(i / 100.0) + "," + rounded(std::cos(half)) + "," +
             rounded(std::sin(half)) + ",0,0\n";
    }
    folder.write("log.csv", log);
    const std::string roll =
        "[guide]\nkind = \"harmonic\"\nangular_velocity = { terms = [{ amplitude = "
        "[0.1570796326794897, 0, 0], frequency = 0.785398163397448, phase_deg = 90 }] }\n";
    const std::string file = folder.write("truth.toml", roll + pendulum).string();
    truth = coordinate(answer(file + " --method verner98"));
  }

  [[nodiscard]] json along_the_log(const std::string& keys) {
    const std::string guide = "[guide]\nkind = \"table\"\nfile = \"log.csv\"\n" + keys;
    return answer(folder.write("scene.toml", guide + pendulum).string());
  }

  [[nodiscard]] static double coordinate(const json& result) {
    return result.at("final").at("joints").at("pendulum").at("coordinate");
  }
};

}  // namespace

BOOST_AUTO_TEST_CASE(reports_the_effect_of_log_errors) {
  RollingShip ship;
  for (const char* const keys : {"", "sigma = 0\n", "sigma = 3e-5\n", "sigma = [3e-5, 0]\n"}) {
    const json result = ship.along_the_log(keys);
    const double off = std::abs(RollingShip::coordinate(result) - ship.truth);
    const json& told = result.at("final").at("error_of_log").at("pendulum");
    BOOST_TEST_MESSAGE(keys << "off by " << off << ", told " << told.dump());
    BOOST_TEST(off <= 1.2 * told.at("coordinates").at(0).get<double>());
    BOOST_TEST(told.at("force").get<double>() > 0);
    const json& error = result.at("error");
    BOOST_TEST(error.at("model").get<double>() == 0);
    const double sum = error.at("integration").get<double>() + error.at("log").get<double>();
    BOOST_TEST(std::abs(result.at("error_estimate").get<double>() - sum) <= 1e-12 * sum);
    const double parts = error.at("truncation").get<double>() + error.at("rounding").get<double>();
    BOOST_TEST(std::abs(error.at("integration").get<double>() - parts) <= 1e-12 * parts);
    const bool interpolated = std::string(keys) == "sigma = 0\n";
    BOOST_TEST((off < 1e-4) != interpolated);
  }
  const Outcome text = run((ship.folder.path() / "scene.toml").string());
  BOOST_TEST(text.out.find("error_of_integration ") != std::string::npos);
  BOOST_TEST(text.out.find("error_of_log ") != std::string::npos);
}

// 30 Hz in hundredths of a second: as they are written, the rows accelerate the ship by its motion
// over 5 ms, 30 times a second.
BOOST_AUTO_TEST_CASE(rounded_time_stamps_are_told) {
  RollingShip ship;
  std::string log = "t,yaw,pitch,roll\n";
  for (int i = 0; i <= 390; ++i) {
    char row[64];
    std::snprintf(row, sizeof row, "%.2f,0,0,%.17g\n", i / 30.0,
                  0.2 * std::sin(0.785398163397448 * i / 30));
    log += row;
  }
  ship.folder.write("log.csv", log);
  for (const char* const keys : {"", "time_stamps = \"exact\"\nsigma = 0\n"}) {
    const bool is_exact = std::string(keys) != "";
    const json result = ship.along_the_log(keys);
    const double off = std::abs(RollingShip::coordinate(result) - ship.truth);
    const double told = result.at("error").at("log");
    BOOST_TEST_MESSAGE(keys << "off by " << off << ", told " << told);
    BOOST_TEST((off > 1e-4) == is_exact);
    BOOST_TEST(result.at("warnings").size() == (is_exact ? 0U : 1U));
    if (is_exact) continue;
    BOOST_TEST(off <= 1.2 * told);
    const std::string warning = result.at("warnings").at(0);
    BOOST_TEST(warning.starts_with("log 'log.csv': its time stamps are coarse"), warning);
  }
}

BOOST_AUTO_TEST_CASE(first_row_is_the_start) {
  const Scratch folder;
  const std::string command =
      std::string(KREISEL_SIMULATE) + " " + scene("double_pendulum") + " --t-end 20 --csv ";
  const std::string part = (folder.path() / "part.csv").string();
  const Outcome limited =
      test::run("bash -c \"trap '' XFSZ; ulimit -f 150; " + command + part + "\"");
  BOOST_TEST(limited.status == 3, limited.err);
  BOOST_TEST(lines(folder.read("part.csv")).at(1) == "0,2,0,0.5,0");
  BOOST_TEST(test::run(command + part + " --resume").status == 4);  // chaos
  BOOST_TEST(test::run(command + (folder.path() / "whole.csv").string()).status == 4);
  BOOST_TEST(folder.read("part.csv") == folder.read("whole.csv"));
}

// A double pendulum for 200 s: its error exceeds the motion.
BOOST_AUTO_TEST_CASE(a_missed_tolerance_exits_with_4) {
  const Scratch folder;
  const std::string file =
      folder.write("chaos.toml", replaced(two_rods, "angle = 0.5", "angle = 2.5")).string();
  const Outcome missed = run(file + " --t-end 200");
  BOOST_TEST(missed.status == 4, missed.err);
  BOOST_TEST(missed.out.find("NOT REACHED") != std::string::npos, missed.out);
  BOOST_TEST(missed.err.find("was not reached") != std::string::npos, missed.err);
  BOOST_TEST(run(file + " --t-end 0.5").status == 0);
}

// An energy of 5e319 J overflows: the run is incomplete, and no result is printed.
BOOST_AUTO_TEST_CASE(a_number_that_is_not_finite_exits_with_3) {
  const Scratch folder;
  const std::string wheel =
      "[[body]]\nname = \"wheel\"\njoint = { kind = \"revolute\", axis = [0, 0, 1] }\nmass = 1\n"
      "inertia = [1e10, 1e10, 1e10]\ninitial = { rate = 1e155 }\n[solve]\nt_end = 1\n";
  for (const char* const option : {"", " --json"}) {
    const Outcome outcome = run(folder.write("scene.toml", wheel).string() + option);
    BOOST_TEST(outcome.status == 3, outcome.err);
    BOOST_TEST(outcome.err.find("not finite: invariants") != std::string::npos, outcome.err);
    BOOST_TEST(outcome.out == "");
  }
}

BOOST_AUTO_TEST_CASE(values_are_set_on_the_command_line) {
  const Scratch folder;
  const std::string file = folder.write("scene.toml", two_rods).string();
  const std::string set = " --set body[0].mass=2 --set 'solve.t_end=0.5 s' --json";
  const Outcome by_file = run(file + set);
  const Outcome by_pipe = test::run("cat " + file + " | " KREISEL_SIMULATE " -" + set);
  BOOST_REQUIRE_MESSAGE(by_file.status == 0, by_file.err);
  const json found = test::parsed(by_file.out);
  BOOST_TEST(found.at("final").at("t") == 0.5);
  BOOST_TEST(found.at("final") == test::parsed(by_pipe.out).at("final"));
  const Outcome plain = run(file + " --t-end 0.5 --json");
  BOOST_TEST(found.at("final") != test::parsed(plain.out).at("final"));
}

BOOST_AUTO_TEST_CASE(help_lists_the_exit_statuses) {
  const Outcome help = run("--help");
  BOOST_TEST(help.status == 0);
  for (const char* const status : {"  0 ", "  2 ", "  3 ", "  4 ", "  130 "}) {
    BOOST_TEST(help.out.find(status) != std::string::npos, status);
  }
}

BOOST_AUTO_TEST_CASE(bad_input_exits_with_2_and_writes_nothing) {
  const Scratch folder;
  const std::string good = folder.write("scene.toml", two_rods).string();
  const std::string bad = folder.write("bad.toml", "titel = \"\"\n" + two_rods).string();
  const std::string csv = " --csv " + (folder.path() / "out.csv").string();
  const std::pair<std::string, std::string> cases[] = {
      {"", "scene is required"},
      {"none.toml", "none.toml: cannot be read"},
      {bad, "bad.toml:1:1: titel: is no key here (did you mean 'title'?)"},
      {good + " --t-end nan", "--t-end = 'nan' is not a finite number"},
      {good + " --t-end -1", "--t-end must be above 0"},
      {good + " --tolerance 1", "--tolerance lies outside"},
      {good + " --method euler", "--method = 'euler' is none of"},
      {good + " --method splitting", "method splitting does not apply"},
      {good + " --colour red", "--colour"},
      {good + " --resume", "cannot be read"},
  };
  for (const auto& [arguments, reason] : cases) {
    const Outcome outcome = run(arguments + csv);
    BOOST_TEST(outcome.status == 2, arguments << " exits with " << outcome.status);
    BOOST_TEST(outcome.out == "");
    BOOST_TEST(outcome.err.find(reason) != std::string::npos, arguments << ": " << outcome.err);
    BOOST_TEST(lines(outcome.err).size() == 1U, outcome.err);
  }
  BOOST_TEST(folder.size() == 2U);
  BOOST_TEST(run(good + " --csv /no/such/folder/x.csv").status == 2);
}

// A joint without inertia is reported when it should move.
BOOST_AUTO_TEST_CASE(failed_computations_exit_with_3) {
  const Scratch folder;
  std::string massless = two_rods;
  const std::size_t last =
      massless.rfind("mass = 1\ncentre = [0, 0, -1]\ninertia = [0.1, 0.1, 0.1]");
  massless.replace(last, 8, "mass = 0");
  massless.replace(massless.rfind("inertia = [0.1, 0.1, 0.1]"), 25, "inertia = [0, 0, 0]");
  const Outcome outcome = run(folder.write("scene.toml", massless).string());
  BOOST_TEST(outcome.status == 3);
  BOOST_TEST(outcome.err.find("lower") != std::string::npos, outcome.err);
}

// A mode of 1e7 per second decays at once; the soft joint's motion is left.
BOOST_AUTO_TEST_CASE(stiff_and_chosen_methods) {
  const Scratch folder;
  std::string stiff = two_rods;
  stiff.insert(stiff.find("[solve]"), "spring = { stiffness = 1e6 }\ndamping = 1e6\n");
  const json result = answer(folder.write("stiff.toml", stiff).string());
  BOOST_TEST(result.at("method") == "radau13");
  BOOST_TEST(result.at("tolerance_kept").get<bool>());
  const std::string file = folder.write("scene.toml", two_rods).string();
  const json wanted = answer(file);
  for (const char* const method : {"verner98", "radau13", "gauss16"}) {
    const json found = answer(file + " --method " + method);
    BOOST_TEST(found.at("method") == method);
    for (const char* const body : {"upper", "lower"}) {
      check_near(method, found.at("final").at("joints").at(body).at("rate"),
                 wanted.at("final").at("joints").at(body).at("rate"), 2e-8);
    }
  }
}

/// A scene with a model, between its head and its solve table.
std::string approximated(const char* model, const std::string& bodies) {
  return bodies + "[solve]\nt_end = 0.2\noutput_step = 0.01\ntolerance = 1e-10\nmodel = \"" +
         model + "\"\n";
}

// Against the harmonic oscillation; its reported error is that of the period, phi^2/16 of it.
BOOST_AUTO_TEST_CASE(linear_equations_report_their_error) {
  const Scratch folder;
  const std::string rod = two_rods.substr(0, two_rods.find("[[body]]\nname = \"lower\""));
  const std::string file = folder.write("scene.toml", approximated("linear", rod)).string();
  const double w = std::sqrt(9.81 / 1.1);
  for (const double begin : {0.5, 0.02}) {
    std::string text = approximated("linear", rod);
    text.replace(text.find("angle = 0.5"), 11, "angle = " + std::to_string(begin));
    folder.write("scene.toml", text);
    const json result = answer(file + " --t-end 20");
    BOOST_TEST(result.at("model") == "linear");
    const json& end = result.at("final").at("joints").at("upper");
    check_near("angle", end.at("coordinate"), begin * std::cos(w * 20), 1e-13);
    check_near("rate", end.at("rate"), -w * begin * std::sin(w * 20), 1e-13);
    const double off = begin * begin / 16 * w * 20;
    const double told = result.at("error_estimate");
    if (begin < 0.1) BOOST_TEST((told > 0.8 * off && told < 1.1 * off), told << " and " << off);
    BOOST_TEST(!result.at("tolerance_kept").get<bool>());
  }
}

// A quarter of a swing from rest: early outputs are small, errors are relative to the whole motion.
BOOST_AUTO_TEST_CASE(model_errors_whatever_the_outputs) {
  const Scratch folder;
  const double begin = 0.005;
  std::string rod = two_rods.substr(0, two_rods.find("[[body]]\nname = \"lower\""));
  rod.replace(rod.find("angle = 0.5"), 11, "angle = 0.005");
  const auto angle = [&folder, &rod](const char* model, const std::string& outputs, double& told) {
    std::string text = approximated(model, rod);
    text.replace(text.find("output_step = 0.01"), 18, outputs);
    const json result = answer(folder.write("scene.toml", text).string() + " --t-end 0.5");
    told = result.at("error_estimate");
    return result.at("final").at("joints").at("upper").at("coordinate").get<double>();
  };
  double told = 0;
  const double exact = angle("exact", "output_times = [0.5]", told);
  for (const char* const outputs :
       {"output_step = 0.025", "output_step = 0.001", "output_times = [0.5]"}) {
    const double off = std::abs(angle("linear", outputs, told) - exact) / begin;
    // The bound is known to a few percent.
    BOOST_TEST((told >= off && told <= 1.1 * off), outputs << ": " << told << " and " << off);
  }
}

// The same rod in a spherical joint: its rotation follows the angle.
BOOST_AUTO_TEST_CASE(linear_equations_of_an_attitude) {
  const Scratch folder;
  const double begin = 0.7;
  std::string ball = two_rods.substr(0, two_rods.find("[[body]]\nname = \"lower\""));
  ball.replace(ball.find("\"revolute\", axis = [0, 1, 0]"), 28, "\"spherical\"");
  std::ostringstream attitude;
  attitude.precision(17);
  attitude << "attitude = [" << std::cos(begin / 2) << ", 0, " << std::sin(begin / 2) << ", 0]";
  ball.replace(ball.find("angle = 0.5"), 11, attitude.str());
  const std::string file = folder.write("scene.toml", approximated("linear", ball)).string();
  const json end = answer(file + " --t-end 3").at("final").at("joints").at("upper");
  const double w = std::sqrt(9.81 / 1.1);
  const double angle = begin * std::cos(3 * w);
  const double sign = end.at("attitude").at(0).get<double>() > 0 ? 1 : -1;
  check_near("w", sign * end.at("attitude").at(0).get<double>(), std::cos(angle / 2), 1e-13);
  check_near("y", sign * end.at("attitude").at(2).get<double>(), std::sin(angle / 2), 1e-13);
  check_near("rate", end.at("angular_velocity").at(1), -w * begin * std::sin(3 * w), 1e-13);
}

// Without transverse inertia: H beta' + c_a alpha = 0, -H alpha' + c_b beta = 0.
BOOST_AUTO_TEST_CASE(precession_equations_report_their_error) {
  const Scratch folder;
  const std::string bodies = R"(
[[body]]
name = "outer"
joint = { kind = "revolute", axis = [1, 0, 0] }
mass = 0
inertia = [0, 0, 0]
spring = { stiffness = 2 }
initial = { angle = 1e-3 }
[[body]]
name = "inner"
parent = "outer"
joint = { kind = "revolute", axis = [0, 1, 0] }
mass = 0
inertia = [0, 0, 0]
spring = { stiffness = 3 }
[[body]]
name = "rotor"
parent = "inner"
joint = { kind = "revolute", axis = [0, 0, 1] }
mass = 1
inertia = [3e-4, 3e-4, 5e-4]
rotor = { mode = "free", speed = 500 }
)";
  const std::string file = folder.write("scene.toml", approximated("precession", bodies)).string();
  const json result = answer(file);
  BOOST_TEST(result.at("model") == "precession");
  const double H = 5e-4 * 500;
  const double w = std::sqrt(2.0 * 3.0) / H;
  const json& end = result.at("final").at("joints");
  // The error has third order in the angles.
  check_near("alpha", end.at("outer").at("coordinate"), 1e-3 * std::cos(w * 0.2), 5e-9);
  check_near("beta", end.at("inner").at("coordinate"),
             -1e-3 * std::sqrt(2.0 / 3.0) * std::sin(w * 0.2), 5e-9);
  // From rest the first swing deviates by the nutation: rates deviate by their own size.
  std::string exact = approximated("exact", bodies);
  const json truth = answer(folder.write("exact.toml", exact).string()).at("final").at("joints");
  for (const char* const body : {"outer", "inner"}) {
    const double off = std::abs(end.at(body).at("coordinate").get<double>() -
                                truth.at(body).at("coordinate").get<double>());
    BOOST_TEST(off <= 2e-3 * result.at("error_estimate").get<double>(), body << ": " << off);
    BOOST_TEST(off > 0);
  }
  check_near("rotor", end.at("rotor").at("coordinate"), 500 * 0.2, 1e-12);
}

/// A gyro in two rings; `rotor` are its moments, followed by its keys.
std::string gyro(const std::string& rings, const std::string& rotor) {
  return "[[body]]\nname = \"outer\"\njoint = { kind = \"revolute\", axis = [1, 0, 0] }\n" + rings +
         "initial = { angle = ANGLE }\n"
         "[[body]]\nname = \"inner\"\nparent = \"outer\"\n"
         "joint = { kind = \"revolute\", axis = [0, 1, 0] }\n" +
         rings +
         "[[body]]\nname = \"rotor\"\nparent = \"inner\"\n"
         "joint = { kind = \"revolute\", axis = [0, 0, 1] }\nmass = 1\ninertia = " +
         rotor + "\n";
}

// With T_a = T_b = T and equal springs z = alpha + i beta obeys  T z'' - i H z' + c z = 0.
BOOST_AUTO_TEST_CASE(foeppls_equations_report_their_error) {
  const Scratch folder;
  const std::string bodies =
      gyro("mass = 1\ninertia = [1e-3, 2e-3, 1.5e-3]\nspring = { stiffness = 2 }\n",
           "[3e-3, 3e-3, 5e-3]\nrotor = { mode = \"free\", speed = 50 }");
  const double T = 5e-3;
  const double H = 5e-3 * 50;
  const double c = 2;
  const double root = std::sqrt(H * H + 4 * T * c);
  const double w_1 = (H + root) / (2 * T);
  const double w_2 = (H - root) / (2 * T);
  double before = 0;
  for (const double angle : {1e-2, 5e-3}) {
    const std::string text =
        replaced(approximated("foeppl", bodies), "ANGLE", std::to_string(angle));
    const std::string file = folder.write("scene.toml", text).string();
    const json result = answer(file);
    BOOST_TEST(result.at("model") == "foeppl");
    const json& end = result.at("final").at("joints");
    const double t = 0.2;
    const double scale = angle / (w_2 - w_1);
    check_near("alpha", end.at("outer").at("coordinate"),
               scale * (w_2 * std::cos(w_1 * t) - w_1 * std::cos(w_2 * t)), 1e-13);
    check_near("beta", end.at("inner").at("coordinate"),
               scale * (w_2 * std::sin(w_1 * t) - w_1 * std::sin(w_2 * t)), 1e-13);
    check_near("alpha'", end.at("outer").at("rate"),
               scale * w_1 * w_2 * (std::sin(w_2 * t) - std::sin(w_1 * t)), 1e-11);
    BOOST_TEST(end.at("rotor").at("rate") == 50);
    // The error has third order in the angles, so second order relative to them.
    const double off = result.at("error_estimate");
    if (before > 0) BOOST_TEST((before / off > 3.9 && before / off < 4.1), before / off);
    before = off;
  }
}

// A horizon in a turn: 1.2 N m s of spin in a turn of 0.05 rad/s are a spring of 0.06 N m/rad.
BOOST_AUTO_TEST_CASE(terms_of_frames_have_sizes) {
  const json all = answer(scene("horizon_in_turn") + " --terms");
  const json& outer = all.at("terms_by_kind").at("outer");
  const auto size = [&outer](const char* kind) { return outer.at(kind).at(0).get<double>(); };
  // The greatest angle of the outer ring is 0.0533 rad.
  check_near("restraint", size("restraint"), 0.06 * 0.0532, 2e-5);
  BOOST_TEST(size("gyroscopic") > 1e3 * size("left_out"));
  BOOST_TEST(size("guide_inertia") == 0);
  BOOST_TEST(run(scene("horizon_in_turn") + " --terms").out.find("guide_gyroscopic") !=
             std::string::npos);
  BOOST_TEST(!answer(scene("heavy_top") + " --terms").contains("terms_by_kind"));
}

// Mirrored axes, a spin about the negative axis and turned bodies are the same gyro.
BOOST_AUTO_TEST_CASE(foeppls_equations_on_any_axes) {
  const Scratch folder;
  const std::string rings =
      "mass = 1\ninertia = [1e-3, 2e-3, 1.5e-3]\nspring = { stiffness = 2 }\n";
  const std::string plain = replaced(
      gyro(rings, "[3e-3, 3e-3, 5e-3]\nrotor = { mode = \"free\", speed = 50 }"), "ANGLE", "0.01");
  std::string other = replaced(plain, "axis = [0, 0, 1]", "axis = [0, 0, -2]");
  other = replaced(other, "speed = 50", "speed = -50");
  // The inner ring's own axes turned by 90 degrees about z: its x is its parent's y.
  other = replaced(other, "axis = [0, 1, 0]",
                   "axis = [0, 1, 0], orientation = [0.70710678118654752, 0, 0, "
                   "0.70710678118654752]");
  const std::size_t inner = other.find("\"inner\"");
  other = other.substr(0, inner) +
          replaced(other.substr(inner), "[1e-3, 2e-3, 1.5e-3]", "[2e-3, 1e-3, 1.5e-3]");
  const auto end = [&](const std::string& text) {
    const std::string file = folder.write("s.toml", approximated("foeppl", text)).string();
    return answer(file).at("final").at("joints");
  };
  const json wanted = end(plain);
  const json found = end(other);
  for (const char* const ring : {"outer", "inner"}) {
    check_near(ring, found.at(ring).at("coordinate"), wanted.at(ring).at("coordinate"), 1e-14);
    check_near(ring, found.at(ring).at("rate"), wanted.at(ring).at("rate"), 1e-12);
  }
}

// Between two springs at 1.4 rad/s the rest is unstable. Each half turn multiplies the angles by
// 1.2313690, by the Floquet multipliers of docs/site/approximations.md. The rotor's first angle
// does not matter, except for the names of its axes.
BOOST_AUTO_TEST_CASE(fuchs_weigand_equations_report_their_error) {
  const Scratch folder;
  const std::string rings = "mass = 0\ninertia = [0, 0, 0]\nspring = { stiffness = 1 }\n";
  const double half_turn = std::acos(-1.0) / 1.4;
  std::ostringstream times;
  times.precision(17);
  times << "t_end = " << 90 * half_turn << "\noutput_times = [" << 89 * half_turn << ", "
        << 90 * half_turn << "]\ntolerance = 1e-10\n";
  std::vector<double> ends;
  for (const auto& [rotor, begin] :
       {std::pair("[1.1, 0.9, 0.5]", "0"), std::pair("[0.9, 1.1, 0.5]", "90")}) {
    const std::string bodies =
        gyro(rings, rotor +
                        std::string("\ndrive = \"constant-rate\"\ninitial = { rate = 1.4, "
                                    "angle_deg = ") +
                        begin + " }");
    const std::string text = replaced(bodies, "ANGLE", "1e-12") + "[solve]\n" + times.str() +
                             "model = \"fuchs-weigand\"\n";
    const std::string file = folder.write("scene.toml", text).string();
    const std::string table = (folder.path() / "out.csv").string();
    const json result = answer(file + " --csv " + table);
    BOOST_TEST(result.at("model") == "fuchs-weigand");
    // After growth by 1e8 the angles are still small against 1.
    BOOST_TEST(result.at("error_estimate").get<double>() < 1e-6);
    std::vector<double> angles;
    const auto rows = lines(folder.read("out.csv"));
    for (const std::size_t i : {1UL, 2UL}) {
      angles.push_back(std::stod(rows.at(i).substr(rows.at(i).find(',') + 1)));
    }
    check_near("growth", std::abs(angles.at(1) / angles.at(0)), 1.2313690, 2e-7);
    ends.push_back(angles.at(1));
  }
  check_near("begun a quarter of a turn later", ends.at(1), ends.at(0), 1e-9 * std::abs(ends[0]));
}

BOOST_AUTO_TEST_CASE(refuses_scenes_without_a_cardan_gyro) {
  const Scratch folder;
  const std::string rings = "mass = 1\ninertia = [1e-3, 2e-3, 1.5e-3]\n";
  const std::string free = "\nrotor = { mode = \"free\", speed = 50 }";
  const std::string plain = replaced(gyro(rings, "[3e-3, 3e-3, 5e-3]" + free), "ANGLE", "0.01");
  const std::string three = "[3e-3, 3e-3, 5e-3]";
  const std::string unbalanced = replaced(
      gyro(rings, "[3.001e-3, 3e-3, 5e-3]\ncentre = [1e-3, 0, 0]\ninitial = { rate = 50 }"),
      "ANGLE", "0.01");
  const std::tuple<std::string, const char*, const char*> cases[] = {
      {two_rods.substr(0, two_rods.find("[solve]")), "foeppl", "here are not three bodies"},
      {"[guide]\nkind = \"rotating\"\nangular_velocity = [0, 0, 1]\n" + plain, "foeppl",
       "is free, and this guide changes its speed"},
      {replaced(plain, "axis = [0, 1, 0]", "axis = [0, 1, 0.1]"), "foeppl", "not at right angles"},
      {replaced(plain, "axis = [0, 1, 0]", "axis = [0, 1, 0], position = [0.1, 0, 0]"), "foeppl",
       "body 'inner' has its joint elsewhere"},
      {unbalanced, "foeppl", "body 'rotor' is not balanced; 'fuchs-weigand' takes it"},
      {unbalanced, "fuchs-weigand", "is free, and unbalance changes its speed"},
      {replaced(plain, rings, rings + "hold = true\n"), "foeppl", "body 'outer' is locked"},
      {replaced(plain, rings, rings + "spring = { stiffness = 1, rest = 0.1 }\n"), "foeppl",
       "body 'outer' has a spring that is not slack at 0"},
      {replaced(plain, rings, rings + "force = 1\n"), "foeppl", "'outer' has a constant force"},
      {plain + "damping = 1\n", "foeppl", "is a rotor that spring or friction slows down"},
      {replaced(plain, "\"free\"", "\"torque\", torque = 1"), "foeppl", "that a torque speeds up"},
      {replaced(gyro(rings, "[3e-3, 4e-3, 5e-3]\ninitial = { rate = 50 }"), "ANGLE", "0"), "foeppl",
       "is not symmetric about its axis; 'fuchs-weigand' takes it"},
      {replaced(gyro(rings, three), "ANGLE", "0"), "fuchs-weigand", "the speed is 0"}};
  for (const auto& [text, model, reason] : cases) {
    const std::string file = folder.write("scene.toml", approximated(model, text)).string();
    const Outcome outcome = run(file);
    BOOST_TEST(outcome.status == 2, reason << ": " << outcome.err);
    BOOST_TEST(outcome.err.find(reason) != std::string::npos, outcome.err);
  }
}

BOOST_AUTO_TEST_CASE(refuses_unavailable_equations) {
  const Scratch folder;
  const std::string rods = two_rods.substr(0, two_rods.find("[solve]"));
  const std::string swinging =
      "[guide]\nkind = \"harmonic\"\nangular_velocity = { terms = [{ amplitude = [0, 0.1, 0], "
      "frequency = 1 }] }\n" +
      rods;
  const std::string sailing =
      "[guide]\nkind = \"course\"\nlatitude_deg = 50\nheading_deg = 0\nspeed = 10\n" +
      rods.substr(rods.find("[[body]]"));
  const std::tuple<std::string, const char*, const char*> cases[] = {
      {approximated("precession", rods), "", "there is no rotor"},
      {approximated("linear", swinging), "", "the guide swings"},
      {approximated("linear", sailing), "", "the guide moves over the earth"},
      {approximated("linear", rods), " --resume", "is computed as a whole"}};
  for (const auto& [text, option, reason] : cases) {
    const std::string file = folder.write("scene.toml", text).string();
    const Outcome outcome = run(file + option + " --csv " + (folder.path() / "out.csv").string());
    BOOST_TEST(outcome.status == 2, outcome.err);
    BOOST_TEST(outcome.err.find(reason) != std::string::npos, outcome.err);
    BOOST_TEST(folder.size() == 1U);
  }
}

BOOST_AUTO_TEST_CASE(writes_pictures) {
  const Scratch folder;
  const std::string pictures = (folder.path() / "pictures").string();
  const Outcome outcome =
      run(scene("cardan_gyro_springs") + " --t-end 0.5 --reactions --json --plot " + pictures);
  BOOST_TEST(outcome.status == 0, outcome.err);
  BOOST_TEST(test::parsed(outcome.out).contains("final"));
  BOOST_TEST(outcome.err.starts_with("wrote " + pictures + "/view.html\n"), outcome.err);
  for (const char* const name :
       {"coordinates", "rates", "reactions", "invariants", "error", "axis"}) {
    const std::string path = std::string("pictures/") + name;
    BOOST_TEST(outcome.err.find(path + ".svg and .png\n") != std::string::npos, outcome.err);
    BOOST_TEST(folder.read(path + ".svg").find("<svg") != std::string::npos, name);
    BOOST_TEST(folder.read(path + ".png").substr(1, 3) == "PNG", name);
  }
}

// The memory of a controller is part of the rows, and no part of the pictures.
BOOST_AUTO_TEST_CASE(draws_scenes_with_controllers) {
  const Scratch folder;
  const Outcome outcome = run(scene("speed_regulator") + " --t-end 0.05 --reactions --plot " +
                              (folder.path() / "out").string());
  BOOST_TEST(outcome.status == 0, outcome.err);
  BOOST_TEST(folder.read("out/reactions.svg").find("<svg") != std::string::npos);
}

// A page without further requests, with the rows of the CSV file in it, to nine digits.
BOOST_AUTO_TEST_CASE(shows_the_run_on_a_page) {
  const Scratch folder;
  const std::string title = "a </script> <!-- title";
  const auto file = folder.write("scene.toml", "title = \"" + title + "\"\n" + two_rods);
  const Outcome outcome =
      run(file.string() + " --terms --json --csv " + (folder.path() / "out.csv").string() +
          " --plot " + (folder.path() / "out").string());
  BOOST_REQUIRE_MESSAGE(outcome.status == 0, outcome.err);
  const std::string page = folder.read("out/view.html");
  for (const char* const foreign : {"http:", "https:", "src=", "href=", "import", "url("}) {
    BOOST_TEST(page.find(foreign) == std::string::npos, foreign);
  }
  const std::string opening = R"(<script type="application/json" id="run">)";
  const std::size_t begin = page.find(opening);
  BOOST_TEST_REQUIRE(begin != std::string::npos);
  const std::size_t length = page.find("</script>", begin) - begin - opening.size();
  const json shown = test::parsed(page.substr(begin + opening.size(), length));
  BOOST_TEST(shown.at("title") == title);
  BOOST_TEST(shown.at("up") == json({0, 0, 1}));
  BOOST_TEST(shown.at("bodies").at(1).at("parent") == 0);

  const auto rows = lines(folder.read("out.csv"));
  std::string columns = "t";
  for (std::size_t k = 1; k < shown.at("columns").size(); ++k) {
    columns += "," + shown.at("columns").at(k).get<std::string>();
  }
  BOOST_TEST(rows.at(0) == columns);
  BOOST_TEST_REQUIRE(shown.at("rows").size() == rows.size() - 1);
  for (const std::size_t i : {0UL, 57UL, 200UL}) {
    std::istringstream row(rows.at(i + 1));
    for (const json& x : shown.at("rows").at(i)) {
      std::string field;
      std::getline(row, field, ',');
      const double wanted = std::stod(field);
      check_near("row " + std::to_string(i), x, wanted, 5e-9 * std::abs(wanted));
    }
  }
  // Relative, guide and Coriolis part of both rods, to four digits; the guide is at rest.
  BOOST_TEST_REQUIRE(shown.at("terms").size() == rows.size() - 1);
  const json& parts = shown.at("terms").back();
  const json wanted = test::parsed(outcome.out).at("final").at("terms").at("lower");
  BOOST_TEST_REQUIRE(parts.size() == 36U);
  for (std::size_t k = 0; k < 3; ++k) {
    const double force = wanted.at("relative").at("force").at(k);
    check_near("relative force", parts.at(18 + k), force, 5e-4 * std::abs(force));
    BOOST_TEST(parts.at(24 + k) == 0);
  }
}

// For any number of rows of the run.
BOOST_AUTO_TEST_CASE(keeps_the_page_small) {
  const Scratch folder;
  std::string fine = two_rods;
  fine.replace(fine.find("output_step = 0.01"), 18, "output_step = 1e-4");
  const auto file = folder.write("scene.toml", fine);
  const Outcome outcome = run(file.string() + " --plot " + (folder.path() / "out").string());
  BOOST_TEST(outcome.status == 0, outcome.err);
  const std::size_t size = folder.read("out/view.html").size();
  BOOST_TEST(size > 50000U);
  BOOST_TEST(size < 250000U);
}

BOOST_AUTO_TEST_SUITE_END()
