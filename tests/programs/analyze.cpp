// The program from its user's side: scene file in; equilibria, roots, multipliers and bounds out,
// against closed forms and references.

#include <boost/test/unit_test.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <support/json.hpp>
#include <support/program.hpp>
#include <support/worst.hpp>

using kreisel::test::number;
using kreisel::test::Outcome;
using kreisel::test::reference_file;
using kreisel::test::Scratch;
using nlohmann::json;
using std::numbers::pi;
using Complex = std::complex<double>;

namespace {

Outcome run(const std::string& arguments) {
  return kreisel::test::run(std::string(KREISEL_ANALYZE) + " " + arguments);
}

std::string scene(const std::string& name) {
  return std::string(KREISEL_SCENES) + "/" + name + ".toml";
}

json answer(const std::string& arguments) {
  const Outcome outcome = run(arguments + " --json");
  BOOST_REQUIRE_MESSAGE(outcome.status == 0, arguments << ": " << outcome.err);
  return kreisel::test::parsed(outcome.out);
}

json answer_to(const std::string& text, const std::string& arguments = "") {
  const Scratch folder;
  return answer(folder.write("scene.toml", text).string() + " " + arguments);
}

void check_near(const std::string& what, double found, double wanted, double bound) {
  BOOST_TEST(std::abs(found - wanted) <= bound, what << ": " << found << " differs from " << wanted
                                                     << " by " << found - wanted << ", allowed "
                                                     << bound);
}

/// With the conjugates, which the program omits.
std::vector<Complex> roots(const json& result) {
  std::vector<Complex> all;
  for (const json& root : result.at("linear").at("roots")) {
    const double growth = root.at("growth_rate").get<double>();
    const double frequency = root.at("frequency").get<double>();
    all.emplace_back(growth, frequency);
    if (frequency > 0) all.emplace_back(growth, -frequency);
  }
  return all;
}

double distance(const std::vector<Complex>& found, const Complex& wanted) {
  double least = 1e300;
  for (const Complex& s : found) least = std::min(least, std::abs(s - wanted));
  return least;
}

/// Oscillations, slowest first.
std::vector<double> frequencies(const json& result) {
  std::vector<double> all;
  for (const json& root : result.at("linear").at("roots")) {
    if (root.at("frequency").get<double>() > 0) all.push_back(root.at("frequency"));
  }
  return all;
}

std::string list(const json& numbers) {
  std::string text;
  for (const json& x : numbers) {
    text += text.empty() ? "[" : ", ";
    text += x.is_string() ? x.get<std::string>() : x.dump();
  }
  return text + "]";
}

/// A model of rotors.json as a scene; `joints` are additional keys, by the body's name.
std::string scene_of(const std::string& model, const std::string& root, double speed,
                     const json& joints, const std::string& mode = "regulated") {
  const json all = reference_file("rotors.json").at("models").at(model);
  std::ostringstream text;
  const auto inertia = [&text](const json& body) {
    const json& tensor = body.at("I");
    text << "mass = " << body.at("m").get<std::string>() << "\ncentre = " << list(body.at("c"))
         << "\ninertia = "
         << list({tensor[0][0], tensor[1][1], tensor[2][2], tensor[0][1], tensor[0][2],
                  tensor[1][2]})
         << '\n';
  };
  if (!root.empty()) {
    text << "[[body]]\nname = \"root\"\njoint = { kind = \"" << root << "\" }\n";
    inertia(all.at("root"));
  }
  const json& bodies = all.at("bodies");
  for (const json& body : bodies) {
    const int parent = body.at("parent");
    const std::string name = body.at("name");
    text << "[[body]]\nname = \"" << name << "\"\nparent = \""
         << (parent >= 0    ? bodies[static_cast<std::size_t>(parent)].at("name").get<std::string>()
             : root.empty() ? "guide"
                            : "root")
         << "\"\njoint = { kind = \"revolute\", axis = " << list(body.at("axis"))
         << ", position = " << list(body.at("r")) << " }\n";
    inertia(body);
    if (body.at("rotor").get<bool>()) {
      text << "rotor = { mode = \"" << mode << "\", speed = " << speed << " }\n";
    } else if (joints.contains(name)) {
      text << joints.at(name).get<std::string>() << '\n';
    }
  }
  text << "[solve]\nt_end = 1\n";
  return text.str();
}

/// Springs and dampers of the reference in the platform's frames.
std::string platform(const json& c, double speed) {
  json joints;
  for (std::size_t i = 0;
       const char* const frame : {"frame4", "housing5", "housing7", "frame9", "housing10"}) {
    joints[frame] = "spring = { stiffness = " + c.at("frame_stiffness")[i].get<std::string>() +
                    " }\ndamping = " + c.at("frame_damping")[i].get<std::string>();
    ++i;
  }
  return scene_of("platform", "spherical", speed, joints);
}

/// A rotor with the moments A, B, C between two springs in rings without mass, driven at a constant
/// speed.
std::string unsymmetric_rotor(const json& p) {
  std::ostringstream text;
  const auto ring = [&](const char* name, const char* parent, const char* axis, const json& k) {
    text << "[[body]]\nname = \"" << name << "\"\nparent = \"" << parent
         << "\"\njoint = { kind = \"revolute\", axis = " << axis
         << " }\nmass = 0\ninertia = [0, 0, 0]\nspring = { stiffness = " << number(k) << " }\n";
  };
  ring("outer", "guide", "[1, 0, 0]", p.at("ca"));
  ring("inner", "outer", "[0, 1, 0]", p.at("cb"));
  text << "[[body]]\nname = \"rotor\"\nparent = \"inner\"\njoint = { kind = \"revolute\", axis = "
          "[0, 0, 1] }\nmass = 1\ninertia = "
       << list({p.at("A"), p.at("B"), p.at("C")})
       << "\ndrive = \"constant-rate\"\ninitial = { rate = " << p.at("Om").get<std::string>()
       << " }\n[solve]\nt_end = 1\n";
  return text.str();
}

const std::string rod = R"(
[gravity]
kind = "uniform"
vector = [0, 0, -9.81]
[[body]]
name = "rod"
joint = { kind = "revolute", axis = [0, 1, 0] }
mass = 2
centre = [0, 0, -1]
inertia = [0.2, 0.2, 0.2]
initial = { angle = 0.5 }
[solve]
t_end = 2
)";

}  // namespace

