#include <boost/test/unit_test.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <string>
#include <vector>

#include <dynamics/guide/harmonic.hpp>
#include <dynamics/guide/resting.hpp>
#include <dynamics/guide/rotating.hpp>
#include <dynamics/load/oblate_gravitation.hpp>
#include <dynamics/solve/solve.hpp>
#include <dynamics/tree/body_system.hpp>

/// The first scenes of many users: rest, right angles, tiny starts, light damping, one output.
/// Reference values are from scipy's DOP853 at two tolerances and closed forms, unless stated
/// otherwise.

using namespace kreisel;

namespace {

constexpr double pi = std::numbers::pi;
constexpr double g = 9.81;

BodyDescription body(const Vector3<double>& axis, double mass, const Vector3<double>& centre,
                     const Vector3<double>& moments) {
  return {.name = "b",
          .joint = {.kind = JointKind::revolute, .axis = axis},
          .inertia = InertiaTensor<Body>::about_centre(mass, centre, moments.asDiagonal())};
}

struct Case {
  Method method;
  double tolerance = 1e-10;
};

/// By the default method and by methods that share no code with it.
const std::vector<Case> cases = {{Method::automatic},       {Method::taylor},
                                 {Method::verner98},        {Method::radau13},
                                 {Method::automatic, 1e-6}, {Method::automatic, 1e-13}};

/// Compares the first angle at the outputs with the reference, within 1.2 of the reported error.
template <class Scene>
void check(const Scene& scene, const typename Scene::State& start, const std::vector<double>& times,
           const std::vector<double>& right, double digits) {
  for (const Case& c : cases) {
    const auto found =
        solve(scene, start, {.output_times = times, .tolerance = c.tolerance, .method = c.method});
    BOOST_TEST_CONTEXT(name(c.method) << ", " << c.tolerance << ": " << found.report.message) {
      BOOST_TEST(found.report.tolerance_kept);
      BOOST_TEST_REQUIRE(found.states.size() == times.size());
      double size = 1e-3;
      for (std::size_t i = 0; i < times.size(); ++i) {
        const double off = std::abs(found.states[i].coordinates[0] - right[i]);
        size = std::max(size, std::abs(right[i]));
        BOOST_TEST(off <= digits + 1.2 * size * found.report.error_estimate);
      }
    }
  }
}

/// Compares the evaluations of the default method with those of another one, and their first
/// angles.
template <class Scene>
void costs_at_most(double times, Method method, const Scene& scene,
                   const typename Scene::State& start, SolveOptions options) {
  const auto found = solve(scene, start, options);
  options.method = method;
  const auto other = solve(scene, start, options);
  BOOST_TEST_MESSAGE(found.report.all_evaluations << " evaluations, " << name(method) << " "
                                                  << other.report.all_evaluations << "; "
                                                  << found.report.changes);
  BOOST_TEST(found.report.tolerance_kept);
  BOOST_TEST(found.report.all_evaluations <= times * other.report.all_evaluations);
  BOOST_TEST(found.report.sizes.size() == scene.blocks().size());
  for (std::size_t i = 0; i < options.output_times.size(); ++i) {
    const double apart = std::abs(found.states[i].coordinates[0] - other.states[i].coordinates[0]);
    BOOST_TEST(apart <= found.report.error_estimate + other.report.error_estimate);
  }
}

}  // namespace

BOOST_AUTO_TEST_SUITE(plain_scenes)

// The first acceleration is 1e-17 m/s^2, the rounding of a sine.
BOOST_AUTO_TEST_CASE(a_pendulum_at_rest_on_a_rolling_ship) {
  auto p = body({1, 0, 0}, 1, {0, 0, -0.5}, {0.1, 0.1, 0.02});
  p.forces = {{.damping = 0.1}};
  const HarmonicSeries<> roll{.terms = {{{0.157, 0, 0}, 0.785, pi / 2}}};
  const HarmonicFrame<> ship(roll, {}, 0, 60);
  const BodySystem scene(ship, {p}, UniformGravity<Inertial>{{0, 0, -g}});
  check(scene, scene.rest(), {10, 60}, {-0.20358471, -0.00813001}, 6e-9);
}

// The angle has a series in t^2, t^6, t^10, ..: four terms in turn vanish.
BOOST_AUTO_TEST_CASE(a_body_near_its_unstable_rest) {
  const RotatingFrame<> table{.angular_velocity = {0, 1, 1}};
  const BodySystem scene(table, {body({-1, 0, 0}, 1, {0, 0, 0}, {0.78, 1.02, 0.36})});
  for (const double start : {0.0, -1e-20, 1e-14, -1e-9}) {
    auto state = scene.rest();
    state.coordinates[0] = start;
    check(scene, state, {2}, {-1.2685309978123}, 3 * std::abs(start) + 5e-14);
  }
}

