// Points and sensors of scene files: what is read, what is refused, and the readings.

#include <Eigen/Geometry>
#include <boost/test/unit_test.hpp>

#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include <dynamics/file/columns.hpp>
#include <dynamics/file/readings.hpp>
#include <dynamics/file/scene_file.hpp>
#include <dynamics/guide/normal_gravity.hpp>
#include <motor/attitude.hpp>
#include <motor/error.hpp>

#include <support/scene_text.hpp>

using namespace kreisel;
using test::mistakes;
using test::scene;

namespace {

const std::string hinge = "joint = { kind = \"revolute\", axis = [0, 1, 0] }\n";
const std::string run = "[solve]\nt_end = 1\noutput_step = 0.1\n";
const std::string site = "kind = \"earth\"\nlatitude_deg = 50\nheight = 100\nazimuth_deg = 30\n";

/// A body with these keys.
std::string body(const std::string& name, const std::string& keys) {
  return "[[body]]\nname = \"" + name + "\"\nmass = 2\ninertia = [0.2, 0.25, 0.3]\n" + keys + "\n";
}

std::string sensor(const std::string& keys) { return "[[sensor]]\nname = \"s\"\n" + keys + "\n"; }

/// One body with a point, and one sensor at line 7.
std::string with(const std::string& keys) {
  return body("a", hinge + "points = { tip = [0, 0, 1.5] }") + sensor(keys) + run;
}

void check_told(const std::vector<std::pair<std::string, std::string>>& cases) {
  for (const auto& [text, reason] : cases) {
    const std::string found = mistakes(text);
    BOOST_TEST(found.find(reason) != std::string::npos, "wanted " << reason << "\nfound " << found);
  }
}

/// The readings at the start.
std::vector<double> at_start(const std::string& text) {
  const SceneFile file = scene(text);
  const auto model = make_model(file);
  return SensorReadings(file).row(*model, 0, start_of(file));
}

std::vector<std::string> columns_of(const std::string& text) {
  const std::vector<std::string> all = columns(scene(text));
  return {all.begin() + 3, all.end()};  // behind the time, the angle and the rate
}

using Names = std::vector<std::string>;

}  // namespace

BOOST_AUTO_TEST_SUITE(points_of_a_scene_file)

BOOST_AUTO_TEST_CASE(are_read_by_name) {
  const SceneFile file =
      scene(body("a", hinge + "points = { tip = [0, 0, 1.5], \"a b\" = [1, 2, 3] }") +
            body("b", hinge) + run);
  BOOST_REQUIRE(file.points.size() == 2U);
  BOOST_TEST((file.points[0].at("tip") == Vector3<double>(0, 0, 1.5)));
  BOOST_TEST((file.points[0].at("a b") == Vector3<double>(1, 2, 3)));
  BOOST_TEST(file.points[1].empty());
}

BOOST_AUTO_TEST_CASE(are_told_where_they_are_wrong) {
  const auto points = [](const std::string& value) {
    return body("a", hinge + "points = " + value) + run;
  };
  check_told({
      {points("3"), "s.toml:6:10: body 'a'.points: must be a table, not a whole number"},
      {points("{ tip = [0, 1] }"), "s.toml:6:18: body 'a'.points.tip: must be 3 numbers, not 2"},
      {points("{ tip = \"top\" }"),
       "s.toml:6:18: body 'a'.points.tip: must be a list of numbers, not a text"},
      {points("{ \"\" = [0, 1, 2] }"), "is a point without a name"},
  });
}

BOOST_AUTO_TEST_SUITE_END()

BOOST_AUTO_TEST_SUITE(mistakes_of_sensors)

