#include <boost/multiprecision/cpp_bin_float.hpp>
#include <boost/test/data/monomorphic.hpp>
#include <boost/test/data/test_case.hpp>
#include <boost/test/unit_test.hpp>

#include <cmath>
#include <limits>
#include <type_traits>

#include <dynamics/guide/chain.hpp>
#include <dynamics/guide/harmonic.hpp>
#include <dynamics/guide/posed.hpp>
#include <dynamics/guide/resting.hpp>
#include <dynamics/guide/rotating.hpp>
#include <dynamics/guide/steady.hpp>
#include <dynamics/step/explicit.hpp>
#include <motor/attitude.hpp>

#include <support/cast.hpp>
#include <support/jet.hpp>
#include <support/kinematics.hpp>
#include <support/near.hpp>
#include <support/sample.hpp>

/// Every kind of guide motion against an independent calculation of pose and derivatives.

using namespace kreisel;
using test::Digits50;
using test::near;
namespace data = boost::unit_test::data;

// Not in an unnamed namespace: lambdas in test functions, whose types have linkage, keep a Swing.
namespace kinds {

struct Ship {};
struct Earth {};

template <class T>
Pose<T> constant(const Pose<double>& X) {
  const auto number = [](double x) { return T(x); };
  return {X.rotation.unaryExpr(number), X.translation.unaryExpr(number)};
}

/// The turn about z by u t.
template <class T>
Pose<T> turn_about_z(double u, const T& t) {
  const YawPitchRoll<T> angles{T(T(u) * t), T(0), T(0)};
  return {angles.rotation(), Vector3<T>(T(0), T(0), T(0))};
}

/// A pose that swings: yaw, pitch, roll and position as trend plus oscillation.
struct Swing {
  double trend[6] = {}, size[6] = {}, frequency[6] = {}, phase[6] = {};

  static Swing random(test::Sample& sample, double length) {
    Swing s;
    for (int i = 0; i < 6; ++i) {
      s.trend[i] = sample.uniform(-0.5, 0.5) * (i < 3 ? 1 : length);
      s.size[i] = sample.uniform(-0.5, 0.5) * (i < 3 ? 1 : length);
      s.frequency[i] = sample.uniform(0.1, 3);
      s.phase[i] = sample.uniform(-3, 3);
    }
    return s;
  }

  template <class T>
  Pose<T> operator()(const T& t) const {
    using std::sin;
    const auto part = [&](int i) {
      const T angle = T(frequency[i]) * t + T(phase[i]);
      return T(T(trend[i]) * t + T(size[i]) * sin(angle));
    };
    return {YawPitchRoll<T>{part(0), part(1), part(2)}.rotation(),
            Vector3<T>(part(3), part(4), part(5))};
  }