BOOST_AUTO_TEST_CASE(a_body_at_rest_stays_there) {
  const RotatingFrame<> earth{.angular_velocity = {0, 7.3e-5, 0}};
  const BodySystem scene(earth, {body({1, 0, 0}, 1, {0, 0, 0}, {0.1, 0.1, 0.2})});
  for (const double start : {0.0, pi / 2, pi}) {
    auto state = scene.rest();
    state.coordinates[0] = start;
    check(scene, state, {5}, {start}, 1e-15);
  }
}

// Reference values: 60 digits of a Taylor series of order 60.
BOOST_AUTO_TEST_CASE(two_pendulums_released_horizontally) {
  auto upper = body({0, 1, 0}, 1, {0, 0, -1}, {0.1, 0.1, 0.1});
  auto lower = upper;
  lower.name = "lower";
  lower.parent = "b";
  lower.joint.position = {0, 0, -1};
  const BodySystem scene(RestingFrame<>{}, {upper, lower}, UniformGravity<Guide>{{0, 0, -g}});
  auto state = scene.rest();
  state.coordinates[0] = pi / 2;
  check(scene, state, {4}, {-0.2634352815830}, 1e-12);
}

// Growth of a motion below the allowed error is no error that may be damped.
BOOST_AUTO_TEST_CASE(an_upright_pendulum_falls_by_every_method) {
  const BodySystem scene(RestingFrame<>{}, {body({0, 1, 0}, 1, {0, 0, 1}, {0.1, 0.1, 0.1})},
                         UniformGravity<Guide>{{0, 0, -g}});
  const double growth = std::sqrt(g / 1.1);
  for (const double start : {1e-9, 1e-12}) {
    auto state = scene.rest();
    state.coordinates[0] = start;
    for (const Method method : {Method::verner98, Method::taylor, Method::radau13}) {
      const auto found =
          solve(scene, state, {.output_times = {1, 2, 3}, .tolerance = 1e-8, .method = method});
      for (std::size_t i = 0; i < found.states.size(); ++i) {
        const double right = start * std::cosh(growth * found.times[i]);
        const double off = std::abs(found.states[i].coordinates[0] / right - 1);
        BOOST_TEST(off <= 1e-14 / start,
                   name(method) << " from " << start << " at " << found.times[i] << ": " << off);
      }
    }
  }
}

// The reference sizes of errors are those of the whole motion, not of the outputs alone. This
// sledge is at rest at its only output, after 1000 m/s.
BOOST_AUTO_TEST_CASE(the_report_does_not_depend_on_outputs) {
  auto sledge = body({1, 0, 0}, 1, {0, 0, 0}, {1, 1, 1});
  sledge.joint.kind = JointKind::prismatic;
  sledge.forces = {{.constant = -10}};
  auto pendulum = body({1, 0, 0}, 0.1, {0, 0, -0.1}, {1e-4, 1e-4, 1e-4});
  pendulum.name = "pendulum";
  pendulum.parent = "b";
  pendulum.forces = {{.stiffness = 0.01}};
  const BodySystem scene(RestingFrame<>{}, {sledge, pendulum});
  auto state = scene.rest();
  state.rates[0] = 1000;
  state.coordinates[1] = 0.5;
  std::vector<double> often;
  for (int i = 1; i <= 1000; ++i) often.push_back(0.11 * i);
  for (const Method method : {Method::automatic, Method::verner98, Method::radau13}) {
    const auto once =
        solve(scene, state, {.output_times = {110}, .tolerance = 1e-11, .method = method});
    const auto many =
        solve(scene, state, {.output_times = often, .tolerance = 1e-11, .method = method});
    const double ratio = once.report.error_estimate / many.report.error_estimate;
    BOOST_TEST_MESSAGE(name(method) << ": told " << once.report.error_estimate << " and "
                                    << many.report.error_estimate);
    BOOST_TEST(once.report.tolerance_kept, name(method));
    BOOST_TEST(ratio <= 1.5, name(method));
    BOOST_TEST(ratio >= 1 / 1.5, name(method));
    BOOST_TEST(std::abs(once.states[0].coordinates[1] - 0.111287085542196) <= 1e-11);
  }
}

