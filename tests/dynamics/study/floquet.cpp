// Floquet's theory against the references: multipliers, boundaries, the closed form.

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <boost/test/unit_test.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstddef>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include <dynamics/gimbal/unsymmetric_rotor.hpp>
#include <dynamics/study/floquet.hpp>
#include <dynamics/study/stability_boundaries.hpp>

#include <support/json.hpp>
#include <support/worst.hpp>

using namespace kreisel;
using test::Json;
using test::number;

namespace {

/// Accurate enough for boundaries: the multipliers still err by 1e-15 only.
constexpr Accuracy quick{.relative = 1e-12};

const Json& reference() {
  static const Json json = test::reference_file("floquet.json");
  return json;
}

double parameter(const Json& c, const char* name) {
  const Json& all = c.at("params");
  return all.contains(name) ? number(all.at(name)) : 0;
}

UnsymmetricRotor<> rotor_of(const Json& c, double speed) {
  const CardanMoments moments{{parameter(c, "A"), parameter(c, "B"), parameter(c, "C")},
                              {0, parameter(c, "my"), parameter(c, "my")},
                              {parameter(c, "mx"), parameter(c, "mx"), 0}};
  return {moments, {{parameter(c, "ca")}, {parameter(c, "cb")}}, speed};
}

/// (49) as printed: half of the diagonal of dM/dt is missing.
struct Printed {
  UnsymmetricRotor<> corrected;

  [[nodiscard]] double period() const { return corrected.period(); }
  [[nodiscard]] Eigen::Matrix4d state_matrix(double t) const {
    auto c = corrected.coefficients(t);
    c.damping.diagonal() /= 2;
    Eigen::Matrix4d A = corrected.state_matrix(t);
    A.bottomRightCorner<2, 2>() = -c.mass.inverse() * c.damping;
    return A;
  }
};

/// The same in the rotor's axes, xi = R(-phi) x, w = R(-phi) x', without rings: the moments are
/// constant, the springs turn. It accepts impossible moments too, because the reference has some.
///
///   xi' = w - Omega J xi,   Theta w' = -Omega (J Theta - C J) w - R(-phi) K R(phi) xi
PairedMultipliers in_rotor_axes(const Json& c, double speed) {
  const Eigen::Matrix2d K = Eigen::Vector2d(parameter(c, "ca"), parameter(c, "cb")).asDiagonal();
  const Eigen::Matrix2d theta = Eigen::Vector2d(parameter(c, "A"), parameter(c, "B")).asDiagonal();
  const double C = parameter(c, "C");
  Eigen::Matrix2d J;
  J << 0, -1, 1, 0;
  const auto A = [&](double t) {
    const Eigen::Matrix2d R = Eigen::Rotation2Dd(speed * t).toRotationMatrix();
    Eigen::Matrix4d result;
    result << -speed * J, Eigen::Matrix2d::Identity(), -theta.inverse() * (R.transpose() * K * R),
        -theta.inverse() * speed * (J * theta - C * J);
    return result;
  };
  Transition<4> half_turn = linear_transition<4>(A, 0, std::numbers::pi / speed, quick);
  half_turn.matrix *= -1;  // R(pi)
  return PairedMultipliers::of(half_turn);
}

/// The greatest distance of a multiplier of the reference from the nearest one here.
template <class Multipliers>
double distance(const Json& expected, const Multipliers& multipliers) {
  double worst = 0;
  for (const Json& pair : expected) {
    const std::complex<double> l(number(pair.at(0)), number(pair.at(1)));
    double nearest = std::numeric_limits<double>::infinity();
    for (const auto& m : multipliers) nearest = std::min(nearest, std::abs(m - l));
    worst = test::worst_of(worst, nearest);
  }
  return worst;
}

}  // namespace

BOOST_AUTO_TEST_SUITE(multipliers_over_a_period)

