// Functions of time in scene files: their meaning, and what is refused.

#include <boost/test/unit_test.hpp>

#include <cmath>
#include <random>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <dynamics/file/joints.hpp>
#include <dynamics/file/log_error.hpp>
#include <dynamics/file/model.hpp>
#include <dynamics/file/scene_system.hpp>

#include <support/scene_text.hpp>
#include <support/scratch.hpp>

using namespace kreisel;
using test::mistakes;
using test::scene;

namespace {

const std::string run = "[solve]\nt_end = 4\n";

/// A body in a joint, and other keys of it.
std::string body(const std::string& keys,
                 const std::string& joint = "{ kind = \"revolute\", axis = [0, 0, 1] }") {
  return "[[body]]\nname = \"a\"\njoint = " + joint + "\nmass = 2\ninertia = [1, 1, 1]\n" + keys +
         "\n" + run;
}

std::string guide(const std::string& keys) {
  return "[guide]\nkind = \"motion\"\n" + keys + "\n" + body("");
}

/// The first rate at the end of a run.
double end_rate(const std::string& text) {
  const auto motion = run_scene(scene(text));
  BOOST_TEST(motion.report.tolerance_kept);
  return motion.states.back().rates[0];
}

/// A scene beside a log of 0.3 sin(2 t): one number, or a vector along z. Rows are 20 ms apart.
class Logged {
 public:
  explicit Logged(bool is_number, double noise = 0, unsigned seed = 1) {
    std::mt19937 engine(seed);
    std::ostringstream text;
    text.precision(17);
    text << (is_number ? "t,value,turn [deg]\n" : "t,a,b,c\n");
    for (int i = -10; i <= 210; ++i) {
      double off = 0;
      for (int k = 0; k < 12; ++k) off += static_cast<double>(engine()) * 0x1p-32 - 0.5;
      const double t = 0.02 * i;
      const double value = 0.3 * std::sin(2 * t) + noise * off;
      text << t << (is_number ? "," : ",0,0,") << value << (is_number ? ",0\n" : "\n");
    }
    (void)folder_.write("log.csv", text.str());
  }

  [[nodiscard]] SceneFile scene(const std::string& text) const {
    return parse_scene(text, folder_.path() / "s.toml");
  }

 private:
  test::Scratch folder_;
};

const std::string slide = "{ kind = \"prismatic\", axis = [0, 0, 1] }";
const std::string universal = "{ kind = \"universal\", axis = [0, 0, 1], second_axis = [1, 0, 0] }";

}  // namespace

BOOST_AUTO_TEST_SUITE(signals_of_a_scene_file)

BOOST_AUTO_TEST_CASE(constants_are_what_they_were) {
  const SceneFile plain = scene(body("force = 3"));
  BOOST_TEST(plain.bodies[0].forces[0].constant == 3);
  BOOST_TEST(!plain.bodies[0].forces[0].in_time);
  BOOST_TEST(!plain.forces_change);
  const SceneFile table = scene(body("force = { constant = 3 }"));
  BOOST_TEST(table.bodies[0].forces[0].constant == 3);
  BOOST_TEST(!table.bodies[0].forces[0].in_time);
  BOOST_TEST(!table.forces_change);
  BOOST_TEST(!scene(body("load = { force = { constant = [1, 0, 0] } }")).forces_change);
}

BOOST_AUTO_TEST_CASE(joint_force_is_their_sum) {
  const SceneFile file = scene(body(
      "force = { constant = 1, rate = 2, terms = [{ amplitude = 3, frequency = 4, phase_deg = 90 "
      "}] }"));
  const auto& signal = file.bodies[0].forces[0].in_time;
  BOOST_TEST_REQUIRE(signal.has_value());
  BOOST_TEST(std::abs((*signal)(0.3) - (1 + 0.6 + 3 * std::cos(1.2))) <= 1e-15);
  BOOST_TEST(file.forces_change);
  BOOST_TEST(file.discontinuities.empty());
}

