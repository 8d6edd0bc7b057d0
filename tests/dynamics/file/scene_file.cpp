// The contents of scene files, against the equivalent objects of the library.

#include <boost/test/unit_test.hpp>

#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include <dynamics/file/model.hpp>
#include <dynamics/file/motion_log.hpp>
#include <dynamics/file/scene_system.hpp>
#include <dynamics/guide/chain.hpp>
#include <dynamics/guide/earth_frame.hpp>
#include <dynamics/guide/orbit.hpp>
#include <dynamics/guide/rotating.hpp>
#include <dynamics/tree/body_system.hpp>
#include <dynamics/tree/joint/list.hpp>

#include <support/scene_text.hpp>
#include <support/scratch.hpp>

using namespace kreisel;
using test::mistakes;
using test::scene;

namespace {

const std::string body = R"(
[[body]]
name = "a"
joint = { kind = "revolute", axis = [0, 0, 1] }
mass = 2
inertia = [1, 1, 1]
)";
const std::string site = "kind = \"earth\"\nlatitude_deg = 50\nheight = 100\nazimuth_deg = 30\n";
const std::string orbit =
    "kind = \"orbit\"\nsemi_major_axis = 7e6\neccentricity = 0.1\ninclination = 1\nnode_deg = "
    "90\nperigee = 0.5\nanomaly = 2\n";
const std::string run = "[solve]\nt_end = 4\n";

/// All kinds of joints, as listed in a message.
std::string joint_names() {
  std::string names;
  for (const JointType& type : joint_types()) {
    const bool last = &type == &joint_types().back();
    names += (names.empty() ? "'" : last ? " or '" : ", '") + type.name + "'";
  }
  return names;
}

/// The joint and further keys of a body with one inertia.
std::string one_body(const std::string& rest) {
  return "[[body]]\nname = \"a\"\nmass = 2\ninertia = [1, 1, 1]\n" + rest + "\n" + run;
}

template <class M>
void check_same(const SceneGuide& guide, const M& motion) {
  for (const double t : {0.0, 0.7, 3.999, 4.0}) {
    const auto a = guide(t);
    const FrameMotion<Guide, Inertial> b = motion(t);
    BOOST_TEST((a.X.value.rotation == b.X.value.rotation));
    BOOST_TEST((a.X.value.translation == b.X.value.translation));
    BOOST_TEST((a.V.value.resultant == b.V.value.resultant));
    BOOST_TEST((a.V.value.moment == b.V.value.moment));
    BOOST_TEST((a.dV.value.resultant == b.dV.value.resultant));
    BOOST_TEST((a.dV.value.moment == b.dV.value.moment));
  }
}

SceneGuide guide(const std::string& text) { return make_guide(scene(text + body + run)); }

}  // namespace

BOOST_AUTO_TEST_SUITE(guides_of_a_scene_file)

BOOST_AUTO_TEST_CASE(rest_by_default) {
  BOOST_TEST(scene(body + run).rests());
  BOOST_TEST(scene("[guide]\nkind = \"inertial\"\n" + body + run).rests());
  check_same(guide(""), RestingFrame<>{});
}

BOOST_AUTO_TEST_CASE(rotate_as_in_the_library) {
  const std::string text =
      "[guide]\nkind = \"rotating\"\nangular_velocity = [1, 2, 3]\norigin_acceleration = [4, 5, "
      "6]\n";
  BOOST_TEST(!scene(text + body + run).rests());
  check_same(guide(text), RotatingFrame<>{{1, 2, 3}, {4, 5, 6}});
}

BOOST_AUTO_TEST_CASE(oscillate_as_in_the_library) {
  const SceneGuide read = guide(R"([guide]
kind = "harmonic"
angular_velocity = { constant = [0.1, 0, 0], terms = [
  { amplitude = [0, 0.2, 0], frequency = 3, phase_deg = 180 } ] }
origin_acceleration = { terms = [ { amplitude = [1, 0, 2], frequency = 2, phase = 0.5 } ] }
)");
  const double half_turn = 180 * 0.017453292519943295;
  check_same(read, HarmonicFrame<>({{0.1, 0, 0}, {{{0, 0.2, 0}, 3, half_turn}}},
                                   {{0, 0, 0}, {{{1, 0, 2}, 2, 0.5}}}, 0, 4 * (1 + 1e-12)));
}

BOOST_AUTO_TEST_CASE(move_on_the_earth_as_in_the_library) {
  check_same(guide("[guide]\n" + site), earth_frame({50, 30, 100}));
  check_same(guide("[guide]\n" + site + "rate = 0.5e-4\n"), earth_frame({50, 30, 100, 0.5e-4}));
  // A gravity given as a number includes the centrifugal part.
  check_same(guide("[guide]\n" + site + "gravity = 9.81\n"),
             RotatingFrame<>{earth_rotation(EarthSite<>{50, 30, 100})});
}

BOOST_AUTO_TEST_CASE(go_along_an_orbit_as_the_library_has_it) {
  OrbitElements<> o{.semi_major_axis = 7e6,
                    .eccentricity = 0.1,
                    .inclination = 1,
                    .node = 90 * 0.017453292519943295,
                    .perigee = 0.5,
                    .anomaly = 2};
  check_same(guide("[guide]\n" + orbit), OrbitFrame<>(o));
  o.parameter = 4.9e12;
  o.j2 = 1.08262982131e-3;
  check_same(guide("[guide]\n" + orbit + "mu = 4.9e12\nj2 = true\n"), OrbitFrame<>(o));
  check_same(guide("[guide]\nkind = \"orbit\"\nsemi_major_axis = 8e6\n"),
             OrbitFrame<>(OrbitElements<>{.semi_major_axis = 8e6}));
}

BOOST_AUTO_TEST_CASE(follow_a_log_beside_the_scene) {
  const test::Scratch folder;
  std::string log = "t,qw,qx,qy,qz\n";
  for (int i = 0; i <= 10; ++i) {
    const double angle = 0.1 * i;
    log += std::to_string(0.5 * i) + "," + std::to_string(std::cos(angle)) + "," +
           std::to_string(std::sin(angle)) + ",0,0\n";
  }
  const auto file = folder.write("log.csv", log);
  const std::string text = "[guide]\nkind = \"table\"\nfile = \"log.csv\"\n" + body + run;
  const SceneFile read = parse_scene(text, folder.path() / "scene.toml");
  check_same(make_guide(read), TabulatedFrame<>(read_motion_log(file).motion));
  // The log ends at 5 s.
  BOOST_CHECK_THROW((void)parse_scene(text, folder.path() / "scene.toml", {.t_end = 5.1}),
                    SceneMistakes);
}

