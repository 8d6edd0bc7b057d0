// Constraints between bodies: joints that close a loop against joints of a tree, closed forms.

#include <Eigen/Geometry>
#include <boost/test/data/monomorphic.hpp>
#include <boost/test/data/test_case.hpp>
#include <boost/test/unit_test.hpp>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <dynamics/guide/resting.hpp>
#include <dynamics/guide/rotating.hpp>
#include <dynamics/sensor/kinematics.hpp>
#include <dynamics/solve/output_times.hpp>
#include <dynamics/solve/solve.hpp>
#include <dynamics/tree/body_system.hpp>

#include <support/random_tree.hpp>
#include <support/sample.hpp>

using namespace kreisel;
using test::Sample;
namespace data = boost::unit_test::data;

namespace {

const RotatingFrame<> turntable{{0.3, -0.8, 0.5}, {1, 2, 3}};
const UniformGravity<Guide> weight{{1, 2, -9}};

/// A carrier in a random hinge on the guide, and a body in a random joint of this kind on it.
std::vector<BodyDescription> as_tree(JointKind kind, Sample& sample) {
  BodyDescription carrier;
  carrier.name = "carrier";
  carrier.joint = test::random_joint(sample, JointKind::revolute);
  carrier.inertia = test::random_inertia(sample);
  BodyDescription body;
  body.name = "body";
  body.parent = "carrier";
  body.joint = test::random_joint(sample, kind);
  body.joint.second_axis = body.joint.axis.cross(sample.direction());
  body.inertia = test::random_inertia(sample);
  return {carrier, body};
}

/// The constraint that is this joint.
Constraint as_constraint(const Joint& joint) {
  const constraint::Point centre{joint.position, {0, 0, 0}};
  const auto on_body = [&](const Vector3<double>& axis) -> Vector3<double> {
    return joint.orientation.conjugate() * axis;
  };
  Constraint result{"joint", "carrier", "body"};
  switch (joint.kind) {
    case JointKind::spherical: result.kind = centre; break;
    case JointKind::revolute:
      result.kind = constraint::Revolute{centre, joint.axis, on_body(joint.axis)};
      break;
    case JointKind::universal:
      result.kind = constraint::Universal{centre, joint.axis, on_body(joint.second_axis)};
      break;
    case JointKind::prismatic:
      result.kind = constraint::Prismatic{centre, joint.axis, joint.orientation};
      break;
    default: result.kind = constraint::Fixed{centre, joint.orientation};
  }
  return result;
}

/// The same bodies with the second one free, and its state in the motion of the first system.
struct Loose {
  BodySystem<RotatingFrame<>> system;
  Eigen::VectorXd y;
};

Loose loosened(std::vector<BodyDescription> bodies, const Eigen::VectorXd& y,
               const BodyKinematics& body) {
  const Constraint joint = as_constraint(bodies[1].joint);
  bodies[1].parent = "guide";
  bodies[1].joint = {.kind = JointKind::free};
  BodySystem system(turntable, bodies, weight, {}, {joint});
  auto state = system.rest();
  const Eigen::Quaterniond q(body.R);
  state.coordinates[0] = y[0];
  state.coordinates.segment<4>(1) = q.coeffs();
  state.coordinates.segment<3>(5) = body.x;
  return {system, system.to_vector(state)};
}

}  // namespace

BOOST_AUTO_TEST_SUITE(constraints)