BOOST_AUTO_TEST_CASE(agree_with_the_reference) {
  double worst = 0;
  int points = 0;
  for (const Json& c : reference().at("points")) {
    const UnsymmetricRotor<> rotor = rotor_of(c, parameter(c, "Om"));
    const bool printed = c.at("printed").get<bool>();
    const PairedMultipliers m =
        printed ? paired_multipliers(Printed{rotor}) : paired_multipliers(rotor);
    const std::string name = c.at("name").get<std::string>() + (printed ? ", printed" : "");
    if (c.contains("a1")) {
      // The reported errors are bounds, and not excessive ones.
      BOOST_TEST(std::abs(m.a_1 - number(c.at("a1"))) <= m.a_1_error, name);
      BOOST_TEST(std::abs(m.a_2 - number(c.at("a2"))) <= m.a_2_error, name);
      BOOST_TEST(m.a_1_error + m.a_2_error < 1e-10, name);
    }
    const double off = distance(c.at("multipliers"), m.multipliers());
    worst = test::worst_of(worst, off);
    BOOST_TEST(off < 1e-11, name << ": " << off);
    BOOST_TEST(std::abs(m.growth() - number(c.at("rho"))) < 1e-11, name << ' ' << m.growth());
    const auto verdict = c.at("stable").get<bool>() ? Stability::stable : Stability::unstable;
    BOOST_TEST((m.verdict() == verdict), name);
    ++points;
  }
  BOOST_TEST(points == 16);
  BOOST_TEST_MESSAGE("multipliers off by " << worst);
}

// The same numbers from the eigenvalues of the transition matrix.
BOOST_AUTO_TEST_CASE(are_the_eigenvalues_of_the_transition_matrix) {
  for (const Json& c : reference().at("points")) {
    if (c.at("printed").get<bool>()) continue;
    const UnsymmetricRotor<> rotor = rotor_of(c, parameter(c, "Om"));
    const auto A = [&](double t) { return rotor.state_matrix(t); };
    const auto l = floquet_multipliers(linear_transition<4>(A, 0, rotor.period()));
    BOOST_TEST(distance(c.at("multipliers"), l) < 1e-9);
  }
}

BOOST_AUTO_TEST_CASE(are_the_same_in_the_axes_of_the_rotor) {
  for (const Json& c : reference().at("points")) {
    if (c.at("printed").get<bool>() || parameter(c, "mx") != 0) continue;
    const PairedMultipliers m = in_rotor_axes(c, parameter(c, "Om"));
    BOOST_TEST(distance(c.at("multipliers"), m.multipliers()) < 1e-11);
  }
}

// The exact gyro about its steady rotation, by its variational equations in dual numbers. Four of
// its six multipliers are the linear rotor's, the two of phi are 1.
BOOST_AUTO_TEST_CASE(agree_with_the_exact_gyro) {
  for (const Json& c : reference().at("points")) {
    if (c.at("printed").get<bool>()) continue;
    const UnsymmetricRotor<> rotor = rotor_of(c, parameter(c, "Om"));
    const auto y = rotor.exact().to_vector(rotor.exact_state({}));
    const Transition<6> turn = transition(rotor.exact(), 0, y, rotor.period());
    BOOST_TEST(std::abs(turn.state[2] - std::numbers::pi) < 1e-13);
    Transition<4> rings;
    const std::array<int, 4> kept = {0, 1, 3, 4};
    for (int i = 0; i < 4; ++i) {
      for (int j = 0; j < 4; ++j) {
        const int row = kept[std::size_t(i)];
        const int column = kept[std::size_t(j)];
        rings.matrix(i, j) = turn.matrix(row, column);
        rings.error(i, j) = turn.error(row, column);
      }
    }
    const PairedMultipliers m = PairedMultipliers::of(rings);
    const double off = distance(c.at("multipliers"), m.multipliers());
    BOOST_TEST(off < 1e-11, c.at("name") << ": " << off);
    const auto all = floquet_multipliers(turn);
    int ones = 0;
    for (const auto& l : all) ones += std::abs(l - 1.0) < 1e-6 ? 1 : 0;
    BOOST_TEST(ones == 2);
  }
}

