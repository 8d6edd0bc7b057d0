#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <boost/test/data/monomorphic.hpp>
#include <boost/test/data/test_case.hpp>
#include <boost/test/unit_test.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <string>
#include <type_traits>
#include <vector>

#include <dynamics/inertia.hpp>
#include <motor/displacement.hpp>
#include <motor/error.hpp>
#include <motor/tensor.hpp>

#include <support/cast.hpp>
#include <support/near.hpp>
#include <support/sample.hpp>
#include <support/six.hpp>
#include <support/terms.hpp>

using namespace kreisel;
using test::cast;
using test::inertia;
using test::Matrix6;
using test::near;
using test::PointMass;
using test::same;
using test::six;
using test::Terms;
using test::terms;
namespace data = boost::unit_test::data;

using Digits50 = boost::multiprecision::cpp_bin_float_50;

static_assert(sizeof(Inertia<>) == 10 * sizeof(double));
static_assert(sizeof(InertiaTensor<Body>) == 10 * sizeof(double));
static_assert(sizeof(Rate<Guide, InertiaTensor<Body>>) == 10 * sizeof(double));

namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

test::Verdict near_inertia(const Inertia<>& x, const Inertia<>& y, const Inertia<Terms>& scale,
                           double k) {
  const test::Verdict mass = near(x.mass, y.mass, scale.mass, k, "mass ");
  if (!mass) return mass;
  const test::Verdict first = near(x.first_moment, y.first_moment, scale.first_moment, k, "s ");
  return first ? near(x.tensor.matrix(), y.tensor.matrix(), scale.tensor.matrix(), k, "tensor ")
               : first;
}

/// Momentum and angular momentum about the origin of point masses in a velocity field.
Motor<> momentum(const std::vector<PointMass>& masses, const Motor<>& V) {
  Motor<> sum;
  for (const auto& [m, p] : masses) {
    const Vector3<double> G = m * (V.moment + V.resultant.cross(p));
    sum += Motor<>{G, p.cross(G)};
  }
  return sum;
}

/// The scale of all sums over point masses.
Inertia<Terms> all_terms(const std::vector<PointMass>& masses) {
  Inertia<Terms> sum{0, Vector3<Terms>::Zero(), {}};
  for (const PointMass& point : masses) sum = sum + terms(inertia({point}));
  return sum;
}

/// The text of the error, or nothing.
template <class Action>
std::string refusal(const Action& action) {
  try {
    action();
  } catch (const InvalidInput& error) {
    return error.what();
  }
  return {};
}

std::string refusal(const Inertia<>& T, Mass rule = Mass::positive) {
  return refusal([&] { check(T, rule); });
}

}  // namespace

BOOST_AUTO_TEST_SUITE(symmetric_matrices)

BOOST_AUTO_TEST_CASE(have_their_numbers_by_name) {
  const Symmetric3<> s{1, 2, 3, 4, 5, 6};
  Matrix3<double> m;
  m << 1, 4, 5, 4, 2, 6, 5, 6, 3;
  BOOST_TEST(same(s.matrix(), m));
  BOOST_TEST(same(Symmetric3<>::from(m).matrix(), m));
  BOOST_TEST(same(s * Vector3<double>(1, 10, 100), Vector3<double>(541, 624, 365)));
  BOOST_TEST(same((s + s).matrix(), 2 * m));
  BOOST_TEST(same((s - s).matrix(), 0 * m));
}

BOOST_AUTO_TEST_CASE(take_the_mean_of_both_triangles) {
  Matrix3<double> m;
  m << 1, 2, 3, 4, 5, 6, 7, 8, 9;
  const Symmetric3<> s = Symmetric3<>::from(m);
  BOOST_TEST(s.xy == 3.0);
  BOOST_TEST(s.xz == 5.0);
  BOOST_TEST(s.yz == 7.0);
}

