// Joint forces, torques of rotors and loads that change with time, against closed forms.

#include <boost/test/unit_test.hpp>

#include <cmath>
#include <string>
#include <vector>

#include <dynamics/guide/resting.hpp>
#include <dynamics/load/signal_load.hpp>
#include <dynamics/solve/solve.hpp>
#include <dynamics/tree/body_system.hpp>

#include <support/series.hpp>

using namespace kreisel;

namespace {

using Number = Signal<double>;
using Vector = Signal<Vector3<double>>;
using System = BodySystem<RestingFrame<>>;

constexpr double about = 0.3;  // kg m^2

BodyDescription body(const char* name, JointKind kind) {
  BodyDescription b;
  b.name = name;
  b.joint = {.kind = kind, .axis = {0, 0, 1}};
  b.inertia = InertiaTensor<Body>::about_centre(
      2, {0, 0, 0}, Vector3<double>(0.2, 0.2, about).asDiagonal().toDenseMatrix());
  return b;
}

/// A wheel or a slide under the force of the signal.
System acted_on(JointKind kind, const Number& signal) {
  BodyDescription b = body("a", kind);
  b.forces = {{.in_time = signal}};
  return System(RestingFrame<>{}, {b});
}

/// A carrier that is free to rotate, with a rotor driven by the signal.
std::vector<BodyDescription> driven_rotor(const Number& torque) {
  BodyDescription carrier = body("carrier", JointKind::revolute);
  BodyDescription rotor = body("rotor", JointKind::revolute);
  rotor.parent = "carrier";
  rotor.rotor = Rotor{.mode = RotorMode::torque};
  rotor.forces = {{.in_time = torque}};
  return {carrier, rotor};
}

/// The final values of the first coordinate and rate, by a method.
struct End {
  double coordinate;
  double rate;
  bool kept;
};

End run(const System& system, double begin, double end, const System::State& start,
        const Number& signal, Method method) {
  const auto motion = solve(system, start,
                            {.begin = begin,
                             .output_times = {end},
                             .discontinuities = signal.discontinuities(),
                             .tolerance = 1e-13,
                             .method = method});
  const auto& state = motion.states.back();
  return {state.coordinates[0], state.rates[0], motion.report.tolerance_kept};
}

constexpr Method adaptive[] = {Method::taylor, Method::verner98, Method::radau13};

}  // namespace

BOOST_AUTO_TEST_SUITE(timed_forces)

/// From rest: the rate is the integral of torque over inertia, the angle is the integral of the
/// rate.
BOOST_AUTO_TEST_CASE(steps_of_torque_turn_a_wheel) {
  const Number torque = Number::steps({{0, 0}, {1, 0.2}, {3, -0.5}, {4.5, 0}});
  const System wheel = acted_on(JointKind::revolute, torque);
  const double rate = (0.2 * 2 - 0.5 * 1.5) / about;
  const double angle = (0.2 * (4 / 2.0 + 2 * 3) - 0.5 * (1.5 * 1.5 / 2 + 1.5 * 1.5)) / about;
  for (const Method method : adaptive) {
    const End forwards = run(wheel, 0, 6, wheel.rest(), torque, method);
    BOOST_TEST(forwards.kept);
    BOOST_TEST(std::abs(forwards.rate - rate) <= 1e-13, name(method));
    BOOST_TEST(std::abs(forwards.coordinate - angle) <= 1e-12, name(method));
    System::State there = wheel.rest();
    there.coordinates[0] = angle;
    there.rates[0] = rate;
    const End backwards = run(wheel, 6, 0, there, torque, method);
    BOOST_TEST(std::abs(backwards.rate) <= 1e-13, name(method));
    BOOST_TEST(std::abs(backwards.coordinate) <= 1e-12, name(method));
  }
}

