// Drag and magnets in scene files, against closed forms.

#include <Eigen/Core>
#include <boost/test/unit_test.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include <dynamics/decompositions.hpp>
#include <dynamics/file/model.hpp>
#include <dynamics/file/steady_motions.hpp>
#include <dynamics/file/study_system.hpp>

#include <support/scene_text.hpp>

using namespace kreisel;
using test::end;
using test::mistakes;
using test::scene;

namespace {

/// A body of 2 kg in a joint, with a load.
std::string body(const std::string& joint, const std::string& load, const std::string& rest = "") {
  return "[[body]]\nname = \"a\"\njoint = " + joint +
         "\nmass = 2\ninertia = [0.5, 0.4, 0.3]\nload = " + load + "\n" + rest +
         "\n[solve]\nt_end = 1.5\ntolerance = 1e-11\n";
}

const std::string weight = "[gravity]\nkind = \"uniform\"\nvector = [0, 0, -9.81]\n";
const std::string slide = "{ kind = \"prismatic\", axis = [0, 0, 1] }";
const std::string hinge = "{ kind = \"revolute\", axis = [0, 0, 1] }";
const std::string floating = "{ kind = \"free\" }";

}  // namespace

BOOST_AUTO_TEST_SUITE(loads_of_a_scene_file)

BOOST_AUTO_TEST_CASE(linear_drag_ends_a_fall) {
  const double speed =
      end(weight + body(slide, "{ kind = \"drag\", linear = [9, 9, 3] }")).rates[0];
  BOOST_TEST(std::abs(speed + 2 * 9.81 / 3 * (1 - std::exp(-1.5 * 1.5))) < 1e-9);
}

BOOST_AUTO_TEST_CASE(quadratic_drag_ends_a_fall) {
  const std::string load = "{ kind = \"drag\", quadratic = [9, 9, \"0.5 N s^2/m^2\"] }";
  const double terminal = std::sqrt(2 * 9.81 / 0.5);
  const JointState state = end(weight + body(slide, load));
  BOOST_TEST(std::abs(state.rates[0] + terminal * std::tanh(9.81 * 1.5 / terminal)) < 1e-9);
  const double way = terminal * terminal / 9.81 * std::log(std::cosh(9.81 * 1.5 / terminal));
  BOOST_TEST(std::abs(state.coordinates[0] + way) < 1e-9);
}

BOOST_AUTO_TEST_CASE(angular_drag_stops_a_spin) {
  const JointState state =
      end(body(hinge, "{ kind = \"drag\", angular = [7, 7, 0.6] }", "initial = { rate = 5 }"));
  BOOST_TEST(std::abs(state.rates[0] - 5 * std::exp(-0.6 / 0.3 * 1.5)) < 1e-9);
}

// A paddle on a hinge: the force at the point has the lever 0.5 m.
BOOST_AUTO_TEST_CASE(drag_acts_at_its_point) {
  const JointState state =
      end(body(hinge, "{ kind = \"drag\", linear = [0, 3, 0], point = [0.5, 0, 0] }",
               "initial = { rate = 5 }"));
  BOOST_TEST(std::abs(state.rates[0] - 5 * std::exp(-3 * 0.25 / 0.3 * 1.5)) < 1e-9);
}

// The medium turns with the guide: a body at rest on it feels nothing.
BOOST_AUTO_TEST_CASE(drag_is_relative_to_the_guide) {
  const std::string turning = "[guide]\nkind = \"rotating\"\nangular_velocity = [0, 0, 2]\n";
  const std::string load = "{ kind = \"drag\", linear = [3, 3, 3], angular = [1, 1, 1] }";
  BOOST_TEST(std::abs(end(turning + body(hinge, load)).rates[0]) < 1e-12);
}

// On body axes, 3 rows: v along x gives forces along x and y.
BOOST_AUTO_TEST_CASE(drag_matrix_is_on_body_axes) {
  const SceneFile file =
      scene(body(floating,
                 "{ kind = \"drag\", linear = [[1, 0, 0], [-1, 2, 0], [0, 0, 3]], quadratic = "
                 "[[0.5, 0, 0], [0, 0.5, 0.1], [0, 0.1, 0.5]], point = [0, 0, 2] }"));
  LoadContext<> s;
  s.X.value.rotation << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  s.V_rel.value = {{0, 1, 0}, {1, 0, 0}};  // at the point: [3, 0, 0]
  const auto [force, torque] = file.bodies[0].loads[0](s).value;
  BOOST_TEST((force - Vector3<double>(-3 - 4.5, 3, 0)).norm() < 1e-15);
  BOOST_TEST((torque - Vector3<double>(0, 0, 2).cross(force)).norm() < 1e-15);
}

// At rest |v| has no derivative, and the linear equations are those without the quadratic part.
BOOST_AUTO_TEST_CASE(quadratic_drag_is_linear_at_rest) {
  const auto matrix = [](const std::string& load) {
    const SceneFile file = scene(body(slide, load));
    const StudySystem system(file);
    return steady_motion::linearized(system, 0, Eigen::Vector2d(0.1, 0)).A;
  };
  const Eigen::MatrixXd both =
      matrix("{ kind = \"drag\", linear = [1, 1, 3], quadratic = [2, 2, 2] }");
  BOOST_TEST(both.allFinite());
  BOOST_TEST((both - matrix("{ kind = \"drag\", linear = [1, 1, 3] }")).norm() == 0);
}

