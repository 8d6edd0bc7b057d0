#include <Eigen/Dense>
#include <boost/test/unit_test.hpp>

#include <cmath>
#include <complex>
#include <numbers>
#include <type_traits>

#include <dynamics/guide/resting.hpp>
#include <dynamics/study/floquet_bodies.hpp>
#include <dynamics/tree/body_system.hpp>

using namespace kreisel;

namespace {

const double speed = 1.3;  // of the drive
const double period = 2 * std::numbers::pi / speed;

/// A couple about x that oscillates in time.
struct Drive {
  template <class N>
  [[nodiscard]] Force<Body, N> operator()(const LoadContext<N>& s) const {
    using std::cos;
    Force<Body, N> result;
    result.value.moment.x() = N(0.3 * cos(N(speed * s.t)));
    return result;
  }
};

BodyDescription wheel(JointKind kind) {
  BodyDescription body;
  body.name = "wheel";
  body.joint = {.kind = kind, .axis = {1, 0, 0}};
  const Matrix3<double> Theta = Vector3<double>(1, 0.7, 0.8).asDiagonal();
  body.inertia = InertiaTensor<Body>::about_centre(1, {0, 0, 0}, Theta);
  return body;
}

/// theta'' + 0.1 theta' + 4 theta = 0.3 cos(speed t)
BodySystem<RestingFrame<>> driven_oscillator() {
  BodyDescription body = wheel(JointKind::revolute);
  body.forces = {{.stiffness = 4, .damping = 0.1}};
  body.loads = {Drive{}};
  return {RestingFrame<>{}, {body}};
}

}  // namespace

BOOST_AUTO_TEST_SUITE(periodic_motions_of_bodies)

// The response of an oscillator to a harmonic drive, in closed form; neighbouring motions decay.
BOOST_AUTO_TEST_CASE(are_found_from_a_nearby_start) {
  const auto system = driven_oscillator();
  const auto found = periodic_motion(system, 0, period, system.to_vector(system.rest()));
  const std::complex<double> i(0, 1);
  const std::complex<double> response = 0.3 / (4 - speed * speed + 0.1 * i * speed);
  BOOST_TEST(found.iterations >= 1);
  BOOST_TEST(found.residual <= 1e-9);
  BOOST_TEST(std::abs(found.start[0] - response.real()) <= 1e-9);
  BOOST_TEST(std::abs(found.start[1] - (i * speed * response).real()) <= 1e-9);
  BOOST_TEST(std::abs(found.period.matrix.determinant() - std::exp(-0.1 * period)) <= 1e-10);
  BOOST_TEST(found.period.error.maxCoeff<Eigen::PropagateNaN>() <= 1e-9);
}

BOOST_AUTO_TEST_CASE(are_missed_with_too_few_steps) {
  const auto system = driven_oscillator();
  const auto start = system.to_vector(system.rest());
  BOOST_CHECK_THROW((void)periodic_motion(system, 0, period, start, {.most_iterations = 1}),
                    ComputationFailed);
}

// A free body in a spherical joint: the volume of neighbouring attitudes and rates is constant.
BOOST_AUTO_TEST_CASE(keep_the_volume_of_their_neighbours) {
  const BodySystem system(RestingFrame<>{}, {wheel(JointKind::spherical)});
  auto s = system.rest();
  s.rates << 1, 2, 3;
  const auto found = tangent_transition(system, 0, system.to_vector(s), 2);
  BOOST_TEST(found.matrix.rows() == 6);
  BOOST_TEST(std::abs(found.matrix.determinant() - 1) <= 1e-9);
}

BOOST_AUTO_TEST_CASE(are_trivial_without_degrees_of_freedom) {
  const BodySystem system(RestingFrame<>{}, {wheel(JointKind::fixed)});
  const auto found = periodic_motion(system, 0, period, system.to_vector(system.rest()));
  BOOST_TEST(found.iterations == 0);
  BOOST_TEST(found.period.matrix.size() == 0);
}

BOOST_AUTO_TEST_SUITE_END()
