#include <Eigen/Dense>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <boost/test/unit_test.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <future>
#include <limits>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <dynamics/guide/harmonic.hpp>
#include <dynamics/guide/rotating.hpp>
#include <dynamics/step/integrator.hpp>
#include <dynamics/tree/body_system.hpp>

#include <support/cast.hpp>
#include <support/kinematics.hpp>
#include <support/near.hpp>
#include <support/reference.hpp>
#include <support/worst.hpp>

using namespace kreisel;
using test::near;

namespace {

using Digits = test::Digits50;

const Vector3<double> x_axis = Vector3<double>::UnitX();
const Vector3<double> y_axis = Vector3<double>::UnitY();
const Vector3<double> z_axis = Vector3<double>::UnitZ();

InertiaTensor<Body> body(double mass, const Vector3<double>& centre,
                         const Vector3<double>& moments) {
  return InertiaTensor<Body>::about_centre(mass, centre, moments.asDiagonal().toDenseMatrix());
}

BodyDescription described(const std::string& name, const std::string& parent, const Joint& joint,
                          const InertiaTensor<Body>& inertia) {
  BodyDescription b;
  b.name = name;
  b.parent = parent;
  b.joint = joint;
  b.inertia = inertia;
  return b;
}

Joint revolute(const Vector3<double>& axis, const Vector3<double>& position = {0, 0, 0}) {
  return {.kind = JointKind::revolute, .axis = axis, .position = position};
}

InertiaTensor<Body> some_body() { return body(2, {0.1, -0.2, 0.3}, {0.3, 0.4, 0.5}); }

/// A system at rest, made from a list.
BodySystem<RestingFrame<>> resting(std::vector<BodyDescription> bodies,
                                   const Gravity& gravity = {}) {
  return {RestingFrame<>{}, std::move(bodies), gravity};
}

double relative(const Eigen::VectorXd& found, const std::vector<Digits>& truth) {
  Digits worst = 0;
  Digits size = 0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const Digits off = abs(Digits(found[Eigen::Index(i)]) - truth[i]);
    worst = off > worst ? off : worst;
    size = abs(truth[i]) > size ? Digits(abs(truth[i])) : size;
  }
  return static_cast<double>(Digits(worst / size));
}

/// The message of an action's exception, or nothing.
template <class Thrown>
std::string message_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const Thrown& error) {
    return error.what();
  }
  return "";
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

}  // namespace

BOOST_AUTO_TEST_SUITE(a_system_of_bodies)

// Two compound pendulums, one on the other, in a vertical plane. Lagrange, with the angles p1, p2
// of both from the vertical (p2 = q1 + q2), l the distance of the joints, s_i of the centres:
//
//     L = (I1 + m1 s1^2 + m2 l^2) p1'^2/2 + (I2 + m2 s2^2) p2'^2/2 + m2 l s2 cos(p1 - p2) p1' p2'
//       + (m1 s1 + m2 l) g cos p1 + m2 s2 g cos p2
BOOST_AUTO_TEST_CASE(agrees_with_the_double_pendulum) {
  const double m1 = 1.5, m2 = 0.75, l = 0.875, s1 = 0.4375, s2 = 0.3125, i1 = 0.125, i2 = 0.0625;
  const double g = 9.8125;
  const auto system =
      resting({described("upper", "guide", revolute(z_axis), body(m1, {0, -s1, 0}, {0.1, 0.1, i1})),
               described("lower", "upper", revolute(z_axis, {0, -l, 0}),
                         body(m2, {0, -s2, 0}, {0.05, 0.05, i2}))},
              UniformGravity<Guide>{{0, -g, 0}});
  BodyWorkspace w = system.workspace();
  double worst = 0;
  double worst_reaction = 0;
  for (const std::array<double, 4>& start : {std::array<double, 4>{0.3, -1.2, 2, -3},
                                             {2.5, 1.4, -4, 5},
                                             {-0.01, 0.02, 0.1, 0.2},
                                             {3.1, 0, 12, -20}}) {
    const Digits p1 = start[0];
    const Digits p2 = p1 + start[1];
    const Digits w1 = start[2];
    const Digits w2 = w1 + start[3];
    const Digits a = Digits(i1) + Digits(m1) * s1 * s1 + Digits(m2) * l * l;
    const Digits b = Digits(i2) + Digits(m2) * s2 * s2;
    const Digits k = Digits(m2) * l * s2;
    const Digits c = k * cos(p1 - p2);
    const Digits s = k * sin(p1 - p2);
    const Digits r1 = -s * w2 * w2 - (Digits(m1) * s1 + Digits(m2) * l) * g * sin(p1);
    const Digits r2 = s * w1 * w1 - Digits(m2) * s2 * g * sin(p2);
    const Digits det = a * b - c * c;
    const Digits dw1 = (b * r1 - c * r2) / det;
    const Digits dw2 = (a * r2 - c * r1) / det;

    const Eigen::VectorXd y = Eigen::Map<const Eigen::Vector4d>(start.data());
    Eigen::VectorXd dv;
    system.accelerations(0, y, {}, dv, w);
    const double error = relative(dv, {dw1, dw2 - dw1});
    BOOST_TEST(error <= 1e-14);
    worst = test::worst_of(worst, error);

    // The force in the lower joint accelerates the lower centre of mass.
    const Digits ax =
        l * (dw1 * cos(p1) - w1 * w1 * sin(p1)) + s2 * (dw2 * cos(p2) - w2 * w2 * sin(p2));
    const Digits ay =
        l * (dw1 * sin(p1) + w1 * w1 * cos(p1)) + s2 * (dw2 * sin(p2) + w2 * w2 * cos(p2));
    const Digits fx = m2 * ax;
    const Digits fy = m2 * (ay + g);
    JointReactions reactions;
    system.reactions(0, y, reactions, w);
    const Motor<>& R = reactions.on_body[1].value;
    const double off =
        relative(R.resultant, {fx * cos(p2) + fy * sin(p2), fy * cos(p2) - fx * sin(p2), 0});
    BOOST_TEST(off <= 1e-14);
    BOOST_TEST(R.moment.norm() <= 1e-14 * R.resultant.norm());
    worst_reaction = test::worst_of(worst_reaction, off);
  }
  BOOST_TEST_MESSAGE("double pendulum: accelerations " << worst << ", reactions "
                                                       << worst_reaction);
}

