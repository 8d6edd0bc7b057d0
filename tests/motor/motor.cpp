#include <boost/test/data/monomorphic.hpp>
#include <boost/test/data/test_case.hpp>
#include <boost/test/unit_test.hpp>

#include <type_traits>

#include <motor/motor.hpp>
#include <motor/screw.hpp>

#include <support/near.hpp>
#include <support/sample.hpp>
#include <support/terms.hpp>

using namespace kreisel;
using test::near;
using test::same;
using test::terms;
namespace data = boost::unit_test::data;

static_assert(sizeof(Motor<>) == 6 * sizeof(double));
static_assert(sizeof(Motor<float>) == 6 * sizeof(float));
static_assert(std::is_standard_layout_v<Motor<>> && std::is_trivially_destructible_v<Motor<>>);
static_assert(std::is_aggregate_v<Motor<>>);

BOOST_AUTO_TEST_SUITE(a_motor)

BOOST_AUTO_TEST_CASE(is_zero_by_default) {
  const Motor<> a;
  BOOST_TEST(same(a.resultant, Vector3<double>::Zero()));
  BOOST_TEST(same(a.moment, Vector3<double>::Zero()));
}

BOOST_AUTO_TEST_CASE(adds_and_scales_each_half) {
  const Motor<> a{{1, 2, 3}, {4, 5, 6}};
  const Motor<> b{{10, 20, 30}, {40, 50, 60}};
  BOOST_TEST(same(a + b, Motor<>{{11, 22, 33}, {44, 55, 66}}));
  BOOST_TEST(same(b - a, Motor<>{{9, 18, 27}, {36, 45, 54}}));
  BOOST_TEST(same(-a, Motor<>{{-1, -2, -3}, {-4, -5, -6}}));
  BOOST_TEST(same(2.0 * a, Motor<>{{2, 4, 6}, {8, 10, 12}}));
  BOOST_TEST(same(a * 2.0, 2.0 * a));
  BOOST_TEST(same(a / 2.0, Motor<>{{0.5, 1, 1.5}, {2, 2.5, 3}}));
  Motor<> c = a;
  c += b;
  BOOST_TEST(same(c, a + b));
  c -= b;
  BOOST_TEST(same(c, a));
}

BOOST_AUTO_TEST_CASE(differs_if_one_number_differs) {
  const Motor<> a{{1, 2, 3}, {4, 5, 6}};
  BOOST_TEST(!(a == Motor<>{{1, 2, 3}, {4, 5, 7}}));
  BOOST_TEST(!(a == Motor<>{{1, 0, 3}, {4, 5, 6}}));
}

BOOST_AUTO_TEST_SUITE_END()

BOOST_AUTO_TEST_SUITE(reduction)

// Anchor: a unit spin about z moves the point (1,0,0) along +y.
BOOST_AUTO_TEST_CASE(spin_about_z_moves_x_to_y) {
  const Motor<> spin{{0, 0, 1}, {0, 0, 0}};
  BOOST_TEST(same(spin.reduced_at({1, 0, 0}), Motor<>{{0, 0, 1}, {0, 1, 0}}));
}

// Anchor: a force +y through (1,0,0) has the moment +z about the origin, and none about its own
//         point.
BOOST_AUTO_TEST_CASE(a_force_has_no_moment_at_its_own_point) {
  const Motor<> force{{0, 1, 0}, {0, 0, 1}};
  BOOST_TEST(same(force.reduced_at({1, 0, 0}), Motor<>{{0, 1, 0}, {0, 0, 0}}));
}

BOOST_AUTO_TEST_CASE(leaves_a_couple_unchanged) {
  const Motor<> couple{{0, 0, 0}, {1, 2, 3}};
  BOOST_TEST(same(couple.reduced_at({4, -5, 6}), couple));
}

