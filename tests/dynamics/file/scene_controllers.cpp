// Controllers of scene files: what is read, against closed forms, and what is refused.

#include <boost/test/unit_test.hpp>

#include <algorithm>
#include <cmath>
#include <complex>
#include <string>

#include <dynamics/decompositions.hpp>
#include <dynamics/file/columns.hpp>
#include <dynamics/file/model.hpp>
#include <dynamics/file/plant.hpp>
#include <dynamics/file/readings.hpp>
#include <dynamics/file/study_system.hpp>
#include <dynamics/study/margins.hpp>

#include <support/scene_text.hpp>

using namespace kreisel;
using test::body;
using test::end;
using test::mistakes;
using test::scene;

namespace {

const std::string hinge = "{ kind = \"revolute\", axis = [0, 0, 1] }";
const std::string arm = body("arm", hinge, "initial = { angle = 0.3 }");  // 0.5 kg m^2
const std::string pickoff = "[[sensor]]\nname = \"pickoff\"\nkind = \"joint\"\njoint = \"arm\"\n";
const std::string run_part = "[solve]\nt_end = 2\ntolerance = 1e-11\noutput_step = 0.5\n";

std::string controller(const std::string& keys) {
  return "[[controller]]\nname = \"servo\"\n" + keys + "\n";
}

const std::string connected = "reads = [\"pickoff.angle\"]\ndrives = [\"arm\"]\n";
const std::string spring = "law = { kind = \"pid\", proportional = 2 }\n";

std::string servo(const std::string& keys = spring) {
  return arm + pickoff + controller(connected + keys) + run_part;
}

/// The last row of a scene's run: joints, then sensors and controllers.
std::vector<double> last_readings(const std::string& text) {
  const SceneFile file = scene(text);
  const auto model = make_model(file);
  const auto run = model->solve(options_of(file), start_of(file));
  SensorReadings readings(file);
  std::vector<double> row;
  for (std::size_t i = 0; i < run.times.size(); ++i) {
    row = readings.row(*model, run.times[i], run.states[i]);
  }
  return row;
}

}  // namespace

BOOST_AUTO_TEST_SUITE(controllers_of_a_scene_file)

BOOST_AUTO_TEST_CASE(a_proportional_law_is_a_spring) {
  const double w = 2;  // sqrt(2 N m/rad / 0.5 kg m^2)
  BOOST_TEST(std::abs(end(servo()).coordinates[0] - 0.3 * std::cos(w * 2)) < 1e-11);
  const auto with_units = servo("law = { kind = \"pid\", proportional = \"2 N m/rad\" }");
  BOOST_TEST(std::abs(end(with_units).coordinates[0] - 0.3 * std::cos(w * 2)) < 1e-11);
}

BOOST_AUTO_TEST_CASE(outputs_are_columns) {
  const SceneFile file = scene(servo());
  const auto names = columns(file);
  BOOST_TEST(names.back() == "servo.arm");
  const auto row = last_readings(servo());
  BOOST_TEST(std::abs(row.back() + 2 * 0.3 * std::cos(4)) < 1e-10);
}

// The row of a sample has the memory before it and the output after it.
BOOST_AUTO_TEST_CASE(rows_have_the_memory) {
  const SceneFile file = scene(servo(spring + "period = 0.5\n"));
  const auto names = columns(file);
  const auto at = std::find(names.begin(), names.end(), "memory.servo output arm") - names.begin();
  BOOST_TEST_REQUIRE(at == 3);
  const auto model = make_model(file);
  const auto run = model->solve(options_of(file), start_of(file));
  for (std::size_t i = 1; i < run.times.size(); ++i) {
    const auto numbers = row(*model, run.times[i], run.states[i], {});
    BOOST_TEST(numbers[3] == -2 * run.states[i - 1].coordinates[0]);
    BOOST_TEST(model->kinematics(run.times[i], run.states[i]).outputs[0][0] ==
               -2 * run.states[i].coordinates[0]);
    BOOST_TEST((state_of(*model, numbers).memory - run.states[i].memory).isZero(0));
  }
}

BOOST_AUTO_TEST_CASE(a_reference_steps_the_loop) {
  const auto text = servo(spring + "reference = { steps = [[0, 0.3], [1, 0]] }\n");
  BOOST_TEST(std::abs(end(text).coordinates[0] - 0.3 * std::cos(2)) < 1e-11);
}

