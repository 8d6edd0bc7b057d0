// Linear equations, equilibria and Floquet multipliers of constrained systems: the published bicycle,
// closed forms, and the same systems as trees.

#include <Eigen/Core>
#include <Eigen/LU>
#include <boost/test/data/monomorphic.hpp>
#include <boost/test/data/test_case.hpp>
#include <boost/test/unit_test.hpp>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <string>
#include <vector>

#include <dynamics/decompositions.hpp>
#include <dynamics/guide/resting.hpp>
#include <dynamics/guide/rotating.hpp>
#include <dynamics/study/equilibrium.hpp>
#include <dynamics/study/floquet_bodies.hpp>
#include <dynamics/study/linearize.hpp>
#include <dynamics/tree/body_system.hpp>

using namespace kreisel;
namespace data = boost::unit_test::data;
using std::numbers::pi;

namespace {

constexpr double g = 9.81;
const UniformGravity<Guide> weight{{0, 0, -g}};

using Roots = std::vector<std::complex<double>>;

/// The eigenvalues of the independent components, without those that are 0.
template <class System>
Roots roots(const System& system, const Eigen::VectorXd& y) {
  const auto linear = linearize<Guide, Body>(system, 0, y);
  const auto& own = linear.free.independent;
  const Eigen::MatrixXd A = linear.free.bound() ? Eigen::MatrixXd(linear.A(own, own)) : linear.A;
  const Eigen::VectorXcd all = eigenvalues(A);
  Roots result;
  for (const auto& root : all) {
    // Multiple roots 0 of coordinates on which nothing depends come out as small ones.
    if (std::abs(root) > 1e-3) result.push_back(root);
  }
  return result;
}

/// The greatest distance of a wanted root from the nearest one.
double distance(const Roots& found, const Roots& wanted) {
  double worst = found.size() == wanted.size() ? 0 : INFINITY;
  for (const auto& root : wanted) {
    double least = INFINITY;
    for (const auto& other : found) least = std::min(least, std::abs(other - root));
    worst = std::max(worst, least / std::abs(root));
  }
  return worst;
}

InertiaTensor<Body> wheel(double mass, double across, double about_axis) {
  const Matrix3<double> theta = Eigen::Vector3d(across, about_axis, across).asDiagonal();
  return InertiaTensor<Body>::about_centre(mass, {0, 0, 0}, theta);
}

BodyDescription described(const std::string& name, const std::string& parent, const Joint& joint,
                          const InertiaTensor<Body>& inertia) {
  BodyDescription body;
  body.name = name;
  body.parent = parent;
  body.joint = joint;
  body.inertia = inertia;
  return body;
}

Joint hinge(const Vector3<double>& axis, const Vector3<double>& position) {
  return {.kind = JointKind::revolute, .axis = axis, .position = position};
}

constraint::Rolling rolling(double radius) {
  constraint::Rolling contact;
  contact.radius = radius;
  contact.axis = Vector3<double>::UnitY();
  return contact;
}

/// The benchmark bicycle, with x forward and z upward.
BodySystem<RestingFrame<>> bicycle() {
  Matrix3<double> frame;
  frame << 9.2, 0, -2.4, 0, 11, 0, -2.4, 0, 2.8;
  Matrix3<double> fork;
  fork << 0.05892, 0, 0.00756, 0, 0.06, 0, 0.00756, 0, 0.00708;
  const double tilt = pi / 10;
  return {RestingFrame<>{},
          {described("frame", "guide", {.kind = JointKind::free},
                     InertiaTensor<Body>::about_centre(85, {0.3, 0, 0.9}, frame)),
           described("rear", "frame", hinge({0, 1, 0}, {0, 0, 0.3}), wheel(2, 0.0603, 0.12)),
           described("fork", "frame", hinge({-std::sin(tilt), 0, std::cos(tilt)}, {1.1, 0, 0}),
                     InertiaTensor<Body>::about_centre(4, {-0.2, 0, 0.7}, fork)),
           described("front", "fork", hinge({0, 1, 0}, {-0.08, 0, 0.35}), wheel(3, 0.1405, 0.28))},
          weight,
          {},
          {{"rear contact", "guide", "rear", rolling(0.3)},
           {"front contact", "guide", "front", rolling(0.35)}}};
}

/// The state of the bicycle that runs straight ahead at the speed v.
Eigen::VectorXd at_speed(const BodySystem<RestingFrame<>>& system, double v) {
  auto state = system.rest();
  state.rates[3] = v;
  state.rates[6] = v / 0.3;
  state.rates[8] = v / 0.35;
  return system.to_vector(state);
}

/// The roots of the published equations  M q'' + v C q' + (g K_0 + v^2 K_2) q = 0  of lean and steer.
Roots published(double v) {
  Eigen::Matrix2d M, C, K_0, K_2;
  M << 80.81722, 2.31941332208709, 2.31941332208709, 0.29784188199686;
  K_0 << -80.95, -2.59951685249872, -2.59951685249872, -0.80329488458618;
  K_2 << 0, 76.59734589573222, 0, 2.65431523794604;
  C << 0, 33.86641391492494, -0.85035641456978, 1.68540397397560;
  Eigen::Matrix4d A = Eigen::Matrix4d::Zero();
  A.topRightCorner<2, 2>().setIdentity();
  A.bottomLeftCorner<2, 2>() = -M.inverse() * (g * K_0 + v * v * K_2);
  A.bottomRightCorner<2, 2>() = -v * M.inverse() * C;
  const Eigen::VectorXcd all = eigenvalues(A);
  return {all.begin(), all.end()};
}

}  // namespace