BOOST_AUTO_TEST_SUITE(analyze_against_closed_forms)

BOOST_AUTO_TEST_CASE(pendulum) {
  const json result = answer_to(rod);
  const json& steady = result.at("steady");
  BOOST_TEST(steady.at("found") == "from the start");
  BOOST_TEST(steady.at("motion") == "equilibrium");
  check_near("distance", steady.at("distance"), 0.5, 1e-15);
  check_near("weight", steady.at("reactions").at("rod").at("force").at(2), 2 * 9.81, 1e-14);
  const json& root = result.at("linear").at("roots").at(0);
  const double w = std::sqrt(2 * 9.81 / 2.2);
  check_near("frequency", root.at("frequency"), w, 1e-14);
  check_near("in Hz", root.at("frequency_hz"), w / (2 * pi), 1e-14);
  check_near("growth", root.at("growth_rate"), 0, 1e-14);
  BOOST_TEST(result.at("linear").at("roots").size() == 1U);
  BOOST_TEST(result.at("linear").at("verdict") == "marginal");
  BOOST_TEST(result.at("precession").at("reason") == "there is no rotor among the bodies");

  std::string upright = rod;
  upright.replace(upright.find("0.5"), 3, "3.1");
  const json unstable = answer_to(upright);
  BOOST_TEST(unstable.at("linear").at("verdict") == "unstable");
  BOOST_TEST(distance(roots(unstable), w) < 1e-13);
}

BOOST_AUTO_TEST_CASE(damped_slide) {
  const json result = answer(scene("damped_slide"));
  check_near("place", result.at("steady").at("joints").at("slide").at("coordinate"), 0.04, 1e-16);
  const json& root = result.at("linear").at("roots").at(0);
  check_near("growth", root.at("growth_rate"), -1, 1e-14);
  check_near("frequency", root.at("frequency"), 7, 1e-13);
  check_near("damping", root.at("damping_ratio"), 1 / std::sqrt(50.0), 1e-14);
  BOOST_TEST(result.at("linear").at("verdict") == "stable");
}

// Paper 002's rod, 13 digits of the README; and the swing plane, which turns by u sin(latitude).
BOOST_AUTO_TEST_CASE(pendulums_on_the_earth) {
  const json hanging = answer(scene("earth_pendulum"));
  check_near("deviation", hanging.at("steady").at("joints").at("rod").at("coordinate"),
             1.355120825006e-10, 1e-21);
  const auto two = frequencies(answer(scene("foucault_pendulum")));
  BOOST_REQUIRE(two.size() == 2U);
  const double u = 7.292115e-5 * std::sin(48.846222 * pi / 180);
  check_near("Foucault", two[1] - two[0], 2 * u, 1e-6 * u);
}

BOOST_AUTO_TEST_CASE(gyrocompass) {
  const json result = answer(scene("gyrocompass"));
  check_near("north", result.at("steady").at("joints").at("ring").at("coordinate"), 0, 1e-12);
  const double horizontal = 7.292115e-5 * std::cos(50 * pi / 180);
  const auto one = frequencies(result);
  BOOST_REQUIRE(one.size() == 1U);
  check_near("swing", one[0], std::sqrt(5e-3 * 2400 * horizontal / 5e-3), 1e-6 * one[0]);
}

// A sleeping top is stable if (C w)^2 > 4 A k; on its own axes it nutates with nu - w.
BOOST_AUTO_TEST_CASE(sleeping_top) {
  const double A = 0.3, C = 0.1, k = 2.5, limit = 2 * std::sqrt(A * k) / C;
  for (const double w : {0.5 * limit, 2 * limit}) {
    std::ostringstream text;
    text.precision(17);
    text << "[gravity]\nkind = \"uniform\"\nvector = [0, 0, -10]\n[[body]]\nname = \"top\"\njoint "
            "= { kind = \"spherical\" }\nmass = 0.5\ncentre = [0, 0, 0.5]\ninertia = [0.175, 0.175,"
            " 0.1]\ninitial = { angular_velocity = [0, 0, "
         << w << "] }\n[solve]\nt_end = 1\n";
    const json result = answer_to(text.str());
    BOOST_TEST(result.at("steady").at("found") == "start");
    BOOST_TEST(result.at("steady").at("motion") == "steady motion");
    const Complex D = std::sqrt(Complex(C * C * w * w - 4 * A * k));
    for (const Complex& nu : {(C * w + D) / (2 * A), (C * w - D) / (2 * A)}) {
      BOOST_TEST(distance(roots(result), Complex(0, 1) * (nu - w)) < 1e-9 * w);
    }
    BOOST_TEST((result.at("linear").at("verdict") == "unstable") == (w < limit));
  }
}

// Free of torque about the middle axis: s^2 = w^2 (C - B)(B - A)/(A C). A body under a thruster's
// torque has no invariant.
BOOST_AUTO_TEST_CASE(tumbling_and_thrust) {
  const json result = answer(scene("tumbling_body"));
  BOOST_TEST(result.at("steady").at("motion") == "steady motion");
  BOOST_TEST(distance(roots(result), 2 * std::sqrt(1.0 / 3)) < 1e-5);
  BOOST_TEST(result.at("linear").at("verdict") == "unstable");
  const json none = answer(scene("satellite"));
  BOOST_TEST(none.at("steady").at("found") == "none");
  BOOST_TEST(none.at("steady").at("reason").get<std::string>().find("equilibrium: none reached") ==
             0U);
  BOOST_TEST(!none.contains("linear"));
  // A motor's torque and the bearing's friction: tau/d = 10 rad/s, decaying by d/C = 1/s.
  const json wheel = answer(scene("wheel_spun_up"));
  check_near("speed", wheel.at("steady").at("joints").at("wheel").at("rate"), 10, 1e-13);
  check_near("decay", wheel.at("linear").at("roots").at(0).at("growth_rate"), -1, 1e-14);
}

/// Both frequencies of a gyro between springs:  A B w^4 - (A k_b + B k_a + H^2) w^2 + k_a k_b = 0.
std::array<double, 2> gyro(double speed) {
  const double A = 0.006 + 0.002 + 0.005, B = 0.0015 + 0.005, H = 0.008 * speed;
  const double a = 2.0, b = 1.5;
  const double p = A * b + B * a + H * H;
  const double faster = (p + std::sqrt(p * p - 4 * A * B * a * b)) / (2 * A * B);
  return {std::sqrt(a * b / (A * B) / faster), std::sqrt(faster)};
}