BOOST_AUTO_TEST_CASE(are_told_at_their_keys) {
  check_told({
      {body("a", hinge) + "[[sensor]]\nkind = \"gyro\"\nbody = \"a\"\n" + run,
       "s.toml:7:1: sensor[0].name: is missing"},
      {body("a", hinge) + "[[sensor]]\nname = \"\"\nkind = \"gyro\"\nbody = \"a\"\n" + run,
       "s.toml:8:8: sensor[0].name: is empty"},
      {with("kind = \"gyro\"\nbody = \"a\"") + sensor("kind = \"gyro\"\nbody = \"a\""),
       "s.toml:15:8: sensor 's'.name: is used by an earlier sensor"},
      {with(""), "sensor 's'.kind: is missing"},
      {with("kind = \"giro\"\nbody = \"a\"\nrubbish = 1"),
       "s.toml:9:8: sensor 's'.kind: 'giro' is none of 'gyro', 'accelerometer', 'point', "
       "'attitude', 'joint', 'reaction' or 'azimuth' (did you mean 'gyro'?)"},
      {with("kind = \"gyro\""), "sensor 's'.body: is missing"},
      {with("kind = \"gyro\"\nbody = 3"),
       "s.toml:10:8: sensor 's'.body: must be a text, not a whole number"},
      {with("kind = \"gyro\"\nbody = \"b\""),
       "s.toml:10:8: sensor 's'.body: 'b' is no body; there are 'a'"},
      {with("kind = \"gyro\"\nbody = \"a\"\naxes = [1, 1, 0, 0]"),
       "s.toml:11:8: sensor 's'.axes: is a quaternion [w, x, y, z] of norm 1.414214, not of 1"},
      {with("kind = \"gyro\"\nbody = \"a\"\nperiod = 0"),
       "s.toml:11:10: sensor 's'.period: 0 must be above 0"},
      {with("kind = \"joint\"\njoint = \"a\"\nperiod = 1e-8"),
       "s.toml:11:10: sensor 's'.period: asks for more than ten million samples"},
      {with("kind = \"gyro\"\nbody = \"a\"\nincrements = true"),
       "s.toml:11:14: sensor 's'.increments: needs 'period', over which the reading is integrated"},
      {with("kind = \"gyro\"\nbody = \"a\"\nincrements = \"both\"\nperiod = 0.1"),
       "s.toml:11:14: sensor 's'.increments: must be true, false or 'uncompensated', not 'both'"},
      {with("kind = \"attitude\"\nbody = \"a\"\nincrements = true\nperiod = 0.1"),
       "s.toml:11:1: sensor 's'.increments: is no key here"},
      {with("kind = \"gyro\"\nbody = \"a\"\nincrements = true\nperiod = 0.1") +
           "model = \"linear\"\n",
       "sensor 's'.increments: needs the model 'exact', not 'linear'"},
      {with("kind = \"accelerometer\"\nbody = \"a\"\nat = [0, 1]"),
       "s.toml:11:6: sensor 's'.at: must be 3 numbers, not 2"},
      {with("kind = \"accelerometer\"\nbody = \"a\"\nat = \"tipp\""),
       "s.toml:11:6: sensor 's'.at: 'tipp' is no point of body 'a' (did you mean 'tip'?); there "
       "are "
       "'tip'"},
      {body("a", hinge) + sensor("kind = \"point\"\nbody = \"a\"\nat = \"tip\"") + run,
       "sensor 's'.at: 'tip' is no point of body 'a'; there are none"},
      {with("kind = \"point\"\nbody = \"a\"\nagainst = \"inertia\""),
       "s.toml:11:11: sensor 's'.against: 'inertia' is no frame (did you mean 'inertial'?); there "
       "are "
       "'guide', 'inertial', 'a'"},
      {with("kind = \"point\"\nbody = \"a\"\naxes = [1, 0, 0, 0]"),
       "s.toml:11:8: sensor 's'.axes: must be a text, not a list"},
      {with("kind = \"point\"\nbody = \"a\"\nbias = 1"),
       "s.toml:11:1: sensor 's'.bias: is no key here"},
      {with("kind = \"attitude\"\nbody = \"a\"\nas = \"matrix\""),
       "s.toml:11:6: sensor 's'.as: 'matrix' is none of 'quaternion' or 'yaw pitch roll'"},
      {with("kind = \"joint\"\nbody = \"a\""), "sensor 's'.joint: is missing"},
      {with("kind = \"joint\"\njoint = \"b\""), "s.toml:10:9: sensor 's'.joint: 'b' is no body"},
      {body("a", "joint = { kind = \"fixed\" }") + sensor("kind = \"joint\"\njoint = \"a\"") + run,
       "sensor 's'.joint: 'a' is fixed and has no coordinate"},
      {with("kind = \"reaction\"\njoint = \"a\"\naxes = \"sky\""),
       "s.toml:11:8: sensor 's'.axes: 'sky' is no frame; there are 'guide', 'inertial', 'a'"},
      {with("kind = \"reaction\"\njoint = \"a\"\naxes = 1"),
       "s.toml:11:8: sensor 's'.axes: must be a list of numbers, not a whole number"},
      {"sensor = 1\n" + body("a", hinge) + run,
       "s.toml:1:10: sensor: must be a list of tables, not a whole number"},
  });
}