BOOST_AUTO_TEST_CASE(jumps_are_met_without_being_declared) {
  const SceneFile file = scene(body("force = { steps = [[-1, 5], [1, 0.2], [3, 0], [9, 1]] }"));
  BOOST_TEST(file.discontinuities == (std::vector<double>{1, 3}), boost::test_tools::per_element());
  const std::string text = body("force = { steps = [[-1, 5], [1, 0.2], [3, 0], [9, 1]] }");
  BOOST_TEST(std::abs(end_rate(text) - (5 + 0.4)) <= 1e-10);
  for (const char* const method : {"taylor", "verner98", "radau13"}) {
    const std::string by = text + "method = \"" + method + "\"\ntolerance = 1e-13\n";
    BOOST_TEST(std::abs(end_rate(by) - 5.4) <= 1e-12, method);
  }
}

BOOST_AUTO_TEST_CASE(broken_line_pushes_a_slide) {
  BOOST_TEST(std::abs(end_rate(body("force = { points = [[1, 0], [2, 3]] }", slide)) -
                      (1.5 + 6) / 2) <= 1e-10);
}

BOOST_AUTO_TEST_CASE(universal_joint_takes_a_list) {
  const SceneFile file = scene(body("force = [2, { steps = [[1, 7]] }]", universal));
  BOOST_TEST(file.bodies[0].forces[0].constant == 2);
  BOOST_TEST((*file.bodies[0].forces[1].in_time)(1.0) == 7);
  const SceneFile both = scene(body("force = { rate = 2 }", universal));
  BOOST_TEST((*both.bodies[0].forces[0].in_time)(1.0) == 2);
  BOOST_TEST((*both.bodies[0].forces[1].in_time)(1.0) == 2);
}

BOOST_AUTO_TEST_CASE(loads_push_and_turn) {
  const std::string text = "{ kind = \"free\" }";
  const std::string load =
      "load = { force = { steps = [[1, [0, 0, 6]]] }, torque = { rate = [0, 0, 0.5] }, axes = "
      "\"guide\" }";
  const auto motion = run_scene(scene(body(load, text)));
  const Eigen::VectorXd& rates = motion.states.back().rates;
  BOOST_TEST(std::abs(rates[5] - 6 * 3 / 2.0) <= 1e-9);
  BOOST_TEST(std::abs(rates[2] - 0.5 * 16 / 2) <= 1e-9);
}

BOOST_AUTO_TEST_CASE(rotor_takes_torque_or_speed) {
  const SceneFile driven =
      scene(body("rotor = { mode = \"torque\", torque = { steps = [[1, 0.5]] } }"));
  BOOST_TEST((*driven.bodies[0].forces[0].in_time)(2.0) == 0.5);
  BOOST_TEST(driven.bodies[0].rotor->torque == 0);
  const std::string speed =
      "rotor = { mode = \"regulated\", speed_deg = { points = [[1, 360], [2, 720]] } }";
  const SceneFile regulated = scene(body(speed));
  const double turn = 360 * 0.017453292519943295;
  BOOST_TEST(regulated.start[0].rates[0] == turn);
  BOOST_TEST(regulated.bodies[0].rotor->acceleration(1.5) == turn);
  BOOST_TEST(std::abs(end_rate(body(speed)) - 2 * turn) <= 1e-9);
}