// Every joint as a joint of the tree, and as a constraint on a free body: the same accelerations
// and the same reactions.
BOOST_DATA_TEST_CASE(agree_with_joints, data::xrange(100), seed) {
  constexpr JointKind kinds[] = {JointKind::spherical, JointKind::revolute, JointKind::universal,
                                 JointKind::prismatic, JointKind::fixed};
  const JointKind kind = kinds[seed % 5];
  Sample sample(static_cast<std::uint64_t>(seed));
  const auto bodies = as_tree(kind, sample);
  const BodySystem tree(turntable, bodies, weight);
  Eigen::VectorXd y = tree.to_vector(tree.rest());
  for (double& x : y) x += sample.uniform(-1, 1);
  if (kind == JointKind::spherical) y.segment<4>(1).normalize();
  auto w = tree.workspace();
  const SystemKinematics wanted = kinematics(tree, 0, y, w);
  Loose loose = loosened(bodies, y, wanted.body(1));
  const Eigen::Index rates = loose.system.tree().coordinates();
  loose.y[rates] = y[tree.tree().coordinates()];
  loose.y.segment<3>(rates + 1) = wanted.body(1).R.transpose() * wanted.body(1).w;
  loose.y.segment<3>(rates + 4) = wanted.body(1).v;

  for (const ConstraintGap& gap : loose.system.constraint_gaps(loose.system.from_vector(loose.y))) {
    BOOST_TEST(gap.position <= 1e-14);
    BOOST_TEST(gap.rate <= 1e-13);
  }
  auto own = loose.system.workspace();
  const SystemKinematics found = kinematics(loose.system, 0, loose.y, own);
  for (int i = 0; i < 2; ++i) {
    const double size = wanted.body(i).dw.norm() + wanted.body(i).a.norm() + 1;
    BOOST_TEST((found.body(i).dw - wanted.body(i).dw).norm() <= 1e-12 * size);
    BOOST_TEST((found.body(i).a - wanted.body(i).a).norm() <= 1e-12 * size);
  }
  const Motor<>& by_tree = wanted.reactions.on_body[1].value;
  const Motor<> held = loose.system.constraint_reactions(0, loose.y, own).at(0).on_second;
  const Matrix3<double> turn = wanted.body(1).R.transpose() * wanted.body(0).R;
  const double size = by_tree.resultant.norm() + by_tree.moment.norm() + 1;
  BOOST_TEST((turn * held.resultant - by_tree.resultant).norm() <= 1e-12 * size);
  BOOST_TEST((turn * held.moment - by_tree.moment).norm() <= 1e-12 * size);
  const Motor<> of_carrier = wanted.reactions.on_body[0].value - found.reactions.on_body[0].value;
  BOOST_TEST(of_carrier.resultant.norm() + of_carrier.moment.norm() <= 1e-11 * size);
  std::vector<ReactionParts> parts;
  loose.system.reaction_parts(0, loose.y, parts, own);
  const Motor<> sum = parts[0].guide.value + parts[0].spin.value + parts[0].gravity.value +
                      parts[0].forces.value - found.reactions.on_body[0].value;
  BOOST_TEST(sum.resultant.norm() + sum.moment.norm() <= 1e-11 * size);
}

namespace {

BodyDescription ball_at(const Vector3<double>& moments, double mass = 1) {
  BodyDescription body;
  body.name = "body";
  body.joint = {.kind = JointKind::free};
  body.inertia = InertiaTensor<Body>::about_centre(mass, {0, 0, 0}, moments.asDiagonal());
  return body;
}

SolveOptions until(double t, int outputs = 20, double tolerance = 1e-11) {
  return {.output_times = linspace(0, t, static_cast<std::size_t>(outputs + 1)),
          .tolerance = tolerance};
}

}  // namespace

// A ball on a turntable circles at 2/7 of its rate: k = I/(m r^2) = 2/5, k/(1 + k) = 2/7.
BOOST_AUTO_TEST_CASE(ball_on_a_turntable) {
  const double rate = 1.4, radius = 0.1, r = 0.5;
  const auto body = ball_at(0.4 * radius * radius * Vector3<double>::Ones());
  const BodySystem system(RotatingFrame<>{{0, 0, rate}}, {body},
                          UniformGravity<Guide>{{0, 0, -9.81}}, {},
                          {{"contact", "guide", "body", constraint::Rolling{.radius = radius}}});
  // Seen inertially the centre circles about a point at rest. At the start it is at x = r with a
  // velocity v along y; the circle's radius is v/(2/7 rate).
  auto start = system.rest();
  start.coordinates.segment<3>(4) = Vector3<double>(r, 0, radius);
  const double v = 0.3;
  // Relative to the table: v - rate r along y. Rolling: w x (0, 0, -radius) = -v_rel.
  start.rates[4] = v - rate * r;
  start.rates[0] = -(v - rate * r) / radius;
  const auto run = solve(system, start, until(20));
  BOOST_TEST(run.report.tolerance_kept);
  const double turn = 2.0 / 7 * rate;
  const double circle = v / turn;
  for (std::size_t i = 0; i < run.times.size(); ++i) {
    const double t = run.times[i];
    const auto& q = run.states[i].coordinates;
    const Eigen::Rotation2Dd table(rate * t);
    const Eigen::Vector2d found = table * Eigen::Vector2d(q[4], q[5]);
    const Eigen::Vector2d wanted(r - circle + circle * std::cos(turn * t),
                                 circle * std::sin(turn * t));
    BOOST_TEST((found - wanted).norm() <= 1e-9);
    BOOST_TEST(std::abs(q[6] - radius) <= 1e-15);
  }
}