BOOST_AUTO_TEST_CASE(names_of_sensors_stand_for_columns) {
  const std::string law = "law = { kind = \"state-space\", D = [[2, 0.1]] }\n";
  const auto all =
      arm + pickoff + controller("reads = [\"pickoff\"]\ndrives = [\"arm\"]\n" + law) + run_part;
  const auto each = arm + pickoff +
                    controller(
                        "reads = [\"pickoff.angle\", \"pickoff.rate\"]\n"
                        "drives = [\"arm\"]\n" +
                        law) +
                    run_part;
  BOOST_TEST(end(all).coordinates[0] == end(each).coordinates[0]);
  const auto pid =
      arm + pickoff + controller("reads = [\"pickoff\"]\ndrives = [\"arm\"]\n" + spring) + run_part;
  BOOST_TEST(end(pid).coordinates[0] == end(servo()).coordinates[0]);
}

// A rotor with friction, 0.02 N m s, driven to a speed: the rate of a first-order loop.
BOOST_AUTO_TEST_CASE(a_regulator_drives_a_rotor) {
  const auto text =
      body("wheel", hinge, "damping = 0.02\nrotor = { mode = \"torque\", torque = 0 }\n") +
      "[[sensor]]\nname = \"tacho\"\nkind = \"joint\"\njoint = \"wheel\"\n" +
      controller(
          "reads = [\"tacho.rate\"]\ndrives = [\"wheel\"]\nreference = 100\n"
          "law = { kind = \"pid\", proportional = 0.4 }\n") +
      run_part;
  const double expected = 40 / 0.42 * (1 - std::exp(-0.42 / 0.5 * 2));
  BOOST_TEST(std::abs(end(text).rates[0] - expected) < 1e-9);
}

// A thruster brakes a body that flies and spins: w = w_0 exp(-k t/J).
BOOST_AUTO_TEST_CASE(a_thruster_brakes_a_spin) {
  const auto text =
      body("bus", "{ kind = \"free\" }", "initial = { angular_velocity = [0, 0, 0.8] }") +
      "[[sensor]]\nname = \"gyro\"\nkind = \"gyro\"\nbody = \"bus\"\n" +
      controller("reads = [\"gyro.z\"]\ndrives = [\"load.bus.torque.z\"]\n" + spring) + run_part;
  BOOST_TEST(std::abs(end(text).rates[2] - 0.8 * std::exp(-2 / 0.5 * 2)) < 1e-11);
  const auto row = last_readings(text);
  BOOST_TEST(std::abs(row.back() + 2 * end(text).rates[2]) < 1e-11);
}

// A winch under a controller: m L'' = m g - k (L - l), l = 1.92 - 0.3 (L - 2). The rope stays taut.
BOOST_AUTO_TEST_CASE(a_winch_follows_its_controller) {
  const auto text =
      body("load", "{ kind = \"prismatic\", axis = [0, 0, 1] }",
           "initial = { displacement = -2 }") +
      "[gravity]\nkind = \"inertial\"\nvector = [0, 0, -9.81]\n"
      "[[element]]\nname = \"hoist\"\nkind = \"rope\"\nbetween = [\"guide\", \"load\"]\n"
      "stiffness = 400\nlength = 1.92\n"
      "[[sensor]]\nname = \"height\"\nkind = \"joint\"\njoint = \"load\"\n" +
      controller(
          "reads = [\"height.displacement\"]\ndrives = [\"hoist\"]\nreference = -2\n"
          "law = { kind = \"pid\", proportional = -0.3 }\n") +
      run_part;
  const double middle = (2.52 + 9.81 / 200) / 1.3;
  const double expected = middle + (2 - middle) * std::cos(std::sqrt(260) * 2);
  BOOST_TEST(std::abs(end(text).coordinates[0] + expected) < 1e-11);
  const auto row = last_readings(text);
  BOOST_TEST(std::abs(row.back() + 0.3 * (expected - 2)) < 1e-11);
}