// Anchor: a unit mass at (1, 2, 3) has the inertia (13, 10, 5; -2, -3, -6).
BOOST_AUTO_TEST_CASE(offset_tensor_is_twice_a_unit_mass_inertia) {
  const Vector3<double> p(1, 2, 3);
  const Matrix3<double> twice = offset_product(p, p).matrix();
  Matrix3<double> m;
  m << 13, -2, -3, -2, 10, -6, -3, -6, 5;
  BOOST_TEST(same(twice, 2 * m));
}

BOOST_DATA_TEST_CASE(offset_tensor_is_bilinear, data::xrange(50u), seed) {
  test::Sample sample(seed);
  const Vector3<double> a = sample.vector();
  const Vector3<double> b = sample.vector();
  const Matrix3<double> expected =
      2 * a.dot(b) * Matrix3<double>::Identity() - a * b.transpose() - b * a.transpose();
  BOOST_TEST(near(offset_product(a, b).matrix(), expected, a.norm() * b.norm(), 16));
  BOOST_TEST(same(offset_product(a, b).matrix(), offset_product(b, a).matrix()));
}

BOOST_AUTO_TEST_SUITE_END()

BOOST_AUTO_TEST_SUITE(an_inertia)

// Anchor: paper 002 (10), letter by letter; its columns act on (moment; resultant).
BOOST_AUTO_TEST_CASE(is_the_papers_matrix_10) {
  const double m = 2, a = 3, b = 5, c = 7;
  const double theta_A = 100, theta_B = 110, theta_C = 120, phi_A = 11, phi_B = 13, phi_C = 17;
  Matrix6<double> paper;
  paper << m, 0, 0, 0, m * c, -m * b,             //
      0, m, 0, -m * c, 0, m * a,                  //
      0, 0, m, m * b, -m * a, 0,                  //
      0, -m * c, m * b, theta_A, -phi_C, -phi_B,  //
      m * c, 0, -m * a, -phi_C, theta_B, -phi_A,  //
      -m * b, m * a, 0, -phi_B, -phi_A, theta_C;
  const Inertia<> T{
      m, m * Vector3<double>(a, b, c), {theta_A, theta_B, theta_C, -phi_C, -phi_B, -phi_A}};
  const MotorTensor<> full = T.motor_tensor();
  Matrix6<double> ours;
  ours << full.rm, full.rr, full.mm, full.mr;
  BOOST_TEST(same(ours, paper));
}

// Anchor: 2 kg at (1, 0, 0), spinning about z with 3 rad/s.
BOOST_AUTO_TEST_CASE(one_mass_by_hand) {
  const Inertia<> T = inertia({{2, {1, 0, 0}}});
  BOOST_TEST(same(T * Motor<>{{0, 0, 3}, {0, 0, 0}}, Motor<>{{0, 6, 0}, {0, 0, 6}}));
}

BOOST_DATA_TEST_CASE(applies_as_its_thirty_six_numbers, data::xrange(100u), seed) {
  test::Sample sample(seed);
  const Inertia<> T = inertia(sample.masses());
  const Motor<> V = sample.motor();
  BOOST_TEST(near(T * V, T.motor_tensor() * V, terms(T) * terms(V), 8));
  BOOST_TEST(same(six(transpose(T.motor_tensor())), six(T.motor_tensor())));
}

BOOST_DATA_TEST_CASE(gives_the_momentum_of_its_masses, data::xrange(200u), seed) {
  test::Sample sample(seed);
  const std::vector<PointMass> masses = sample.masses();
  const Motor<> V = sample.motor();
  BOOST_TEST(near(inertia(masses) * V, momentum(masses, V), all_terms(masses) * terms(V), 20));
}

BOOST_DATA_TEST_CASE(two_bodies_have_the_sum_of_their_masses, data::xrange(50u), seed) {
  test::Sample sample(seed);
  std::vector<PointMass> masses = sample.masses();
  const std::vector<PointMass> others = sample.masses();
  const Inertia<> one = inertia(masses);
  const Inertia<> other = inertia(others);
  masses.insert(masses.end(), others.begin(), others.end());
  BOOST_TEST(near_inertia(one + other, inertia(masses), all_terms(masses), 16));
  BOOST_TEST(near_inertia((one + other) - other, one, all_terms(masses), 4));
  BOOST_TEST(near_inertia(-one, inertia({}) - one, all_terms(masses), 0));
}

