// Elements of scene files: what is read, against closed forms, and what is refused.

#include <boost/test/unit_test.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <dynamics/file/columns.hpp>
#include <dynamics/file/model.hpp>
#include <dynamics/file/readings.hpp>

#include <support/scene_text.hpp>

using namespace kreisel;
using test::body;
using test::end;
using test::mistakes;
using test::scene;

namespace {

const std::string slide = "{ kind = \"prismatic\", axis = [1, 0, 0] }";
const std::string hinge = "{ kind = \"revolute\", axis = [0, 0, 1] }";
const std::string floating = "{ kind = \"free\" }";
const std::string run_part = "[solve]\nt_end = 0.7\ntolerance = 1e-11\n";

std::string element(const std::string& keys) { return "[[element]]\n" + keys + "\n"; }

const std::string named_spring = "name = \"s\"\nkind = \"spring\"\nbetween = [\"a\", \"b\"]\n";
const std::string named_rope = "name = \"r\"\nkind = \"rope\"\nbetween = [\"a\", \"b\"]\n";
const std::string named_mount = "name = \"m\"\nkind = \"mount\"\nbetween = [\"guide\", \"a\"]\n";
const std::string named_gear = "name = \"g\"\nkind = \"gear\"\njoints = [\"a\", \"b\"]\n";

const std::string sliders = body("a", slide) + body("b", slide, "initial = { displacement = 0.8 }");
const std::string wheels = body("a", hinge, "initial = { angle = 0.3 }") + body("b", hinge);

}  // namespace

BOOST_AUTO_TEST_SUITE(elements_of_a_scene_file)

BOOST_AUTO_TEST_CASE(a_spring_swings_two_masses) {
  const auto stretch = [](const std::string& law) {
    const JointState state = end(sliders + element(named_spring + law) + run_part);
    return state.coordinates[1] - state.coordinates[0] - 0.5;
  };
  const double expected = 0.3 * std::cos(0.7 * std::sqrt(40.0));
  BOOST_TEST(std::abs(stretch("stiffness = \"0.04 N/mm\"\nlength = \"50 cm\"") - expected) <=
             1e-10);
  BOOST_TEST(std::abs(stretch("table = [[0, -20], [1, \"20 N\"]]") - expected) <= 1e-10);
  const double w = std::sqrt(40 - 9.0);  // damping 6 N s/m: delta = 3/s
  const double damped = std::exp(-2.1) * 0.3 * (std::cos(0.7 * w) + 3 / w * std::sin(0.7 * w));
  BOOST_TEST(std::abs(stretch("stiffness = 40\nlength = 0.5\ndamping = \"6 N s/m\"") - damped) <=
             1e-10);
}

// The hook, 2 kg, hangs on a winch that pulls it up at 0.3 m/s from t = 0.2 s on.
BOOST_AUTO_TEST_CASE(a_winch_pulls_a_hook) {
  const std::string hook =
      "[gravity]\nkind = \"uniform\"\nvector = [0, 0, -10]\n" +
      body("a", "{ kind = \"prismatic\", axis = [0, 0, 1] }", "initial = { displacement = -1.1 }") +
      element(
          "name = \"r\"\nkind = \"rope\"\nbetween = [\"guide\", \"a\"]\nstiffness = 200\n"
          "length = { points = [[0, 1], [0.2, 1], [1.2, 0.7]] }") +
      "[report]\nelements = true\n" + run_part;
  const SceneFile file = scene(hook);
  BOOST_TEST(file.discontinuities == (std::vector<double>{0.2}), boost::test_tools::per_element());
  BOOST_TEST(file.forces_change);
  const double w = 10, t = 0.5;
  const double stretch = 0.1 + 0.3 / w * std::sin(w * t);
  BOOST_TEST(std::abs(end(hook).coordinates[0] + 1 - 0.3 * t + stretch) <= 1e-10);
}

