#include <boost/test/unit_test.hpp>

#include <cmath>
#include <type_traits>

#include <dynamics/guide/analytic.hpp>
#include <dynamics/guide/harmonic.hpp>
#include <motor/attitude.hpp>

#include <support/near.hpp>

using namespace kreisel;
using test::near;

namespace {

constexpr int order = most_series_order;
constexpr double begin = 0.7;
constexpr double unit = 0.25;

/// A series at a fraction of its unit of time.
template <class Coefficient>
double at(double part, const Coefficient& coefficient) {
  double sum = 0;
  for (int k = order; k >= 0; --k) sum = sum * part + coefficient(k);
  return sum;
}

/// A formula in series against the same in numbers.
template <class Formula>
void hold(const char* what, const Formula& formula) {
  const PowerSeries series = formula(PowerSeries::time(begin, unit, order));
  for (const double part : {0.0, -0.25, 0.125, 0.25}) {
    const double found = at(part, [&](int k) { return series[k]; });
    BOOST_TEST(near(found, formula(begin + part * unit), 10.0, 10, what));
  }
}

/// The series of a guide against its motion.
template <class M>
void hold_guide(const M& guide) {
  const Vector3<double> gravity(1, 2, -9);
  const GuideSeries series = guide.series(begin, unit, order, detail::components(gravity));
  for (const double part : {0.0, -0.25, 0.125, 0.25}) {
    const auto vector_at = [&](const GuideSeries::Coefficients& c) {
      const auto number = [&](auto component) {
        return at(part, [&](int k) { return c[std::size_t(k)].*component; });
      };
      using Three = detail::Components<double>;
      return Vector3<double>(number(&Three::x), number(&Three::y), number(&Three::z));
    };
    const auto now = guide(begin + part * unit);
    BOOST_TEST(near(vector_at(series.u), now.V.value.resultant, 1.0, 20));
    const Vector3<double> felt =
        now.X.value.rotation.transpose() * gravity - now.origin_acceleration();
    BOOST_TEST(near(vector_at(series.g), felt, 10.0, 40));
  }
}

}  // namespace

BOOST_AUTO_TEST_SUITE(analytic_guides)

BOOST_AUTO_TEST_CASE(have_correct_functions) {
  using std::cos, std::cosh, std::exp, std::log, std::pow, std::sin, std::sinh, std::sqrt, std::tan,
      std::tanh;
  hold("sin, cos", [](const auto& t) { return sin(3 * t + 1) * cos(t * t); });
  hold("tan", [](const auto& t) { return tan(t / 2); });
  hold("exp, log", [](const auto& t) { return exp(-t) / log(2 + t); });
  hold("hyperbolic", [](const auto& t) { return sinh(t) - cosh(t) * tanh(t); });
  hold("powers", [](const auto& t) { return sqrt(1 + t) + pow(2 + t, -2.5); });
  hold("sums", [](auto t) {
    t += 2;
    t *= t;
    t -= 1;
    t /= 3 - t;
    return -t;
  });
  hold("a constant", [](const auto& t) { return std::decay_t<decltype(t)>(0.5); });
}

BOOST_AUTO_TEST_CASE(give_the_apparent_field) {
  hold_guide(analytic([](const auto& t) {
    using std::exp;
    using std::sin;
    using T = std::decay_t<decltype(t)>;
    const YawPitchRoll<T> turn{T(0.3 * t), T(0.1 * sin(1.3 * t + 0.4)), T(0.2 * sin(0.9 * t))};
    return Pose<T>{turn.rotation(), Vector3<T>(T(5.0 * t), T(0.5 * sin(0.7 * t)), T(exp(-t)))};
  }));
  const HarmonicSeries<> u{{0.1, -0.2, 0.3},
                           {{{0.3, 0.1, -0.2}, 1.3, 0.4}, {{0.1, 0.5, 0.2}, 2.9, 1}}};
  const HarmonicSeries<> a{{0.1, 0.2, 9}, {{{1, -0.5, 2}, 0.7, 0.2}}};
  const Displacement<Inertial, Guide> X{Pose<>::from(Eigen::Quaterniond(0.9, 0.1, -0.3, 0.2))};
  hold_guide(HarmonicFrame<>(u, a, 0, 2, X));
}

// If nothing moves in a formula, all but the first coefficients are 0.
BOOST_AUTO_TEST_CASE(may_be_at_rest) {
  const auto still = analytic([](const auto& t) {
    using T = std::decay_t<decltype(t)>;
    return Pose<T>{Matrix3<T>::Identity(), Vector3<T>(T(1), T(2), T(3))};
  });
  const GuideSeries series = still.series(0, 1, order, {1, 2, -9});
  BOOST_TEST(series.g[0].z == -9);
  for (std::size_t k = 1; k <= order; ++k) {
    BOOST_TEST(series.g[k].z == 0);
    BOOST_TEST(series.u[k].x == 0);
  }
}

BOOST_AUTO_TEST_SUITE_END()