BOOST_AUTO_TEST_CASE(magnet_swings_about_the_field) {
  const std::string load =
      "{ kind = \"magnet\", moment = [2, 0, 0], field = [\"0.6 T\", 0, \"30 mT\"] }";
  BOOST_TEST(mistakes(body(hinge, load)) != "none");  // mT is no unit of the table
  const SceneFile file =
      scene(body(hinge, "{ kind = \"magnet\", moment = [2, 0, 0], field = [\"0.6 T\", 0, 0.03] }",
                 "initial = { angle = 0.3 }"));
  BOOST_TEST(!file.forces_change);
  const StudySystem system(file);
  const Eigen::VectorXcd roots =
      eigenvalues(steady_motion::linearized(system, 0, Eigen::Vector2d(0, 0)).A);
  BOOST_TEST(std::abs(std::abs(roots[0].imag()) - std::sqrt(2 * 0.6 / 0.3)) < 1e-12);
  const auto model = make_model(file);
  const auto run = model->solve(options_of(file), start_of(file));
  const auto energy = model->conserved(0, run.states.front());
  BOOST_TEST_REQUIRE(!energy.empty());
  BOOST_TEST(energy[0].first == "energy");
  const double rate = run.states.back().rates[0];
  const double angle = run.states.back().coordinates[0];
  const double wanted = -1.2 * std::cos(0.3);
  BOOST_TEST(std::abs(0.15 * rate * rate - 1.2 * std::cos(angle) - wanted) < 1e-9);
  BOOST_TEST(std::abs(model->conserved(1.5, run.states.back())[0].second - energy[0].second) <
             1e-9);
}

// A compass on a turned body: the field is on guide axes, the moment on the body's.
BOOST_AUTO_TEST_CASE(magnet_follows_a_changing_field) {
  const std::string load =
      "{ kind = \"magnet\", moment = [2, 0, 0], field = { steps = [[0, [0, 0, 0]], [1, [0, 0.5, "
      "0]]] "
      "} }";
  const SceneFile file = scene(body(hinge, load));
  BOOST_TEST(file.forces_change);
  BOOST_TEST(file.discontinuities == std::vector<double>({1}));
  const auto model = make_model(file);
  BOOST_TEST(model->conserved(0, start_of(file)).empty());
  const JointState state = end(body(hinge, load));
  // 0.3 a'' = cos a from rest at t = 1: the energy says a'^2 = 2/0.3 sin a.
  BOOST_TEST(state.coordinates[0] > 0.3);
  BOOST_TEST(std::abs(state.rates[0] * state.rates[0] - 2 / 0.3 * std::sin(state.coordinates[0])) <
             1e-9);
}

BOOST_AUTO_TEST_CASE(mistakes_in_loads_are_reported) {
  const std::pair<std::string, std::string> cases[] = {
      {"{ kind = \"wind\" }",
       "s.toml:6:17: body 'a'.load.kind: 'wind' is none of 'force', 'drag' or 'magnet'"},
      {"{ kind = \"drag\" }", "s.toml:6:8: body 'a'.load.linear: is missing"},
      {"{ kind = \"drag\", force = [1, 0, 0], linear = [1, 1, 1] }",
       "s.toml:6:25: body 'a'.load.force: is no key here"},
      {"{ kind = \"drag\", linear = [1, -1, 1] }",
       "s.toml:6:34: body 'a'.load.linear: would drive the body: its symmetric part must have no "
       "negative eigenvalue"},
      {"{ kind = \"drag\", angular = [[1, 3, 0], [0, 1, 0], [0, 0, 1]] }",
       "s.toml:6:35: body 'a'.load.angular: would drive the body: its symmetric part must have no "
       "negative eigenvalue"},
      {"{ kind = \"drag\", quadratic = [[1, 0, 0], [0, 1, 0]] }",
       "s.toml:6:37: body 'a'.load.quadratic: must be 3 numbers, or 3 rows of 3 numbers"},
      {"{ kind = \"drag\", quadratic = [[1, 0, 0], [0, 1], [0, 0, 1]] }",
       "s.toml:6:37: body 'a'.load.quadratic: must be 3 numbers, or 3 rows of 3 numbers"},
      {"{ kind = \"drag\", quadratic = [1, 2] }",
       "s.toml:6:37: body 'a'.load.quadratic: must be 3 numbers, not 2"},
      {"{ kind = \"drag\", linear = [\"1 N\", 1, 1] }",
       "s.toml:6:35: body 'a'.load.linear[0]: '1 N' is a force (N), wanted a damping (N s/m)"},
      {"{ kind = \"magnet\", moment = [1, 0, 0] }", "s.toml:6:8: body 'a'.load.field: is missing"},
      {"{ kind = \"magnet\", field = [1, 0, 0] }", "s.toml:6:8: body 'a'.load.moment: is missing"},
      {"{ kind = \"magnet\", moment = [1, 0, 0], field = [1, 0, 0], axes = \"body\" }",
       "body 'a'.load.axes: is no key here"},
  };
  for (const auto& [load, reason] : cases) {
    const std::string found = mistakes(body(hinge, load));
    BOOST_TEST(found.find(reason) != std::string::npos, "wanted " << reason << "\nfound " << found);
  }
}

BOOST_AUTO_TEST_SUITE_END()
