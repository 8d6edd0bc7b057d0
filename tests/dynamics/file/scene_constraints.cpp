// Constraints of scene files: what is read, the start, and what is refused.

#include <boost/test/unit_test.hpp>

#include <cmath>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <dynamics/file/columns.hpp>
#include <dynamics/file/contacts.hpp>
#include <dynamics/file/model.hpp>
#include <dynamics/file/readings.hpp>

#include <support/scene_text.hpp>

using namespace kreisel;
using test::body;
using test::end;
using test::mistakes;
using test::scene;

namespace {

std::string hinge(double x) {
  return "{ kind = \"revolute\", axis = [0, 1, 0], position = [" + std::to_string(x) + ", 0, 0] }";
}

const std::string floating = "{ kind = \"free\" }";
const std::string weight = "[gravity]\nkind = \"uniform\"\nvector = [0, 0, -10]\n";
const std::string run_part = "[solve]\nt_end = 0.7\ntolerance = 1e-11\n";

std::string condition(const std::string& keys) { return "[[constraint]]\n" + keys + "\n"; }

/// Two cranks of length 1 at a distance of 2, and a rod on the left one.
std::string linkage(const std::string& left, const std::string& right, const std::string& rod) {
  return body("left", hinge(0), "initial = { angle = " + left + " }") +
         body("right", hinge(2), "initial = { angle = " + right + " }") +
         body("rod", "{ kind = \"revolute\", axis = [0, 1, 0], position = [0, 0, -1] }",
              "parent = \"left\"\npoints = { end = [2, 0, 0] }\ninitial = { angle = " + rod + " }");
}

const std::string loop = condition(
    "name = \"loop\"\nkind = \"revolute\"\nbetween = [\"right\", \"rod\"]\n"
    "at = [[0, 0, \"-100 cm\"], \"end\"]\naxis = [0, 1, 0]");

}  // namespace

BOOST_AUTO_TEST_SUITE(constraints_of_a_scene_file)

// A free body in a hinge to the guide, against the same body in that joint.
BOOST_AUTO_TEST_CASE(a_hinge_is_a_joint) {
  const std::string centre = "centre = [0, 0, -0.5]\n";
  const JointState tree = end(
      weight +
      body("a", "{ kind = \"revolute\", axis = [0, 1, 0] }", centre + "initial = { angle = 0.8 }") +
      run_part);
  const JointState loose =
      end(weight +
          body("a", floating,
               centre + "initial = { attitude = [0.92106099400288508, 0, "
                        "0.38941834230865049, 0] }") +
          condition(
              "name = \"h\"\nkind = \"revolute\"\nbetween = [\"guide\", \"a\"]\naxis = [0, 1, 0]") +
          run_part);
  const double angle = 2 * std::atan2(loose.coordinates[1], loose.coordinates[3]);
  BOOST_TEST(std::abs(angle - tree.coordinates[0]) <= 1e-10);
  BOOST_TEST(std::abs(loose.rates[1] - tree.rates[0]) <= 1e-10);
}

BOOST_AUTO_TEST_CASE(a_start_is_assembled) {
  const std::string off = weight + linkage("0.5", "0.52", "-0.5") + loop;
  BOOST_TEST(mistakes(off + run_part).find("constraint 'loop': the start is off by 0.0") !=
             std::string::npos);
  const SceneFile file = scene(off + run_part + "assemble = true\n");
  const double left = file.start[0].coordinates[0];
  const double right = file.start[1].coordinates[0];
  BOOST_TEST(std::abs(left - right) <= 1e-14);
  BOOST_TEST(std::abs(left - 0.5) <= 0.02);
  BOOST_TEST_REQUIRE(file.redundant_constraints.size() == 1U);
  BOOST_TEST(file.redundant_constraints[0].redundant == 3);
}

