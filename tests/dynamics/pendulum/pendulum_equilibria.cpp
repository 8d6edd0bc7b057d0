#include <Eigen/Eigenvalues>
#include <boost/test/data/monomorphic.hpp>
#include <boost/test/data/test_case.hpp>
#include <boost/test/unit_test.hpp>

#include <array>
#include <cmath>
#include <complex>
#include <limits>
#include <utility>

#include <dynamics/pendulum/pendulum_cases.hpp>
#include <dynamics/pendulum/pendulum_equilibria.hpp>

#include <support/worst.hpp>

using namespace kreisel;
using namespace kreisel::test::pendulum;
using test::Sample;
namespace data = boost::unit_test::data;

BOOST_AUTO_TEST_SUITE(all_equilibria)

// In z = exp(i phi) the moment is  [(H - iK) z^4 + (F - iE) z^3 + (F + iE) z + (H + iK)]/(2 z^2).
int roots_on_the_unit_circle(double e, double f, double h, double k, bool& clear) {
  using Complex = std::complex<double>;
  const Complex leading(h, -k);
  Eigen::Matrix4cd companion = Eigen::Matrix4cd::Zero();
  companion(1, 0) = companion(2, 1) = companion(3, 2) = 1;
  companion(0, 3) = -Complex(h, k) / leading;
  companion(1, 3) = -Complex(f, e) / leading;
  companion(3, 3) = -Complex(f, -e) / leading;
  const Eigen::Vector4cd roots = companion.eigenvalues();
  int count = 0;
  clear = true;
  for (int i = 0; i < 4; ++i) {
    const double off = std::abs(std::abs(roots[i]) - 1);
    if (off < 1e-9) ++count;
    if (off >= 1e-9 && off < 1e-5) clear = false;  // two roots about to meet
  }
  return count;
}

BOOST_AUTO_TEST_CASE(agree_in_number_with_the_quartic) {
  Sample sample(1);
  int unclear = 0;
  std::array<int, 5> seen{};
  for (int i = 0; i < 20000; ++i) {
    const auto draw = [&] {
      return sample.uniform(-1, 1) * std::pow(10.0, std::floor(sample.uniform(-2, 1)));
    };
    const double e = draw();
    const double f = draw();
    const double h = draw();
    const double k = draw();
    bool clear = false;
    const int count = roots_on_the_unit_circle(e, f, h, k, clear);
    if (!clear) {
      ++unclear;
      continue;
    }
    const PendulumCoefficients<double> c{1, e - 1, f, h, k};
    const auto found = equilibria(c);
    BOOST_TEST_REQUIRE(static_cast<int>(found.size()) == count);
    ++seen[found.size()];
    for (std::size_t j = 0; j < found.size(); ++j) {
      // Stable and unstable ones alternate around the circle.
      BOOST_TEST_REQUIRE(found[j].stable != found[(j + 1) % found.size()].stable);
      BOOST_TEST_REQUIRE(near(c.moment(found[j].angle), 0,
                              std::abs(e) + std::abs(f) + std::abs(h) + std::abs(k), 16));
    }
  }
  BOOST_TEST(unclear < 20);
  BOOST_TEST(seen[2] > 1000);
  BOOST_TEST(seen[4] > 1000);
}

// Against Newton's method in 64 bits, anywhere on the circle and for any size of the terms there.
BOOST_AUTO_TEST_CASE(have_all_the_digits_of_their_terms) {
  using L = long double;
  Sample sample(2);
  double worst = 0;
  for (int i = 0; i < 20000; ++i) {
    const auto draw = [&] {
      return sample.uniform(-1, 1) * std::pow(10.0, std::floor(sample.uniform(-2, 1)));
    };
    const PendulumCoefficients<double> c{1, draw(), draw(), draw(), draw()};
    const L e = 1 + L(c.delta_e);
    for (const auto& found : equilibria(c)) {
      L x = found.angle;
      L slope = 0;
      for (int step = 0; step < 3; ++step) {
        slope = e * std::cos(x) - c.f * std::sin(x) - 2 * c.h * std::sin(2 * x) +
                2 * c.k * std::cos(2 * x);
        x -= (e * std::sin(x) + c.f * std::cos(x) + c.h * std::cos(2 * x) + c.k * std::sin(2 * x)) /
             slope;
      }
      const L terms = std::abs(e * std::sin(x)) + std::abs(c.f * std::cos(x)) +
                      std::abs(c.h * std::cos(2 * x)) + std::abs(c.k * std::sin(2 * x));
      if (std::abs(slope) < 1e-2L * terms) continue;  // almost merged
      const L off = std::abs(found.angle - x) / (std::abs(x) + terms / std::abs(slope));
      worst = test::worst_of(worst, double(off) / u);
    }
  }
  BOOST_TEST_MESSAGE("at most " << worst << " u of what their terms are");
  BOOST_TEST(worst <= 2);
}

