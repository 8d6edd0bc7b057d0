#include <boost/test/unit_test.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <vector>

#include <dynamics/exact/pendulum_motion.hpp>
#include <dynamics/gimbal/cardan_gyro.hpp>
#include <dynamics/guide/resting.hpp>
#include <dynamics/guide/rotating.hpp>
#include <dynamics/solve/solve.hpp>
#include <dynamics/tree/body_system.hpp>

#include <support/random_tree.hpp>
#include <support/sample.hpp>
#include <support/worst.hpp>

/// Trees of bodies, whose states have a size known only at run time.

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
  const auto found = solve(system, start, {.output_times = {5, 10, 15, 20}, .tolerance = 1e-10});
  BOOST_TEST(found.report.tolerance_kept);
  BOOST_TEST(found.report.invariants.size() > 0);
  for (std::size_t i = 0; i < found.times.size(); ++i) {
    BOOST_TEST(std::abs(found.states[i].coordinates[0] - truth.at(found.times[i]).angle) <= 1e-10);
  }
  for (const Method method : {Method::verner98, Method::radau13, Method::gauss16}) {
    const auto other =
        solve(system, start, {.output_times = {20}, .tolerance = 1e-10, .method = method});
    BOOST_TEST(other.report.method == name(method));
    BOOST_TEST(other.report.tolerance_kept);
    BOOST_TEST(std::abs(other.states[0].coordinates[0] - truth.at(20).angle) <= 1e-10);
  }
}

// A tree in which nothing can move has an empty state, which all methods accept.
BOOST_AUTO_TEST_CASE(solves_trees_without_motion) {
  const InertiaTensor<Body> block{{2, {0, 0, -1}, {2.6, 2.6, 0.1}}};
  const BodySystem system(RestingFrame<>{}, {{.name = "block", .inertia = block}},
                          UniformGravity<Guide>{{0, 0, -9.81}});
  BOOST_TEST(system.rest().coordinates.size() == 0);
  for (const Method method :
       {Method::automatic, Method::verner98, Method::radau13, Method::gauss16}) {
    const auto found = solve(system, system.rest(), {.output_times = {1, 2}, .method = method});
    BOOST_TEST(found.report.tolerance_kept, name(method));
    BOOST_TEST(found.states.size() == 2U, name(method));
  }
}

// The Cardan gyro with the stiff bearing again, as three bodies.
BOOST_AUTO_TEST_CASE(changes_the_method_for_stiff_trees) {
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
  start.coordinates[1] = 0.3;  // where the gyro's angle is 0
  start.rates << 0.5, 0, 500;
  const SolveOptions options{.output_times = {0.5, 1, 1.5, 2}, .tolerance = 1e-9};
  const auto as_bodies = solve(system, start, options);
  const CardanGyro gyro({.rotor = rotor, .inner_ring = inner, .outer_ring = outer},
                        {.outer = {0.5, 1e-3, 0}, .inner = {stiffness, 2e-3 * stiffness, 0.3}},
                        RestingFrame<>{});
  const auto as_gyro = solve(gyro, {.alpha_rate = 0.5, .phi_rate = 500}, options);
  BOOST_TEST(as_bodies.report.method == "radau13");
  BOOST_TEST(as_bodies.report.tolerance_kept);
  BOOST_TEST_MESSAGE(as_bodies.report.all_evaluations << " evaluations of the tree, "
                                                      << as_gyro.report.all_evaluations
                                                      << " of the gyro");
  for (std::size_t i = 0; i < options.output_times.size(); ++i) {
    const auto& [q, v] = as_bodies.states[i];
    BOOST_TEST(std::abs(q[0] - as_gyro.states[i].alpha) <= 2e-9);
    BOOST_TEST(std::abs(q[1] - 0.3 - as_gyro.states[i].beta) <= 2e-9);
    BOOST_TEST(std::abs(v[0] - as_gyro.states[i].alpha_rate) <= 2e-9);
  }
}