// A point mass on a rod without mass swings as a pendulum: (omega/omega_0)^2 in closed form for the
// rate at the bottom, and the pull m (g + v^2/l) there.
BOOST_AUTO_TEST_CASE(distance_makes_a_pendulum) {
  const double l = 2, g = 9.81, m = 3;
  const BodySystem system(
      RestingFrame<>{}, {ball_at(Vector3<double>::Constant(1e-3), m)},
      UniformGravity<Guide>{{0, 0, -g}}, {},
      {{"rod", "guide", "body", constraint::Distance{{{0, 0, 0}, {0, 0, 0}}, l}}});
  auto start = system.rest();
  start.coordinates.segment<3>(4) = Vector3<double>(l, 0, 0);
  // A quarter of the period from rest at 90 degrees: sqrt(l/g) K(1/2).
  const double quarter = std::sqrt(l / g) * 1.8540746773013719184;
  const auto run = solve(system, start, until(quarter, 4));
  const auto& end = run.states.back();
  BOOST_TEST((end.coordinates.segment<3>(4) - Vector3<double>(0, 0, -l)).norm() <= 1e-9);
  const double speed = std::sqrt(2 * g * l);
  BOOST_TEST(std::abs(end.rates[3] + speed) <= 1e-9);
  auto w = system.workspace();
  const auto reaction =
      system.constraint_reactions(quarter, system.to_vector(end), w).at(0).on_second;
  BOOST_TEST(std::abs(reaction.resultant.z() - m * (g + speed * speed / l)) <= 1e-8);
  BOOST_TEST(run.report.invariants.at(0).name == "energy");
  BOOST_TEST(run.report.invariants.at(0).largest <= 1e-10);
}

// Two wheels joined by a gear: one torque turns both, dw = M/(I_1 + I_2/ratio^2).
BOOST_AUTO_TEST_CASE(gear_of_two_wheels) {
  BodyDescription first = ball_at({1, 1, 2});
  first.name = "first";
  first.joint = {.kind = JointKind::revolute, .axis = {0, 0, 1}};
  first.forces = {{.constant = 5}};
  BodyDescription second = ball_at({1, 1, 1});
  second.name = "second";
  second.joint = {.kind = JointKind::revolute, .axis = {1, 0, 0}};
  const BodySystem system(RestingFrame<>{}, {first, second}, {}, {},
                          {{"gear", "first", "second", constraint::Gear{-0.5, 0.25}}});
  auto start = system.rest();
  start.coordinates[0] = 0.25;
  const auto run = solve(system, start, until(2));
  const double dw = 5 / (2 + 1 / 0.25);
  const auto& end = run.states.back();
  BOOST_TEST(std::abs(end.rates[0] - 2 * dw) <= 1e-10);
  BOOST_TEST(std::abs(end.coordinates[0] - (-0.5 * end.coordinates[1] + 0.25)) <= 1e-15);
  auto w = system.workspace();
  const auto on_second = system.constraint_reactions(0, system.to_vector(start), w).at(0);
  BOOST_TEST(std::abs(on_second.on_second.moment.norm() - dw / 0.5) <= 1e-12);
}

// A disc that rolls down a plane of angle alpha: a = g sin(alpha)/(1 + I/(m r^2)) = 2/3 g sin(alpha).
BOOST_AUTO_TEST_CASE(disc_rolls_down) {
  const double r = 0.3, alpha = 0.4, g = 9.81;
  const Vector3<double> normal(std::sin(alpha), 0, std::cos(alpha));
  const auto disc = ball_at({0.25 * r * r, 0.5 * r * r, 0.25 * r * r});
  const BodySystem system(
      RestingFrame<>{}, {disc}, UniformGravity<Guide>{{0, 0, -g}}, {},
      {{"contact", "guide", "body",
        constraint::Rolling{.radius = r, .axis = Vector3<double>(0, 1, 0), .normal = normal}}});
  auto start = system.rest();
  start.coordinates.segment<3>(4) = r * normal;
  const auto run = solve(system, start, until(1));
  const Vector3<double> way = run.states.back().coordinates.segment<3>(4) - r * normal;
  const double wanted = g * std::sin(alpha) / 3;
  BOOST_TEST(std::abs(way.dot(Vector3<double>(std::cos(alpha), 0, -std::sin(alpha))) - wanted) <=
             1e-10);
  auto w = system.workspace();
  const auto held = system.constraint_reactions(0, system.to_vector(start), w).at(0);
  BOOST_TEST(std::abs(held.on_second.resultant.dot(normal) - g * std::cos(alpha)) <= 1e-12);
  BOOST_TEST(held.on_second.moment.norm() <= 1e-12);
}