BOOST_AUTO_TEST_CASE(drive_prescribes_angle_or_rate) {
  const std::string swing =
      body("drive = { angle = { terms = [{ amplitude = 0.3, frequency = 2, phase_deg = 90 }] } }");
  const SceneFile file = scene(swing);
  BOOST_TEST((file.bodies[0].rule == JointRule::driven));
  BOOST_TEST(file.start[0].coordinates[0] == 0.3);
  BOOST_TEST(std::abs(file.bodies[0].acceleration(0.4) + 1.2 * std::cos(0.8)) <= 1e-15);
  BOOST_TEST(std::abs(end_rate(swing) + 0.6 * std::sin(8.0)) <= 1e-9);
  const std::string command =
      body("initial = { angle = 0.5 }\ndrive = { rate_deg = { points = [[1, 0], [2, 90]] } }");
  BOOST_TEST(scene(command).start[0].coordinates[0] == 0.5);
  BOOST_TEST(std::abs(end_rate(command) - 90 * 0.017453292519943295) <= 1e-9);
  const std::string lift = body("drive = { displacement = { rate = 0.2 } }", slide);
  BOOST_TEST(scene(lift).start[0].rates[0] == 0.2);
  BOOST_TEST(end_rate(lift) == 0.2);
}

BOOST_AUTO_TEST_CASE(guide_moves_as_its_signals) {
  const SceneFile file = scene(
      guide("position = { rate = [1, 0, 0], terms = [{ amplitude = [0, 0, 2], frequency = 3 }] }\n"
            "angles = { yaw_deg = 90, roll = { terms = [{ amplitude = 0.3, frequency = 2 }] } }"));
  const auto now = make_guide(file)(0.4);
  const Vector3<double> place(0.4, 0, 2 * std::sin(1.2));
  BOOST_TEST((now.X.value.translation - place).norm() <= 1e-15);
  const double roll = 0.3 * std::sin(0.8);
  Matrix3<double> R;
  R << 0, -std::cos(roll), std::sin(roll), 1, 0, 0, 0, std::sin(roll), std::cos(roll);
  BOOST_TEST((now.X.value.rotation - R).norm() <= 1e-15);
  BOOST_TEST(std::abs(now.V.value.resultant.x() - 0.6 * std::cos(0.8)) <= 1e-15);
  BOOST_TEST(make_guide(file).knows_series());
}

BOOST_AUTO_TEST_CASE(guide_is_a_link_of_chains) {
  const std::string chain =
      "[guide]\nkind = \"chain\"\nlinks = [\n"
      "  { kind = \"rotating\", angular_velocity = [0, 0, 0.5] },\n"
      "  { kind = \"motion\", position = { terms = [{ amplitude = [1, 0, 0], frequency = 2 }] } "
      "},\n"
      "]\n";
  const auto now = make_guide(scene(chain + body("")))(0.7);
  const double x = std::sin(1.4);
  BOOST_TEST(
      (now.X.value.translation - x * Vector3<double>(std::cos(0.35), std::sin(0.35), 0)).norm() <=
      1e-15);
  // v' = x', and Coriolis: the acceleration on the rotated axes is x'' - w^2 x, 2 w x'.
  const Vector3<double> a(-4 * x - 0.25 * x, 2 * 0.5 * 2 * std::cos(1.4), 0);
  BOOST_TEST((now.origin_acceleration() - a).norm() <= 1e-14);
}

// 0.3 sin(2 t) at every 20 ms, beyond both ends of the run.
BOOST_AUTO_TEST_CASE(log_is_a_function_of_time) {
  const Logged number(true);
  const SceneFile pushed = number.scene(body("force = { file = \"log.csv\" }"));
  BOOST_TEST(pushed.forces_change);
  BOOST_TEST(pushed.discontinuities.empty());
  BOOST_TEST(pushed.log_files().size() == 1U);
  BOOST_TEST(!pushed.guide_follows_log());
  const auto run = run_scene(pushed);
  BOOST_TEST(run.report.tolerance_kept);
  BOOST_TEST(run.report.method != "taylor");
  BOOST_TEST(std::abs(run.states.back().rates[0] - 0.15 * (1 - std::cos(8.0))) <= 1e-10);
  const Logged vector(false);
  const auto thrown = run_scene(vector.scene(body(
      "load = { force = { file = \"log.csv\", columns = { t = \"t\", x = \"a\", y = \"b\", z = "
      "\"c\" } }, axes = \"guide\" }",
      "{ kind = \"free\" }")));
  BOOST_TEST(std::abs(thrown.states.back().rates[5] - 0.075 * (1 - std::cos(8.0))) <= 1e-10);
}