BOOST_DATA_TEST_CASE(displaced_agrees_with_displaced_masses, data::xrange(200u), seed) {
  test::Sample sample(seed);
  const std::vector<PointMass> masses = sample.masses();
  const Pose<> X = sample.pose(-2, 2);
  std::vector<PointMass> moved = masses;
  for (PointMass& point : moved) point.place = X.point(point.place);
  const Inertia<Terms> scale = terms(X) * all_terms(masses);
  BOOST_TEST(near_inertia(X * inertia(masses), inertia(moved), scale, 24));
}

BOOST_DATA_TEST_CASE(displaced_agrees_with_the_motor_tensor, data::xrange(100u), seed) {
  test::Sample sample(seed);
  const Inertia<> T = inertia(sample.masses());
  const Pose<> X = sample.pose(-2, 2);
  const Matrix6<Terms> scale = six(terms(X) * terms(T).motor_tensor());
  BOOST_TEST(near(six((X * T).motor_tensor()), six(X * T.motor_tensor()), scale, 32));
}

BOOST_DATA_TEST_CASE(has_the_same_energy_in_every_frame, data::xrange(100u), seed) {
  test::Sample sample(seed);
  const Inertia<> T = inertia(sample.masses());
  const Motor<> V = sample.motor();
  const Pose<> X = sample.pose(-2, 2);
  const Terms scale =
      reciprocal(terms(X) * (terms(T) * terms(V)), terms(X) * terms(V)) +
      reciprocal((terms(X) * terms(T)) * (terms(X) * terms(V)), terms(X) * terms(V));
  BOOST_TEST(near(reciprocal((X * T) * (X * V), X * V), reciprocal(T * V, V), scale, 24));
}

BOOST_AUTO_TEST_SUITE_END()

BOOST_AUTO_TEST_SUITE(the_carried_rate)

// Anchor: 2 kg at (1, 0, 0), moving with 3 m/s along x. The first moment grows by 6 kg m/s, the
//         moments of inertia about y and z by 2 m x v = 12.
BOOST_AUTO_TEST_CASE(by_hand) {
  const Inertia<> rate = carried_rate(Motor<>{{0, 0, 0}, {3, 0, 0}}, inertia({{2, {1, 0, 0}}}));
  BOOST_TEST(rate.mass == 0.0);
  BOOST_TEST(same(rate.first_moment, Vector3<double>(6, 0, 0)));
  BOOST_TEST(same(rate.tensor.matrix(), Vector3<double>(0, 12, 12).asDiagonal().toDenseMatrix()));
}

// Anchor: spun about z with 3 rad/s it moves to +y; its product of inertia falls by m x 3 x.
BOOST_AUTO_TEST_CASE(by_hand_when_spun) {
  const Inertia<> rate = carried_rate(Motor<>{{0, 0, 3}, {0, 0, 0}}, inertia({{2, {1, 0, 0}}}));
  BOOST_TEST(same(rate.first_moment, Vector3<double>(0, 6, 0)));
  BOOST_TEST(rate.tensor.xy == -6.0);
  BOOST_TEST(rate.tensor.xx == 0.0);
}

BOOST_DATA_TEST_CASE(is_a_difference_of_products, data::xrange(200u), seed) {
  test::Sample sample(seed);
  const Inertia<> T = inertia(sample.masses());
  const Motor<> V = sample.motor();
  const MotorTensor<> full = T.motor_tensor();
  const MotorTensor<Terms> terms_full = terms(T).motor_tensor();
  const Matrix6<Terms> scale = six(cross(terms(V), terms_full) + cross(terms_full, terms(V)));
  BOOST_TEST(
      near(six(carried_rate(V, T).motor_tensor()), six(cross(V, full) - cross(full, V)), scale, 8));
}