/// A run that begins or ends at a jump uses the signal on its own side of the jump.
BOOST_AUTO_TEST_CASE(runs_between_jumps_see_their_side) {
  const Number torque = Number::steps({{0, 5}, {1, 0.2}, {3, 7}});
  const System wheel = acted_on(JointKind::revolute, torque);
  for (const Method method : adaptive) {
    const End forwards = run(wheel, 1, 3, wheel.rest(), torque, method);
    BOOST_TEST(std::abs(forwards.coordinate - 0.4 / about) <= 1e-13, name(method));
    const End backwards = run(wheel, 3, 1, wheel.rest(), torque, method);
    BOOST_TEST(std::abs(backwards.coordinate - 0.4 / about) <= 1e-13, name(method));
    BOOST_TEST(std::abs(backwards.rate + 0.4 / about) <= 1e-13, name(method));
  }
}

/// C w' = M sin(Omega t + p).
BOOST_AUTO_TEST_CASE(oscillating_torque_turns_a_wheel) {
  const double M = 0.7, Omega = 3.1, p = 0.4, t = 25;
  const Number torque(0, 0, {{M, Omega, p}});
  const System wheel = acted_on(JointKind::revolute, torque);
  BOOST_TEST(wheel.knows_series());
  const double rate = M / (about * Omega) * (std::cos(p) - std::cos(Omega * t + p));
  const double angle =
      M / (about * Omega) * (std::cos(p) * t - (std::sin(Omega * t + p) - std::sin(p)) / Omega);
  for (const Method method : adaptive) {
    const End end = run(wheel, 0, t, wheel.rest(), torque, method);
    BOOST_TEST(std::abs(end.rate - rate) <= 1e-12, name(method));
    BOOST_TEST(std::abs(end.coordinate - angle) <= 1e-12 * std::abs(angle), name(method));
  }
}

/// m x'' rises from 0 at 1 s by 3 N/s up to 2 s and is constant afterwards.
BOOST_AUTO_TEST_CASE(broken_line_of_force_moves_a_slide) {
  const Number force = Number::broken_line({{1, 0}, {2, 3}});
  const System slide = acted_on(JointKind::prismatic, force);
  const double m = 2;
  const double rate = (1.5 + 3 * 2) / m;
  const double place = (3 / 6.0 + 1.5 * 2 + 3 * 4 / 2.0) / m;
  for (const Method method : adaptive) {
    const End end = run(slide, 0, 4, slide.rest(), force, method);
    BOOST_TEST(std::abs(end.rate - rate) <= 2e-13, name(method));
    BOOST_TEST(std::abs(end.coordinate - place) <= 5e-13, name(method));
  }
}

/// The motor's torque rotates rotor and carrier in opposite directions.
BOOST_AUTO_TEST_CASE(motor_of_a_rotor_turns_its_carrier) {
  const Number torque = Number::steps({{1, 0.2}, {2, 0}});
  const System system(RestingFrame<>{}, driven_rotor(torque));
  for (const Method method : adaptive) {
    const auto motion = solve(
        system, system.rest(),
        {.output_times = {3}, .discontinuities = {1, 2}, .tolerance = 1e-13, .method = method});
    const Eigen::VectorXd& rates = motion.states.back().rates;
    BOOST_TEST(std::abs(rates[0] + 0.2 / about) <= 1e-13, name(method));
    BOOST_TEST(std::abs(rates[1] - 2 * 0.2 / about) <= 1e-13, name(method));
  }
}

/// phi'' of a regulated rotor is the slope of the speed; its torque rotates the carrier.
BOOST_AUTO_TEST_CASE(regulated_speed_follows_a_broken_line) {
  const Number speed = Number::broken_line({{1, 10}, {3, 50}});
  auto bodies = driven_rotor(0);
  bodies[1].rotor = Rotor{.mode = RotorMode::regulated,
                          .acceleration = [&](double t) { return speed.derivative(t, 1); }};
  bodies[1].forces.clear();
  const System system(RestingFrame<>{}, bodies);
  System::State start = system.rest();
  start.rates[1] = 10;
  const auto motion =
      solve(system, start, {.output_times = {5}, .discontinuities = {1, 3}, .tolerance = 1e-13});
  const Eigen::VectorXd& rates = motion.states.back().rates;
  BOOST_TEST(std::abs(rates[1] - 50) <= 1e-12);
  BOOST_TEST(std::abs(rates[0] + 40 / 2.0) <= 1e-12);
}