// A bead on a rod that turns with the guide: x'' = (u^2 - c/m) x. The rod pushes sideways with m (2
// u x' + ou x).
BOOST_AUTO_TEST_CASE(agrees_with_a_bead_on_a_turning_rod) {
  FrameMotion<Guide, Inertial> motion;
  motion.V.value.resultant = {0, 0, 1.5};
  motion.dV.value.resultant = {0, 0, -0.75};
  const auto guide = [motion](double) { return motion; };
  auto bead = described("bead", "guide", {.kind = JointKind::prismatic, .axis = {2, 0, 0}},
                        body(0.5, {0, 0, 0}, {0.1, 0.1, 0.1}));
  bead.forces = {{.stiffness = 3, .damping = 0.25}};
  const BodySystem<std::decay_t<decltype(guide)>> system(guide, {bead});
  BodyWorkspace w = system.workspace();
  const Eigen::Vector2d y(0.75, -2);
  Eigen::VectorXd rates;
  system.rates(0, y, rates, w);
  BOOST_TEST(rates[0] == -2);
  BOOST_TEST(near(rates[1], 1.5 * 1.5 * 0.75 - (3 * 0.75 - 0.25 * 2) / 0.5, 5.0, 4));
  JointReactions r;
  system.reactions(0, y, r, w);
  const double across = 0.5 * (2 * 1.5 * -2 - 0.75 * 0.75);
  const double along = -3 * 0.75 + 0.25 * 2;
  BOOST_TEST(near(r.on_body[0].value.resultant, {along, across, 0}, 5.0, 4));
  BOOST_TEST(near(r.on_body[0].value.moment, {0, 0, -0.75 * 0.1}, 1.0, 4));
  BOOST_TEST(r.drive[0] == 0);
}

// A free body on the moving guide of the 25-digit cases: the force for its motion.
BOOST_AUTO_TEST_CASE(needs_the_force_of_the_reference_cases) {
  for (const test::ReferenceCase& c : test::reference_cases()) {
    const test::Truth truth = test::truth(c.guide, c.relative, c.t, c.masses);
    FrameMotion<Guide, Inertial> motion;
    motion.X.value = test::cast<double>(truth.X_IG);
    motion.V.value = test::cast<double>(truth.F_G);
    motion.dV.value = test::cast<double>(truth.dF_G);
    const auto guide = [motion](double) { return motion; };
    const InertiaTensor<Body> inertia{test::inertia(c.masses)};
    const BodySystem<std::decay_t<decltype(guide)>> system(
        guide, {described("body", "guide", {.kind = JointKind::free}, inertia)});
    const Matrix3<double> R = test::cast<double>(truth.X_GB.rotation);
    const Motor<> V = test::cast<double>(c.V_rel);
    const Motor<> dV = test::cast<double>(c.dV_rel.body);
    Eigen::VectorXd y(13);
    y << Eigen::Quaterniond(R).coeffs(), test::cast<double>(truth.X_GB.translation), V.resultant,
        R * V.moment;
    Eigen::VectorXd dv(6);
    dv << dV.resultant, R * (dV.moment + V.resultant.cross(V.moment));
    BodyWorkspace w = system.workspace();
    Eigen::VectorXd force;
    system.joint_forces(0, y, dv, force, w);
    const Motor<> P = test::cast<double>(c.force);
    const Vector3<double> f = R.transpose() * Vector3<double>(force.tail<3>());
    const Vector3<double> n = force.head<3>();
    BOOST_TEST_MESSAGE(c.name << ": force " << (f - P.resultant).norm() / P.resultant.norm()
                              << ", torque " << (n - P.moment).norm() / P.moment.norm());
    BOOST_TEST((f - P.resultant).norm() <= 1e-13 * P.resultant.norm());
    BOOST_TEST((n - P.moment).norm() <= 1e-13 * (P.moment.norm() + P.resultant.norm()));
    // And in reverse: that force causes that motion.
    Eigen::VectorXd back;
    system.accelerations(0, y, force, back, w);
    BOOST_TEST((back - dv).norm() <= 1e-13 * dv.norm());
    const BodyBalance balance = system.balance(0, y, w);
    const Motor<> J = (test::cast<double>(truth.X_GB) * test::cast<double>(c.momentum));
    BOOST_TEST((balance.momentum.value.resultant - J.resultant).norm() <=
               1e-13 * J.resultant.norm());
    BOOST_TEST((balance.momentum.value.moment - J.moment).norm() <= 1e-13 * J.moment.norm());
  }
}