BOOST_AUTO_TEST_CASE(campbell_diagram_of_a_gyro_on_springs) {
  const json result =
      answer(scene("cardan_gyro_springs") + " --campbell rotor --speeds 5:105:11").at("campbell");
  BOOST_REQUIRE(result.at("curves").size() == 2U);
  for (std::size_t i = 0; i < 11; ++i) {
    const double speed = 5 + 10 * static_cast<double>(i);
    check_near("speed", result.at("speeds").at(i), speed, 1e-12);
    for (std::size_t k = 0; k < 2; ++k) {
      const json& mode = result.at("curves").at(k).at(i);
      check_near("frequency", mode.at("frequency"), gyro(speed).at(k), 1e-11);
      const double h = 1e-4;
      const double growth = std::log(gyro(speed * (1 + h)).at(k) / gyro(speed * (1 - h)).at(k)) /
                            std::log((1 + h) / (1 - h));
      check_near("d ln w / d ln L", mode.at("spin_growth"), growth, 1e-7);
      const std::string kind = mode.at("kind");
      BOOST_TEST(kind == (std::abs(growth) <= 0.5 ? "oscillation"
                          : growth > 0            ? "nutation"
                                                  : "precession"));
    }
  }
}

BOOST_AUTO_TEST_SUITE_END()

namespace {

/// A point mass at 1 m on a hinge along y, with the rest position 0.
std::string point_pendulum(const std::string& rest) {
  return "[[body]]\nname = \"bob\"\njoint = { kind = \"revolute\", axis = [0, 1, 0] }\nmass = 1\n"
         "centre = [0, 0, -1]\ninertia = [0, 0, 0]\n" +
         rest + "\n[gravity]\nkind = \"uniform\"\nvector = [0, 0, -9.81]\n[solve]\nt_end = 5\n";
}

/// A pid that reads the angle of a body and drives its joint or that of another, and further keys of
/// the controller.
std::string servo_of(const std::string& body, const std::string& gains,
                     const std::string& keys = "", const std::string& other = "") {
  return "[[sensor]]\nname = \"pickoff\"\nkind = \"joint\"\njoint = \"" + body +
         "\"\n[[controller]]\nname = \"servo\"\nreads = [\"pickoff.angle\"]\ndrives = [\"" +
         (other.empty() ? body : other) + "\"]\nlaw = { kind = \"pid\", " + gains + " }\n" + keys;
}

/// Coordinates and stability of all equilibria, in the order of the program.
std::vector<std::pair<std::vector<double>, std::string>> equilibria(
    const json& result, const std::vector<std::string>& bodies) {
  std::vector<std::pair<std::vector<double>, std::string>> all;
  for (const json& one : result.at("equilibria")) {
    std::vector<double> coordinates;
    for (const std::string& body : bodies) {
      coordinates.push_back(one.at("joints").at(body).at("coordinate"));
    }
    all.emplace_back(std::move(coordinates), one.at("stability"));
  }
  return all;
}

void check_equilibria(const json& result, const std::vector<std::string>& bodies,
                      const std::vector<std::pair<std::vector<double>, std::string>>& wanted) {
  const auto found = equilibria(result, bodies);
  BOOST_TEST_REQUIRE(found.size() == wanted.size());
  for (const auto& one : wanted) {
    const bool is_there = std::any_of(found.begin(), found.end(), [&one](const auto& other) {
      double off = 0;
      for (std::size_t i = 0; i < one.first.size(); ++i) {
        off = std::max(off, std::abs(other.first[i] - one.first[i]));
      }
      return off <= 1e-12 && other.second == one.second;
    });
    BOOST_TEST(is_there, one.second << " at " << one.first.front());
  }
  const auto rank = [](const auto& one) {
    return one.second == "stable" ? 0 : one.second == "marginal" ? 1 : 2;
  };
  BOOST_TEST(std::is_sorted(found.begin(), found.end(),
                            [&](const auto& a, const auto& b) { return rank(a) < rank(b); }));
}

}  // namespace

BOOST_AUTO_TEST_SUITE(analyze_lists_equilibria)

BOOST_AUTO_TEST_CASE(pendulum_from_any_start) {
  for (const double degrees : {0.0, 30.0, 75.0, 83.0, 90.0, 91.0, 135.0, 179.0, 180.0, -100.0}) {
    const json result =
        answer_to(point_pendulum("initial = { angle_deg = " + std::to_string(degrees) + " }"));
    check_equilibria(result, {"bob"}, {{{0}, "stable"}, {{pi}, "unstable"}});
    const double next = result.at("steady").at("joints").at("bob").at("coordinate");
    const double wanted = std::abs(degrees) <= 90 ? 0 : std::copysign(pi, degrees);
    check_near("the next one to " + std::to_string(degrees), next, wanted, 1e-12);
  }
  const Scratch folder;
  const std::string file = folder.write("s.toml", point_pendulum("")).string();
  const Outcome text = run(file);
  BOOST_TEST(text.out.find("equilibria: 2 found from ") != std::string::npos, text.out);
  BOOST_TEST(text.out.find("\n  stable    bob coordinate 0\n") != std::string::npos, text.out);
  BOOST_TEST(text.out.find("\n  unstable  bob coordinate 3.14159265358979\n") != std::string::npos);
  BOOST_TEST(run(file).out == text.out);
}

BOOST_AUTO_TEST_CASE(all_four_of_a_double_pendulum) {
  const std::string two = point_pendulum("initial = { angle_deg = 180 }") +
                          "[[body]]\nname = \"lower\"\nparent = \"bob\"\njoint = { kind = "
                          "\"revolute\", axis = [0, 1, 0], position = [0, 0, -1] }\nmass = 2\n"
                          "centre = [0, 0, -1]\ninertia = [0, 0, 0]\n";
  const json result = answer_to(two);
  check_equilibria(
      result, {"bob", "lower"},
      {{{0, 0}, "stable"}, {{pi, 0}, "unstable"}, {{0, pi}, "unstable"}, {{pi, pi}, "unstable"}});
  BOOST_TEST(result.at("steady").at("found") == "start");
}

