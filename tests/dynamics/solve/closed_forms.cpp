// Trees that solve() recognises: free Cardan gyros, and tops on moving guides. Steps are the second
// way to the same numbers.

#include <boost/test/unit_test.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include <dynamics/guide/harmonic.hpp>
#include <dynamics/guide/resting.hpp>
#include <dynamics/guide/rotating.hpp>
#include <dynamics/solve/error_measure.hpp>
#include <dynamics/solve/solve.hpp>
#include <dynamics/tree/body_system.hpp>

#include <support/sample.hpp>
#include <support/worst.hpp>

using namespace kreisel;
using test::Sample;

namespace {

/// Moments of a box, so that the triangle inequality holds.
InertiaTensor<Body> box(Sample& sample, double mass = 1) {
  const Vector3<double> s(sample.uniform(.002, .02), sample.uniform(.002, .02),
                          sample.uniform(.002, .02));
  return {{mass, Vector3<double>::Zero(), {s.y() + s.z(), s.z() + s.x(), s.x() + s.y()}}};
}

using Bodies = std::vector<BodyDescription>;

/// A gyro on the axes k, k + 1, k + 2 of the guide, or with the third reversed.
Bodies gyro(Sample& sample, bool regulated) {
  const int k = int(sample.uniform(0, 3));
  Bodies bodies(3);
  const char* const names[] = {"outer", "inner", "rotor"};
  for (int i = 0; i < 3; ++i) {
    BodyDescription& body = bodies[std::size_t(i)];
    body.name = names[i];
    if (i > 0) body.parent = names[i - 1];
    body.joint.kind = JointKind::revolute;
    body.joint.axis = Vector3<double>::Unit((k + i) % 3);
    body.inertia = box(sample);
  }
  Symmetric3<>& t = bodies[2].inertia.value.tensor;
  Matrix3<double> round = 0.01 * Matrix3<double>::Identity();
  round((k + 2) % 3, (k + 2) % 3) = 0.015;
  t = Symmetric3<>::from(round);
  if (sample.once_in(2)) bodies[2].joint.axis = -bodies[2].joint.axis;
  bodies[2].rotor = Rotor{.mode = regulated ? RotorMode::regulated : RotorMode::free};
  return bodies;
}

struct Judged {
  double distance;  ///< of the closed form from steps, in the measure of the estimate
  double told;      ///< sum of both estimates
  bool closed;
};

template <class System>
Judged judge(const System& system, const typename System::State& start, double t_end) {
  std::vector<double> times;
  for (int i = 1; i <= 7; ++i) times.push_back(-1 + (t_end + 1) * i / 7);
  SolveOptions options{.begin = -1, .output_times = times, .tolerance = 1e-12};
  const auto closed = solve(system, start, options);
  options.method = Method::verner98;
  auto steps = solve(system, start, options);
  ErrorMeasure<System> measure(system, options.absolute_scale);
  measure.note_sizes(steps.report.sizes);
  double worst = 0;
  for (std::size_t i = 0; i < times.size(); ++i) {
    auto& quaternion = steps.states[i].coordinates;
    if (quaternion.size() == 4 && quaternion.dot(closed.states[i].coordinates) < 0) {
      quaternion = -quaternion;
    }
    worst = test::worst_of(
        worst, measure(System::to_vector(closed.states[i]), System::to_vector(steps.states[i])));
  }
  return {worst, closed.report.error_estimate + steps.report.error_estimate,
          closed.report.all_evaluations == 0};
}

HarmonicFrame<> ship(Sample& sample) {
  HarmonicSeries<> u{sample.uniform(0, 1) * sample.direction(), {}};
  u.terms.push_back({sample.direction(), sample.uniform(0.2, 3), sample.uniform(-3, 3)});
  return {u, {{1, 2, 3}, {}}, -2, 20};
}

BodyDescription ball(Sample& sample) {
  return {.name = "ball",
          .joint = {.kind = JointKind::spherical,
                    .position = sample.direction(),
                    .orientation = Eigen::Quaterniond(sample.rotation())},
          .inertia = box(sample)};
}

template <class M>
typename BodySystem<M>::State turned(const BodySystem<M>& system, Sample& sample) {
  auto start = system.rest();
  start.coordinates = Eigen::Quaterniond(sample.rotation()).coeffs();
  start.rates = sample.uniform(0, 3) * sample.direction();
  return start;
}

}  // namespace

BOOST_AUTO_TEST_SUITE(closed_forms_of_trees)