  /// The same motion in the truth's type.
  test::Motion motion() const {
    const auto wave = [&](int i) {
      return test::Wave{0, trend[i], 0, size[i], frequency[i], phase[i]};
    };
    return {wave(0), wave(1), wave(2), wave(3), wave(4), wave(5)};
  }
};

using Jet = test::Jet<Digits50>;

/// The motion of a pose in 50 digits, by the jets of the truth.
FrameMotion<Guide, Inertial, Digits50> differentiated(const Pose<Jet>& X) {
  const auto skew_part = [](const Matrix3<Digits50>& m) -> Vector3<Digits50> {
    return Vector3<Digits50>(m(2, 1) - m(1, 2), m(0, 2) - m(2, 0), m(1, 0) - m(0, 1)) / Digits50(2);
  };
  const Matrix3<Digits50> to_guide = test::value(X.rotation).transpose();
  const Vector3<Digits50> u = skew_part(to_guide * test::first(X.rotation));
  const Vector3<Digits50> v = to_guide * test::first(X.translation);
  FrameMotion<Guide, Inertial, Digits50> motion;
  motion.X.value = {test::value(X.rotation), test::value(X.translation)};
  motion.V.value = {u, v};
  motion.dV.value = {skew_part(to_guide * test::second(X.rotation)),
                     to_guide * test::second(X.translation) - u.cross(v)};
  return motion;
}

/// The time t as a jet.
Jet clock(double t) { return {Digits50(t), Digits50(1), Digits50(0)}; }

template <class A, class B, class S>
test::Verdict agree(const FrameMotion<A, B, double>& found, const FrameMotion<A, B, S>& exact,
                    double length, double k) {
  const auto real = [](const auto& x) { return test::cast<double>(x); };
  const auto turn = near(found.X.value.rotation, real(exact.X.value.rotation), 1.0, k, "rotation ");
  if (!turn) return turn;
  const auto place =
      near(found.X.value.translation, real(exact.X.value.translation), length, k, "place ");
  if (!place) return place;
  const Motor<double> V = real(exact.V.value);
  const Motor<double> dV = real(exact.dV.value);
  const double rate = 1 + V.resultant.norm();
  const auto u = near(found.V.value.resultant, V.resultant, rate, k, "u ");
  if (!u) return u;
  const auto v = near(found.V.value.moment, V.moment, rate * length, k, "v ");
  if (!v) return v;
  const double acceleration = rate * rate + dV.resultant.norm();
  const auto du = near(found.dV.value.resultant, dV.resultant, acceleration, k, "ou ");
  return du ? near(found.dV.value.moment, dV.moment, acceleration * length, k, "ov ") : du;
}

}  // namespace kinds

using namespace kinds;

BOOST_AUTO_TEST_SUITE(a_posed_frame)

// The truth's guide carries point masses; only its own motion matters here.
BOOST_DATA_TEST_CASE(is_differentiated_exactly, data::xrange(100u), seed) {
  test::Sample sample(seed);
  const Swing swing = Swing::random(sample, 2);
  const double t = sample.uniform(-3, 3);
  const test::Truth truth = test::truth(swing.motion(), test::Motion{}, t, {});
  const FrameMotion<Guide, Inertial, Digits50> exact{{truth.X_IG}, {truth.F_G}, {truth.dF_G}};
  BOOST_TEST(agree(posed(swing)(t), exact, 8, 32));
}

BOOST_AUTO_TEST_SUITE_END()

BOOST_AUTO_TEST_SUITE(a_chain_from_earth_to_device)

// earth -> ship -> device against ONE pose, the product of the three, differentiated in 50 digits.
// Relative to the earth's centre, lengths are measured in earth radii: 6.4e6 m and 465 m/s.
BOOST_DATA_TEST_CASE(agrees_with_the_product_of_poses, data::xrange(60u), seed) {
  test::Sample sample(seed);
  const Swing ship = Swing::random(sample, 20);
  const Swing device = Swing::random(sample, 0.5);
  const double u = 7.292115e-5;
  const Pose<double> site{sample.rotation(), 6.4e6 * sample.direction()};
  const double t = sample.uniform(0, 20);

  SteadyFrame<Earth, Inertial> earth;
  earth.X = {site};
  earth.V = {{{0, 0, u}, {0, 0, 0}}};
  const Chain chain(earth, posed<Ship, Earth>(ship), posed<Guide, Ship>(device));
  static_assert(GuideMotion<decltype(chain)>);

  const Jet time = clock(t);
  const auto found = chain(t);
  const auto exact =
      differentiated(turn_about_z(u, time) * constant<Jet>(site) * ship(time) * device(time));

  BOOST_TEST(near(found.X.value.rotation, test::cast<double>(exact.X.value.rotation), 1.0, 90));
  // 1e-14 of the greatest term in each, because the sums of the chain are that large.
  const double k = 1e-14 / test::u<>;
  const auto check = [&](const Vector3<double>& a, const Vector3<Digits50>& b, double scale) {
    return near(a, test::cast<double>(b), scale, k);
  };
  const double rate = 1 + found.V.value.resultant.norm();
  BOOST_TEST(check(found.X.value.translation, exact.X.value.translation, 6.4e6));
  BOOST_TEST(check(found.V.value.resultant, exact.V.value.resultant, rate));
  BOOST_TEST(check(found.V.value.moment, exact.V.value.moment, 465 + 20 * rate));
  BOOST_TEST(check(found.dV.value.resultant, exact.dV.value.resultant, rate * rate));
  BOOST_TEST(check(found.dV.value.moment, exact.dV.value.moment, (465 + 20 * rate) * rate));
  // A body's apparent field contains the 465 m/s of the earth's surface through rounding only.
  BOOST_TEST(
      check(found.origin_acceleration(), exact.origin_acceleration(), (465 + 20 * rate) * rate));
}

