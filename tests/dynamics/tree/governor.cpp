// A flyball governor with rods and with stiff springs, against its reduction to one and two angles.

#include <boost/test/unit_test.hpp>

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include <dynamics/guide/resting.hpp>
#include <dynamics/solve/output_times.hpp>
#include <dynamics/solve/solve.hpp>
#include <dynamics/tree/body_system.hpp>

#include <support/extrapolation.hpp>
#include <support/told_error.hpp>

using namespace kreisel;
using namespace kreisel::test;

namespace {

// The data are of our own, of the size of those of problem A05 in the library of benchmarks of IFToMM.
constexpr double g = 9.81, shaft_inertia = 0.05, slider_inertia = 0.02, slider_mass = 10;
constexpr double arm_mass = 5.3;                               ///< with its ball at the end
constexpr double arm_centre = 0.97;                            ///< from the hinge
constexpr double across = 5.1, sideways = 5.08, along = 0.03;  ///< moments about the hinge
constexpr double joint = 0.5;                                  ///< of the rod, from the hinge
constexpr double rod = 0.5;
constexpr double stiffness = 8e5, damping = 4e4;
constexpr double tilt_0 = 0.5, turn_0 = 6;

BodyDescription arm(const std::string& name, double side) {
  BodyDescription body;
  body.name = name;
  body.parent = "shaft";
  body.joint = {.kind = JointKind::revolute, .axis = {0, -side, 0}};
  const Matrix3<double> tensor = Vector3<double>(sideways, across, along).asDiagonal();
  body.inertia = InertiaTensor<Body>::about_origin(arm_mass, {0, 0, -arm_centre}, tensor);
  return body;
}

/// A shaft, two arms in hinges on its axis and a slider, joined by rods without mass or by springs.
BodySystem<RestingFrame<>> governor(bool has_rods) {
  BodyDescription shaft;
  shaft.name = "shaft";
  shaft.joint = {.kind = JointKind::revolute, .axis = {0, 0, 1}};
  shaft.inertia =
      InertiaTensor<Body>::about_centre(1, {0, 0, 0}, shaft_inertia * Matrix3<double>::Identity());
  BodyDescription slider;
  slider.name = "slider";
  slider.parent = "shaft";
  slider.joint = {.kind = JointKind::prismatic, .axis = {0, 0, 1}};
  slider.inertia = InertiaTensor<Body>::about_centre(slider_mass, {0, 0, 0},
                                                     slider_inertia * Matrix3<double>::Identity());
  std::vector<Element> springs;
  std::vector<Constraint> rods;
  const Vector3<double> at(0, 0, -joint);
  for (const std::string name : {"left", "right"}) {
    if (has_rods) {
      rods.push_back({"rod " + name, "slider", name, constraint::Distance{{{0, 0, 0}, at}, rod}});
    } else {
      SpringElement spring;
      spring.name = "rod " + name;
      spring.ends = {{{"slider", {0, 0, 0}}, {name, at}}};
      spring.stiffness = stiffness;
      spring.length = rod;
      spring.damping = damping;
      springs.emplace_back(spring);
    }
  }
  return {RestingFrame<>{},
          {shaft, arm("left", -1), arm("right", 1), slider},
          UniformGravity<Guide>{{0, 0, -g}},
          springs,
          rods};
}

using S = long double;

/// The moment of inertia about the shaft, and its slope.
S moment(S tilt) {
  const S sine = std::sin(tilt), cosine = std::cos(tilt);
  return S(shaft_inertia) + S(slider_inertia) +
         2 * (S(sideways) * sine * sine + S(along) * cosine * cosine);
}
S moment_slope(S tilt) { return 2 * (S(sideways) - S(along)) * std::sin(2 * tilt); }

/// The angular momentum about the shaft is constant.
S momentum() { return moment(S(tilt_0)) * S(turn_0); }

/// The torque on both arms without the rods.
S torque(S tilt, S turn) {
  return moment_slope(tilt) * turn * turn / 2 -
         2 * S(arm_mass) * S(arm_centre) * S(g) * std::sin(tilt);
}

/// The height of the slider on rods, and its first and second derivative by the tilt.
std::array<S, 3> height(S tilt) {
  const S b = S(joint), sine = std::sin(tilt), cosine = std::cos(tilt);
  const S q = std::sqrt(S(rod) * S(rod) - b * b * sine * sine);
  return {-b * cosine - q, b * sine + b * b * sine * cosine / q,
          b * cosine + b * b *
                           ((cosine * cosine - sine * sine) / q +
                            b * b * sine * sine * cosine * cosine / (q * q * q))};
}

/// The rates of turn, tilt and tilt's rate with rods:
///
///   (2 A + m z'^2) tilt'' + m z' z'' tilt'^2 = torque - m g z',   z' = dz/d(tilt)
std::array<S, 3> rates_on_rods(S /*t*/, const std::array<S, 3>& y) {
  const auto [turn, tilt, speed] = y;
  const auto [z, dz, ddz] = height(tilt);
  const S rate = momentum() / moment(tilt), m = S(slider_mass);
  return {rate, speed,
          (torque(tilt, rate) - m * S(g) * dz - m * dz * ddz * speed * speed) /
              (2 * S(across) + m * dz * dz)};
}

/// The rates of turn, tilt, slider's height and the rates of the last two with springs of the pull F:
///
///   2 A tilt'' = torque - 2 F dL/d(tilt),   m z'' = -m g - 2 F dL/dz
std::array<S, 5> rates_on_springs(S /*t*/, const std::array<S, 5>& y) {
  const auto [turn, tilt, z, speed, dz] = y;
  const S b = S(joint), x = b * std::sin(tilt), h = z + b * std::cos(tilt);
  const S L = std::sqrt(x * x + h * h);
  const S by_tilt = (x * b * std::cos(tilt) - h * b * std::sin(tilt)) / L, by_z = h / L;
  const S F = S(stiffness) * (L - S(rod)) + S(damping) * (by_tilt * speed + by_z * dz);
  const S rate = momentum() / moment(tilt);
  return {rate, speed, dz, (torque(tilt, rate) - 2 * F * by_tilt) / (2 * S(across)),
          -S(g) - 2 * F * by_z / S(slider_mass)};
}

/// The state of the tree.
Eigen::VectorXd state(S turn, S tilt, S z, S tilting, S dz) {
  Eigen::Matrix<S, 8, 1> y;
  y << turn, tilt, tilt, z, momentum() / moment(tilt), tilting, tilting, dz;
  return y.cast<double>();
}

Eigen::VectorXd on_rods(double t) {
  const auto [turn, tilt, speed] =
      extrapolated<3>(rates_on_rods, {0, S(tilt_0), 0}, 0, t, 1 + static_cast<int>(40 * t));
  const auto [z, dz, ddz] = height(tilt);
  return state(turn, tilt, z, speed, dz * speed);
}

Eigen::VectorXd on_springs(double t) {
  const auto [turn, tilt, z, speed, dz] =
      extrapolated<5>(rates_on_springs, {0, S(tilt_0), height(S(tilt_0))[0], 0, 0}, 0, t,
                      1 + static_cast<int>(2000 * t));
  return state(turn, tilt, z, speed, dz);
}

/// A run against the reduction, which has 13 digits: half as long steps change the last of them.
template <class Reference>
RunReport checked(bool has_rods, Method method, const Reference& reference, double end) {
  const auto system = governor(has_rods);
  const auto start = system.from_vector(state(0, S(tilt_0), height(S(tilt_0))[0], 0, 0));
  const auto run = solve(
      system, start, {.output_times = linspace(0, end, 5), .tolerance = 1e-10, .method = method});
  std::vector<Eigen::VectorXd> wanted;
  for (const double t : run.times) wanted.push_back(reference(t));
  const double off = true_error(system, run, wanted);
  BOOST_TEST(run.report.tolerance_kept);
  BOOST_TEST_MESSAGE(name(method) << " errs by " << off << ", told " << run.report.error_estimate);
  BOOST_TEST(off <= run.report.error_estimate, name(method) << " errs by " << off);
  BOOST_TEST(off >= 0.1 * run.report.error_estimate, name(method) << " errs by " << off);
  BOOST_TEST(greatest_gap(system, run) <= 1e-14);
  return run.report;
}

}  // namespace