BOOST_AUTO_TEST_CASE(are_found_in_error_keys) {
  const auto gyro = [](const std::string& key) {
    return with("kind = \"gyro\"\nbody = \"a\"\n" + key);
  };
  check_told({
      {gyro("bias = [1, 2]"), "s.toml:11:8: sensor 's'.bias: must be 3 numbers, not 2"},
      {gyro("scale = true"), "s.toml:11:9: sensor 's'.scale: must be a number, not true or false"},
      {gyro("misalignment = 0.1"),
       "s.toml:11:16: sensor 's'.misalignment: must be a list of numbers, not a number"},
      {gyro("noise = -1"), "s.toml:11:9: sensor 's'.noise: must not be below 0"},
      {gyro("drift = [0, 0, -1]"), "s.toml:11:9: sensor 's'.drift: must not be below 0"},
      {gyro("correlation = 1"), "s.toml:11:15: sensor 's'.correlation: must be a table"},
      {gyro("correlation = { time = 1 }"), "sensor 's'.correlation.sigma: is missing"},
      {gyro("correlation = { sigma = 1 }"), "sensor 's'.correlation.time: is missing"},
      {gyro("correlation = { sigma = 1, time = 0 }"),
       "s.toml:11:35: sensor 's'.correlation.time: 0 must be above 0"},
      {gyro("correlation = { sigma = -1, time = 1 }"),
       "s.toml:11:25: sensor 's'.correlation.sigma: must not be below 0"},
      {gyro("correlation = { sigma = 1, time = 1, mean = 1 }"),
       "sensor 's'.correlation.mean: is no key here"},
      {gyro("resolution = 0"), "s.toml:11:14: sensor 's'.resolution: must be above 0"},
      {gyro("range = -1"), "s.toml:11:9: sensor 's'.range: must be above 0"},
      {gyro("seed = -1"), "s.toml:11:8: sensor 's'.seed: must be a whole number, not below 0"},
      {gyro("seed = 1.5"), "s.toml:11:8: sensor 's'.seed: must be a whole number, not below 0"},
  });
}

// A sensor may have the name of a body, unless a column of the body would be there twice.
BOOST_AUTO_TEST_CASE(second_columns_are_refused) {
  const auto named_as_body = [](const std::string& keys) {
    return body("a", "joint = { kind = \"free\" }") + "[[sensor]]\nname = \"a\"\n" + keys + "\n" +
           run;
  };
  check_told(
      {{named_as_body("kind = \"gyro\"\nbody = \"a\""),
        "s.toml:7:8: sensor 'a'.name: would make a second column 'a.x'; choose another name"},
       {named_as_body("kind = \"reaction\"\njoint = \"a\""), "a second column 'a.force x'"},
       {named_as_body("kind = \"point\"\nbody = \"a\""), "none"}});
}

BOOST_AUTO_TEST_CASE(are_told_once) {
  const std::string wrong = body("a", "joint = { kind = \"hinge\" }");
  BOOST_TEST(mistakes(wrong + sensor("kind = \"joint\"\njoint = \"a\"") + run).find("fixed and") ==
             std::string::npos);
}

BOOST_AUTO_TEST_CASE(without_bodies_are_not_looked_for) {
  BOOST_TEST(mistakes(sensor("kind = \"gyro\"\nbody = \"a\"") + run) ==
             "s.toml:1:1: no [[body]] is given");
}

BOOST_AUTO_TEST_SUITE_END()

BOOST_AUTO_TEST_SUITE(columns_of_a_run)

const std::string all = with("kind = \"point\"\nbody = \"a\"");