BOOST_AUTO_TEST_CASE(does_not_depend_on_a_quaternions_norm) {
  auto ball = described("ball", "guide", {.kind = JointKind::spherical}, some_body());
  auto loose = described("loose", "ball", {.kind = JointKind::free}, some_body());
  const auto system = resting({ball, loose}, UniformGravity<Guide>{{0, 0, -9}});
  Eigen::VectorXd y(20);
  y << 0.1, 0.2, -0.3, 0.9, 0.4, -0.1, 0.2, 0.8, 0.3, 0.2, 0.1, 1, 2, 3, -1, 0.5, 0.2, 3, 2, 1;
  Eigen::VectorXd longer = y;
  longer.head(4) *= 16;
  longer.segment(4, 4) /= 4;
  const Eigen::VectorXd a = system.rates(0, y);
  const Eigen::VectorXd b = system.rates(0, longer);
  BOOST_TEST((a.tail(9) == b.tail(9)));
  BOOST_TEST((16 * a.head(4) == b.head(4)));
}

BOOST_AUTO_TEST_CASE(reports_the_torque_of_a_constant_rate) {
  auto frame = described("frame", "guide", revolute(x_axis), some_body());
  auto rotor = described("rotor", "frame", revolute(y_axis, {0.1, 0, 0}), some_body());
  rotor.rule = JointRule::driven;
  rotor.forces = {{.damping = 0.5}};
  const auto system = resting({frame, rotor}, UniformGravity<Guide>{{0, 0, -9}});
  BodyWorkspace w = system.workspace();
  const Eigen::Vector4d y(0.3, 0.4, 2, 50);
  Eigen::VectorXd rates;
  system.rates(0, y, rates, w);
  BOOST_TEST(rates[1] == 50);
  BOOST_TEST(rates[3] == 0);
  JointReactions r;
  system.reactions(0, y, r, w);
  BOOST_TEST(near(r.drive[1] - 0.5 * 50, r.on_body[1].value.moment.y(), 1000.0, 4));
  // The same motion, with that torque on a free joint.
  rotor.rule = JointRule::forces;
  const auto left = resting({frame, rotor}, UniformGravity<Guide>{{0, 0, -9}});
  Eigen::VectorXd dv;
  left.accelerations(0, y, Eigen::Vector2d(0, r.drive[1]), dv, w);
  BOOST_TEST(near(dv[0], rates[2], std::abs(rates[2]), 200));
  BOOST_TEST(std::abs(dv[1]) <= 1e-12 * std::abs(rates[2]));
}

BOOST_AUTO_TEST_CASE(holds_a_locked_joint_where_it_is) {
  auto arm = described("arm", "guide", revolute(x_axis), some_body());
  auto hand = described("hand", "arm", revolute(y_axis, {0, 0, 1}), some_body());
  hand.rule = JointRule::held;
  const auto locked = resting({arm, hand}, UniformGravity<Guide>{{0, 0, -9}});
  hand.rule = JointRule::forces;
  hand.joint = {.kind = JointKind::fixed,
                .position = {0, 0, 1},
                .orientation = Eigen::Quaterniond(std::cos(0.2), 0, std::sin(0.2), 0)};
  const auto welded = resting({arm, hand}, UniformGravity<Guide>{{0, 0, -9}});
  const Eigen::VectorXd a = locked.rates(0, Eigen::Vector4d(0.3, 0.4, 2, 77));
  const Eigen::VectorXd b = welded.rates(0, Eigen::Vector2d(0.3, 2));
  BOOST_TEST(a[1] == 0);
  BOOST_TEST(a[3] == 0);
  BOOST_TEST(near(a[2], b[1], std::abs(b[1]), 8));
}