BOOST_AUTO_TEST_SUITE(governor_of_balls)

// The errors are 1.1e-12 and 5.3e-12, 0.57 of the told ones.
BOOST_AUTO_TEST_CASE(rods_make_one_angle) {
  for (const Method method : {Method::automatic, Method::radau13}) {
    const RunReport report = checked(true, method, on_rods, 4);
    // Energy and angular momentum. Their terms are below 300 J and 15 N m s, whose errors are at most
    // twice those of the state.
    BOOST_TEST_REQUIRE(report.invariants.size() == 2U);
    BOOST_TEST(report.invariants[0].largest <= 2 * report.error_estimate * 300);
    BOOST_TEST(report.invariants[1].largest <= 2 * report.error_estimate * 15);
  }
}

// A run of 0.2 s on one core. The conditions are lengths of 0.5 m, whose rates have terms of
// 1 m/s: 1e-13 of both.
BOOST_AUTO_TEST_CASE(rods_stay_closed_for_100_s) {
  const auto system = governor(true);
  const auto start = system.from_vector(state(0, S(tilt_0), height(S(tilt_0))[0], 0, 0));
  const auto run = solve(system, start, {.output_times = linspace(0, 100, 401)});
  BOOST_TEST(run.states.size() == 401U);
  BOOST_TEST(run.report.tolerance_kept);
  BOOST_TEST(greatest_gap(system, run) <= 1e-13);
  BOOST_TEST(greatest_gap_rate(system, run) <= 1e-13);
}

// The dampers stop the slider on the rods in 0.16 ms, while the arms swing in 1 s. The errors are
// 3.5e-12 and 3.4e-11, 0.22 and 0.64 of the told ones.
BOOST_AUTO_TEST_CASE(stiff_springs_keep_the_governor) {
  BOOST_TEST(checked(false, Method::automatic, on_springs, 2).method == "radau13");
  checked(false, Method::radau13, on_springs, 2);
}

BOOST_AUTO_TEST_SUITE_END()
