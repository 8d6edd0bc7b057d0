#include <boost/test/unit_test.hpp>

#include <cmath>
#include <limits>
#include <string>
#include <type_traits>
#include <vector>

#include <dynamics/guide/resting.hpp>
#include <dynamics/tree/body_system.hpp>
#include <dynamics/tree/state_by_name.hpp>

using namespace kreisel;

namespace {

const Eigen::Quaterniond quarter(std::sqrt(0.5), 0, 0, std::sqrt(0.5));  // about z

/// A satellite with a wheel, a boom in two axes, a weight that slides on it, and a plate.
BodySystem<RestingFrame<>> satellite() {
  const auto block = InertiaTensor<Body>::about_centre(
      2, {0, 0, 0}, Matrix3<double>(Vector3<double>(1, 2, 2.5).asDiagonal()));
  const Vector3<double> x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
  return {RestingFrame<>{},
          {{.name = "bus",
            .joint = {.kind = JointKind::free, .position = {0, 0, 7}, .orientation = quarter},
            .inertia = block},
           {.name = "wheel",
            .parent = "bus",
            .joint = {.kind = JointKind::revolute, .axis = z},
            .inertia = block},
           {.name = "boom",
            .parent = "bus",
            .joint = {JointKind::universal, x, y, {1, 0, 0}},
            .inertia = block},
           {.name = "slider",
            .parent = "boom",
            .joint = {.kind = JointKind::prismatic, .axis = x},
            .inertia = block},
           {.name = "ball",
            .parent = "slider",
            .joint = {.kind = JointKind::spherical, .orientation = quarter},
            .inertia = block},
           {.name = "plate", .parent = "bus", .joint = {}, .inertia = block}}};
}

template <class Do>
std::string refusal(const Do& act) {
  try {
    act();
  } catch (const InvalidInput& error) {
    return error.what();
  }
  return "none";
}

}  // namespace

BOOST_AUTO_TEST_SUITE(state_by_name)

BOOST_AUTO_TEST_CASE(gives_back_what_was_set) {
  const auto system = satellite();
  auto start = system.rest();
  StateByName state(system.tree(), start);
  const Eigen::Quaterniond q = Eigen::Quaterniond(3, -1, 0.5, 2).normalized();
  state.set_attitude("bus", q);
  state.set_position("bus", {1, 2, 3});
  state.set_angular_velocity("bus", {4, 5, 6});
  state.set_velocity("bus", {7, 8, 9});
  state.set_angle("wheel", 0.1);
  state.set_rate("wheel", 300);
  state.set_angle("boom", 0.2);
  state.set_angle("boom", 0.3, 1);
  state.set_rate("boom", -1);
  state.set_rate("boom", -2, 1);
  state.set_displacement("slider", 0.4);
  state.set_rate("slider", 0.5);
  state.set_attitude("ball", Eigen::Quaterniond(-2, 0, 0, 0));
  state.set_angular_velocity("ball", {0.1, 0.2, 0.3});
  const auto& read = start;
  const StateByName found(system.tree(), read);
  BOOST_TEST(found.attitude("bus").angularDistance(q) < 1e-15);
  BOOST_TEST((found.position("bus") == Vector3<double>(1, 2, 3)));
  BOOST_TEST((found.angular_velocity("bus") == Vector3<double>(4, 5, 6)));
  BOOST_TEST((found.velocity("bus") == Vector3<double>(7, 8, 9)));
  BOOST_TEST(found.angle("wheel") == 0.1);
  BOOST_TEST(found.rate("wheel") == 300);
  BOOST_TEST(found.angle("boom", 0) == 0.2);
  BOOST_TEST(found.angle("boom", 1) == 0.3);
  BOOST_TEST(found.rate("boom", 0) == -1);
  BOOST_TEST(found.rate("boom", 1) == -2);
  BOOST_TEST(found.displacement("slider") == 0.4);
  BOOST_TEST(found.rate("slider") == 0.5);
  BOOST_TEST(found.attitude("ball").angularDistance(Eigen::Quaterniond::Identity()) < 1e-15);
  BOOST_TEST((found.angular_velocity("ball") == Vector3<double>(0.1, 0.2, 0.3)));
}

