#include <boost/multiprecision/cpp_bin_float.hpp>
#include <boost/test/data/monomorphic.hpp>
#include <boost/test/data/test_case.hpp>
#include <boost/test/unit_test.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <vector>

#include <motor/displacement.hpp>
#include <motor/screw.hpp>

#include <support/cast.hpp>
#include <support/near.hpp>
#include <support/sample.hpp>
#include <support/six.hpp>
#include <support/terms.hpp>
#include <support/worst.hpp>

using namespace kreisel;
using test::cast;
using test::near;
using test::same;
using test::Terms;
using test::terms;
namespace data = boost::unit_test::data;

using Digits50 = boost::multiprecision::cpp_bin_float_50;

static_assert(sizeof(Pose<>) == 12 * sizeof(double));

namespace {

constexpr double pi = std::numbers::pi;

#ifdef __OPTIMIZE__
constexpr int motors_per_range = 1'000'000;
#else
constexpr int motors_per_range = 10'000;
#endif

/// The exponential by its power series in 50 digits, without sines and rotations.
Pose<Digits50> power_series(const Motor<Digits50>& A) {
  using Matrix4 = Eigen::Matrix<Digits50, 4, 4>;
  Matrix4 a = Matrix4::Zero();
  a.topLeftCorner<3, 3>() = test::vector_product_matrix(A.resultant);
  a.topRightCorner<3, 1>() = A.moment;
  const int squarings = A.resultant.norm() > 1 ? 7 : 0;
  a /= Digits50(1 << squarings);
  Matrix4 sum = Matrix4::Identity();
  for (int n = 60; n > 0; --n) sum = Matrix4::Identity() + a * sum / Digits50(n);
  for (int n = 0; n < squarings; ++n) sum = (sum * sum).eval();
  return {sum.topLeftCorner<3, 3>(), sum.topRightCorner<3, 1>()};
}

Motor<> turn(test::Sample& sample, double theta) {
  Motor<> A{theta * sample.direction(), sample.magnitude(-4, 4) * sample.direction()};
  if (sample.once_in(4)) A.moment = sample.uniform(-1, 1) * A.resultant;
  if (sample.once_in(8)) A.moment += 1e-3 * theta * sample.direction();
  return A;
}

double relative(const Vector3<double>& x, const Vector3<double>& y) {
  return y.norm() == 0 ? x.norm() : (x - y).norm() / y.norm();
}

}  // namespace

BOOST_AUTO_TEST_SUITE(a_pose)

// Anchors: a quarter turn about z, then (1, 2, 3), which also moves a force along z through the
//          origin.
BOOST_AUTO_TEST_CASE(turns_then_shifts) {
  Matrix3<double> quarter;
  quarter << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  const Pose<> X{quarter, {1, 2, 3}};
  BOOST_TEST(same(X.point({1, 0, 0}), Vector3<double>(1, 3, 3)));
  BOOST_TEST(same(X.inverse().point({1, 3, 3}), Vector3<double>(1, 0, 0)));
  BOOST_TEST(same(X * Motor<>{{0, 0, 1}, {0, 0, 0}}, Motor<>{{0, 0, 1}, {2, -1, 0}}));
  BOOST_TEST(same(X * Motor<>{{0, 0, 0}, {1, 0, 0}}, Motor<>{{0, 0, 0}, {0, 1, 0}}));
}

BOOST_AUTO_TEST_CASE(is_the_identity_by_default) {
  BOOST_TEST(same(Pose<>{}.point({1, 2, 3}), Vector3<double>(1, 2, 3)));
}

BOOST_DATA_TEST_CASE(product_applies_one_after_the_other, data::xrange(200u), seed) {
  test::Sample sample(seed);
  const Pose<> X = sample.pose();
  const Pose<> Y = sample.pose();
  const Vector3<double> p = sample.vector();
  const Motor<> a = sample.motor();
  BOOST_TEST(
      near((X * Y).point(p), X.point(Y.point(p)), terms(X).point(terms(Y).point(terms(p))), 12));
  BOOST_TEST(near((X * Y) * a, X * (Y * a), terms(X) * (terms(Y) * terms(a)), 16));
}