BOOST_AUTO_TEST_CASE(log_prescribes_a_motion) {
  const Logged log(true);
  const SceneFile swing = log.scene(body("drive = { angle = { file = \"log.csv\" } }"));
  BOOST_TEST(std::abs(swing.start[0].coordinates[0]) <= 1e-12);
  BOOST_TEST(std::abs(swing.start[0].rates[0] - 0.6) <= 1e-9);
  const auto state = run_scene(swing).states.back();
  BOOST_TEST(std::abs(state.coordinates[0] - 0.3 * std::sin(8.0)) <= 1e-9);
  const std::string degrees =
      body("drive = { angle = { file = \"log.csv\", angles = \"deg\", sigma = \"0 rad\" } }");
  BOOST_TEST(std::abs(log.scene(degrees).start[0].rates[0] - 0.6 * 0.017453292519943295) <= 1e-10);
  const std::string rolls = "angles = { roll = { file = \"log.csv\" } }";
  const SceneGuide rolling = make_guide(log.scene(guide(rolls)));
  BOOST_TEST(!rolling.knows_series());
  const auto now = rolling(0.4);
  BOOST_TEST(std::abs(now.V.value.resultant.x() - 0.6 * std::cos(0.8)) <= 1e-8);
  BOOST_TEST(std::abs(now.dV.value.resultant.x() + 1.2 * std::sin(0.8)) <= 1e-6);
}

// White noise of a torque: the rate's error is its integral.
BOOST_AUTO_TEST_CASE(error_of_a_log_is_estimated) {
  for (const unsigned seed : {1U, 2U, 3U}) {
    const Logged log(true, 0.01, seed);
    const SceneFile file = log.scene(body("force = { file = \"log.csv\" }"));
    const auto model = make_model(file);
    const auto run = model->solve(options_of(file), start_of(file));
    const auto error = error_of_logs(file, *model, run, {});
    BOOST_TEST_REQUIRE(error.has_value());
    const double off = std::abs(run.states.back().rates[0] - 0.15 * (1 - std::cos(8.0)));
    // Twice the standard deviation: 0.01 sqrt(0.02 s 4 s)/2.
    const double estimate = error->joints[0].rates[0];
    BOOST_TEST(estimate >= 0.5 * 0.01 * std::sqrt(0.08));
    BOOST_TEST(estimate <= 3 * 0.01 * std::sqrt(0.08));
    BOOST_TEST(off <= 1.5 * estimate);
  }
}

BOOST_AUTO_TEST_CASE(mistakes_in_logs_are_reported) {
  const Logged log(true);
  const std::pair<std::string, std::string> cases[] = {
      {body("force = { file = \"none.csv\" }"), "none.csv: cannot be read"},
      {body("force = { file = 3 }"), "a'.force.file: must be a text, not a whole number"},
      {body("force = { file = \"\" }"), "a'.force.file: is empty"},
      {body("force = { file = \"log.csv\", rate = 2 }"),
       "a'.force.file: is given beside 'rate'; one of them says what the signal is"},
      {body("force = { file = \"log.csv\", column = 2 }"), "a'.force.column: is no key here"},
      {body("force = { file = \"log.csv\", columns = { x = 2 } }"),
       "a'.force.columns.x: is no key here"},
      {body("force = { file = \"log.csv\", sigma = -1 }"),
       "a'.force.sigma: -1 must not be below 0"},
      {body("force = { file = \"log.csv\", time_zero = 1 }"),
       "a'.force.file: 'log.csv' ends at t = 3.2 s, the run at t = 4 s: give  t_end = 3.2  in "
       "[solve]"},
      {body("force = { file = \"log.csv\", columns = { t = \"t\", value = \"turn [deg]\" } }"),
       "is in deg, and is read in SI units"},
      {body("load = { torque = { file = \"log.csv\" } }"), "a'.load.torque.file: "},
      {body("drive = { angle = { file = \"log.csv\", columns = { t = \"t\", value = \"turn [deg]\" "
            "} "
            "} }"),
       "a'.drive.angle.file: "},
  };
  for (const auto& [text, reason] : cases) {
    std::string found = "none";
    try {
      (void)log.scene(text);
    } catch (const SceneMistakes& error) {
      found = error.what();
    }
    BOOST_TEST(found.find(reason) != std::string::npos, "wanted " << reason << "\nfound " << found);
  }
}

