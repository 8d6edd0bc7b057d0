// Forces of controllers at joints of all kinds and on bodies, against constant loads and joint
// forces of the bodies' own description.

#include <boost/test/unit_test.hpp>

#include <string>
#include <utility>
#include <vector>

#include <dynamics/control/controlled_system.hpp>
#include <dynamics/guide/rotating.hpp>
#include <dynamics/study/linearize.hpp>

using namespace kreisel;

namespace {

using Guided = RotatingFrame<>;

const Guided turntable{Vector3<double>(0.1, -0.2, 0.3), Vector3<double>(0.5, 0.2, 9.8)};

BodyDescription body(const std::string& name, const std::string& parent, JointKind kind) {
  BodyDescription result;
  result.name = name;
  result.parent = parent;
  result.joint = {.kind = kind, .axis = {0, 0, 1}};
  result.joint.position = {0.1, 0.4, -0.3};
  const Matrix3<double> tensor = Vector3<double>(0.5, 0.6, 0.8).asDiagonal();
  result.inertia = InertiaTensor<Body>::about_centre(1.3, {0.1, 0.3, 0.2}, tensor);
  return result;
}

/// A ball joint, a hinge on it, and a slide on that.
std::vector<BodyDescription> chain() {
  return {body("ball", "guide", JointKind::spherical), body("arm", "ball", JointKind::revolute),
          body("slide", "arm", JointKind::prismatic)};
}

/// A controller whose outputs are constant: the states of its law are the outputs.
Controller constant(std::vector<std::string> drives, const std::vector<double>& outputs) {
  const auto n = static_cast<Eigen::Index>(outputs.size());
  Controller result;
  result.name = "thrusters";
  result.reads = {{JointSensor{1, 0, false}}};
  result.drives = std::move(drives);
  result.law = StateSpaceLaw{Eigen::MatrixXd::Zero(n, n), Eigen::MatrixXd::Zero(n, 1),
                             Eigen::MatrixXd::Identity(n, n), Eigen::MatrixXd::Zero(n, 1),
                             Eigen::Map<const Eigen::VectorXd>(outputs.data(), n)};
  return result;
}

/// Coordinates and rates of the chain.
Eigen::VectorXd state() {
  Eigen::VectorXd y(11);
  y << 0.5, -0.1, 0.3, std::sqrt(1 - 0.35), 0.4, -0.2, 0.2, -0.3, 0.5, 0.8, 0.6;
  return y;
}

Eigen::VectorXd with_memory(const ControlledSystem<Guided>& system) {
  Eigen::VectorXd y(11 + system.memory());
  y << state(), system.loops().front().initial();
  return y;
}

double greatest(const Eigen::VectorXd& v) { return v.cwiseAbs().maxCoeff(); }

}  // namespace

BOOST_AUTO_TEST_SUITE(actuators_of_controllers)

BOOST_AUTO_TEST_CASE(loads_act_as_loads_of_the_body) {
  const Vector3<double> force(3, -2, 0.7);
  const Vector3<double> torque(0.4, 1.1, -0.6);
  std::vector<BodyDescription> loaded = chain();
  loaded[1].loads = {ConstantLoad<Body>{force, torque, Vector3<double>::Zero()}};
  const BodySystem<Guided> expected(turntable, loaded);
  const ControlledSystem<Guided> system(
      BodySystem<Guided>(turntable, chain()),
      {constant({"load.arm.force.x", "load.arm.force.y", "load.arm.force.z", "load.arm.torque.x",
                 "load.arm.torque.y", "load.arm.torque.z"},
                {force[0], force[1], force[2], torque[0], torque[1], torque[2]})});
  const Eigen::VectorXd y = with_memory(system);
  // Sums of ten terms of size 10.
  constexpr double rounding = 1e-13;
  BOOST_TEST(greatest(system.rates(0.2, y).head(11) - expected.rates(0.2, state())) < rounding);

  auto w = system.workspace();
  auto v = expected.workspace();
  JointReactions found;
  JointReactions wanted;
  system.reactions(0.2, y, found, w);
  expected.reactions(0.2, state(), wanted, v);
  for (std::size_t i = 0; i < 3; ++i) {
    const Motor<> difference = found.on_body[i].value - wanted.on_body[i].value;
    BOOST_TEST(difference.resultant.norm() < 10 * rounding);
    BOOST_TEST(difference.moment.norm() < 10 * rounding);
  }
}