BOOST_DATA_TEST_CASE(times_its_inverse_is_the_identity, data::xrange(200u), seed) {
  test::Sample sample(seed);
  const Pose<> X = sample.pose();
  const Pose<Terms> scale = terms(X) * terms(X).inverse();
  for (const Pose<>& none : {X * X.inverse(), X.inverse() * X}) {
    BOOST_TEST(near(none.rotation, Matrix3<double>::Identity().eval(), 1.0, 16));
    BOOST_TEST(near(none.translation, Vector3<double>::Zero().eval(), scale.translation, 16));
  }
}

// A motor is a field: its displaced moment at a point is the displaced motor's moment at the
// displaced point.
BOOST_DATA_TEST_CASE(moves_the_field_of_a_motor, data::xrange(200u), seed) {
  test::Sample sample(seed);
  const Pose<> X = sample.pose();
  const Motor<> a = sample.motor();
  const Vector3<double> p = sample.vector();
  const Vector3<Terms> scale = (terms(X) * terms(a)).reduced_at(terms(X).point(terms(p))).moment;
  BOOST_TEST(near((X * a).reduced_at(X.point(p)).moment,
                  Vector3<double>(X.rotation * a.reduced_at(p).moment), scale, 24));
}

BOOST_AUTO_TEST_SUITE_END()

BOOST_AUTO_TEST_SUITE(a_pose_from_a_quaternion)

// Anchor: 120 degrees about (1, 1, 1) maps x to y, y to z, z to x.
BOOST_AUTO_TEST_CASE(by_hand) {
  const Pose<> X = Pose<>::from({0.5, 0.5, 0.5, 0.5}, {7, 8, 9});
  Matrix3<double> cycle;
  cycle << 0, 0, 1, 1, 0, 0, 0, 1, 0;
  BOOST_TEST(same(X.rotation, cycle));
  BOOST_TEST(same(X.translation, Vector3<double>(7, 8, 9)));
}

BOOST_DATA_TEST_CASE(does_not_depend_on_the_norm, data::xrange(200u), seed) {
  test::Sample sample(seed);
  const Eigen::Quaterniond q(sample.number(-3, 0), sample.number(-3, 0), sample.number(-3, 0),
                             sample.magnitude(-3, 0));
  const double s = sample.magnitude(-140, 140);
  const Eigen::Quaterniond sq(s * q.w(), s * q.x(), s * q.y(), s * q.z());
  BOOST_TEST(near(Pose<>::from(sq).rotation, Pose<>::from(q).rotation, 1.0, 16));
  BOOST_TEST(near(Pose<>::from(q).rotation, q.normalized().toRotationMatrix(), 1.0, 16));
}

BOOST_DATA_TEST_CASE(is_orthogonal, data::xrange(200u), seed) {
  test::Sample sample(seed);
  const Matrix3<double> R = sample.rotation();
  BOOST_TEST(near(Matrix3<double>(R.transpose() * R), Matrix3<double>::Identity().eval(), 1.0, 12));
  BOOST_TEST(near(R.determinant(), 1.0, 1.0, 12));
}

BOOST_DATA_TEST_CASE(is_restored_from_its_matrix, data::xrange(400u), seed) {
  test::Sample sample(seed);
  const double half =
      sample.once_in(4) ? pi / 2 - sample.magnitude(-16, -1) : sample.uniform(0, pi / 2);
  const Vector3<double> n = std::sin(half) * sample.direction();
  const Eigen::Quaterniond q(std::cos(half), n.x(), n.y(), n.z());
  const Eigen::Quaternion<Digits50> exact = q.cast<Digits50>().normalized();
  const Matrix3<double> R = cast<double>(Matrix3<Digits50>(exact.toRotationMatrix()));
  const Eigen::Quaterniond back = quaternion(R);
  BOOST_TEST(back.w() >= 0);
  BOOST_TEST(near(back.coeffs(), Eigen::Vector4d(exact.coeffs().cast<double>()), 1.0, 4));
}