// k q = m g l sin(q) with k = m g l/2: the spring distinguishes whole turns, and the mass is stable
// on it.
BOOST_AUTO_TEST_CASE(mass_on_a_bending_spring) {
  const double bent = 1.8954942670339809;
  std::string text = point_pendulum("spring = { stiffness = 4.905 }\ndamping = 0.1");
  text.replace(text.find("[0, 0, -1]"), 10, "[0, 0, 1]");
  check_equilibria(answer_to(text), {"bob"},
                   {{{bent}, "stable"}, {{-bent}, "stable"}, {{0}, "unstable"}});
}

// On a guide that turns about the vertical the equilibrium is w^2 l cos(q) = g.
BOOST_AUTO_TEST_CASE(governor) {
  const double w = 5;
  const double out = std::acos(9.81 / (w * w));
  check_equilibria(answer_to("[guide]\nkind = \"rotating\"\nangular_velocity = [0, 0, 5]\n" +
                             point_pendulum("")),
                   {"bob"},
                   {{{out}, "stable"}, {{-out}, "stable"}, {{0}, "unstable"}, {{pi}, "unstable"}});
}

// Two cranks of 1 m and a rod between them: hanging, upright, and crossed. The hanging one swings with
// omega^2 = (2 m g/2 + m g) / (2/3 m + m).
BOOST_AUTO_TEST_CASE(linkage) {
  const auto rod = [](const std::string& name, const std::string& joint, const std::string& rest) {
    return "[[body]]\nname = \"" + name + "\"\njoint = { kind = \"revolute\", axis = [0, 1, 0], " +
           joint + " }\nmass = 3\ninertia = [0.25, 0.25, 0.25]\n" + rest;
  };
  const json result = answer_to(
      "[gravity]\nkind = \"uniform\"\nvector = [0, 0, -9.81]\n" +
      rod("left", "position = [0, 0, 0]", "centre = [0, 0, -0.5]\ninitial = { angle = 0.1 }\n") +
      rod("right", "position = [2, 0, 0]", "centre = [0, 0, -0.5]\ninitial = { angle = 0.1 }\n") +
      rod("rod", "position = [0, 0, -1]",
          "parent = \"left\"\ncentre = [1, 0, 0]\ninitial = { angle = -0.1 }\n") +
      "[[constraint]]\nname = \"loop\"\nkind = \"point\"\nbetween = [\"right\", \"rod\"]\n"
      "at = [[0, 0, -1], [2, 0, 0]]\n[solve]\nt_end = 1\n");
  const json& hanging = result.at("equilibria").at(0);
  BOOST_TEST(hanging.at("stability") == "stable");
  for (const char* const body : {"left", "right", "rod"}) {
    check_near(body, hanging.at("joints").at(body).at("coordinate"), 0, 1e-14);
  }
  const json& root = hanging.at("roots").at(0);
  check_near("frequency", root.at("frequency"), std::sqrt(2 * 9.81 / (5.0 / 3)), 1e-12);
  BOOST_TEST(result.at("linear").at("dependent").size() == 4U);
}

// A family of equilibria is listed once.
BOOST_AUTO_TEST_CASE(one_for_each_family) {
  std::string ball = point_pendulum("initial = { attitude = [0.8, 0.6, 0, 0] }");
  ball.replace(ball.find("kind = \"revolute\", axis = [0, 1, 0]"), 35, "kind = \"spherical\"");
  ball.replace(ball.find("[0, 0, 0]"), 9, "[0.1, 0.2, 0.25]");
  const json hanging = answer_to(ball).at("equilibria");
  BOOST_TEST_REQUIRE(hanging.size() == 2U);
  BOOST_TEST(hanging.at(0).at("stability") == "stable");
  BOOST_TEST(hanging.at(0).at("neutral") == 1);
  BOOST_TEST(hanging.at(1).at("stability") == "unstable");
  BOOST_TEST(answer(scene("cardan_gyro_free")).at("equilibria").size() == 1U);
  BOOST_TEST(answer(scene("gimbal_lock")).at("equilibria").size() == 1U);
}

// m g l sin(q) = -P q: a controller counts the turns of the angle that it reads, as a spring does.
BOOST_AUTO_TEST_CASE(controllers_count_turns) {
  const auto found =
      equilibria(answer_to(point_pendulum("") + servo_of("bob", "proportional = 0.3")), {"bob"});
  BOOST_TEST(found.size() >= 3U);
  for (const auto& [q, stability] : found) {
    BOOST_TEST(std::abs(9.81 * std::sin(q[0]) + 0.3 * q[0]) <= 1e-12, q[0]);
  }
}

// The integral of a sampled law leaves one equilibrium, where the error is 0.
BOOST_AUTO_TEST_CASE(sampled_controllers_hold_a_single_one) {
  const std::string arm = R"([[body]]
name = "arm"
joint = { kind = "revolute", axis = [0, 0, 1] }
mass = 1
inertia = [0.1, 0.1, 0.2]
damping = 0.3
)";
  const std::string servo =
      servo_of("arm", "proportional = 3, integral = 0.7, derivative = 0.4, filter = 0.05",
               "period = 0.02\ndelay = 0.033\nreference = 0.2\n");
  const json found = answer_to(arm + servo + "[solve]\nt_end = 3\n").at("equilibria");
  BOOST_TEST_REQUIRE(found.size() == 1U);
  BOOST_TEST(found.at(0).value("neutral", 0) == 0);
  check_near("arm", found.at(0).at("joints").at("arm").at("coordinate"), 0.2, 1e-12);
}

BOOST_AUTO_TEST_CASE(none_under_a_persistent_torque) {
  const std::string wheel = R"([[body]]
name = "wheel"
joint = { kind = "revolute", axis = [0, 0, 1] }
mass = 1
inertia = [1, 1, 1]
rotor = { mode = "torque", torque = 0.1 }
[solve]
t_end = 1
)";
  const json result = answer_to(wheel);
  BOOST_TEST(result.at("equilibria").empty());
  const std::string reason = result.at("steady").at("reason");
  BOOST_TEST(reason.find("the torque on rotor 'wheel' goes on acting") != std::string::npos,
             reason);
  BOOST_TEST(result.at("precession").at("reason").get<std::string>().find("nothing but rotors") !=
             std::string::npos);
  for (const char* const mode : {"\"free\", speed = 3", "\"regulated\", speed = 3"}) {
    std::string text = wheel;
    text.replace(text.find("\"torque\", torque = 0.1"), 22, mode);
    BOOST_TEST(answer_to(text).at("steady").at("found") == "start", mode);
  }
}

