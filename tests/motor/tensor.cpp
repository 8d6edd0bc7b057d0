#include <boost/test/data/monomorphic.hpp>
#include <boost/test/data/test_case.hpp>
#include <boost/test/unit_test.hpp>

#include <motor/displacement.hpp>
#include <motor/tensor.hpp>

#include <support/near.hpp>
#include <support/sample.hpp>
#include <support/six.hpp>
#include <support/terms.hpp>

using namespace kreisel;
using test::Matrix6;
using test::near;
using test::same;
using test::six;
using test::Terms;
using test::terms;
using test::Vector6;
namespace data = boost::unit_test::data;

static_assert(sizeof(MotorTensor<>) == 36 * sizeof(double));

BOOST_AUTO_TEST_SUITE(a_motor_tensor)

// Anchor: every block has its own power of ten, so that a misplaced block is visible.
BOOST_AUTO_TEST_CASE(has_its_blocks_by_name) {
  const Matrix3<double> one = Matrix3<double>::Identity();
  const MotorTensor<> T{1 * one, 10 * one, 100 * one, 1000 * one};
  const Motor<> a{{1, 2, 3}, {4, 5, 6}};
  BOOST_TEST(same(T * a, Motor<>{{41, 52, 63}, {4100, 5200, 6300}}));
}

// Anchor: the paper's (10) acts on (moment; resultant) and gives {momentum; moment}.
BOOST_AUTO_TEST_CASE(is_matrix_10_with_exchanged_columns) {
  Matrix3<double> block;
  block << 1, 2, 3, 4, 5, 6, 7, 8, 9;
  const MotorTensor<> T{block, 2 * block, 3 * block, 4 * block};
  Matrix6<double> paper;
  paper << T.rm, T.rr, T.mm, T.mr;
  Vector6<double> moment_first;
  moment_first << 4, 5, 6, 1, 2, 3;
  BOOST_TEST(same(six(T * Motor<>{{1, 2, 3}, {4, 5, 6}}), (paper * moment_first).eval()));
}

BOOST_DATA_TEST_CASE(applies_as_its_matrix, data::xrange(100u), seed) {
  test::Sample sample(seed);
  const MotorTensor<> T = sample.tensor();
  const Motor<> a = sample.motor();
  const Vector6<Terms> scale = six(terms(T)) * six(terms(a));
  BOOST_TEST(near(six(T * a), (six(T) * six(a)).eval(), scale, 12));
}

BOOST_DATA_TEST_CASE(adds_and_scales_entry_by_entry, data::xrange(50u), seed) {
  test::Sample sample(seed);
  const MotorTensor<> T = sample.tensor();
  const MotorTensor<> U = sample.tensor();
  BOOST_TEST(same(six(T + U), (six(T) + six(U)).eval()));
  BOOST_TEST(same(six(T - U), (six(T) - six(U)).eval()));
  BOOST_TEST(same(six(3.0 * T), (3.0 * six(T)).eval()));
}

BOOST_DATA_TEST_CASE(identity_changes_nothing, data::xrange(20u), seed) {
  test::Sample sample(seed);
  const Motor<> a = sample.motor();
  BOOST_TEST(same(MotorTensor<>::identity() * a, a));
}

BOOST_AUTO_TEST_SUITE_END()

BOOST_AUTO_TEST_SUITE(the_transposed_tensor)

BOOST_DATA_TEST_CASE(changes_sides_of_the_reciprocal_product, data::xrange(200u), seed) {
  test::Sample sample(seed);
  const MotorTensor<> T = sample.tensor();
  const Motor<> a = sample.motor();
  const Motor<> b = sample.motor();
  const auto scale = reciprocal(terms(a), terms(T) * terms(b));
  BOOST_TEST(near(reciprocal(a, T * b), reciprocal(transpose(T) * a, b), scale, 24));
}

// With J the matrix of the reciprocal product: J T^T J.
BOOST_DATA_TEST_CASE(differs_from_the_transposed_matrix, data::xrange(20u), seed) {
  test::Sample sample(seed);
  const MotorTensor<> T = sample.tensor();
  Matrix6<double> J;
  J << Matrix3<double>::Zero(), Matrix3<double>::Identity(), Matrix3<double>::Identity(),
      Matrix3<double>::Zero();
  BOOST_TEST(same(six(transpose(T)), (J * six(T).transpose() * J).eval()));
  BOOST_TEST(same(six(transpose(transpose(T))), six(T)));
}

BOOST_AUTO_TEST_SUITE_END()

BOOST_AUTO_TEST_SUITE(a_dyad)