BOOST_AUTO_TEST_CASE(free_cardan_gyros) {
  double worst = 0;
  int closed = 0;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    Sample sample(seed);
    const BodySystem system(RestingFrame<>{}, gyro(sample, seed % 2 == 0),
                            UniformGravity<Guide>{{0, 0, -9.81}});
    auto start = system.rest();
    // Also beyond 90 degrees.
    start.coordinates << sample.uniform(-4, 4),
        sample.uniform(-1.2, 1.2) + (seed % 3 == 0 ? 3.1 : 0), sample.uniform(-4, 4);
    start.rates << sample.uniform(-1, 1), sample.uniform(-1, 1), sample.uniform(-60, 60);
    const Judged run = judge(system, start, 6);
    if (!run.closed) continue;
    ++closed;
    BOOST_TEST(run.distance <= run.told,
               "seed " << seed << ": " << run.distance << " of " << run.told);
    worst = test::worst_of(worst, run.distance);
  }
  BOOST_TEST_MESSAGE(closed << " closed, worst distance from steps " << worst);
  BOOST_TEST(closed >= 40);
}

BOOST_AUTO_TEST_CASE(tops_on_moving_guides) {
  double worst = 0;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    Sample sample(seed);
    const auto on = [&](const auto& guide) {
      const BodySystem system(guide, {ball(sample)}, UniformGravity<Inertial>{{0, 0, -9.81}});
      const Judged run = judge(system, turned(system, sample), 15);
      BOOST_TEST(run.closed);
      BOOST_TEST(run.distance <= run.told,
                 "seed " << seed << ": " << run.distance << " of " << run.told);
      worst = test::worst_of(worst, run.distance);
    };
    if (seed % 2 == 0) {
      on(ship(sample));
    } else {
      on(RotatingFrame<>{.angular_velocity = sample.direction(), .origin_acceleration = {0, 1, 0}});
    }
  }
  BOOST_TEST_MESSAGE("worst distance from steps " << worst);
}

// Everything that acts on a body, and each property that the closed form lacks.
BOOST_AUTO_TEST_CASE(all_others_take_steps) {
  using Change = std::function<void(Bodies&)>;
  const auto takes_steps = [](const auto& guide, const Bodies& plain, const Change& change,
                              const std::string& what) {
    Bodies bodies = plain;
    change(bodies);
    const BodySystem system(guide, bodies, UniformGravity<Guide>{{0, 0, -9.81}});
    auto start = system.rest();
    start.rates.setConstant(1);
    if (start.rates.size() == 3 && bodies.size() == 3) start.rates[2] = 60;
    const auto run = solve(system, start, {.output_times = {0.01}, .tolerance = 1e-6});
    BOOST_TEST((run.report.all_evaluations > 0) == !what.empty(), what);
  };
  const auto push = [](const LoadContext<>&) { return Force<Body>{{{0, 0, 0}, {1e-3, 0, 0}}}; };
  Sample sample(3);
  const Bodies rings = gyro(sample, false);
  const auto rest = [&](const std::string& what, const Change& change) {
    takes_steps(RestingFrame<>{}, rings, change, what);
  };
  rest("", [](Bodies&) {});
  rest("a spring", [](Bodies& b) { b[0].forces = {JointForce{.stiffness = 1}}; });
  rest("a damper", [](Bodies& b) { b[1].forces = {JointForce{.damping = 1e-3}}; });
  rest("a torque", [](Bodies& b) { b[1].forces = {JointForce{.constant = 1e-3}}; });
  rest("a load", [&](Bodies& b) { b[0].loads = {push}; });
  rest("an unbalance", [](Bodies& b) { b[1].inertia.value.first_moment = {1e-3, 0, 0}; });
  rest("a product", [](Bodies& b) { b[0].inertia.value.tensor.xy = 1e-4; });
  rest("a motor", [](Bodies& b) { b[2].rotor = Rotor{RotorMode::torque, 1e-3}; });
  rest("an arm", [](Bodies& b) { b[1].joint.position = {0.1, 0, 0}; });
  rest("a locked ring", [](Bodies& b) { b[1].rule = JointRule::held; });
  takes_steps(
      RotatingFrame<>{.angular_velocity = {0, 0, 1e-3}}, rings, [](Bodies&) {},
      "a guide that turns");

  const Bodies one{ball(sample)};
  const RotatingFrame<> turning{.angular_velocity = {0, 0, 1}};
  takes_steps(
      turning, one, [](Bodies&) {}, "");
  takes_steps(
      turning, one, [&](Bodies& b) { b[0].loads = {push}; }, "a load on a ball");
  takes_steps(
      turning, one,
      [](Bodies& b) {
        b[0].inertia.value.first_moment = {1e-3, 0, 0};
      },
      "a pendulum");
}

BOOST_AUTO_TEST_SUITE_END()