BOOST_DATA_TEST_CASE(two_steps_equal_one, data::xrange(200u), seed) {
  test::Sample sample(seed);
  const Motor<> a = sample.motor();
  const Vector3<double> p = sample.vector();
  const Vector3<double> q = sample.vector();
  const auto scale = terms(a).reduced_at(terms(p)).reduced_at(terms(q));
  BOOST_TEST(near(a.reduced_at(p).reduced_at(q), a.reduced_at(p + q), scale, 8));
}

BOOST_AUTO_TEST_SUITE_END()

BOOST_AUTO_TEST_SUITE(motor_product)

const Vector3<double> zero(0, 0, 0);
const Vector3<double> x(1, 0, 0);
const Vector3<double> y(0, 1, 0);
const Vector3<double> z(0, 0, 1);

// Anchors: the effect of a spin about z on a line along x and on a couple, and that of a
//          translation.
BOOST_AUTO_TEST_CASE(spin_rotates_motors) {
  BOOST_TEST(same(cross(Motor<>{z, zero}, Motor<>{x, zero}), Motor<>{y, zero}));
  BOOST_TEST(same(cross(Motor<>{z, zero}, Motor<>{zero, x}), Motor<>{zero, y}));
}

BOOST_AUTO_TEST_CASE(translation_moves_lines_but_no_couples) {
  // A line along z through the origin, carried along x: its moment grows by x cross z.
  BOOST_TEST(same(cross(Motor<>{zero, x}, Motor<>{z, zero}), Motor<>{zero, -y}));
  BOOST_TEST(same(cross(Motor<>{zero, x}, Motor<>{zero, z}), Motor<>{zero, zero}));
}

BOOST_DATA_TEST_CASE(is_bilinear, data::xrange(200u), seed) {
  test::Sample sample(seed);
  const Motor<> a = sample.motor();
  const Motor<> b = sample.motor();
  const Motor<> c = sample.motor();
  const double s = sample.number();
  const auto left = cross(test::Terms(s) * terms(a) + terms(b), terms(c));
  const auto right = cross(terms(c), test::Terms(s) * terms(a) + terms(b));
  BOOST_TEST(near(cross(s * a + b, c), s * cross(a, c) + cross(b, c), left, 10));
  BOOST_TEST(near(cross(c, s * a + b), s * cross(c, a) + cross(c, b), right, 10));
}

BOOST_DATA_TEST_CASE(is_skew, data::xrange(200u), seed) {
  test::Sample sample(seed);
  const Motor<> a = sample.motor();
  const Motor<> b = sample.motor();
  const auto scale = cross(terms(a), terms(b));
  BOOST_TEST(near(cross(a, b), -cross(b, a), scale, 8));
  BOOST_TEST(near(cross(a, a), Motor<>{}, cross(terms(a), terms(a)), 4));
}

BOOST_DATA_TEST_CASE(obeys_jacobi, data::xrange(200u), seed) {
  test::Sample sample(seed);
  const Motor<> a = sample.motor();
  const Motor<> b = sample.motor();
  const Motor<> c = sample.motor();
  const Motor<> sum = cross(a, cross(b, c)) + cross(b, cross(c, a)) + cross(c, cross(a, b));
  const auto scale = cross(terms(a), cross(terms(b), terms(c))) +
                     cross(terms(b), cross(terms(c), terms(a))) +
                     cross(terms(c), cross(terms(a), terms(b)));
  BOOST_TEST(near(sum, Motor<>{}, scale, 10));
}

BOOST_DATA_TEST_CASE(is_the_same_at_every_point, data::xrange(200u), seed) {
  test::Sample sample(seed);
  const Motor<> a = sample.motor();
  const Motor<> b = sample.motor();
  const Vector3<double> p = sample.vector();
  const auto scale = cross(terms(a).reduced_at(terms(p)), terms(b).reduced_at(terms(p)));
  BOOST_TEST(near(cross(a.reduced_at(p), b.reduced_at(p)), cross(a, b).reduced_at(p),
                  scale + cross(terms(a), terms(b)).reduced_at(terms(p)), 8));
}

