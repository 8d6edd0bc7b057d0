// Joints whose motion is prescribed, against closed forms and against guides with the same motion.

#include <boost/test/unit_test.hpp>

#include <cmath>
#include <string>
#include <vector>

#include <dynamics/guide/resting.hpp>
#include <dynamics/guide/signal_frame.hpp>
#include <dynamics/solve/solve.hpp>
#include <dynamics/tree/body_system.hpp>
#include <motor/error.hpp>

using namespace kreisel;

namespace {

using Resting = BodySystem<RestingFrame<>>;

constexpr double amplitude = 0.2;
constexpr double frequency = 7;
constexpr double phase = 0.3;
const Signal<double> oscillation(0.1, 0, {{amplitude, frequency, phase}});

BodyDescription body(const std::string& name, const std::string& parent, const Joint& joint) {
  BodyDescription b;
  b.name = name;
  b.parent = parent;
  b.joint = joint;
  b.inertia = InertiaTensor<Body>::about_centre(
      2, {0.1, 0.2, -0.5}, Vector3<double>(0.2, 0.25, 0.3).asDiagonal().toDenseMatrix());
  return b;
}

/// Prescribes the coordinate of a joint.
void drive(BodyDescription& b, const Signal<double>& motion) {
  b.rule = JointRule::driven;
  b.acceleration = [motion](double t) { return motion.derivative(t, 2); };
}

/// A body on a base whose joint follows the oscillation, under gravity.
std::vector<BodyDescription> on_a_base(JointKind kind) {
  BodyDescription base = body("base", "guide", {.kind = kind, .axis = {0, 0.6, 0.8}, .pitch = 0.4});
  drive(base, oscillation);
  return {base, body("rod", "base",
                     {.kind = JointKind::revolute, .axis = {0, 1, 0}, .position = {0.3, 0, 0.1}})};
}

/// The start of such a system, at the oscillation's own values.
Resting::State start_of(const Resting& system) {
  Resting::State start = system.rest();
  start.coordinates[0] = oscillation(0.0);
  start.rates[0] = oscillation.derivative(0, 1);
  start.coordinates[1] = 0.7;
  start.rates[1] = -0.4;
  return start;
}

constexpr JointKind kinds[] = {JointKind::revolute, JointKind::prismatic, JointKind::screw};

}  // namespace

BOOST_AUTO_TEST_SUITE(drives)

// The guide makes the motion of the base; what is left is the rod.
BOOST_AUTO_TEST_CASE(a_driven_slide_is_a_moving_guide) {
  const UniformGravity<Inertial> gravity{{0, 0, -9.81}};
  const Resting driven(RestingFrame<>{}, on_a_base(JointKind::prismatic), gravity);
  const Vector3<double> axis(0, 0.6, 0.8);
  const SignalFrame<> guide(
      PoseSignals{.position = Signal<Vector3<double>>(0.1 * axis, Vector3<double>::Zero(),
                                                      {{amplitude * axis, frequency, phase}})});
  const BodySystem carried(
      guide,
      {body("rod", "guide",
            {.kind = JointKind::revolute, .axis = {0, 1, 0}, .position = {0.3, 0, 0.1}})},
      gravity);
  const SolveOptions options{.output_times = {1, 3}, .tolerance = 1e-12};
  const auto a = solve(driven, start_of(driven), options);
  auto start = carried.rest();
  start.coordinates[0] = 0.7;
  start.rates[0] = -0.4;
  const auto b = solve(carried, start, options);
  for (std::size_t i = 0; i < 2; ++i) {
    BOOST_TEST(std::abs(a.states[i].coordinates[1] - b.states[i].coordinates[0]) <= 4e-12);
    BOOST_TEST(std::abs(a.states[i].rates[1] - b.states[i].rates[0]) <= 4e-11);
  }
}

BOOST_AUTO_TEST_CASE(coordinates_follow_the_motion) {
  for (const JointKind kind : kinds) {
    const Resting system(RestingFrame<>{}, on_a_base(kind), UniformGravity<Guide>{{0, 0, -9.81}});
    const auto run = solve(system, start_of(system), {.output_times = {2, 5}, .tolerance = 1e-12});
    for (std::size_t i = 0; i < 2; ++i) {
      const double t = run.times[i];
      BOOST_TEST(std::abs(run.states[i].coordinates[0] - oscillation(t)) <= 1e-12);
      BOOST_TEST(std::abs(run.states[i].rates[0] - oscillation.derivative(t, 1)) <= 1e-11);
    }
  }
}

