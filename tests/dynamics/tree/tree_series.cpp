#include <boost/test/data/monomorphic.hpp>
#include <boost/test/data/test_case.hpp>
#include <boost/test/unit_test.hpp>

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include <dynamics/guide/harmonic.hpp>
#include <dynamics/guide/rotating.hpp>
#include <dynamics/load/drag.hpp>
#include <dynamics/load/magnet.hpp>
#include <dynamics/load/signal_load.hpp>
#include <dynamics/pendulum/pendulum_series.hpp>
#include <dynamics/solve/solve.hpp>
#include <dynamics/tree/body_system.hpp>

#include <support/random_tree.hpp>
#include <support/sample.hpp>
#include <support/series.hpp>

using namespace kreisel;
using test::Sample;
namespace data = boost::unit_test::data;

namespace {

/// If a body hangs on a lighter one, the accelerations differ by more than rounding of each: 1e-13
/// is 450u.
template <class M>
void hold_tree(const std::string& what, const BodySystem<M>& system, std::uint64_t seed) {
  BOOST_TEST_REQUIRE(system.knows_series());
  Sample sample(seed + 1000);
  Eigen::VectorXd y = system.to_vector(system.rest());
  for (double& x : y) x += sample.uniform(-1, 1);
  test::hold_series(what, system, y, 0.05, 1e-13);
}

}  // namespace

BOOST_AUTO_TEST_SUITE(tree_series)

BOOST_DATA_TEST_CASE(agrees_for_trees_on_all_guides, data::xrange(120), seed) {
  const auto number = static_cast<std::uint64_t>(seed);
  const auto bodies = test::random_tree(number);
  const UniformGravity<Guide> along_guide{{1, 2, -9}};
  const UniformGravity<Inertial> resting{{1, 2, -9}};
  hold_tree("at rest", BodySystem(RestingFrame<>{}, bodies, along_guide), number);
  RestingFrame<> aslant;
  aslant.X.value.rotation = Sample(number).rotation();
  hold_tree("at rest aslant", BodySystem(aslant, bodies, resting), number);
  const RotatingFrame<> turntable{{0.3, -0.8, 0.5}, {1, 2, 3}};
  hold_tree("on a turntable", BodySystem(turntable, bodies, along_guide), number);
  hold_tree("on a turntable, gravity at rest", BodySystem(turntable, bodies, resting), number);
  const HarmonicSeries<> u{{0.1, -0.2, 0.3}, {{{0.3, 0.1, -0.2}, 1.3, 0.4}}};
  hold_tree("on a harmonic guide", BodySystem(HarmonicFrame<>(u, {}, 0, 2), bodies, resting),
            number);
}

/// A random function of time.
template <class Value>
Signal<Value> random_signal(const std::function<Value()>& value, Sample& sample) {
  return {value(), value(), {{value(), sample.uniform(0.5, 2), sample.uniform(-1, 1)}}};
}

/// A random tree with loads, drives and rotors that follow functions of time.
std::vector<BodyDescription> tree_in_time(std::uint64_t seed) {
  Sample sample(seed + 2000);
  const std::function number = [&sample] { return sample.uniform(-1, 1); };
  const std::function vector = [&sample]() -> Vector3<double> { return 2 * sample.direction(); };
  auto bodies = test::random_tree(seed);
  for (BodyDescription& body : bodies) {
    if (body.rotor && body.rotor->mode == RotorMode::regulated) {
      body.rotor->acceleration = TimeFunction(random_signal<double>(number, sample), 1);
    }
    if (body.rotor) continue;
    const bool is_single = joint_type(body.joint.kind).rate_count() == 1;
    if (is_single && body.rule == JointRule::driven) {
      body.acceleration = TimeFunction(random_signal<double>(number, sample), 2);
    }
    const auto force = random_signal(vector, sample);
    const auto torque = random_signal(vector, sample);
    if (sample.once_in(2)) body.loads.emplace_back(SignalLoad<Guide>{force, torque, vector()});
    if (sample.once_in(3)) body.loads.emplace_back(SignalLoad<Body>{torque, force, vector()});
    if (sample.once_in(3))
      body.loads.emplace_back(ConstantLoad<Guide>{vector(), vector(), vector()});
    if (sample.once_in(3)) body.loads.emplace_back(SignalLoad<Inertial>{force, torque, vector()});
    if (sample.once_in(3)) body.loads.emplace_back(Magnet{vector(), random_signal(vector, sample)});
  }
  return bodies;
}