// Chaplygin's sleigh with its blade at the centre of mass moves on a circle at constant speed.
BOOST_AUTO_TEST_CASE(sleigh_on_a_circle) {
  auto sleigh = ball_at({1, 1, 0.5});
  sleigh.joint = {.kind = JointKind::planar, .axis = {0, 0, 1}};
  const BodySystem system(RestingFrame<>{}, {sleigh}, {}, {},
                          {{"blade", "guide", "body", constraint::Blade{}}});
  auto start = system.rest();
  start.rates = Vector3<double>(1.5, 0, 0.8);
  const auto run = solve(system, start, until(5));
  const auto& q = run.states.back().coordinates;
  const double turn = 0.8 * 5;
  const double radius = 1.5 / 0.8;
  BOOST_TEST(std::abs(q[0] - radius * std::sin(turn)) <= 1e-9);
  BOOST_TEST(std::abs(q[1] - radius * (1 - std::cos(turn))) <= 1e-9);
  BOOST_TEST(std::abs(q[2] - turn) <= 1e-9);
}

namespace {

/// A parallelogram of two cranks and a rod, closed by a hinge in space: 2 of its 5 conditions are
/// enough in the plane.
BodySystem<RestingFrame<>> parallelogram() {
  const auto crank = [](const std::string& name, const Vector3<double>& at) {
    BodyDescription body;
    body.name = name;
    body.joint = {.kind = JointKind::revolute, .axis = {0, 1, 0}, .position = at};
    body.inertia =
        InertiaTensor<Body>::about_centre(1, {0, 0, -0.5}, Matrix3<double>::Identity() / 12);
    return body;
  };
  BodyDescription rod = crank("rod", {0, 0, -1});
  rod.parent = "left";
  rod.inertia = InertiaTensor<Body>::about_centre(2, {1, 0, 0}, Matrix3<double>::Identity() / 3);
  return {RestingFrame<>{},
          {crank("left", {0, 0, 0}), crank("right", {2, 0, 0}), rod},
          UniformGravity<Guide>{{0, 0, -9.81}},
          {},
          {{"loop", "right", "rod",
            constraint::Revolute{{{0, 0, -1}, {2, 0, 0}}, {0, 1, 0}, {0, 1, 0}}}}};
}

}  // namespace