// A wheel about its own axis takes I phi''; a slide m x'' and its weight.
BOOST_AUTO_TEST_CASE(forces_of_single_drives) {
  const double t = 0.4;
  const double acceleration = oscillation.derivative(t, 2);
  BodyDescription wheel = body("wheel", "guide", {.kind = JointKind::revolute, .axis = {0, 0, 1}});
  wheel.inertia = InertiaTensor<Body>::about_centre(
      2, {0, 0, 0}, Vector3<double>(0.2, 0.2, 0.3).asDiagonal().toDenseMatrix());
  drive(wheel, oscillation);
  BodyDescription slide = wheel;
  slide.name = "slide";
  slide.joint.kind = JointKind::prismatic;
  const Resting system(RestingFrame<>{}, {wheel, slide}, UniformGravity<Guide>{{0, 0, -9.81}});
  BodyWorkspace w = system.workspace();
  JointReactions reactions;
  system.reactions(t, Resting::to_vector(system.rest()), reactions, w);
  BOOST_TEST(std::abs(reactions.drive[0] - 0.3 * acceleration) <= 1e-14);
  BOOST_TEST(std::abs(reactions.drive[1] - 2 * (acceleration + 9.81)) <= 1e-14);
}

// Inverse dynamics with the accelerations found needs the drive's force and no other.
BOOST_AUTO_TEST_CASE(inverse_dynamics_agrees) {
  for (const JointKind kind : kinds) {
    const Resting system(RestingFrame<>{}, on_a_base(kind), UniformGravity<Guide>{{0, 0, -9.81}});
    const Eigen::VectorXd y = Resting::to_vector(start_of(system));
    const Eigen::VectorXd dv = system.rates(0.4, y).tail(2);
    BOOST_TEST(dv[0] == oscillation.derivative(0.4, 2));
    BodyWorkspace w = system.workspace();
    Eigen::VectorXd needed;
    system.joint_forces(0.4, y, dv, needed, w);
    JointReactions reactions;
    system.reactions(0.4, y, reactions, w);
    BOOST_TEST(std::abs(needed[0] - reactions.drive[0]) <= 1e-13 * std::abs(needed[0]));
    BOOST_TEST(std::abs(needed[1]) <= 1e-13 * std::abs(needed[0]));
  }
}

// The parts by cause sum to the whole; the prescribed acceleration belongs to the spin.
BOOST_AUTO_TEST_CASE(parts_of_reactions_sum_up) {
  const Resting system(RestingFrame<>{}, on_a_base(JointKind::revolute),
                       UniformGravity<Guide>{{0, 0, -9.81}});
  const Eigen::VectorXd y = Resting::to_vector(start_of(system));
  BodyWorkspace w = system.workspace();
  JointReactions whole;
  system.reactions(0.4, y, whole, w);
  std::vector<ReactionParts> parts;
  system.reaction_parts(0.4, y, parts, w);
  for (std::size_t i = 0; i < 2; ++i) {
    const Motor<> off = parts[i].total().value - whole.on_body[i].value;
    BOOST_TEST(off.resultant.norm() <= 1e-13 * whole.on_body[i].value.resultant.norm());
    BOOST_TEST(off.moment.norm() <= 1e-13 * whole.on_body[i].value.moment.norm());
  }
}

BOOST_AUTO_TEST_CASE(accelerations_need_a_drive) {
  BodyDescription loose = body("a", "guide", {.kind = JointKind::revolute, .axis = {0, 0, 1}});
  loose.acceleration = [](double) { return 1.0; };
  BOOST_CHECK_EXCEPTION(BodyTree({loose}), InvalidInput, [](const InvalidInput& error) {
    return std::string(error.what()).find("an acceleration is given, but no drive") !=
           std::string::npos;
  });
  BodyDescription ball = body("a", "guide", {.kind = JointKind::spherical});
  ball.rule = JointRule::driven;
  BOOST_CHECK_THROW(BodyTree({ball}), InvalidInput);
}

BOOST_AUTO_TEST_SUITE_END()