BOOST_AUTO_TEST_SUITE(constrained_systems)

// The equations are published with 15 digits; their sensitivity makes 1e-12 of it.
BOOST_DATA_TEST_CASE(bicycle_has_the_published_roots, data::make({0.0, 3.0, 5.0, 10.0}), v) {
  const auto system = bicycle();
  const double off = distance(roots(system, at_speed(system, v)), published(v));
  BOOST_TEST(off <= 1e-11, "v = " << v << ": " << off);
}

BOOST_AUTO_TEST_CASE(bicycle_has_the_digits_of_the_table) {
  const auto system = bicycle();
  const Roots table{-14.07838969279822,
                    {-0.77534188219585, 4.46486771378823},
                    {-0.77534188219585, -4.46486771378823},
                    -0.32286642900409};
  BOOST_TEST(distance(roots(system, at_speed(system, 5)), table) <= 1e-12);
}

// Between the published weave and capsize speeds the bicycle balances itself.
BOOST_AUTO_TEST_CASE(bicycle_balances_between_two_speeds) {
  const auto system = bicycle();
  const auto growth = [&system](double v, bool swings) {
    double greatest = -INFINITY;
    for (const auto& root : roots(system, at_speed(system, v))) {
      if ((std::abs(root.imag()) > 1) == swings) greatest = std::max(greatest, root.real());
    }
    return greatest;
  };
  const double weave = 4.29238253634111, capsize = 6.02426201538837, off = 1e-3;
  BOOST_TEST(std::abs(growth(weave, true)) <= 1e-12);
  BOOST_TEST(growth(weave - off, true) > 1e-4);
  BOOST_TEST(growth(weave + off, true) < -1e-4);
  // Not at the speed itself: roots() leaves out what is below 1e-3.
  const double before = growth(capsize - 0.1, false);
  const double after = growth(capsize + 0.1, false);
  BOOST_TEST(before < -1e-3);
  BOOST_TEST(after > 1e-3);
}

// An upright wheel at the spin n:  (A + m r^2) lambda^2 = m g r - (C + m r^2) C n^2/A.
BOOST_DATA_TEST_CASE(wheel_is_held_upright_by_its_spin, data::make({0.5, 4.0, 9.0}), n) {
  const double m = 1.7, r = 0.4, A = 0.07, C = 0.12;
  const auto slide = [](const Vector3<double>& axis) {
    return Joint{.kind = JointKind::prismatic, .axis = axis};
  };
  const Vector3<double> here = Vector3<double>::Zero();
  // Without spin the axes in which the lean is measured stay the same.
  const BodySystem system(
      RestingFrame<>{},
      {described("x", "guide", slide({1, 0, 0}), {}), described("y", "x", slide({0, 1, 0}), {}),
       described("z", "y", slide({0, 0, 1}), {}),
       described("heading", "z", hinge({0, 0, 1}, here), {}),
       described("lean", "heading", hinge({1, 0, 0}, here), {}),
       described("wheel", "lean", hinge({0, 1, 0}, here), wheel(m, A, C))},
      weight, {}, {{"contact", "guide", "wheel", rolling(r)}});
  auto state = system.rest();
  state.coordinates[2] = r;
  state.rates[0] = r * n;
  state.rates[5] = n;
  const std::complex<double> square =
      (m * g * r - (C + m * r * r) * C * n * n / A) / (A + m * r * r);
  const std::complex<double> root = std::sqrt(square);
  BOOST_TEST(distance(roots(system, system.to_vector(state)), {root, -root}) <= 1e-12);
}