// Random trees against finer steps of another method. The reported error is that of the steps.
BOOST_AUTO_TEST_CASE(reports_its_error_by_series) {
  using Scene = BodySystem<RestingFrame<>>;
  int runs = 0;
  int within = 0;
  double greatest = 0;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    const Scene system(RestingFrame<>{}, test::random_tree(seed),
                       UniformGravity<Guide>{{1, 2, -9}});
    test::Sample sample(seed);
    auto start = system.rest();
    for (double& q : start.coordinates) q += sample.uniform(-0.5, 0.5);
    for (double& v : start.rates) v = sample.uniform(-1, 1);
    // The outputs are so dense that the reference sizes, those of all steps, equal those of the
    // outputs.
    SolveOptions options{.output_times = {}, .tolerance = 1e-13, .method = Method::verner98};
    for (int i = 0; i <= 200; ++i) options.output_times.push_back(0.01 * i);
    const auto truth = solve(system, start, options);
    for (const double tolerance : {1e-4, 1e-6, 1e-8, 1e-10}) {
      options.tolerance = tolerance;
      options.method = Method::taylor;
      const auto found = solve(system, start, options);
      ErrorMeasure<Scene> distance(system, options.absolute_scale);
      double error = 0;
      for (std::size_t i = 0; i < options.output_times.size(); ++i) {
        error = test::worst_of(
            error, distance(Scene::to_vector(found.states[i]), Scene::to_vector(truth.states[i])));
      }
      const double ratio = error / found.report.error_estimate;
      // Below this limit the estimate is rounding, in trees that hardly move.
      const bool by_steps = found.report.error_estimate > 1e-13;
      runs += by_steps ? 1 : 0;
      within += by_steps && ratio >= 0.1 && ratio <= 1 ? 1 : 0;
      greatest = test::worst_of(greatest, ratio);
      BOOST_TEST(found.report.tolerance_kept, "tree " << seed << " to " << tolerance);
      BOOST_TEST(error <= tolerance, "tree " << seed << " to " << tolerance << ": " << error);
    }
  }
  BOOST_TEST_MESSAGE(within << " of " << runs << " in [0.1, 1], greatest " << greatest);
  BOOST_TEST(runs >= 140);
  BOOST_TEST(within >= 0.95 * runs);
  BOOST_TEST(greatest <= 3);
}

namespace {

using Resting = BodySystem<RestingFrame<>>;

/// Distance of coordinates or rates, relative to their size.
double apart(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  return (a - b).lpNorm<Eigen::Infinity>() / std::max(1.0, b.lpNorm<Eigen::Infinity>());
}

double distance(const Resting::State& a, const Resting::State& b, JointKind kind) {
  Eigen::VectorXd x = a.coordinates, y = b.coordinates;
  if (kind != JointKind::revolute) {
    x.head<4>().normalize();
    y.head<4>().normalize();
  }
  return std::max(apart(x, y), apart(a.rates, b.rates));
}

BodyDescription one(JointKind kind, const InertiaTensor<Body>& inertia) {
  return {.name = "one", .joint = {.kind = kind, .axis = {0, 1, 0}}, .inertia = inertia};
}

const InertiaTensor<Body> brick =
    InertiaTensor<Body>::about_origin(1.3, {0, 0, 0}, Vector3<double>(1, 1.5, 2).asDiagonal());
const Gravity weight = UniformGravity<Guide>{{0, 0, -9.81}};

}  // namespace

// Against steps without a closed form. They use the tensor about an axis and the arm as rounded:
// 1e-13 is 100 such roundings of the total angle.
BOOST_AUTO_TEST_CASE(recognises_pendulums_and_tops) {
  test::Sample sample(11);
  const auto vector = [&sample] {
    return Vector3<double>(sample.uniform(0.3, 1.5) * sample.direction());
  };
  const auto attitude = [&sample] { return Eigen::Quaterniond(sample.rotation()); };
  double worst = 0;
  for (int i = 0; i < 40; ++i) {
    const JointKind kind = i % 4 == 0   ? JointKind::revolute
                           : i % 4 == 1 ? JointKind::free
                                        : JointKind::spherical;
    BodyDescription body = one(kind, brick);
    body.joint.position = vector();
    Vector3<double> g = 5 * vector();
    if (kind == JointKind::revolute) {
      body.joint.axis = vector();
      body.joint.orientation = attitude();
      const Vector3<double> a = vector();
      body.inertia = InertiaTensor<Body>::about_centre(
          1.3, vector(), 2 * Matrix3<double>::Identity() - 0.3 * a * a.transpose());
    } else if (kind == JointKind::free) {
      body.joint.orientation = attitude();
    } else {  // Lagrange's top, upright and hanging; Euler's, if no load acts
      const double arm = i % 8 == 2 ? 0.5 : -0.5;
      body.inertia = InertiaTensor<Body>::about_origin(1.3, {0, 0, arm},
                                                       Vector3<double>(1.5, 1.5, 0.7).asDiagonal());
      g = i % 8 == 3 ? Vector3<double>(0, 0, 0) : Vector3<double>(0, 0, -9.81);
    }
    const Resting system({}, {body}, UniformGravity<Guide>{g});
    auto start = system.rest();
    for (double& rate : start.rates) rate = sample.uniform(-1, 1);
    if (kind == JointKind::revolute) {
      start.coordinates[0] = sample.uniform(-3, 3);
    } else {
      start.coordinates.head<4>() = attitude().coeffs();
      if (kind == JointKind::free) start.coordinates.tail<3>() = vector();
    }
    const std::vector<double> times{-1, 0.5, 3, 7};
    const auto known =
        solve(system, start, {.begin = -2, .output_times = times, .tolerance = 1e-13});
    const auto steps =
        solve(system, start,
              {.begin = -2, .output_times = times, .tolerance = 1e-13, .method = Method::verner98});
    BOOST_TEST(known.report.all_evaluations == 0, known.report.method);
    BOOST_TEST(known.report.tolerance_kept);
    BOOST_TEST(known.report.invariants.size() == steps.report.invariants.size());
    for (const InvariantDrift& drift : known.report.invariants) {
      BOOST_TEST(drift.largest <= 1e-12, drift.name);  // of sums of some 20
    }
    for (std::size_t k = 0; k < times.size(); ++k) {
      worst = std::max(worst, distance(known.states[k], steps.states[k], kind));
    }
  }
  BOOST_TEST(worst <= 1e-13);
}