// The circle is cut where no equilibrium is. If a cut hits one, the signs at its ends are random.
BOOST_AUTO_TEST_CASE(are_not_lost_where_the_circle_is_cut) {
  for (int i = 0; i < 2000; ++i) {
    const double angle = 0.9 + (i - 1000) * 3e-17;
    const double size = 1 + 0.37 * (i % 7);
    const PendulumCoefficients<double> c{size, size * (std::cos(angle) - 1),
                                         -size * std::sin(angle), 0, 0};
    BOOST_TEST_REQUIRE(equilibria(c).size() == 2U);
  }
}

// (1 - cos(x - a)) (cos(a - b)/2 + cos(x - b)): a double root at a for any b.
BOOST_DATA_TEST_CASE(a_merged_pair_is_reported_once_and_unstable, data::xrange(200u), seed) {
  Sample sample(seed);
  const double a = sample.uniform(-3.1, 3.1);
  const double b = sample.uniform(-3.1, 3.1);
  const double q = std::cos(a - b) / 2;
  if (std::abs(q) < 0.05) return;  // three meet where cos(a - b) = 0
  // Products: cos(x-a) cos(x-b) = cos(a-b)/2 + cos(2x-a-b)/2; the constants cancel.
  const double e = std::sin(b) - q * std::sin(a);
  const double f = std::cos(b) - q * std::cos(a);
  const double h = -std::cos(a + b) / 2;
  const double k = -std::sin(a + b) / 2;
  const auto found = equilibria(PendulumCoefficients<double>{1, e - 1, f, h, k});
  int merged = 0;
  for (const auto& one : found) {
    if (!one.degenerate) continue;
    ++merged;
    BOOST_TEST(!one.stable);
    BOOST_TEST(near(one.angle, a, 1, std::sqrt(64 / u)));  // a double root is known to sqrt(u)
  }
  BOOST_TEST(merged == 1);
  BOOST_TEST(found.size() == 3u);
}

// m = cos 2(x - 0.9): the search cuts the circle at 0.9, and all roots are at the points that halve
// it.
BOOST_AUTO_TEST_CASE(are_no_clusters_where_the_circle_is_halved) {
  const double at = 0.9;
  const auto found =
      equilibria(PendulumCoefficients<double>{0, 0, 0, std::cos(2 * at), std::sin(2 * at)});
  BOOST_TEST_REQUIRE(found.size() == 4u);
  const double turn = 4 * std::acos(0.0);
  for (int i = 0; i < 4; ++i) {
    BOOST_TEST(test::near(found[std::size_t(i)].angle, at + turn * (2 * i - 5) / 8, 1.0, 4));
    BOOST_TEST(!found[std::size_t(i)].degenerate);
  }
}

BOOST_AUTO_TEST_CASE(exist_for_a_single_coefficient) {
  const auto count = [](double e, double f, double h, double k) {
    return equilibria(PendulumCoefficients<double>{e, 0, f, h, k}).size();
  };
  BOOST_TEST(count(1, 0, 0, 0) == 2u);
  BOOST_TEST(count(0, 1, 0, 0) == 2u);
  BOOST_TEST(count(0, 0, 1, 0) == 4u);
  BOOST_TEST(count(0, 0, 0, 1) == 4u);
}

// E sin x + K sin 2x with E = -2K: the hanging position loses its stability (case P9's pitchfork).
BOOST_AUTO_TEST_CASE(are_found_at_the_pitchfork_point) {
  const auto at = [](double k) { return equilibria(PendulumCoefficients<double>{1, 0, 0, 0, k}); };
  const auto merged = at(-0.5);
  BOOST_TEST_REQUIRE(merged.size() == 2u);
  BOOST_TEST(merged[0].angle == 0);
  BOOST_TEST(merged[0].degenerate);
  BOOST_TEST(merged[0].stable);
  BOOST_TEST_REQUIRE(at(-0.499999).size() == 2u);
  BOOST_TEST(at(-0.499999)[0].stable);
  const auto split = at(-0.500001);  // cos(phi) = 1/(2 |k|)
  BOOST_TEST_REQUIRE(split.size() == 4u);
  BOOST_TEST(split[0].stable);
  BOOST_TEST(!split[1].stable);
  BOOST_TEST(near(split[2].angle, std::acos(1 / 1.000002), 1, 1 / std::sqrt(u) / 100));
}