// Massless rings: Euler's equations of the rotor, until the outer axis meets the rotor's.
BOOST_AUTO_TEST_CASE(accepts_massless_bodies) {
  const InertiaTensor<Body> none{};
  const auto rotor = body(1, {0, 0, 0}, {0.005, 0.005, 0.008});
  const auto gyro = resting({described("outer", "guide", revolute(x_axis), none),
                             described("inner", "outer", revolute(y_axis), none),
                             described("rotor", "inner", revolute(z_axis), rotor)});
  Eigen::VectorXd y(6);
  y << 0.1, 0.3, 0.2, 2, 1, 30;
  const auto ball = resting({described("rotor", "guide", {.kind = JointKind::spherical}, rotor)});
  // u' on the rotor's axes from the three rates, and its derivative on them.
  const double cb = std::cos(y[1]), sb = std::sin(y[1]), cf = std::cos(y[2]), sf = std::sin(y[2]);
  const double ad = y[3], bd = y[4], fd = y[5];
  Eigen::VectorXd free = ball.to_vector(ball.rest());
  free.tail<3>() << ad * cb * cf + bd * sf, -ad * cb * sf + bd * cf, ad * sb + fd;
  const Eigen::VectorXd du = ball.rates(0, free).tail(3);
  const Eigen::VectorXd dv = gyro.rates(0, y).tail(3);
  const Vector3<double> again(
      dv[0] * cb * cf + dv[1] * sf - ad * bd * sb * cf - ad * cb * fd * sf + bd * fd * cf,
      -dv[0] * cb * sf + dv[1] * cf + ad * bd * sb * sf - ad * cb * fd * cf - bd * fd * sf,
      dv[0] * sb + dv[2] + ad * bd * cb);
  BOOST_TEST(near(again, Vector3<double>(du), 100.0, 16));

  y[1] = std::acos(-1.0) / 2;
  const std::string lock = message_of<ComputationFailed>([&] { (void)gyro.rates(0, y); });
  BOOST_TEST(contains(lock, "body 'outer': the rotation about (1, 0, 0)"), lock);

  const auto tail = resting({described("dog", "guide", revolute(x_axis), rotor),
                             described("tail", "dog", {.kind = JointKind::spherical}, none)});
  const std::string loose =
      message_of<ComputationFailed>([&] { (void)tail.rates(0, tail.to_vector(tail.rest())); });
  BOOST_TEST(contains(loose, "body 'tail': the rotation about"), loose);
}

BOOST_AUTO_TEST_CASE(may_have_no_degrees_of_freedom) {
  const auto system =
      resting({described("a", "guide", {.position = {0, 0, 1}}, body(2, {0, 0, 0}, {1, 1, 1})),
               described("b", "a", {.position = {3, 0, 0}}, body(1, {1, 0, 0}, {1, 1, 1}))},
              UniformGravity<Guide>{{0, 0, -10}});
  BOOST_TEST(system.rates(0, Eigen::VectorXd()).size() == 0);
  BodyWorkspace w = system.workspace();
  JointReactions r;
  system.reactions(0, Eigen::VectorXd(), r, w);
  BOOST_TEST((r.on_body[0].value == Motor<>{{0, 0, 30}, {0, -40, 0}}));
  BOOST_TEST((r.on_body[1].value == Motor<>{{0, 0, 10}, {0, -10, 0}}));
  BOOST_TEST(resting({}).rates(0, Eigen::VectorXd()).size() == 0);
}

BOOST_AUTO_TEST_CASE(reports_its_layout) {
  const auto system =
      resting({described("ship", "guide", {.kind = JointKind::free}, some_body()),
               described("fork", "ship",
                         {.kind = JointKind::universal, .axis = x_axis, .second_axis = y_axis},
                         some_body()),
               described("lamp", "ship", {.kind = JointKind::spherical}, some_body())});
  BOOST_TEST(system.rest().coordinates.size() == 13);
  BOOST_TEST(system.rest().rates.size() == 11);
  const JointPlace fork = system.tree().place(system.tree().index("fork"));
  BOOST_TEST((fork.q == 7 && fork.q_count == 2 && fork.v == 6 && fork.v_count == 2));
  const JointPlace lamp = system.tree().place(2);
  BOOST_TEST((lamp.q == 9 && lamp.q_count == 4 && lamp.v == 8 && lamp.v_count == 3));
  BOOST_TEST((system.blocks() == std::vector<int>{4, 3, 1, 1, 4, 3, 3, 1, 1, 3}));
  BOOST_CHECK_THROW((void)system.tree().index("mast"), InvalidInput);
}