BOOST_AUTO_TEST_CASE(have_a_closed_form_with_equal_springs) {
  const Vector3<double> J(1.1, 0.9, 0.5);
  for (const double speed : {0.6, 1.2, 1.35, 1.4, 1.5, 1.7, 3.0}) {
    const double k_1 = 1 + speed * speed * (J.z() - J.y());
    const double k_2 = 1 + speed * speed * (J.z() - J.x());
    const double spread = J.x() + J.y() - J.z();
    const double b =
        (J.x() * k_2 + J.y() * k_1 + speed * speed * spread * spread) / (J.x() * J.y());
    const double c = k_1 * k_2 / (J.x() * J.y());
    const double q = -(b + std::copysign(std::sqrt(b * b - 4 * c), b)) / 2;
    const UnsymmetricRotor<> rotor({J}, {{1}, {1}}, speed);
    const auto l = paired_multipliers(rotor).multipliers();
    for (const double s2 : {q, c / q}) {
      const std::complex<double> s = std::sqrt(std::complex<double>(s2));
      const std::complex<double> expected = -std::exp(s * rotor.period());
      double nearest = 1;
      for (const auto& m : l) nearest = std::min(nearest, std::abs(m - expected));
      BOOST_TEST(nearest < 1e-12, speed << ": " << nearest);
    }
    const auto range = EqualSpringsRange::of(J, 1);
    const bool unstable = range.begin < speed && speed < range.end;
    BOOST_TEST((paired_multipliers(rotor).verdict() ==
                (unstable ? Stability::unstable : Stability::stable)));
  }
}

// On the boundary the verdict is undecided.
BOOST_AUTO_TEST_CASE(are_undecided_on_the_boundary) {
  const Vector3<double> J(1.1, 0.9, 0.5);
  const double begin = EqualSpringsRange::of(J, 1).begin;
  const auto verdict = [&](double speed) {
    return paired_multipliers(UnsymmetricRotor<>({J}, {{1}, {1}}, speed)).verdict();
  };
  BOOST_TEST((verdict(begin) == Stability::undecided));
  BOOST_TEST((verdict(begin * (1 - 1e-9)) == Stability::stable));
  BOOST_TEST((verdict(begin * (1 + 1e-9)) == Stability::unstable));
}

/// The multipliers with the given sums z = l + 1/l.
PairedMultipliers with_sums(double z_1, double z_2) {
  return {z_1 + z_2, z_1 * z_2 + 2, 1e-14, 1e-14};
}

// A pair lies on the circle if its sum is real and within (-2, 2).
BOOST_AUTO_TEST_CASE(are_stable_on_the_circle_only) {
  struct {
    double z_1, z_2;
    Stability verdict;
  } const cases[] = {{0.5, -0.5, Stability::stable}, {3, -0.5, Stability::unstable},
                     {-3, 0.5, Stability::unstable}, {3, 4, Stability::unstable},
                     {-3, -4, Stability::unstable},  {3, 3, Stability::unstable},
                     {1, 1, Stability::undecided},   {2, 0, Stability::undecided},
                     {0, 0, Stability::undecided},   {3, -3, Stability::unstable}};
  for (const auto& [z_1, z_2, verdict] : cases) {
    const PairedMultipliers m = with_sums(z_1, z_2);
    BOOST_TEST((m.verdict() == verdict), z_1 << ", " << z_2);
    const auto l = m.multipliers();
    // If both sums are one, they are the remainder of the square root of rounding.
    const double off = std::min(std::abs(l[0] + l[1] - z_1) + std::abs(l[2] + l[3] - z_2),
                                std::abs(l[0] + l[1] - z_2) + std::abs(l[2] + l[3] - z_1));
    BOOST_TEST(off <= (z_1 == z_2 ? 1e-7 : 1e-14));
    for (const auto& one : {l[0], l[2]}) BOOST_TEST(std::abs(one) >= 1 - 1e-15);
  }
}

