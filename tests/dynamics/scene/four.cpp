#include <boost/test/unit_test.hpp>

#include <limits>

#include <dynamics/scene/four.hpp>
#include <dynamics/scene/structure.hpp>
#include <dynamics/scene/tensor_of_four.hpp>

#include <support/sample.hpp>

using namespace kreisel;
using detail::Four;

namespace {

constexpr double u = std::numeric_limits<double>::epsilon() / 2;

Four four(const Vector3<double>& v) { return {v.x(), v.y(), v.z(), 0}; }

Vector3<double> vector(const Four& a) { return {a[0], a[1], a[2]}; }

Vector3<double> random_vector(test::Sample& sample) {
  return {sample.uniform(-1, 1), sample.uniform(-1, 1), sample.uniform(-1, 1)};
}

/// Of a body with moments from 0.2 to 1 on any axes.
Symmetric3<double> random_tensor(test::Sample& sample) {
  const Matrix3<double> R = Eigen::Quaterniond(sample.uniform(-1, 1), sample.uniform(-1, 1),
                                               sample.uniform(-1, 1), sample.uniform(0.1, 1))
                                .normalized()
                                .toRotationMatrix();
  const Vector3<double> moments(sample.uniform(0.2, 1), sample.uniform(0.2, 1),
                                sample.uniform(0.2, 1));
  return Symmetric3<double>::from(R * moments.asDiagonal() * R.transpose());
}

}  // namespace

BOOST_AUTO_TEST_SUITE(four_numbers)

BOOST_AUTO_TEST_CASE(calculate_each_by_itself) {
  const Four a(1, -2, 3, 5);
  const Four b(0.5, 4, -8, 2);
  Four c = a;
  c += b;
  const Four sum = a + b;
  const Four difference = a - b;
  const Four product = a * b;
  const Four quotient = a / b;
  const Four twice = 2 * a;
  for (int i = 0; i < 4; ++i) {
    BOOST_TEST(sum[i] == a[i] + b[i]);
    BOOST_TEST(c[i] == sum[i]);
    BOOST_TEST(difference[i] == a[i] - b[i]);
    BOOST_TEST(product[i] == a[i] * b[i]);
    BOOST_TEST(quotient[i] == a[i] / b[i]);
    BOOST_TEST(twice[i] == 2 * a[i]);
  }
}

BOOST_AUTO_TEST_CASE(go_round) {
  const Four a(1, 2, 3, 4);
  const Four next = a.next();
  const Four after = a.after();
  BOOST_TEST((next[0] == 2 && next[1] == 3 && next[2] == 1 && next[3] == 4));
  BOOST_TEST((after[0] == 3 && after[1] == 1 && after[2] == 2 && after[3] == 4));
}

BOOST_AUTO_TEST_CASE(take_absent_components_for_0) {
  const Four a = detail::four(detail::Components<double, detail::Absent, double>{2, {}, -1});
  BOOST_TEST((a[0] == 2 && a[1] == 0 && a[2] == -1 && a[3] == 0));
}

BOOST_AUTO_TEST_CASE(have_the_product_of_vectors) {
  test::Sample sample(1);
  for (int i = 0; i < 100; ++i) {
    const Vector3<double> a = random_vector(sample);
    const Vector3<double> b = random_vector(sample);
    const Four product = cross(four(a), four(b));
    BOOST_TEST((vector(product) - a.cross(b)).norm() <= 4 * u * a.norm() * b.norm());
    BOOST_TEST(product[3] == 0);
  }
}

BOOST_AUTO_TEST_SUITE_END()

BOOST_AUTO_TEST_SUITE(tensors_of_four)

template <class Tensor>
void hold_gyroscopic_torque(const Tensor& tensor, const Vector3<double>& w) {
  const Four mixed(w.y() * w.z(), w.z() * w.x(), w.x() * w.y(), 0);
  const Four squares(w.x() * w.x(), w.y() * w.y(), w.z() * w.z(), 0);
  const Four torque = detail::TensorOfFour<Tensor>(tensor).gyroscopic_torque(mixed, squares);
  const Vector3<double> expected =
      detail::vector<double>(tensor.gyroscopic_torque(detail::components(w)));
  BOOST_TEST((vector(torque) - expected).norm() <= 16 * u * w.squaredNorm());
  BOOST_TEST(torque[3] == 0);
}

BOOST_AUTO_TEST_CASE(have_the_same_gyroscopic_torque) {
  test::Sample sample(2);
  for (int i = 0; i < 100; ++i) {
    const Symmetric3<double> T = random_tensor(sample);
    const Vector3<double> w = random_vector(sample);
    hold_gyroscopic_torque(detail::GeneralTensor(T), w);
    hold_gyroscopic_torque(detail::PrincipalTensor<>({T.xx, T.yy, T.zz}), w);
  }
}

BOOST_AUTO_TEST_CASE(know_a_body_of_revolution) {
  const detail::TensorOfFour<detail::PrincipalTensor<>> T(detail::PrincipalTensor<>({2, 2, 3}));
  BOOST_TEST(T.across() == 2);
  BOOST_TEST(T.along() == 3);
}

BOOST_AUTO_TEST_CASE(solve) {
  test::Sample sample(3);
  for (int i = 0; i < 100; ++i) {
    const Symmetric3<double> T = random_tensor(sample);
    const Vector3<double> M = random_vector(sample);
    const detail::TensorOfFour<detail::PrincipalTensor<>> principal(
        detail::PrincipalTensor<>({T.xx, T.yy, T.zz}));
    BOOST_TEST(vector(principal.solve(four(M))) ==
               M.cwiseQuotient(Vector3<double>(T.xx, T.yy, T.zz)));
    const detail::TensorOfFour<detail::GeneralTensor> general{detail::GeneralTensor(T)};
    const Four w = general.solve(four(M));
    // Moments of 0.2 to 1 make at most 5 times as much of what is rounded.
    BOOST_TEST((T.matrix() * vector(w) - M).norm() <= 5 * 8 * u * M.norm());
    BOOST_TEST(w[3] == 0);
  }
}

BOOST_AUTO_TEST_SUITE_END()