// A pendulum that passes its lowest point at its only output, and a body that falls back to its
// start.
BOOST_AUTO_TEST_CASE(closed_forms_do_not_depend_on_outputs) {
  const auto check_end = [](const auto& scene, const auto& start, double end) {
    std::vector<double> often;
    for (int i = 1; i <= 1000; ++i) often.push_back(i * (end / 1000));
    const auto once = solve(scene, start, {.output_times = {end}, .method = Method::closed_form});
    const auto many = solve(scene, start, {.output_times = often, .method = Method::closed_form});
    const double ratio = once.errors.back() / many.errors.back();
    BOOST_TEST_MESSAGE("told " << once.errors.back() << " and " << many.errors.back());
    BOOST_TEST(ratio <= 1.05);
    BOOST_TEST(ratio >= 1 / 1.05);
  };
  const auto pendulum = body({1, 0, 0}, 1, {0, 0, -1}, {0, 0, 0});
  const BodySystem swings(RestingFrame<>{}, {pendulum}, UniformGravity<Guide>{{0, 0, -g}});
  auto start = swings.rest();
  start.coordinates[0] = 1;
  const double period = 2.139137600558689;  // 4 K(sin 1/2) / sqrt(g)
  check_end(swings, start, 1000.25 * period);

  auto ball = body({1, 0, 0}, 1, {0, 0, 0}, {1, 1, 1});
  ball.joint.kind = JointKind::free;
  const BodySystem flies(RestingFrame<>{}, {ball}, UniformGravity<Guide>{{0, 0, -g}});
  auto thrown = flies.rest();
  thrown.rates[5] = 1000;
  check_end(flies, thrown, 2 * 1000 / g);
}

// A mode of 1e5 rad/s that decays before the first output, with damping ratios down to 1e-3.
BOOST_AUTO_TEST_CASE(lightly_damped_modes_cost_no_more) {
  auto outer = body({1, 0, 0}, 0.5, {0, 0, 0}, {0.006, 0.0045, 0.005});
  outer.forces = {{.stiffness = 2, .damping = 0.001}};
  auto inner = body({0, 1, 0}, 0.5, {0, 0, 0}, {0.002, 0.0015, 0.0028});
  inner.name = "inner";
  inner.parent = "b";
  auto rotor = body({0, 0, 1}, 1, {0, 0, 0}, {0.005, 0.005, 0.008});
  rotor.name = "rotor";
  rotor.parent = "inner";
  rotor.rotor = Rotor{.mode = RotorMode::regulated};
  for (const double ratio : {1e-1, 1e-2, 1e-3}) {
    inner.forces = {{.stiffness = 1e8, .damping = 2 * ratio * std::sqrt(1e8 * 0.0065)}};
    const BodySystem scene(RestingFrame<>{}, {outer, inner, rotor});
    auto state = scene.rest();
    state.coordinates[0] = 0.3;
    state.rates[2] = 50;
    const SolveOptions options{.output_times = {0.5, 1, 1.5, 2}, .tolerance = 1e-8};
    BOOST_TEST_CONTEXT("damping ratio " << ratio) {
      costs_at_most(2, Method::radau13, scene, state, options);
    }
  }
}

// A gyrocompass of 2400 rad/s. It nutates at 2446 rad/s, and a damper removes the nutation at 2.5
// per second. Outputs are 10 s apart.
BOOST_AUTO_TEST_CASE(damped_nutations_need_not_be_resolved) {
  auto ring = body({1, 0, 0}, 0.2, {0, 0, 0}, {2e-3, 1e-3, 1e-3});
  auto housing = body({0, 1, 0}, 0.5, {0.005, 0, 0}, {1e-3, 1e-3, 1e-3});
  housing.name = "case";
  housing.parent = "b";
  housing.forces = {{.damping = 0.02}};
  auto rotor = body({0, 0, 1}, 1, {0, 0, 0}, {3e-3, 3e-3, 5e-3});
  rotor.name = "rotor";
  rotor.parent = "case";
  rotor.rotor = Rotor{.mode = RotorMode::regulated};
  const RotatingFrame<> guide{.angular_velocity = {4.7e-5, 5.6e-5, 0}};
  const BodySystem scene(guide, {ring, housing, rotor}, UniformGravity<Guide>{{-g, 0, 0}});
  auto state = scene.rest();
  state.coordinates[0] = 0.05;
  state.rates[2] = 2400;
  const SolveOptions options{.output_times = {10, 20, 100}, .tolerance = 1e-8};
  costs_at_most(2, Method::radau13, scene, state, options);
}