BOOST_DATA_TEST_CASE(is_the_same_in_every_frame, data::xrange(200u), seed) {
  test::Sample sample(seed);
  const Motor<> a = sample.motor();
  const Motor<> b = sample.motor();
  const Pose<> X = sample.pose();
  const auto scale =
      cross(terms(X) * terms(a), terms(X) * terms(b)) + terms(X) * cross(terms(a), terms(b));
  BOOST_TEST(near(cross(X * a, X * b), X * cross(a, b), scale, 16));
}

BOOST_AUTO_TEST_SUITE_END()

BOOST_AUTO_TEST_SUITE(reciprocal_product)

// Anchor: 2 N along a velocity of 3 m/s and 5 N m along 7 rad/s make 41 W.
BOOST_AUTO_TEST_CASE(is_the_power) {
  const Motor<> force{{2, 0, 0}, {0, 5, 0}};
  const Motor<> velocity{{0, 7, 0}, {3, 0, 0}};
  BOOST_TEST(reciprocal(force, velocity) == 41.0);
}

BOOST_DATA_TEST_CASE(is_bilinear_and_symmetric, data::xrange(200u), seed) {
  test::Sample sample(seed);
  const Motor<> a = sample.motor();
  const Motor<> b = sample.motor();
  const Motor<> c = sample.motor();
  const double s = sample.number();
  const auto scale = reciprocal(test::Terms(s) * terms(a) + terms(b), terms(c));
  BOOST_TEST(near(reciprocal(s * a + b, c), s * reciprocal(a, c) + reciprocal(b, c), scale, 16));
  BOOST_TEST(near(reciprocal(a, b), reciprocal(b, a), reciprocal(terms(a), terms(b)), 12));
}

BOOST_DATA_TEST_CASE(is_the_same_at_every_point, data::xrange(200u), seed) {
  test::Sample sample(seed);
  const Motor<> a = sample.motor();
  const Motor<> b = sample.motor();
  const Vector3<double> p = sample.vector();
  const auto scale = reciprocal(terms(a).reduced_at(terms(p)), terms(b).reduced_at(terms(p)));
  BOOST_TEST(near(reciprocal(a.reduced_at(p), b.reduced_at(p)), reciprocal(a, b), scale, 12));
}

BOOST_DATA_TEST_CASE(is_the_same_in_every_frame, data::xrange(200u), seed) {
  test::Sample sample(seed);
  const Motor<> a = sample.motor();
  const Motor<> b = sample.motor();
  const Pose<> X = sample.pose();
  const auto scale = reciprocal(terms(X) * terms(a), terms(X) * terms(b));
  BOOST_TEST(near(reciprocal(X * a, X * b), reciprocal(a, b), scale, 20));
}

// The products of three motors in cyclic order are one number: [A . ] is minus its transposed.
BOOST_DATA_TEST_CASE(commutes_with_the_motor_product, data::xrange(200u), seed) {
  test::Sample sample(seed);
  const Motor<> a = sample.motor();
  const Motor<> b = sample.motor();
  const Motor<> c = sample.motor();
  const auto scale = reciprocal(cross(terms(a), terms(b)), terms(c));
  BOOST_TEST(near(reciprocal(cross(a, b), c), reciprocal(a, cross(b, c)), scale, 12));
  BOOST_TEST(near(reciprocal(b, cross(a, c)), -reciprocal(cross(a, b), c), scale, 12));
  BOOST_TEST(
      near(reciprocal(cross(a, b), b), 0.0, reciprocal(cross(terms(a), terms(b)), terms(b)), 10));
}

BOOST_AUTO_TEST_SUITE_END()

BOOST_AUTO_TEST_SUITE(skew_matrix)

BOOST_AUTO_TEST_CASE(is_the_vector_product) {
  const Vector3<double> a(1, 2, 3);
  const Vector3<double> b(-4, 5, 7);
  BOOST_TEST(same(skew(a) * b, Vector3<double>(-1, -19, 13)));
  BOOST_TEST(same(skew(a), -skew(a).transpose()));
}

BOOST_AUTO_TEST_SUITE_END()