BOOST_DATA_TEST_CASE(maps_by_the_reciprocal_product, data::xrange(200u), seed) {
  test::Sample sample(seed);
  const Motor<> a = sample.motor();
  const Motor<> b = sample.motor();
  const Motor<> c = sample.motor();
  const auto scale = reciprocal(terms(b), terms(c)) * terms(a);
  BOOST_TEST(near(dyad(a, b) * c, reciprocal(b, c) * a, scale, 12));
  BOOST_TEST(same(six(transpose(dyad(a, b))), six(dyad(b, a))));
}

BOOST_AUTO_TEST_SUITE_END()

BOOST_AUTO_TEST_SUITE(products_of_motor_and_tensor)

// [V T] X = [V (T X)]  and  [T V] X = T [V X].
BOOST_DATA_TEST_CASE(associate, data::xrange(200u), seed) {
  test::Sample sample(seed);
  const MotorTensor<> T = sample.tensor();
  const Motor<> V = sample.motor();
  const Motor<> X = sample.motor();
  BOOST_TEST(near(cross(V, T) * X, cross(V, T * X), cross(terms(V), terms(T) * terms(X)), 20));
  BOOST_TEST(near(cross(T, V) * X, T * cross(V, X), terms(T) * cross(terms(V), terms(X)), 20));
}

BOOST_DATA_TEST_CASE(are_matrix_products, data::xrange(100u), seed) {
  test::Sample sample(seed);
  const MotorTensor<> T = sample.tensor();
  const Motor<> V = sample.motor();
  const auto ad = test::product_matrix(V);
  const auto ad_terms = test::product_matrix(terms(V));
  BOOST_TEST(near(six(cross(V, T)), (ad * six(T)).eval(), (ad_terms * six(terms(T))).eval(), 10));
  BOOST_TEST(near(six(cross(T, V)), (six(T) * ad).eval(), (six(terms(T)) * ad_terms).eval(), 10));
}

// The transposed of [V . ] is -[V . ]; hence that of [V T] is -[T^t V].
BOOST_DATA_TEST_CASE(are_transposes_of_each_other, data::xrange(100u), seed) {
  test::Sample sample(seed);
  const MotorTensor<> T = sample.tensor();
  const Motor<> V = sample.motor();
  const auto scale = six(cross(transpose(terms(T)), terms(V)));
  BOOST_TEST(near(six(transpose(cross(V, T))), (-six(cross(transpose(T), V))).eval(), scale, 10));
}

BOOST_AUTO_TEST_SUITE_END()

BOOST_AUTO_TEST_SUITE(a_displaced_tensor)

// Anchor: a tensor that maps a force along z through the origin to itself, moved to (1, 0, 0).
BOOST_AUTO_TEST_CASE(acts_at_its_new_position) {
  const Motor<> force{{0, 0, 1}, {0, 0, 0}};
  const Motor<> rotation{{0, 0, 0}, {0, 0, 1}};  // reciprocal(rotation, force) = 1
  const Pose<> X{Matrix3<double>::Identity(), {1, 0, 0}};
  const MotorTensor<> moved = X * dyad(force, rotation);
  BOOST_TEST(same(moved * Motor<>{{0, 0, 1}, {0, 0, 0}}, Motor<>{{0, 0, 1}, {0, -1, 0}}));
}

BOOST_DATA_TEST_CASE(commutes_with_displacing_motors, data::xrange(200u), seed) {
  test::Sample sample(seed);
  const MotorTensor<> T = sample.tensor();
  const Motor<> a = sample.motor();
  const Pose<> X = sample.pose();
  const auto scale = (terms(X) * terms(T)) * (terms(X) * terms(a));
  BOOST_TEST(near((X * T) * (X * a), X * (T * a), scale, 60));
}

BOOST_DATA_TEST_CASE(is_a_congruence_of_matrices, data::xrange(100u), seed) {
  test::Sample sample(seed);
  const MotorTensor<> T = sample.tensor();
  const Pose<> X = sample.pose();
  const auto back = test::displacement_matrix(X.inverse());
  const auto back_terms = test::displacement_matrix(terms(X).inverse());
  const Matrix6<Terms> scale = test::displacement_matrix(terms(X)) * six(terms(T)) * back_terms;
  BOOST_TEST(near(six(X * T), (test::displacement_matrix(X) * six(T) * back).eval(), scale, 40));
}

BOOST_DATA_TEST_CASE(dyads_are_displaced_by_factors, data::xrange(100u), seed) {
  test::Sample sample(seed);
  const Motor<> a = sample.motor();
  const Motor<> b = sample.motor();
  const Pose<> X = sample.pose();
  const Matrix6<Terms> scale = six(dyad(terms(X) * terms(a), terms(X) * terms(b))) +
                               six(terms(X) * dyad(terms(a), terms(b)));
  BOOST_TEST(near(six(X * dyad(a, b)), six(dyad(X * a, X * b)), scale, 40));
}

BOOST_AUTO_TEST_SUITE_END()
