#include <boost/test/data/monomorphic.hpp>
#include <boost/test/data/test_case.hpp>
#include <boost/test/unit_test.hpp>

#include <type_traits>

#include <motor/frame.hpp>
#include <motor/rate.hpp>

#include <support/near.hpp>
#include <support/sample.hpp>
#include <support/terms.hpp>

using namespace kreisel;
using test::near;
using test::same;
using test::Terms;
using test::terms;
namespace data = boost::unit_test::data;

namespace {

/// Frames of a user: earth, ship, device.
struct Earth {};
struct Ship {};
struct Device {};

template <class X, class Y>
constexpr bool is = std::is_same_v<std::remove_cvref_t<X>, Y>;

// A tag has no cost.
static_assert(sizeof(Velocity<Body, Guide, Body>) == sizeof(Motor<>));
static_assert(sizeof(Momentum<Body>) == sizeof(Motor<>));
static_assert(sizeof(Force<Body>) == sizeof(Motor<>));
static_assert(sizeof(Displacement<Body, Guide>) == sizeof(Pose<>));
static_assert(sizeof(Velocity<Body, Guide, Body, float>) == 6 * sizeof(float));
static_assert(std::is_trivially_destructible_v<Velocity<Body, Guide, Body>>);
static_assert(std::is_standard_layout_v<Velocity<Body, Guide, Body>>);
static_assert(std::is_trivially_copyable_v<Force<Body>> == std::is_trivially_copyable_v<Motor<>>);

}  // namespace

BOOST_AUTO_TEST_SUITE(velocities)

// Anchor: 1 m/s along a ship with 10 m/s is 11 m/s over ground.
BOOST_AUTO_TEST_CASE(join_along_a_chain_of_frames) {
  const Velocity<Device, Ship, Device> walk{{{0, 0, 1}, {1, 0, 0}}};
  const Velocity<Ship, Earth, Device> voyage{{{0, 0, 2}, {10, 0, 0}}};
  const auto sum = walk + voyage;
  static_assert(is<decltype(sum), Velocity<Device, Earth, Device>>);
  BOOST_TEST(same(untagged(sum), Motor<>{{0, 0, 3}, {11, 0, 0}}));
}

BOOST_AUTO_TEST_CASE(swap_their_frames_with_their_sign) {
  const Velocity<Device, Ship, Device> walk{{{0, 0, 1}, {1, 0, 0}}};
  static_assert(is<decltype(-walk), Velocity<Ship, Device, Device>>);
  BOOST_TEST(same((-walk).value, Motor<>{{0, 0, -1}, {-1, 0, 0}}));
}

BOOST_AUTO_TEST_CASE(differ_by_the_rest_of_the_chain) {
  const Velocity<Device, Earth, Device> over_ground{{{0, 0, 3}, {11, 0, 0}}};
  const Velocity<Ship, Earth, Device> voyage{{{0, 0, 2}, {10, 0, 0}}};
  static_assert(is<decltype(over_ground - voyage), Velocity<Device, Ship, Device>>);
  static_assert(is<decltype(voyage - over_ground), Velocity<Ship, Device, Device>>);
  BOOST_TEST(same((over_ground - voyage).value, Motor<>{{0, 0, 1}, {1, 0, 0}}));
}

BOOST_AUTO_TEST_SUITE_END()

BOOST_AUTO_TEST_SUITE(forces_and_momenta)

BOOST_AUTO_TEST_CASE(add_to_their_own_kind) {
  const Force<Body> P{{{1, 2, 3}, {4, 5, 6}}};
  const Momentum<Ship> J{{{1, 0, 0}, {0, 1, 0}}};
  static_assert(is<decltype(P + P), Force<Body>>);
  static_assert(is<decltype(P - P), Force<Body>>);
  static_assert(is<decltype(-P), Force<Body>>);
  static_assert(is<decltype(J + J), Momentum<Ship>>);
  static_assert(is<decltype(J - J), Momentum<Ship>>);
  BOOST_TEST(same((P + P).value, 2.0 * P.value));
  BOOST_TEST(same((P - P).value, Motor<>{}));
  BOOST_TEST(same((-J).value, -J.value));
}

BOOST_AUTO_TEST_CASE(give_their_numbers_by_name_only) {
  const Force<Body> P{{{1, 2, 3}, {4, 5, 6}}};
  BOOST_TEST(same(untagged(P), Motor<>{{1, 2, 3}, {4, 5, 6}}));
  static_assert(!std::is_convertible_v<Force<Body>, Motor<>>);
  static_assert(!std::is_convertible_v<Motor<>, Force<Body>>);
  static_assert(!std::is_convertible_v<Force<Body>, Force<Guide>>);
  static_assert(!std::is_constructible_v<Force<Body>, Momentum<Body>>);
}