BOOST_AUTO_TEST_CASE(are_no_pairs_with_damping) {
  const UnsymmetricRotor<> rotor({{1.1, 0.9, 0.5}}, {{1, 0.1}, {1, 0.1}}, 1);
  BOOST_CHECK_THROW((void)paired_multipliers(rotor), InvalidInput);
  const auto A = [&](double t) { return rotor.state_matrix(t); };
  const Transition<4> period = linear_transition<4>(A, 0, rotor.period());
  for (const auto& l : floquet_multipliers(period)) BOOST_TEST(std::abs(l) < 1);
  BOOST_CHECK_THROW(UnsymmetricRotor<>({{1.1, 0.9, 0.5}}, {}, 0), InvalidInput);
}

BOOST_AUTO_TEST_SUITE_END()

BOOST_AUTO_TEST_SUITE(unstable_ranges_of_the_speed)

BOOST_AUTO_TEST_CASE(have_the_boundaries_of_the_reference) {
  double worst = 0;
  int found = 0;
  const Json& all = reference().at("boundaries");
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Json& c = all.at(i);
    // Cases with the same parameters follow each other; the range is searched once for each.
    if (i > 0 && all.at(i - 1).at("params") == c.at("params")) continue;
    const bool no_body = parameter(c, "A") - parameter(c, "B") > parameter(c, "C");
    const auto at = [&](double speed) {
      return no_body ? in_rotor_axes(c, speed) : paired_multipliers(rotor_of(c, speed), quick);
    };
    const bool si = parameter(c, "A") < 0.1;
    const auto ends =
        si ? stability_boundaries(at, 5, 60, 110) : stability_boundaries(at, 0.6, 3, 80);
    for (std::size_t k = i; k < all.size() && all.at(k).at("params") == c.at("params"); ++k) {
      const double expected = number(all.at(k).at("Omega"));
      const auto kind = all.at(k).at("kind") == "K" ? BoundaryKind::krein : BoundaryKind::minus_one;
      double nearest = 1;
      double error = 0;
      for (const StabilityBoundary& end : ends) {
        const double off = std::abs(end.parameter / expected - 1);
        if (end.kind != kind || off > nearest) continue;
        nearest = off;
        error = end.error / expected;
      }
      BOOST_TEST(nearest < 1e-10, all.at(k).at("label") << ' ' << expected << ": " << nearest);
      BOOST_TEST(nearest <= error + 1e-15, all.at(k).at("label")
                                               << ' ' << expected << ": " << error);
      worst = test::worst_of(worst, nearest);
      ++found;
    }
  }
  BOOST_TEST(found == 39);
  BOOST_TEST_MESSAGE("boundaries off by " << worst);
}

BOOST_AUTO_TEST_CASE(agree_with_closed_forms_for_equal_springs) {
  const Vector3<double> J(1.1, 0.9, 0.5);
  const auto at = [&](double speed) {
    return paired_multipliers(UnsymmetricRotor<>({J}, {{1}, {1}}, speed));
  };
  const auto ranges = unstable_intervals(at, 0.5, 3, 60);
  BOOST_REQUIRE(ranges.size() == 1);
  const auto expected = EqualSpringsRange::of(J, 1);
  BOOST_TEST(std::abs(ranges[0].begin.parameter - expected.begin) < 1e-12);
  BOOST_TEST(std::abs(ranges[0].end.parameter - expected.end) < 1e-12);
  BOOST_TEST(ranges[0].growth > 1.2);
  // The intermediate axis: no upper end, so that the end of the searched range counts.
  BOOST_TEST(std::isinf(EqualSpringsRange::of({1.2, 0.8, 0.95}, 1).end));
  BOOST_TEST(std::abs(EqualSpringsRange::of({1.2, 0.8, 0.95}, 1).begin - 2) < 1e-15);
  BOOST_CHECK_THROW((void)unstable_intervals(at, 3, 0.5), InvalidInput);
}