BOOST_AUTO_TEST_CASE(integrate_logged_rates) {
  const test::Scratch folder;
  std::string table = "t,wx,wy,wz,ax,ay,az\n";
  RatesLog log;
  for (int i = 0; i <= 10; ++i) {
    const double t = 0.5 * i;
    log.times.push_back(t);
    log.angular_velocities.emplace_back(0.25 * i, -0.125, 0);
    log.accelerations.emplace_back(0, 0.5 * i, 9.75);
    table += std::to_string(t) + "," + std::to_string(0.25 * i) + ",-0.125,0,0," +
             std::to_string(0.5 * i) + ",9.75\n";
  }
  (void)folder.write("log.csv", table);
  const auto read = [&](const std::string& keys, const std::string& more = "") {
    const std::string text =
        "[guide]\nkind = \"rates\"\nfile = \"log.csv\"\n" + keys + more + body + run;
    return make_guide(parse_scene(text, folder.path() / "scene.toml"));
  };
  const Vector3<double> gravity(0, 0, -9.75);
  check_same(
      read("gravity = [0, 0, -9.75]\nattitude = [0, 1, 0, 0]\norigin_velocity = [1, 2, 3]\n"),
      RatesFrame<>(log, {{0, 1, 0, 0}, {1, 2, 3}, gravity}));
  check_same(read("", "[gravity]\nkind = \"inertial\"\nvector = [0, 0, -9.75]\n"),
             RatesFrame<>(log, {Eigen::Quaterniond::Identity(), {0, 0, 0}, gravity}));
  check_same(read("acceleration = \"kinematic\"\n"), RatesFrame<>(log));
  BOOST_CHECK_THROW((void)read(""), SceneMistakes);
  BOOST_CHECK_THROW((void)read("acceleration = \"kinematic\"\ngravity = [0, 0, 1]\n"),
                    SceneMistakes);
  BOOST_CHECK_THROW((void)read("gravity = [0, 0, 1]\nattitude = [2, 0, 0, 0]\n"), SceneMistakes);
  BOOST_CHECK_THROW((void)read("gravity = [0, 0, 1]\nsigma = -1\n"), SceneMistakes);
}

// A frame without logged accelerations is not accelerated, and does not fall.
BOOST_AUTO_TEST_CASE(rates_without_accelerations_do_not_fall) {
  const test::Scratch folder;
  (void)folder.write("log.csv", "t,wx,wy,wz\n0,0,0,1\n2,0,0,1\n4,0,0,1\n6,0,0,1\n");
  const auto read = [&](const std::string& keys, const std::string& more = "") {
    const std::string text =
        "[guide]\nkind = \"rates\"\nfile = \"log.csv\"\n" + keys + more + body + run;
    return parse_scene(text, folder.path() / "scene.toml");
  };
  const SceneFile scene = read("", "[gravity]\nkind = \"inertial\"\nvector = [0, 0, -9.81]\n");
  const auto& rates = std::get<scene_guide::Rates>(scene.guide.front());
  BOOST_TEST(rates.start.gravity.isZero(0));
  BOOST_CHECK_THROW((void)read("gravity = [0, 0, -9.81]\n"), SceneMistakes);
}

BOOST_AUTO_TEST_CASE(chain_as_in_the_library) {
  struct Earth;
  struct Ship;
  const SceneGuide read = guide("[guide]\nkind = \"chain\"\n[[guide.links]]\n" + site + R"(
[[guide.links]]
kind = "rotating"
angular_velocity = [0, 0.1, 0]
[[guide.links]]
kind = "rotating"
angular_velocity = [0.2, 0, 0]
origin_acceleration = [0, 0, 1]
)");
  check_same(read, Chain(earth_frame<Earth, Inertial>({50, 30, 100}),
                         RotatingFrame<Ship, Earth>{{0, 0.1, 0}},
                         RotatingFrame<Guide, Ship>{{0.2, 0, 0}, {0, 0, 1}}));
}

BOOST_AUTO_TEST_SUITE_END()

BOOST_AUTO_TEST_SUITE(gravity_of_a_scene_file)

Eigen::VectorXd acceleration(const std::string& text) {
  const SceneFile read = scene(text);
  SceneBodies bodies = bodies_in_gravity(read);
  const BodySystem system(make_guide_of_equations(read), std::move(bodies.bodies), bodies.gravity);
  auto state = system.rest();
  BodyWorkspace w = system.workspace();
  Eigen::VectorXd result;
  system.accelerations(0.3, system.to_vector(state), {}, result, w);
  return result;
}

const std::string arm = R"(
[[body]]
name = "arm"
joint = { kind = "revolute", axis = [0, 0, 1] }
mass = 1
centre = [0, 0.5, 0]
inertia = [0.1, 0.1, 0.1]
)";
const double lever = 0.5 / (0.1 + 0.25);  // m a / Theta

BOOST_AUTO_TEST_CASE(is_absent_by_default) {
  BOOST_TEST(acceleration(arm + run)[0] == 0);
  BOOST_TEST(std::abs(acceleration("[guide]\n" + site + arm + run)[0]) < 0.05);
  BOOST_TEST(std::abs(acceleration("[guide]\n" + site + "gravity = \"none\"\n" + arm + run)[0]) <
             0.05);
}

BOOST_AUTO_TEST_CASE(points_in_the_given_direction) {
  const auto uniform = [](const char* kind) {
    return std::string("[gravity]\nkind = \"") + kind + "\"\nvector = [9, 0, 0]\n" + arm + run;
  };
  BOOST_TEST(std::abs(acceleration(uniform("uniform"))[0] + 9 * lever) < 1e-14);
  BOOST_TEST(std::abs(acceleration(uniform("inertial"))[0] + 9 * lever) < 1e-14);
  // A guide that has rotated by 0.3 rad about z: the inertial field has rotated back.
  const std::string turning = "[guide]\nkind = \"rotating\"\nangular_velocity = [0, 0, 1]\n";
  BOOST_TEST(std::abs(acceleration(turning + uniform("uniform"))[0] + 9 * lever) < 1e-14);
  BOOST_TEST(std::abs(acceleration(turning + uniform("inertial"))[0] + 9 * lever * std::cos(0.3)) <
             1e-14);
}

// A planet's centre 100 m below: 0.5 m along y and its first order in 0.5/100.
BOOST_AUTO_TEST_CASE(points_to_a_planets_centre) {
  const auto planet = [](const std::string& keys) {
    return acceleration("[gravity]\nmu = 1e5\ncentre = [100, 0, 0]\n" + keys + arm + run)[0];
  };
  const double r = std::hypot(100, 0.5);
  const double g = 1e5 / (r * r * r) * 100;
  BOOST_TEST(std::abs(planet("kind = \"point\"\n") + g * lever) < 1e-13);
  // In the plane of the equator J2 adds its (3/2) J2 (R/r)^2.
  const double k = 1.5 * 0.01 * (50 / r) * (50 / r);
  const std::string j2 = "kind = \"j2\"\nj2 = 0.01\nradius = 50\n";
  BOOST_TEST(std::abs(planet(j2) + g * (1 + k) * lever) < 1e-13);
  BOOST_TEST(std::abs(planet(j2 + "pole = [0, 0, 2]\n") - planet(j2)) < 1e-15);
  BOOST_TEST(planet(j2 + "pole = [1, 0, 0]\n") > planet(j2));
  // The size of a body that is not a sphere counts if `gradient` is set.
  const auto rod = [&](const std::string& keys) {
    return acceleration("[gravity]\nkind = \"point\"\nmu = 1e5\ncentre = [100, 0, 0]\n" + keys +
                        "[[body]]\nname = \"rod\"\njoint = { kind = \"revolute\", axis = [0, 0, 1] "
                        "}\nmass = 1\ninertia = [0, 1, 1]\ncentre = [0.5, 0.5, 0]\n" +
                        run)[0];
  };
  BOOST_TEST(std::abs(rod("gradient = true\n") - rod("")) > 1e-6);
  BOOST_TEST(rod("gradient = false\n") == rod(""));
}

