// Numbers with a unit in scene files.

#include <boost/test/unit_test.hpp>

#include <cmath>
#include <numbers>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <dynamics/file/scene_setting.hpp>
#include <dynamics/file/unit.hpp>

#include <support/scene_text.hpp>

using namespace kreisel;
using detail::value_with_unit;
using test::mistakes;
using test::scene;

namespace {

constexpr double degree = 0.017453292519943295;

/// A body with a joint of a kind, and further keys.
std::string body(const std::string& kind, const std::string& keys) {
  return "[[body]]\nname = \"a\"\nmass = 2\ninertia = [1, 1, 1]\njoint = { kind = \"" + kind +
         "\", axis = [0, 0, 1] }\n" + keys + "\n[solve]\nt_end = 1\n";
}

std::string refusal(const std::string& text, const detail::KeyDimension& wanted) {
  try {
    (void)value_with_unit(text, wanted);
  } catch (const InvalidInput& error) {
    return error.what();
  }
  return "none";
}

}  // namespace

BOOST_AUTO_TEST_SUITE(numbers_with_a_unit)

// The decimal point is moved in the text, so the double is that of the literal.
BOOST_AUTO_TEST_CASE(are_the_literals_where_units_are_decimal) {
  const std::pair<const char*, double> cases[] = {{"5 mm", 0.005},
                                                  {"0.1 mm", 0.0001},
                                                  {"0.7 um", 0.7e-6},
                                                  {"-3.3 cm", -0.033},
                                                  {"+1.1e3 km", 1.1e6},
                                                  {"9.81 m/s^2", 9.81},
                                                  {"2 kN/m", 2000},
                                                  {"0.3 g", 0.0003},
                                                  {"1e-3 rad/s", 1e-3},
                                                  {"10 N m", 10},
                                                  {"10 N*m", 10},
                                                  {"10 N.m", 10},
                                                  {"0.5 Nms/rad", 0.5},
                                                  {"3 kg m^2", 3},
                                                  {"7 g cm^2", 7e-7},
                                                  {"1.7 t", 1700},
                                                  {"30 uT", 3e-5},
                                                  {"100 ppm", 1e-4},
                                                  {"3 %", 0.03},
                                                  {"2 1/s", 2},
                                                  {"2 /s", 2},
                                                  {"5mm", 0.005},
                                                  {"4 N/(m s)", 4},
                                                  {"4 kg.m^2.s^-1", 4},
                                                  {"8 m / s^2", 8},
                                                  {"72 km/h", 20},
                                                  {"1 kn", 1852 / 3600.0},
                                                  {"3 ft", 0.9144},
                                                  {"1 lb", 0.45359237},
                                                  {"2 in", 0.0508},
                                                  {"1 nmi", 1852},
                                                  {"5 min", 300},
                                                  {"1.5 h", 5400},
                                                  {"2 d", 172800},
                                                  {"0.3 ms", 0.0003},
                                                  {"4 mN", 0.004},
                                                  {"6 J", 6},
                                                  {"7 W", 7},
                                                  {"8 Pa", 8},
                                                  {"3 sqrt(m^2)", 3},
                                                  {"2 m/sqrt(s)", 2},
                                                  {"2 m/s^0.5", 2},
                                                  {"5 m/s^2/sqrt(Hz)", 5},
                                                  {"9 nT", 9e-9}};
  for (const auto& [text, value] : cases) BOOST_TEST(value_with_unit(text) == value, text);
}

BOOST_AUTO_TEST_CASE(are_as_in_keys_of_degrees) {
  const std::pair<const char*, double> cases[] = {{"30 deg", 30 * degree},
                                                  {"0.1 deg/s", 0.1 * degree},
                                                  {"2400 rpm", 14400 * degree},
                                                  {"0.5 rev", 180 * degree},
                                                  {"3 Hz", 1080 * degree},
                                                  {"30 arcmin", 0.5 * degree},
                                                  {"18 arcsec", 18.0 / 3600 * degree},
                                                  {"0.1 deg/h", 0.1 / 3600 * degree}};
  for (const auto& [text, value] : cases) BOOST_TEST(value_with_unit(text) == value, text);
  // sqrt(3600) = 60
  BOOST_TEST(std::abs(value_with_unit("6 deg/sqrt(h)") / (0.1 * degree) - 1) < 4e-16);
  BOOST_TEST(std::abs(value_with_unit("5 mm/rev") * 2 * std::numbers::pi / 0.005 - 1) < 4e-16);
  BOOST_TEST(std::abs(value_with_unit("2 N m/deg") * degree / 2 - 1) < 4e-16);
  const SceneFile file =
      scene(body("revolute", "initial = { angle = \"30 deg\", rate = \"60 rpm\" }"));
  const SceneFile plain = scene(body("revolute", "initial = { angle_deg = 30, rate_deg = 360 }"));
  BOOST_TEST(file.start[0].coordinates == plain.start[0].coordinates);
  BOOST_TEST(file.start[0].rates == plain.start[0].rates);
}