BOOST_AUTO_TEST_CASE(merged_pairs_of_exact_numbers_are_found) {
  // a = 0, b = 0: (1 - cos x)(1/2 + cos x) = cos(x)/2 - cos(2x)/2, roots 0 (double), +-2 pi/3.
  const auto found = equilibria(PendulumCoefficients<double>{0, 0, 0.5, -0.5, 0});
  BOOST_TEST_REQUIRE(found.size() == 3u);
  BOOST_TEST(found[1].angle == 0);
  BOOST_TEST(found[1].degenerate);
  BOOST_TEST(!found[1].stable);
  BOOST_TEST(near(found[2].angle, 2 * std::acos(-1.0) / 3, 2, 2));
}

BOOST_AUTO_TEST_CASE(positive_one_of_two_equally_near_is_used) {
  const auto found = equilibria(PendulumCoefficients<double>{1, 0, 0, 0, -0.9});
  BOOST_TEST_REQUIRE(found.size() == 4u);
  BOOST_TEST(nearest_stable(found).angle > 0);
  BOOST_TEST(found.back().angle == std::acos(-1.0));
}

BOOST_AUTO_TEST_CASE(tiny_angles_keep_their_digits) {
  for (const double f : {1e-3, 1e-10, 1e-100, 1e-300}) {
    const auto found = equilibria(PendulumCoefficients<double>{1, 0, -f, 0, 0});
    BOOST_TEST_REQUIRE(found.size() == 2u);
    BOOST_TEST(near(nearest_stable(found).angle, std::atan(f), f, 4));
  }
}

BOOST_AUTO_TEST_CASE(terms_that_cancel_at_0_give_exactly_0) {
  for (const double f : {0.3, -0.7, 1e-10}) {
    const auto found = equilibria(PendulumCoefficients<double>{1, 0, f, -f, 0.2});
    BOOST_TEST(nearest_stable(found).angle == 0);
  }
}

// F = H: they cancel at pi, not at 0, and the root is near pi.
BOOST_AUTO_TEST_CASE(terms_that_cancel_at_pi_give_exactly_pi) {
  for (const double f : {1e-3, -1e-3, 1e-10}) {
    const PendulumCoefficients<double> c{1, 0, f, f, 0};
    const auto found = equilibria(c);
    BOOST_TEST_REQUIRE(found.size() == 2u);
    BOOST_TEST(test::near(nearest_stable(found).angle, -2 * f, std::abs(f), 16 + 12 * f * f / u));
    BOOST_TEST(found.back().angle == std::acos(-1.0));
  }
}

BOOST_AUTO_TEST_CASE(a_root_costs_as_little_as_newtons_method) {
  int looks = 0;
  const auto look = [&looks](double x) {
    ++looks;
    return std::pair(std::cos(x) < 0, x + std::cos(x) / std::sin(x));
  };
  const double root = detail::root_in_bracket(0.0, 3.0, 1.0, 0.0, look);
  BOOST_TEST(test::near(root, std::acos(0.0), 1.0, 1));
  BOOST_TEST(looks <= 6);
  // Starts from which Newton's method leaves the bracket or oscillates.
  BOOST_TEST(
      test::near(detail::root_in_bracket(-1.0, 3.1, 3.1, 0.0, look), std::acos(0.0), 1.0, 1));
  looks = 0;
  const auto to_and_fro = [&looks](double x) {
    ++looks;
    return std::pair(x > 0.3, 0.6 - x);
  };
  BOOST_TEST(test::near(detail::root_in_bracket(-1.0, 1.0, 0.9, 0.0, to_and_fro), 0.3, 0.3, 4));
  BOOST_TEST(looks <= 120);
  // As accurate as requested.
  looks = 0;
  BOOST_TEST(std::abs(detail::root_in_bracket(0.0, 3.0, 1.0, 1e-3, look) - std::acos(0.0)) < 1e-6);
  BOOST_TEST(looks <= 4);
}

BOOST_AUTO_TEST_CASE(no_moment_at_all_is_refused) {
  BOOST_TEST(message_of([] { (void)equilibria(PendulumCoefficients<double>{}); }) ==
             "every angle is an equilibrium: E, F, H and K are all 0");
  const double nan = std::numeric_limits<double>::quiet_NaN();
  BOOST_CHECK_THROW((void)equilibria(PendulumCoefficients<double>{1, 0, nan, 0, 0}), InvalidInput);
}

BOOST_AUTO_TEST_SUITE_END()
