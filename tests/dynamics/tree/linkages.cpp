// Mechanisms with closed loops: the same motion wherever the loop is cut, and against single bodies.

#include <boost/test/data/monomorphic.hpp>
#include <boost/test/data/test_case.hpp>
#include <boost/test/unit_test.hpp>

#include <array>
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

#include <support/told_error.hpp>

using namespace kreisel;
using namespace kreisel::test;
namespace data = boost::unit_test::data;

namespace {

const RotatingFrame<> turntable{{0.1, -0.3, 0.2}};
const UniformGravity<Guide> weight{{0, -9.81, 0}};

/// Bricard's mechanism: five rods of 1 m and 1 kg along edges of a cube, and six hinges. Such a loop
/// is rigid in general. Here one condition follows from the others, so that the mechanism moves.
struct Bricard {
  static constexpr std::size_t rods = 5;
  std::array<Vector3<double>, rods + 1> corner{
      {{0, 0, 0}, {1, 0, 0}, {1, -1, 0}, {1, -1, 1}, {0, -1, 1}, {0, 0, 1}}};
  std::array<Vector3<double>, rods + 1> axis{
      {{0, 1, 0}, {0, 0, 1}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 0}}};

  /// The rod i in the hinge at a corner, on the rod or the guide whose origin is given.
  [[nodiscard]] BodyDescription rod(std::size_t i, std::size_t at, const std::string& parent,
                                    const Vector3<double>& origin) const {
    BodyDescription body;
    body.name = "rod " + std::to_string(i);
    body.parent = parent;
    body.joint = {.kind = JointKind::revolute, .axis = axis[at], .position = corner[at] - origin};
    const Vector3<double> along = corner[i + 1] - corner[i];
    const Matrix3<double> across = Matrix3<double>::Identity() - along * along.transpose();
    const Vector3<double> middle = (corner[i] + corner[i + 1]) / 2;
    body.inertia = InertiaTensor<Body>::about_centre(
        1, middle - corner[at], across / 12 + 1e-3 * Matrix3<double>::Identity());
    return body;
  }

  /// The mechanism as two open chains, held together at the hinge `cut`.
  [[nodiscard]] BodySystem<RotatingFrame<>> cut_at(std::size_t cut) const {
    std::vector<BodyDescription> bodies;
    for (std::size_t i = 0; i < cut; ++i) {
      bodies.push_back(i == 0 ? rod(0, 0, "guide", Vector3<double>::Zero())
                              : rod(i, i, bodies.back().name, corner[i - 1]));
    }
    for (std::size_t i = rods; i-- > cut;) {
      bodies.push_back(i + 1 == rods ? rod(i, rods, "guide", Vector3<double>::Zero())
                                     : rod(i, i + 1, bodies.back().name, corner[i + 2]));
    }
    constraint::Revolute hinge;
    hinge.at_first = corner[cut] - corner[cut - 1];
    hinge.at_second = corner[cut] - corner[cut + 1];
    hinge.axis_of_first = hinge.axis_of_second = axis[cut];
    return {turntable,
            bodies,
            weight,
            {},
            {{"hinge", "rod " + std::to_string(cut - 1), "rod " + std::to_string(cut), hinge}}};
  }
};

/// The pose of the rod in the middle after 1 s from rest.
template <class System>
BodyKinematics after_a_second(const System& system) {
  const auto run = solve(system, system.rest(), {.output_times = {1}, .tolerance = 1e-10});
  BOOST_TEST(run.report.tolerance_kept);
  auto w = system.workspace();
  for (const ConstraintGap& gap : system.constraint_gaps(run.states[0])) {
    BOOST_TEST(gap.relative <= 1e-14);
  }
  const auto all = kinematics(system, 1, system.to_vector(run.states[0]), w);
  return all.body(system.tree().index("rod 2"));
}

}  // namespace

BOOST_AUTO_TEST_SUITE(linkages)

BOOST_DATA_TEST_CASE(bricard_moves_the_same_wherever_it_is_cut, data::make({2, 3, 4}), cut) {
  const Bricard mechanism;
  const auto wanted = after_a_second(mechanism.cut_at(1));
  const auto system = mechanism.cut_at(static_cast<std::size_t>(cut));
  const auto found = after_a_second(system);
  // The middle of the rod: its origin is one of its ends.
  const Vector3<double> half = (mechanism.corner[3] - mechanism.corner[2]) / 2;
  const auto middle = [&](const BodyKinematics& body, double side) -> Vector3<double> {
    return body.x + side * (body.R * half);
  };
  const Vector3<double> off = middle(found, cut > 2 ? 1 : -1) - middle(wanted, -1);
  BOOST_TEST(off.norm() <= 1e-9);
  BOOST_TEST((found.R - wanted.R).norm() <= 1e-9);
  BOOST_TEST((found.w - wanted.w).norm() <= 1e-8);
  const auto redundant = system.redundant_constraints(system.rest());
  BOOST_TEST_REQUIRE(redundant.size() == 1U);
  BOOST_TEST(redundant[0].redundant == 1);
  BOOST_TEST(redundant[0].conditions == 5);
}