BOOST_AUTO_TEST_CASE(are_chosen_by_name_or_group) {
  const auto chosen = [](const std::string& list) {
    const SceneFile file = scene(all + "[output]\ncolumns = " + list + "\n");
    Names names;
    const Names known = columns(file);
    for (const std::size_t i : chosen_columns(known, file.columns)) names.push_back(known[i]);
    return names;
  };
  BOOST_TEST((chosen("[\"a.rate\"]") == Names{"t", "a.rate"}));
  BOOST_TEST((chosen("[\"s.position\", \"a\"]") ==
              Names{"t", "s.position x", "s.position y", "s.position z", "a.angle", "a.rate"}));
  BOOST_TEST((chosen("[\"s.velocity y\", \"s.velocity\"]") ==
              Names{"t", "s.velocity y", "s.velocity x", "s.velocity z"}));
  BOOST_TEST(scene(all).columns.empty());
}

BOOST_AUTO_TEST_CASE(are_told_where_there_are_none) {
  const auto output = [](const std::string& keys) { return all + "[output]\n" + keys + "\n"; };
  check_told({
      {output(""), "s.toml:14:1: output.columns: is missing"},
      {output("columns = 3"), "s.toml:15:11: output.columns: must be a list of texts, not a whole"},
      {output("columns = [\"a\", 3]"), "output.columns[1]: must be a text, not a whole number"},
      {output("columns = [\"a.rat\"]"),
       "s.toml:15:11: output.columns: 'a.rat' is no column (did you mean 'a.rate'?)"},
      {output("columns = [\"a.force\"]"), "output.columns: 'a.force' is no column"},
      {output("columns = [\"a\"]\nrows = 1"), "s.toml:16:1: output.rows: is no key here"},
      {"output = 3\n" + all, "s.toml:1:10: output: must be a table, not a whole number"},
  });
  BOOST_TEST(mistakes(output("columns = [\"a.force\"]") + "[report]\nreactions = true\n") ==
             "none");
}

BOOST_AUTO_TEST_SUITE_END()

BOOST_AUTO_TEST_SUITE(readings_of_a_scene)

// The default of "at" is the origin; a point is seen from the guide, on the axes of its observer.
BOOST_AUTO_TEST_CASE(points_without_further_keys) {
  const std::string moving =
      body("a", hinge + "initial = { angle_deg = 90, rate = 2 }\npoints = { tip = [0, 0, 1.5] }");
  const auto check_near = [](const std::vector<double>& found, const std::vector<double>& wanted) {
    BOOST_REQUIRE(found.size() >= wanted.size());
    for (std::size_t i = 0; i < wanted.size(); ++i)
      BOOST_TEST(std::abs(found[i] - wanted[i]) < 1e-14);
  };
  const std::string point = "kind = \"point\"\nbody = \"a\"\n";
  check_near(at_start(moving + sensor(point) + run), {0, 0, 0, 0, 0, 0, 0, 0, 0});
  // The tip is at x and moves along -z; without moments its acceleration is w^2 r alone.
  const std::string tip = point + "at = \"tip\"\n";
  check_near(at_start(moving + sensor(tip) + run), {1.5, 0, 0, 0, 0, -3, -6, 0, 0});
  check_near(at_start(moving + sensor(point + "at = [0, 0, 1.5]") + run), {1.5, 0, 0, 0, 0, -3});
  check_near(at_start(moving + sensor(tip + "against = \"a\"") + run),
             {0, 0, 1.5, 0, 0, 0, 0, 0, 0});
  check_near(at_start(moving + sensor(tip + "axes = \"a\"") + run), {0, 0, 1.5, 3, 0, 0, 0, 0, -6});
}

BOOST_AUTO_TEST_CASE(have_columns_of_their_kinds) {
  BOOST_TEST(columns_of(body("a", hinge) + run).empty());
  BOOST_TEST((columns_of(with("kind = \"gyro\"\nbody = \"a\"")) == Names{"s.x", "s.y", "s.z"}));
  BOOST_TEST((columns_of(with("kind = \"accelerometer\"\nbody = \"a\"\nbias = 1")) ==
              Names{"s.x", "s.y", "s.z", "s.true x", "s.true y", "s.true z"}));
  BOOST_TEST((columns_of(with("kind = \"point\"\nbody = \"a\"")) ==
              Names{"s.position x", "s.position y", "s.position z", "s.velocity x", "s.velocity y",
                    "s.velocity z", "s.acceleration x", "s.acceleration y", "s.acceleration z"}));
  BOOST_TEST((columns_of(with("kind = \"attitude\"\nbody = \"a\"")) ==
              Names{"s.qw", "s.qx", "s.qy", "s.qz"}));
  BOOST_TEST((columns_of(with("kind = \"attitude\"\nbody = \"a\"\nas = \"yaw pitch roll\"")) ==
              Names{"s.yaw", "s.pitch", "s.roll"}));
  BOOST_TEST((columns_of(with("kind = \"joint\"\njoint = \"a\"")) == Names{"s.angle", "s.rate"}));
  BOOST_TEST(
      (columns_of(with("kind = \"reaction\"\njoint = \"a\"")) ==
       Names{"s.force x", "s.force y", "s.force z", "s.torque x", "s.torque y", "s.torque z"}));
}