BOOST_DATA_TEST_CASE(agrees_for_functions_of_time, data::xrange(120), seed) {
  const auto number = static_cast<std::uint64_t>(seed);
  const auto bodies = tree_in_time(number);
  const UniformGravity<Guide> gravity{{1, 2, -9}};
  hold_tree("at rest", BodySystem(RestingFrame<>{}, bodies, gravity), number);
  hold_tree("on a turntable",
            BodySystem(RotatingFrame<>{{0.3, -0.8, 0.5}, {1, 2, 3}}, bodies, gravity), number);
  const HarmonicSeries<> u{{0.1, -0.2, 0.3}, {{{0.3, 0.1, -0.2}, 1.3, 0.4}}};
  hold_tree("on a harmonic guide", BodySystem(HarmonicFrame<>(u, {}, 0, 2), bodies, gravity),
            number);
}

BOOST_DATA_TEST_CASE(agrees_for_drag, data::xrange(120), seed) {
  const auto number = static_cast<std::uint64_t>(seed);
  Sample sample(number + 3000);
  const auto matrix = [&sample] {
    return Matrix3<double>(
        Matrix3<double>::NullaryExpr([&sample] { return sample.uniform(-1, 1); }));
  };
  auto bodies = tree_in_time(number);
  for (BodyDescription& body : bodies) {
    if (body.rotor || sample.once_in(3)) continue;
    body.loads.emplace_back(
        Drag<>{.linear = matrix(),
               .angular = sample.once_in(2) ? matrix() : Matrix3<double>::Zero(),
               .point = sample.direction()});
  }
  RestingFrame<> aslant;
  aslant.X.value.rotation = sample.rotation();
  hold_tree("at rest", BodySystem(aslant, bodies, UniformGravity<Guide>{{1, 2, -9}}), number);
  hold_tree("gravity at rest", BodySystem(aslant, bodies, UniformGravity<Inertial>{{1, 2, -9}}),
            number);
}

BOOST_AUTO_TEST_CASE(agrees_for_many_rates) {
  std::vector<BodyDescription> chain;
  Sample sample(7);
  for (int i = 0; i < 20; ++i) {
    BodyDescription b;
    b.name = "link " + std::to_string(i);
    if (i > 0) b.parent = chain.back().name;
    b.joint = test::random_joint(sample, JointKind::revolute);
    b.inertia = test::random_inertia(sample);
    chain.push_back(b);
  }
  hold_tree("a chain of 20", BodySystem(RestingFrame<>{}, chain, UniformGravity<Guide>{{0, 0, -9}}),
            0);
}

BOOST_AUTO_TEST_CASE(agrees_for_floating_and_braked_bodies) {
  Sample sample(3);
  BodyDescription body;
  body.name = "body";
  body.joint = test::random_joint(sample, JointKind::free);
  body.inertia = test::random_inertia(sample);
  body.forces.assign(6, {.damping = 0.3});
  hold_tree("braked", BodySystem(RestingFrame<>{}, {body}, UniformGravity<Guide>{{0, 0, -9}}), 0);
}

/// The series of a pendulum, which also has one of its own.
BOOST_AUTO_TEST_CASE(agrees_for_a_pendulum) {
  BodyDescription rod;
  rod.name = "rod";
  rod.joint = {.kind = JointKind::revolute, .axis = {0, 1, 0}};
  rod.inertia =
      InertiaTensor<Body>::about_centre(1, {0, 0, -0.5}, Matrix3<double>::Identity() / 12);
  const BodySystem system(RestingFrame<>{}, {rod}, UniformGravity<Guide>{{0, 0, -9.81}});
  const double e = 9.81 * 0.5 / (1.0 / 12 + 0.25);
  detail::PendulumSeries pendulum(e, 0, 0, 0, 0);
  Eigen::Matrix<double, 2, 25> expected;
  Eigen::MatrixXd c(2, 25);
  c.col(0) << 0.7, -1.2;
  expected.col(0) = c.col(0);
  pendulum(0, 0.1, 20, expected);
  auto series = system.series();
  series(0, 0.1, 20, c);
  for (int k = 1; k <= 20; ++k) {
    BOOST_TEST(
        (c.col(k) - expected.col(k)).norm() <= 1e-13 * expected.col(k).norm(),
        "order " << k << ": " << c.col(k).transpose() << " and " << expected.col(k).transpose());
  }
}