/// A free body under a force that is fixed in the guide and grows with time.
BOOST_AUTO_TEST_CASE(load_that_grows_moves_a_body) {
  BodyDescription b = body("a", JointKind::free);
  b.loads = {SignalLoad<Guide>{Vector({0, 0, 1}, {3, 0, 0}, {}), {}, {0, 0, 0}}};
  const System system(RestingFrame<>{}, {b});
  System::State start = system.rest();
  start.rates.head<3>() << 0.3, -0.2, 0.5;
  const auto motion = solve(system, start, {.output_times = {2}, .tolerance = 1e-12});
  const Eigen::VectorXd& q = motion.states.back().coordinates;
  BOOST_TEST(std::abs(q[4] - 3 * 8 / (6 * 2.0)) <= 1e-11);
  BOOST_TEST(std::abs(q[6] - 4 / (2 * 2.0)) <= 1e-11);
}

BOOST_AUTO_TEST_CASE(series_has_them) {
  const Number torque(0.1, 0.3, {{0.7, 3.1, 0.4}});
  const System system(RestingFrame<>{}, driven_rotor(torque), UniformGravity<Guide>{{0, 0, -9.81}});
  Eigen::VectorXd y(4);
  y << 0.3, 0.1, -0.4, 2;
  test::hold_series("a driven rotor", system, y, 0.05, 1e-14);
}

/// In dual numbers the field's slope in time is the slope of the signal.
BOOST_AUTO_TEST_CASE(slope_in_time_is_exact) {
  using Dual = Eigen::AutoDiffScalar<Eigen::Matrix<double, 1, 1>>;
  const Number torque(0, 0, {{0.7, 3.1, 0.4}});
  const System wheel = acted_on(JointKind::revolute, torque);
  Dual t(1.3);
  t.derivatives()[0] = 1;
  const Eigen::Matrix<Dual, Eigen::Dynamic, 1> y = Eigen::VectorXd::Zero(2).cast<Dual>();
  const auto rates = wheel.rates(t, y);
  BOOST_TEST(std::abs(rates[1].value() - torque(1.3) / about) <= 1e-15);
  BOOST_TEST(std::abs(rates[1].derivatives()[0] - torque.derivative(1.3, 1) / about) <= 1e-14);
}

BOOST_AUTO_TEST_CASE(energy_is_no_invariant) {
  const Number torque = Number::steps({{1, 0.2}});
  const System wheel = acted_on(JointKind::revolute, torque);
  BOOST_TEST(wheel.conserved(0, wheel.rest()).empty());
  // Both parts rotate about the axis together: their momentum is conserved, the energy is not.
  const System pair(RestingFrame<>{}, driven_rotor(torque));
  const auto kept = pair.conserved(0, pair.rest());
  BOOST_TEST_REQUIRE(kept.size() == 1);
  BOOST_TEST(kept.front().first == "angular momentum about the axis of 'carrier'");
}

BOOST_AUTO_TEST_CASE(free_rotor_takes_no_torque) {
  auto bodies = driven_rotor(Number::steps({{1, 0.2}}));
  bodies[1].rotor->mode = RotorMode::free;
  BOOST_CHECK_THROW(System(RestingFrame<>{}, bodies), InvalidInput);
}

BOOST_AUTO_TEST_CASE(terms_name_them) {
  bool named = false;
  for (const Term& term : acted_on(JointKind::revolute, Number(0, 1, {})).terms()) {
    named = named || (term.kept && term.name == "forces in joints that change with time");
  }
  BOOST_TEST(named);
}

BOOST_AUTO_TEST_SUITE_END()