BOOST_AUTO_TEST_SUITE_END()

BOOST_AUTO_TEST_SUITE(the_exponential)

BOOST_AUTO_TEST_CASE(exp_of_zero_is_exactly_the_identity) {
  const Pose<> X = exp(Motor<>{});
  BOOST_TEST(same(X.rotation, Matrix3<double>::Identity()));
  BOOST_TEST(same(X.translation, Vector3<double>::Zero()));
}

BOOST_AUTO_TEST_CASE(exp_of_a_couple_is_exactly_a_shift) {
  const Pose<> X = exp(Motor<>{{0, 0, 0}, {1, -2, 3e10}});
  BOOST_TEST(same(X.rotation, Matrix3<double>::Identity()));
  BOOST_TEST(same(X.translation, Vector3<double>(1, -2, 3e10)));
}

// Anchor: half a turn about the line along z through (1, 0, 0), climbing 5.
BOOST_AUTO_TEST_CASE(exp_of_a_screw_turns_and_climbs) {
  const Pose<> X = exp(motor(Screw<>{ScrewKind::general, {0, 0, 1}, {1, 0, 0}, pi, 5 / pi}));
  BOOST_TEST(near(X.point({0, 0, 0}), Vector3<double>(2, 0, 5), 5.0, 4));
  BOOST_TEST(near(X.point({1, 0, 0}), Vector3<double>(1, 0, 5), 5.0, 4));
  BOOST_TEST(near(X.point({1, 1, 0}), Vector3<double>(1, -1, 5), 5.0, 4));
}

// Anchor: a quarter turn about z is right-handed.
BOOST_AUTO_TEST_CASE(exp_of_a_quarter_turn_maps_x_to_y) {
  const Pose<> X = exp(Motor<>{{0, 0, pi / 2}, {0, 0, 0}});
  BOOST_TEST(near(X.point({1, 0, 0}), Vector3<double>(0, 1, 0), 1.0, 2));
}

BOOST_DATA_TEST_CASE(leaves_its_own_motor_unchanged, data::xrange(200u), seed) {
  test::Sample sample(seed);
  const Motor<> A = turn(sample, sample.uniform(0, pi));
  const Pose<> X = exp(A);
  BOOST_TEST(near(X * A, A, terms(X) * terms(A), 24));
}

BOOST_DATA_TEST_CASE(two_halves_make_the_whole, data::xrange(200u), seed) {
  test::Sample sample(seed);
  const Motor<> A = turn(sample, sample.uniform(0, 2 * pi));
  const double s = sample.uniform(0, 1);
  const Pose<> whole = exp(A);
  const Pose<> joined = exp(s * A) * exp((1 - s) * A);
  BOOST_TEST(near(joined.rotation, whole.rotation, 1.0, 48));
  BOOST_TEST(near(joined.translation, whole.translation, A.moment.norm(), 48));
}

// The motor product is the derivative of the exponential: (exp(h V) Q - exp(-h V) Q) / 2h -> [V Q].
BOOST_DATA_TEST_CASE(begins_with_the_motor_product, data::xrange(50u), seed) {
  test::Sample sample(seed);
  const Motor<> V = sample.motor(-1, 1);
  const Motor<> Q = sample.motor(-1, 1);
  const Digits50 h("1e-15");
  const Motor<Digits50> forth = exp(h * cast<Digits50>(V)) * cast<Digits50>(Q);
  const Motor<Digits50> back = exp(-h * cast<Digits50>(V)) * cast<Digits50>(Q);
  const Motor<> rate = cast<double>(Motor<Digits50>((forth - back) / (2 * h)));
  const Vector3<Terms> tiny = Vector3<Terms>::Constant(1e-24);
  BOOST_TEST(near(rate, cross(V, Q), cross(terms(V), terms(Q)) + Motor<Terms>{tiny, tiny}, 4));
}

