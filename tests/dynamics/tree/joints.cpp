// The list of joints, and joints whose bodies move in closed form.

#include <boost/test/unit_test.hpp>

#include <cmath>
#include <cstddef>
#include <set>
#include <string>
#include <utility>

#include <dynamics/guide/resting.hpp>
#include <dynamics/guide/rotating.hpp>
#include <dynamics/tree/body_system.hpp>
#include <dynamics/tree/joint/list.hpp>

using namespace kreisel;

namespace {

const UniformGravity<Guide> weight{{0, 0, -9.81}};

/// A body with its centre of mass off its origin, in a joint to the guide.
BodyDescription body(const Joint& joint) {
  BodyDescription b;
  b.name = "body";
  b.joint = joint;
  b.inertia = InertiaTensor<Body>::about_centre(2, {0.3, -0.1, 0.2},
                                                Vector3<double>(0.2, 0.25, 0.15).asDiagonal());
  return b;
}

/// The rates of a state, and the state a step later by the series, which converges to the last
/// digit there.
template <class Guide>
std::pair<Eigen::VectorXd, Eigen::VectorXd> motion(const BodySystem<Guide>& system,
                                                   const Eigen::VectorXd& y, double h) {
  constexpr int order = 24;
  Eigen::MatrixXd c(y.size(), order + 1);
  c.col(0) = y;
  system.series()(0, h, order, c);
  return {system.rates(0, y), c.rowwise().sum()};
}

/// Some 20 roundings of numbers of the order of 10.
void check_near(const Eigen::VectorXd& found, const Eigen::VectorXd& truth) {
  BOOST_TEST((found - truth).cwiseAbs().maxCoeff() <= 5e-14,
             found.transpose() << " instead of " << truth.transpose());
}

Eigen::VectorXd vector(std::initializer_list<double> numbers) {
  return Eigen::Map<const Eigen::VectorXd>(numbers.begin(), Eigen::Index(numbers.size()));
}

std::string message(const Joint& joint) {
  try {
    const BodyTree tree({body(joint)});
  } catch (const InvalidInput& error) {
    return error.what();
  }
  return "none";
}

}  // namespace

BOOST_AUTO_TEST_SUITE(joints)

BOOST_AUTO_TEST_CASE(are_listed_in_the_order_of_their_kinds) {
  std::set<std::string> names;
  for (std::size_t i = 0; i < joint_types().size(); ++i) {
    const JointType& type = joint_types()[i];
    BOOST_TEST(static_cast<std::size_t>(type.kind) == i, type.name);
    BOOST_TEST(&joint_type(type.kind) == &type, type.name);
    BOOST_TEST(names.insert(type.name).second, type.name);
  }
}

BOOST_AUTO_TEST_CASE(have_the_numbers_of_their_parts) {
  const Joint joint{.axis = {1, 2, 3}, .second_axis = {3, -1, 0}, .pitch = 0.1};
  for (const JointType& type : joint_types()) {
    int coordinates = 0;
    int rates = 0;
    for (const detail::JointPart& part : type.parts(joint)) {
      coordinates += detail::coordinate_count(part.kind);
      rates += detail::rate_count(part.kind);
    }
    BOOST_TEST(type.coordinate_count() == coordinates, type.name);
    BOOST_TEST(type.rate_count() == rates, type.name);
    for (const auto& quantities : {type.coordinates, type.rates}) {
      for (const JointQuantity& quantity : quantities) {
        BOOST_TEST(quantity.curves.size() == quantity.columns.size(), type.name);
      }
    }
  }
}

// About and along a vertical axis the motions are uncoupled: a uniform rotation and a free fall.
BOOST_AUTO_TEST_CASE(a_cylindrical_one_spins_and_falls) {
  const BodySystem system(RestingFrame<>{},
                          {body({.kind = JointKind::cylindrical, .axis = {0, 0, 3}})}, weight);
  const double t = 0.4;
  const auto [rate, after] = motion(system, vector({0.7, 0.5, 2, -1}), t);
  check_near(rate, vector({2, -1, 0, -9.81}));
  check_near(after, vector({0.7 + 2 * t, 0.5 - t - 9.81 * t * t / 2, 2, -1 - 9.81 * t}));
}