BOOST_AUTO_TEST_CASE(increments_follow_a_sampled_loop) {
  const std::string imu =
      "[[sensor]]\nname = \"imu\"\nkind = \"gyro\"\nbody = \"arm\"\n"
      "period = 0.5\nincrements = true\n";
  const auto text = arm + pickoff + imu + controller(connected + spring + "period = 0.2\n") +
                    "[solve]\nt_end = 2\ntolerance = 1e-11\n";
  const SceneFile file = scene(text);
  const auto model = make_model(file);
  const auto run = model->solve(options_of(file), start_of(file));
  SensorReadings readings(file);
  double sum = 0;
  for (std::size_t i = 0; i < run.times.size(); ++i) {
    const auto row = readings.row(*model, run.times[i], run.states[i]);
    const auto sensor = columns(file);
    const auto at = std::find(sensor.begin(), sensor.end(), "imu.dtheta z") - sensor.begin();
    // After t, angle, rate and the held output.
    sum += row[static_cast<std::size_t>(at) - 4];
  }
  BOOST_TEST(std::abs(run.states.back().coordinates[0] - 0.3 - sum) < 1e-11);
}

// J q'' = -2 q - 0.3 q' + d, with the reference r: 2 r + 0.3 r'.
BOOST_AUTO_TEST_CASE(a_plant_responds_by_its_formula) {
  using Complex = std::complex<double>;
  const SceneFile file =
      scene(servo("law = { kind = \"pid\", proportional = 2, derivative = 0.3, "
                  "filter = 0.01 }\n"));
  const StudySystem system(file);
  const Eigen::VectorXd rest = Eigen::VectorXd::Zero(3);
  const auto plant =
      system.plant(system.begin(), rest,
                   {plant_input(file, "joint.arm"), plant_input(file, "servo.reference"),
                    plant_input(file, "load.arm.torque.z"), plant_input(file, "guide.yaw"),
                    plant_input(file, "guide.angular_velocity.z")},
                   {plant_output(file, "arm.angle"), plant_output(file, "servo.arm")});
  for (const double w : {0.1, 1.0, 2.0, 30.0}) {
    const Complex s(0, w);
    const Complex law = 2.0 + 0.3 * s / (1.0 + 0.01 * s);
    const Complex open = 0.5 * s * s;
    const auto H = plant.response(w);
    const auto is_near = [](Complex a, Complex b) { return std::abs(a - b) < 1e-13 * std::abs(b); };
    BOOST_TEST(is_near(H(0, 0), 1.0 / (open + law)));
    BOOST_TEST(is_near(H(1, 0), -law / (open + law)));
    BOOST_TEST(is_near(H(0, 1), law / (open + law)));
    BOOST_TEST(is_near(H(0, 2), 1.0 / (open + law)));
    BOOST_TEST(is_near(H(0, 3), -open / (open + law)));  // the guide turns away below the arm
    BOOST_TEST(is_near(H(0, 4), -open / s / (open + law)));
  }
  BOOST_CHECK_THROW((void)plant_input(file, "joint.leg"), InvalidInput);
  BOOST_CHECK_THROW((void)plant_output(file, "arm.torque"), InvalidInput);
  BOOST_CHECK_THROW((void)plant.response(0), InvalidInput);
}

// A pendulum with the moment J about its hinge. In gravity that does not turn with the guide it hangs
// still while the guide pitches; in gravity on guide axes it does not.
BOOST_AUTO_TEST_CASE(a_plant_responds_to_its_guide) {
  using Complex = std::complex<double>;
  const std::string rod =
      body("rod", "{ kind = \"revolute\", axis = [0, 1, 0] }", "centre = [0, 0, -0.4]\n") +
      "[[sensor]]\nname = \"force\"\nkind = \"accelerometer\"\n"
      "body = \"rod\"\n" +
      run_part;
  const double J = 0.3 + 2 * 0.16, g = 9.81, k = 2 * g * 0.4, w = 1.7;
  const Complex s(0, w);
  for (const std::string kind : {"inertial", "uniform"}) {
    const SceneFile file =
        scene(rod + "[gravity]\nkind = \"" + kind + "\"\nvector = [0, 0, -9.81]\n");
    const StudySystem system(file);
    const Eigen::VectorXd rest = Eigen::VectorXd::Zero(2);
    const auto H =
        system
            .plant(
                system.begin(), rest,
                {plant_input(file, "guide.pitch"), plant_input(file, "guide.origin_acceleration.x"),
                 plant_input(file, "load.rod.torque.y"), plant_input(file, "load.rod.force.x")},
                {plant_output(file, "rod.angle"), plant_output(file, "force.x")})
            .response(w);
    const auto is_near = [](Complex a, Complex b) { return std::abs(a - b) < 1e-13; };
    const Complex open = J * s * s + k;
    BOOST_TEST(is_near(H(0, 0), kind == "inertial" ? -1.0 : -J * s * s / open));
    BOOST_TEST(is_near(H(0, 1), 0.8 / open));
    BOOST_TEST(is_near(H(1, 1), 1.0 - g * 0.8 / open));
    BOOST_TEST(is_near(H(0, 2), 1.0 / open));
    BOOST_TEST(is_near(H(0, 3), 0.0));
  }
}