BOOST_AUTO_TEST_CASE(reactions_are_columns_and_readings) {
  const std::string text =
      weight + body("a", floating, "centre = [0, 0, -0.5]\npoints = { tip = [0, 0, -1] }") +
      condition("name = \"h\"\nkind = \"point\"\nbetween = [\"guide\", \"a\"]") +
      "[[sensor]]\nname = \"pull\"\nkind = \"reaction\"\nconstraint = \"h\"\n"
      "[report]\nconstraints = true\n" +
      run_part;
  const SceneFile file = scene(text);
  const auto names = columns(file);
  BOOST_TEST(names.at(14) == "h.force x");
  BOOST_TEST(names.at(20) == "pull.force x");
  const auto model = make_model(file);
  const auto state = start_of(file);
  const auto numbers = row(*model, 0, state, {false, false, true});
  BOOST_TEST(std::abs(numbers.at(16) - 20) <= 1e-13);
  const auto read = SensorReadings(file).row(*model, 0, state);
  BOOST_TEST(std::abs(read.at(2) - 20) <= 1e-13);
}

// With gravity upward a ball on the plane is held by its contact alone.
BOOST_AUTO_TEST_CASE(a_contact_that_pulls_is_told) {
  const auto pulls = [](const std::string& gravity) {
    const SceneFile file =
        scene("[gravity]\nkind = \"uniform\"\nvector = [0, 0, " + gravity + "]\n" +
              body("a", floating, "initial = { position = [0, 0, 0.3] }") +
              condition("name = \"x\"\nkind = \"rolling\"\nbody = \"a\"\nradius = 0.3\n"
                        "plane = { normal = [0, 0, 2] }") +
              run_part);
    return pulling_contacts(file, *make_model(file), run_scene(file));
  };
  BOOST_TEST(pulls("-10").empty());
  const auto found = pulls("10");
  BOOST_TEST_REQUIRE(found.size() == 1U);
  BOOST_TEST(found[0].constraint == "x");
  BOOST_TEST(std::abs(found[0].force + 20) <= 1e-13);
}

BOOST_AUTO_TEST_CASE(reads_every_kind) {
  const std::string bodies =
      body("a", floating) + body("b", floating) + body("c", hinge(0)) + body("d", hinge(3));
  const auto read = [&](const std::string& keys) {
    return scene(bodies + condition("name = \"x\"\n" + keys) + run_part + "assemble = true\n")
        .constraints.at(0);
  };
  const std::string pair = "between = [\"a\", \"b\"]\n";
  using namespace constraint;
  BOOST_TEST(std::holds_alternative<Point>(read("kind = \"point\"\n" + pair).kind));
  const auto distance = std::get<Distance>(
      read("kind = \"distance\"\nat = [[0, 0, 0.1], [0, 0, 0]]\nlength = \"20 cm\"\n" + pair).kind);
  BOOST_TEST(distance.length == 0.2);
  const auto universal = std::get<Universal>(
      read("kind = \"universal\"\naxis = [[1, 0, 0], [0, 1, 0]]\n" + pair).kind);
  BOOST_TEST(universal.axis_of_second.y() == 1);
  BOOST_TEST(std::holds_alternative<Fixed>(read("kind = \"fixed\"\n" + pair).kind));
  const auto slide =
      std::get<Prismatic>(read("kind = \"prismatic\"\naxis = [0, 0, 2]\n" + pair).kind);
  BOOST_TEST(slide.axis.z() == 2);
  const auto gear = std::get<Gear>(
      read("kind = \"gear\"\njoints = [\"c\", \"d\"]\nratio = -2\noffset = \"90 deg\"").kind);
  BOOST_TEST(gear.ratio == -2);
  BOOST_TEST(std::abs(gear.offset - std::acos(0.0)) <= 1e-15);
  const auto rolling = std::get<Rolling>(
      read("kind = \"rolling\"\nbody = \"a\"\nradius = 0.3\naxis = [0, 1, 0]\ntube = \"1 cm\"\n"
           "plane = { point = [0, 0, -0.2], normal = [0, 0, 1] }")
          .kind);
  BOOST_TEST(rolling.tube == 0.01);
  BOOST_TEST(rolling.point.z() == -0.2);
  const auto blade = std::get<Blade>(
      read("kind = \"blade\"\nbody = \"a\"\nat = [1, 0, 0]\ndirection = [0, 1, 0]").kind);
  BOOST_TEST(blade.at.x() == 1);
}