// A free body in a hinge on a turntable has the roots and the multipliers of the body in that joint.
BOOST_AUTO_TEST_CASE(held_body_is_that_of_a_tree) {
  const RotatingFrame<> turntable{{0.3, -0.8, 0.5}, {1, 2, 3}};
  const Vector3<double> axis = Vector3<double>(1, 2, 0.5).normalized();
  Matrix3<double> theta;
  theta << 0.3, 0.02, 0.01, 0.02, 0.35, -0.03, 0.01, -0.03, 0.2;
  const auto inertia = InertiaTensor<Body>::about_centre(2, {0.1, -0.3, 0.4}, theta);
  const Vector3<double> at(0.5, 0.1, -0.2);
  const BodySystem tree(turntable, {described("a", "guide", hinge(axis, at), inertia)}, weight);
  constraint::Revolute joint;
  joint.at_first = at;
  joint.axis_of_first = joint.axis_of_second = axis;
  const BodySystem loose(turntable, {described("a", "guide", {.kind = JointKind::free}, inertia)},
                         weight, {}, {{"hinge", "guide", "a", joint}});
  const auto rest = find_equilibrium(
      tree, 0, tree.to_vector({Eigen::VectorXd::Constant(1, 0.4), Eigen::VectorXd::Zero(1)}));
  auto guess = loose.rest();
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(0.4, axis));
  guess.coordinates.head<4>() = turn.coeffs();
  guess.coordinates.tail<3>() = at;
  const auto held = find_equilibrium(loose, 0, loose.to_vector(guess));
  const double angle = 2 * std::atan2(held.state.head<3>().dot(axis), held.state[3]);
  BOOST_TEST(std::abs(angle - rest.state[0]) <= 1e-13);
  BOOST_TEST(distance(roots(loose, held.state), roots(tree, rest.state)) <= 1e-12);

  const auto period = tangent_transition(tree, 0, rest.state, 2);
  const auto of_held = tangent_transition(loose, 0, held.state, 2);
  const auto free = linearize<Guide, Body>(loose, 0, held.state).free.independent;
  BOOST_TEST_REQUIRE(free.size() == 2U);
  const Eigen::Matrix2d found = of_held.matrix(free, free);
  const Eigen::Matrix2d wanted = period.matrix;
  const double size = wanted.norm();
  BOOST_TEST(std::abs(found.trace() - wanted.trace()) <= 1e-11 * size);
  BOOST_TEST(std::abs(found.determinant() - wanted.determinant()) <= 1e-11 * size * size);

  auto pushed = loose.from_vector(held.state);
  pushed.rates.head<3>() += 1e-3 * axis;
  const auto motion = periodic_motion(loose, 0, 0.3, loose.to_vector(pushed));
  BOOST_TEST((motion.start - held.state).cwiseAbs().maxCoeff() <= 1e-8);
}

// Two cranks and a rod as a parallelogram: the rod is translated.
//
//   omega^2 = (2 m_c g s + m g l) / (2 I + m l^2)
BOOST_AUTO_TEST_CASE(parallelogram_swings_as_its_closed_form) {
  const double l = 1, s = 0.4, m_c = 0.6, I = 0.2, m = 2;
  const Matrix3<double> crank = Eigen::Vector3d(I, I, 0.01).asDiagonal();
  const auto of_crank = InertiaTensor<Body>::about_origin(m_c, {0, 0, -s}, crank);
  const Matrix3<double> rod = Eigen::Vector3d(0.1, 0.7, 0.7).asDiagonal();
  constraint::Revolute joint;
  joint.at_first = {0, 0, -l};
  joint.at_second = {2, 0, 0};
  joint.axis_of_first = joint.axis_of_second = {0, 1, 0};
  const BodySystem system(RestingFrame<>{},
                          {described("left", "guide", hinge({0, 1, 0}, {0, 0, 0}), of_crank),
                           described("right", "guide", hinge({0, 1, 0}, {2, 0, 0}), of_crank),
                           described("rod", "left", hinge({0, 1, 0}, {0, 0, -l}),
                                     InertiaTensor<Body>::about_centre(m, {1, 0, 0}, rod))},
                          weight, {}, {{"loop", "right", "rod", joint}});
  auto guess = system.rest();
  guess.coordinates << 0.3, 0.35, -0.3;
  const auto rest = find_equilibrium(system, 0, system.to_vector(guess));
  BOOST_TEST(rest.state.cwiseAbs().maxCoeff() <= 1e-14);
  const double w = std::sqrt((2 * m_c * g * s + m * g * l) / (2 * I + m * l * l));
  BOOST_TEST(distance(roots(system, rest.state), {{0, w}, {0, -w}}) <= 1e-13);
}

// A drive stays independent: the dependent components are chosen among the others.
BOOST_AUTO_TEST_CASE(given_components_stay_independent) {
  Eigen::MatrixXd slopes = Eigen::MatrixXd::Zero(2, 4);
  slopes(0, 0) = slopes(1, 2) = 5;
  slopes(0, 1) = slopes(1, 3) = -1;
  const auto free = detail::free_directions(slopes, {0, 2}, 2);
  BOOST_TEST(free.dependent == (std::vector<int>{1, 3}), boost::test_tools::per_element());
  BOOST_TEST(free.complete(Eigen::Vector4d(1, 0, 2, 0)).isApprox(Eigen::Vector4d(1, 5, 2, 10)));
}

BOOST_AUTO_TEST_SUITE_END()