// Roots on axes that turn with the body differ by that rotation from those on resting axes.
BOOST_AUTO_TEST_CASE(roots_name_their_frame) {
  const std::string top = R"([[body]]
name = "top"
joint = { kind = "spherical" }
mass = 0.5
centre = [0, 0, 0.5]
inertia = [0.175, 0.175, 0.1]
initial = { angular_velocity = [0, 0, 40] }
[gravity]
kind = "uniform"
vector = [0, 0, -10]
[solve]
t_end = 1
)";
  BOOST_TEST(answer_to(top).at("linear").at("frame") == "on body axes, which turn with 'top'");
  const json pendulum = answer_to(point_pendulum(""));
  BOOST_TEST(pendulum.at("linear").at("frame") == "against the guide");
  BOOST_TEST(pendulum.at("equilibria").at(0).at("frame") == "against the guide");
  const json gimbals = answer(scene("cardan_gyro_springs"));
  BOOST_TEST(gimbals.at("linear").at("frame") == "against the guide");
  const json carried = answer_to(
      "[[body]]\nname = \"table\"\njoint = { kind = \"revolute\", axis = [0, 0, 1] }\nmass = 1\n"
      "inertia = [1, 1, 1]\ndrive = \"constant-rate\"\ninitial = { rate = 1 }\n[[body]]\nname = "
      "\"rod\"\nparent = \"table\"\njoint = { kind = \"revolute\", axis = [0, 1, 0] }\nmass = 1\n"
      "centre = [0, 0, -1]\ninertia = [0.1, 0.1, 0.1]\n[gravity]\nkind = \"uniform\"\nvector = "
      "[0, 0, -10]\n[solve]\nt_end = 1\n");
  BOOST_TEST(carried.at("linear").at("frame") ==
             "against the parent of each body; 'table' turns against the guide");
}

BOOST_AUTO_TEST_SUITE_END()

BOOST_AUTO_TEST_SUITE(analyze_against_references)

// Castering, weave and capsize of the benchmark at 5 m/s.
BOOST_AUTO_TEST_CASE(bicycle) {
  const json result = answer(scene("bicycle"));
  BOOST_TEST(result.at("steady").at("motion") == "steady motion");
  const std::pair<double, double> wanted[] = {
      {-14.07838969279822, 0}, {-0.77534188219585, 4.46486771378823}, {-0.32286642900409, 0}};
  for (const auto& [growth, frequency] : wanted) {
    double least = INFINITY;
    for (const json& root : result.at("linear").at("roots")) {
      least = std::min(least, std::hypot(root.at("growth_rate").get<double>() - growth,
                                         root.at("frequency").get<double>() - frequency));
    }
    BOOST_TEST(least <= 1e-10, growth);
  }
}

// 32 digits. The growth of roots with the momenta is the difference of two such scenes, damped or
// not.
BOOST_AUTO_TEST_CASE(platform_with_three_gyros) {
  const json all = reference_file("rotors.json").at("eigenvalues");
  for (const char* const name : {"P_free_base_springs_only", "P_free_base_springs_dampers"}) {
    const json& c = all.at(name);
    const json result = answer_to(platform(c, 1000));
    BOOST_TEST(result.at("steady").at("found") == "start");
    const auto found = roots(result);
    std::size_t count = 0;
    for (const json& root : c.at("eig_corrected_regulated")) {
      const Complex truth(number(root[0]), number(root[1]));
      if (std::abs(truth) < 1e-9) continue;
      ++count;
      BOOST_TEST(distance(found, truth) < 1e-12 * std::abs(truth), name << ": " << truth);
    }
    BOOST_TEST(std::count_if(found.begin(), found.end(), [](const Complex& s) {
                 return std::abs(s) > 1e-9;
               }) == static_cast<std::ptrdiff_t>(count));
    const double h = 1e-4;
    const auto more = roots(answer_to(platform(c, 1000 * (1 + h))));
    const auto less = roots(answer_to(platform(c, 1000 * (1 - h))));
    std::size_t kinds = 0;
    for (const json& root : result.at("linear").at("roots")) {
      if (!root.contains("kind")) continue;
      ++kinds;
      const Complex s(root.at("growth_rate"), root.at("frequency"));
      const auto size = [&s](const std::vector<Complex>& list) {
        return std::abs(*std::min_element(list.begin(), list.end(), [&s](auto a, auto b) {
          return std::abs(a - s) < std::abs(b - s);
        }));
      };
      const double growth = std::log(size(more) / size(less)) / (2 * h);
      check_near("d ln|s| / d ln L", root.at("spin_growth"), growth, 1e-5);
    }
    BOOST_TEST(kinds >= 6U);
  }
}

// tests/data/floquet.json: multipliers over half a turn, for possible rotors.
BOOST_AUTO_TEST_CASE(unsymmetric_rotors) {
  const json all = reference_file("floquet.json").at("points");
  int count = 0;
  for (const json& point : all) {
    const json& p = point.at("params");
    if (point.at("printed").get<bool>() || p.size() != 6) continue;
    const double A = number(p.at("A")), B = number(p.at("B")), C = number(p.at("C"));
    if (A > B + C || B > A + C || C > A + B) continue;
    ++count;
    std::ostringstream period;
    period.precision(17);
    period << "--period " << pi / number(p.at("Om"));
    const json result = answer_to(unsymmetric_rotor(p), period.str());
    BOOST_TEST((result.at("steady").at("found") == "none") == (A != B));
    const json& floquet = result.at("floquet");
    std::vector<Complex> found;
    double allowed = 0;
    for (const json& m : floquet.at("multipliers")) {
      found.emplace_back(m.at("real"), m.at("imag"));
      allowed = std::max(allowed, m.at("error").get<double>());
    }
    BOOST_TEST(found.size() == 4U);
    BOOST_TEST(allowed < 1e-4);
    for (const json& m : point.at("multipliers")) {
      BOOST_TEST(distance(found, {number(m[0]), number(m[1])}) <= allowed);
    }
    const bool grows = number(point.at("rho")) > 1 + 1e-6;
    BOOST_TEST((floquet.at("verdict") == "unstable") == grows, point.at("name"));
  }
  BOOST_TEST(count >= 3);
}