// Up is -x; the centrifugal part comes from the guide's motion, gravitation from the ellipsoid.
BOOST_AUTO_TEST_CASE(at_rest_on_the_earth_are_gravity) {
  const double g = normal_gravity({50, 30, 100}).magnitude;
  const std::string fixed =
      body("a", hinge + "hold = true") + sensor("kind = \"accelerometer\"\nbody = \"a\"") + run;
  const auto check_upwards = [](const std::vector<double>& f, double wanted) {
    BOOST_REQUIRE(f.size() == 3U);
    BOOST_TEST(std::abs(f[0] + wanted) <= 1e-13 * wanted);
    BOOST_TEST(std::hypot(f[1], f[2]) <= 1e-13 * wanted);
  };
  check_upwards(at_start("[guide]\n" + site + "gravity = \"normal\"\n" + fixed), g);
  check_upwards(at_start("[guide]\n" + site + "[gravity]\nkind = \"earth\"\n" + fixed), g);
  check_upwards(at_start("[guide]\n" + site + "gravity = 9.75\n" + fixed), 9.75);
  const std::string chain = "[guide]\nkind = \"chain\"\n[[guide.links]]\n" + site;
  const std::string level = "[[guide.links]]\nkind = \"inertial\"\n" + fixed;
  check_upwards(at_start(chain + "gravity = \"normal\"\n" + level), g);
  check_upwards(at_start(chain + "gravity = 9.75\n" + level), 9.75);
  // On a body without mass too.
  const std::string massless =
      "[[body]]\nname = \"a\"\nmass = 0\ninertia = [0, 0, 0]\njoint = { kind = \"fixed\" }\n";
  check_upwards(at_start("[guide]\n" + site + "gravity = \"normal\"\n" + massless +
                         body("b", hinge) + sensor("kind = \"accelerometer\"\nbody = \"a\"") + run),
                g);
}

// A body that is held 10 m above the origin of a circular orbit. The remaining gravity is the tide
// 2 n^2 x, to the order x/a; the inertial frame still has the motion about the planet.
BOOST_AUTO_TEST_CASE(on_an_orbit) {
  const double a = 7e6;
  const double n2 = 3.986004418e14 / (a * a * a);
  const std::string held =
      "[guide]\nkind = \"orbit\"\nsemi_major_axis = 7e6\n[gravity]\nkind = \"orbit\"\n" +
      body("a", "joint = { kind = \"fixed\", position = [10, 0, 0] }");
  const auto f = at_start(held + sensor("kind = \"accelerometer\"\nbody = \"a\"") + run);
  BOOST_TEST(std::abs(f[0] + 30 * n2) <= 6 * n2 * 100 / a);
  BOOST_TEST(std::hypot(f[1], f[2]) <= 1e-20);
  const auto p = at_start(
      held + sensor("kind = \"point\"\nbody = \"a\"\nagainst = \"inertial\"\naxes = \"inertial\"") +
      run);
  const auto check = [&p](std::size_t at, const Vector3<double>& wanted) {
    const Vector3<double> found(p.data() + at);
    BOOST_TEST((found - wanted).norm() <= 1e-14 * wanted.norm(), found << "\nwanted " << wanted);
  };
  const double r = a + 10;
  check(0, {r, 0, 0});
  check(3, {0, std::sqrt(n2) * r, 0});
  check(6, {-n2 * r, 0, 0});
}