// The origin of the orbit is weightless, and gravity across the orbit is restoring with mu/r^3.
BOOST_AUTO_TEST_CASE(on_an_orbit_is_the_planets) {
  const std::string text =
      "[guide]\nkind = \"orbit\"\nsemi_major_axis = 7e6\n[gravity]\nkind = "
      "\"orbit\"\n";
  const std::string slide =
      "[[body]]\nname = \"a\"\njoint = { kind = \"prismatic\", axis = [0, 0, 1] }\nmass = 2\n"
      "inertia = [1, 1, 1]\ncentre = [0, 0, 3]\n";
  const double rate2 = 3.986004418e14 / (7e6 * 7e6 * 7e6);
  BOOST_TEST(std::abs(acceleration(text + slide + run)[0] + 3 * rate2) < 1e-12 * rate2);
  // In the inertial frame gravity is the same, up to eight digits.
  const std::string point =
      "[guide]\nkind = \"orbit\"\nsemi_major_axis = 7e6\n[gravity]\nkind = "
      "\"point\"\nmu = 3.986004418e14\n";
  BOOST_TEST(std::abs(acceleration(point + slide + run)[0] + 3 * rate2) < 1e-8 * rate2);
  // In a chain gravity remains that of the orbit.
  const std::string chain =
      "[guide]\nkind = \"chain\"\nlinks = [{ kind = \"orbit\", semi_major_axis = 7e6 }, { kind = "
      "\"rotating\", angular_velocity = [0, 0, 1] }]\n[gravity]\nkind = \"orbit\"\n";
  BOOST_TEST(std::abs(acceleration(chain + slide + run)[0] + 3 * rate2) < 1e-12 * rate2);
}

// NESC check case 1: a sphere dropped from 30000 ft over the equator. J2 is included; with the
// ellipsoid's gravitation the sphere ends 0.064 ft lower. The altitude is printed to 1e-7 ft.
//
// Source : E. B. Jackson et al., Check-Cases for Verification of 6-Degree-of-Freedom Flight Vehicle
//          Simulations, NASA/TM-2015-218675
BOOST_AUTO_TEST_CASE(drops_a_sphere_as_nesc_has_it) {
  const SceneFile dropped = scene(R"(
[guide]
kind = "earth"
latitude_deg = 0
height = 9144
azimuth_deg = 90
[gravity]
kind = "earth"
field = "j2"
[[body]]
name = "sphere"
joint = { kind = "free" }
mass = 14.59
inertia = [4.88, 4.88, 4.88]
[solve]
t_end = 30
tolerance = 1e-12
)");
  const auto run = run_scene(dropped);
  const Eigen::Vector3d fallen = run.states.back().coordinates.segment<3>(4);  // down, north, east
  const double equator = 6378137;
  const double altitude = std::hypot(equator + 9144 - fallen.x(), fallen.z()) - equator;
  BOOST_TEST(std::abs(altitude / 0.3048 - 15598.9043522) < 5e-7);
}

// Both ways to specify gravity give the effective one. They differ by its gradient over half a
// metre and the earth's rotation: 1.5e-6 m/s^2 and 0.5 u^2.
BOOST_AUTO_TEST_CASE(is_effective_gravity_on_the_earth) {
  const double g = normal_gravity({50, 30, 100}).magnitude;
  for (const std::string& text :
       {"[guide]\n" + site + "gravity = \"normal\"\n" + arm + run,
        "[guide]\n" + site + "[gravity]\nkind = \"earth\"\n" + arm + run}) {
    BOOST_TEST(std::abs(acceleration(text)[0] + g * lever) < 2e-6);
  }
  const std::string number = "[guide]\n" + site + "gravity = 9.5\n";
  BOOST_TEST(std::abs(acceleration(number + arm + run)[0] + 9.5 * lever) < 1e-8);
  // Along a chain gravity remains on the axes of the earth.
  const std::string chain = "[guide]\nkind = \"chain\"\n[[guide.links]]\n" + site +
                            "gravity = 9.5\n[[guide.links]]\nkind = \"rotating\"\n"
                            "angular_velocity = [0, 0, 1]\n";
  BOOST_TEST(std::abs(acceleration(chain + arm + run)[0] + 9.5 * lever * std::cos(0.3)) < 1e-4);
}

BOOST_AUTO_TEST_SUITE_END()

BOOST_AUTO_TEST_SUITE(bodies_of_a_scene_file)

BOOST_AUTO_TEST_CASE(have_their_inertia_about_the_origin) {
  const auto read = scene(
      "[[body]]\nname = \"a\"\njoint = { kind = \"fixed\" }\nmass = 2\ncentre = [0, 0, 3]\n"
      "inertia = [1, 1.2, 1.4, 0.1, 0.2, 0.3]\n" +
      run);
  const auto& T = read.bodies.at(0).inertia.value;
  BOOST_TEST(T.mass == 2);
  BOOST_TEST((T.first_moment == Vector3<double>(0, 0, 6)));
  const Matrix3<double> expected =
      (Matrix3<double>() << 19, 0.1, 0.2, 0.1, 19.2, 0.3, 0.2, 0.3, 1.4).finished();
  BOOST_TEST((T.tensor.matrix() - expected).norm() < 1e-14);
}

BOOST_AUTO_TEST_CASE(have_springs_dampers_and_forces) {
  const auto revolute =
      scene(one_body("joint = { kind = \"revolute\", axis = [0, 1, 0] }\n"
                     "spring = { stiffness = 3, rest_deg = 90 }\n"
                     "damping = 4\nforce = 5"));
  const JointForce& f = revolute.bodies.at(0).forces.at(0);
  BOOST_TEST(f.stiffness == 3);
  BOOST_TEST(f.rest == 90 * 0.017453292519943295);
  BOOST_TEST(f.damping == 4);
  BOOST_TEST(f.constant == 5);
}

