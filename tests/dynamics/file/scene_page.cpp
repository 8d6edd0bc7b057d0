// Sentences of docs/scene_files.md that tests/dynamics/file/scene_file.cpp does not test.

#include <boost/test/unit_test.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <dynamics/file/scene_system.hpp>
#include <dynamics/guide/chain.hpp>
#include <dynamics/guide/harmonic.hpp>
#include <dynamics/guide/rotating.hpp>
#include <dynamics/tree/body_system.hpp>

#include <support/json.hpp>
#include <support/program.hpp>
#include <support/scene_text.hpp>

using namespace kreisel;
using test::mistakes;
using test::scene;

namespace {

constexpr double degree = 0.017453292519943295;

const std::string hinge = "joint = { kind = \"revolute\", axis = [0, 1, 0] }\n";
const std::string universal =
    "joint = { kind = \"universal\", axis = [0, 1, 0], second_axis = [1, 0, 0] }\n";
const std::string ball = "joint = { kind = \"spherical\" }\n";
const std::string floating = "joint = { kind = \"free\" }\n";
const std::string weight = "[gravity]\nkind = \"uniform\"\nvector = [0, 0, -9.81]\n";

/// One body, with its keys before all tables, then further tables.
std::string one(const std::string& keys, const std::string& rest = "") {
  const bool has_inertia = keys.find("inertia") != std::string::npos;
  return "[[body]]\nname = \"a\"\nmass = 2\n" +
         std::string(has_inertia ? "" : "inertia = [0.2, 0.25, 0.3]\n") + keys + "\n" + rest +
         "[solve]\nt_end = 1\noutput_times = [1]\n";
}

test::Outcome simulate(const std::string& text, const std::string& options = "") {
  const test::Scratch folder;
  return test::run(std::string(KREISEL_SIMULATE) + " " + folder.write("s.toml", text).string() +
                   " " + options);
}

/// The method chosen by simulate.
std::string method(const std::string& text) {
  const test::Outcome outcome = simulate(text, "--json");
  BOOST_TEST_REQUIRE(outcome.status == 0, text << outcome.err);
  return test::parsed(outcome.out).at("method").get<std::string>();
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// The guide of a scene with a log that runs to 1 s.
SceneFile beside(const std::string& log, const std::string& guide) {
  const test::Scratch folder;
  (void)folder.write("log.csv", log);
  return parse_scene(one(hinge, "[guide]\nfile = \"log.csv\"\n" + guide), folder.path() / "s.toml");
}

/// A line of a log, its fields joined by the separator.
std::string row(const std::vector<std::string>& fields, const std::string& separator) {
  std::string text;
  for (const std::string& field : fields) text += (text.empty() ? "" : separator) + field;
  return text + "\n";
}

/// The blocks of the page that begin with ```text.
std::vector<std::string> texts_of_the_page() {
  std::ifstream file(KREISEL_PAGE);
  const std::string page{std::istreambuf_iterator<char>(file), {}};
  const std::string open = "```text\n";
  std::vector<std::string> blocks;
  for (std::size_t at = page.find(open); at != std::string::npos; at = page.find(open, at)) {
    at += open.size();
    blocks.push_back(page.substr(at, page.find("```", at) - at));
  }
  return blocks;
}

/// A system at rest, in motion or rotated, with the values of a scene at t = 0.
class AtStart {
 public:
  explicit AtStart(const std::string& text)
      : file_(scene(text)),
        in_gravity_(bodies_in_gravity(file_)),
        system_(make_guide(file_), in_gravity_.bodies, in_gravity_.gravity),
        state_(system_.rest()),
        workspace_(system_.workspace()) {
    Eigen::Index q = 0;
    Eigen::Index v = 0;
    for (const JointStart& joint : file_.start) {
      for (const double x : joint.coordinates) state_.coordinates[q++] = x;
      for (const double x : joint.rates) state_.rates[v++] = x;
    }
  }

  [[nodiscard]] Pose<> pose(int body) {
    return system_.situation(0, system_.to_vector(state_), body, workspace_).X.value;
  }
  [[nodiscard]] Eigen::VectorXd accelerations() {
    Eigen::VectorXd result;
    system_.accelerations(0, system_.to_vector(state_), {}, result, workspace_);
    return result;
  }

 private:
  SceneFile file_;
  SceneBodies in_gravity_;
  BodySystem<SceneGuide> system_;
  decltype(std::declval<BodySystem<SceneGuide>>().rest()) state_;
  BodyWorkspace workspace_;
};

}  // namespace

BOOST_AUTO_TEST_SUITE(page_on_scene_files)

// The table of units. Their sizes are in tests/dynamics/file/unit.cpp.
BOOST_AUTO_TEST_CASE(every_unit_of_the_page_is_read) {
  std::ifstream file(KREISEL_PAGE);
  std::string row;
  while (std::getline(file, row) && row != "| quantity | units |") continue;
  std::getline(file, row);
  int count = 0;
  while (std::getline(file, row) && !row.empty()) {
    std::istringstream units(row.substr(row.find('|', 1) + 1));
    for (std::string unit; units >> unit;) {
      if (unit == "|" || unit.front() == '(') continue;
      if (unit.back() == ',') unit.pop_back();
      const std::string found = mistakes(one(hinge + "centre = [0, 0, \"1 " + unit + "\"]"));
      BOOST_TEST(!contains(found, "unknown unit"), unit);
      ++count;
    }
  }
  BOOST_TEST(count == 41);
}

// "A key of an angle or of an angular rate may end in _deg instead".
BOOST_AUTO_TEST_CASE(angles_and_their_rates_in_degrees) {
  const auto start = [](const std::string& keys) { return scene(one(keys)).start.at(0); };
  BOOST_TEST(start(hinge + "initial = { angle_deg = 30, rate_deg = 60 }").coordinates.at(0) ==
             30 * degree);
  BOOST_TEST(start(hinge + "initial = { rate_deg = 60 }").rates.at(0) == 60 * degree);
  const JointStart two = start(universal + "initial = { angle_deg = [3, 4], rate_deg = [5, 6] }");
  BOOST_TEST(two.coordinates == std::vector<double>({3 * degree, 4 * degree}));
  BOOST_TEST(two.rates == std::vector<double>({5 * degree, 6 * degree}));
  const JointStart radian = start(universal + "initial = { angle = [3, 4], rate = [5, 6] }");
  BOOST_TEST(radian.coordinates == std::vector<double>({3, 4}));
  BOOST_TEST(radian.rates == std::vector<double>({5, 6}));
  BOOST_TEST(start(ball + "initial = { angular_velocity_deg = [1, 2, 3] }").rates.at(2) ==
             3 * degree);
  BOOST_TEST(scene(one(hinge + "spring = { stiffness = 1, rest_deg = 9 }"))
                 .bodies.at(0)
                 .forces.at(0)
                 .rest == 9 * degree);
  const std::string disc =
      "inertia = [1, 1, 2]\njoint = { kind = \"revolute\", axis = [0, 0, 1] }\n";
  BOOST_TEST(start(disc + "rotor = { mode = \"free\", speed_deg = 90 }").rates.at(0) ==
             90 * degree);
  const auto guide = [](const std::string& keys) {
    return scene(one(hinge, "[guide]\n" + keys)).guide.front();
  };
  const auto turning = std::get<scene_guide::Rotating>(
      guide("kind = \"rotating\"\nangular_velocity_deg = [1, 2, 3]\n"));
  BOOST_TEST(turning.angular_velocity.z() == 3 * degree);
  const auto swinging = std::get<scene_guide::Harmonic>(
      guide("kind = \"harmonic\"\nangular_velocity_deg = { constant = [1, 0, 0], terms = [ { "
            "amplitude = [0, 2, 0], frequency_deg = 40, phase_deg = 50 } ] }\n"));
  BOOST_TEST(swinging.angular_velocity.constant.x() == degree);
  const auto& term = swinging.angular_velocity.terms.at(0);
  BOOST_TEST(term.amplitude.y() == 2 * degree);
  BOOST_TEST(term.frequency == 40 * degree);
  BOOST_TEST(term.phase == 50 * degree);
  const auto earth = std::get<scene_guide::Earth>(
      guide("kind = \"earth\"\nlatitude_deg = 5\nheight = 0\nazimuth_deg = 0\nrate_deg = 0.004\n"));
  BOOST_TEST(earth.site.rotation_rate == 0.004 * degree);
  BOOST_TEST(contains(mistakes(one(hinge,
                                   "[guide]\nkind = \"rotating\"\nangular_velocity = [1, 0, "
                                   "0]\nangular_velocity_deg = [1, 0, 0]\n")),
                      "is given in radian too"));
}

// The start of rotating and harmonic: relative to the previous frame, on its axes.
BOOST_AUTO_TEST_CASE(guides_start_as_stated) {
  const std::string begin =
      "attitude = [0.6, 0.8, 0, 0]\norigin_position = [1, 2, 3]\norigin_velocity = [4, 5, 6]\n";
  const Displacement<Inertial, Guide> X{
      Pose<>::from(Eigen::Quaterniond(0.6, 0.8, 0, 0), {1, 2, 3})};
  const Vector3<double> v(4, 5, 6);
  const auto check = [](const std::string& keys, const auto& wanted) {
    const SceneGuide guide = make_guide(scene(one(hinge, "[guide]\n" + keys)));
    for (const double t : {0.0, 0.4, 1.0}) {
      const auto a = guide(t);
      const auto b = wanted(t);
      BOOST_TEST((a.X.value.rotation - b.X.value.rotation).norm() == 0);
      BOOST_TEST((a.X.value.translation - b.X.value.translation).norm() == 0);
      BOOST_TEST((a.V.value.moment - b.V.value.moment).norm() == 0);
    }
  };
  check("kind = \"rotating\"\nangular_velocity = [0, 0, 2]\n" + begin,
        RotatingFrame<>{{0, 0, 2}, {0, 0, 0}, X, v});
  check(
      "kind = \"harmonic\"\norigin_acceleration = { terms = [ { amplitude = [1, 0, 0], frequency "
      "= 3 } ] }\n" +
          begin,
      HarmonicFrame<>({}, {{0, 0, 0}, {{{1, 0, 0}, 3, 0}}}, 0, 1 + 1e-12, X, v));
  BOOST_TEST(contains(mistakes(one(hinge,
                                   "[guide]\nkind = \"inertial\"\norigin_velocity = [1, 0, "
                                   "0]\n")),
                      "origin_velocity: is no key here"));
}

// The same in a chain.
BOOST_AUTO_TEST_CASE(links_start_on_the_link_before) {
  struct Ship;
  const SceneGuide guide = make_guide(scene(one(hinge, R"([guide]
kind = "chain"
[[guide.links]]
kind = "rotating"
angular_velocity = [0, 0, 1]
attitude = [0.6, 0, 0.8, 0]
[[guide.links]]
kind = "rotating"
angular_velocity = [2, 0, 0]
attitude = [0.6, 0.8, 0, 0]
origin_position = [1, 2, 3]
origin_velocity = [4, 5, 6]
)")));
  const Displacement<Inertial, Ship> first{
      Pose<>::from(Eigen::Quaterniond(0.6, 0, 0.8, 0), {0, 0, 0})};
  const Displacement<Ship, Guide> second{
      Pose<>::from(Eigen::Quaterniond(0.6, 0.8, 0, 0), {1, 2, 3})};
  const Chain wanted(RotatingFrame<Ship, Inertial>{{0, 0, 1}, {0, 0, 0}, first},
                     RotatingFrame<Guide, Ship>{{2, 0, 0}, {0, 0, 0}, second, {4, 5, 6}});
  for (const double t : {0.0, 0.4, 1.0}) {
    const FrameMotion<Guide, Inertial> a = guide(t);
    const FrameMotion<Guide, Inertial> b = wanted(t);
    BOOST_TEST((a.X.value.rotation - b.X.value.rotation).norm() == 0);
    BOOST_TEST((a.X.value.translation - b.X.value.translation).norm() == 0);
    BOOST_TEST((a.V.value.moment - b.V.value.moment).norm() == 0);
  }
}

// "A heave given as acceleration a sin(w t) needs origin_velocity = -a/w": 0.6/0.49 up and down for
// an hour. Without it: 3 km.
BOOST_AUTO_TEST_CASE(heave_with_its_velocity_does_not_drift) {
  const auto greatest = [](const std::string& velocity) {
    SceneFile file =
        scene(one(hinge,
                  "[guide]\nkind = \"harmonic\"\norigin_acceleration = { terms = [ { amplitude = "
                  "[-0.6, 0, 0], frequency = 0.7 } ] }\n" +
                      velocity));
    file.t_end = 3600;
    const SceneGuide guide = make_guide(file);
    double most = 0;
    for (int k = 0; k <= 7200; ++k) {
      most = std::max(most, guide(0.5 * k).X.value.translation.norm());
    }
    return most;
  };
  const double heave = 0.6 / 0.49;
  const double held = greatest("origin_velocity = [" + std::to_string(0.6 / 0.7) + ", 0, 0]\n");
  // The velocity has six decimals: half of the last one causes 2 mm in an hour.
  BOOST_TEST(std::abs(held - heave) <= 2e-3);
  BOOST_TEST(greatest("") > 3000);
}

// Logs: the attitude from guide to inertial axes, the position on inertial axes.
BOOST_AUTO_TEST_CASE(logs_give_the_guide_on_inertial_axes) {
  std::string log = "t,qw,qx,qy,qz,x,y,z\n";
  for (int i = 0; i <= 20; ++i) {
    log += row({std::to_string(0.1 * i), "0.6", "0", "0", "0.8", std::to_string(0.1 * i), "2", "3"},
               ",");
  }
  const Pose<> X = make_guide(beside(log, "kind = \"table\"\n"))(0.55).X.value;
  BOOST_TEST((X.rotation - Eigen::Quaterniond(0.6, 0, 0, 0.8).toRotationMatrix()).norm() <= 1e-14);
  BOOST_TEST((X.translation - Vector3<double>(0.55, 2, 3)).norm() <= 1e-14);
}

// Rates start at the log's first time, or at the first one in window: 1 rad/s from -1 s on.
BOOST_AUTO_TEST_CASE(rates_start_with_the_window) {
  std::string log = "t,wx,wy,wz\n";
  for (int i = -10; i <= 20; ++i) log += row({std::to_string(0.1 * i), "0", "0", "1"}, ",");
  const auto angle = [&log](const std::string& keys) {
    const auto R = make_guide(beside(log, "kind = \"rates\"\n" + keys))(0.5).X.value.rotation;
    return std::atan2(R(1, 0), R(0, 0));
  };
  BOOST_TEST(std::abs(angle("") - 1.5) <= 1e-12);
  BOOST_TEST(std::abs(angle("window = [0, 2]\n") - 0.5) <= 1e-12);
  BOOST_TEST(std::abs(angle("window = [0, 2]\nattitude = [0.8, 0, 0, 0.6]\n") - 0.5 -
                      2 * std::atan2(0.6, 0.8)) <= 1e-12);
}

// `sigma` is [a, b]: of the attitude's quaternion and of the position. With 0 there is no
// smoothing, and the motion passes through its rows.
BOOST_AUTO_TEST_CASE(sigma_is_for_attitude_and_position) {
  std::string log = "t,yaw,pitch,roll,x,y,z\n";
  for (int i = 0; i <= 100; ++i) {
    const std::string noise = i % 2 == 0 ? "0.01" : "-0.01";
    log += row({std::to_string(0.01 * i), noise, "0", "0", noise, "0", "0"}, ",");
  }
  const auto goes_through = [&log](const std::string& sigma) {
    const Pose<> X =
        make_guide(beside(log, "kind = \"table\"\nsigma = " + sigma + "\n"))(0.5).X.value;
    return std::pair(std::abs(X.rotation(1, 0) - std::sin(0.01)) < 1e-9,
                     std::abs(X.translation.x() - 0.01) < 1e-9);
  };
  BOOST_TEST((goes_through("0") == std::pair(true, true)));
  BOOST_TEST((goes_through("0.01") == std::pair(false, false)));
  BOOST_TEST((goes_through("[0.01, 0]") == std::pair(false, true)));
  BOOST_TEST((goes_through("[0, 0.01]") == std::pair(true, false)));
}

// Times of more than 15 digits are given as a text, and window is in seconds after time_zero.
BOOST_AUTO_TEST_CASE(time_zero_keeps_nanoseconds_as_a_text) {
  std::string log = "t,qw,qx,qy,qz\n";
  for (int i = 0; i <= 30; ++i) {
    const std::string t = std::to_string(63 + i / 10) + "." + std::to_string(i % 10);
    log += row({"13118681" + t + "69712345", "1", "0", "0", "0"}, ",");
  }
  const auto times = [&log](const std::string& keys) {
    const SceneFile file = beside(log, "kind = \"table\"\n" + keys);
    return std::get<scene_guide::Table>(file.guide.front()).log.times;
  };
  const auto exact = times("time_zero = \"1311868163.069712345\"\n");
  BOOST_TEST(exact.at(0) == 0);
  BOOST_TEST(exact.at(3) == 0.3);
  const auto part = times("time_zero = \"1311868164.069712345\"\nwindow = [-0.5, 1.2]\n");
  BOOST_TEST(part.front() == -0.5);
  BOOST_TEST(part.back() == 1.2);
}

// The examples at the end of "Logs", each with a log as its comment describes.
BOOST_AUTO_TEST_CASE(logs_are_read_as_the_page_shows) {
  std::map<std::string, std::string> logs{
      {"state_groundtruth_estimate0.csv",
       "#timestamp, p_RS_R_x [m], p_RS_R_y [m], p_RS_R_z [m], q_RS_w [], q_RS_x [], q_RS_y [], "
       "q_RS_z []\n"},
      {"groundtruth.txt", "# ground truth\n# timestamp tx ty tz qx qy qz qw\n"},
      {"TStick_Test02_Trial1.csv", "Time;Vicon;;;\ns;W;X;Y;Z\n"},
      {"turntable.csv", row(std::vector<std::string>(12, "preamble"), "\n") +
                            "Zeit;Gier;Nick;Roll\ns;deg;deg;deg\n"}};
  for (int i = 0; i <= 20; ++i) {
    const std::string tenths = std::to_string(i / 10) + "." + std::to_string(i % 10);
    logs["state_groundtruth_estimate0.csv"] += row(
        {std::to_string(1403636579763555584 + 100'000'000L * i), "1", "2", "3", "0", "1", "0", "0"},
        ",");
    const std::string stamp = std::to_string(13118681638697L + 1000L * i).insert(10, ".");
    logs["groundtruth.txt"] += row({stamp, "1", "2", "3", "1", "0", "0", "0"}, " ");
    if (i == 5) logs["groundtruth.txt"] += row({stamp, "1", "2", "3", "1", "0", "0", "0"}, " ");
    logs["TStick_Test02_Trial1.csv"] += row({tenths, "0", "1", "0", "0"}, ";");
    logs["turntable.csv"] +=
        row({std::to_string(i / 10) + "," + std::to_string(i % 10), "0,0", "0,0", "180,0"}, ";");
  }
  const auto blocks = texts_of_the_page();
  BOOST_TEST(blocks.size() == logs.size());
  for (const std::string& block : blocks) {
    const test::Scratch folder;
    for (const auto& [name, text] : logs) (void)folder.write(name, text);
    const SceneFile file = parse_scene(block + one(hinge), folder.path() / "s.toml");
    const auto& log = std::get<scene_guide::Table>(file.guide.front()).log;
    BOOST_TEST(log.times.size() == 21U, block);
    BOOST_TEST(log.times.front() == 0, block);
    BOOST_TEST(std::abs(log.times.back() - 2) <= 1e-9, block);
    BOOST_TEST(std::abs(log.attitudes.back().x()) == 1, block);
  }
}

// At zero coordinates all axes are parallel to those of the guide, unless a joint rotates them.
// Position and axes are on the parent's axes; orientation rotates the body's axes.
BOOST_AUTO_TEST_CASE(bodies_are_placed_on_their_parent) {
  const std::string child =
      "[[body]]\nname = \"b\"\nparent = \"a\"\nmass = 1\ninertia = [1, 1, 1]\n";
  for (const std::string& joint :
       {std::string("joint = { kind = \"fixed\" }\n"), hinge, universal, ball, floating,
        std::string("joint = { kind = \"prismatic\", axis = [0, 1, 0] }\n")}) {
    AtStart rest(one(joint, child + joint));
    BOOST_TEST((rest.pose(1).rotation - Matrix3<double>::Identity()).norm() == 0, joint);
  }
  // A quarter turn about z, then one about the new x: the child's joint is along the rotated x.
  const std::string quarter = "0.70710678118654757";
  AtStart turned(
      one("joint = { kind = \"fixed\", orientation = [" + quarter + ", 0, 0, " + quarter + "] }\n",
          child +
              "joint = { kind = \"revolute\", axis = [0, 0, 1], position = [2, 0, 0], "
              "orientation = [" +
              quarter + ", " + quarter + ", 0, 0] }\n"));
  const Pose<> X = turned.pose(1);
  BOOST_TEST((X.translation - Vector3<double>(0, 2, 0)).norm() <= 1e-15);
  Matrix3<double> wanted;
  wanted << 0, 0, 1, 1, 0, 0, 0, 1, 0;
  BOOST_TEST((X.rotation - wanted).norm() <= 1e-15);
}

// Joint forces -stiffness (q - rest), -damping q' and a constant one; loads have their torque about
// the body's origin. The moment of inertia about the joint is 0.25.
BOOST_AUTO_TEST_CASE(joint_forces_follow_the_formulas) {
  const std::pair<std::string, double> cases[] = {
      {"spring = { stiffness = 3, rest = 0.5 }\ninitial = { angle = 0.7 }", -3 * 0.2},
      {"damping = 2\ninitial = { rate = 0.3 }", -2 * 0.3},
      {"force = 1.5", 1.5},
      {"load = { torque = [7, 1.5, 7] }", 1.5},
      {"load = { force = [0, 0, 2], point = [3, 0, 0] }", -6},
      {"load = [ { torque = [0, 1, 0] }, { torque = [0, 2, 0], axes = \"guide\" } ]", 3}};
  for (const auto& [keys, torque] : cases) {
    AtStart start(one(hinge + keys));
    BOOST_TEST(std::abs(start.accelerations()[0] - torque / 0.25) <= 1e-13, keys);
  }
}

// Each kind of joint, guide and load has the keys in its row, and no others.
BOOST_AUTO_TEST_CASE(keys_of_another_kind_are_refused) {
  const std::string site = "[guide]\nkind = \"earth\"\nheight = 0\n";
  const std::string fixed = "joint = { kind = \"fixed\" }\n";
  const std::string slide = "joint = { kind = \"prismatic\", axis = [0, 1, 0] }\n";
  const std::pair<std::string, std::string> cases[] = {
      {one(hinge, site + "latitude = 5\nazimuth_deg = 0\n"), "guide.latitude: is no key here"},
      {one(hinge, site + "latitude_deg = 5\nazimuth = 0\n"), "guide.azimuth: is no key here"},
      {one(hinge, site + "latitude_deg = 5\nazimuth_deg = 0\ngravity = \"wgs84\"\n"),
       "guide.gravity: 'wgs84' is none of 'normal' or 'none'"},
      {one(hinge,
           "[guide]\nkind = \"chain\"\nlinks = [ { kind = \"inertial\" }, { kind = \"rates\", file "
           "= \"none.csv\" } ]\n"),
       "'rates' must be the first link"},
      {one(hinge, "[gravity]\nkind = \"none\"\nvector = [0, 0, 1]\n"), "gravity.vector: is no key"},
      {one(hinge, "[gravity]\nkind = \"uniform\"\n"), "gravity.vector: is missing"},
      {one("joint = { kind = \"spherical\", axis = [0, 0, 1] }"), "joint.axis: is no key here"},
      {one("joint = { kind = \"revolute\", axis = [0, 0, 1], second_axis = [1, 0, 0] }"),
       "joint.second_axis: is no key here"},
      {one(fixed + "initial = { angle = 1 }"), "initial.angle: is no key here"},
      {one(hinge + "initial = { attitude = [1, 0, 0, 0] }"), "initial.attitude: is no key here"},
      {one(slide + "initial = { angle = 1 }"), "initial.angle: is no key here"},
      {one(slide + "initial = { rate_deg = 1 }"), "initial.rate_deg: is no key here"},
      {one(universal + "initial = { angle = 1 }"), "initial.angle: must be a list of numbers"},
      {one(ball + "initial = { velocity = [1, 0, 0] }"), "initial.velocity: is no key here"},
      {one(floating + "initial = { rate = 1 }"), "initial.rate: is no key here"},
      {one(fixed + "damping = 1"), "damping: has no single coordinate"},
      {one(hinge + "load = { force = [1, 0, 0], axes = \"parent\" }"),
       "'parent' is none of 'body', 'guide' or 'inertial'"},
      {one(hinge + "drive = \"constant\""), "drive: 'constant' is none of"},
      {one(hinge, "[report]\nreaction = true\n"), "report.reaction: is no key here"}};
  for (const auto& [text, reason] : cases) {
    const std::string found = mistakes(text);
    BOOST_TEST(contains(found, reason), "wanted " << reason << "\nfound " << found);
  }
}

// For several coordinates one number or a list; a ball joint has damping alone.
BOOST_AUTO_TEST_CASE(two_coordinates_take_a_number_for_both) {
  const auto forces = [](const std::string& keys) {
    return scene(one(universal + keys)).bodies.at(0).forces;
  };
  for (const std::string both :
       {"damping = 0.1\nforce = 3\nspring = { stiffness = 5, rest_deg = 6 }",
        "damping = [0.1, 0.1]\nforce = [3, 3]\nspring = { stiffness = [5, 5], rest_deg = [6, 6] "
        "}"}) {
    for (const JointForce& force : forces(both)) {
      BOOST_TEST(force.damping == 0.1);
      BOOST_TEST(force.constant == 3);
      BOOST_TEST(force.stiffness == 5);
      BOOST_TEST(force.rest == 6 * degree);
    }
  }
  BOOST_TEST(forces("damping = [0.1, 0.2]").at(1).damping == 0.2);
  BOOST_TEST(
      contains(mistakes(one(universal + "damping = [1, 2, 3]")), "must be 2 numbers, not 3"));
  BOOST_TEST(contains(mistakes(one(universal + "damping = true")), "must be a number, not true"));
  const auto of_ball = scene(one(ball + "damping = 0.3")).bodies.at(0).forces;
  BOOST_TEST(of_ball.size() == 3U);
  BOOST_TEST(of_ball.at(2).damping == 0.3);
  BOOST_TEST(contains(mistakes(one(ball + "force = 1")), "needs a single coordinate"));
  BOOST_TEST(contains(mistakes(one(ball + "damping = [1, 1, 1]")), "must be a number"));
}

// The rows of cylindrical, planar and screw joints: coordinates and rates in the order of their
// row, springs for each, `rest` without _deg, `pitch` in metres per RADIAN.
BOOST_AUTO_TEST_CASE(joints_of_several_units_take_their_row) {
  const std::string axis = "axis = [0, 0, 1] }\n";
  const auto start = [](const std::string& keys) { return scene(one(keys)).start.at(0); };
  const std::string cylinder = "joint = { kind = \"cylindrical\", " + axis;
  const JointStart turned =
      start(cylinder + "initial = { angle_deg = 30, displacement = 2, rate = 3, velocity = 4 }");
  BOOST_TEST(turned.coordinates == std::vector<double>({30 * degree, 2}));
  BOOST_TEST(turned.rates == std::vector<double>({3, 4}));
  const std::string plane = "joint = { kind = \"planar\", " + axis;
  const JointStart puck =
      start(plane + "initial = { displacement = [1, 2], angle = 3, velocity = [4, 5], rate = 6 }");
  BOOST_TEST(puck.coordinates == std::vector<double>({1, 2, 3}));
  BOOST_TEST(puck.rates == std::vector<double>({4, 5, 6}));
  const auto forces = scene(one(plane + "damping = 7\nspring = { stiffness = [1, 2, 3], "
                                        "rest = [4, 5, 6] }"))
                          .bodies.at(0)
                          .forces;
  BOOST_TEST_REQUIRE(forces.size() == 3U);
  BOOST_TEST(forces[2].stiffness == 3);
  BOOST_TEST(forces[1].rest == 5);
  BOOST_TEST(forces[2].damping == 7);
  BOOST_TEST(contains(mistakes(one(plane + "spring = { stiffness = 1, rest_deg = 2 }")),
                      "spring.rest_deg: is no key here"));
  const std::string thread = "joint = { kind = \"screw\", pitch = 0.5, " + axis;
  BOOST_TEST(scene(one(thread)).bodies.at(0).joint.pitch == 0.5);
  AtStart screw(one(thread + "initial = { angle = 2 }"));
  BOOST_TEST((screw.pose(0).translation - Vector3<double>(0, 0, 1)).norm() == 0);
  BOOST_TEST(contains(mistakes(one(thread + "initial = { displacement = 1 }")),
                      "initial.displacement: is no key here"));
}

// Impossible numbers: those of a catalogue, rounded in the last digit.
BOOST_AUTO_TEST_CASE(rounded_inertia_gets_the_nearest_legal) {
  const std::string told = mistakes(one("inertia = [0.0795775, 0.0795775, 0.1591551]\n" + hinge));
  const std::size_t begin = told.find("nearest legal tensor: [");
  BOOST_TEST_REQUIRE(begin != std::string::npos, told);
  BOOST_TEST(mistakes(one("inertia = " + told.substr(begin + 22) + "\n" + hinge)) == "none");
  BOOST_TEST(!contains(mistakes(one("inertia = [1, 1, 2.1]\n" + hinge)), "nearest"));
}

BOOST_AUTO_TEST_CASE(defaults_agree_with_the_page) {
  const SceneFile file = scene("[[body]]\nname = \"a\"\nmass = 1\ninertia = [1, 1, 1]\n" + hinge +
                               "[solve]\nt_end = 5\n");
  BOOST_TEST(file.output_times.size() == 501U);
  BOOST_TEST(file.output_times.at(1) == 0.01);
  BOOST_TEST(file.tolerance == 1e-10);
  BOOST_TEST((file.method == Method::automatic));
  BOOST_TEST((file.model == SceneModel::exact));
  BOOST_TEST(!file.reactions);
  BOOST_TEST(!file.element_forces);
  BOOST_TEST(!file.terms);
  BOOST_TEST(file.bodies.at(0).parent == "guide");
  BOOST_TEST(file.start.at(0).coordinates.at(0) == 0);
  std::ptrdiff_t scenes = 0;
  for (const auto& entry : std::filesystem::directory_iterator(KREISEL_SCENES)) {
    scenes += entry.path().extension() == ".toml" ? 1 : 0;
  }
  BOOST_TEST(scenes == 48);
}

// A scene that is only a pendulum or a top uses its closed form with method auto.
BOOST_AUTO_TEST_CASE(closed_forms_are_used_if_they_exist) {
  const std::string off = "centre = [0, 0, -0.4]\n";
  const std::string swung = "initial = { angle = 0.3 }\n";
  const std::string spun = "initial = { angular_velocity = [1, 2, 3] }\n";
  const std::string sym = "inertia = [0.2, 0.2, 0.3]\n";
  const std::pair<std::string, bool> cases[] = {
      {one(hinge + off + swung, weight), true},
      {one(floating + spun, weight), true},
      {one(ball + spun, weight), true},
      {one(ball + spun), true},
      {one(sym + ball + off + spun, weight), true},
      {one(ball + off + spun, weight), false},                                 // not symmetric
      {one(floating + off + spun, weight), false},                             // centre elsewhere
      {one("inertia = [0.2, 0.25, 0.3, 0.01, 0, 0]\n" + ball + spun), false},  // other axes
      {one(hinge + off + "damping = 0.1\n" + swung, weight), false},
      {one(hinge + off + swung, weight + "[guide]\nkind = \"rotating\"\nangular_velocity = [0, 0, "
                                         "1]\n"),
       false},
  };
  for (const auto& [text, has_one] : cases) {
    const std::string found = method(text);
    const bool is_series = found == "taylor" || found == "verner98" || found == "radau13";
    BOOST_TEST(is_series == !has_one, found << " for\n" << text);
  }
}

// A year costs as much as a second, with an error of 1.3e-8 after a year of swings of 3.4 s.
BOOST_AUTO_TEST_CASE(closed_forms_cost_the_same_for_a_year) {
  const auto run = [](const std::string& t_end) {
    const test::Outcome outcome =
        simulate("[[body]]\nname = \"a\"\nmass = 1\ncentre = [0, 0, -0.4]\ninertia = [1, 1, 1]\n" +
                     hinge + "initial = { angle = 0.3 }\n" + weight + "[solve]\nt_end = " + t_end +
                     "\noutput_times = [" + t_end + "]\ntolerance = 1e-6\n",
                 "--json");
    BOOST_TEST_REQUIRE(outcome.status == 0, outcome.err);
    return test::parsed(outcome.out);
  };
  const test::Json year = run("3.15576e7");
  BOOST_TEST(year.at("all_evaluations").get<long>() <=
             2 * run("1.0").at("all_evaluations").get<long>());
  BOOST_TEST(std::abs(year.at("error_estimate").get<double>() - 1.3e-8) < 3e-9);
}

// No step has to resolve a rotor's angle.
BOOST_AUTO_TEST_CASE(fast_rotors_need_no_more_steps) {
  const auto steps = [](const std::string& speed) {
    const test::Outcome outcome =
        simulate(one(hinge + "centre = [0, 0, -0.4]\ninitial = { angle = 0.3 }",
                     "[[body]]\nname = \"b\"\nparent = \"a\"\nmass = 1\ninertia = [1, 1, 2]\n"
                     "joint = { kind = \"revolute\", axis = [0, 0, 1] }\nrotor = { mode = "
                     "\"free\", speed = " +
                         speed + " }\n" + weight),
                 "--json");
    BOOST_TEST_REQUIRE(outcome.status == 0, outcome.err);
    return test::parsed(outcome.out).at("steps").get<long>();
  };
  BOOST_TEST(steps("1e6") <= steps("1") + 1);
}

BOOST_AUTO_TEST_CASE(methods_have_the_names_of_the_page) {
  const std::pair<std::string, Method> methods[] = {
      {"auto", Method::automatic},     {"closed form", Method::closed_form},
      {"taylor", Method::taylor},      {"verner98", Method::verner98},
      {"gauss16", Method::gauss16},    {"radau13", Method::radau13},
      {"splitting", Method::splitting}};
  for (const auto& [name, method] : methods) BOOST_TEST((method_named(name) == method), name);
  BOOST_TEST(!method_named("euler"));
}

// All other scenes use the Taylor series of their motion, with the exceptions of the page.
BOOST_AUTO_TEST_CASE(series_are_used_if_they_are_known) {
  const std::string swung = hinge + "centre = [0, 0, -0.4]\ndamping = 0.1\n";
  const std::string turning = "[guide]\nkind = \"rotating\"\nangular_velocity = [0, 0, 1]\n";
  const std::string second =
      "[[body]]\nname = \"b\"\nparent = \"a\"\nmass = 1\ninertia = [1, 1, 1]\n";
  BOOST_TEST(method(one(swung, weight)) == "taylor");
  BOOST_TEST(method(one(swung, weight + turning)) == "taylor");
  BOOST_TEST(method(one(swung, second + hinge + weight)) == "taylor");
  for (const std::string load :
       {"torque = [0, 1, 0]", "force = { terms = [{ amplitude = [1, 0, 0], frequency = 3 }] }",
        "torque = [0, 1, 0], axes = \"inertial\"", "kind = \"drag\", linear = [1, 1, 1]"}) {
    const std::string loaded = swung + "inertia = [1, 1, 1]\nload = { " + load + " }\n";
    BOOST_TEST(method(one(loaded, weight)) == "taylor", load);
  }
  const std::string drag = "inertia = [1, 1, 1]\nload = { kind = \"drag\", ";
  BOOST_TEST(method(one(swung + drag + "quadratic = [1, 1, 1] }\n", weight)) != "taylor");
  BOOST_TEST(method(one(swung + drag + "linear = [1, 1, 1] }\n", weight + turning)) != "taylor");
  BOOST_TEST(method(one(swung, second + floating + weight)) != "taylor");
  const auto with_element = [&](const std::string& keys) {
    const std::string element = "[[element]]\nname = \"e\"\nstiffness = 3\n" + keys + "\n";
    return method(one(swung, second + hinge + element + weight));
  };
  BOOST_TEST(with_element("kind = \"spring\"\nbetween = [\"guide\", \"b\"]\nat = [[0, 0, 1], [0, "
                          "0, 0]]") != "taylor");
  BOOST_TEST(with_element("kind = \"gear\"\njoints = [\"a\", \"b\"]") == "taylor");
  const std::string wheel = second + "joint = { kind = \"revolute\", axis = [0, 1, 0] }\n";
  for (const std::string mode : {"\"free\", speed = 9", "\"torque\", torque = 0.1"}) {
    BOOST_TEST(method(one(swung, wheel + "rotor = { mode = " + mode + " }\n" + weight)) ==
               "taylor");
  }
  const test::Scratch folder;
  std::string log = "t,qw,qx,qy,qz\n";
  for (int i = 0; i <= 10; ++i) log += row({std::to_string(0.1 * i), "1", "0", "0", "0"}, ",");
  const std::string file = folder.write("log.csv", log).string();
  BOOST_TEST(method(one(swung, "[guide]\nkind = \"table\"\nfile = \"" + file + "\"\n")) !=
             "taylor");
  BOOST_TEST(method(one(swung,
                        "[guide]\nkind = \"chain\"\nlinks = [ { kind = \"rotating\", "
                        "angular_velocity = [0, 0, 1] }, { kind = \"rotating\", "
                        "angular_velocity = [0, 1, 0] } ]\n")) != "taylor");
  BOOST_TEST(method(one(swung,
                        "[guide]\nkind = \"earth\"\nlatitude_deg = 50\nheight = 0\n"
                        "azimuth_deg = 0\ngravity = \"normal\"\n")) != "taylor");
  BOOST_TEST(method(one(swung,
                        "[guide]\nkind = \"course\"\nlatitude_deg = 50\nheading_deg = 0\n"
                        "speed = 10\n")) != "taylor");
}

// Splitting is refused for scenes of a file, as are models that do not fit, with the reason.
BOOST_AUTO_TEST_CASE(models_and_methods_are_refused_with_a_reason) {
  const auto refused = [](const std::string& text, const std::string& reason) {
    const test::Outcome outcome = simulate(text);
    BOOST_TEST(outcome.status == 2, outcome.status << ": " << outcome.err);
    BOOST_TEST(contains(outcome.err, reason), outcome.err);
  };
  const auto with = [](const std::string& keys, const std::string& rest = "") {
    std::string text = one(hinge + "centre = [0, 0, -0.4]\n", weight + rest);
    return text + keys + "\n";
  };
  refused(with("method = \"splitting\""), "splitting");
  refused(with("model = \"precession\""), "no rotor");
  refused(with("model = \"foeppl\""), "foeppl");
  refused(with("model = \"fuchs-weigand\""), "fuchs-weigand");
  refused(
      with("model = \"linear\"",
           "[guide]\nkind = \"harmonic\"\nangular_velocity = { terms = [ { amplitude = [0, 0.1, "
           "0], frequency = 1 } ] }\n"),
      "no steady motion");
}

// Torque and power of a drive are reported.
BOOST_AUTO_TEST_CASE(drives_report_their_torque) {
  const test::Outcome outcome = simulate(
      one(hinge + "centre = [0, 0, -0.4]\ndrive = \"constant-rate\"\ninitial = { rate = 1 }\n",
          weight),
      "--json");
  BOOST_TEST_REQUIRE(outcome.status == 0, outcome.err);
  // 2 kg at 0.4 m, lifted by sin(1): the torque that holds it against gravity.
  const auto joint = test::parsed(outcome.out).at("final").at("joints").at("a");
  const double torque = joint.at("drive_torque").get<double>();
  BOOST_TEST(std::abs(torque - 2 * 9.81 * 0.4 * std::sin(1.0)) <= 1e-9);
  BOOST_TEST(joint.at("drive_power").get<double>() == torque);  // at 1 rad/s
}

BOOST_AUTO_TEST_SUITE_END()