BOOST_AUTO_TEST_SUITE_END()

BOOST_AUTO_TEST_SUITE(displacements)

BOOST_DATA_TEST_CASE(join_along_a_chain_of_frames, data::xrange(50u), seed) {
  test::Sample sample(seed);
  const Displacement<Earth, Ship> X_ES{sample.pose()};
  const Displacement<Ship, Device> X_SD{sample.pose()};
  const auto X_ED = X_ES * X_SD;
  static_assert(is<decltype(X_ED), Displacement<Earth, Device>>);
  static_assert(is<decltype(X_ED.inverse()), Displacement<Device, Earth>>);
  const Vector3<double> p = sample.vector();
  const auto scale = terms(X_ES.value).point(terms(X_SD.value).point(terms(p)));
  BOOST_TEST(near(X_ED.point(p), X_ES.point(X_SD.point(p)), scale, 12));
  const Pose<Terms> there_and_back = terms(X_ES.value).inverse() * terms(X_ES.value);
  BOOST_TEST(near(X_ES.inverse().point(X_ES.point(p)), p, there_and_back.point(terms(p)), 16));
}

// Anchor: the ship's origin lies 100 m north (y) of the earth's. The ship moves with 10 m/s along x
//         and turns with 1 rad/s about z. At the earth's origin the ship's frame moves with 10 +
//         100.
BOOST_AUTO_TEST_CASE(rewrite_a_velocity_without_changing_it) {
  const Displacement<Earth, Ship> X_ES{{Matrix3<double>::Identity(), {0, 100, 0}}};
  const Velocity<Ship, Earth, Ship> V{{{0, 0, 1}, {10, 0, 0}}};
  const auto V_E = X_ES * V;
  static_assert(is<decltype(V_E), Velocity<Ship, Earth, Earth>>);
  BOOST_TEST(same(V_E.value, Motor<>{{0, 0, 1}, {110, 0, 0}}));
}

BOOST_AUTO_TEST_CASE(rewrite_every_kind) {
  test::Sample sample(1);
  const Displacement<Earth, Ship> X{sample.pose()};
  const Motor<> a = sample.motor();
  const auto F = X * Force<Ship>{a};
  const auto J = X * Momentum<Ship>{a};
  const auto dJ = X * Rate<Device, Momentum<Ship>>{a};
  const auto ddJ = X * Rate<Inertial, Rate<Device, Force<Ship>>>{a};
  static_assert(is<decltype(F), Force<Earth>>);
  static_assert(is<decltype(J), Momentum<Earth>>);
  static_assert(is<decltype(dJ), Rate<Device, Momentum<Earth>>>);
  static_assert(is<decltype(ddJ), Rate<Inertial, Rate<Device, Force<Earth>>>>);
  BOOST_TEST(same(F.value, X.value * a));
  BOOST_TEST(same(J.value, X.value * a));
  BOOST_TEST(same(dJ.value, X.value * a));
  BOOST_TEST(same(ddJ.value, X.value * a));
}

BOOST_DATA_TEST_CASE(rewrite_sums_term_by_term, data::xrange(50u), seed) {
  test::Sample sample(seed);
  const Displacement<Earth, Ship> X{sample.pose()};
  const Velocity<Device, Ship, Ship> walk{sample.motor()};
  const Velocity<Ship, Earth, Ship> voyage{sample.motor()};
  const auto scale = terms(X.value) * (terms(walk.value) + terms(voyage.value));
  BOOST_TEST(near((X * (walk + voyage)).value, (X * walk + X * voyage).value, scale, 12));
}

BOOST_AUTO_TEST_SUITE_END()

BOOST_AUTO_TEST_SUITE(power_of_a_force)

BOOST_AUTO_TEST_CASE(by_hand) {
  const Force<Body> P{{{2, 0, 0}, {0, 5, 0}}};
  const Velocity<Body, Guide, Body> V{{{0, 7, 0}, {3, 0, 0}}};
  BOOST_TEST(power(P, V) == 41.0);
}

BOOST_DATA_TEST_CASE(is_the_same_in_every_frame, data::xrange(200u), seed) {
  test::Sample sample(seed);
  const Displacement<Earth, Body> X{sample.pose()};
  const Force<Body> P{sample.motor()};
  const Velocity<Body, Guide, Body> V{sample.motor()};
  const Terms scale = reciprocal(terms(X.value) * terms(P.value), terms(X.value) * terms(V.value));
  BOOST_TEST(near(power(X * P, X * V), power(P, V), scale, 20));
}

BOOST_AUTO_TEST_SUITE_END()