// Without gravity on the earth the centripetal part at the site remains.
BOOST_AUTO_TEST_CASE(without_gravity_are_centripetal) {
  const NormalGravity gravity = normal_gravity({50, 30, 100});
  const auto f = at_start("[guide]\n" + site + body("a", hinge + "hold = true") +
                          sensor("kind = \"accelerometer\"\nbody = \"a\"") + run);
  const double size = std::sqrt(f[0] * f[0] + f[1] * f[1] + f[2] * f[2]);
  BOOST_TEST(std::abs(size - gravity.centrifugal.norm()) <= 1e-14 * size);
}

BOOST_AUTO_TEST_CASE(uniform_gravity_on_either_axes) {
  for (const std::string kind : {"uniform", "inertial"}) {
    const auto f = at_start("[gravity]\nkind = \"" + kind + "\"\nvector = [0, 0, -9.75]\n" +
                            body("a", hinge + "hold = true\ninitial = { angle_deg = 90 }") +
                            sensor("kind = \"accelerometer\"\nbody = \"a\"") + run);
    BOOST_TEST(std::abs(f[0] + 9.75) <= 1e-14);  // body x points down
    BOOST_TEST(std::abs(f[2]) <= 1e-14);
  }
}

BOOST_AUTO_TEST_CASE(an_attitude) {
  const std::string turned =
      "joint = { kind = \"free\" }\ninitial = { attitude = [-0.6, 0, 0, 0.8] }";
  const auto q = at_start(body("a", turned) + sensor("kind = \"attitude\"\nbody = \"a\"") + run);
  const double wanted[] = {0.6, 0, 0, -0.8};
  for (std::size_t i = 0; i < 4; ++i) BOOST_TEST(std::abs(q.at(i) - wanted[i]) <= 1e-15);
  const auto angles =
      at_start(body("a", turned) +
               sensor("kind = \"attitude\"\nbody = \"a\"\nas = \"yaw pitch roll\"") + run);
  BOOST_TEST(std::abs(angles.at(0) + 2 * std::atan2(0.8, 0.6)) <= 1e-15);
}

BOOST_AUTO_TEST_CASE(joints_read_their_columns) {
  const auto numbers = at_start(body("a", hinge + "initial = { angle = 0.5, rate = -2 }") +
                                sensor("kind = \"joint\"\njoint = \"a\"") + run);
  BOOST_TEST(numbers == (std::vector<double>{0.5, -2}));
}

BOOST_AUTO_TEST_CASE(in_degrees_are_turned_into_radian) {
  const double degree = 0.017453292519943295;
  const SceneFile file =
      scene(with("kind = \"gyro\"\nbody = \"a\"\nbias_deg = 1\nnoise_deg = [1, 2, 3]\n"
                 "resolution_deg = 0.5\nrange_deg = 90\nseed = 12"));
  const SensorErrors& errors = *file.sensors.at(0).errors;
  BOOST_TEST((errors.bias == Vector3<double>::Constant(degree)));
  BOOST_TEST((errors.noise == Vector3<double>(degree, 2 * degree, 3 * degree)));
  BOOST_TEST(errors.resolution == 0.5 * degree);
  BOOST_TEST(errors.range == 90 * degree);
  BOOST_TEST(errors.seed == 12U);
}

BOOST_AUTO_TEST_CASE(samples_are_rows) {
  const std::string joint = "kind = \"joint\"\njoint = \"a\"\nperiod = ";
  const SceneFile both = scene(with(joint + "0.25"));
  const std::vector<double> wanted{0,       0.1,     0.2,  0.25, 3 * 0.1, 0.4, 0.5,
                                   6 * 0.1, 7 * 0.1, 0.75, 0.8,  0.9,     1};
  BOOST_TEST(both.output_times == wanted, boost::test_tools::per_element());
  // Multiples of both steps are one row each, though they differ by rounding.
  BOOST_TEST(scene(with(joint + "0.02")).output_times.size() == 51U);
  const SceneFile alone = scene(body("a", hinge) + sensor(joint + "0.3") + "[solve]\nt_end = 1\n");
  const std::vector<double> own{0, 0.3, 0.6, 3 * 0.3, 1};
  BOOST_TEST(alone.output_times == own, boost::test_tools::per_element());
}