BOOST_AUTO_TEST_SUITE_END()

BOOST_AUTO_TEST_SUITE(a_steady_frame)

BOOST_DATA_TEST_CASE(turns_with_the_earth, data::xrange(50u), seed) {
  test::Sample sample(seed);
  const Pose<double> site{sample.rotation(), 3 * sample.direction()};
  const double u = sample.uniform(-2, 2);
  const double t = sample.uniform(-3, 3);
  SteadyFrame<> frame;
  frame.X = {site};
  frame.V = {{{0, 0, u}, {0, 0, 0}}};
  const auto exact = differentiated(turn_about_z(u, clock(t)) * constant<Jet>(site));
  // The site's rotation is orthogonal to 2u only, which affects its 50-digit derivatives.
  BOOST_TEST(agree(frame(t), exact, 4, 32));
}

BOOST_AUTO_TEST_SUITE_END()

BOOST_AUTO_TEST_SUITE(a_rotating_frame)

// Turning about z with an acceleration constant on its own axes: all integrals are elementary.
BOOST_DATA_TEST_CASE(is_carried_by_its_own_acceleration, data::xrange(200u), seed) {
  using std::cos;
  using std::sin;
  test::Sample sample(seed);
  const Matrix3<double> R0 = sample.rotation();
  const double w = sample.number(-6, 1);
  const Vector3<double> a = 2 * sample.direction();
  const Vector3<double> x0 = sample.direction();
  const Vector3<double> v0 = sample.direction();
  const double t = sample.uniform(-4, 4);
  const RotatingFrame<> frame{{0, 0, w}, a, {{R0, x0}}, v0};

  Vector3<Digits50> v;
  Vector3<Digits50> x;
  const Digits50 W = w, T = t, angle = W * T, ax = a.x(), ay = a.y(), az = a.z();
  if (w == 0) {
    v = test::cast<Digits50>(a) * T;
    x = v * T / Digits50(2);
  } else {
    const Digits50 s = sin(angle), c = cos(angle);
    v = {(ax * s - ay * (1 - c)) / W, (ax * (1 - c) + ay * s) / W, az * T};
    x = {(ax * (1 - c) - ay * (angle - s)) / (W * W), (ax * (angle - s) + ay * (1 - c)) / (W * W),
         az * T * T / 2};
  }
  const Matrix3<Digits50> start = test::cast<Digits50>(R0);
  const Matrix3<Digits50> R = start * YawPitchRoll<Digits50>{angle, 0, 0}.rotation();
  const Vector3<Digits50> velocity = test::cast<Digits50>(v0) + start * v;
  const Vector3<Digits50> place =
      test::cast<Digits50>(x0) + test::cast<Digits50>(v0) * T + start * x;

  const FrameMotion<Guide, Inertial> found = frame(t);
  const double length = 1 + std::abs(t) * (1 + std::abs(t));
  const double turns = std::max(1.0, std::abs(w * t));
  const auto check = [&](const auto& p, const auto& q, double scale) {
    return near(p, test::cast<double>(q), scale * turns, 24);
  };
  BOOST_TEST(check(found.X.value.rotation, R, 1.0));
  BOOST_TEST(check(found.X.value.translation, place, 3 * length));
  const Matrix3<Digits50> to_guide = R.transpose();
  BOOST_TEST(check(found.V.value.moment, Vector3<Digits50>(to_guide * velocity), 3 * length));
  BOOST_TEST(near(found.origin_acceleration(), a, 2 + std::abs(w) * 3 * length, 8));
}

