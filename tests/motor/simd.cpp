#include <boost/test/unit_test.hpp>

#include <limits>

#include <motor/simd.hpp>
#include <motor/static_zero.hpp>

#include <support/sample.hpp>

using namespace kreisel;
using detail::Vec4d;

BOOST_AUTO_TEST_SUITE(packed_numbers)

BOOST_AUTO_TEST_CASE(calculate_component_by_component) {
  const Vec4d a(1, -2, 3, 5);
  const Vec4d b(0.5, 4, -8, 2);
  Vec4d c = a;
  c += b;
  const Vec4d sum = a + b;
  const Vec4d difference = a - b;
  const Vec4d product = a * b;
  const Vec4d quotient = a / b;
  const Vec4d twice = 2 * a;
  for (int i = 0; i < 4; ++i) {
    BOOST_TEST(sum[i] == a[i] + b[i]);
    BOOST_TEST(c[i] == sum[i]);
    BOOST_TEST(difference[i] == a[i] - b[i]);
    BOOST_TEST(product[i] == a[i] * b[i]);
    BOOST_TEST(quotient[i] == a[i] / b[i]);
    BOOST_TEST(twice[i] == 2 * a[i]);
  }
}

BOOST_AUTO_TEST_CASE(rotate_cyclically) {
  const Vec4d a(1, 2, 3, 4);
  const Vec4d next = a.next();
  const Vec4d after = a.after();
  BOOST_TEST((next[0] == 2 && next[1] == 3 && next[2] == 1 && next[3] == 4));
  BOOST_TEST((after[0] == 3 && after[1] == 1 && after[2] == 2 && after[3] == 4));
}

BOOST_AUTO_TEST_CASE(take_absent_components_for_0) {
  const Vec4d a = detail::vec4d(detail::Components<double, detail::StaticZero, double>{2, {}, -1});
  BOOST_TEST((a[0] == 2 && a[1] == 0 && a[2] == -1 && a[3] == 0));
}

BOOST_AUTO_TEST_CASE(have_the_product_of_vectors) {
  test::Sample sample(1);
  for (int i = 0; i < 100; ++i) {
    const Vector3<double> a = sample.vector();
    const Vector3<double> b = sample.vector();
    const Vec4d c = cross(vec4d(detail::components(a)), vec4d(detail::components(b)));
    constexpr double u = std::numeric_limits<double>::epsilon() / 2;
    BOOST_TEST((Vector3<double>(c[0], c[1], c[2]) - a.cross(b)).norm() <=
               4 * u * a.norm() * b.norm());
    BOOST_TEST(c[3] == 0);
  }
}

BOOST_AUTO_TEST_CASE(are_loaded_and_stored) {
  alignas(Vec4d) const double numbers[] = {1, -2, 3, -4};
  alignas(Vec4d) double copy[4];
  Vec4d::from(numbers).to(copy);
  for (int i = 0; i < 4; ++i) BOOST_TEST(copy[i] == numbers[i]);
}

BOOST_AUTO_TEST_CASE(are_gathered_in_their_order) {
  const auto hold = []<class N>(const auto& vector, const N&) {
    for (int i = 0; i < vector.size(); ++i) BOOST_TEST(vector[i] == N(i + 1));
  };
  hold(detail::gathered<double>(1), 0.0);
  hold(detail::gathered<double>(1, 2.0), 0.0);
  hold(detail::gathered<double>(1, 2, 3), 0.0);
  hold(detail::gathered<double>(1, 2, 3, 4), 0.0);
  hold(detail::gathered<double>(1, 2, 3, 4, 5, 6, 7), 0.0);
  hold(detail::gathered<double>(1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13), 0.0);
  hold(detail::gathered<long double>(1, 2.0F, 3.0L, 4, 5), 0.0L);
}

BOOST_AUTO_TEST_SUITE_END()
