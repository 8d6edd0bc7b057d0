// Increments of the gyros and accelerometers of a scene.

#include <Eigen/Geometry>
#include <boost/test/unit_test.hpp>

#include <cmath>
#include <string>
#include <vector>

#include <dynamics/file/readings.hpp>
#include <dynamics/file/scene_file.hpp>
#include <motor/attitude.hpp>

#include <support/scene_text.hpp>

using namespace kreisel;
using test::scene;

namespace {

/// A strapdown unit on a ship in a seaway.
const std::string at_sea =
    "[guide]\nkind = \"motion\"\n"
    "position = { rate = [5, 0, 0], terms = [{ amplitude = [0, 0, 1.5], frequency = 0.6 }] }\n"
    "[guide.angles]\n"
    "yaw = { terms = [{ amplitude = 0.1, frequency = 0.13 }] }\n"
    "pitch = { terms = [{ amplitude = 0.05, frequency = 0.9, phase = 0.7 }] }\n"
    "roll = { terms = [{ amplitude = 0.3, frequency = 0.7 }] }\n"
    "[[body]]\nname = \"unit\"\nmass = 2\ninertia = [0.2, 0.25, 0.3]\n"
    "joint = { kind = \"fixed\", position = [3, 1, 5] }\n";

std::string unit(const std::string& name, const std::string& kind, const std::string& keys) {
  return "[[sensor]]\nname = \"" + name + "\"\nkind = \"" + kind + "\"\nbody = \"unit\"\n" + keys +
         "\n";
}

/// The rows of all sensors in a run.
std::vector<std::vector<double>> rows_of(const SceneFile& file,
                                         const Trajectory<JointState>& motion) {
  const auto model = make_model(file);
  SensorReadings readings(file);
  std::vector<std::vector<double>> rows;
  for (std::size_t i = 0; i < motion.times.size(); ++i) {
    rows.push_back(readings.row(*model, motion.times[i], motion.states[i]));
  }
  return rows;
}

Vector3<double> three(const std::vector<double>& numbers, std::size_t begin) {
  return Vector3<double>(numbers.data() + begin);
}

}  // namespace

BOOST_AUTO_TEST_SUITE(increments_of_a_scene)

// q <- q exp(dtheta/2), v <- v + R(q) dv: attitude and velocity after an hour at sea.
BOOST_AUTO_TEST_CASE(navigate_a_ship_for_an_hour) {
  const std::string keys = "period = 1\nincrements = true";
  const SceneFile file =
      scene(at_sea + unit("g", "gyro", keys) + unit("a", "accelerometer", keys) +
            unit("q", "attitude", "against = \"inertial\"") +
            unit("p", "point", "against = \"inertial\"") + "[solve]\nt_end = 3600\n");
  const auto rows = rows_of(file, run_scene(file));
  BOOST_TEST_REQUIRE(rows.size() == 3601U);
  Eigen::Quaterniond q(rows[0][6], rows[0][7], rows[0][8], rows[0][9]);
  Vector3<double> v = three(rows[0], 13);
  for (const auto& row : rows) {
    v += q * three(row, 3);
    q = rotated(q, three(row, 0));
  }
  const Eigen::Quaterniond end(rows.back()[6], rows.back()[7], rows.back()[8], rows.back()[9]);
  const double turn = 2 * (end.conjugate() * q).vec().norm();
  const double speed = (v - three(rows.back(), 13)).norm();
  BOOST_TEST_MESSAGE("after an hour off by " << turn << " rad and " << speed << " m/s");
  BOOST_TEST(turn <= 1e-12);
  BOOST_TEST(speed <= 1e-11);
}

BOOST_AUTO_TEST_CASE(uncompensated_are_plain_integrals) {
  const auto increments = [](const std::string& key) {
    const std::string keys = "period = 0.5\nincrements = " + key;
    const SceneFile file = scene(at_sea + unit("g", "gyro", keys) +
                                 unit("a", "accelerometer", keys) + "[solve]\nt_end = 1\n");
    return rows_of(file, run_scene(file)).back();
  };
  const auto with_coning = increments("true");
  const auto plain = increments("\"uncompensated\"");
  // Simpson's rule on 2000 intervals of the sensors' values.
  const SceneFile file = scene(at_sea + unit("g", "gyro", "") + unit("a", "accelerometer", "") +
                               "[solve]\nt_end = 1\noutput_step = 0.00025\n");
  const auto rows = rows_of(file, run_scene(file));
  for (std::size_t k = 0; k < 6; ++k) {
    double sum = 0;
    for (std::size_t i = 2000; i + 2 < rows.size(); i += 2) {
      sum += (rows[i][k] + 4 * rows[i + 1][k] + rows[i + 2][k]) * 0.00025 / 3;
    }
    BOOST_TEST(std::abs(plain[k] - sum) <= 1e-14);
  }
  BOOST_TEST((three(plain, 0) - three(with_coning, 0)).norm() > 1e-5);
  BOOST_TEST((three(plain, 3) - three(with_coning, 3)).norm() > 1e-5);
}