// 3e5 oscillations in a period.
BOOST_AUTO_TEST_CASE(increments_of_a_hard_spring_end) {
  const SceneFile file =
      scene(body("a", hinge + "spring = { stiffness = 1e12 }\ninitial = { angle = 0.1 }") +
            sensor("kind = \"gyro\"\nbody = \"a\"\nperiod = 1\nincrements = true") + run);
  const auto model = make_model(file);
  SensorReadings readings(file);
  (void)readings.row(*model, 0, start_of(file));
  const auto why = [](const ComputationFailed& error) {
    const std::string text = error.what();
    return text.find("sensor 's'") != std::string::npos &&
           text.find("take a shorter period") != std::string::npos;
  };
  BOOST_CHECK_EXCEPTION((void)readings.row(*model, 1, start_of(file)), ComputationFailed, why);
}

BOOST_AUTO_TEST_CASE(samples_are_held_between_rows) {
  const SceneFile file = scene(body("a", hinge + "initial = { rate = 2 }") +
                               sensor("kind = \"joint\"\njoint = \"a\"\nperiod = 0.25") + run);
  const auto model = make_model(file);
  const auto motion = run_scene(file);
  SensorReadings readings(file);
  for (std::size_t i = 0; i < motion.times.size(); ++i) {
    const std::vector<double> found = readings.row(*model, motion.times[i], motion.states[i]);
    const double sample = 0.25 * std::floor(motion.times[i] / 0.25);
    BOOST_TEST(std::abs(found.at(0) - 2 * sample) <= 1e-14);
  }
  BOOST_TEST(readings.last_row(*model, motion).at(0) == 2);
}

// The noise of a row depends on the row, not on the rows requested before.
BOOST_AUTO_TEST_CASE(noise_of_rows_in_any_order) {
  const SceneFile file = scene(with("kind = \"gyro\"\nbody = \"a\"\nnoise = 1\ndrift = 1"));
  const auto model = make_model(file);
  const JointState state = start_of(file);
  SensorReadings forwards(file);
  std::vector<std::vector<double>> rows;
  for (const double t : file.output_times) rows.push_back(forwards.row(*model, t, state));
  BOOST_TEST(rows[0] != rows[1]);
  SensorReadings other(file);
  for (const std::size_t i : {5U, 9U, 2U, 2U}) {
    BOOST_TEST(other.row(*model, file.output_times[i], state) == rows[i]);
  }
}

// Foucault: the plane turns clockwise, by the earth's rate about the plumb line. It begins to one
// side of 30 degrees, because the bob's plumb line is beside the site's by u^2 d/2g, or 1.53 times
// as much on the ellipsoid. The horizontal component of u deflects the bob on its way up and down,
// and the ellipse of its path turns.
BOOST_AUTO_TEST_CASE(azimuth_of_foucault) {
  const double degree = std::numbers::pi / 180, length = 67, amplitude = 1e-3;
  for (const char* const gravity : {"9.81", "\"normal\""}) {
    const SceneFile file = scene(
        "[guide]\nkind = \"earth\"\nlatitude_deg = 48.85\nheight = 0\nazimuth_deg = 30\n"
        "gravity = " +
        std::string(gravity) +
        "\n[[body]]\nname = \"bob\"\nmass = 28\ncentre = [67, 0, 0]\ninertia = [0.04, 0.04, 0.04]\n"
        "joint = { kind = \"universal\", axis = [0, 0, 1], second_axis = [0, 1, 0] }\n"
        "initial = { angle = [0, -0.001] }\n" +
        sensor("kind = \"azimuth\"\nbody = \"bob\"\nat = [67, 0, 0]") +
        "[solve]\nt_end = 3600\noutput_step = 100\n");
    const auto model = make_model(file);
    const auto motion = run_scene(file);
    const Vector3<double> u = make_guide(file)(0).V.value.resultant;
    const double start = u.squaredNorm() * length / (9.81 * amplitude);
    SensorReadings readings(file);
    double first = 0;
    for (std::size_t i = 0; i < motion.times.size(); ++i) {
      const double t = motion.times[i];
      const double found = readings.row(*model, t, motion.states[i]).at(0);
      if (i == 0) first = found;
      const double bound = u.norm() * amplitude * (std::sqrt(length / 9.81) + amplitude * t / 2);
      BOOST_TEST(std::abs(found - first + u.x() * t) <= bound);
    }
    BOOST_TEST(std::abs(first - 30 * degree) <= start);
  }
}

BOOST_AUTO_TEST_SUITE_END()