BOOST_AUTO_TEST_CASE(uses_steps_for_other_systems) {
  const auto by_steps = [](BodyDescription body, auto guide, const Gravity& gravity = weight) {
    const BodySystem system(std::move(guide), {std::move(body)}, gravity);
    auto start = system.rest();
    start.rates.setConstant(0.3);
    const auto found = solve(system, start, {.output_times = {0.5}, .tolerance = 1e-8});
    return found.report.tolerance_kept && found.report.all_evaluations > 0;
  };
  using enum JointKind;
  const RestingFrame<> still;
  const InertiaTensor<Body> rod{{1, {0.3, 0, 0}, {0.1, 0.2, 0.2}}};
  BOOST_TEST(!by_steps(one(revolute, rod), still));  // the subject of this test
  BodyDescription other = one(revolute, rod);
  other.forces = {{.stiffness = 1}};
  BOOST_TEST(by_steps(other, still));
  other.forces = {{.damping = 1}};
  BOOST_TEST(by_steps(other, still));
  other.forces = {{.constant = 1}};
  BOOST_TEST(by_steps(other, still));
  other = one(revolute, rod);
  other.loads = {ConstantLoad<Body>{{0, 0, 1}}};
  BOOST_TEST(by_steps(other, still));
  BOOST_TEST(by_steps(one(revolute, rod), still, {}));  // no load acts
  BOOST_TEST(by_steps(one(revolute, rod), RotatingFrame<>{{0, 0, 0.1}}));
  BOOST_TEST(by_steps(one(prismatic, rod), still));
  BOOST_TEST(by_steps(one(free, rod), still));  // the centre of mass is not at the origin
  BOOST_TEST(by_steps(one(spherical, InertiaTensor<Body>{{1, {0, 0.3, 0.3}, {1, 1, 1}}}), still));
  BOOST_TEST(by_steps(one(spherical, InertiaTensor<Body>{{1, {0, 0, 0.3}, {1, 1.1, 0.5}}}), still));
  Inertia<> oblique = brick.value;
  oblique.tensor.xy = 0.1;
  BOOST_TEST(by_steps(one(spherical, {oblique}), still));
  BOOST_TEST(by_steps(one(free, {oblique}), still));
  other = one(spherical, InertiaTensor<Body>{{1, {0, 0, 0.3}, {1, 1, 0.5}}});
  BOOST_TEST(!by_steps(other, still));
  other.joint.orientation = Eigen::Quaterniond(0.8, 0.6, 0, 0);  // its start is rounded
  BOOST_TEST(by_steps(other, still));
  const Resting two({},
                    {one(revolute, rod),
                     {.name = "two",
                      .parent = "one",
                      .joint = {.kind = revolute, .axis = {0, 1, 0}},
                      .inertia = rod}},
                    weight);
  BOOST_TEST(solve(two, two.rest(), {.output_times = {0.1}}).report.all_evaluations > 0);
}

BOOST_AUTO_TEST_CASE(follows_a_pendulum_for_any_time) {
  const BodySystem system(RestingFrame<>{},
                          {one(JointKind::revolute, {{2, {0, 0, -1}, {0.6, 0.6, 0.1}}})}, weight);
  auto start = system.rest();
  start.coordinates[0] = 0.7;
  const exact::PendulumMotion truth(9.81 / 0.6, 0.7, 0);
  const auto found = solve(system, start, {.output_times = {1e6}, .tolerance = 1e-8});
  const double off = std::abs(found.states[0].coordinates[0] - truth.at(1e6).angle) / 0.7;
  BOOST_TEST(found.report.tolerance_kept);
  BOOST_TEST(off <= 1e-9);  // of 9.81/0.6 as rounded
}

