// Guides of kind `course` in scene files: what is read, what is refused, and bodies on a vehicle.
// The sentences of docs/scene_files.md about them are tested here.

#include <boost/test/unit_test.hpp>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <dynamics/file/readings.hpp>
#include <dynamics/file/scene_system.hpp>
#include <dynamics/guide/course.hpp>
#include <dynamics/guide/normal_gravity.hpp>

#include <support/scene_text.hpp>

using namespace kreisel;
using test::mistakes;
using test::scene;

namespace {

constexpr double degree = 0.017453292519943295;

const std::string run = "[solve]\nt_end = 10\noutput_times = [10]\ntolerance = 1e-12\n";
const std::string start = "kind = \"course\"\nlatitude_deg = 50\nheading_deg = 30\nspeed = 200\n";
const std::string parked = "kind = \"course\"\nlatitude_deg = 50\nheading_deg = 30\nspeed = 0\n";
const std::string site = "kind = \"earth\"\nlatitude_deg = 50\nheight = 0\nazimuth_deg = 30\n";

/// A pendulum, or with `hold` a body at rest on the guide.
std::string pendulum(const std::string& keys = "") {
  return "[[body]]\nname = \"a\"\njoint = { kind = \"universal\", axis = [0, 1, 0], second_axis = "
         "[0, 0, 1] }\nmass = 2\ncentre = [0.5, 0, 0]\ninertia = [0.2, 0.25, 0.3]\n" +
         keys + "\n";
}

const std::string swung = pendulum("initial = { angle = [0.3, 0.1] }") + run;
const std::string held = pendulum("hold = true");

std::string guide(const std::string& keys) { return "[guide]\n" + keys; }

/// A chain of a link and one that turns about the axis ahead.
std::string chain(const std::string& keys) {
  return "[guide]\nkind = \"chain\"\n[[guide.links]]\n" + keys +
         "[[guide.links]]\nkind = \"rotating\"\nangular_velocity = [0, 0, 0.5]\n";
}

CoursePlan plan(const std::string& keys) {
  return std::get<scene_guide::Course>(scene(guide(keys) + held + run).guide.front()).plan;
}

Eigen::VectorXd at_end(const std::string& text) {
  return run_scene(scene(text)).states.back().coordinates;
}

/// The readings of one sensor at the start.
std::vector<double> reading(const std::string& text, const std::string& sensor) {
  const SceneFile file =
      scene(text + held + "[[sensor]]\nname = \"s\"\nbody = \"a\"\n" + sensor + "\n" + run);
  const auto model = make_model(file);
  return SensorReadings(file).row(*model, 0, start_of(file));
}

}  // namespace

BOOST_AUTO_TEST_SUITE(a_course_of_a_scene_file)

BOOST_AUTO_TEST_CASE(is_that_of_the_library) {
  const std::string signals =
      "turn_rate_deg = { points = [[1, 0], [3, 2]] }\nacceleration = { steps = [[2, 0.5]] }\n"
      "climb = { constant = 1, terms = [{ amplitude = 2, frequency = 3 }] }\nbank_deg = 5\n";
  const CoursePlan wanted{.latitude = 50,
                          .longitude = 20,
                          .height = 1000,
                          .heading = 30,
                          .speed = 200,
                          .turn_rate = Signal<double>::broken_line({{1, 0}, {3, 2}}).scaled(degree),
                          .acceleration = Signal<double>::steps({{2, 0.5}}),
                          .climb = Signal<double>(1, 0, {{2, 3, 0}}),
                          .bank = 5 * degree};
  const CourseFrame<> frame(wanted, 10);
  const auto read =
      make_guide(scene(guide(start + "longitude_deg = 20\nheight = 1000\n" + signals) + swung));
  for (const double t : {0.0, 2.5, 10.0, 10.0 * (1 + 1e-13)}) {
    const auto x = read(t);
    const auto y = frame(std::min(t, 10.0));
    BOOST_TEST((x.X.value.rotation == y.X.value.rotation));
    BOOST_TEST((x.X.value.translation == y.X.value.translation));
    BOOST_TEST((x.V.value.resultant == y.V.value.resultant));
    BOOST_TEST((x.dV.value.moment == y.dV.value.moment));
  }
}