// A round wheel of 1000 rad/s in a gimbal, as an ordinary joint: terms of order 20 amplify
// quantities that cancel up to rounding.
BOOST_AUTO_TEST_CASE(a_fast_round_wheel_costs_no_more_by_series) {
  auto rod = body({0, 1, 0}, 1, {0, 0, -1}, {0.1, 0.1, 0.1});
  auto gimbal = body({1, 0, 0}, 1, {0, 0, 0}, {0.1, 0.2, 0.15});
  gimbal.name = "gimbal";
  gimbal.parent = "b";
  gimbal.joint.position = {0, 0, -1};
  auto wheel = body({0, 0, 1}, 1, {0, 0, 0.1}, {0.005, 0.005, 0.008});
  wheel.name = "wheel";
  wheel.parent = "gimbal";
  const BodySystem scene(RestingFrame<>{}, {rod, gimbal, wheel}, UniformGravity<Guide>{{0, 0, -g}});
  auto state = scene.rest();
  state.coordinates << 0.5, 0.3, 0;
  state.rates[2] = 1000;
  const SolveOptions options{.output_times = {2, 4, 6, 8, 10}, .tolerance = 1e-9};
  costs_at_most(5, Method::verner98, scene, state, options);
}

// The step before the last ended 7e-15 s before the end of the run.
BOOST_AUTO_TEST_CASE(a_remainder_of_rounding_joins_the_last_step) {
  auto bead = body({-1, 0, 0}, 1, {0, -0.5, 0}, {2, 1.2, 1.2});
  bead.joint.kind = JointKind::prismatic;
  const RotatingFrame<> guide{.angular_velocity = {0, 0, -0.1}};
  const BodySystem scene(guide, {bead});
  for (const Method method : {Method::automatic, Method::verner98, Method::radau13}) {
    const auto found = solve(scene, scene.rest(), {.output_times = {60}, .method = method});
    BOOST_TEST(found.report.tolerance_kept, name(method) << ": " << found.report.message);
  }
}

// I x'' + d x' + k x = 0 decays at 3e5 1/s and accelerates at first by 1e12 rad/s^2. The time in
// which so great a rate changes by its own size is below the last digit of the time.
BOOST_AUTO_TEST_CASE(a_stiff_spring_starts_at_any_time) {
  auto arm = body({1, 0, 0}, 1, {0, 0, 0}, {0.01, 0.01, 0.005});
  arm.forces = {{.stiffness = 1e10, .damping = 5890}};
  const BodySystem scene(RestingFrame<>{}, {arm});
  auto state = scene.rest();
  state.coordinates[0] = 1.1;
  const double decay = 5890 / 0.02;
  const double frequency = std::sqrt(1e12 - decay * decay);
  const double t = 1e-6;
  const double right = 1.1 * std::exp(-decay * t) *
                       (std::cos(frequency * t) + decay / frequency * std::sin(frequency * t));
  for (const Method method :
       {Method::automatic, Method::verner98, Method::taylor, Method::radau13}) {
    for (const double begin : {0.0, 0.5, -3.0}) {
      const SolveOptions options{.begin = begin, .output_times = {begin + t}, .method = method};
      const auto found = solve(scene, state, options);
      BOOST_TEST_CONTEXT(name(method) << " from " << begin << ": " << found.report.message) {
        BOOST_TEST_REQUIRE(found.states.size() == 1);
        // The time itself is rounded: 4e-16 s of 1e6 rad/s.
        const double off = std::abs(found.states[0].coordinates[0] - right);
        BOOST_TEST(off <= 1.1 * found.report.error_estimate + 1e6 * 4.5e-16);
      }
    }
  }
}

// A body on a planet's gravity, slowly turned by its gradient. Its potential energy is 4e8 J, and one
// last digit of it 6e-8 J: more than the turning motion's whole energy.
BOOST_AUTO_TEST_CASE(a_large_energy_rounds_without_error) {
  auto satellite = body({1, 0, 0}, 28, {0.03, 0, 0}, {21, 8, 24});
  satellite.joint.kind = JointKind::spherical;
  OblateGravitation<> planet{.centre = {1.9e7, -1.2e7, 1.4e7}, .gradient = true};
  planet.pole = Vector3<double>(-1, 1, 1).normalized();
  satellite.loads.emplace_back(planet);
  const BodySystem scene(RestingFrame<>{}, {satellite});
  for (const Method method : {Method::verner98, Method::radau13, Method::gauss16}) {
    const auto found =
        solve(scene, scene.rest(), {.t_end = 2, .output_step = 0.1, .method = method});
    BOOST_TEST(found.report.tolerance_kept, name(method) << ": " << found.report.error_estimate);
  }
}