BOOST_AUTO_TEST_CASE(are_0_between_the_ends_of_periods) {
  const SceneFile file = scene(at_sea + unit("g", "gyro", "period = 0.4\nincrements = true") +
                               "[solve]\nt_end = 1\noutput_step = 0.1\n");
  const auto motion = run_scene(file);
  const auto rows = rows_of(file, motion);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const bool ends = i == 4 || i == 8;
    BOOST_TEST((three(rows[i], 0).norm() > 0) == ends);
  }
  const auto model = make_model(file);
  BOOST_TEST(SensorReadings(file).last_row(*model, motion) == rows[8]);
}

// Rounding is carried to the next increment, so that no angle is lost.
BOOST_AUTO_TEST_CASE(coarse_resolution_loses_nothing) {
  const SceneFile file =
      scene(at_sea +
            unit("g", "gyro", "period = 0.01\nincrements = true\nresolution = 1e-3\nbias = 0.01") +
            "[solve]\nt_end = 3\n");
  const auto motion = run_scene(file);
  const auto rows = rows_of(file, motion);
  Vector3<double> read = Vector3<double>::Zero();
  Vector3<double> truth = Vector3<double>::Zero();
  for (std::size_t i = 1; i < rows.size(); ++i) {
    read += three(rows[i], 0);
    truth += three(rows[i], 3) + Vector3<double>::Constant(0.01 * 0.01);
    BOOST_TEST((read - truth).lpNorm<Eigen::Infinity>() <= 0.5e-3 * (1 + 1e-9));
  }
  const auto model = make_model(file);
  BOOST_TEST(SensorReadings(file).last_row(*model, motion) == rows.back());
}

// A torque that steps within a period: w = 2 (t - 0.37) after the step.
BOOST_AUTO_TEST_CASE(meet_a_step_within_a_period) {
  const SceneFile file = scene(
      "[[body]]\nname = \"unit\"\nmass = 1\ninertia = [1, 1, 1]\n"
      "joint = { kind = \"revolute\", axis = [0, 0, 1] }\n"
      "force = { steps = [[0.37, 2.0]] }\n" +
      unit("g", "gyro", "period = 0.5\nincrements = true") + "[solve]\nt_end = 1\n");
  const auto rows = rows_of(file, run_scene(file));
  BOOST_TEST(std::abs(rows.at(1).at(2) - 0.13 * 0.13) <= 1e-14);
  BOOST_TEST(std::abs(rows.at(2).at(2) - (0.63 * 0.63 - 0.13 * 0.13)) <= 1e-14);
}

// A damper of 4e5/s is stiff over the period. About a fixed axis the increment is the angle turned.
BOOST_AUTO_TEST_CASE(stiff_motion_is_integrated) {
  const SceneFile file = scene(
      "[[body]]\nname = \"unit\"\nmass = 2\ninertia = [0.2, 0.25, 0.3]\n"
      "joint = { kind = \"revolute\", axis = [0, 1, 0] }\nspring = { stiffness = 2e5 }\ndamping = "
      "1e5\n"
      "initial = { angle = 0.1 }\n" +
      unit("g", "gyro", "period = 0.5\nincrements = true") +
      "[solve]\nt_end = 1\ntolerance = 1e-12\n");
  const auto motion = run_scene(file);
  const auto rows = rows_of(file, motion);
  for (std::size_t i = 1; i < rows.size(); ++i) {
    const double turned = motion.states[i].coordinates[0] - motion.states[i - 1].coordinates[0];
    BOOST_TEST(std::abs(turned) > 0.02);
    BOOST_TEST(std::abs(rows[i].at(1) - turned) <= 1e-12);
  }
}

BOOST_AUTO_TEST_CASE(need_the_row_that_begins_a_period) {
  const SceneFile file =
      scene(at_sea + unit("g", "gyro", "period = 0.5\nincrements = true") + "[solve]\nt_end = 2\n");
  const auto model = make_model(file);
  SensorReadings readings(file);
  BOOST_CHECK_EXCEPTION(
      (void)readings.row(*model, 1, start_of(file)), InvalidInput, [](const InvalidInput& error) {
        return std::string(error.what()).find("read all rows in order") != std::string::npos;
      });
}

BOOST_AUTO_TEST_SUITE_END()
