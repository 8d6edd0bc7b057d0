#include <Eigen/Dense>
#include <boost/test/unit_test.hpp>

#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

#include <dynamics/study/harmonic_response.hpp>
#include <motor/error.hpp>

using namespace kreisel;
using Complex = std::complex<double>;

namespace {

constexpr double W = 3;
constexpr double period = 2 * std::numbers::pi / W;

/// x' = a(t) x + b(t) u, y = c(t) x + d(t) u at equal parts of the period.
template <class A, class B, class C, class D>
std::vector<LinearPlant> samples(int count, const A& a, const B& b, const C& c, const D& d,
                                 int power = 0) {
  std::vector<LinearPlant> all;
  for (int j = 0; j < count; ++j) {
    const double t = period * j / count;
    LinearPlant plant;
    plant.names = {"x"};
    plant.inputs = {{"u", "N", Actuator{.kind = Actuator::JointForce{0}}}};
    plant.outputs = {{"y", "m", PlantOutput::OfController{0, 0}}};
    plant.A = Eigen::MatrixXd::Constant(1, 1, a(t));
    plant.C = Eigen::MatrixXd::Constant(1, 1, c(t));
    plant.columns = {
        {0, power, Eigen::VectorXd::Constant(1, b(t)), Eigen::VectorXd::Constant(1, d(t))}};
    all.push_back(std::move(plant));
  }
  return all;
}

double zero(double) { return 0; }
double one(double) { return 1; }

}  // namespace

BOOST_AUTO_TEST_SUITE(responses_of_periodic_plants)

BOOST_AUTO_TEST_CASE(are_those_of_constant_plants) {
  const auto all = samples(
      16, [](double) { return -2.0; }, one, one, [](double) { return 0.5; }, 1);
  const PeriodicPlant plant(period, all);
  for (const double w : {0.1, 1.0, 7.0}) {
    const auto H = plant.response(w, 2);
    const Complex wanted = all[0].response(w)(0, 0);
    BOOST_TEST(std::abs(H[2](0, 0) - wanted) < 1e-15 * std::abs(wanted) + 1e-16);
    for (const int k : {0, 1, 3, 4})
      BOOST_TEST(std::abs(H[static_cast<std::size_t>(k)](0, 0)) < 1e-15);
  }
}

// An input through cos(W t) and an output through sin(2 W t), with x' = -2 x between them.
BOOST_AUTO_TEST_CASE(shift_frequencies_by_modulation) {
  const auto all = samples(
      16, [](double) { return -2.0; }, [](double t) { return std::cos(W * t); },
      [](double t) { return std::sin(2 * W * t); }, zero);
  const double w = 0.7;
  const auto H = PeriodicPlant(period, all).response(w, 3);
  const auto x = [&](int k) { return 0.5 / (Complex(2, w + k * W)); };
  const Complex i(0, 1);
  const Complex wanted[] = {-x(-1) / (2.0 * i), 0, -x(1) / (2.0 * i), 0,
                            x(-1) / (2.0 * i),  0, x(1) / (2.0 * i)};
  for (std::size_t k = 0; k < 7; ++k) BOOST_TEST(std::abs(H[k](0, 0) - wanted[k]) < 1e-15);
}

// x' = (-2 + m W sin(W t)) x + u has x = e^(-m cos(W t)) v with v' = -2 v + e^(m cos(W t)) u. The
// Jacobi-Anger expansion e^(m cos a) = sum_n I_n(m) e^(i n a) makes a sum of it.
BOOST_AUTO_TEST_CASE(at_a_modulated_rate_are_bessel_sums) {
  const double m = 0.4, w = 1.3;
  const auto rate = [m](double t) { return -2 + m * W * std::sin(W * t); };
  const auto H = PeriodicPlant(period, samples(64, rate, one, one, zero)).response(w, 3);
  const auto I = [m](int n) { return std::cyl_bessel_i(std::abs(n), m); };
  for (int k = -3; k <= 3; ++k) {
    Complex wanted = 0;
    for (int n = -20; n <= 20; ++n) {
      const double sign = (k - n) % 2 == 0 ? 1 : -1;
      wanted += sign * I(k - n) * I(n) / Complex(2, w + n * W);
    }
    BOOST_TEST(std::abs(H[static_cast<std::size_t>(k + 3)](0, 0) - wanted) < 1e-13);
  }
}

BOOST_AUTO_TEST_CASE(refuse_what_does_not_fit) {
  const auto minus = [](double) { return -2.0; };
  BOOST_CHECK_THROW(PeriodicPlant(0, samples(8, minus, one, one, zero)), InvalidInput);
  BOOST_CHECK_THROW(PeriodicPlant(1, samples(6, minus, one, one, zero)), InvalidInput);
  auto other = samples(8, minus, one, one, zero);
  other[3].names = {"z"};
  BOOST_CHECK_THROW(PeriodicPlant(1, other), InvalidInput);
  const PeriodicPlant plant(1, samples(8, minus, one, one, zero));
  BOOST_CHECK_THROW((void)plant.response(0, 1), InvalidInput);
  BOOST_CHECK_THROW((void)plant.response(1, 3), InvalidInput);
  const PeriodicPlant integrator(period, samples(8, zero, one, one, zero));
  BOOST_CHECK_THROW((void)integrator.response(W, 1), ComputationFailed);
}

BOOST_AUTO_TEST_SUITE_END()