// The masses moved for h and for -h, in 50 digits.
BOOST_DATA_TEST_CASE(agrees_with_moving_masses, data::xrange(100u), seed) {
  test::Sample sample(seed);
  const std::vector<PointMass> masses = sample.masses();
  const Motor<> V = sample.motor(-1, 1);
  const Digits50 h("1e-15");
  const auto at = [&](const Digits50& t) {
    Inertia<Digits50> sum;
    for (const auto& [mass, place] : masses) {
      const Vector3<Digits50> p = exp(t * cast<Digits50>(V)).point(cast<Digits50>(place));
      const Digits50 m = mass;
      sum.mass += m;
      sum.first_moment += m * p;
      const Matrix3<Digits50> theta =
          m * (p.squaredNorm() * Matrix3<Digits50>::Identity() - p * p.transpose());
      sum.tensor = sum.tensor + Symmetric3<Digits50>::from(theta);
    }
    return sum;
  };
  const Inertia<Digits50> difference = at(h) - at(-h);
  const Digits50 slope = 1 / (2 * h);
  const Inertia<> expected{
      0, cast<double>(Vector3<Digits50>(slope * difference.first_moment)),
      Symmetric3<>::from(cast<double>(Matrix3<Digits50>(slope * difference.tensor.matrix())))};
  const Inertia<Terms> scale =
      carried_rate(terms(V), all_terms(masses)) +
      Inertia<Terms>{
          0, Vector3<Terms>::Constant(1e-9), {1e-9, 1e-9, 1e-9, 1e-9, 1e-9, 1e-9}};  // h^2 / u
  BOOST_TEST(near_inertia(carried_rate(V, inertia(masses)), expected, scale, 20));
}

// Paper 002, section 2: oT V' = [V' (T V')],  oT F = [V' (T F)] + T [F V'].
BOOST_DATA_TEST_CASE(agrees_with_the_paper, data::xrange(100u), seed) {
  test::Sample sample(seed);
  const Inertia<> T = inertia(sample.masses());
  const Motor<> V = sample.motor();
  const Motor<> F = sample.motor();
  const Motor<Terms> own =
      carried_rate(terms(V), terms(T)) * terms(V) + cross(terms(V), terms(T) * terms(V));
  const Motor<Terms> guide = carried_rate(terms(V), terms(T)) * terms(F) +
                             cross(terms(V), terms(T) * terms(F)) +
                             terms(T) * cross(terms(F), terms(V));
  BOOST_TEST(near(carried_rate(V, T) * V, cross(V, T * V), own, 10));
  BOOST_TEST(near(carried_rate(V, T) * F, cross(V, T * F) + T * cross(F, V), guide, 10));
}

BOOST_AUTO_TEST_SUITE_END()

BOOST_AUTO_TEST_SUITE(solving_for_the_acceleration)

// Anchor: 2 kg, the centre of mass at (1, 0, 0), moments 1 about it. 6 N along y at the origin
//         accelerate the centre by 3 and rotate by -6 about it: the origin accelerates by 3 + 6.
BOOST_AUTO_TEST_CASE(by_hand) {
  const Inertia<> T{2, {2, 0, 0}, {1, 3, 3, 0, 0, 0}};
  const Motor<> A = solve(T, Motor<>{{0, 6, 0}, {0, 0, 0}});
  BOOST_TEST(near(A, Motor<>{{0, 0, -6}, {0, 9, 0}}, 9.0, 4));
}