// Mathieu's pendulum, oscillated along its length, upright: the equation by classical Runge-Kutta
// steps.
BOOST_AUTO_TEST_CASE(pendulum_stabilised_upright) {
  std::string text = rod;
  text.replace(text.find("0.5"), 3, "3.141592653589793");
  const std::string shaken = R"([guide]
kind = "harmonic"
origin_acceleration = { terms = [ { amplitude = [0, 0, 800], frequency = 60, phase = 0.3 } ] }
)" + text;
  const json floquet = answer_to(shaken).at("floquet");
  check_near("period", floquet.at("period"), 2 * pi / 60, 1e-15);
  const auto slope = [](double t, double x) {
    return 2 / 2.2 * (9.81 + 800 * std::sin(60 * t + 0.3)) * x;
  };
  double trace = 0;
  for (const int column : {0, 1}) {
    double x = column == 0, v = column == 1, t = 0;
    const int steps = 4000;
    const double h = 2 * pi / 60 / steps;
    for (int i = 0; i < steps; ++i, t = i * h) {
      const double k1 = slope(t, x), k2 = slope(t + h / 2, x + h / 2 * v);
      const double k3 = slope(t + h / 2, x + h / 2 * (v + h / 2 * k1));
      const double k4 = slope(t + h, x + h * (v + h / 2 * k2));
      x += h * (v + h / 6 * (k1 + k2 + k3));
      v += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
    }
    trace += column == 0 ? x : v;
  }
  Complex sum, product = 1;
  for (const json& m : floquet.at("multipliers")) {
    const Complex l(m.at("real"), m.at("imag"));
    sum += l;
    product *= l;
  }
  check_near("trace", sum.real(), trace, 1e-9);
  check_near("determinant", std::abs(product), 1, 1e-9);
  BOOST_TEST((floquet.at("verdict") == "unstable") == (std::abs(trace) > 2));
}

// rotors.json, T13: the distance of the exact motion and the precession motion of a gyro on
// springs.
BOOST_AUTO_TEST_CASE(precession_of_a_gyro_on_springs) {
  const json c = reference_file("rotors.json")
                     .at("trajectories")
                     .at("T13_cardan_springs_exact_and_precession");
  const json result =
      answer_to(scene_of("cardan", "", 1000,
                         {{"outer",
                           "spring = { stiffness = 0.4 }\nforce = 0.02\ninitial = { angle "
                           "= 0.2 }"},
                          {"inner",
                           "spring = { stiffness = 0.3 }\nforce = -0.01\ninitial = { "
                           "angle = -0.1 }"}}));
  double off = 0;
  for (std::size_t i = 0; i < c.at("exact").size(); ++i) {
    const auto q = [&](const char* which, std::size_t k) {
      return number(c.at(which).at(i).at("q").at(k));
    };
    off = kreisel::test::worst_of(
        off, std::hypot(q("exact", 0) - q("precession", 0), q("exact", 1) - q("precession", 1)));
  }
  const json& check = result.at("precession");
  BOOST_TEST(check.at("admissible").get<bool>());
  BOOST_TEST(check.at("rank") == 2);
  const double bound = check.at("bound").at("error");
  BOOST_TEST(check.at("bound").at("t") == 1.0);
  BOOST_TEST(bound >= off);
  BOOST_TEST(bound <= 10 * off);
  // At a tenth of the speed no motion is slow.
  const json slower = answer_to(scene_of(
      "cardan", "", 50,
      {{"outer", "spring = { stiffness = 0.4 }"}, {"inner", "spring = { stiffness = 0.3 }"}}));
  BOOST_TEST(!slower.at("precession").at("admissible").get<bool>());
  BOOST_TEST(slower.at("precession").at("why_not").get<std::string>().find("not fast") !=
             std::string::npos);
}

BOOST_AUTO_TEST_SUITE_END()

BOOST_AUTO_TEST_SUITE(closed_loops)

// Two arms on equal cranks, or on gears of ratio 1: neither angle is free at one time and not at
// another.
BOOST_AUTO_TEST_CASE(a_linkage_responds_on_a_ship_that_rolls) {
  const auto arm = [](const std::string& name, const std::string& rest) {
    return "[[body]]\nname = \"" + name + "\"\ncentre = [0, 0, -0.3]\n" +
           "inertia = [0.02, 0.02, 0.02]\njoint = { kind = \"revolute\", axis = [1, 0, 0]" + rest;
  };
  const std::string arms =
      "[guide]\nkind = \"motion\"\n"
      "angles = { roll = { terms = [{ amplitude = 0.1, frequency = 0.8 }] } }\n"
      "[gravity]\nkind = \"inertial\"\nvector = [0, 0, -9.81]\n" +
      arm("a", " }\nmass = 1\ndamping = 0.1\n") +
      arm("b", ", position = [0, 0.5, 0] }\nmass = 1.5\n") + "[[constraint]]\nname = \"rod\"\n";
  const Scratch folder;
  std::vector<json> rows;
  for (const char* const rod : {"kind = \"distance\"\nbetween = [\"a\", \"b\"]\n"
                                "at = [[0, 0, -0.6], [0, 0, -0.6]]\nlength = 0.5\n",
                                "kind = \"gear\"\njoints = [\"a\", \"b\"]\nratio = 1\n"}) {
    const auto file = folder.write("arms.toml", arms + rod + "[solve]\nt_end = 3\n");
    rows.push_back(answer(file.string() + " --response joint.a --to b.angle --frequencies 1:10:4")
                       .at("response")
                       .at("rows"));
  }
  BOOST_TEST_REQUIRE(rows[0].size() == 4U);
  for (std::size_t i = 0; i < rows[0].size(); ++i) {
    for (const char* const key : {"amplitude", "phase"}) {
      check_near(key, rows[0].at(i).at(key), rows[1].at(i).at(key), 1e-9);
    }
  }
}