BOOST_AUTO_TEST_SUITE_END()

BOOST_AUTO_TEST_SUITE(a_harmonic_frame)

// q' = q u / 2 and x'' = q a q^-1 integrated step by step in long double: an independent pose.
BOOST_DATA_TEST_CASE(agrees_with_gyros_and_accelerometers, data::xrange(8u), seed) {
  test::Sample sample(seed);
  const auto series = [&](double size) {
    HarmonicSeries<> s{size * sample.direction(), {}};
    for (int i = 0; i < 3; ++i) {
      s.terms.push_back({size * sample.direction(), sample.uniform(0.2, 5), sample.uniform(-3, 3)});
    }
    return s;
  };
  const HarmonicSeries<> u = series(0.5);
  const HarmonicSeries<> a = series(2);
  const Pose<double> X{sample.rotation(), sample.direction()};
  const Vector3<double> v = sample.direction();
  constexpr double begin = -2, end = 60;
  const HarmonicFrame<> frame(u, a, begin, end, {X}, v);

  using Real = long double;
  using State = Eigen::Matrix<Real, 10, 1>;
  const auto fine_u = u.cast<Real>();
  const auto fine_a = a.cast<Real>();
  const auto field = [&](Real t, const State& y) {
    const Eigen::Quaternion<Real> q(Eigen::Matrix<Real, 4, 1>(y.head<4>()));
    const Vector3<Real> half = fine_u(t) / 2;
    State rate;
    rate << (q * Eigen::Quaternion<Real>(0, half.x(), half.y(), half.z())).coeffs(), y.tail<3>(),
        Pose<Real>::from(q).rotation * fine_a(t);
    return rate;
  };
  State start;
  start << Eigen::Quaternion<Real>(test::cast<Real>(X.rotation)).coeffs(),
      test::cast<Real>(X.translation), test::cast<Real>(v);
  ExplicitRungeKutta steps(field, Real(begin), start, {.relative = 1e-16},
                           std::array<int, 3>{4, 3, 3});
  for (const double t : {-2.0, -1.9, 0.0, 7.3, 30.0, 59.99, 60.0}) {
    const State y = steps.advance_to(t);
    const Eigen::Quaternion<Real> q(Eigen::Matrix<Real, 4, 1>(y.head<4>()));
    const Matrix3<Real> R = Pose<Real>::from(q).rotation;
    const FrameMotion<Guide, Inertial> found = frame(t);
    const double length = 1 + (t - begin) * (1 + 4 * (t - begin));
    BOOST_TEST(near(found.X.value.rotation, test::cast<double>(R), 1.0, 40));
    BOOST_TEST(near(found.X.value.translation, test::cast<double>(Vector3<Real>(y.segment<3>(4))),
                    length, 20));
    const Vector3<Real> velocity = R.transpose() * y.tail<3>();
    BOOST_TEST(near(found.V.value.moment, test::cast<double>(velocity), 1 + 8 * (t - begin), 40));
    BOOST_TEST(found.V.value.resultant == u(t));
    BOOST_TEST(near(found.origin_acceleration(), a(t), 1 + 8 * (t - begin), 8));
  }
}

// Rolling about one axis has a closed form: the angle is the integral of c + A sin(w t + p).
BOOST_AUTO_TEST_CASE(rolls_by_the_integral_of_its_rate) {
  const HarmonicFrame<> frame({{0.1, 0, 0}, {{{0.3, 0, 0}, 0.7, 0.2}}}, {}, 0, 2000);
  for (const double t : {0.0, 1.0, 123.4, 2000.0}) {
    const Digits50 T = t;
    const Digits50 angle =
        Digits50(0.1) * T - Digits50(0.3) / Digits50(0.7) *
                                (cos(Digits50(0.7) * T + Digits50(0.2)) - cos(Digits50(0.2)));
    const auto exact = YawPitchRoll<Digits50>{0, 0, angle}.rotation();
    BOOST_TEST(near(frame(t).X.value.rotation, test::cast<double>(exact), 1.0, 90));
  }
}