// A run over many periods has the regime of the plant: its first harmonic is the mean over one
// period of the sine.
BOOST_AUTO_TEST_CASE(a_sampled_plant_responds_as_a_run) {
  const auto keys =
      "law = { kind = \"pid\", proportional = 2, derivative = 1, filter = 0.1 }\n"
      "period = 0.25\n";
  const SceneFile file = scene(servo(keys));
  const StudySystem system(file);
  const Eigen::VectorXd rest = Eigen::VectorXd::Zero(system.start_of(file).size());
  const auto plant = system.plant(system.begin(), rest, {plant_input(file, "servo.reference")},
                                  {plant_output(file, "arm.angle")});
  // A period of the sine is eight samples, so the regime repeats.
  const double w = M_PI;
  const std::complex<double> H = plant.response(w)(0, 0);
  const auto sine =
      "reference = { terms = [{ amplitude = 0.2, frequency = 3.141592653589793 }] }\n";
  const SceneFile driven =
      scene(arm + pickoff + controller(connected + keys + sine) +
            "[solve]\nt_begin = 0\nt_end = 102\ntolerance = 1e-11\noutput_step = 0.0125\n");
  const auto run = make_model(driven)->solve(options_of(driven), start_of(driven));
  std::complex<double> mean = 0;
  constexpr int count = 160;  // of steps in the last 2 s; the regime is smooth enough for this mean
  for (int i = 0; i < count; ++i) {
    const auto at = run.times.size() - 1 - static_cast<std::size_t>(i);
    mean += run.states[at].coordinates[0] * std::exp(std::complex<double>(0, -w * run.times[at])) *
            (2.0 / count);
  }
  // The response to 0.2 sin(w t) is 0.2 Im(H e^(i w t)).
  const std::complex<double> found = mean * std::complex<double>(0, 1) / 0.2;
  BOOST_TEST(std::abs(found - H) < 1e-5 * std::abs(H));
}

// L = 2/(0.5 s^2) (1 + 0.15 s)/(1 + 0.01 s) ..: margins against their own equations.
BOOST_AUTO_TEST_CASE(margins_fulfil_their_equations) {
  using Complex = std::complex<double>;
  const auto loop = [](double w) {
    const Complex s(0, w);
    return 3.0 / (s * (1.0 + 0.2 * s) * (1.0 + 0.05 * s));
  };
  std::vector<double> grid;
  for (double w = 0.1; w < 100; w *= 1.1) grid.push_back(w);
  const LoopMargins margins = loop_margins(loop, grid);
  BOOST_TEST_REQUIRE((margins.phase.has_value() && margins.gain.has_value()));
  // -180 degrees where w^2 = 1/(0.2 0.05), gain there 3 0.2 0.05/(0.2 + 0.05).
  BOOST_TEST(std::abs(margins.gain->frequency - 10) < 1e-11);
  BOOST_TEST(std::abs(margins.gain->margin - 0.25 / 0.03) < 1e-10);
  const double w = margins.phase->frequency;
  BOOST_TEST(std::abs(9.0 / (w * w * (1 + 0.04 * w * w) * (1 + 0.0025 * w * w)) - 1) < 1e-12);
  BOOST_TEST(std::abs(margins.phase->margin -
                      (M_PI / 2 - std::atan(0.2 * w) - std::atan(0.05 * w))) < 1e-12);
  // A coarse grid hides no crossing.
  const LoopMargins coarse = loop_margins(loop, {0.1, 3, 100});
  BOOST_TEST_REQUIRE((coarse.phase.has_value() && coarse.gain.has_value()));
  BOOST_TEST(std::abs(coarse.gain->frequency - 10) < 1e-11);
  const auto twice = [](double at) { return Complex(-1 / at, (at - 20) * (at - 30)); };
  BOOST_TEST(loop_margins(twice, {10, 100}).gain.has_value());
  const auto lag = [](double x) { return 1.0 / Complex(1, x / 7); };
  BOOST_TEST(std::abs(*bandwidth(lag, grid) - 7 * std::sqrt(1 + 0.02 / 49)) < 1e-3);
}