// A motor on a load by a gear, and the same inertia, damping and gains on one shaft.
BOOST_AUTO_TEST_CASE(a_sampled_loop_reads_what_a_gear_moves) {
  const auto shaft = [](const std::string& name, const std::string& rest) {
    return "[[body]]\nname = \"" + name +
           "\"\njoint = { kind = \"revolute\", axis = [0, 0, 1] }\nmass = 1\n" + rest;
  };
  const std::string sampled = "period = 0.05\ndelay = 0.03\n[solve]\nt_end = 3\n";
  const std::string load = "spring = { stiffness = 2 }\n";
  const json geared = answer_to(
      shaft("motor", "inertia = [0.02, 0.02, 0.02]\ndamping = 0.01\n") +
      shaft("load", "inertia = [3, 3, 3]\n" + load) +
      "[[constraint]]\nname = \"gear\"\nkind = \"gear\"\njoints = [\"motor\", \"load\"]\n"
      "ratio = -10\n" +
      servo_of("load", "proportional = -3, integral = -0.7, derivative = -1.4, filter = 0.05",
               sampled, "motor"));
  const json direct = answer_to(
      shaft("load", "inertia = [5, 5, 5]\ndamping = 1\n" + load) +
      servo_of("load", "proportional = 30, integral = 7, derivative = 14, filter = 0.05", sampled));
  const std::vector<Complex> wanted = roots(direct);
  BOOST_TEST(roots(geared).size() == wanted.size());
  for (const Complex& s : wanted) BOOST_TEST(distance(roots(geared), s) <= 1e-9 * std::abs(s));
  BOOST_TEST(distance(wanted, {-0.243515, 0}) < 1e-6);
}

// A Bennett linkage that lies flat moves as elsewhere: M q'' + 5 q = 0 with the inertia of all bars at
// the unit rate of the first.
BOOST_AUTO_TEST_CASE(a_flat_bennett_linkage_keeps_its_freedom) {
  const json result = answer_to(R"([[body]]
name = "one"
joint = { kind = "revolute", axis = [0, 0, 1] }
mass = 1
centre = [0.25, 0, 0]
inertia = [0.01, 0.03, 0.03]
spring = { stiffness = 5 }
[[body]]
name = "two"
parent = "one"
joint = { kind = "revolute", axis = [0, -0.5646424733950354, 0.8253356149096783], position = [0.5, 0, 0], orientation = [0.955336489125606, 0.29552020666133955, 0, 0] }
mass = 2
centre = [0.4, 0, 0]
inertia = [0.02, 0.06, 0.06]
initial = { angle = 3.141592653589793 }
[[body]]
name = "three"
parent = "two"
joint = { kind = "revolute", axis = [0, -0.963558185417193, 0.26749882862458735], position = [0.8532462848779249, 0, 0], orientation = [0.7960837985490559, 0.6051864057360395, 0, 0] }
mass = 1.5
centre = [0.2, 0, 0]
inertia = [0.02, 0.04, 0.04]
[[constraint]]
name = "loop"
kind = "revolute"
between = ["guide", "three"]
at = [[-0.8532462848779249, 0, 0], [0.5, 0, 0]]
axis = [[0, 0.963558185417193, 0.26749882862458735], [0, -0.5646424733950354, 0.8253356149096783]]
[solve]
t_end = 2.5
)");
  const std::vector<double> found = frequencies(result);
  BOOST_TEST_REQUIRE(found.size() == 1U);
  check_near("frequency", found[0], std::sqrt(5 / 0.28504429), 1e-7);
}