BOOST_AUTO_TEST_CASE(wrong_keys_are_told) {
  const std::string bodies = body("a", floating) + body("b", hinge(0));
  const std::vector<std::pair<std::string, std::string>> cases{
      {"kind = \"point\"", "constraint 'x'.between: is missing"},
      {"kind = \"weld\"", "'weld' is none of 'point'"},
      {"kind = \"revolute\"\nbetween = [\"a\", \"b\"]", "'x'.axis: is missing"},
      {"kind = \"revolute\"\nbetween = [\"a\", \"b\"]\naxis = [0, 0, 0]",
       "is 0 and has no direction"},
      {"kind = \"universal\"\nbetween = [\"a\", \"b\"]\naxis = [0, 0, 1]", "must be two axes"},
      {"kind = \"distance\"\nbetween = [\"a\", \"b\"]\nlength = \"2 kg\"", "length"},
      {"kind = \"gear\"\njoints = [\"a\", \"b\"]\nratio = 2", "take joints with one coordinate"},
      {"kind = \"rolling\"\nbody = \"a\"\nradius = 1\ntube = 0.1\nplane = { normal = [0, 0, 1] }",
       "is for a wheel"},
      {"kind = \"rolling\"\nbody = \"a\"\nradius = 1", "'x'.plane: is missing"},
      {"kind = \"blade\"\nbody = \"c\"\ndirection = [1, 0, 0]", "'c' is no body"},
      {"kind = \"point\"\nbetween = [\"a\", \"b\"]\nstiffness = 3", "stiffness: is no key here"}};
  for (const auto& [keys, reason] : cases) {
    const std::string found =
        mistakes(bodies + condition("name = \"x\"\n" + keys) + run_part + "assemble = true\n");
    BOOST_TEST(found.find(reason) != std::string::npos, "wanted " << reason << "\nfound " << found);
  }
  const std::string twice =
      condition("name = \"x\"\nkind = \"point\"\nbetween = [\"guide\", \"a\"]");
  BOOST_TEST(mistakes(bodies + twice + twice + run_part).find("is used by an earlier") !=
             std::string::npos);
}

// The fixed point lies 5 m below the guide, out of the reach of 1 m.
BOOST_AUTO_TEST_CASE(contradictions_are_told) {
  const std::string far =
      body("a", hinge(0)) +
      condition(
          "name = \"x\"\nkind = \"point\"\nbetween = [\"guide\", \"a\"]\nat = [[0, 0, 5], [0, "
          "0, 1]]");
  BOOST_TEST(mistakes(far + run_part + "assemble = true\n").find("no state near the start") !=
             std::string::npos);
}

BOOST_AUTO_TEST_CASE(conditions_without_direction_are_told) {
  const std::string wheel =
      "name = \"x\"\nkind = \"rolling\"\nbody = \"a\"\nradius = 0.3\naxis = [0, 0, 1]\n"
      "plane = { normal = [0, 0, 1] }";
  const std::string rod =
      "name = \"x\"\nkind = \"distance\"\nbetween = [\"guide\", \"a\"]\nlength = 0.3";
  for (const std::string& keys : {wheel, rod}) {
    const std::string found =
        mistakes(body("a", floating) + condition(keys) + run_part + "assemble = true\n");
    BOOST_TEST(found.find("constraint 'x': it has no direction here") != std::string::npos, found);
  }
}

BOOST_AUTO_TEST_SUITE_END()