const double angles[] = {1e-300, 1e-20,   1e-9,    1e-5,    1e-3,   0.01,      0.1,
                         0.5,    0.99999, 1.0,     1.00001, 1.5,    2,         2.09,
                         2.0943, 2.0944,  2.0945,  2.5,     3,      pi - 1e-3, pi - 1e-8,
                         pi,     3.16227, 3.16228, 4,       2 * pi, 10,        100};

// The bounds in displacement.hpp at its branch points: at 1 the form changes, at the root of 10
// polynomials become sines. The logarithm's branch point is at 120 degrees.
BOOST_DATA_TEST_CASE(keeps_its_error_bounds, data::make(angles), theta) {
  test::Sample sample(static_cast<std::uint64_t>(1 + theta * 1000));
  const double k = 8 * std::max(1.0, theta / pi);
  for (int i = 0; i < 20; ++i) {
    const Motor<> A = turn(sample, theta);
    const Pose<> X = exp(A);
    const Pose<> exact = cast<double>(power_series(cast<Digits50>(A)));
    BOOST_TEST(near(X.rotation, exact.rotation, 1.0, k));
    BOOST_TEST(near(X.translation, exact.translation, A.moment.norm(), k));
  }
}

BOOST_DATA_TEST_CASE(agrees_with_the_series_in_50_digits, data::make(angles), theta) {
  test::Sample sample(static_cast<std::uint64_t>(1 + theta * 1000));
  const Motor<Digits50> A = cast<Digits50>(turn(sample, theta));
  const Pose<Digits50> X = exp(A);
  const Pose<Digits50> exact = power_series(A);
  const double k = 512 * std::max(1.0, theta);  // the series is squared seven times
  BOOST_TEST(near(X.rotation, exact.rotation, Digits50(1), k));
  BOOST_TEST(near(X.translation, exact.translation, Digits50(A.moment.norm()), k));
}

BOOST_AUTO_TEST_SUITE_END()

BOOST_AUTO_TEST_SUITE(the_logarithm)

BOOST_AUTO_TEST_CASE(log_of_the_identity_is_exactly_zero) {
  BOOST_TEST(same(log(Pose<>{}), Motor<>{}));
}

BOOST_AUTO_TEST_CASE(log_of_a_shift_is_exactly_a_couple) {
  const Vector3<double> x(1, -2, 3e10);
  BOOST_TEST(same(log(Pose<>{Matrix3<double>::Identity(), x}), Motor<>{{0, 0, 0}, x}));
}

// Anchor: half a turn about x, applied at (0, 1, 0): the axis passes through (0, 1/2, 0).
BOOST_AUTO_TEST_CASE(log_of_a_half_turn_by_hand) {
  const Pose<> X{Vector3<double>(1, -1, -1).asDiagonal(), {0, 1, 0}};
  const Motor<> A = log(X);
  BOOST_TEST(near(A.resultant, Vector3<double>(pi, 0, 0), pi, 1));
  BOOST_TEST(near(A.moment, Vector3<double>(0, 0, -pi / 2), pi, 2));
}

// The matrix of a half turn is symmetric: only its symmetric part contains the axis.
BOOST_DATA_TEST_CASE(log_of_a_half_turn_finds_the_axis, data::xrange(100u), seed) {
  test::Sample sample(seed);
  const Vector3<double> n = sample.direction();
  const Vector3<double> x = sample.vector();
  const Matrix3<double> R = 2 * n * n.transpose() - Matrix3<double>::Identity();
  const Motor<> A = log(Pose<>{R, x});
  const double sign = A.resultant.dot(n) > 0 ? 1 : -1;
  BOOST_TEST(near(A.resultant, Vector3<double>(sign * pi * n), pi, 8));
  Eigen::Index largest = 0;
  A.resultant.cwiseAbs().maxCoeff(&largest);
  BOOST_TEST(A.resultant[largest] > 0);
  const Pose<> X = exp(A);
  BOOST_TEST(near(X.rotation, R, 1.0, 24));
  BOOST_TEST(near(X.translation, x, x.norm(), 24));
}