// Kept if the first joint is affected, dropped if the cause is absent.
BOOST_AUTO_TEST_CASE(lists_its_terms) {
  const BodyDescription arm = described("arm", "guide", revolute(y_axis), some_body());
  BodyDescription wheel =
      described("wheel", "arm", revolute(x_axis), body(1, {0, 0, 0}, {0.2, 0.1, 0.1}));
  wheel.rotor = Rotor{};
  BodyDescription pushed = arm;
  pushed.loads = {ConstantLoad<Body>{{1, 2, 3}, {0, 5, 0}}};
  BodyDescription lid = described("lid", "arm", revolute(z_axis), some_body());
  lid.rule = JointRule::held;
  const RotatingFrame<> table{{0.3, -0.2, 1.1}};
  const Gravity weight = UniformGravity<Guide>{{0, 0, -9.81}};
  const auto turning = [&table](std::vector<BodyDescription> bodies) {
    return BodySystem<RotatingFrame<>>(table, std::move(bodies));
  };
  const auto acceleration = [](const auto& system, double spin) {
    auto state = system.rest();
    state.coordinates[0] = 0.5;
    state.rates[0] = 2;
    if (state.rates.size() > 1) state.rates[1] = spin;
    return system.rates(0.2, system.to_vector(state))[state.coordinates.size()];
  };
  const auto check = [](const auto& system, const char* name, double effect) {
    for (const Term& term : terms(system)) {
      if (term.name != name) continue;
      BOOST_TEST(term.kept == (effect != 0), name << " does " << effect);
      BOOST_TEST((term.kept || !term.why.empty()), name);
      return;
    }
    BOOST_ERROR(name);
  };
  const double bare = acceleration(resting({arm}), 0);
  for (const char* const name :
       {"T_i *F + F x (T_i F)", "V'_i x (T_i F) + F x (T_i V'_i) + T_i (F x V'_i)"}) {
    check(resting({arm}), name, 0);
    check(turning({arm}), name, acceleration(turning({arm}), 0) - bare);
  }
  check(resting({arm}), "uniform gravity", 0);
  check(resting({arm}, weight), "gravity on guide axes",
        acceleration(resting({arm}, weight), 0) - bare);
  check(resting({arm}), "loads on bodies", 0);
  check(resting({pushed}), "loads on bodies", acceleration(resting({pushed}), 0) - bare);
  const auto wheeled = turning({arm, wheel});
  check(turning({arm}), "w x l e of rotors", 0);
  check(wheeled, "w x l e of rotors", acceleration(wheeled, 50) - acceleration(wheeled, 0));
  check(wheeled, "angles of rotors", 0);
  const Terms closed = terms(resting({arm, lid}));
  const auto locked = std::find_if(closed.begin(), closed.end(), [](const Term& term) {
    return term.name == "accelerations in joints";
  });
  BOOST_TEST_REQUIRE((locked != closed.end()));
  BOOST_TEST(locked->why == "not where held or driven: 'lid'");
}

BOOST_AUTO_TEST_SUITE_END()

BOOST_AUTO_TEST_SUITE(a_description)

BOOST_AUTO_TEST_CASE(is_refused_by_name_and_reason) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto good = described("a", "guide", revolute(x_axis), some_body());
  const auto refused = [&](const BodyDescription& b) {
    return message_of<InvalidInput>([&] { (void)resting({good, b}); });
  };
  const auto expect = [&](const BodyDescription& b, const std::string& what) {
    const std::string message = refused(b);
    BOOST_TEST(contains(message, what), "'" << message << "' lacks '" << what << "'");
  };
  auto b = described("b", "a", revolute(y_axis), some_body());
  BOOST_TEST(refused(b).empty());
  const auto with = [&b](auto change) {
    BodyDescription changed = b;
    change(changed);
    return changed;
  };
  expect(with([](auto& c) { c.name = "a"; }), "body 'a': the name is used twice");
  expect(with([](auto& c) { c.name = "guide"; }), "needs a name other than 'guide'");
  expect(with([](auto& c) { c.parent = "c"; }), "body 'b': its parent 'c' is unknown");
  expect(with([](auto& c) { c.parent = "b"; }), "body 'b': closed loop b -> b");
  expect(with([](auto& c) { c.joint.axis.setZero(); }), "body 'b': the axis of its joint is 0");
  expect(with([nan](auto& c) { c.joint.axis[1] = nan; }), "body 'b': the axis of its joint is not");
  expect(with([nan](auto& c) { c.joint.position[2] = nan; }), "body 'b': the position");
  expect(with([](auto& c) { c.joint.orientation.coeffs().setZero(); }),
         "body 'b': the orientation");
  expect(with([](auto& c) { c.inertia.value.mass = -1; }), "body 'b': mass >= 0 fails");
  expect(with([](auto& c) { c.inertia.value.tensor.xx = 99; }), "body 'b': triangle inequality");
  expect(with([](auto& c) { c.forces.resize(2); }), "body 'b': 2 joint forces for a joint of 1");
  expect(with([nan](auto& c) { c.forces = {{.rest = nan}}; }), "body 'b': a number of its joint");
  expect(with([](auto& c) {
           c.joint.kind = JointKind::spherical;
           c.rule = JointRule::driven;
         }),
         "body 'b': only a revolute, prismatic or screw joint");
  expect(with([](auto& c) {
           c.joint.kind = JointKind::spherical;
           c.forces.resize(3, {.stiffness = 1});
         }),
         "body 'b': a spring needs a single coordinate");
  expect(with([](auto& c) {
           c.joint.kind = JointKind::universal;
           c.joint.second_axis = 2 * c.joint.axis;
         }),
         "body 'b': both axes of its universal joint are parallel");
}