BOOST_AUTO_TEST_CASE(differentiates_its_series) {
  const HarmonicSeries<> s{{1, 2, 3}, {{{0.5, 0, 0}, 2, 0.3}, {{0, 4, 0}, 0.5, 1}}};
  BOOST_TEST(near(s.rate(0.7), Vector3<double>(std::cos(1.7), 2 * std::cos(1.35), 0), 2.0, 4));
}

BOOST_AUTO_TEST_CASE(refuses_invalid_motions) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  const HarmonicSeries<> none;
  BOOST_CHECK_THROW((HarmonicFrame<>(none, none, 1, 0)), InvalidInput);
  BOOST_CHECK_THROW((HarmonicFrame<>(none, none, 0, nan)), InvalidInput);
  BOOST_CHECK_THROW((HarmonicFrame<>({{nan, 0, 0}, {}}, none, 0, 1)), InvalidInput);
  BOOST_CHECK_THROW((HarmonicFrame<>(none, {{0, 0, 0}, {{{1, 0, 0}, nan, 0}}}, 0, 1)),
                    InvalidInput);
  BOOST_CHECK_THROW((HarmonicFrame<>({{0, 0, 0}, {{{1, 0, nan}, 1, 0}}}, none, 0, 1)),
                    InvalidInput);
  BOOST_CHECK_THROW((HarmonicFrame<>({{0, 0, 0}, {{{1, 0, 0}, 1, nan}}}, none, 0, 1)),
                    InvalidInput);
  BOOST_CHECK_THROW((HarmonicFrame<>(none, none, 0, HUGE_VAL)), InvalidInput);
  BOOST_CHECK_THROW((HarmonicFrame<>({{1e9, 0, 0}, {}}, none, 0, 1e9)), InvalidInput);
  const HarmonicFrame<> frame(none, none, 0, 1);
  BOOST_CHECK_THROW((void)frame(1.0001), InvalidInput);
  BOOST_CHECK_THROW((void)frame(-1e-9), InvalidInput);
  BOOST_CHECK_THROW((void)frame(nan), InvalidInput);
  BOOST_CHECK_THROW((void)frame.turning(1.0001), InvalidInput);
  BOOST_CHECK_THROW((void)frame.turning(nan), InvalidInput);
}

BOOST_AUTO_TEST_SUITE_END()

// u and ou without the pose agree with those of the whole motion to the last bit.
BOOST_DATA_TEST_CASE(rotation_agrees_with_the_whole_motion, data::xrange(20u), seed) {
  test::Sample sample(seed);
  const double t = sample.uniform(0, 10);
  const auto compare = [t](const auto& frame) {
    const FrameTurning<> found = turning(frame, t);
    BOOST_TEST(test::same(found.u, frame(t).V.value.resultant));
    BOOST_TEST(test::same(found.du, frame(t).dV.value.resultant));
  };
  const Pose<double> X{sample.rotation(), sample.direction()};
  const HarmonicSeries<> u{sample.direction(),
                           {{sample.direction(), sample.uniform(0.2, 5), sample.uniform(-3, 3)},
                            {sample.direction(), sample.uniform(0.2, 5), sample.uniform(-3, 3)}}};
  compare(HarmonicFrame<>(u, {}, 0, 10, {X}));
  compare(RotatingFrame<>{.angular_velocity = sample.direction(), .X = {X}});
  compare(SteadyFrame<>{{X}, {{sample.direction(), sample.direction()}}});
  compare(RestingFrame<>{{X}});  // and one that offers nothing more
}