BOOST_AUTO_TEST_CASE(start_relative_to_their_parent) {
  // The joint's frame is rotated by a quarter turn about z, with its origin at x = 1.
  const auto read = scene(one_body(
      "joint = { kind = \"free\", position = [1, 0, 0], orientation = [0.70710678118654757, 0, 0, "
      "0.70710678118654757] }\ninitial = { attitude = [0.70710678118654757, 0, 0, "
      "0.70710678118654757], position = [3, 4, 5], velocity = [1, 2, 3], angular_velocity = [4, 5, "
      "6] }"));
  const std::vector<double>& q = read.start.at(0).coordinates;
  const std::vector<double> expected{0, 0, 0, 1, 2, 4, 5};
  for (std::size_t i = 0; i < expected.size(); ++i)
    BOOST_TEST(std::abs(q.at(i) - expected[i]) < 1e-15);
  BOOST_TEST(read.start.at(0).rates == std::vector<double>({4, 5, 6, 1, 2, 3}));
}

BOOST_AUTO_TEST_CASE(carry_loads) {
  const auto read = scene(one_body(
      "joint = { kind = \"free\" }\n"
      "load = { force = [1, 0, 0], torque = [0, 0, 7], point = [0, 2, 0], axes = \"body\" }"));
  const Force<Body> P = read.bodies.at(0).loads.at(0)(LoadContext<>{});
  BOOST_TEST((P.value.resultant == Vector3<double>(1, 0, 0)));
  BOOST_TEST((P.value.moment == Vector3<double>(0, 0, 5)));
}

// The body is rotated by a quarter turn about z relative to the guide, as is the guide in the
// inertial frame.
BOOST_AUTO_TEST_CASE(carry_loads_on_any_axes) {
  const auto read = scene(
      one_body("joint = { kind = \"free\" }\nload = [ { force = [1, 0, 0], axes = \"guide\" }, "
               "{ torque = [1, 0, 0], axes = \"inertial\" }, { force = [1, 0, 0] } ]"));
  const Matrix3<double> quarter =
      Eigen::AngleAxisd(std::acos(-1.0) / 2, Vector3<double>::UnitZ()).toRotationMatrix();
  LoadContext<> s;
  s.X.value.rotation = quarter;
  s.guide.X.value.rotation = quarter;
  const auto& loads = read.bodies.at(0).loads;
  BOOST_REQUIRE(loads.size() == 3U);
  BOOST_TEST((loads[0](s).value.resultant - Vector3<double>(0, -1, 0)).norm() < 1e-15);
  BOOST_TEST((loads[1](s).value.moment - Vector3<double>(-1, 0, 0)).norm() < 1e-15);
  BOOST_TEST((loads[2](s).value.resultant - Vector3<double>(1, 0, 0)).norm() < 1e-15);
}

BOOST_AUTO_TEST_CASE(slide_on_springs) {
  const auto read = scene(
      one_body("joint = { kind = \"prismatic\", axis = [0, 1, 0] }\nspring = { stiffness = 3, "
               "rest = 0.5 }\ninitial = { displacement = 1, rate = 2 }"));
  BOOST_TEST(read.bodies.at(0).forces.at(0).rest == 0.5);
  BOOST_TEST(read.start.at(0).coordinates == std::vector<double>({1}));
  BOOST_TEST(read.start.at(0).rates == std::vector<double>({2}));
}

BOOST_AUTO_TEST_CASE(may_be_rotors) {
  const std::string axis = "joint = { kind = \"revolute\", axis = [0, 0, 1] }\n";
  const auto with = [&](const std::string& rest) { return scene(one_body(axis + rest)); };
  const auto free = with("rotor = { mode = \"free\", speed = 3 }");
  BOOST_TEST((free.bodies.at(0).rotor->mode == RotorMode::free));
  BOOST_TEST(free.start.at(0).rates.at(0) == 3);
  const auto regulated =
      with("rotor = { mode = \"regulated\", speed = 3 }\ninitial = { rate = 3 }");
  BOOST_TEST((regulated.bodies.at(0).rotor->mode == RotorMode::regulated));
  const auto torque = with("rotor = { mode = \"torque\", torque = 2 }");
  BOOST_TEST(torque.bodies.at(0).rotor->torque == 2);
  // Friction or a constant torque makes a free rotor a driven one.
  const auto rubbed = with("rotor = { mode = \"free\", speed = 3 }\ndamping = 0.1");
  BOOST_TEST((rubbed.bodies.at(0).rotor->mode == RotorMode::torque));
  BOOST_TEST(rubbed.bodies.at(0).rotor->torque == 0);
  // A load may need the angle, which a rotor does not have.
  const std::string load = "\nload = { torque = [0, 0, 1] }";
  const auto loaded = with("rotor = { mode = \"torque\", torque = 2 }\nforce = 5" + load);
  BOOST_TEST(!loaded.bodies.at(0).rotor);
  BOOST_TEST(loaded.bodies.at(0).forces.at(0).constant == 7);
  const auto kept = with("rotor = { mode = \"regulated\", speed = 3 }" + load);
  BOOST_TEST(!kept.bodies.at(0).rotor);
  BOOST_TEST((kept.bodies.at(0).rule == JointRule::driven));
  BOOST_TEST(kept.start.at(0).rates.at(0) == 3);
  BOOST_TEST((with("drive = \"constant-rate\"").bodies.at(0).rule == JointRule::driven));
  BOOST_TEST((with("hold = true").bodies.at(0).rule == JointRule::held));
}

BOOST_AUTO_TEST_SUITE_END()

BOOST_AUTO_TEST_SUITE(solve_of_a_scene_file)

BOOST_AUTO_TEST_CASE(makes_output_times) {
  const auto times = [](const std::string& rest, const SolveRequest& request = {}) {
    return parse_scene(body + "[solve]\n" + rest, "s.toml", request).output_times;
  };
  BOOST_TEST(times("t_end = 1\noutput_step = 0.1").size() == 11U);
  BOOST_TEST(times("t_end = 1\noutput_step = 0.1").back() == 1);
  BOOST_TEST(times("t_end = 1\noutput_step = 0.3") ==
             std::vector<double>({0, 0.3, 0.6, 3 * 0.3, 1}));
  BOOST_TEST(times("t_end = 1\noutput_step = 5") == std::vector<double>({0, 1}));
  BOOST_TEST(times("t_end = 1\noutput_times = [0.25, 0.5]") == std::vector<double>({0.25, 0.5}));
  BOOST_TEST(times("t_end = 1\noutput_times = [0.25, 0.5]", {.t_end = 0.3}) ==
             std::vector<double>({0.25}));
  BOOST_TEST(times("output_step = 1", {.t_end = 2}) == std::vector<double>({0, 1, 2}));
}

