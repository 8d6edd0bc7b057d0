#include <boost/test/data/monomorphic.hpp>
#include <boost/test/data/test_case.hpp>
#include <boost/test/unit_test.hpp>
#include <unsupported/Eigen/AutoDiff>

#include <limits>
#include <optional>

#include <dynamics/guide/motion.hpp>
#include <dynamics/guide/posed.hpp>
#include <dynamics/model/dual_numbers.hpp>
#include <motor/attitude.hpp>
#include <motor/error.hpp>

#include <support/kinematics.hpp>
#include <support/sample.hpp>

using namespace kreisel;
using test::Digits50;
namespace data = boost::unit_test::data;

namespace {

using Dual = Eigen::AutoDiffScalar<Eigen::Vector2d>;

constexpr double u = std::numeric_limits<double>::epsilon() / 2;

/// A double in dual numbers of dual numbers.
template <class T>
T constant(double x) {
  if constexpr (requires(T number) { number.derivatives(); }) {
    return T(constant<typename T::Scalar>(x));
  } else {
    return T(x);
  }
}

/// Rotates and moves on all axes; the fifth derivatives of its accelerations are at most 500.
const auto pose = [](const auto& t) {
  using std::cos;
  using std::sin;
  using T = std::decay_t<decltype(t)>;
  const T half = constant<T>(0.5), once_and_half = constant<T>(1.5);
  const YawPitchRoll<T> attitude{T(half * t), T(half * sin(t + t)),
                                 T(half * cos(once_and_half * t))};
  return Pose<T>{attitude.rotation(),
                 Vector3<T>(T(sin(once_and_half * t)), T(t * t), T(half * cos(t)))};
};

/// The same with doubles only, within its time.
struct OfDoubles {
  std::optional<double> begin = {}, end = {};

  FrameMotion<Guide, Inertial> operator()(double t) const {
    if ((begin && t < *begin) || (end && t > *end)) throw InvalidInput("guide: outside its time");
    return PosedFrame<decltype(pose)>(pose)(t);
  }
};

using Numbers = Eigen::Matrix<Digits50, 24, 1>;

/// Pose, velocity and acceleration one below the other.
template <class S>
Eigen::Matrix<S, 24, 1> all_of(const FrameMotion<Guide, Inertial, S>& motion) {
  Eigen::Matrix<S, 24, 1> x;
  x << motion.X.value.rotation.reshaped(), motion.X.value.translation, motion.V.value.resultant,
      motion.V.value.moment, motion.dV.value.resultant, motion.dV.value.moment;
  return x;
}

/// The rate of all numbers, in 50 digits: the difference errs by 1e-24.
Numbers slope(double t) {
  const PosedFrame<decltype(pose), Guide, Inertial, Digits50> guide(pose);
  const Digits50 h("1e-12");
  return (all_of(guide(Digits50(t + h))) - all_of(guide(Digits50(t - h)))) / (2 * h);
}

constexpr double h4 = 0x1p-40;  // the fourth power of the difference's step

}  // namespace

BOOST_AUTO_TEST_SUITE(scenes_in_dual_numbers)

// Within its time, and at both ends.
BOOST_DATA_TEST_CASE(differentiate_a_guide_of_doubles,
                     data::make({-0.7, 0.4, 1.9}) * data::xrange(3), now, side) {
  OfDoubles guide;
  if (side == 1) guide.begin = now;
  if (side == 2) guide.end = now;
  Dual t(now);
  t.derivatives() << 1, -3;
  const auto motion = all_of(detail::guide_at<Dual>(guide, t));
  const auto values = all_of(guide(now));
  const Numbers rates = slope(now);
  for (int i = 0; i < 24; ++i) {
    BOOST_TEST_CONTEXT("component " << i) {
      BOOST_TEST(motion[i].value() == values[i]);
      const double rate = motion[i].derivatives()[0];
      // Those of the acceleration are differences.
      const double bound = i < 18 ? 32 * u : 500 * h4 / 5 + 32 * u * 0x1p10;
      BOOST_TEST(abs(double(Digits50(rate - rates[i]))) <= bound);
      BOOST_TEST(abs(motion[i].derivatives()[1] + 3 * rate) <= 8 * u * (1 + abs(rate)));
    }
  }
}

BOOST_AUTO_TEST_CASE(leave_a_guide_unchanged_at_constant_time) {
  const auto motion = all_of(detail::guide_at<Dual>(OfDoubles{}, Dual(0.4)));
  for (int i = 0; i < 24; ++i) BOOST_TEST(motion[i].derivatives().isZero(0));
}

BOOST_AUTO_TEST_CASE(refuse_a_guide_known_at_one_time) {
  Dual t(0.4);
  t.derivatives() << 1, 0;
  BOOST_CHECK_THROW((void)detail::guide_at<Dual>(OfDoubles{0.4, 0.4}, t), InvalidInput);
}

// A polynomial of the fourth degree, for which the differences are exact.
BOOST_DATA_TEST_CASE(differentiate_by_differences, data::xrange(3), side) {
  constexpr double now = 0.75;
  const auto f = [side](double t) {
    if ((side == 1 && t < now) || (side == 2 && t > now)) throw InvalidInput("outside");
    return (((t - 3) * t + 2) * t + 5) * t;
  };
  const double expected = ((4 * now - 9) * now + 4) * now + 5;
  BOOST_TEST(abs(detail::slope_in_time(f, now) - expected) <= 16 * u * 0x1p10);
}

BOOST_AUTO_TEST_CASE(pass_through_a_linear_map) {
  test::Sample sample(5);
  Matrix3<double> A;
  for (double& a : A.reshaped()) a = sample.uniform(-1, 1);
  const auto map = [&A](const Vector3<double>& x) { return Vector3<double>(A * x); };
  const Vector3<double> x = sample.vector();
  BOOST_TEST((detail::mapped(map, x) - A * x).norm() == 0);

  Eigen::Matrix<double, 3, 2> along;
  for (double& a : along.reshaped()) a = sample.uniform(-1, 1);
  Vector3<Dual> duals = x.cast<Dual>();
  for (int i = 0; i < 3; ++i) duals[i].derivatives() = along.row(i);
  const Vector3<Dual> image = detail::mapped(map, duals);
  for (int i = 0; i < 3; ++i) {
    BOOST_TEST(image[i].value() == Vector3<double>(A * x)[i]);
    for (int k = 0; k < 2; ++k) {
      BOOST_TEST(abs(image[i].derivatives()[k] - A.row(i).dot(along.col(k))) <= 4 * u);
    }
  }
}

BOOST_AUTO_TEST_SUITE_END()