// One of the 5 conditions follows from the others. A run of 0.3 s on one core.
BOOST_AUTO_TEST_CASE(bricard_stays_closed_for_100_s) {
  const auto system = Bricard{}.cut_at(3);
  const auto run = solve(system, system.rest(), {.output_times = linspace(0, 100, 401)});
  BOOST_TEST(run.states.size() == 401U);
  BOOST_TEST(run.report.tolerance_kept);
  BOOST_TEST(greatest_gap(system, run) <= 1e-13);
  BOOST_TEST(greatest_gap_rate(system, run) <= 1e-13);
}

// The rows of the second hinge are rounding of its points and axis, about 1e-17, and must not lock the
// door.
BOOST_DATA_TEST_CASE(door_moves_on_two_hinges, data::xrange(20), seed) {
  const Vector3<double> axis = Vector3<double>(1, 0.1 * (seed + 1), 0.7 - 0.13 * seed).normalized();
  BodyDescription door;
  door.name = "door";
  door.joint = {.kind = JointKind::revolute, .axis = axis};
  const Vector3<double> across = axis.unitOrthogonal();
  door.inertia = InertiaTensor<Body>::about_centre(10, 0.4 * across,
                                                   Vector3<double>(1, 1.2, 1.3).asDiagonal());
  constraint::Revolute hinge;
  hinge.at_first = hinge.at_second = 0.9 * axis;
  hinge.axis_of_first = hinge.axis_of_second = axis;

  const BodySystem<RotatingFrame<>> one{turntable, {door}, weight};
  const BodySystem<RotatingFrame<>> two{
      turntable, {door}, weight, {}, {{"second hinge", "guide", "door", hinge}}};
  const auto redundant = two.redundant_constraints(two.rest());
  BOOST_TEST_REQUIRE(redundant.size() == 1U);
  BOOST_TEST(redundant[0].redundant == 5);
  const auto wanted = solve(one, one.rest(), {.output_times = {1}, .tolerance = 1e-10});
  const auto run = solve(two, two.rest(), {.output_times = {1}, .tolerance = 1e-10});
  BOOST_TEST(run.report.tolerance_kept);
  BOOST_TEST(std::abs(run.states[0].coordinates[0] - wanted.states[0].coordinates[0]) <= 2e-10);
}

// The third condition of the second ball joint follows from the others. Beside the conditions its row
// is small, and must not weigh as much as theirs: radau13 then failed to project its long steps.
BOOST_AUTO_TEST_CASE(two_ball_joints_make_a_hinge) {
  const Vector3<double> axis(0, 0, 1);
  BodyDescription door;
  door.name = "door";
  door.joint = {.kind = JointKind::spherical};
  door.inertia = InertiaTensor<Body>::about_centre(1, {1, 0, 0.1},
                                                   Vector3<double>(0.58, 0.58, 0.2).asDiagonal());
  BodyDescription hinged = door;
  hinged.joint = {.kind = JointKind::revolute, .axis = axis};
  constraint::Point ball;
  ball.at_first = ball.at_second = 0.2 * axis;

  const BodySystem<RotatingFrame<>> hinge{turntable, {hinged}, weight};
  const BodySystem<RotatingFrame<>> balls{
      turntable, {door}, weight, {}, {{"ball", "guide", "door", ball}}};
  const auto wanted = solve(hinge, hinge.rest(), {.output_times = {5}, .tolerance = 1e-10});
  SolveOptions options{.output_times = {5}, .tolerance = 1e-3};
  options.method = Method::radau13;
  const auto run = solve(balls, balls.rest(), options);
  BOOST_TEST(run.report.tolerance_kept);
  const Eigen::VectorXd& q = run.states[0].coordinates;
  const double angle = wanted.states[0].coordinates[0];
  BOOST_TEST(std::abs(std::remainder(2 * std::atan2(q[2], q[3]) - angle, 2 * std::numbers::pi)) <=
             2e-3);
}

BOOST_AUTO_TEST_SUITE_END()