// The tongues between unequal springs in this range, in order, and no others.
BOOST_AUTO_TEST_CASE(number_three_with_unequal_springs) {
  const auto at = [](double speed) {
    return paired_multipliers(UnsymmetricRotor<>({{1.05, 0.95, 0.5}}, {{1}, {1.5}}, speed), quick);
  };
  const auto ranges = unstable_intervals(at, 0.6, 3, 60);
  BOOST_REQUIRE(ranges.size() == 3);
  BOOST_TEST((ranges[0].begin.kind == BoundaryKind::minus_one));
  BOOST_TEST((ranges[1].begin.kind == BoundaryKind::krein));
  BOOST_TEST((ranges[2].begin.kind == BoundaryKind::minus_one));
  BOOST_TEST(std::abs(ranges[0].end.parameter - ranges[0].begin.parameter - 0.00245664601) < 1e-9);
}

// One pair leaves the circle at 1, the other at 2: that is no end of the range.
BOOST_AUTO_TEST_CASE(do_not_end_with_the_other_pair) {
  const auto at = [](double p) {
    return PairedMultipliers{2 * p + 1, p * (p + 1) + 2, 1e-14, 1e-14};
  };
  BOOST_TEST(stability_boundaries(at, 0, 3, 7).size() == 2U);
  const auto ranges = unstable_intervals(at, 0, 3, 7);
  BOOST_REQUIRE(ranges.size() == 1U);
  BOOST_TEST(std::abs(ranges[0].begin.parameter - 1) <= 1e-15);
  BOOST_TEST(ranges[0].end.parameter == 3);
  // l + 1/l = 3.5 in the middle of its later part
  BOOST_TEST(std::abs(ranges[0].growth - (1.75 + std::sqrt(1.75 * 1.75 - 1))) <= 1e-14);
  BOOST_CHECK_THROW((void)stability_boundaries(at, 0, 3, 1), InvalidInput);
}

// Higher orders lie at lower speeds, with a width of 1e-4 of the speed. They are found between
// samples two thousand times as far apart, and confirmed on the rotor's axes. The reference's scan
// missed them.
BOOST_AUTO_TEST_CASE(are_found_even_if_narrow) {
  const Json c{{"params", {{"A", 1.2}, {"B", 0.8}, {"C", 0.5}, {"ca", 1}, {"cb", 1.5}}}};
  const auto at = [&](double speed) { return paired_multipliers(rotor_of(c, speed), quick); };
  const auto rotor_axes = [&](double speed) { return in_rotor_axes(c, speed); };
  const auto ranges = unstable_intervals(at, 0.4, 0.65, 16);
  const auto others = unstable_intervals(rotor_axes, 0.4, 0.65, 16);
  BOOST_REQUIRE((ranges.size() == 2 && others.size() == 2));
  BOOST_TEST((ranges[0].begin.kind == BoundaryKind::minus_one));
  BOOST_TEST((ranges[1].begin.kind == BoundaryKind::krein));
  BOOST_TEST(std::abs(ranges[0].end.parameter - ranges[0].begin.parameter - 5.489808e-6) < 1e-10);
  BOOST_TEST(std::abs(ranges[1].end.parameter - ranges[1].begin.parameter - 4.290923e-5) < 1e-10);
  BOOST_TEST(std::abs(ranges[1].growth - 1.0002348) < 1e-7);
  for (std::size_t i = 0; i < 2; ++i) {
    const auto agree = [](const StabilityBoundary& a, const StabilityBoundary& b) {
      return std::abs(a.parameter - b.parameter) <= a.error + b.error;
    };
    BOOST_TEST(agree(ranges[i].begin, others[i].begin));
    BOOST_TEST(agree(ranges[i].end, others[i].end));
    BOOST_TEST(std::abs(ranges[i].growth - others[i].growth) < 1e-7);
    BOOST_TEST(ranges[i].begin.error < 1e-9);
  }
}

BOOST_AUTO_TEST_SUITE_END()