BOOST_AUTO_TEST_CASE(is_refused_out_of_order_or_in_a_ring) {
  const auto a = described("a", "c", revolute(x_axis), some_body());
  const auto b = described("b", "a", revolute(x_axis), some_body());
  auto c = described("c", "b", revolute(x_axis), some_body());
  const std::string ring = message_of<InvalidInput>([&] { (void)resting({a, b, c}); });
  BOOST_TEST(contains(ring, "body 'a': closed loop a -> c -> b -> a"), ring);
  c.parent = "guide";
  const std::string late = message_of<InvalidInput>([&] { (void)resting({a, b, c}); });
  BOOST_TEST(contains(late, "body 'a': its parent 'c' comes later"), late);
}

BOOST_AUTO_TEST_CASE(belongs_to_states_and_workspaces_of_its_size) {
  const auto one = resting({described("a", "guide", revolute(x_axis), some_body())});
  const auto two = resting({described("a", "guide", revolute(x_axis), some_body()),
                            described("b", "a", revolute(x_axis), some_body())});
  BodyWorkspace w = one.workspace();
  Eigen::VectorXd result;
  BOOST_CHECK_THROW(two.rates(0, Eigen::VectorXd::Zero(4), result, w), InvalidInput);
  BOOST_CHECK_THROW(one.rates(0, Eigen::VectorXd::Zero(3), result, w), InvalidInput);
  BOOST_TEST(
      contains(message_of<InvalidInput>([&] { two.rates(0, Eigen::VectorXd::Zero(3), result, w); }),
               "a state of 3 components, not 4"));
  BOOST_CHECK_THROW(
      one.accelerations(0, Eigen::VectorXd::Zero(2), Eigen::VectorXd::Zero(2), result, w),
      InvalidInput);
}

BOOST_AUTO_TEST_SUITE_END()

BOOST_AUTO_TEST_SUITE(systems_of_bodies_in_motion)

namespace {

/// All joint kinds, springs and dampers, under gravity.
std::vector<BodyDescription> mobile(double damping) {
  auto ship = described("ship", "guide", {.kind = JointKind::free}, some_body());
  auto mast = described("mast", "ship", revolute({1, 2, 2}, {0.1, 0, 0.3}), some_body());
  mast.forces = {{.stiffness = 6, .rest = 0.2, .damping = damping}};
  auto yard =
      described("yard", "mast", {.kind = JointKind::prismatic, .axis = {0, 1, 1}}, some_body());
  yard.forces = {{.stiffness = 20, .damping = damping}};
  auto lamp = described("lamp", "yard", {.kind = JointKind::spherical, .position = {0, 0.3, 0}},
                        some_body());
  auto fork = described("fork", "ship",
                        {.kind = JointKind::universal, .axis = x_axis, .second_axis = {0.5, 1, 0}},
                        some_body());
  fork.forces = {{.stiffness = 3, .damping = damping}, {.stiffness = 4, .rest = 0.5}};
  const auto box = described("box", "fork", {.position = {0.5, 0, 0}}, some_body());
  return {ship, mast, yard, lamp, fork, box};
}

Eigen::VectorXd start(int size) {
  Eigen::VectorXd y(size);
  for (int i = 0; i < size; ++i) y[i] = std::sin(3.0 * i + 1);
  return y;
}

/// y at the time `end`, and the integrals of `power`.
template <class System, class Power>
std::pair<Eigen::VectorXd, Eigen::VectorXd> run(const System& system, const Eigen::VectorXd& from,
                                                double end, const Power& power) {
  BodyWorkspace w = system.workspace();
  const Eigen::Index states = from.size();
  const Eigen::Index integrals = power(0, from, w).size();
  Eigen::VectorXd y = Eigen::VectorXd::Zero(states + integrals);
  y.head(states) = from;
  Eigen::VectorXd state = from;
  Eigen::VectorXd rates = from;
  const auto field = [&](double t, const Eigen::VectorXd& z, Eigen::VectorXd& result) {
    state = z.head(states);
    system.rates(t, state, rates, w);
    result.head(states) = rates;
    result.tail(integrals) = power(t, state, w);
  };
  ExplicitRungeKutta steps(field, 0.0, y, {.relative = 1e-14});
  steps.advance_to(end);
  return {steps.y().head(states), steps.y().tail(integrals)};
}

const auto nothing = [](double, const Eigen::VectorXd&, BodyWorkspace&) {
  return Eigen::VectorXd();
};

}  // namespace

BOOST_AUTO_TEST_CASE(keep_energy_on_a_resting_guide) {
  const auto system = resting(mobile(0), UniformGravity<Guide>{{1, 2, -9}});
  const Eigen::VectorXd y = start(system.tree().coordinates() + system.tree().rates());
  const auto before = system.conserved(0, system.from_vector(y));
  BOOST_TEST_REQUIRE(before.size() == 2U);
  BOOST_TEST_REQUIRE(before[0].first == "energy");
  const Eigen::VectorXd end = run(system, y, 0.5, nothing).first;
  const auto after = system.conserved(0.5, system.from_vector(end));
  BOOST_TEST_MESSAGE("energy " << before[0].second << ", drift "
                               << after[0].second - before[0].second);
  BOOST_TEST(std::abs(after[0].second - before[0].second) <= 1e-12 * std::abs(before[0].second));
}