BOOST_AUTO_TEST_CASE(a_name_stands_for_all_rates) {
  std::vector<BodyDescription> pushed = chain();
  pushed[1].forces = {{.constant = 0.9}};
  pushed[2].forces = {{.constant = -4}};
  const BodySystem<Guided> expected(turntable, pushed);
  const ControlledSystem<Guided> system(
      BodySystem<Guided>(turntable, chain()),
      {constant({"ball", "joint.arm", "slide"}, {0, 0, 0, 0.9, -4})});
  const Eigen::VectorXd y = with_memory(system);
  BOOST_TEST(greatest(system.rates(0.2, y).head(11) - expected.rates(0.2, state())) < 1e-13);
  const std::vector<std::string> names{"thrusters state 1", "thrusters state 2",
                                       "thrusters state 3", "thrusters state 4",
                                       "thrusters state 5"};
  BOOST_TEST(system.memory_names() == names, boost::test_tools::per_element());

  // A torque on the carrier about one of its axes is one on the ball joint.
  const ControlledSystem<Guided> by_joint(BodySystem<Guided>(turntable, chain()),
                                          {constant({"joint.ball.2"}, {1.7})});
  const ControlledSystem<Guided> by_load(BodySystem<Guided>(turntable, chain()),
                                         {constant({"load.ball.torque.y"}, {1.7})});
  const Eigen::VectorXd rates = by_joint.rates(0.2, with_memory(by_joint));
  BOOST_TEST(greatest(rates - by_load.rates(0.2, with_memory(by_load))) < 1e-13);
}

// Differences of fourth order err by h^4 and by 1e-16/h.
BOOST_AUTO_TEST_CASE(dual_numbers_follow_loads) {
  Controller thrusters = constant({"load.slide.force.y", "load.ball.torque.z"}, {3, -2});
  auto& law = std::get<StateSpaceLaw>(thrusters.law);
  law.D = Eigen::Vector2d(5, 0.4);
  const ControlledSystem<Guided> system(BodySystem<Guided>(turntable, chain()), {thrusters});
  const Eigen::VectorXd y = with_memory(system);
  const auto n = y.size();
  const auto d = detail::derivatives(system, 0.2, y, Eigen::MatrixXd::Identity(n, n));
  constexpr double h = 1e-4;
  for (Eigen::Index k = 0; k < n; ++k) {
    const auto at = [&](double step) {
      Eigen::VectorXd moved = y;
      moved[k] += step;
      return system.rates(0.2, moved);
    };
    const Eigen::VectorXd slope = (8 * (at(h) - at(-h)) - (at(2 * h) - at(-2 * h))) / (12 * h);
    BOOST_TEST(greatest(slope - d.along.col(k)) < 1e-10);
  }
}

BOOST_AUTO_TEST_CASE(forces_that_are_not_free_are_refused) {
  std::vector<BodyDescription> bodies = chain();
  bodies.push_back(body("plate", "arm", JointKind::fixed));
  bodies[1].rule = JointRule::held;
  const auto refusal = [&bodies](const std::vector<std::string>& drives) -> std::string {
    try {
      const BodyTree tree(bodies);
      (void)actuators({.name = "servo", .drives = drives}, tree);
      return "";
    } catch (const InvalidInput& error) {
      return error.what();
    }
  };
  BOOST_TEST(refusal({"arm"}) ==
             "controller 'servo': it drives the joint of 'arm', whose motion is prescribed");
  BOOST_TEST(refusal({"plate"}) ==
             "controller 'servo': it drives the joint of 'plate', which is fixed");
  BOOST_TEST(refusal({"ball", "joint.ball.2"}) ==
             "controller 'servo': it drives 'joint.ball.2' twice");
  BOOST_TEST(refusal({"joint.ball.4"}) ==
             "controller 'servo': it drives 'joint.ball.4', but there is no such body, joint, load "
             "or rope");
  BOOST_TEST(refusal({"load.arm.torque.x"}).empty());
}

BOOST_AUTO_TEST_SUITE_END()