// 0.5 kg m^2 under a torque -(2 + 0.3 s/(1 + 0.01 s)) angle.
BOOST_AUTO_TEST_CASE(servo_has_roots_response_and_margins) {
  const Scratch folder;
  const auto file = folder.write("servo.toml", std::string(R"(
[solve]
t_end = 1
[[body]]
name = "arm"
joint = { kind = "revolute", axis = [0, 0, 1] }
mass = 2
inertia = [0.3, 0.3, 0.5]
)") + servo_of("arm", "proportional = 2, derivative = 0.3, filter = 0.01"));
  const auto plant = folder.path() / "plant.json";
  const auto table = folder.path() / "table.csv";
  const json result =
      answer(file.string() + " --response joint.arm --to servo.arm --frequencies " +
             "0.1:100:50 --state-space " + plant.string() + " --csv " + table.string());
  const auto law = [](Complex s) { return 2.0 + 0.3 * s / (1.0 + 0.01 * s); };
  for (const Complex s : roots(result)) BOOST_TEST(std::abs(0.5 * s * s + law(s)) < 1e-9);
  const json& response = result.at("response");
  for (const json& row : response.at("rows")) {
    const Complex s(0, row.at("frequency").get<double>());
    const Complex wanted = -law(s) / (0.5 * s * s + law(s));
    check_near("amplitude", row.at("amplitude"), std::abs(wanted), 1e-12);
    check_near("phase", row.at("phase"), std::arg(wanted), 1e-12);
  }
  const double w = response.at("phase_margin").at("frequency");
  const Complex loop = law(Complex(0, w)) / (0.5 * Complex(0, w) * Complex(0, w));
  check_near("gain", std::abs(loop), 1, 1e-11);
  check_near("margin", response.at("phase_margin").at("angle"), std::arg(loop) + pi, 1e-11);
  BOOST_TEST(response.at("gain_margin").is_null());

  const json matrices = json::parse(std::ifstream(plant));
  BOOST_TEST(matrices.at("dt") == 0);
  BOOST_TEST(matrices.at("states").size() == 3U);
  BOOST_TEST(matrices.at("A").size() == 3U);
  BOOST_TEST(matrices.at("B").at(0).size() == matrices.at("inputs").size());
  BOOST_TEST(matrices.at("D").size() == matrices.at("outputs").size());
  std::string first;
  std::ifstream rows(table);
  std::getline(rows, first);
  BOOST_TEST(first == "frequency,amplitude,phase");
}

BOOST_AUTO_TEST_CASE(requests_for_responses_are_checked) {
  const auto refused = [](const std::string& options, const std::string& part) {
    const Outcome outcome = run(scene("gyro_horizon") + " " + options);
    BOOST_TEST(outcome.status == 2);
    BOOST_TEST(outcome.err.find(part) != std::string::npos, outcome.err);
  };
  refused("--response joint.outer", "go together");
  refused("--csv table.csv", "needs --response");
  refused("--response joint.outer --to outer.angle --frequencies 0:1:5", "above 0");
}

BOOST_AUTO_TEST_SUITE_END()

BOOST_AUTO_TEST_SUITE(analyze_from_a_command_line)

BOOST_AUTO_TEST_CASE(every_example_scene_has_an_answer) {
  for (const auto& entry : std::filesystem::directory_iterator(KREISEL_SCENES)) {
    if (entry.path().extension() != ".toml") continue;
    const Outcome outcome = run("'" + entry.path().string() + "'");
    BOOST_TEST(outcome.status == 0, entry.path() << ": " << outcome.err);
    BOOST_TEST(outcome.err == "");
    BOOST_TEST(outcome.out.find("precession equations: ") != std::string::npos, entry.path());
  }
}

BOOST_AUTO_TEST_CASE(states_its_limits_in_one_line) {
  const auto notes = [](const char* name) { return answer(scene(name)).at("notes").dump(); };
  BOOST_TEST(notes("heavy_top").find("gimbals and a rotor") != std::string::npos);
  const Scratch folder;
  const auto swings = folder.write(
      "scene.toml",
      rod +
          "[guide]\nkind = \"harmonic\"\nangular_velocity = { terms = [{ amplitude = [0, 0.1, 0], "
          "frequency = 1, phase = 0 }, { amplitude = [0.1, 0, 0], frequency = 1.4142135623730951, "
          "phase = 0 }] }\n");
  BOOST_TEST(answer(swings.string()).at("notes").dump().find("several frequencies") !=
             std::string::npos);
  BOOST_TEST(notes("device_on_logged_ship").find("log") != std::string::npos);
}

// A pivot that is shaken as a function of time. The product of the multipliers is that of the damping,
// 0.3 N m s on 0.55 kg m^2, over one period (Liouville).
BOOST_AUTO_TEST_CASE(takes_the_only_period_by_itself) {
  const json floquet = answer_to(R"([guide]
kind = "motion"
position = { terms = [{ amplitude = [0, 0, 0.15], frequency = 8 }] }
[gravity]
kind = "inertial"
vector = [0, 0, -9.81]
[[body]]
name = "p"
joint = { kind = "revolute", axis = [1, 0, 0] }
mass = 2
centre = [0, 0, -0.5]
inertia = [0.05, 0.05, 0.01]
damping = 0.3
[solve]
t_end = 1
)")
                           .at("floquet");
  check_near("period", floquet.at("period"), pi / 4, 1e-15);
  Complex product = 1;
  for (const json& m : floquet.at("multipliers")) product *= Complex(m.at("real"), m.at("imag"));
  check_near("product", product.real(), std::exp(-0.3 / 0.55 * pi / 4), 1e-11);
}

// Frequencies of 2, 3 and 5 rad/s.
BOOST_AUTO_TEST_CASE(finds_the_common_period) {
  const std::string notes = answer(scene("cardan_gyro_shaken")).at("notes").dump();
  BOOST_TEST(notes.find("the period is 6.28318531 s") != std::string::npos, notes);
}

BOOST_AUTO_TEST_CASE(exit_status_is_2_or_3_for_errors) {
  const Scratch folder;
  const std::string good = folder.write("scene.toml", rod).string();
  const std::string bad = folder.write("bad.toml", "titel = \"\"\n" + rod).string();
  const std::string gyro = scene("cardan_gyro_springs");
  const std::pair<std::string, std::string> cases[] = {
      {"", "scene is required"},
      {"none.toml", "none.toml: cannot be read"},
      {bad, "bad.toml:1:1: titel: is no key here (did you mean 'title'?)"},
      {good + " --colour red", "--colour"},
      {good + " --period 0", "--period must be above 0"},
      {good + " --period nan", "--period = 'nan' is not a finite number"},
      {gyro + " --campbell rotor", "go together"},
      {gyro + " --campbell rotor --speeds 1:2", "wanted FROM:TO:N"},
      {gyro + " --campbell rotor --speeds 1:2:1", "no whole number from 2"},
      {gyro + " --campbell rotor --speeds 1:1:5", "the same"},
      {gyro + " --campbell rotor --speeds=-1e308:1e308:5", "too far apart"},
      {gyro + " --campbell wheel --speeds 1:2:3", "body 'wheel' does not exist"},
      {gyro + " --campbell 'outer ring' --speeds 1:2:3", "neither a free or regulated rotor"},
      {scene("cardan_gyro_shaken") + " --period 1", "after 1 s the equations are not the same"},
  };
  for (const auto& [arguments, reason] : cases) {
    const Outcome outcome = run(arguments);
    BOOST_TEST(outcome.status == 2, arguments << " exits with " << outcome.status);
    BOOST_TEST(outcome.out == "");
    BOOST_TEST(outcome.err.find(reason) != std::string::npos, arguments << ": " << outcome.err);
    BOOST_TEST(std::count(outcome.err.begin(), outcome.err.end(), '\n') == 1);
  }
  const Outcome none = run(scene("satellite") + " --campbell wheel --speeds 1:2:3");
  BOOST_TEST(none.status == 3);
  BOOST_TEST(none.err.find("analyze: sweep of a speed: no steady motion") == 0U, none.err);
  BOOST_TEST(kreisel::test::run("( " + std::string(KREISEL_ANALYZE) + " " + good + " >/dev/full )")
                 .status == 3);
}

BOOST_AUTO_TEST_CASE(writes_pictures) {
  const Scratch folder;
  const auto check_pictures = [&](const std::string& arguments,
                                  std::initializer_list<const char*> names) {
    const std::string pictures = (folder.path() / "pictures").string();
    const Outcome outcome = run(arguments + " --plot " + pictures);
    BOOST_TEST(outcome.status == 0, outcome.err);
    for (const char* const name : names) {
      const std::string path = std::string("pictures/") + name;
      BOOST_TEST(folder.read(path + ".svg").find("<svg") != std::string::npos, name);
      BOOST_TEST(folder.read(path + ".png").substr(1, 3) == "PNG", name);
    }
  };
  check_pictures(scene("cardan_gyro_springs") + " --campbell rotor --speeds 0:100:21",
                 {"roots", "campbell"});
  const json p{{"A", "1.1"}, {"B", "0.9"}, {"C", "0.5"}, {"ca", "1"}, {"cb", "1"}, {"Om", "1.4"}};
  check_pictures(
      folder.write("rotor.toml", unsymmetric_rotor(p)).string() + " --period 2.2439947525641379",
      {"multipliers"});
}

BOOST_AUTO_TEST_SUITE_END()