BOOST_AUTO_TEST_CASE(begins_at_another_time) {
  const auto from = [](const std::string& keys, const std::string& of_body = "") {
    return scene(body + of_body + "\n[solve]\n" + keys);
  };
  const SceneFile later = from("t_begin = 2\nt_end = 3\noutput_step = 0.5");
  BOOST_TEST(later.t_begin == 2);
  BOOST_TEST(later.output_times == std::vector<double>({2, 2.5, 3}));
  BOOST_TEST(options_of(later).begin == 2);
  const SceneFile pushed =
      from("t_begin = -1\nt_end = 2", "force = { steps = [[-1, 7], [0, 5], [1, 3], [2.5, 1]] }");
  BOOST_TEST(pushed.discontinuities == std::vector<double>({0, 1}));
  BOOST_TEST(std::abs(run_scene(pushed).states.back().rates[0] - (7 + 5 + 3)) < 1e-9);
  const SceneFile driven = from("t_begin = 2\nt_end = 3", "drive = { angle = { rate = 0.5 } }");
  BOOST_TEST(driven.start[0].coordinates[0] == 1);
  const SceneFile turned =
      from("t_begin = 2\nt_end = 3",
           "rotor = { mode = \"regulated\", speed = { constant = 1, rate = 4 } }");
  BOOST_TEST(turned.start[0].rates[0] == 9);
  BOOST_TEST(std::abs(run_scene(turned).states.back().rates[0] - 13) < 1e-9);
}

// On moving guides, with a force that oscillates.
BOOST_AUTO_TEST_CASE(goes_on_where_another_run_stopped) {
  const std::string guides[] = {
      "",
      "kind = \"rotating\"\nangular_velocity = [0.3, 0, 0.5]\norigin_acceleration = [1, 0, 0]\n",
      "kind = \"harmonic\"\nangular_velocity = { terms = [{ amplitude = [1, 0, 0], frequency = 2 "
      "}] }\n",
      "kind = \"motion\"\nposition = { terms = [{ amplitude = [1, 0, 0], frequency = 2 }] }\n",
      site + "gravity = \"normal\"\n"};
  const std::string pendulum =
      "[[body]]\nname = \"a\"\njoint = { kind = \"universal\", axis = [0, 0, 1], second_axis = [0, "
      "1, 0] "
      "}\nmass = 2\ncentre = [0.3, 0.1, 0]\ninertia = [1, 2, 2]\n"
      "force = { terms = [{ amplitude = 1, frequency = 3 }] }\ninitial = { angle = [0.1, 0.2] }\n";
  for (const std::string& guide : guides) {
    const std::string text = (guide.empty() ? "" : "[guide]\n" + guide) + pendulum + "[solve]\n";
    const SceneFile whole = scene(text + "t_end = 4\noutput_times = [1.5, 4]\n");
    const auto first = run_scene(whole);
    SceneFile rest = scene(text + "t_begin = 1.5\nt_end = 4\noutput_times = [4]\n");
    const JointState& middle = first.states.front();
    rest.start[0].coordinates.assign(middle.coordinates.begin(), middle.coordinates.end());
    rest.start[0].rates.assign(middle.rates.begin(), middle.rates.end());
    const auto second = run_scene(rest);
    const JointState& a = first.states.back();
    const JointState& b = second.states.back();
    BOOST_TEST(second.report.tolerance_kept);
    BOOST_TEST((a.coordinates - b.coordinates).norm() < 1e-8, guide);
    BOOST_TEST((a.rates - b.rates).norm() < 1e-8, guide);
  }
}

// Nothing depends on the time, so the end is the same, by all equations.
BOOST_AUTO_TEST_CASE(may_begin_late_in_any_model) {
  const std::string ring = "mass = 1\ninertia = [0.002, 0.002, 0.002]\n";
  const std::string gyro =
      "[[body]]\nname = \"a\"\njoint = { kind = \"revolute\", axis = [1, 0, 0] }\n" + ring +
      "spring = { stiffness = 0.1 }\ninitial = { angle = 0.01, rate = 0.02 }\n" +
      "[[body]]\nname = \"b\"\nparent = \"a\"\njoint = { kind = \"revolute\", axis = [0, 1, 0] "
      "}\n" +
      ring + "initial = { angle = 0.02 }\n" +
      "[[body]]\nname = \"c\"\nparent = \"b\"\njoint = { kind = \"revolute\", axis = [0, 0, 1] "
      "}\n" +
      "mass = 1\ninertia = [0.005, 0.005, 0.008]\nrotor = { mode = \"regulated\", speed = 50 }\n";
  for (const char* const model : {"exact", "linear", "precession", "foeppl"}) {
    const auto end = [&](const std::string& times) {
      return run_scene(scene(gyro + "[solve]\n" + times + "model = \"" + model + "\"\n"))
          .states.back();
    };
    const JointState a = end("t_end = 1\n");
    const JointState b = end("t_begin = 8\nt_end = 9\n");
    BOOST_TEST((a.coordinates - b.coordinates).head(2).norm() < 1e-11, model);
    BOOST_TEST((a.rates - b.rates).norm() < 1e-9, model);
  }
}

BOOST_AUTO_TEST_CASE(sets_equations_and_tolerance) {
  const auto solve = [](const std::string& rest) { return scene(body + run + rest); };
  BOOST_TEST((solve("model = \"linear\"").model == SceneModel::linear));
  BOOST_TEST((solve("model = \"precession\"").model == SceneModel::precession));
  BOOST_TEST((solve("method = \"gauss16\"").method == Method::gauss16));
  BOOST_TEST(solve("tolerance = 1e-6").tolerance == 1e-6);
  BOOST_TEST(parse_scene(body + run, "s.toml", {.tolerance = 1e-7}).tolerance == 1e-7);
  const SceneFile told = scene(body + run + "[report]\nreactions = true\n");
  BOOST_TEST(told.reactions);
  BOOST_TEST(!told.terms);
  BOOST_TEST(scene(body + run + "[report]\nterms = true\n").terms);
}

BOOST_AUTO_TEST_CASE(limits_the_size_of_files) {
  const test::Scratch folder;
  const auto file = folder.write("scene.toml", "title = \"a 'b' # c\"\n" + body + run);
  BOOST_TEST(read_scene(file).title == "a 'b' # c");
  BOOST_TEST(read_scene(file).t_end == 4);
  BOOST_TEST(read_scene(file, {.t_end = 3}).t_end == 3);
  std::filesystem::resize_file(file, (64U << 20U) + 1);
  try {
    (void)read_scene(file);
    BOOST_ERROR("not refused");
  } catch (const InvalidInput& error) {
    BOOST_TEST(error.what() == file.string() + ": is larger than 64 MB, the most that is read");
  }
}

BOOST_AUTO_TEST_SUITE_END()

BOOST_AUTO_TEST_SUITE(mistakes_of_a_scene_file)