// On a level axis it slides at constant speed and swings as a pendulum about the axis.
BOOST_AUTO_TEST_CASE(a_level_cylindrical_one_is_a_pendulum) {
  const Joint cylinder{.kind = JointKind::cylindrical, .axis = {0, 1, 0}, .position = {1, 2, 3}};
  Joint hinge = cylinder;
  hinge.kind = JointKind::revolute;
  const double t = 0.1;
  const auto both =
      motion(BodySystem(RestingFrame<>{}, {body(cylinder)}, weight), vector({0.7, 0.5, 2, -1}), t);
  const auto turning =
      motion(BodySystem(RestingFrame<>{}, {body(hinge)}, weight), vector({0.7, 2}), t);
  check_near(both.first, vector({2, -1, turning.first[1], 0}));
  check_near(both.second, vector({turning.second[0], 0.5 - t, turning.second[1], -1}));
}

// (I + m p^2) q'' = -m g p, with I about the axis.
BOOST_AUTO_TEST_CASE(a_screw_has_the_inertia_of_both_motions) {
  const double p = -0.3;
  const BodySystem system(
      RestingFrame<>{}, {body({.kind = JointKind::screw, .axis = {0, 0, 2}, .pitch = p})}, weight);
  const double I = 0.15 + 2 * (0.3 * 0.3 + 0.1 * 0.1);
  BodyWorkspace workspace = system.workspace();
  Eigen::MatrixXd mass;
  const Eigen::VectorXd start = vector({0.7, 2});
  system.mass_matrix(start, mass, workspace);
  BOOST_TEST(std::abs(mass(0, 0) - (I + 2 * p * p)) <= 1e-15);
  const double a = -2 * 9.81 * p / (I + 2 * p * p);
  const double t = 0.4;
  const auto [rate, after] = motion(system, start, t);
  check_near(rate, vector({2, a}));
  check_near(after, vector({0.7 + 2 * t + a * t * t / 2, 2 + a * t}));
}

// One revolution of a right-handed screw of 0.1 m per radian advances by 0.2 pi m along its axis.
BOOST_AUTO_TEST_CASE(a_screw_advances_by_its_pitch_a_radian) {
  const BodySystem system(
      RestingFrame<>{},
      {body({.kind = JointKind::screw, .axis = {0, 5, 0}, .position = {1, 2, 3}, .pitch = 0.1})});
  BodyWorkspace workspace = system.workspace();
  const double turn = 2 * 3.14159265358979323846;
  const auto at = system.situation(0, vector({turn, 3}), 0, workspace);
  const Vector3<double> place(1, 2 + 0.1 * turn, 3);
  BOOST_TEST((at.X.value.translation - place).norm() <= 1e-15);
  BOOST_TEST((at.X.value.rotation - Matrix3<double>::Identity()).norm() <= 1e-15);
  BOOST_TEST((at.V_rel.value.moment - Vector3<double>(0, 0.3, 0)).norm() <= 1e-15);
  BOOST_TEST((at.V_rel.value.resultant - Vector3<double>(0, 3, 0)).norm() <= 1e-15);
}

// A straight inertial motion, relative to the rotating table:
//   z = exp(-i W t) (z0 + (z0' + i W z0) t)
BOOST_AUTO_TEST_CASE(a_puck_on_a_turntable_goes_straight_on) {
  const double W = 1.5;
  auto puck = body({.kind = JointKind::planar, .axis = {0, 0, 1}});
  puck.inertia = InertiaTensor<Body>::about_centre(2, {0, 0, 0.1},
                                                   Vector3<double>(0.2, 0.25, 0.15).asDiagonal());
  const BodySystem system(RotatingFrame<>{{0, 0, W}}, {puck}, weight);
  const double x = 0.5;
  const double y = -0.8;
  const double vx = 1.1;
  const double vy = 0.4;
  const auto [rate, after] = motion(system, vector({x, y, 0.7, vx, vy, 2}), 0.4);
  check_near(rate, vector({vx, vy, 2, W * W * x + 2 * W * vy, W * W * y - 2 * W * vx, 0}));
  const double t = 0.4;
  const double c = std::cos(W * t);
  const double s = std::sin(W * t);
  const double ux = vx - W * y;  // in the inertial frame
  const double uy = vy + W * x;
  const double X = c * (x + ux * t) + s * (y + uy * t);
  const double Y = c * (y + uy * t) - s * (x + ux * t);
  const double VX = c * ux + s * uy + W * Y;
  const double VY = c * uy - s * ux - W * X;
  check_near(after, vector({X, Y, 0.7 + 2 * t, VX, VY, 2}));
}