BOOST_DATA_TEST_CASE(undoes_the_inertia, data::xrange(200u), seed) {
  test::Sample sample(seed);
  const Inertia<> T = inertia(sample.solid_masses());
  const Motor<> P = sample.motor();
  const Motor<> A = solve(T, P);
  const Motor<> exact = cast<double>(solve(cast<Digits50>(T), cast<Digits50>(P)));

  // The best possible error: the condition of the tensor about the centre of mass, times the loss
  // by its conversion from the origin. For the moment, half of that with the lever of the centre.
  const Vector3<double> r = T.first_moment / T.mass;
  const Symmetric3<> about_centre =
      T.tensor - offset_product(r, Vector3<double>(T.first_moment / 2));
  const Eigen::SelfAdjointEigenSolver<Matrix3<double>> eigen(about_centre.matrix());
  const double turned = T.tensor.matrix().norm() / eigen.eigenvalues()[0];
  const double size = (P.moment.norm() + r.norm() * P.resultant.norm()) / eigen.eigenvalues()[0];
  BOOST_TEST(near(A.resultant, exact.resultant, turned * size, 8));
  BOOST_TEST(
      near(A.moment, exact.moment, turned * size * r.norm() + P.resultant.norm() / T.mass, 8));
}

BOOST_AUTO_TEST_CASE(refuses_undetermined_accelerations) {
  const Motor<> P{{1, 2, 3}, {4, 5, 6}};
  const auto fails = [&P](const Inertia<>& T) {
    try {
      (void)solve(T, P);
    } catch (const ComputationFailed& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  const std::string rotation =
      "Inertia: the tensor about the centre of mass is singular (a point or a needle): its "
      "rotation is not determined by the force";
  BOOST_TEST(fails(Inertia<>{}) == "Inertia: solve needs a mass above 0");
  BOOST_TEST(fails({-1, {0, 0, 0}, {1, 1, 1, 0, 0, 0}}) == "Inertia: solve needs a mass above 0");
  BOOST_TEST(fails({not_a_number, {0, 0, 0}, {1, 1, 1, 0, 0, 0}}) ==
             "Inertia: solve needs a mass above 0");
  BOOST_TEST(fails(inertia({{2, {1, 2, 3}}})) == rotation);
  BOOST_TEST(fails(inertia({{2, {1, 2, 3}}, {3, {-1, 0, 5}}})) == rotation);
  BOOST_TEST(fails({1, {0, 0, 0}, {not_a_number, 1, 1, 0, 0, 0}}) == rotation);
  BOOST_TEST(fails({1, {0, 0, 0}, {1, 1, 1, 0, 0, 0}}) == "");
}

BOOST_AUTO_TEST_SUITE_END()

BOOST_AUTO_TEST_SUITE(the_check)

BOOST_DATA_TEST_CASE(accepts_all_sets_of_masses, data::xrange(400u), seed) {
  test::Sample sample(seed);
  const std::vector<PointMass> masses = sample.masses();
  BOOST_TEST(refusal(inertia(masses)) == "");
  const Inertia<> moved = sample.pose(-1, 1) * inertia(masses);
  BOOST_TEST(refusal(moved) == "");
  BOOST_TEST(refusal([&] { check(cast<float>(moved)); }) == "");
}

BOOST_AUTO_TEST_CASE(accepts_the_legal_limits) {
  BOOST_TEST(refusal(Inertia<>{1, {0, 0, 0}, {0, 0, 0, 0, 0, 0}}) == "");          // point
  BOOST_TEST(refusal(Inertia<>{1, {0, 0, 0}, {0, 2, 2, 0, 0, 0}}) == "");          // needle
  BOOST_TEST(refusal(Inertia<>{1, {0, 0, 0}, {1, 2, 3, 0, 0, 0}}) == "");          // disc
  BOOST_TEST(refusal(Inertia<>{1, {0, 0, 0}, {1, 2, 3 + 1e-12, 0, 0, 0}}) == "");  // to rounding
  BOOST_TEST(refusal(Inertia<>{1e-30, {0, 0, 0}, {1e-40, 1e-40, 1e-40, 0, 0, 0}}) == "");
}

BOOST_AUTO_TEST_CASE(requires_a_mass_above_zero) {
  BOOST_TEST(refusal(Inertia<>{-2.5, {0, 0, 0}, {1, 1, 1, 0, 0, 0}}) ==
             "inertia: mass >= 0 fails: mass = -2.5 kg");
  BOOST_TEST(refusal(Inertia<>{-2.5, {0, 0, 0}, {1, 1, 1, 0, 0, 0}}, Mass::zero_allowed) ==
             "inertia: mass >= 0 fails: mass = -2.5 kg");
  BOOST_TEST(refusal(Inertia<>{0, {0, 0, 0}, {1, 1, 1, 0, 0, 0}}) ==
             "inertia: mass > 0 fails: mass = 0 kg");
}

BOOST_AUTO_TEST_CASE(accepts_a_massless_ring_if_allowed) {
  BOOST_TEST(refusal(Inertia<>{0, {0, 0, 0}, {1, 1, 2, 0, 0, 0}}, Mass::zero_allowed) == "");
  BOOST_TEST(refusal(Inertia<>{0, {0, 1e-9, 0}, {1, 1, 2, 0, 0, 0}}, Mass::zero_allowed) ==
             "inertia: mass = 0 kg, but its first moment is not 0");
  BOOST_TEST(refusal(Inertia<>{0, {0, 0, 0}, {1, 1, 3, 0, 0, 0}}, Mass::zero_allowed) ==
             "inertia: triangle inequality about the centre of mass fails: 1 + 1 >= 3 kg m^2");
}

BOOST_AUTO_TEST_CASE(names_negative_moments) {
  BOOST_TEST(refusal(Inertia<>{1, {0, 0, 0}, {-0.5, 2, 2, 0, 0, 0}}) ==
             "inertia: principal moments about the centre of mass >= 0 fails: -0.5, 2, 2 kg m^2");
  // Products of inertia too great for the moments, and a centre of mass too far from the origin.
  BOOST_TEST(refusal(Inertia<>{1, {0, 0, 0}, {2, 2, 2, 3, 0, 0}}) ==
             "inertia: principal moments about the centre of mass >= 0 fails: -1, 2, 5 kg m^2");
  BOOST_TEST(refusal(Inertia<>{2, {2, 0, 0}, {1, 1, 3, 0, 0, 0}}) ==
             "inertia: principal moments about the centre of mass >= 0 fails: -1, 1, 1 kg m^2");
}

// The tensor in the message is legal, and no other one is nearer. The change has the pattern e/3
// (1, 1, -1) on the principal axes, so that its norm is e/sqrt(3).
BOOST_AUTO_TEST_CASE(names_the_nearest_legal_tensor) {
  const auto named = [](const Symmetric3<>& t) {
    const std::string text = refusal(Inertia<>{1, {0, 0, 0}, t});
    std::vector<double> numbers;
    std::istringstream list(text.substr(std::min(text.size(), text.rfind('[') + 1)));
    for (double x = 0; list >> x; list.ignore(1)) numbers.push_back(x);
    numbers.resize(6, 0);
    return Symmetric3<>{numbers[0], numbers[1], numbers[2], numbers[3], numbers[4], numbers[5]};
  };
  const auto norm = [](const Symmetric3<>& t) { return t.matrix().norm(); };
  const Matrix3<double> R = Eigen::Quaterniond(0.5, 0.1, -0.7, 0.5).normalized().toRotationMatrix();
  for (const double e : {1e-3, 1e-6, 1e-11}) {
    for (const bool is_turned : {false, true}) {
      const Symmetric3<> disc{0.5, 0.5, 1 + e};
      const Symmetric3<> t = is_turned ? disc.rotated(R) : disc;
      const Symmetric3<> legal = named(t);
      BOOST_TEST(refusal(Inertia<>{1, {0, 0, 0}, legal}) == "");
      BOOST_TEST(std::abs(norm(legal - t) - e / std::sqrt(3.0)) <= 1e-3 * e + 1e-13);
    }
  }
  // A needle with a moment below 0 by rounding: both others become equal.
  const Symmetric3<> needle = Symmetric3<>{-1e-4, 1, 1}.rotated(R);
  const Symmetric3<> legal = named(needle);
  BOOST_TEST(refusal(Inertia<>{1, {0, 0, 0}, legal}) == "");
  BOOST_TEST(std::abs(norm(legal - needle) - 1e-4) <= 1e-12);
  BOOST_TEST(refusal(Inertia<>{1, {0, 0, 0}, {0.5, 0.5, 1.1, 0, 0, 0}}).find("nearest") ==
             std::string::npos);
}

BOOST_AUTO_TEST_CASE(names_the_violated_triangle_inequality) {
  BOOST_TEST(refusal(Inertia<>{1, {0, 0, 0}, {1, 4, 2, 0, 0, 0}}) ==
             "inertia: triangle inequality about the centre of mass fails: 1 + 2 >= 4 kg m^2");
  BOOST_TEST(
      refusal(Inertia<>{1, {0, 0, 0}, {1, 2, 3.0001, 0, 0, 0}}) ==
      "inertia: triangle inequality about the centre of mass fails: 1 + 2 >= 3.0001 kg m^2, by "
      "3.3e-05 of the greatest; nearest legal tensor: [1.0000333333333, 2.0000333333333, "
      "3.0000666666667]");
  // About the origin the triangle inequality holds, about the centre of mass (0, 0, 1) it does not.
  BOOST_TEST(refusal(Inertia<>{1, {0, 0, 1}, {2, 2, 3, 0, 0, 0}}) ==
             "inertia: triangle inequality about the centre of mass fails: 1 + 1 >= 3 kg m^2");
}

BOOST_AUTO_TEST_CASE(refuses_numbers_that_are_not_finite) {
  const std::string text = "inertia: not a finite number among mass, first moment and tensor";
  for (const double bad : {not_a_number, infinity, -infinity}) {
    BOOST_TEST(refusal(Inertia<>{bad, {0, 0, 0}, {1, 1, 1, 0, 0, 0}}) == text);
    for (int i = 0; i < 3; ++i) {
      Inertia<> T{1, {0, 0, 0}, {1, 1, 1, 0, 0, 0}};
      T.first_moment[i] = bad;
      BOOST_TEST(refusal(T) == text);
    }
    BOOST_TEST(refusal(Inertia<>{1, {0, 0, 0}, {bad, 1, 1, 0, 0, 0}}) == text);
    BOOST_TEST(refusal(Inertia<>{1, {0, 0, 0}, {1, bad, 1, 0, 0, 0}}) == text);
    BOOST_TEST(refusal(Inertia<>{1, {0, 0, 0}, {1, 1, bad, 0, 0, 0}}) == text);
    BOOST_TEST(refusal(Inertia<>{1, {0, 0, 0}, {1, 1, 1, bad, 0, 0}}) == text);
    BOOST_TEST(refusal(Inertia<>{1, {0, 0, 0}, {1, 1, 1, 0, bad, 0}}) == text);
    BOOST_TEST(refusal(Inertia<>{1, {0, 0, 0}, {1, 1, 1, 0, 0, bad}}) == text);
  }
}

BOOST_AUTO_TEST_CASE(names_the_body) {
  BOOST_TEST(refusal([] { check(Inertia<>{}, Mass::positive, "outer gimbal"); }) ==
             "outer gimbal: mass > 0 fails: mass = 0 kg");
}

BOOST_AUTO_TEST_SUITE_END()

BOOST_AUTO_TEST_SUITE(an_inertia_tensor)

BOOST_AUTO_TEST_CASE(may_be_given_about_centre_or_origin) {
  const Vector3<double> centre(1, 2, 3);
  const Matrix3<double> one = Matrix3<double>::Identity();
  const auto about_centre = InertiaTensor<Body>::about_centre(2, centre, one);
  BOOST_TEST(about_centre.value.mass == 2.0);
  BOOST_TEST(same(about_centre.value.first_moment, Vector3<double>(2, 4, 6)));
  Matrix3<double> about_origin;
  about_origin << 27, -4, -6, -4, 21, -12, -6, -12, 11;
  BOOST_TEST(same(about_centre.value.tensor.matrix(), about_origin));

  const auto again = InertiaTensor<Body>::about_origin(2, centre, about_origin);
  BOOST_TEST(same(again.value.first_moment, about_centre.value.first_moment));
  BOOST_TEST(same(again.value.tensor.matrix(), about_origin));
}

BOOST_AUTO_TEST_CASE(is_checked_by_its_constructor) {
  Matrix3<double> lopsided = Matrix3<double>::Identity();
  lopsided(0, 1) = 0.1;
  const Vector3<double> o = Vector3<double>::Zero();
  const Matrix3<double> one = Matrix3<double>::Identity();
  using Tensor = InertiaTensor<Body>;
  const std::string skew = "inertia: the tensor is not symmetric";
  const std::string massless = "inertia: mass > 0 fails: mass = 0 kg";
  BOOST_TEST(refusal([&] { (void)Tensor::about_centre(1, o, lopsided); }) == skew);
  BOOST_TEST(refusal([&] { (void)Tensor::about_origin(1, o, lopsided); }) == skew);
  BOOST_TEST(refusal([&] { (void)Tensor::about_centre(0, o, one); }) == massless);
  BOOST_TEST(refusal([&] { (void)Tensor::about_origin(0, o, one); }) == massless);
  BOOST_TEST(refusal([&] { (void)Tensor::about_centre(0, o, one, Mass::zero_allowed); }) == "");
  BOOST_TEST(refusal([&] { (void)Tensor::about_origin(0, o, one, Mass::zero_allowed); }) == "");
  // About the origin, (1, 0, 0) away, one moment is less than that of the mass alone.
  BOOST_TEST(refusal([&] { (void)Tensor::about_centre(2, {1, 0, 0}, one); }) == "");
  BOOST_TEST(refusal([&] {
               (void)Tensor::about_origin(2, {1, 0, 0}, one);
             }) ==
             "inertia: principal moments about the centre of mass >= 0 fails: -1, -1, 1 kg m^2");
  BOOST_TEST(refusal([&] {
               (void)Tensor::about_origin(1, {not_a_number, 0, 0}, one);
             }) == "inertia: not a finite number among mass, first moment and tensor");
  Matrix3<double> unknown = one;
  unknown(2, 1) = not_a_number;
  BOOST_TEST(refusal([&] { (void)Tensor::about_centre(1, o, unknown); }) != "");
}

BOOST_AUTO_TEST_CASE(gives_typed_results) {
  test::Sample sample(7);
  const InertiaTensor<Body> T{inertia(sample.masses())};
  const Velocity<Body, Guide, Body> V{sample.motor()};
  const Rate<Guide, Velocity<Body, Guide, Body>> dV{sample.motor()};
  const Displacement<Guide, Body> X{sample.pose()};
  static_assert(std::is_same_v<decltype(T * V), Momentum<Body>>);
  static_assert(std::is_same_v<decltype(T * dV), Force<Body>>);
  static_assert(std::is_same_v<decltype(T + T), InertiaTensor<Body>>);
  static_assert(std::is_same_v<decltype(T - T), InertiaTensor<Body>>);
  static_assert(std::is_same_v<decltype(X * T), InertiaTensor<Guide>>);
  static_assert(std::is_same_v<decltype(rate(T, V)), Rate<Guide, InertiaTensor<Body>>>);
  static_assert(std::is_same_v<decltype(X * rate(T, V)), Rate<Guide, InertiaTensor<Guide>>>);
  BOOST_TEST(same((T * V).value, T.value * V.value));
  BOOST_TEST(same((T * dV).value, T.value * dV.value));
  BOOST_TEST(near_inertia((T + T).value, T.value + T.value, terms(T.value), 0));
  BOOST_TEST(near_inertia((X * T).value, X.value * T.value, terms(T.value), 0));
  BOOST_TEST(near_inertia(rate(T, V).value, carried_rate(V.value, T.value), terms(T.value), 0));
}

BOOST_AUTO_TEST_SUITE_END()
