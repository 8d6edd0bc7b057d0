#include <Eigen/Core>
#include <boost/test/unit_test.hpp>

#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include <dynamics/guide/rotating.hpp>
#include <dynamics/step/integrator.hpp>
#include <dynamics/tree/body_system.hpp>

#include <support/heap.hpp>

/// After workspace and results are made, a system's computations allocate no memory, and the
/// workspace grows linearly.

using namespace kreisel;
using namespace kreisel::test::heap;

namespace {

/// Every joint kind in turn, with springs, dampers, loads, rotors and elements.
BodySystem<RotatingFrame<>> chain(int n) {
  std::vector<BodyDescription> bodies;
  for (int i = 0; i < n; ++i) {
    BodyDescription b;
    b.name = "body " + std::to_string(i);
    if (i > 0) b.parent = "body " + std::to_string(i - 1);
    b.joint = {.kind = static_cast<JointKind>(i % 6),
               .axis = {1, 0.5, 0},
               .second_axis = {0, 0, 1},
               .position = {0, 0.25, -0.5}};
    b.inertia = InertiaTensor<Body>::about_centre(
        1, {0, 0.1, 0.2}, Vector3<double>(0.1, 0.12, 0.15).asDiagonal().toDenseMatrix());
    if (b.joint.kind == JointKind::revolute) b.forces = {{.stiffness = 1, .damping = 0.1}};
    b.loads.emplace_back(ConstantLoad<Inertial>{.force = {1, 2, 3}});
    b.loads.emplace_back(ViscousDrag<>{.torque_per_rate = 0.1});
    bodies.push_back(b);
    if (i % 6 != 0) continue;
    BodyDescription rotor;
    rotor.name = "rotor " + std::to_string(i);
    rotor.parent = b.name;
    rotor.joint = {.kind = JointKind::revolute, .axis = {0, 0, 1}};
    rotor.inertia = InertiaTensor<Body>::about_centre(
        1, {0, 0, 0}, Vector3<double>(0.1, 0.1, 0.15).asDiagonal().toDenseMatrix());
    rotor.rotor = Rotor{.mode = static_cast<RotorMode>(i / 6 % 3)};
    bodies.push_back(rotor);
  }
  MountElement mount{.name = "mount", .ends = {{{"guide"}, {"body 5"}}}};
  mount.stiffness.rm.diagonal() = Vector3<double>(20, 30, 40);
  const SpringElement spring{
      .name = "spring", .ends = {{{"body 0"}, {"body 3", {0, 0, 1}}}}, .stiffness = 10};
  const CouplingElement coupling{"coupling", {"body 1", "body 2"}, 0.5, 10, 1};
  return {{.angular_velocity = {0, 0, 1}},
          bodies,
          UniformGravity<Guide>{{0, 0, -9}},
          {mount, spring, coupling}};
}

}  // namespace

BOOST_AUTO_TEST_SUITE(a_system_of_bodies)

BOOST_AUTO_TEST_CASE(computes_without_allocations) {
  const auto system = chain(24);
  BodyWorkspace w = system.workspace();
  Eigen::VectorXd y(system.tree().coordinates() + system.tree().rates());
  for (int i = 0; i < y.size(); ++i) y[i] = std::sin(i + 1.0);
  Eigen::VectorXd rates, dv, force;
  Eigen::MatrixXd mass;
  JointReactions reactions;
  std::vector<ReactionParts> parts;
  std::vector<Motor<>> forces;
  const auto everything = [&] {
    system.rates(0.1, y, rates, w);
    system.accelerations(0.1, y, {}, dv, w);
    system.joint_forces(0.1, y, dv, force, w);
    system.mass_matrix(y, mass, w);
    system.reactions(0.1, y, reactions, w);
    system.reaction_parts(0.1, y, parts, w);
    system.element_forces(0.1, y, forces, w);
    (void)system.situation(0.1, y, 3, w);
    (void)system.terms(0.1, y, 5, w);
    (void)system.balance(0.1, y, w);
  };
  std::size_t before = requests;
  everything();
  BOOST_TEST(requests > before);  // the results get their size: the counter counts
  before = requests;
  everything();
  BOOST_TEST(requests == before);
}

BOOST_AUTO_TEST_CASE(needs_memory_in_proportion_to_its_bodies) {
  const auto workspace_bytes = [](int n) {
    const auto system = chain(n);
    const std::size_t before = bytes;
    const BodyWorkspace w = system.workspace();
    return static_cast<double>(bytes - before);
  };
  const double one = (workspace_bytes(66) - workspace_bytes(6)) / 60;
  BOOST_TEST_MESSAGE("workspace: " << one << " bytes for each body");
  BOOST_TEST(std::abs(workspace_bytes(1206) - workspace_bytes(6) - 1200 * one) <=
             0.01 * 1200 * one);
}

// A step allocates nothing; the returned State has two vectors.
BOOST_AUTO_TEST_CASE(is_integrated_without_allocations_in_steps) {
  const auto system = chain(6);
  Integrator run(system, 0, system.rest(), {.relative = 1e-10});
  const auto requests_to = [&run](double t) {
    const std::size_t before = requests;
    const auto state = run.to(t);
    return requests - before;
  };
  (void)requests_to(1e-3);
  const double steps = run.effort().steps;
  double t = 1e-3;
  while (run.effort().steps < steps + 100) BOOST_TEST(requests_to(t += 0.2) == 2U);
  BOOST_TEST(run.effort().evaluations > 1600);
}

BOOST_AUTO_TEST_CASE(gives_output_without_allocations) {
  const auto system = chain(6);
  BodyWorkspace w = system.workspace();
  const auto field = [&](double t, const Eigen::VectorXd& y, Eigen::VectorXd& rate) {
    system.rates(t, y, rate, w);
  };
  ExplicitRungeKutta steps(field, 0.0, system.to_vector(system.rest()), {.relative = 1e-10},
                           system.blocks());
  steps.step_towards(1);
  Eigen::VectorXd y = steps.y();
  const std::size_t before = requests;
  for (int i = 0; i < 10; ++i) {
    const double from = steps.t();
    steps.step_towards(1);
    const double length = steps.t() - from;
    for (int k = 0; k <= 4; ++k) steps.at(from + length * k / 4, y);
    steps.back_to(from + 0.7 * length);
  }
  BOOST_TEST(requests == before);
}

BOOST_AUTO_TEST_SUITE_END()