BOOST_AUTO_TEST_CASE(has_defaults_and_angles_in_radian) {
  const CoursePlan given =
      plan("kind = \"course\"\nlatitude = 0.5\nheading = 1\nspeed = 3\nlongitude = -1\n");
  BOOST_TEST(std::abs(given.latitude - 0.5 / degree) <= 1e-14);
  BOOST_TEST(std::abs(given.heading - 1 / degree) <= 1e-14);
  BOOST_TEST(std::abs(given.longitude + 1 / degree) <= 1e-14);
  BOOST_TEST(given.height == 0);
  BOOST_TEST(!given.is_coordinated);
  BOOST_TEST(plan(start).longitude == 0);
  BOOST_TEST(plan(parked).rests());
  BOOST_TEST(!plan(start).rests());
  BOOST_TEST(!plan(start + "bank = \"none\"\n").is_coordinated);
  BOOST_TEST(plan(start + "bank = \"coordinated\"\n").is_coordinated);
  BOOST_TEST(plan(start + "bank = 0.1\n").bank(0.0) == 0.1);
}

// At speed 0 a vehicle is a site, for each kind of gravity. A number is the same in a chain, too.
BOOST_AUTO_TEST_CASE(at_rest_is_a_site_on_the_earth) {
  for (const std::string gravity :
       {"gravity = \"normal\"\n", "gravity = 9.75\n", "gravity = \"none\"\n"}) {
    for (const auto& frame : {guide, chain}) {
      const Eigen::VectorXd on_vehicle = at_end(frame(parked + gravity) + swung);
      const Eigen::VectorXd on_site = at_end(frame(site + gravity) + swung);
      BOOST_TEST((on_vehicle - on_site).norm() <= 1e-12, gravity << on_vehicle - on_site);
    }
  }
  for (const std::string field : {"\"normal\"", "\"j2\""}) {
    const std::string rest = "[gravity]\nkind = \"earth\"\nfield = " + field + "\n" + swung;
    BOOST_TEST((at_end(guide(parked) + rest) - at_end(guide(site) + rest)).norm() <= 1e-12);
  }
}

// An accelerometer at the origin: Eotvos on the equator, g + (u (a + h))^2/(a + h) - s^2/(a + h).
BOOST_AUTO_TEST_CASE(is_felt_by_accelerometers) {
  const std::string east = "kind = \"course\"\nlatitude_deg = 0\nheading_deg = 90\nspeed = 250\n";
  const std::string sensor = "kind = \"accelerometer\"";
  const double a = 6378137, u = 7.292115e-5;
  const double lift = ((u * a + 250) * (u * a + 250) - u * u * a * a) / a;
  const auto normal = reading(guide(east + "gravity = \"normal\"\n"), sensor);
  const double g = normal_gravity({0, 0, 0}).magnitude;
  BOOST_TEST(std::abs(normal[0] + g - lift) <= 1e-13);
  BOOST_TEST(std::hypot(normal[1], normal[2]) <= 1e-13);
  const auto number = reading(guide(east + "gravity = 9.5\n"), sensor);
  BOOST_TEST(std::abs(number[0] + 9.5 - lift) <= 1e-13);
  const auto linked = reading(chain(east + "gravity = 9.5\n"), sensor);
  BOOST_TEST(std::abs(linked[0] + 9.5 - lift) <= 1e-13);
}

// A coordinated turn has no lateral reading, for each kind of gravity.
BOOST_AUTO_TEST_CASE(coordinated_has_no_lateral_force) {
  for (const std::string gravity : {"\"normal\"", "9.5"}) {
    const auto f = reading(
        guide(start + "turn_rate = 0.05\nbank = \"coordinated\"\ngravity = " + gravity + "\n"),
        "kind = \"accelerometer\"");
    BOOST_TEST(std::abs(f[1]) <= 1e-12);
    BOOST_TEST(f[0] < -13);  // hypot(9.8, 200 * 0.05) = 14
  }
}

// Positions against the inertial frame begin at the earth's centre, for each kind of gravity.
BOOST_AUTO_TEST_CASE(is_seen_from_the_earths_centre) {
  for (const std::string gravity : {"\"normal\"", "9.5"}) {
    const auto p = reading(guide("kind = \"course\"\nlatitude_deg = 0\nheading_deg = 90\nspeed = "
                                 "250\ngravity = " +
                                 gravity + "\n"),
                           "kind = \"point\"\nagainst = \"inertial\"");
    const double a = 6378137;
    const double v = 7.292115e-5 * a + 250;
    const double wanted[] = {a, 0, 0, 0, v, 0, -v * v / a, 0, 0};
    for (std::size_t i = 0; i < 9; ++i) {
      BOOST_TEST(std::abs(p[i] - wanted[i]) <= 1e-12 * (1 + std::abs(wanted[i])), i << ' ' << p[i]);
    }
  }
}

