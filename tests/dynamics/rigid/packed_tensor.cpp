#include <boost/test/unit_test.hpp>

#include <cmath>
#include <limits>

#include <dynamics/model/structure.hpp>
#include <dynamics/rigid/packed_tensor.hpp>
#include <motor/simd.hpp>

#include <support/sample.hpp>

using namespace kreisel;
using detail::Vec4d;

namespace {

constexpr double u = std::numeric_limits<double>::epsilon() / 2;

Vector3<double> vector(const Vec4d& a) { return {a[0], a[1], a[2]}; }

/// A tensor of a body with moments from 0.2 to 1 on any axes.
Symmetric3<double> random_tensor(test::Sample& sample) {
  const Matrix3<double> R = sample.rotation();
  const Vector3<double> moments(sample.uniform(0.2, 1), sample.uniform(0.2, 1),
                                sample.uniform(0.2, 1));
  return Symmetric3<double>::from(R * moments.asDiagonal() * R.transpose());
}

}  // namespace

BOOST_AUTO_TEST_SUITE(tensors_of_four)

template <class Tensor>
void hold_gyroscopic_torque(const Tensor& tensor, const Vector3<double>& w) {
  const Vec4d mixed(w.y() * w.z(), w.z() * w.x(), w.x() * w.y(), 0);
  const Vec4d squares(w.x() * w.x(), w.y() * w.y(), w.z() * w.z(), 0);
  const Vec4d torque = detail::PackedTensor<Tensor>(tensor).gyroscopic_torque(mixed, squares);
  const Vector3<double> expected =
      detail::vector<double>(tensor.gyroscopic_torque(detail::components(w)));
  BOOST_TEST((vector(torque) - expected).norm() <= 16 * u * w.squaredNorm());
  BOOST_TEST(torque[3] == 0);
}

BOOST_AUTO_TEST_CASE(have_the_same_gyroscopic_torque) {
  test::Sample sample(2);
  for (int i = 0; i < 100; ++i) {
    const Symmetric3<double> T = random_tensor(sample);
    const Vector3<double> w = sample.vector();
    hold_gyroscopic_torque(detail::GeneralTensor(T), w);
    hold_gyroscopic_torque(detail::PrincipalTensor<>({T.xx, T.yy, T.zz}), w);
  }
}

BOOST_AUTO_TEST_CASE(recognise_a_body_of_revolution) {
  const detail::PackedTensor<detail::PrincipalTensor<>> T(detail::PrincipalTensor<>({2, 2, 3}));
  BOOST_TEST(T.across() == 2);
  BOOST_TEST(T.along() == 3);
}

// By four roundings, with neighbours in the opposite direction, so that their difference changes as
// much.
BOOST_AUTO_TEST_CASE(are_perturbed_by_ulps) {
  const detail::GeneralTensor T({2, 3, 4, 0, 0, 0});
  const detail::GeneralTensor moved = T.perturbed_by_ulps();
  const auto change = [&](const Vector3<double>& w) {
    const auto torque = [&w](const detail::GeneralTensor& tensor) {
      return detail::vector<double>(tensor.gyroscopic_torque(detail::components(w)));
    };
    return (torque(moved) - torque(T)).norm();
  };
  BOOST_TEST(std::abs(change({1, 1, 0}) - 4 * u * (2 + 3)) <= u);
  BOOST_TEST(std::abs(change({0, 1, 1}) - 4 * u * (3 + 4)) <= u);
}

BOOST_AUTO_TEST_CASE(solve_linear_equations) {
  test::Sample sample(3);
  for (int i = 0; i < 100; ++i) {
    const Symmetric3<double> T = random_tensor(sample);
    const Vector3<double> M = sample.vector();
    const detail::PackedTensor<detail::PrincipalTensor<>> principal(
        detail::PrincipalTensor<>({T.xx, T.yy, T.zz}));
    BOOST_TEST(vector(principal.solve(vec4d(detail::components(M)))) ==
               M.cwiseQuotient(Vector3<double>(T.xx, T.yy, T.zz)));
    const detail::PackedTensor<detail::GeneralTensor> general{detail::GeneralTensor(T)};
    const Vec4d w = general.solve(vec4d(detail::components(M)));
    // Moments of 0.2 to 1 amplify rounding at most 5 times.
    BOOST_TEST((T.matrix() * vector(w) - M).norm() <= 5 * 8 * u * M.norm());
    BOOST_TEST(w[3] == 0);
  }
}

BOOST_AUTO_TEST_SUITE_END()
