#include <boost/test/unit_test.hpp>

#include <cmath>
#include <vector>

#include <dynamics/exact/pendulum_motion.hpp>
#include <dynamics/guide/resting.hpp>
#include <dynamics/scene/body_system.hpp>
#include <dynamics/scene/cardan_gyro.hpp>
#include <dynamics/solve/solve.hpp>

/// Trees of bodies, whose states have a size known at run time only.

using namespace kreisel;

BOOST_AUTO_TEST_SUITE(solve_trees)

BOOST_AUTO_TEST_CASE(solves_trees_of_bodies) {
  const InertiaTensor<Body> bob{{2, {0, 0, -1}, {0.6, 0.6, 0.1}}};
  const BodyDescription rod{
      .name = "rod", .joint = {.kind = JointKind::revolute, .axis = {1, 0, 0}}, .inertia = bob};
  const BodySystem system(RestingFrame<>{}, {rod}, UniformGravity<Guide>{{0, 0, -9.81}});
  auto start = system.rest();
  start.coordinates[0] = 0.7;
  const exact::PendulumMotion truth(9.81 / 0.6, 0.7, 0);
  const auto found = solve(system, start, {.times = {5, 10, 15, 20}, .tolerance = 1e-10});
  BOOST_TEST(found.report.tolerance_kept);
  BOOST_TEST(found.report.invariants.size() > 0);
  for (std::size_t i = 0; i < found.times.size(); ++i) {
    BOOST_TEST(std::abs(found.states[i].coordinates[0] - truth.at(found.times[i]).angle) <= 1e-10);
  }
  for (const Method method : {Method::radau13, Method::gauss16}) {
    const auto other = solve(system, start, {.times = {20}, .tolerance = 1e-10, .method = method});
    BOOST_TEST(other.report.tolerance_kept);
    BOOST_TEST(std::abs(other.states[0].coordinates[0] - truth.at(20).angle) <= 1e-10);
  }
}

// The Cardan gyro with the stiff bearing once more, as three bodies.
BOOST_AUTO_TEST_CASE(gives_way_in_stiff_trees_too) {
  const Vector3<double> rotor(5e-4, 5e-4, 8e-4), inner(2e-4, 3e-4, 2.5e-4), outer(4e-4, 1, 1);
  const auto body = [](const char* name, const char* parent, const Vector3<double>& axis,
                       const Vector3<double>& moments, const JointForce& force) {
    return BodyDescription{
        .name = name,
        .parent = parent,
        .joint = {.kind = JointKind::revolute, .axis = axis},
        .inertia = InertiaTensor<Body>::about_origin(1, {0, 0, 0}, moments.asDiagonal()),
        .forces = {force}};
  };
  const double stiffness = 1e9;
  const BodySystem system(
      RestingFrame<>{},
      {body("outer ring", "guide", {1, 0, 0}, outer, {.stiffness = 0.5, .damping = 1e-3}),
       body("inner ring", "outer ring", {0, 1, 0}, inner,
            {.stiffness = stiffness, .rest = 0.3, .damping = 2e-3 * stiffness}),
       body("rotor", "inner ring", {0, 0, 1}, rotor, {})});
  auto start = system.rest();
  start.coordinates[1] = 0.3;  // where the gyro's angle begins to count
  start.rates << 0.5, 0, 500;
  const Task task{.times = {0.5, 1, 1.5, 2}, .tolerance = 1e-9};
  const auto as_bodies = solve(system, start, task);
  const CardanGyro gyro({.rotor = rotor, .inner_ring = inner, .outer_ring = outer},
                        {.outer = {0.5, 1e-3, 0}, .inner = {stiffness, 2e-3 * stiffness, 0.3}},
                        RestingFrame<>{});
  const auto as_gyro = solve(gyro, {.alpha_rate = 0.5, .phi_rate = 500}, task);
  BOOST_TEST(as_bodies.report.method == "radau13");
  BOOST_TEST(as_bodies.report.tolerance_kept);
  BOOST_TEST_MESSAGE(as_bodies.report.all_evaluations << " evaluations of the tree, "
                                                      << as_gyro.report.all_evaluations
                                                      << " of the gyro");
  for (std::size_t i = 0; i < task.times.size(); ++i) {
    const auto& [q, v] = as_bodies.states[i];
    BOOST_TEST(std::abs(q[0] - as_gyro.states[i].alpha) <= 2e-9);
    BOOST_TEST(std::abs(q[1] - 0.3 - as_gyro.states[i].beta) <= 2e-9);
    BOOST_TEST(std::abs(v[0] - as_gyro.states[i].alpha_rate) <= 2e-9);
  }
}

BOOST_AUTO_TEST_SUITE_END()