BOOST_AUTO_TEST_CASE(keep_momentum_without_external_loads) {
  const auto system = resting(mobile(0.7));
  const Eigen::VectorXd y = start(system.tree().coordinates() + system.tree().rates());
  const auto before = system.conserved(0, system.from_vector(y));
  BOOST_TEST_REQUIRE(before.size() == 6U);
  const Eigen::VectorXd end = run(system, y, 0.5, nothing).first;
  const auto after = system.conserved(0.5, system.from_vector(end));
  for (std::size_t k = 0; k < 6; ++k) {
    BOOST_TEST(std::abs(after[k].second - before[k].second) <= 1e-12 * 50);
  }
}

BOOST_AUTO_TEST_CASE(lose_energy_on_a_moving_guide_or_with_a_motor) {
  const auto keeps_energy = [](const auto& system) {
    const auto kept = system.conserved(0, system.rest());
    return std::any_of(kept.begin(), kept.end(),
                       [](const auto& invariant) { return invariant.first == "energy"; });
  };
  const BodySystem<RotatingFrame<>> moving({.angular_velocity = {0, 0, 1}}, mobile(0));
  BOOST_TEST(moving.conserved(0, moving.rest()).empty());
  const UniformGravity<Guide> gravity{z_axis};
  BOOST_TEST(keeps_energy(resting(mobile(0), gravity)));
  auto bodies = mobile(0);
  bodies[1].rule = JointRule::driven;
  BOOST_TEST(!keeps_energy(resting(bodies, gravity)));
  BOOST_TEST(!keeps_energy(resting(mobile(0.1), gravity)));
}

namespace {

/// The absolute energy grows by the guide's work and that of dampers and drive. The guide's power
/// is its reaction on body 0, the only body on it, times its own velocity. The momentum grows by
/// reaction and weight.
template <class M>
void check_balances(const M& guide, const std::vector<BodyDescription>& bodies,
                    const Vector3<double>& g, double end) {
  const BodySystem<M> system(guide, bodies, UniformGravity<Inertial>{g});
  const Eigen::VectorXd y = start(system.tree().coordinates() + system.tree().rates());
  JointReactions r;
  const auto power = [&](double t, const Eigen::VectorXd& state, BodyWorkspace& w) {
    system.reactions(t, state, r, w);
    const LoadContext<> s = system.situation(t, state, 0, w);
    const FrameMotion<Guide, Inertial>& G = s.guide;
    const Motor<> R = s.X.value * r.on_body[0].value;  // on guide axes, about its origin
    Eigen::VectorXd result(7);
    double sum = reciprocal(R, G.V.value);
    const auto v = state.tail(system.tree().rates());
    for (int k = 0; k < v.size(); ++k) sum += r.drive[k] * v[k];
    for (std::size_t k = 0; k < system.tree().forces().size(); ++k) {
      const double rate = v[Eigen::Index(k)];
      sum -= system.tree().forces()[k].damping * rate * rate;
    }
    const Pose<> X = G.X.value;
    Motor<> P = X * R;
    for (int i = 0; i < system.body_count(); ++i) {
      const LoadContext<> b = system.situation(t, state, i, w);
      const double m = b.inertia.value.mass;
      const Vector3<double> centre = b.template position<Inertial>(b.centre());
      P += {m * g, centre.cross(m * g)};
    }
    result << sum, P.resultant, P.moment;
    return result;
  };
  const auto [y_end, work] = run(system, y, end, power);
  BodyWorkspace w = system.workspace();
  const BodyBalance a = system.balance(0, y, w);
  const BodyBalance b = system.balance(end, y_end, w);
  const double energy =
      b.kinetic_energy + b.potential_energy - a.kinetic_energy - a.potential_energy;
  BOOST_TEST_MESSAGE("energy grows by " << energy << ", work " << work[0] << ", off by "
                                        << energy - work[0]);
  BOOST_TEST(std::abs(energy - work[0]) <=
             1e-12 * (a.kinetic_energy + b.kinetic_energy + std::abs(work[0])));
  const Motor<> before = guide(0).X.value * a.momentum.value;
  const Motor<> after = guide(end).X.value * b.momentum.value;
  const Motor<> gain = after - before;
  const Vector3<double> off_p = gain.resultant - Vector3<double>(work.segment(1, 3));
  const Vector3<double> off_L = gain.moment - Vector3<double>(work.segment(4, 3));
  BOOST_TEST_MESSAGE("momentum off by " << off_p.norm() << " of " << after.resultant.norm()
                                        << ", angular by " << off_L.norm() << " of "
                                        << after.moment.norm());
  BOOST_TEST(off_p.norm() <= 1e-12 * (before.resultant.norm() + after.resultant.norm()));
  BOOST_TEST(off_L.norm() <= 1e-12 * (before.moment.norm() + after.moment.norm()));
}

/// Six bodies in a row, the third in a spherical joint.
std::vector<BodyDescription> row() {
  std::vector<BodyDescription> bodies;
  for (int i = 0; i < 6; ++i) {
    const std::string parent = i == 0 ? "guide" : bodies.back().name;
    Joint joint = revolute(i % 2 ? x_axis : y_axis, {0, 0, i == 0 ? 0 : -0.5});
    if (i == 2) joint.kind = JointKind::spherical;
    bodies.push_back(described("body " + std::to_string(i), parent, joint,
                               body(1, {0.01, 0.02, -0.25}, {0.05, 0.04, 0.03})));
    bodies.back().forces.assign(i == 2 ? 3 : 1, {.damping = 0.02});
  }
  return bodies;
}

HarmonicFrame<> rolling() {
  const HarmonicSeries<> u{{0, 0, 0.1}, {{{0.3, 0, 0}, 1.5, 0.2}, {{0, 0.2, 0}, 2.5, 1}}};
  const HarmonicSeries<> a{{0, 0, 0}, {{{0, 0.5, 1}, 2, 0}}};
  return {u, a, 0, 5};
}

}  // namespace