BOOST_AUTO_TEST_CASE(have_the_dimension_of_their_key) {
  using namespace detail::dimension;
  const std::tuple<const char*, detail::KeyDimension, const char*> cases[] = {
      {"5 mm", mass, "'5 mm' is a length (m), wanted a mass (kg)"},
      {"5 N m/rad", torque, "'5 N m/rad' is a stiffness (N m/rad), wanted a torque (N m)"},
      {"5 deg", number, "'5 deg' is an angle (rad), wanted a plain number"},
      {"5 kg^2", mass, "'5 kg^2' is a quantity in kg^2, wanted a mass (kg)"},
      {"5 kg/s^0.5", mass, "'5 kg/s^0.5' is a quantity in kg s^-0.5, wanted a mass (kg)"},
      {"5 deg", std::nullopt, "'5 deg' must be a plain number: the key is in degrees"},
      {"5", length, "'5' has no unit; write the number without quotes"},
      {"5 mmm", length, "'5 mmm' has an unknown unit, 'mmm' (did you mean 'mm'?)"},
      {"5 N/m s", length, "'5 N/m s' is unclear after '/'; write 'N s/m', or 'N/(m s)'"},
      {"5 m2", length, "'5 m2' is unclear at '2'; products are written 'N m', powers 's^2'"},
      {"5 m^x", length, "'5 m^x' has a power that is none of 2, -1, 0.5 and the like"},
      {"5 m^1e9", length, "'5 m^1e9' is unclear at 'e9'"},
      {"5 m^99", length, "has a power"},
      {"5 m^0.3", length, "has a power"},
      {"5 m/", length, "'5 m/' ends without a unit"},
      {"5 m/2", length, "'5 m/2' has no unit at '2', but needs one"},
      {"5 (m", length, "'5 (m' lacks a closing bracket"},
      {"5 m)", length, "'5 m)' has a bracket too many"},
      {"1e999 m", length, "'1e999 m' is no number that a computer holds"},
      {"1e9999 m", length, "'1e9999 m' is no number that a computer holds"},
      {"- 5 m", length, "'- 5 m' is no number"}};
  for (const auto& [text, wanted, reason] : cases) {
    const std::string found = refusal(text, wanted);
    BOOST_TEST(found.find(reason) != std::string::npos, "wanted " << reason << "\nfound " << found);
  }
  BOOST_TEST(refusal("5 " + std::string(100, '('), length).find("is too long") !=
             std::string::npos);
}

// The unit of a radian may be left out: rad/s is 1/s.
BOOST_AUTO_TEST_CASE(may_leave_out_radian) {
  using namespace detail::dimension;
  BOOST_TEST(value_with_unit("5 1/s", angular_rate) == 5);
  BOOST_TEST(value_with_unit("5 N m", torque / angle) == 5);
  BOOST_TEST(value_with_unit("5 N m s", torque / angular_rate) == 5);
}

BOOST_AUTO_TEST_CASE(depend_on_the_kind_of_joint) {
  const std::string turning =
      "spring = { stiffness = \"2 N m/rad\", rest = \"90 deg\" }\ndamping = \"3 N m s/rad\"\n"
      "force = \"4 N m\"";
  const std::string sliding =
      "spring = { stiffness = \"2 kN/m\", rest = \"90 mm\" }\ndamping = \"3 N s/m\"\n"
      "force = \"4 N\"";
  const JointForce hinge = scene(body("revolute", turning)).bodies[0].forces[0];
  BOOST_TEST(hinge.stiffness == 2);
  BOOST_TEST(hinge.rest == 90 * degree);
  BOOST_TEST(hinge.damping == 3);
  BOOST_TEST(hinge.constant == 4);
  const JointForce slide = scene(body("prismatic", sliding)).bodies[0].forces[0];
  BOOST_TEST(slide.stiffness == 2000);
  BOOST_TEST(slide.rest == 0.09);
  BOOST_TEST(slide.damping == 3);
  BOOST_TEST(slide.constant == 4);
  const std::string found = mistakes(body("prismatic", turning));
  for (const char* const key : {"stiffness", "rest", "damping", "force"}) {
    BOOST_TEST(found.find(std::string(key) + ": '") != std::string::npos, found);
  }
  const auto both = scene(body("cylindrical", "damping = [\"1 N m s\", \"2 N s/m\"]")).bodies[0];
  BOOST_TEST(both.forces[1].damping == 2);
  BOOST_TEST(mistakes(body("cylindrical", "damping = \"2 N s/m\"")) ==
             "s.toml:6:11: body 'a'.damping: '2 N s/m' is a damping (N s/m), wanted a damping (N m "
             "s/rad)");
}