BOOST_AUTO_TEST_CASE(mistakes_are_told) {
  const auto told = [](const std::string& text, const std::string& part) {
    const std::string found = mistakes(text);
    BOOST_TEST(found.find(part) != std::string::npos, found);
  };
  const auto with = [](const std::string& keys) {
    return arm + pickoff + controller(keys) + run_part;
  };
  told(with(""), "reads");
  told(with("reads = [\"pikoff.angle\"]\ndrives = [\"arm\"]\n" + spring), "did you mean");
  told(with("reads = [\"pickoff.angle\"]\ndrives = [\"leg\"]\n" + spring), "no body");
  told(with("reads = [\"pickoff.angle\"]\ndrives = [\"load.arm.torque.u\"]\n" + spring),
       "did you mean");
  told(with(connected), "law");
  told(with(connected + "law = { kind = \"bang\" }\n"), "law.kind");
  told(with(connected + "law = { kind = \"pid\" }\n"), "proportional");
  told(with(connected + "law = { kind = \"pid\", derivative = 1 }\n"), "filter");
  told(with(connected + "law = { kind = \"pid\", proportional = \"2 N\" }\n"), "proportional");
  told(with(connected + "law = { kind = \"state-space\", D = [[1, 2]] }\n"), "1 columns");
  told(with(connected + "law = { kind = \"state-space\", D = [[1], [2, 3]] }\n"), "list of rows");
  told(with(connected + "law = { kind = \"state-space\" }\n"), "D");
  told(with(connected + spring + "delay = 0.1\n"), "period");
  told(with(connected + spring + "limit = -1\n"), "above 0");
  told(with(connected + spring + "gain = 3\n"), "gain");
  const std::string wheel = body("wheel", hinge, "rotor = { mode = \"free\", speed = 3 }\n");
  told(arm + wheel +
           "[[sensor]]\nname = \"s\"\nkind = \"attitude\"\nbody = \"arm\"\n"
           "against = \"wheel\"\nas = \"yaw pitch roll\"\n" +
           controller("reads = [\"s.yaw\"]\ndrives = [\"arm\"]\n" + spring) + run_part,
       "the rotor 'wheel'");
  told(with("reads = [\"pickoff\"]\ndrives = [\"arm\", \"arm\"]\n" + spring), "twice");
  told(with("reads = [\"pickoff.angle\", \"pickoff.rate\"]\ndrives = [\"arm\"]\n" + spring),
       "one reading for each");
  told(arm + pickoff + controller(connected + spring) + controller(connected + spring) + run_part,
       "used by an earlier");
  told(servo() + "model = \"linear\"\n", "exact");
  const std::string imu = "[[sensor]]\nname = \"imu\"\nkind = \"accelerometer\"\nbody = \"arm\"\n";
  told(arm + imu +
           controller("reads = [\"imu.x\"]\ndrives = [\"arm\"]\n"
                      "law = { kind = \"pid\", proportional = 1 }\n") +
           run_part,
       "accelerations");
  told(arm + imu + "bias = 1\n" +
           controller("reads = [\"imu.x\"]\ndrives = [\"arm\"]\n"
                      "law = { kind = \"pid\", integral = 1 }\n") +
           run_part,
       "true x");
  told(arm + imu + "bias = 1\n" +
           controller("reads = [\"imu.z\"]\ndrives = [\"arm\"]\n"
                      "law = { kind = \"pid\", integral = 1 }\n") +
           run_part,
       "'imu.true z'");
}

BOOST_AUTO_TEST_SUITE_END()