BOOST_AUTO_TEST_CASE(a_gear_joins_two_wheels) {
  const std::string law = "ratio = -2\nstiffness = \"20 N m/rad\"\n";
  const double w = std::sqrt(20 / 0.5 * 5);
  for (const char* const kind : {"gear", "coupling"}) {
    const std::string named =
        "name = \"g\"\nkind = \"" + std::string(kind) + "\"\njoints = [\"a\", \"b\"]\n";
    const JointState state = end(wheels + element(named + law) + run_part);
    BOOST_TEST(std::abs(state.coordinates[0] + 2 * state.coordinates[1] -
                        0.3 * std::cos(0.7 * w)) <= 1e-10);
  }
}

BOOST_AUTO_TEST_CASE(reads_every_key_of_a_mount) {
  const auto read = scene(
      body("a", floating, "points = { foot = [0, 0.2, 0] }") +
      element(named_mount +
              "at = [[\"5 mm\", 0, 1], \"foot\"]\naxes = [0, 0, 0, 1]\n"
              "stiffness = [1, 2, \"3 N/mm\"]\nturning_stiffness = [[4, 1, 0], [0, 5, 0], [0, 0, "
              "\"6 N m/rad\"]]\ncoupling = [[1, 2, 3], [4, 5, 6], [7, 8, 9]]\n"
              "damping = [7, 8, 9]\nturning_damping = [1, 2, \"3 N m s/rad\"]\n"
              "preload = [1, 2, 3, 4, 5, \"6 N m\"]") +
      run_part);
  const auto& mount = std::get<MountElement>(read.elements.at(0));
  BOOST_TEST(mount.name == "m");
  BOOST_TEST(mount.ends[0].body == "guide");
  BOOST_TEST(mount.ends[1].body == "a");
  BOOST_TEST(mount.ends[0].at == Vector3<double>(0.005, 0, 1));
  BOOST_TEST(mount.ends[1].at == Vector3<double>(0, 0.2, 0));
  BOOST_TEST(mount.axes.z() == 1);
  BOOST_TEST(mount.stiffness.rm.diagonal() == Vector3<double>(1, 2, 3000));
  BOOST_TEST(mount.stiffness.mr(0, 1) == 1);
  BOOST_TEST(mount.stiffness.mr(2, 2) == 6);
  BOOST_TEST(mount.stiffness.rr(0, 2) == 3);
  BOOST_TEST(mount.stiffness.mm(2, 0) == 3);
  BOOST_TEST(mount.damping.rm.diagonal() == Vector3<double>(7, 8, 9));
  BOOST_TEST(mount.damping.mr.diagonal() == Vector3<double>(1, 2, 3));
  BOOST_TEST(mount.preload.resultant == Vector3<double>(1, 2, 3));
  BOOST_TEST(mount.preload.moment == Vector3<double>(4, 5, 6));
  BOOST_TEST(!mount.has_potential());
}

// The mount carries the weight. The sensor moves the torque to the body's origin and writes it on
// the guide's axes.
BOOST_AUTO_TEST_CASE(forces_are_columns_and_readings) {
  const std::string text =
      "[gravity]\nkind = \"uniform\"\nvector = [0, 0, -10]\n" + body("a", floating) +
      element(named_mount +
              "at = [[0.5, 0, 0], [0.5, 0, 0]]\naxes = [0.6, 0.8, 0, 0]\nstiffness = [9, 9, 9]\n"
              "preload = [0, 19.2, -5.6, 0, 10, 0]") +
      "[[sensor]]\nname = \"own\"\nkind = \"reaction\"\nelement = \"m\"\n"
      "[[sensor]]\nname = \"moved\"\nkind = \"reaction\"\nelement = \"m\"\nat = [0, 0, 0]\naxes = "
      "\"a\"\n[report]\nelements = true\n" +
      run_part;
  const SceneFile read = scene(text);
  const auto model = make_model(read);
  const std::vector<std::string> names = columns(read);
  std::vector<double> numbers = row(*model, 0, start_of(read), {.elements = true});
  const std::vector<double> readings = SensorReadings(read).row(*model, 0, start_of(read));
  numbers.insert(numbers.end(), readings.begin(), readings.end());
  BOOST_TEST_REQUIRE(names.size() == numbers.size());
  const auto value = [&](const std::string& name) {
    const auto found = std::find(names.begin(), names.end(), name);
    BOOST_TEST_REQUIRE((found != names.end()), name);
    return numbers[std::size_t(found - names.begin())];
  };
  for (const char* const own : {"m", "own", "moved"}) {
    BOOST_TEST(std::abs(value(std::string(own) + ".force y")) <= 1e-14);
    BOOST_TEST(std::abs(value(std::string(own) + ".force z") - 20) <= 1e-13);
  }
  BOOST_TEST(std::abs(value("own.torque y") + 2.8) <= 1e-14);
  BOOST_TEST(std::abs(value("moved.torque y") + 2.8 + 10) <= 1e-13);
  BOOST_TEST(std::abs(value("m.torque z") - 9.6) <= 1e-14);
}