BOOST_AUTO_TEST_CASE(stand_anywhere_in_a_scene_file) {
  const SceneFile file = scene(R"toml(
[gravity]
kind = "uniform"
vector = [0, 0, "-9.81 m/s^2"]
[[body]]
name = "a"
joint = { kind = "screw", axis = [0, 0, 1], pitch = "2 mm/rad", position = ["1 cm", 0, 0] }
mass = "500 g"
centre = [0, "3 mm", 0]
inertia = ["3 kg m^2", 3, 3]
points = { tip = [0, 0, "5 cm"] }
drive = { rate = { constant = "60 rpm", rate = "1 deg/s^2", terms = [
  { amplitude = "1 deg/s", frequency = "2 Hz", phase = "90 deg" }] } }
load = { force = { steps = [["1 ms", ["1 kN", 0, 0]]] }, point = [0, 0, "1 m"] }
[[sensor]]
name = "g"
kind = "gyro"
body = "a"
at = "tip"
noise = "0.6 deg/sqrt(h)"
bias = "10 deg/h"
drift = "0.1 rad/s^2/sqrt(Hz)"
scale = "100 ppm"
[[sensor]]
name = "f"
kind = "accelerometer"
body = "a"
at = [0, 0, "1 cm"]
noise = "0.1 m/s^2/sqrt(Hz)"
correlation = { sigma = "1 mm/s^2", time = "2 min" }
[solve]
t_end = "1 min"
output_times = ["1 s", 2, "0.5 min"]
)toml");
  const BodyDescription& a = file.bodies[0];
  BOOST_TEST(a.inertia.value.mass == 0.5);
  BOOST_TEST(a.joint.pitch == 0.002);
  BOOST_TEST(a.joint.position.x() == 0.01);
  BOOST_TEST(file.points[0].at("tip").z() == 0.05);
  BOOST_TEST(std::abs(file.start[0].rates[0] - 361 * degree) < 1e-15);
  BOOST_TEST(file.discontinuities.front() == 0.001);
  BOOST_TEST(file.t_end == 60);
  BOOST_TEST(file.output_times == (std::vector<double>{1, 2, 30}));
  BOOST_TEST(std::abs(file.sensors[0].errors->noise.x() / (0.01 * degree) - 1) < 1e-15);
  BOOST_TEST(file.sensors[0].errors->bias.x() == 10.0 / 3600 * degree);
  BOOST_TEST(file.sensors[0].errors->drift.x() == 0.1);
  BOOST_TEST(file.sensors[0].errors->scale.x() == 1e-4);
  BOOST_TEST(file.sensors[1].errors->noise.x() == 0.1);
  BOOST_TEST(file.sensors[1].errors->correlation.sigma.x() == 0.001);
  BOOST_TEST(file.sensors[1].errors->correlation.time == 120);
}

BOOST_AUTO_TEST_CASE(are_refused_where_none_belongs) {
  const std::pair<std::string, std::string> cases[] = {
      {"initial = { angle_deg = \"3 deg\" }",
       "s.toml:6:25: body 'a'.initial.angle_deg: '3 deg' must be a plain number: the key is in "
       "degrees; units go into keys without _deg"},
      {"rotor = { mode = \"regulated\", speed_deg = { points = [[0, \"3 deg/s\"]] } }",
       "body 'a'.rotor.speed_deg.points[0][1]: '3 deg/s' must be a plain number"},
      {"damping = \"much\"", "body 'a'.damping: must be a number, not a text"},
      {"centre = [0, 0, \"5 kg\"]",
       "body 'a'.centre[2]: '5 kg' is a mass (kg), wanted a length (m)"},
      {"force = { rate = \"5 N m\" }", "body 'a'.force.rate: '5 N m' is a torque (N m), wanted"}};
  for (const auto& [keys, reason] : cases) {
    const std::string found = mistakes(body("revolute", keys));
    BOOST_TEST(found.find(reason) != std::string::npos, "wanted " << reason << "\nfound " << found);
  }
  // A function of time for two coordinates is read twice; its mistakes are reported once.
  const std::string found = mistakes(body("cylindrical", "force = { rate = true }"));
  BOOST_TEST(found == "s.toml:6:18: body 'a'.force.rate: must be a number, not true or false");
}

BOOST_AUTO_TEST_CASE(are_read_at_keys_of_a_scene) {
  const std::string text = "a = '5 mm'\nb_deg = '2 deg'\nc = [\"2 rpm\", 3]\n";
  BOOST_TEST(number_in_scene(text, "a").value() == 0.005);
  BOOST_TEST(number_in_scene(text, "c[0]").value() == 12 * degree);
  BOOST_TEST(!number_in_scene(text, "d.e"));
  BOOST_CHECK_THROW((void)number_in_scene(text, "c[2]"), InvalidInput);
  BOOST_CHECK_THROW((void)number_in_scene(text, "b_deg"), InvalidInput);
  for (const char* const wrong : {"a = 'x'", "a = '5 xx'", "a = true"}) {
    BOOST_CHECK_THROW((void)number_in_scene(wrong, "a"), InvalidInput);
  }
}

BOOST_AUTO_TEST_SUITE_END()