// From any output of any run: the same states and the same report.
BOOST_AUTO_TEST_CASE(continues_from_a_checkpoint_exactly) {
  const InertiaTensor<Body> bob{{2, {0, 0, -1}, {0.6, 0.6, 0.1}}};
  const BodyDescription swinging{
      .name = "rod", .joint = {.kind = JointKind::revolute, .axis = {1, 0, 0}}, .inertia = bob};
  const BodyDescription free{.name = "top",
                             .parent = "rod",
                             .joint = {.kind = JointKind::spherical, .position = {0, 0, -2}},
                             .inertia = {{1, {0, 0, 0.1}, {0.2, 0.3, 0.4}}}};
  BodyDescription creeping = swinging;
  creeping.forces = {{.stiffness = 1e6, .damping = 1e7}};
  struct Case {
    std::vector<BodyDescription> bodies;
    SolveOptions options;
    const char* method;
    bool begins_again;
  };
  const std::vector<double> times{0.3, 0.31, 0.32, 0.33, 0.4, 1, 3, 4.5};
  std::vector<double> long_times = times;
  long_times.push_back(30);
  const Case cases[] = {
      {{swinging, free}, {.output_times = times}, "taylor", false},
      {{swinging, free},
       {.output_times = long_times},
       "verner98",
       true},  // where taylor rounds too much
      {{swinging, free}, {.output_times = long_times, .method = Method::taylor}, "taylor", true},
      {{swinging, free}, {.output_times = times, .method = Method::verner98}, "verner98", false},
      {{swinging, free},
       {.output_times = long_times, .method = Method::verner98},
       "verner98",
       true},
      {{swinging, free}, {.output_times = times, .method = Method::gauss16}, "gauss16", false},
      {{swinging, free}, {.output_times = times, .method = Method::radau13}, "radau13", false},
      {{creeping, free}, {.output_times = times}, "radau13", false}};
  for (Case c : cases) {
    const BodySystem system(RestingFrame<>{}, c.bodies, UniformGravity<Guide>{{0, 0, -9.81}});
    auto start = system.rest();
    start.coordinates[0] = 0.7;
    start.rates << 0, 1, 3, 0.1;
    std::vector<std::vector<double>> checkpoints;
    c.options.offer_checkpoint = [&](const auto& checkpoint) {
      checkpoints.push_back(checkpoint());
    };
    const auto whole = solve(system, start, c.options);
    BOOST_TEST(whole.report.method == c.method);
    // Runs are also compared between outputs.
    BOOST_TEST(*std::max_element(whole.errors.begin(), whole.errors.end()) <=
               whole.report.error_estimate);
    BOOST_TEST((checkpoints.size() >= c.options.output_times.size()) == c.begins_again,
               checkpoints.size());
    for (const auto& checkpoint : checkpoints) {
      SolveOptions rest = c.options;
      rest.offer_checkpoint = nullptr;
      rest.checkpoint = checkpoint;
      const auto found = solve(system, start, rest);
      const std::size_t before = whole.times.size() - found.times.size();
      for (std::size_t i = 0; i < found.times.size(); ++i) {
        BOOST_TEST(found.times[i] == whole.times[before + i]);
        BOOST_TEST(found.errors[i] == whole.errors[before + i]);
        BOOST_TEST(found.states[i].coordinates == whole.states[before + i].coordinates);
        BOOST_TEST(found.states[i].rates == whole.states[before + i].rates);
      }
      BOOST_TEST(found.report.error_estimate == whole.report.error_estimate);
      BOOST_TEST(found.report.effort.steps == whole.report.effort.steps);
      BOOST_TEST(found.report.effort.evaluations == whole.report.effort.evaluations);
      BOOST_TEST(found.report.all_evaluations == whole.report.all_evaluations);
      BOOST_TEST(found.report.invariants.size() == whole.report.invariants.size());
      for (std::size_t i = 0; i < found.report.invariants.size(); ++i) {
        BOOST_TEST(found.report.invariants[i].largest == whole.report.invariants[i].largest);
      }
      rest.checkpoint.pop_back();
      BOOST_CHECK_THROW((void)solve(system, start, rest), InvalidInput);
    }
    SolveOptions other = c.options;
    other.checkpoint = checkpoints.front();
    other.method = c.options.method == Method::gauss16 ? Method::radau13 : Method::gauss16;
    BOOST_CHECK_THROW((void)solve(system, start, other), InvalidInput);
  }
}

BOOST_AUTO_TEST_SUITE_END()
