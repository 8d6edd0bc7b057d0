// Linear equations of a gyro on a guide at rest against the exact ones: (49), (50) and Foeppl's
// generalised. The order of their error in the angles is tested too.

#include <Eigen/LU>
#include <boost/test/unit_test.hpp>

#include <cmath>
#include <string>
#include <vector>

#include <dynamics/gimbal/foeppl.hpp>
#include <dynamics/gimbal/unsymmetric_rotor.hpp>
#include <dynamics/study/deviation.hpp>

#include <support/json.hpp>
#include <support/worst.hpp>

using namespace kreisel;

namespace {

using test::Json;

const CardanMoments symmetric{{.005, .005, .008}, {.002, .0015, .0028}, {.006, .0045, .005}};
const CardanMoments unsymmetric{{.0055, .0045, .008}, {.002, .0015, .0028}, {.006, .0045, .005}};
const CardanBearings springs{{2}, {1.5}};
constexpr double speed = 50;

const Json& orders() {
  static const Json json =
      test::reference_file("cardan-gyro.json").at("approximation_orders").at("data");
  return json;
}

/// Runs the scene from the reference's starts. Compares the error of the angles with the reference,
/// and its order with k.
template <class Scene>
void errs_as(const std::string& name, const Scene& scene, double k) {
  const Json& expected = orders().at(name);
  double before = 0;
  for (std::size_t i = 0; i < expected.at("eps").size(); ++i) {
    const double eps = expected.at("eps").at(i).get<double>();
    const double reference = expected.at("err").at(i).get<double>();
    const auto off = greatest_deviation(scene, {eps, -0.5 * eps, 5 * eps, 3 * eps}, 0, 0.2);
    const double error = test::worst_of(off[0], off[1]);
    // The reference uses other times.
    BOOST_TEST(std::abs(error / reference - 1) < 0.01, name << ": " << error << ' ' << reference);
    if (before != 0) {
      const double order = std::log2(before / error);
      BOOST_TEST(std::abs(order - k) < (eps > 0.05 ? 0.15 : 0.05), name << ", order " << order);
    }
    before = error;
  }
}

/// (49) as printed: half of the diagonal of dM/dt is missing.
struct Printed : UnsymmetricRotor<> {
  using UnsymmetricRotor<>::UnsymmetricRotor;

  [[nodiscard]] Vector rates(double t, const Vector& y) const {
    auto c = coefficients(t);
    c.damping.diagonal() /= 2;
    const Eigen::Vector2d force = -c.damping * y.tail<2>() - c.stiffness * y.head<2>();
    Vector dy;
    dy << y.tail<2>(), c.mass.inverse() * force;
    return dy;
  }
};

/// Foeppl's equations without the rings, on a gyro that has them.
struct WithoutRings : FoepplGyro<> {
  using FoepplGyro<>::FoepplGyro;

  [[nodiscard]] CardanGyro<RestingFrame<>> exact() const {
    return {symmetric, springs, RestingFrame<>{}};
  }
};

}  // namespace

BOOST_AUTO_TEST_SUITE(linear_equations_of_a_gyro)

BOOST_AUTO_TEST_CASE(foeppls_err_in_third_order) {
  errs_as("(50) Foeppl, massless rings, free spin, u=0",
          FoepplGyro<>({symmetric.rotor}, springs, speed), 3);
  errs_as("(50) Foeppl, massless rings, regulated spin, u=0",
          FoepplGyro({symmetric.rotor}, springs, speed, RegulatedRotor{}), 3);
  errs_as("generalised Foeppl, massive rings, free spin", FoepplGyro<>(symmetric, springs, speed),
          3);
  errs_as("generalised Foeppl, massive rings, regulated spin",
          FoepplGyro(symmetric, springs, speed, RegulatedRotor{}), 3);
}

BOOST_AUTO_TEST_CASE(foeppls_without_rings_err_in_first_order) {
  errs_as("(50) WITHOUT ring terms, massive rings (model error)",
          WithoutRings({symmetric.rotor}, springs, speed), 1);
}

BOOST_AUTO_TEST_CASE(unsymmetric_rotor_errs_in_third_order) {
  errs_as("(49) corrected, massless rings, regulated, asym",
          UnsymmetricRotor<>({unsymmetric.rotor}, springs, speed), 3);
  errs_as("(49) corrected + ring terms, regulated, asym",
          UnsymmetricRotor<>(unsymmetric, springs, speed), 3);
  errs_as("(49) corrected + ring terms, free spin, asym",
          UnsymmetricRotor(unsymmetric, springs, speed, FreeRotor{}), 3);
}

BOOST_AUTO_TEST_CASE(printed_equations_err_in_first_order) {
  errs_as("(49) PRINTED (factor 1/2), massless, regulated, asym",
          Printed({unsymmetric.rotor}, springs, speed), 1);
}

// With A = B both scenes are equal.
BOOST_AUTO_TEST_CASE(symmetric_rotor_gives_foeppls_equations) {
  const UnsymmetricRotor<> one(symmetric, {{2, 0.01}, {1.5, 0.02}}, speed);
  const FoepplGyro<> other(symmetric, {{2, 0.01}, {1.5, 0.02}}, speed);
  const Eigen::Vector4d y(0.1, -0.2, 3, 5);
  const Eigen::Vector4d expected = other.rates(0.0, y);
  BOOST_TEST((one.rates(0.3, y) - expected).norm() < 1e-14 * expected.norm());
}

BOOST_AUTO_TEST_CASE(refuse_invalid_gyros) {
  BOOST_CHECK_THROW(FoepplGyro<>(unsymmetric, springs, speed), InvalidInput);
  BOOST_CHECK_THROW(FoepplGyro<>(symmetric, {{2, 0, 0.1}, {}}, speed), InvalidInput);
  BOOST_CHECK_THROW(UnsymmetricRotor<>(unsymmetric, {{2, 0, 0.1}, {}}, speed), InvalidInput);
  BOOST_CHECK_THROW(UnsymmetricRotor<>({{1, 1, 3}}, springs, speed), InvalidInput);
}

BOOST_AUTO_TEST_SUITE_END()
