#include <boost/test/unit_test.hpp>

#include <cmath>
#include <string_view>

#include <dynamics/guide/chain.hpp>
#include <dynamics/guide/earth_frame.hpp>
#include <dynamics/guide/resting.hpp>
#include <dynamics/load/earth_gravitation.hpp>
#include <dynamics/load/oblate_gravitation.hpp>
#include <dynamics/rigid/fixed_point_body.hpp>
#include <dynamics/rigid/free_body.hpp>
#include <dynamics/step/integrator.hpp>
#include <dynamics/study/linearize.hpp>
#include <motor/attitude.hpp>

#include <support/near.hpp>

using namespace kreisel;
using test::near;

namespace {

const InertiaTensor<Body> ball =
    InertiaTensor<Body>::about_centre(3, {0, 0, 0}, Matrix3<double>::Identity());

const EarthSite<double> munich{.latitude = 48.1, .azimuth = 90, .height = 520};

}  // namespace

BOOST_AUTO_TEST_SUITE(the_earth_as_a_guide)

// Gravitation as a load and the centrifugal part of the guide's motion add up to normal gravity,
// along the guide's x axis.
BOOST_AUTO_TEST_CASE(gives_a_body_at_rest_its_weight) {
  const FreeBody body(ball, earth_frame(munich), EarthGravitation{});
  const auto a = body.acceleration(body.situation(1234.5, {})).value.moment;
  BOOST_TEST(near(a, normal_gravity(munich).guide.effective_gravity, 10.0, 16));
}

// It rotates with the site's rotation on the guide's axes, with the same signs of up, north and
// east.
BOOST_AUTO_TEST_CASE(turns_as_the_pendulum_guide) {
  const auto motion = earth_frame(munich)(0);
  BOOST_TEST(
      near(motion.V.value.resultant, normal_gravity(munich).guide.angular_velocity, 1e-4, 4));
  BOOST_TEST(motion.dV.value.resultant == Vector3<double>(0, 0, 0));
}

// Eastward deflection of a fall, u g t^3 cos(latitude) / 3 to leading order, and a small southward
// one.
BOOST_AUTO_TEST_CASE(deflects_a_falling_body_to_the_east) {
  const FreeBody body(ball, earth_frame(munich), EarthGravitation{});
  const double t = 4;
  const auto end = Integrator(body, 0, {}).to(t);  // x down, y north, z east
  const double g = normal_gravity(munich).magnitude;
  const double expected =
      munich.rotation_rate * g * std::cos(48.1 * std::acos(-1.0) / 180) * t * t * t / 3;
  BOOST_TEST(near(end.position.z(), expected, expected, 1e-3 / test::u<>));
  BOOST_TEST(end.position.y() < 0);
  BOOST_TEST(std::abs(end.position.y()) < 1e-3 * expected);
  BOOST_TEST(near(end.position.x(), g * t * t / 2, 100.0, 1e-5 / test::u<>));
}

// The same fall, observed from a frame that does not rotate.
BOOST_AUTO_TEST_CASE(shows_the_same_fall_as_the_inertial_frame) {
  const auto earth = earth_frame(munich);
  const FreeBody on_earth(ball, earth, EarthGravitation{});
  const FreeBody in_space(ball, RestingFrame<>{}, EarthGravitation{});
  const auto start = earth(0);
  decltype(in_space)::State from;
  from.attitude = Eigen::Quaterniond(start.X.value.rotation);
  from.position = start.X.value.translation;
  from.velocity.value = start.V.value;
  const auto a = Integrator(on_earth, 0, {}).to(60);
  const auto b = Integrator(in_space, 0, from).to(60);
  // Twice the last digit of an earth radius, accumulated over the steps.
  BOOST_TEST(near(earth(60).X.point(a.position), b.position, 6.4e6, 16));
}

BOOST_AUTO_TEST_CASE(keeps_the_energy_of_an_orbit) {
  const FreeBody body(ball, RestingFrame<>{}, EarthGravitation{});
  decltype(body)::State start;
  start.position = {7e6, 0, 1e6};
  start.velocity.value = {{0, 0, 0.001}, {0, 5000, 5500}};
  const auto energy = [&](const auto& state) {
    const auto r = body.body_outputs(0, state);
    return r.kinetic_energy + r.potential_energy;
  };
  const double e0 = energy(start);
  BOOST_TEST(near(energy(Integrator(body, 0, start).to(6000)), e0, std::abs(e0), 200));
}

// In linear equations: the free-air gradient including the guide's centrifugal part, and half of it
// towards the plumb line on either side.
BOOST_AUTO_TEST_CASE(has_the_free_air_gradient) {
  const FreeBody body(ball, earth_frame(munich), EarthGravitation{});
  const auto linear = linearize<Guide, Body>(body, 0, body.to_vector({}));
  const auto at = [&](Eigen::Index k) { return linear.A(9 + k, 3 + k); };
  BOOST_TEST(std::abs(at(0) - 3.086e-6) < 3e-9);
  BOOST_TEST(std::abs(at(1) + 1.54e-6) < 1e-8);
  BOOST_TEST(std::abs(at(2) + 1.54e-6) < 1e-8);
}

// J2 describes the ellipsoid's field except for terms from J4 on: 3 parts in a million.
BOOST_AUTO_TEST_CASE(field_is_nearly_that_of_j2) {
  for (const double latitude : {0.0, 30.0, 48.1, 90.0}) {
    const auto X = earth_frame(EarthSite<double>{.latitude = latitude})(0).X;
    const Vector3<double> p = X.value.translation;
    const Vector3<double> exact = detail::gravitation(p);
    BOOST_TEST((OblateGravitation<>{}(p)-exact).norm() < 2e-4);
    BOOST_TEST((OblateGravitation<>{.j2 = 0}(p)-exact).norm() > 5e-3);
  }
}

BOOST_AUTO_TEST_SUITE_END()