// Against where the system puts the bodies: the bus stands on the guide, the wheel on the bus.
BOOST_AUTO_TEST_CASE(means_what_the_system_means) {
  const auto system = satellite();
  auto start = system.rest();
  StateByName state(system.tree(), start);
  const Eigen::Quaterniond q = Eigen::Quaterniond(0.3, 0.9, -0.2, 0.1).normalized();
  state.set_attitude("bus", Eigen::Quaterniond(2 * q.coeffs()));  // of any norm
  state.set_position("bus", {1, -2, 3});
  state.set_angular_velocity("bus", {0.1, 0.2, 0.3});
  state.set_angle("wheel", 0.7);
  BodyWorkspace w = system.workspace();
  const Eigen::VectorXd y = system.to_vector(start);
  const LoadContext<> bus = system.situation(0, y, index_of(system.tree(), "bus"), w);
  const LoadContext<> wheel = system.situation(0, y, index_of(system.tree(), "wheel"), w);
  BOOST_TEST((bus.X.value.rotation - q.toRotationMatrix()).norm() < 1e-15);
  BOOST_TEST((bus.X.value.translation - Vector3<double>(1, -2, 3)).norm() < 1e-15);
  BOOST_TEST((bus.V_rel.value.resultant - Vector3<double>(0.1, 0.2, 0.3)).norm() < 1e-15);
  const Matrix3<double> turned =
      Eigen::AngleAxisd(0.7, Vector3<double>::UnitZ()).toRotationMatrix();
  BOOST_TEST((bus.X.value.rotation.transpose() * wheel.X.value.rotation - turned).norm() < 1e-15);
}

BOOST_AUTO_TEST_CASE(refuses_what_is_not_there) {
  const auto system = satellite();
  auto start = system.rest();
  StateByName state(system.tree(), start);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::string none =
      "no body is named 'weel'; there are 'bus', 'wheel', 'boom', 'slider', "
      "'ball', 'plate'";
  BOOST_TEST(refusal([&] { (void)state.angle("weel"); }) == none);
  BOOST_TEST(refusal([&] { (void)index_of(system.tree(), "weel"); }) == none);
  BOOST_TEST(refusal([&] { (void)state.angle("bus"); }) ==
             "body 'bus' has no angle; its joint has attitude and angular velocity, position and "
             "velocity");
  BOOST_TEST(refusal([&] { (void)state.angle("slider"); }) ==
             "body 'slider' has no angle; its joint has displacement");
  BOOST_TEST(refusal([&] { (void)state.angle("boom", 2); }) ==
             "body 'boom' has no angle of index 2; its joint has angle, angle");
  BOOST_TEST(refusal([&] { (void)state.angle("boom", -1); }) ==
             "body 'boom' has no angle of index -1; its joint has angle, angle");
  BOOST_TEST(refusal([&] { (void)state.rate("plate"); }) ==
             "body 'plate' has no rate of a single coordinate; its joint has no coordinates");
  BOOST_TEST(refusal([&] { (void)state.rate("ball"); }) ==
             "body 'ball' has no rate of a single coordinate; its joint has attitude and angular "
             "velocity");
  BOOST_TEST(refusal([&] { (void)state.position("ball"); }) ==
             "body 'ball' has no position and velocity; its joint has attitude and angular "
             "velocity");
  BOOST_TEST(refusal([&] { state.set_angle("wheel", nan); }) ==
             "body 'wheel': the value to be set is not finite");
  BOOST_TEST(refusal([&] { state.set_attitude("bus", Eigen::Quaterniond(0, 0, 0, 0)); }) ==
             "body 'bus': an attitude of norm 0 turns nothing");
  start.rates.resize(1);
  BOOST_TEST(refusal([&] { StateByName(system.tree(), start); }) ==
             "the state has 15 coordinates and 1 rates, the tree 15 and 13");
}

BOOST_AUTO_TEST_SUITE_END()
