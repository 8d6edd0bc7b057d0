// docs/scene_files.md, sentence by sentence where tests/dynamics/file/scene_file.cpp has it not.

#include <boost/test/unit_test.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <dynamics/file/scene_system.hpp>
#include <dynamics/guide/harmonic.hpp>
#include <dynamics/guide/rotating.hpp>

#include <support/json.hpp>
#include <support/program.hpp>

using namespace kreisel;

namespace {

constexpr double degree = 0.017453292519943295;

const std::string hinge = "joint = { kind = \"revolute\", axis = [0, 1, 0] }\n";
const std::string universal =
    "joint = { kind = \"universal\", axis = [0, 1, 0], second_axis = [1, 0, 0] }\n";
const std::string ball = "joint = { kind = \"spherical\" }\n";
const std::string floating = "joint = { kind = \"free\" }\n";
const std::string weight = "[gravity]\nkind = \"uniform\"\nvector = [0, 0, -9.81]\n";

/// One body, whose keys come before all tables, and then the rest.
std::string one(const std::string& keys, const std::string& rest = "") {
  const bool has_inertia = keys.find("inertia") != std::string::npos;
  return "[[body]]\nname = \"a\"\nmass = 2\n" +
         std::string(has_inertia ? "" : "inertia = [0.2, 0.25, 0.3]\n") + keys + "\n" + rest +
         "[solve]\nt_end = 1\noutput_times = [1]\n";
}

SceneFile scene(const std::string& text) { return parse_scene(text, "s.toml"); }

std::string mistakes(const std::string& text) {
  try {
    (void)scene(text);
  } catch (const SceneMistakes& error) {
    return error.what();
  }
  return "none";
}

test::Outcome simulate(const std::string& text, const std::string& options = "") {
  const test::Scratch folder;
  return test::run(std::string(KREISEL_SIMULATE) + " " + folder.write("s.toml", text).string() +
                   " " + options);
}

/// The method that simulate chooses.
std::string method(const std::string& text) {
  const test::Outcome outcome = simulate(text, "--json");
  BOOST_TEST_REQUIRE(outcome.status == 0, text << outcome.err);
  return test::parsed(outcome.out).at("method").get<std::string>();
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

}  // namespace

BOOST_AUTO_TEST_SUITE(page_on_scene_files)

// "A key of an angle or of an angular rate may end in _deg instead".
BOOST_AUTO_TEST_CASE(angles_and_their_rates_in_degrees) {
  const auto start = [](const std::string& keys) { return scene(one(keys)).start.at(0); };
  BOOST_TEST(start(hinge + "initial = { angle_deg = 30, rate_deg = 60 }").coordinates.at(0) ==
             30 * degree);
  BOOST_TEST(start(hinge + "initial = { rate_deg = 60 }").rates.at(0) == 60 * degree);
  BOOST_TEST(start(universal + "initial = { angle_deg = [3, 4], rate_deg = [5, 6] }").rates.at(1) ==
             6 * degree);
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

// "The start of rotating and harmonic": against the frame before it, on its axes.
BOOST_AUTO_TEST_CASE(guides_begin_as_they_are_told) {
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

// "A heave given as acceleration a sin(w t) needs origin_velocity = -a/w": 0.6/0.49 up and down for
// an hour, and 3 km without it.
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
  // The velocity has six decimals: half of the last of them makes 2 mm in an hour.
  BOOST_TEST(std::abs(held - heave) <= 2e-3);
  BOOST_TEST(greatest("") > 3000);
}

// "of two coordinates a number for both or [a, b]; of a ball damping alone".
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
  BOOST_TEST(contains(mistakes(one(universal + "damping = -0.1")), "must not be below 0"));
  const auto of_ball = scene(one(ball + "damping = 0.3")).bodies.at(0).forces;
  BOOST_TEST(of_ball.size() == 3U);
  BOOST_TEST(of_ball.at(2).damping == 0.3);
  BOOST_TEST(contains(mistakes(one(ball + "force = 1")), "needs a single coordinate"));
  BOOST_TEST(contains(mistakes(one(ball + "damping = [1, 1, 1]")), "must be a number"));
}

// "Numbers that no mass can have": catalogue numbers rounded in the last digit.
BOOST_AUTO_TEST_CASE(rounded_inertia_is_told_the_nearest_legal) {
  const std::string told = mistakes(one("inertia = [0.0795775, 0.0795775, 0.1591551]\n" + hinge));
  const std::size_t begin = told.find("nearest legal tensor: [");
  BOOST_TEST_REQUIRE(begin != std::string::npos, told);
  BOOST_TEST(mistakes(one("inertia = " + told.substr(begin + 22) + "\n" + hinge)) == "none");
  BOOST_TEST(!contains(mistakes(one("inertia = [1, 1, 2.1]\n" + hinge)), "nearest"));
}

BOOST_AUTO_TEST_CASE(defaults_are_as_the_page_says) {
  const SceneFile file = scene("[[body]]\nname = \"a\"\nmass = 1\ninertia = [1, 1, 1]\n" + hinge +
                               "[solve]\nt_end = 5\n");
  BOOST_TEST(file.output_times.size() == 501U);
  BOOST_TEST(file.output_times.at(1) == 0.01);
  BOOST_TEST(file.tolerance == 1e-10);
  BOOST_TEST((file.method == Method::automatic));
  BOOST_TEST(file.bodies.at(0).parent == "guide");
  BOOST_TEST(file.start.at(0).coordinates.at(0) == 0);
  BOOST_TEST(std::holds_alternative<scene_gravity::None>(file.gravity));
  std::ptrdiff_t scenes = 0;
  for (const auto& entry : std::filesystem::directory_iterator(KREISEL_SCENES)) {
    scenes += entry.path().extension() == ".toml" ? 1 : 0;
  }
  BOOST_TEST(scenes == 19);
}

// "A scene that is no more than a pendulum or a top goes by its closed form under auto".
BOOST_AUTO_TEST_CASE(closed_forms_are_taken_where_there_are_some) {
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

// "All others go by the Taylor series of their motion, unless ..".
BOOST_AUTO_TEST_CASE(series_are_taken_where_they_are_known) {
  const std::string swung = hinge + "centre = [0, 0, -0.4]\ndamping = 0.1\n";
  const std::string turning = "[guide]\nkind = \"rotating\"\nangular_velocity = [0, 0, 1]\n";
  const std::string second =
      "[[body]]\nname = \"b\"\nparent = \"a\"\nmass = 1\ninertia = [1, 1, 1]\n";
  BOOST_TEST(method(one(swung, weight)) == "taylor");
  BOOST_TEST(method(one(swung, weight + turning)) == "taylor");
  BOOST_TEST(method(one(swung, second + hinge + weight)) == "taylor");
  BOOST_TEST(method(one(swung + "load = { torque = [0, 1, 0] }\n", weight)) != "taylor");
  BOOST_TEST(method(one(swung, second + floating + weight)) != "taylor");
  BOOST_TEST(method(one(swung,
                        "[guide]\nkind = \"chain\"\nlinks = [ { kind = \"rotating\", "
                        "angular_velocity = [0, 0, 1] }, { kind = \"rotating\", "
                        "angular_velocity = [0, 1, 0] } ]\n")) != "taylor");
  BOOST_TEST(method(one(swung,
                        "[guide]\nkind = \"earth\"\nlatitude_deg = 50\nheight = 0\n"
                        "azimuth_deg = 0\ngravity = \"normal\"\n")) != "taylor");
}

// "splitting is .. refused for scenes of a file", and models that do not fit, with the reason.
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

// "its torque is reported".
BOOST_AUTO_TEST_CASE(drives_report_their_torque) {
  const test::Outcome outcome = simulate(
      one(hinge + "centre = [0, 0, -0.4]\ndrive = \"constant-rate\"\ninitial = { rate = 1 }\n",
          weight),
      "--json");
  BOOST_TEST_REQUIRE(outcome.status == 0, outcome.err);
  // 2 kg at 0.4 m, lifted by sin(1): the torque that holds it against gravity.
  const double torque =
      test::parsed(outcome.out).at("final").at("joints").at("a").at("drive_torque").get<double>();
  BOOST_TEST(std::abs(torque - 2 * 9.81 * 0.4 * std::sin(1.0)) <= 1e-9);
}

BOOST_AUTO_TEST_SUITE_END()
