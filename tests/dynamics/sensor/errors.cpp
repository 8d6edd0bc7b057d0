// Errors of instruments: each alone, and the noises by their Allan deviations.

#include <boost/test/unit_test.hpp>

#include <cmath>
#include <cstddef>
#include <vector>

#include <dynamics/sensor/errors.hpp>

using namespace kreisel;

namespace {

using Vector = Vector3<double>;

const Vector none = Vector::Zero();

/// The Allan deviation of samples of length dt over clusters of m of them, overlapping.
double allan_deviation(const std::vector<double>& y, std::size_t m) {
  std::vector<double> sum{0};
  for (const double x : y) sum.push_back(sum.back() + x);
  double square = 0;
  const std::size_t count = y.size() - 2 * m + 1;
  for (std::size_t i = 0; i < count; ++i) {
    const double difference = (sum[i + 2 * m] - 2 * sum[i + m] + sum[i]) / static_cast<double>(m);
    square += difference * difference;
  }
  return std::sqrt(square / (2 * static_cast<double>(count)));
}

/// The mean of the deviations of many sensors, all three axes of each.
double mean_deviation(SensorErrors errors, double dt, std::size_t m, int sensors) {
  double square = 0;
  for (int i = 0; i < sensors; ++i) {
    errors.seed = static_cast<std::uint64_t>(i);
    SensorNoise noise(errors, "gyro");
    std::vector<double> axis[3];
    for (std::size_t k = 0; k < 64 * m; ++k) {
      const Vector y = noise.next(dt);
      for (int j = 0; j < 3; ++j) axis[j].push_back(y[j]);
    }
    for (const auto& y : axis) square += std::pow(allan_deviation(y, m), 2) / (3 * sensors);
  }
  return std::sqrt(square);
}

}  // namespace

BOOST_AUTO_TEST_SUITE(errors_of_instruments)

BOOST_AUTO_TEST_CASE(each_by_itself) {
  const Vector truth(1, -2, 3);
  BOOST_TEST((misread({}, truth, none) == truth));
  BOOST_TEST((misread({.scale = {0.5, 0, -1}}, truth, none) == Vector(1.5, -2, 0)));
  BOOST_TEST((misread({.bias = {1, 2, 3}}, truth, none) == Vector(2, 0, 6)));
  BOOST_TEST((misread({.resolution = 0.75}, truth, none) == Vector(0.75, -2.25, 3)));
  BOOST_TEST((misread({.range = 1.5}, truth, none) == Vector(1, -1.5, 1.5)));
  BOOST_TEST((misread({}, truth, {0.25, 0, 0}) == Vector(1.25, -2, 3)));
  // Real axes rotated by a right angle about z: the real x is the nominal y.
  const double quarter = std::acos(-1.0) / 2;
  const Vector turned = misread({.misalignment = {0, 0, quarter}}, truth, none);
  BOOST_TEST((turned - Vector(-2, -1, 3)).norm() < 1e-15);
}

// Scale of the rotated truth, bias unscaled, noise unscaled, rounding of the sum, range last.
BOOST_AUTO_TEST_CASE(one_after_the_other) {
  SensorErrors errors;
  errors.misalignment = {0, 0, std::acos(-1.0) / 2};
  errors.scale = {1, 0, 0};
  errors.bias = {0.3, 0, 0};
  errors.resolution = 0.5;
  errors.range = 3.7;
  BOOST_TEST((misread(errors, {0, 1, 9}, {0.35, 0, 0}) == Vector(2.5, 0, 3.7)));
}

BOOST_AUTO_TEST_CASE(nan_is_not_hidden_by_a_range) {
  BOOST_TEST(std::isnan(misread({.range = 1}, {NAN, 0, 0}, none).x()));
}

// White noise N falls as N / sqrt(tau). 5 % are five standard deviations of the mean here.
BOOST_AUTO_TEST_CASE(white_noise_by_its_allan_deviation) {
  const double N = 0.02, dt = 0.01;
  for (const std::size_t m : {1U, 4U, 16U}) {
    const double found = mean_deviation({.noise = Vector::Constant(N)}, dt, m, 100);
    const double tau = static_cast<double>(m) * dt;
    BOOST_TEST(std::abs(found / (N / std::sqrt(tau)) - 1) < 0.05);
  }
}

// A walk sampled every dt has K sqrt(tau/3) (1 + 1/(2 m^2))^(1/2), the sum of its steps.
BOOST_AUTO_TEST_CASE(drift_by_its_allan_deviation) {
  const double K = 0.003, dt = 0.1;
  for (const std::size_t m : {8U, 32U}) {
    const double found = mean_deviation({.drift = Vector::Constant(K)}, dt, m, 100);
    const double tau = static_cast<double>(m) * dt;
    BOOST_TEST(std::abs(found / (K * std::sqrt(tau / 3)) - 1) < 0.05);
  }
}

// 2 s^2 T/tau (1 - T/(2 tau) (3 - 4 exp(-tau/T) + exp(-2 tau/T))), if dt is short against T.
BOOST_AUTO_TEST_CASE(correlated_noise_by_its_deviation) {
  const double sigma = 0.5, T = 2, dt = 0.05;
  SensorErrors errors;
  errors.correlation = {Vector::Constant(sigma), T};
  for (const std::size_t m : {16U, 80U, 160U}) {
    const double tau = static_cast<double>(m) * dt;
    const double x = tau / T;
    const double square =
        2 * sigma * sigma / x * (1 - (3 - 4 * std::exp(-x) + std::exp(-2 * x)) / (2 * x));
    BOOST_TEST(std::abs(mean_deviation(errors, dt, m, 40) / std::sqrt(square) - 1) < 0.05);
  }
}

BOOST_AUTO_TEST_CASE(numbers_by_seed_name_and_sample) {
  const SensorErrors errors{.noise = Vector::Ones()};
  const auto second = [](SensorErrors e, const char* name) {
    SensorNoise noise(e, name);
    (void)noise.next(1);
    return noise.next(1);
  };
  BOOST_TEST((second(errors, "a") == second(errors, "a")));
  BOOST_TEST((second(errors, "a") != second(errors, "b")));
  SensorErrors other = errors;
  other.seed = 1;
  BOOST_TEST((second(errors, "a") != second(other, "a")));
  // An added drift does not change the white noise.
  other = errors;
  other.drift = {0, 0, 1};
  BOOST_TEST(second(errors, "a").x() == second(other, "a").x());
}

BOOST_AUTO_TEST_SUITE_END()