/// Motions of a rod in a ball joint, which carries a rod on a hinge, by series and by other methods.
template <class M>
void agree_with_stages(const M& guide, const std::vector<BodyLoad>& loads) {
  BodyDescription upper;
  upper.name = "upper";
  upper.joint = {.kind = JointKind::spherical};
  upper.inertia = InertiaTensor<Body>::about_centre(2, {0, 0, -0.4},
                                                    Vector3<double>(0.2, 0.25, 0.1).asDiagonal());
  BodyDescription lower = upper;
  lower.name = "lower";
  lower.parent = "upper";
  lower.joint = {.kind = JointKind::revolute, .axis = {0.6, 0.8, 0}, .position = {0, 0, -0.8}};
  upper.loads = loads;
  lower.loads = loads;
  const BodySystem system(guide, {upper, lower}, UniformGravity<Inertial>{{0, 0, -9.81}});
  auto start = system.to_vector(system.rest());
  start.tail(4) << 0.4, -0.3, 0.9, 1.1;
  const auto by = [&](Method method) {
    return solve(system, system.from_vector(start),
                 {.t_end = 2, .tolerance = 1e-13, .method = method});
  };
  const auto series = by(Method::taylor);
  BOOST_TEST(by(Method::automatic).report.method == "taylor");
  const auto end = system.to_vector(series.states.back());
  for (const Method method : {Method::verner98, Method::radau13}) {
    const auto other = by(method);
    BOOST_TEST((end - system.to_vector(other.states.back())).norm() <= 1e-12);
    BOOST_TEST_MESSAGE(series.report.effort.steps << " steps, " << series.report.all_evaluations
                                                  << " evaluations; " << other.report.method << ' '
                                                  << other.report.all_evaluations);
  }
}

BOOST_AUTO_TEST_CASE(leads_where_other_methods_do) {
  const RotatingFrame<> turntable{{0.3, -0.8, 0.5}, {1, 2, 3}};
  const Signal<Vector3<double>> shaking({0.5, 0, 0}, {0, 0, 0}, {{{0, 2, 1}, 3, 0.2}});
  agree_with_stages(turntable, {SignalLoad<Inertial>{shaking, shaking, {0, 0.1, -0.2}}});
  agree_with_stages(turntable, {ConstantLoad<Inertial>{{1, 2, 0}, {0, 0.3, 0}, {0, 0, -1}}});
  agree_with_stages(turntable, {Magnet{{0, 0, 1.5}, shaking}});
  agree_with_stages(RestingFrame<>{},
                    {Drag<>{.linear = Vector3<double>(0.2, 0.3, 0.1).asDiagonal(),
                            .angular = Vector3<double>(0.01, 0.02, 0.03).asDiagonal(),
                            .point = {0, 0, -0.5}}});
}

BOOST_AUTO_TEST_CASE(is_unavailable_for_other_loads) {
  BodyDescription carrier;
  carrier.name = "carrier";
  carrier.joint = {.kind = JointKind::free};
  carrier.inertia = InertiaTensor<Body>::about_centre(1, {0, 0, 0}, Matrix3<double>::Identity());
  const auto knows = [](const std::vector<BodyDescription>& bodies) {
    return BodySystem(RestingFrame<>{}, bodies).knows_series();
  };
  BOOST_TEST(knows({carrier}));

  BodyDescription loaded = carrier;
  loaded.loads = {[](const LoadContext<>&) { return Force<Body>{}; }};
  BOOST_TEST(!knows({loaded}));
  loaded.loads = {SignalLoad<Inertial>{}, Magnet{}};
  BOOST_TEST(knows({loaded}));
  loaded.loads = {Drag<>{.linear = Matrix3<double>::Identity()}};
  BOOST_TEST(knows({loaded}));
  BOOST_TEST(!BodySystem(RotatingFrame<>{}, {loaded}).knows_series());
  loaded.loads = {Drag<>{.quadratic = Matrix3<double>::Identity()}};
  BOOST_TEST(!knows({loaded}));
  loaded.loads = {SignalLoad<Guide>{}};
  BOOST_TEST(knows({loaded}));
  Polynomials<Vector3<double>> spline{{0, 1}, 2, 1, {{0, 0, 0}, {0, 0, 0}}};
  loaded.loads = {SignalLoad<Guide>{Signal<Vector3<double>>::polynomials(spline)}};
  BOOST_TEST(!knows({loaded}));

  BodyDescription beside = carrier;
  beside.name = "beside";
  beside.parent = "carrier";
  BOOST_TEST(!knows({carrier, beside}));

  BodyDescription wheel = carrier;
  wheel.name = "wheel";
  wheel.parent = "carrier";
  wheel.joint = {.kind = JointKind::revolute, .axis = {0, 0, 1}};
  wheel.rotor = Rotor{RotorMode::regulated};
  BOOST_TEST(knows({carrier, wheel}));
  wheel.rotor->acceleration = [](double t) { return t; };
  BOOST_TEST(!knows({carrier, wheel}));
  wheel.rotor->acceleration = Signal<double>(0, 1, {});
  BOOST_TEST(knows({carrier, wheel}));
}

BOOST_AUTO_TEST_SUITE_END()