BOOST_AUTO_TEST_CASE(have_line_column_key_and_reason) {
  const std::string revolute = "joint = { kind = \"revolute\", axis = [0, 0, 1] }\n";
  const std::pair<std::string, std::string> cases[] = {
      {"",
       "s.toml:1:1: the table [solve] with its key 't_end' is missing\n"
       "s.toml:1:1: no [[body]] is given"},
      {"titel = \"x\"\n" + body + run, "s.toml:1:1: titel: is no key here (did you mean 'title'?)"},
      {"[gravity]\nkind = \"none\"\nstrength = 1\n" + body + run,
       "s.toml:3:1: gravity.strength: is no key here; allowed: 'kind'"},
      {"title = 3\n" + body + run, "s.toml:1:9: title: must be a text, not a whole number"},
      {"a = 1\na = 2\n", "is no TOML"},
      {"[guide]\nkind = \"rotatin\"\n" + body + run,
       "s.toml:2:8: guide.kind: 'rotatin' is none of 'inertial', 'rotating', 'harmonic', 'earth', "
       "'table', 'rates', 'motion', 'orbit', 'course' or 'chain' (did you mean 'rotating'?)"},
      {"[guide]\nkind = \"rotating\"\n" + body + run,
       "s.toml:1:1: guide.angular_velocity: is missing"},
      {"[guide]\nkind = \"earth\"\nlatitude_deg = 91\nheight = 0\nazimuth_deg = 0\n" + body + run,
       "s.toml:3:16: guide.latitude_deg: 91 degrees lies outside [-90, 90] degrees"},
      {"[guide]\nkind = \"chain\"\nlinks = [ { kind = \"inertial\" }, { kind = \"earth\", "
       "latitude_deg = 1, height = 0, azimuth_deg = 0 } ]\n" +
           body + run,
       "'earth' must be the first link"},
      {"[guide]\nkind = \"table\"\nfile = \"none.csv\"\n" + body + run,
       "s.toml:3:8: guide.file: none.csv: cannot be read"},
      {"[gravity]\nkind = \"earth\"\n" + body + run, "s.toml:2:8: gravity.kind: 'earth' needs"},
      {"[guide]\n" + site + "gravity = 9.8\n[gravity]\nkind = \"earth\"\n" + body + run,
       "gives gravity a second time"},
      {one_body("joint = { kind = \"revolute\", axis = [0, 0, 0] }"),
       "s.toml:5:37: body 'a'.joint.axis: is 0 and has no direction"},
      {one_body(revolute + "initial = { angle = nan }"),
       "s.toml:6:21: body 'a'.initial.angle: is NaN, not a finite number"},
      {one_body(revolute + "mass = 3"), "is no TOML"},
      {one_body(revolute + "centre = [0, 0, inf]"),
       "s.toml:6:17: body 'a'.centre[2]: is infinite, not a finite number"},
      {one_body(revolute + "damping = -1"), "s.toml:6:11: body 'a'.damping: must not be below 0"},
      {one_body(revolute + "parent = \"b\""), "s.toml:6:10: body 'a'.parent: 'b' is no body"},
      {one_body(revolute + "centre = [0.1, 0, 0]\nrotor = { mode = \"free\", speed = 1 }"),
       "body 'a'.rotor: is unbalanced"},
      {one_body(revolute + "rotor = { mode = \"free\", speed = 1 }\ninitial = { rate = 2 }"),
       "body 'a'.rotor.speed: differs from initial.rate"},
      {one_body("joint = { kind = \"spherical\" }\nspring = { stiffness = 1 }"),
       "body 'a'.spring: needs a single coordinate"},
      {one_body("joint = { kind = \"spherical\" }\ndrive = \"constant-rate\""),
       "body 'a'.drive: is for a revolute, prismatic or screw joint"},
      {one_body("joint = { kind = \"free\" }\ninitial = { attitude = [1, 1, 0, 0] }"),
       "is a quaternion [w, x, y, z] of norm 1.414214, not of 1"},
      {body + body + run, "s.toml:9:8: body 'a'.name: is used by an earlier body"},
      {body + "[solve]\nt_end = 0\n", "s.toml:8:9: solve.t_end: 0 must be above 0"},
      {body + "[solve]\nt_end = 1\nmodel = \"lineal\"\n",
       "s.toml:9:9: solve.model: 'lineal' is none of 'exact', 'linear', 'small', 'precession', "
       "'foeppl' or 'fuchs-weigand' (did you mean 'linear'?)"},
      {body + "[solve]\nt_end = 1\noutput_times = [0.5, 0.5]\n", "does not increase"},
      {body + "[solve]\nt_end = 1\noutput_step = 1e-9\n", "more than ten million rows"},
  };
  for (const auto& [text, reason] : cases) {
    const std::string found = mistakes(text);
    BOOST_TEST(found.find(reason) != std::string::npos, "wanted " << reason << "\nfound " << found);
  }
}