BOOST_AUTO_TEST_CASE(refuses_wrong_elements) {
  const std::string bodies = body("a", hinge, "points = { tip = [1, 0, 0] }") + body("b", hinge) +
                             body("c", floating) +
                             body("w", hinge, "rotor = { mode = \"free\", speed = 3 }");
  const std::pair<std::string, const char*> cases[] = {
      {named_spring, "element 's'.stiffness: is missing"},
      {"kind = \"spring\"\nbetween = [\"a\", \"b\"]\nstiffness = 1", "element[0].name: is missing"},
      {"name = \"\"\nkind = \"spring\"\nbetween = [\"a\", \"b\"]\nstiffness = 1", "is empty"},
      {"name = \"a\"\nkind = \"spring\"\nbetween = [\"a\", \"b\"]\nstiffness = 1",
       "'a' is the name of a body"},
      {"name = \"s\"\nbetween = [\"a\", \"b\"]", "element 's'.kind: is missing"},
      {"name = \"s\"\nkind = \"sprung\"", "did you mean 'spring'?"},
      {named_rope + "stiffness = 1", "element 'r'.length: is missing"},
      {named_rope + "length = 1", "element 'r'.stiffness: is missing"},
      {named_rope + "length = 1\nstiffness = -1", "must be"},
      {named_rope + "length = -1\nstiffness = 1", "must not be below 0"},
      {named_rope + "stiffness = 1\nlength = { steps = [[0, 2], [1, 3]] }", "a winch needs time"},
      {named_rope + "stiffness = 1\nlength = 1\ntable = [[1, 2], [2, 3]]", "is no key here"},
      {"name = \"s\"\nkind = \"spring\"\nstiffness = 1", "element 's'.between: is missing"},
      {"name = \"s\"\nkind = \"spring\"\nstiffness = 1\nbetween = [\"a\"]", "two names, not 1"},
      {"name = \"s\"\nkind = \"spring\"\nstiffness = 1\nbetween = \"a\"", "list of texts"},
      {"name = \"s\"\nkind = \"spring\"\nstiffness = 1\nbetween = [\"a\", 3]", "must be a text"},
      {"name = \"s\"\nkind = \"spring\"\nstiffness = 1\nbetween = [\"a\", \"x\"]",
       "'x' is no body"},
      {"name = \"s\"\nkind = \"spring\"\nstiffness = 1\nbetween = [\"a\", \"a\"]", "twice"},
      {"name = \"s\"\nkind = \"spring\"\nstiffness = 1\nbetween = [\"a\", \"w\"]", "is a rotor"},
      {named_spring + "stiffness = 1\nat = [[0, 0, 0]]", "two points"},
      {named_spring + "stiffness = 1\nat = \"tip\"", "two points"},
      {named_spring + "stiffness = 1\nat = [\"top\", [0, 0, 0]]", "did you mean 'tip'?"},
      {named_spring + "stiffness = 1\nat = [\"tip\", [0, 0]]", "at[1]: must be 3 numbers, not 2"},
      {named_spring + "stiffness = 1\nat = [\"tip\", [0, 0, \"3 s\"]]", "at[1][2]"},
      {named_spring + "stiffness = 1\nat = [\"tip\", 3]", "at[1]: must be a list of numbers"},
      {named_spring + "stiffness = \"1 N\"", "s'.stiffness"},
      {named_spring + "stiffness = { constant = 3 }", "must be a number, not a table"},
      {named_spring + "stiffness = 0", "no stiffness and no damping"},
      {named_spring + "stiffness = 1\nlength = -1", "must not be below 0"},
      {named_spring + "stiffness = 1\ndamping = -1", "must not be below 0"},
      {named_spring + "stiffness = 1\nfoo = 1", "foo: is no key here"},
      {named_spring + "stiffness = 1\ntable = [[1, 2], [2, 3]]", "beside 'table'"},
      {named_spring + "table = 3", "list of pairs"},
      {named_spring + "table = [[1, 2]]", "two points [length, force]"},
      {named_spring + "table = [[1, 2, 3], [2, 4]]", "table[0]: must be two numbers"},
      {named_spring + "table = [[2, 2], [1, 4]]", "increasing lengths"},
      {named_spring + "table = [[-2, 2], [1, 4]]", "length below 0"},
      {named_mount, "element 'm'.stiffness: is missing"},
      {named_mount + "stiffness = [1, 2]", "must be 3 numbers, not 2"},
      {named_mount + "stiffness = [[1, 2, 3], [4, 5, 6]]", "3 rows of 3 numbers"},
      {named_mount + "damping = [1, -2, 3]", "below 0 along an axis"},
      {named_mount + "stiffness = [0, 0, 0]", "and so no force"},
      {named_mount + "stiffness = [1, 1, 1]\npreload = 5", "must be 6 numbers"},
      {named_mount + "stiffness = [1, 1, 1]\npreload = [1, 2, 3]", "must be 6 numbers, not 3"},
      {named_mount + "stiffness = [1, 1, 1]\naxes = [1, 1, 0, 0]", "norm"},
      {named_mount + "stiffness = [1, 1, 1]\nlength = 3", "length: is no key here"},
      {named_gear, "element 'g'.stiffness: is missing"},
      {named_gear + "stiffness = 1\nratio = 0", "must not be 0"},
      {named_gear + "stiffness = \"1 N/m\"", "g'.stiffness"},
      {named_gear + "stiffness = 1\nbetween = [\"a\", \"b\"]", "between: is no key here"},
      {"name = \"g\"\nkind = \"gear\"\nstiffness = 1", "joints: is missing"},
      {"name = \"g\"\nkind = \"gear\"\nstiffness = 1\njoints = [\"a\", \"guide\"]", "has no joint"},
      {"name = \"g\"\nkind = \"gear\"\nstiffness = 1\njoints = [\"a\", \"c\"]", "is free"},
      {"name = \"g\"\nkind = \"gear\"\nstiffness = 1\njoints = [\"a\", \"x\"]", "'x' is no joint"},
      {"name = \"g\"\nkind = \"gear\"\nstiffness = 1\njoints = [\"w\", \"a\"]", "is a rotor"}};
  for (const auto& [keys, why] : cases) {
    const std::string all = mistakes(bodies + element(keys) + run_part);
    BOOST_TEST((all.find(why) != std::string::npos), why << " is not in " << all);
  }
}