BOOST_AUTO_TEST_CASE(ends_steps_at_its_jumps) {
  const SceneFile file = scene(
      guide(start + "turn_rate = { points = [[1, 0], [3, 0.1]] }\nacceleration = { steps = [[2, "
                    "1], [20, 0]] }\n") +
      "[gravity]\nkind = \"earth\"\n" + swung);
  BOOST_TEST(file.discontinuities == std::vector<double>({1, 2, 3}),
             boost::test_tools::per_element());
  BOOST_TEST(run_scene(file).report.tolerance_kept);
}

BOOST_AUTO_TEST_CASE(has_line_column_key_and_reason) {
  const std::pair<std::string, std::string> cases[] = {
      {"kind = \"course\"\n", "guide.latitude_deg: is missing"},
      {"kind = \"course\"\n", "guide.heading_deg: is missing"},
      {"kind = \"course\"\n", "guide.speed: is missing"},
      {start + "latitude = 1\n", "s.toml:3:16: guide.latitude_deg: is given in radian too"},
      {start + "height = 2e7\n", "s.toml:6:10: guide.height: 20000000 m lies outside"},
      {start + "longitude = 7\n", "s.toml:6:13: guide.longitude: 401.0704566 degrees lies outside"},
      {start + "azimuth_deg = 3\n", "s.toml:6:1: guide.azimuth_deg: is no key here"},
      {start + "turn_rate = { steps = [[4, 0.1]] }\n",
       "s.toml:6:13: guide.turn_rate: jumps, or its rate does, at t = 4 s, which takes an infinite "
       "force; give 'points'"},
      {start + "climb = { steps = [[4, 1]] }\n",
       "guide.climb: jumps, or its rate does, at t = 4 s"},
      {start + "bank_deg = { points = [[4, 1], [5, 2]] }\n",
       "guide.bank_deg: jumps, or its rate does, at t = 4 s, which takes an infinite force; give "
       "'constant', 'rate' and 'terms'"},
      {start + "bank = \"coordinated\"\nturn_rate_deg = { points = [[4, 1], [5, 2]] }\n",
       "s.toml:7:17: guide.turn_rate_deg: jumps, or its rate does, at t = 4 s, which takes an "
       "infinite torque beside bank = 'coordinated'; give 'constant', 'rate' and 'terms', or "
       "'file', or an angle of bank"},
      {start + "bank = \"steep\"\n", "guide.bank: 'steep' is none of 'none' or 'coordinated'"},
      {start + "bank = \"none\"\nbank_deg = 3\n", "guide.bank_deg: is given beside 'bank'"},
      {start + "gravity = -1\n", "s.toml:6:11: guide.gravity: -1 must be above 0"},
      {start + "gravity = \"moon\"\n", "guide.gravity: 'moon' is none of 'normal' or 'none'"},
      {start + "gravity = 9.8\n[gravity]\nkind = \"earth\"\n", "gives gravity a second time"},
      {"kind = \"chain\"\nlinks = [{ kind = \"inertial\" }, { kind = \"course\", latitude_deg = 1, "
       "heading_deg = 0, speed = 1 }]\n",
       "'course' must be the first link"}};
  for (const auto& [keys, reason] : cases) {
    const std::string found = mistakes(guide(keys) + held + run);
    BOOST_TEST(found.find(reason) != std::string::npos, "wanted " << reason << "\nfound " << found);
  }
  const std::string early = mistakes(guide(start) + held + "[solve]\nt_begin = -1\nt_end = 1\n");
  BOOST_TEST(early.find("its start at t = 0; solve.t_begin is earlier") != std::string::npos);
  // The height on the way is known to the run only.
  const SceneFile sinking = scene(guide(start + "climb = -2000\n") + held + run);
  BOOST_CHECK_THROW((void)make_guide(sinking), InvalidInput);
}

BOOST_AUTO_TEST_SUITE_END()