// The rod only translates, so that the whole is a pendulum: theta (2 I + m_rod l^2) = -(2 m l/2 +
// m_rod l) g sin(angle), with I = 1/12 + 1/4.
BOOST_AUTO_TEST_CASE(parallelogram_is_a_pendulum) {
  const auto system = parallelogram();
  const double angle = 0.9;
  auto start = system.rest();
  start.coordinates = Vector3<double>(angle, angle, -angle);
  const auto redundant = system.redundant_constraints(start);
  BOOST_TEST_REQUIRE(redundant.size() == 1U);
  BOOST_TEST(redundant[0].redundant == 3);
  BOOST_TEST(redundant[0].conditions == 5);

  BodyDescription pendulum;
  pendulum.name = "pendulum";
  pendulum.joint = {.kind = JointKind::revolute, .axis = {0, 1, 0}};
  const double theta = 2 * (1.0 / 12 + 0.25) + 2;
  pendulum.inertia = InertiaTensor<Body>::about_centre(
      4, {0, 0, -0.75}, Vector3<double>(5, theta - 4 * 0.75 * 0.75, 5).asDiagonal());
  const BodySystem alone(RestingFrame<>{}, {pendulum}, UniformGravity<Guide>{{0, 0, -9.81}});
  auto swing = alone.rest();
  swing.coordinates[0] = angle;
  const auto wanted = solve(alone, swing, until(10));
  for (const Method method : {Method::automatic, Method::radau13, Method::gauss16}) {
    SolveOptions options = until(10);
    options.method = method;
    const auto run = solve(system, start, options);
    BOOST_TEST(run.report.tolerance_kept);
    for (std::size_t i = 0; i < run.times.size(); ++i) {
      const auto& q = run.states[i].coordinates;
      BOOST_TEST(std::abs(q[0] - wanted.states[i].coordinates[0]) <= 2e-10);
      for (const ConstraintGap& gap : system.constraint_gaps(run.states[i])) {
        BOOST_TEST(gap.relative <= 1e-14);
        BOOST_TEST(gap.rate <= 1e-13);
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(assembly_finds_the_nearest_state) {
  const auto system = parallelogram();
  auto off = system.rest();
  off.coordinates = Vector3<double>(0.5, 0.53, -0.48);
  off.rates = Vector3<double>(1, 1.1, -0.9);
  const auto found = system.assembled(off);
  for (const ConstraintGap& gap : system.constraint_gaps(found)) {
    BOOST_TEST(gap.relative <= 1e-14);
    BOOST_TEST(gap.rate <= 1e-14);
  }
  BOOST_TEST((found.coordinates - off.coordinates).norm() <= 0.05);
  BOOST_TEST((found.rates - off.rates).norm() <= 0.2);
}

BOOST_AUTO_TEST_CASE(wrong_ones_are_refused) {
  const auto body = ball_at(Vector3<double>::Ones());
  const auto told = [&](const Constraint& constraint) -> std::string {
    try {
      (void)BodySystem(RestingFrame<>{}, {body}, {}, {}, {constraint});
    } catch (const InvalidInput& error) {
      return error.what();
    }
    return "";
  };
  const auto has = [](const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
  };
  BOOST_TEST(has(told({"c", "body", "body"}), "joins a body to itself"));
  BOOST_TEST(has(told({"c", "guide", "wheel"}), "'wheel' does not exist"));
  BOOST_TEST(has(told({"c", "guide", "body", constraint::Distance{}}), "is not positive"));
  BOOST_TEST(has(told({"c", "guide", "body",
                       constraint::Blade{Vector3<double>(1, 0, 0), Vector3<double>(0, 0, 0)}}),
                 "is 0"));
  BOOST_TEST(has(told({"c", "guide", "body", constraint::Blade{Vector3<double>(NAN, 0, 0)}}),
                 "not finite"));
  BOOST_TEST(has(told({"c", "guide", "body", constraint::Gear{}}), "'guide' does not exist"));
}

// Two cranks and a rod of 1 m and 1 kg lie on a line once in half a turn. The rod could begin to turn
// there. As a parallelogram they are a pendulum with the inertia 5/3 and the first moment 2.
BOOST_DATA_TEST_CASE(four_bar_passes_its_singular_position, data::make({0.5, 1.0, 2.0, 3.7}),
                     speed) {
  const auto rod = [](const std::string& name, const std::string& parent,
                      const Vector3<double>& position, const Vector3<double>& centre) {
    BodyDescription body;
    body.name = name;
    body.parent = parent;
    body.joint = {.kind = JointKind::revolute, .axis = {0, 1, 0}, .position = position};
    const Matrix3<double> tensor = Eigen::Vector3d::Constant(1.0 / 12).asDiagonal();
    body.inertia = InertiaTensor<Body>::about_centre(1, centre, tensor);
    return body;
  };
  const UniformGravity<Guide> down{{0, 0, -9.81}};
  const BodySystem linkage(
      RestingFrame<>{},
      {rod("left", "guide", {0, 0, 0}, {0, 0, 0.5}), rod("right", "guide", {1, 0, 0}, {0, 0, 0.5}),
       rod("rod", "left", {0, 0, 1}, {0.5, 0, 0})},
      down, {}, {{"loop", "right", "rod", constraint::Point{{0, 0, 1}, {1, 0, 0}}}});
  auto start = linkage.rest();
  start.rates << speed, speed, -speed;
  const auto run = solve(linkage, start, {.output_times = {0.8, 3}});
  BOOST_TEST(run.report.tolerance_kept);

  BodyDescription pendulum = rod("p", "guide", {0, 0, 0}, {0, 0, 0});
  const Matrix3<double> inertia = Eigen::Vector3d(5.0 / 3, 5.0 / 3, 0.1).asDiagonal();
  pendulum.inertia = InertiaTensor<Body>::about_origin(3, {0, 0, 2.0 / 3}, inertia);
  const BodySystem simple(RestingFrame<>{}, {pendulum}, down);
  const auto expected =
      solve(simple, {Eigen::VectorXd::Zero(1), Eigen::VectorXd::Constant(1, speed)},
            {.output_times = {0.8, 3}, .tolerance = 1e-12});
  for (std::size_t i = 0; i < 2; ++i) {
    const double angle = expected.states[i].coordinates[0];
    const Vector3<double> off = run.states[i].coordinates - angle * Vector3<double>(1, 1, -1);
    BOOST_TEST(off.cwiseAbs().maxCoeff() <= 1e-10 * (1 + std::abs(angle)), i);
  }
}

BOOST_AUTO_TEST_SUITE_END()