BOOST_AUTO_TEST_CASE(planar_ones_slide_along_stated_directions) {
  const auto check = [](const Vector3<double>& axis, const Vector3<double>& second_axis,
                        const Vector3<double>& first, const Vector3<double>& second) {
    const BodySystem system(RestingFrame<>{}, {body({.kind = JointKind::planar,
                                                     .axis = axis,
                                                     .second_axis = second_axis,
                                                     .position = {1, 2, 3}})});
    BodyWorkspace workspace = system.workspace();
    // Rotated, to detect directions that would rotate along.
    const auto at = system.situation(0, vector({0.3, 0.4, 1.2, 5, 6, 0}), 0, workspace);
    const Vector3<double> place = Vector3<double>(1, 2, 3) + 0.3 * first + 0.4 * second;
    BOOST_TEST((at.X.value.translation - place).norm() <= 1e-15);
    const Vector3<double> v = at.X.value.rotation * at.V_rel.value.moment;
    BOOST_TEST((v - (5 * first + 6 * second)).norm() <= 5e-15);
  };
  check({0, 0, 2}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  check({0, 0, -2}, {0, 0, 0}, {1, 0, 0}, {0, -1, 0});
  check({3, 0, 0}, {0, 0, 0}, {0, 1, 0}, {0, 0, 1});
  check({0, 4, 0}, {0, 0, 0}, {0, 0, 1}, {1, 0, 0});
  check({0, 0.6, 0.8}, {0, 0, 0}, {1, 0, 0}, {0, 0.8, -0.6});
  check({0, 0, 1}, {0, 3, 7}, {0, 1, 0}, {-1, 0, 0});
}

BOOST_AUTO_TEST_CASE(springs_act_on_each_single_coordinate) {
  auto puck = body({.kind = JointKind::planar, .axis = {0, 0, 1}});
  puck.inertia = InertiaTensor<Body>::about_centre(2, {0, 0, 0},
                                                   Vector3<double>(0.2, 0.25, 0.15).asDiagonal());
  puck.forces = {{.stiffness = 3, .rest = 0.1}, {.damping = 4}, {.constant = 6}};
  const BodySystem system(RestingFrame<>{}, {puck}, weight);
  const Eigen::VectorXd rates = system.rates(0, vector({0.5, 0, 0, 0, 0.7, 0}));
  check_near(rates, vector({0, 0.7, 0, -3 * 0.4 / 2, -4 * 0.7 / 2, 6 / 0.15}));
  puck.forces[1].damping = 0;
  const BodySystem kept(RestingFrame<>{}, {puck}, weight);
  BOOST_TEST_REQUIRE(!kept.conserved(0, kept.rest()).empty());
  BOOST_TEST(kept.conserved(0, kept.rest()).front().first == "energy");
}

BOOST_AUTO_TEST_CASE(a_screw_keeps_its_momentum_without_weight) {
  const BodySystem system(RestingFrame<>{},
                          {body({.kind = JointKind::screw, .axis = {1, 2, 2}, .pitch = 0.4})});
  auto state = system.rest();
  state.rates[0] = 3;
  const auto kept = system.conserved(0, state);
  BOOST_TEST_REQUIRE(kept.size() == 2U);
  BOOST_TEST(kept[1].first == "momentum along the screw of 'body'");
  BodyWorkspace workspace = system.workspace();
  Eigen::MatrixXd mass;
  system.mass_matrix(system.to_vector(state), mass, workspace);
  BOOST_TEST(std::abs(kept[1].second - 3 * mass(0, 0)) <= 5e-15);
}

BOOST_AUTO_TEST_CASE(without_what_they_need_are_refused) {
  BOOST_TEST(message({.kind = JointKind::screw, .axis = {0, 0, 1}}) ==
             "body 'body': the pitch of its screw joint must be finite and not 0");
  BOOST_TEST(message({.kind = JointKind::cylindrical}) ==
             "body 'body': the axis of its joint is 0 and has no direction");
  BOOST_TEST(message({.kind = JointKind::planar, .axis = {0, 0, 1}, .second_axis = {0, 0, -1}}) ==
             "body 'body': both axes of its planar joint are parallel");
  BOOST_TEST(message({.kind = JointKind::planar, .axis = {0, 0, 1}}) == "none");
}

BOOST_AUTO_TEST_SUITE_END()