BOOST_AUTO_TEST_CASE(refuses_wrong_names_of_elements) {
  const std::string spring = element(named_spring + "stiffness = 1");
  BOOST_TEST(mistakes(wheels + spring + run_part) == "none");
  const std::pair<std::string, const char*> cases[] = {
      {spring + spring, "is used by an earlier element"},
      {spring + "[[sensor]]\nname = \"r\"\nkind = \"reaction\"\nelement = \"t\"\n",
       "'t' is no element"},
      {"[[sensor]]\nname = \"r\"\nkind = \"reaction\"\nelement = \"t\"\n", "there are none"},
      {spring + "[[sensor]]\nname = \"r\"\nkind = \"reaction\"\nelement = \"s\"\njoint = \"a\"\n",
       "exclude each other"},
      {spring + "[[sensor]]\nname = \"s\"\nkind = \"reaction\"\nelement = \"s\"\n",
       "second column 's.force x'"},
      {"element = 3\n", "must be a list of tables"},
      {"[element]\nname = \"s\"\n", "must be a list of tables"}};
  for (const auto& [keys, why] : cases) {
    const bool is_first = keys.starts_with("element");
    const std::string all =
        mistakes(is_first ? keys + wheels + run_part : wheels + keys + run_part);
    BOOST_TEST((all.find(why) != std::string::npos), why << " is not in " << all);
  }
}

BOOST_AUTO_TEST_SUITE_END()