// A stiff spring, at rest but for 1e-28 rad, and a jump that makes first steps equal in every run.
// Explicit steps of 85 rad are accepted for their ends, and in between they are nonsense.
BOOST_AUTO_TEST_CASE(equal_steps_between_jumps_show_errors) {
  auto p = body({0, 0, 1}, 1, {0, 0, 0}, {0.1, 0.1, 0.125});
  p.forces = {{.stiffness = 1e4, .damping = 0.002}};
  const BodySystem scene(RestingFrame<>{}, {p});
  auto state = scene.rest();
  state.coordinates[0] = 1e-28;
  SolveOptions options{.t_end = 1, .output_step = 0.05, .tolerance = 1e-3};
  options.discontinuities = {0.3};
  for (const Method method :
       {Method::automatic, Method::verner98, Method::taylor, Method::radau13}) {
    options.method = method;
    const auto found = solve(scene, state, options);
    BOOST_TEST_CONTEXT(name(method)) {
      BOOST_TEST(found.report.tolerance_kept);
      for (const auto& now : found.states) {
        BOOST_TEST(std::abs(now.coordinates[0]) <= 1e-3 * found.report.error_estimate);
        BOOST_TEST(std::abs(now.rates[0]) <= 1e-3 * found.report.error_estimate);
      }
    }
  }
}

// Coarse implicit steps damp an oscillation that finer ones resolve: their error falls by far more than
// the accuracy, and not by chance. Taken for chance, it cost 34 times as much as series.
BOOST_AUTO_TEST_CASE(rods_between_springs_of_gears) {
  auto outer = body({0, 0, 1}, 1, {0, 0, 0}, {0.00115, 0.00115, 0.000575});
  auto middle = body({1, 0, 0}, 2, {0, 0, 0}, {0.005, 0.005, 0.005});
  auto wheel = body({0, 1, 0}, 7, {0, 0, 0}, {0.005, 0.008, 0.005});
  outer.name = "outer", middle.name = "middle", wheel.name = "wheel";
  middle.parent = "outer", wheel.parent = "middle";
  wheel.rotor = Rotor{.mode = RotorMode::regulated};
  const std::vector<Element> gears{
      CouplingElement{.name = "a", .joints = {"middle", "outer"}, .stiffness = 30},
      CouplingElement{
          .name = "b", .joints = {"middle", "outer"}, .ratio = 3, .stiffness = 30, .damping = 0.1}};
  const BodySystem scene(RotatingFrame<>{.angular_velocity = {0, 0, -1}}, {outer, middle, wheel},
                         {}, gears);
  auto state = scene.rest();
  state.coordinates[0] = -1e-9;
  state.coordinates[1] = 1e-14;
  state.rates[2] = -100;
  costs_at_most(8, Method::taylor, scene, state, {.output_times = {5, 10}, .tolerance = 1e-8});
  // The stiff motion has died, and the steps resolve it nevertheless.
  const auto back = solve(scene, state, {.output_times = {10}, .tolerance = 1e-10});
  BOOST_TEST(back.report.changes.ends_with("then taylor"), back.report.changes);
}

// x'' = x in a frame that turns at 1 rad/s: exp(1000) m after 1000 s.
BOOST_AUTO_TEST_CASE(overflow_ends_the_run) {
  auto bead = body({1, 0, 0}, 1, {0, 0, 0}, {1, 1, 1});
  bead.joint.kind = JointKind::prismatic;
  const RotatingFrame<> guide{.angular_velocity = {0, 0, 1}};
  const BodySystem scene(guide, {bead});
  auto state = scene.rest();
  state.coordinates[0] = 1;
  std::vector<double> times;
  for (int i = 1; i <= 20; ++i) times.push_back(50 * i);
  for (const Method method : {Method::automatic, Method::verner98, Method::radau13}) {
    const auto found = solve(scene, state, {.output_times = times, .method = method});
    BOOST_TEST_CONTEXT(name(method) << ": " << found.report.message) {
      BOOST_TEST((found.report.status == RunStatus::failed));
      BOOST_TEST(found.report.message.find("beyond the range of numbers") != std::string::npos);
      BOOST_TEST(std::isfinite(found.report.error_estimate));
      BOOST_TEST(!found.states.empty());
    }
  }
}

BOOST_AUTO_TEST_SUITE_END()