// Every part of a scene that may be inconsistent.
BOOST_AUTO_TEST_CASE(are_found_in_every_section) {
  const std::string revolute = "joint = { kind = \"revolute\", axis = [0, 0, 1] }\n";
  const std::string prismatic = "joint = { kind = \"prismatic\", axis = [0, 0, 1] }\n";
  const std::string free = "joint = { kind = \"free\" }\n";
  const auto solve = [](const std::string& rest) { return body + "[solve]\nt_end = 1\n" + rest; };
  const auto guide = [](const std::string& rest) { return "[guide]\n" + rest + body + run; };
  const auto earth = [&guide](const std::string& height, const std::string& azimuth,
                              const std::string& rate) {
    return guide("kind = \"earth\"\nlatitude_deg = 50\nheight = " + height +
                 "\nazimuth_deg = " + azimuth + "\nrate = " + rate + "\n");
  };
  const auto second = [&revolute](const std::string& rest) {
    return body + "[[body]]\nname = \"b\"\nmass = 1\ninertia = [1, 1, 1]\n" + revolute + rest + run;
  };
  std::string chain = "{ kind = \"inertial\" }";
  for (int depth = 0; depth < 9; ++depth) chain = "{ kind = \"chain\", links = [ " + chain + " ] }";
  const std::pair<std::string, std::string> cases[] = {
      {solve("tolerance = 0.1\n"), "s.toml:9:13: solve.tolerance: lies outside [1e-15, 1e-2]"},
      {solve("tolerance = 1e-16\n"), "solve.tolerance: lies outside [1e-15, 1e-2]"},
      {solve("output_step = 0.1\noutput_times = [0.5]\n"),
       "solve.output_times: is given beside 'output_step'"},
      {solve("output_times = []\n"), "solve.output_times: is empty"},
      {solve("output_times = [-0.5]\n"), "solve.output_times: begins before t = 0"},
      {solve("output_times = [0.5, 1.5]\n"), "solve.output_times: goes on after t_end"},
      {solve("output_times = 0.5\n"),
       "solve.output_times: must be a list of numbers, not a number"},
      {body + "[solve]\nt_begin = 2\nt_end = 1\n",
       "s.toml:9:9: solve.t_end: 1 s must be after t_begin, 2 s"},
      {solve("t_begin = \"soon\"\n"), "s.toml:9:11: solve.t_begin: must be a number, not a text"},
      {body + "[solve]\nt_begin = 2\nt_end = 3\noutput_times = [1, 3]\n",
       "solve.output_times: begins before t = 2"},
      {body + "[solve]\nt_begin = 2\n", "solve.t_end: is missing"},
      {"[guide]\nkind = \"harmonic\"\norigin_acceleration = { constant = [1, 0, 0] }\n" + body +
           "[solve]\nt_begin = -1\nt_end = 1\n",
       "s.toml:2:8: guide.kind: 'harmonic' is given by its start at t = 0; solve.t_begin is "
       "earlier"},
      {"solve = true\n" + body, "s.toml:1:9: solve: must be a table, not true or false"},
      {guide("kind = \"chain\"\n"), "guide.links: is missing"},
      {guide("kind = \"chain\"\nlinks = []\n"), "guide.links: is empty"},
      {guide("kind = \"chain\"\nlinks = [3]\n"),
       "guide.links[0]: must be a table, not a whole number"},
      {guide("kind = \"chain\"\nlinks = { kind = \"inertial\" }\n"),
       "guide.links: must be a list of tables, not a table"},
      {guide("kind = \"chain\"\nlinks = [ " + chain + " ]\n"),
       ".links: is a chain in a chain, nine deep"},
      {guide("kind = \"chain\"\nlinks = [ {} ]\n"), "guide.links[0].kind: is missing"},
      {guide("kind = \"harmonic\"\n"), "guide.angular_velocity: is missing"},
      {guide("kind = \"harmonic\"\nangular_velocity = { constant = [0, 0, 3e5] }\n"),
       "guide.kind: 'harmonic' turns too fast for so long a run"},
      {guide("kind = \"table\"\nfile = \"\"\n"), "guide.file: is empty"},
      {guide("kind = \"table\"\nfile = 1979-05-27\n"),
       "guide.file: must be a text, not a date or a time"},
      {earth("2e7", "0", "0"), "s.toml:4:10: guide.height: 20000000 m lies outside"},
      {earth("0", "361", "0"), "s.toml:5:15: guide.azimuth_deg: 361 degrees lies outside"},
      {earth("0", "0", "1001"), "s.toml:6:8: guide.rate: 1001 rad/s lies outside"},
      {guide("kind = \"orbit\"\n"), "guide.semi_major_axis: is missing"},
      {guide("kind = \"orbit\"\nsemi_major_axis = 0\n"),
       "guide.semi_major_axis: 0 must be above 0"},
      {guide("kind = \"orbit\"\nsemi_major_axis = 7e6\neccentricity = 1\n"),
       "s.toml:4:16: guide.eccentricity: must be from 0 to below 1"},
      {guide("kind = \"orbit\"\nsemi_major_axis = 7e6\neccentricity = -0.1\n"),
       "guide.eccentricity: must be from 0 to below 1"},
      {guide("kind = \"orbit\"\nsemi_major_axis = 7e6\nmu = -1\n"), "guide.mu: -1 must be above 0"},
      {guide("kind = \"chain\"\nlinks = [{ kind = \"inertial\" }, { kind = \"orbit\", "
             "semi_major_axis = 7e6 }]\n"),
       "'orbit' must be the first link"},
      {"[gravity]\nvector = [0, 0, -9.81]\n" + body + run, "gravity.kind: is missing"},
      {"[gravity]\nkind = \"point\"\n" + body + run, "gravity.mu: is missing"},
      {"[gravity]\nkind = \"point\"\nmu = 0\n" + body + run, "gravity.mu: 0 must be above 0"},
      {"[gravity]\nkind = \"point\"\nmu = 1\npole = [0, 0, 1]\n" + body + run,
       "gravity.pole: is no key here"},
      {"[gravity]\nkind = \"j2\"\nmu = 1\n" + body + run, "gravity.j2: is missing"},
      {"[gravity]\nkind = \"j2\"\nmu = 1\nj2 = 1e-3\nradius = 0\n" + body + run,
       "gravity.radius: 0 must be above 0"},
      {"[gravity]\nkind = \"j2\"\nmu = 1\nj2 = 1e-3\nradius = 1\npole = [0, 0, 0]\n" + body + run,
       "gravity.pole: is 0 and has no direction"},
      {"[gravity]\nkind = \"orbit\"\n" + body + run, "gravity.kind: 'orbit' needs a guide of kind"},
      {"[guide]\n" + site + "[gravity]\nkind = \"earth\"\nfield = \"j4\"\n" + body + run,
       "gravity.field: 'j4' is none of 'normal' or 'j2'"},
      {"[gravity]\nkind = \"moon\"\nvector = [0, 0, 1]\n" + body + run,
       "s.toml:2:8: gravity.kind: 'moon' is none of"},
      {"body = []\n" + run, "s.toml:1:8: body: is empty"},
      {one_body(revolute + "parent = \"a\""), "body 'a'.parent: is the body itself"},
      {second("parent = \"c\"\n"), "body 'b'.parent: 'c' is no body"},
      {"[[body]]\nname = \"b\"\nparent = \"a\"\nmass = 1\ninertia = [1, 1, 1]\n" + revolute + body +
           run,
       "s.toml:3:10: body 'b'.parent: 'a' comes later; parents come before children"},
      {body + "rotor = { mode = \"free\", speed = 1 }\n[[body]]\nname = \"b\"\nparent = \"a\"\n" +
           "mass = 1\ninertia = [1, 1, 1]\n" + revolute + run,
       "body 'b'.parent: 'a' is a rotor, which can carry nothing"},
      {"[[body]]\nname = \"guide\"\nmass = 1\ninertia = [1, 1, 1]\n" + revolute + run,
       "body 'guide'.name: 'guide' is reserved for the guide frame"},
      {"[[body]]\nname = \"\"\nmass = 1\ninertia = [1, 1, 1]\n" + revolute + run,
       "body[0].name: is empty"},
      {"[[body]]\nmass = 1\ninertia = [1, 1, 1]\n" + revolute + run, "body[0].name: is missing"},
      {one_body("joint = { kind = \"universal\", axis = [0, 0, 1], second_axis = [0, 0, -2] }"),
       "body 'a'.joint.second_axis: is parallel to 'axis'"},
      {one_body("joint = { kind = \"planar\", axis = [0, 0, 1], second_axis = [0, 0, 2] }"),
       "s.toml:5:60: body 'a'.joint.second_axis: is parallel to 'axis'"},
      {one_body("joint = { kind = \"planar\" }"), "body 'a'.joint.axis: is missing"},
      {one_body("joint = { kind = \"cylindrical\", axis = [0, 0, 0] }"),
       "body 'a'.joint.axis: is 0 and has no direction"},
      {one_body("joint = { kind = \"screw\", axis = [0, 0, 1] }"),
       "body 'a'.joint.pitch: is missing"},
      {one_body("joint = { kind = \"screw\", axis = [0, 0, 1], pitch = 0 }"),
       "s.toml:5:53: body 'a'.joint.pitch: is 0: the joint does not advance; take 'revolute'"},
      {one_body("joint = { kind = \"screw\", axis = [0, 0, 1], pitch = inf }"),
       "body 'a'.joint.pitch: "},
      {one_body("joint = { kind = \"revolute\", axis = [0, 0, 1], pitch = 1 }"),
       "body 'a'.joint.pitch: is no key here"},
      {one_body("joint = { kind = \"hinge\", axis = [0, 0, 1] }"),
       "body 'a'.joint.kind: 'hinge' is none of"},
      {one_body(""), "body 'a'.joint: is missing"},
      {"[[body]]\nname = \"a\"\nmass = 1\ninertia = [1, 1, 1, 0]\n" + revolute + run,
       "body 'a'.inertia: must be 3 numbers, or 6 (xx, yy, zz, xy, xz, yz), not 4"},
      {"[[body]]\nname = \"a\"\nmass = 1\n" + revolute + run, "body 'a'.inertia: is missing"},
      {one_body(revolute + "centre = [0, 0]"), "body 'a'.centre: must be 3 numbers, not 2"},
      {one_body(free + "damping = 1"),
       "body 'a'.damping: has no single coordinate in this kind of joint"},
      {one_body(revolute + "spring = { rest = 0 }"), "body 'a'.spring.stiffness: is missing"},
      {one_body("joint = { kind = \"universal\", axis = [0, 0, 1], second_axis = [0, 1, 0] }\n" +
                std::string("initial = { angle = [0, 1], angle_deg = [0, 1] }")),
       "body 'a'.initial.angle_deg: is given in radian too, as 'angle'"},
      {one_body(revolute + "hold = true\ninitial = { rate = 1 }"),
       "body 'a'.hold: locks a joint whose initial rate is not 0"},
      {one_body(revolute + "hold = true\ndrive = \"constant-rate\""),
       "body 'a'.hold: and 'drive' exclude each other"},
      {one_body(revolute + "hold = \"yes\""), "body 'a'.hold: must be true or false, not a text"},
      {one_body(free + "load = { point = [0, 0, 1] }"), "body 'a'.load.force: is missing"},
      {one_body(prismatic + "rotor = { mode = \"free\", speed = 1 }"),
       "body 'a'.rotor: is for a revolute joint"},
      {one_body(revolute + "rotor = { mode = \"free\" }"), "body 'a'.rotor.speed: is missing"},
      {one_body(revolute + "rotor = { mode = \"free\", speed = 1, torque = 2 }"),
       "body 'a'.rotor.torque: is for mode = 'torque'"},
      {one_body(revolute + "rotor = { mode = \"torque\" }"), "body 'a'.rotor.torque: is missing"},
      {one_body(revolute + "hold = true\nrotor = { mode = \"free\", speed = 1 }"),
       "body 'a'.hold: does not go with a rotor"},
      {"[[body]]\nname = \"a\"\nmass = 1\ninertia = [1, 2, 2]\n" + revolute +
           "rotor = { mode = \"free\", speed = 1 }\n" + run,
       "body 'a'.rotor: is not symmetric about its axis"},
      {"[[body]]\nname = \"a\"\nmass = 1\ninertia = [1, 1, 0]\n" + revolute +
           "rotor = { mode = \"free\", speed = 1 }\n" + run,
       "body 'a'.rotor: has no moment of inertia about its axis"},
  };
  for (const auto& [text, reason] : cases) {
    const std::string found = mistakes(text);
    BOOST_TEST(found.find(reason) != std::string::npos, "wanted " << reason << "\nfound " << found);
  }
}