BOOST_AUTO_TEST_CASE(mistakes_are_reported) {
  const std::pair<std::string, std::string> cases[] = {
      {body("force = {}"),
       "s.toml:6:9: body 'a'.force: is a function of time: give 'constant', 'rate' and 'terms', or "
       "'steps', 'points' or 'file'"},
      {body("force = { steps = [] }"), "s.toml:6:19: body 'a'.force.steps: is empty"},
      {body("force = { steps = 3 }"),
       "s.toml:6:19: body 'a'.force.steps: must be a list of [time, value]"},
      {body("force = { steps = [[0, 1], [2]] }"),
       "s.toml:6:28: body 'a'.force.steps[1]: must be [time, value]"},
      {body("force = { steps = [[0, 1], [2, \"x\"]] }"),
       "s.toml:6:32: body 'a'.force.steps[1][1]: must be a number, not a text"},
      {body("force = { points = [[0, 1], [2, 3], [2, 4]] }"),
       "s.toml:6:37: body 'a'.force.points[2]: begins at 2 s, not after 2 s, the time before it"},
      {body("force = { points = [[0, 1]], steps = [[0, 1]] }"),
       "s.toml:6:38: body 'a'.force.steps: is given beside 'points'; one of them says what the "
       "signal is"},
      {body("force = { points = [[0, 1]], rate = 2 }"),
       "s.toml:6:20: body 'a'.force.points: is given beside 'rate'; one of them says what the "
       "signal is"},
      {body("force = { constnat = 1 }"),
       "s.toml:6:9: body 'a'.force: is a function of time: give 'constant', 'rate' and 'terms', or "
       "'steps', 'points' or 'file'"},
      {body("force = { rate = 1, constnat = 1 }"),
       "s.toml:6:21: body 'a'.force.constnat: is no key here (did you mean 'constant'?)"},
      {body("force = { terms = [{ amplitude = 1 }] }"),
       "s.toml:6:20: body 'a'.force.terms[0].frequency: is missing"},
      {body("force = { terms = [{ frequency = 1 }] }"),
       "s.toml:6:20: body 'a'.force.terms[0].amplitude: is missing"},
      {body("force = { terms = [{ amplitude = 1, frequency = -2 }] }"),
       "s.toml:6:49: body 'a'.force.terms[0].frequency: must not be below 0; the other direction "
       "is "
       "an 'amplitude' of the other sign"},
      {body("force = { terms = [{ amplitude = [1, 2, 3], frequency = 2 }] }"),
       "s.toml:6:34: body 'a'.force.terms[0].amplitude: must be a number, not a list"},
      {body("load = { force = { constant = [1, 2] } }"),
       "s.toml:6:31: body 'a'.load.force.constant: must be 3 numbers, not 2"},
      {body("load = { force = { steps = [[0, 1]] } }"),
       "s.toml:6:33: body 'a'.load.force.steps[0][1]: must be a list of numbers, not a whole "
       "number"},
      {body("load = { torque = { points = [[0, [1, 2]]] } }"),
       "s.toml:6:35: body 'a'.load.torque.points[0][1]: must be 3 numbers, not 2"},
      {body("force = [{ rate = 1 }]", universal),
       "s.toml:6:9: body 'a'.force: must be 2 numbers or functions of time"},
      {body("rotor = { mode = \"free\", speed = { rate = 1 } }"),
       "s.toml:6:34: body 'a'.rotor.speed: changes with time, which is for mode = 'regulated'"},
      {body("rotor = { mode = \"regulated\", speed = { steps = [[0, 1], [2, 3]] } }"),
       "s.toml:6:39: body 'a'.rotor.speed: jumps at t = 0 s, which takes an infinite torque; give "
       "'points'"},
      {body("load = { force = [1, 0, 0] }\nrotor = { mode = \"regulated\", speed = { rate = 1 } }"),
       "s.toml:7:39: body 'a'.rotor.speed: changes with time, which a rotor with a load cannot"},
      {body("force = { rate = 1 }\nrotor = { mode = \"torque\", torque = { rate = 1 } }"),
       "s.toml:7:37: body 'a'.rotor.torque: changes with time beside 'force'; one of them may"},
      {body("rotor = { mode = \"free\", speed = 1, torque = { rate = 1 } }"),
       "s.toml:6:46: body 'a'.rotor.torque: is for mode = 'torque'"},
      {body("drive = {}"),
       "s.toml:6:9: body 'a'.drive: is the motion of the joint: give 'angle' or 'rate'"},
      {body("drive = { angle = 1, rate = 2 }"),
       "s.toml:6:29: body 'a'.drive.rate: is given beside 'angle'; one of them is the motion"},
      {body("drive = { displacement = 1 }"),
       "s.toml:6:9: body 'a'.drive: is the motion of the joint: give 'angle' or 'rate'\n"
       "s.toml:6:11: body 'a'.drive.displacement: is no key here; allowed: 'angle', 'angle_deg', "
       "'rate' or 'rate_deg'"},
      {body("drive = { angle = { points = [[1, 0], [2, 1]] } }"),
       "s.toml:6:19: body 'a'.drive.angle: jumps, or its rate does, at t = 1 s, which takes an "
       "infinite force; give 'constant', 'rate' and 'terms'"},
      {body("drive = { rate = { steps = [[1, 2]] } }"),
       "s.toml:6:18: body 'a'.drive.rate: jumps, or its rate does, at t = 1 s, which takes an "
       "infinite force; give 'points'"},
      {body("initial = { angle = 1 }\ndrive = { angle = { constant = 2, rate = 1 } }"),
       "s.toml:6:21: body 'a'.initial.angle: differs from 'drive' at t = 0"},
      {body("initial = { rate_deg = 0 }\ndrive = { rate = 1 }"),
       "s.toml:6:24: body 'a'.initial.rate_deg: differs from 'drive' at t = 0"},
      {guide(""), "s.toml:1:1: guide.position: is missing"},
      {guide("position = { steps = [[1, [0, 0, 1]]] }"),
       "s.toml:3:12: guide.position: jumps, or its rate does, at t = 1 s, which takes an infinite "
       "force; give 'constant', 'rate' and 'terms'"},
      {guide("angles = { yaw_deg = { points = [[1, 0], [2, 3]] } }"),
       "s.toml:3:22: guide.angles.yaw_deg: jumps, or its rate does, at t = 1 s, which takes an "
       "infinite force; give 'constant', 'rate' and 'terms'"},
      {guide("angles = { jaw = 0.3 }"),
       "s.toml:3:12: guide.angles.jaw: is no key here (did you mean 'yaw'?)"},
      {guide("angles = { yaw = 1, yaw_deg = 2 }"),
       "s.toml:3:31: guide.angles.yaw_deg: is given in radian too, as 'yaw'"},
  };
  for (const auto& [text, expected] : cases) BOOST_TEST(mistakes(text) == expected, text);
}

BOOST_AUTO_TEST_SUITE_END()