BOOST_DATA_TEST_CASE(undoes_the_exponential_in_fifty_digits, data::make(the_exponential::angles),
                     theta) {
  if (theta >= pi) return;
  test::Sample sample(static_cast<std::uint64_t>(1 + theta * 1000));
  const Motor<Digits50> A = cast<Digits50>(turn(sample, theta));
  const Motor<Digits50> B = log(power_series(A));
  BOOST_TEST(near(B.resultant, A.resultant, Digits50(A.resultant.norm()), 64));
  BOOST_TEST(near(B.moment, A.moment, Digits50(A.moment.norm()), 64));
}

// The same matrix, read in 50 digits. It is orthogonal to u only, so that |log| is uncertain to
// that extent.
BOOST_DATA_TEST_CASE(agrees_with_fifty_digits, data::make(the_exponential::angles), theta) {
  if (theta >= pi) return;
  test::Sample sample(static_cast<std::uint64_t>(1 + theta * 1000));
  for (int i = 0; i < 20; ++i) {
    const Pose<> X = cast<double>(power_series(cast<Digits50>(turn(sample, theta))));
    const Motor<> exact = cast<double>(log(cast<Digits50>(X)));
    const Motor<> A = log(X);
    BOOST_TEST(near(A.resultant, exact.resultant, exact.resultant.norm(), 8));
    BOOST_TEST(near(A.moment, exact.moment, exact.moment.norm(), 8));
  }
}

struct Range {
  const char* name;
  double low, high;  // of theta, evenly over the decades; near pi those of pi - theta
  bool from_pi;
  double limit;  // in units of 1e-16
};

// The table in displacement.hpp. Away from pi the limit is 1e-15.
BOOST_AUTO_TEST_CASE(log_of_exp_is_the_motor) {
  const Range ranges[] = {{"< 1e-8", 1e-30, 1e-8, false, 4},
                          {"1e-8..1e-3", 1e-8, 1e-3, false, 10},
                          {"1e-3..1", 1e-3, 1, false, 10},
                          {"1..pi-1e-3", 1e-3, pi - 1, true, 10},
                          {"pi-1e-3..pi", 1e-14, 1e-3, true, 12}};
  std::printf("log(exp(A)), worst relative error of %d motors, in units of 1e-16\n",
              motors_per_range);
  std::printf("%-14s %10s %10s\n", "theta", "resultant", "moment");
  test::Sample sample(1);
  for (const Range& range : ranges) {
    double resultant = 0;
    double moment = 0;
    for (int i = 0; i < motors_per_range; ++i) {
      const bool even = range.high > 1 || sample.once_in(2);  // the end with the greater errors
      const double distance = even
                                  ? sample.uniform(range.low, range.high)
                                  : sample.magnitude(std::log10(range.low), std::log10(range.high));
      const Motor<> A = turn(sample, range.from_pi ? pi - distance : distance);
      const Motor<> B = log(exp(A));
      resultant = test::worst_of(resultant, relative(B.resultant, A.resultant));
      moment = test::worst_of(moment, relative(B.moment, A.moment));
    }
    std::printf("%-14s %10.1f %10.1f\n", range.name, resultant * 1e16, moment * 1e16);
    BOOST_TEST(resultant <= range.limit * 1e-16);
    BOOST_TEST(moment <= range.limit * 1e-16);
  }
}

BOOST_AUTO_TEST_SUITE_END()