BOOST_AUTO_TEST_CASE(close_their_balances_on_a_moving_guide) {
  auto bodies = mobile(0.3);
  bodies[0].joint = {.kind = JointKind::universal, .axis = x_axis, .second_axis = y_axis};
  bodies[0].forces = {{.stiffness = 5}, {.damping = 0.2}};
  bodies[1].rule = JointRule::driven;
  const RotatingFrame<> turns_and_brakes{.angular_velocity = {0.5, -0.75, 1},
                                         .origin_acceleration = {1, 2, -3},
                                         .origin_velocity = {3, 1, 2}};
  check_balances(turns_and_brakes, bodies, {1, -2, 5}, 0.5);
  check_balances(rolling(), row(), {0, 0, -9.81}, 5);
}

// Integrator gets the size and the blocks of a system from the object.
BOOST_AUTO_TEST_CASE(agree_with_states_of_fixed_size) {
  const BodySystem system(rolling(), row(), UniformGravity<Inertial>{{0, 0, -9.81}});
  using System = std::decay_t<decltype(system)>;
  using Fixed = Eigen::Matrix<double, 17, 1>;
  const Eigen::VectorXd y = start(17);
  BodyWorkspace w = system.workspace();
  const auto field = [&](double t, const Fixed& state) {
    Eigen::VectorXd rates;
    system.rates(t, state, rates, w);
    return Fixed(rates);
  };
  ExplicitRungeKutta fixed(field, 0.0, Fixed(y), {.relative = 1e-12}, system.blocks());
  Integrator run(system, 0, system.from_vector(y), {.relative = 1e-12});
  const auto compare = [](const System::State& state, const Fixed& truth) {
    const double off = (System::to_vector(state) - truth).norm() / truth.norm();
    BOOST_TEST_MESSAGE("off by " << off);
    BOOST_TEST(off < 1e-12);
  };
  compare(run.to(5), fixed.advance_to(5));
  fixed.step_towards(0);
  const double within = (5 + fixed.t()) / 2;
  compare(run.on_the_way(within, 0), fixed.at(within));
  // Sums over vectors of different types round differently, which may cost a step or two.
  BOOST_TEST(std::abs(run.effort().evaluations - fixed.effort().evaluations) <= 2 * 16);
}

// One system, used by two threads with a workspace each.
BOOST_AUTO_TEST_CASE(may_be_used_by_several_threads) {
  const BodySystem<RotatingFrame<>> system({.angular_velocity = {0.3, -0.2, 0.5}}, mobile(0.1),
                                           UniformGravity<Guide>{{0, 0, -9.81}});
  const auto accelerations = [&system] {
    BodyWorkspace w = system.workspace();
    Eigen::VectorXd y = system.to_vector(system.rest());
    Eigen::VectorXd dv;
    std::vector<Eigen::VectorXd> found;
    for (int k = 0; k < 2000; ++k) {
      y.tail(system.tree().rates()).setConstant(std::sin(k));
      system.accelerations(0.01 * k, y, {}, dv, w);
      found.push_back(dv);
    }
    return found;
  };
  const auto alone = accelerations();
  auto other = std::async(std::launch::async, accelerations);
  const auto here = accelerations();
  const auto there = other.get();
  bool same = true;
  for (std::size_t k = 0; k < alone.size(); ++k) {
    same = same && here[k] == alone[k] && there[k] == alone[k];
  }
  BOOST_TEST(same);
}

BOOST_AUTO_TEST_CASE(may_have_nothing_that_moves) {
  const auto system = resting({described("block", "guide", {}, some_body())});
  Integrator run(system, 0, system.rest());
  BOOST_TEST(run.to(1).rates.size() == 0);
}

BOOST_AUTO_TEST_SUITE_END()