// One line each, at most a few screen widths long.
BOOST_AUTO_TEST_CASE(quote_the_file_in_one_short_line) {
  const std::string found =
      mistakes("[guide]\nkind = \"a\\nb\\u007f" + std::string(100, 'c') + "\"\n" + body + run);
  BOOST_TEST(found.find("guide.kind: 'a?b?" + std::string(56, 'c') + "...' is none of") !=
                 std::string::npos,
             found);
  BOOST_TEST(mistakes("\"a\\tb\" = 1\n" + body + run).find("a?b: is no key here") !=
             std::string::npos);
}

// Mass, tensor and axis are wrong at once, and all are reported, in the order of the file.
BOOST_AUTO_TEST_CASE(are_reported_all_at_once) {
  const std::string found = mistakes(R"([[body]]
name = "a"
mass = -1
inertia = [1, 1, 3]
joint = { kind = "revolute", axis = [0, 0, 0], positon = [0, 0, 0] }
[solve]
t_end = "soon"
)");
  BOOST_TEST(found ==
             "s.toml:3:8: body 'a'.mass: -1 must not be below 0\n"
             "s.toml:4:11: body 'a'.inertia: triangle inequality about the centre of mass fails: "
             "1 + 1 >= 3 kg m^2\n"
             "s.toml:5:37: body 'a'.joint.axis: is 0 and has no direction\n"
             "s.toml:5:48: body 'a'.joint.positon: is no key here (did you mean 'position'?)\n"
             "s.toml:7:9: solve.t_end: must be a number, not a text");
}

// Keys of a joint are not reported as well if the joint itself is wrong.
BOOST_AUTO_TEST_CASE(are_reported_only_once) {
  const std::string rest =
      "damping = 1\ninitial = { angle = 1 }\nrotor = { mode = \"free\", speed = 1 }";
  BOOST_TEST(mistakes(one_body("joint = { kind = \"revolut\", axis = [0, 0, 1] }\n" + rest)) ==
             "s.toml:5:18: body 'a'.joint.kind: 'revolut' is none of " + joint_names() +
                 " (did you mean 'revolute'?)");
  BOOST_TEST(mistakes(one_body(rest)) == "s.toml:1:1: body 'a'.joint: is missing");
}

BOOST_AUTO_TEST_CASE(are_reported_for_binary_files) {
  const std::string nested = "a = " + std::string(100'000, '[');
  BOOST_TEST(mistakes(nested).find("nested more than 64 deep") != std::string::npos);
  std::string dotted = "a";
  for (int i = 0; i < 100'000; ++i) dotted += ".a";
  BOOST_TEST(mistakes(dotted + " = 1").find("nested more than 64 deep") != std::string::npos);
  BOOST_TEST(mistakes("[" + dotted + "]").find("nested more than 64 deep") != std::string::npos);
  BOOST_TEST(mistakes(std::string(1000, '\0')).find("is no TOML") != std::string::npos);
  BOOST_TEST(mistakes("\xff\xfe\x01").find("is no TOML") != std::string::npos);
  BOOST_CHECK_THROW((void)read_scene("/no/such/scene.toml"), InvalidInput);
  BOOST_CHECK_THROW((void)read_scene("/"), InvalidInput);
}

BOOST_AUTO_TEST_CASE(exclude_byte_order_mark_and_carriage_return) {
  std::string text = "\xEF\xBB\xBF";
  for (const char c : "# a [ comment . with ' brackets\n" + body + run) {
    if (c == '\n') text += '\r';
    text += c;
  }
  BOOST_TEST(mistakes(text) == "none");
}

BOOST_AUTO_TEST_SUITE_END()
