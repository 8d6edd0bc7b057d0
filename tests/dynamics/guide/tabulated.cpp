#include <boost/test/data/monomorphic.hpp>
#include <boost/test/data/test_case.hpp>
#include <boost/test/unit_test.hpp>

#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <type_traits>

#include <dynamics/guide/posed.hpp>
#include <dynamics/guide/tabulated.hpp>
#include <motor/attitude.hpp>

#include <support/near.hpp>
#include <support/sample.hpp>
#include <support/worst.hpp>

using namespace kreisel;
using test::near;
namespace data = boost::unit_test::data;

namespace {

/// A ship in a swell.
constexpr auto swell = [](const auto& t) {
  using std::sin;
  using T = std::decay_t<decltype(t)>;
  const T yaw = 0.1 * t;
  const T pitch = 0.1 * sin(1.3 * t + 0.4);
  const T roll = 0.3 * sin(0.9 * t);
  return Pose<T>{YawPitchRoll<T>{yaw, pitch, roll}.rotation(),
                 Vector3<T>(5 * t, sin(0.7 * t), 0.5 * sin(1.1 * t + 1.5))};
};

/// The swell logged from 0 to `end`; `uneven` shifts samples by up to that part of the spacing.
MotionLog<> logged(double end, int samples, double uneven = 0) {
  test::Sample sample(7);
  MotionLog<> log;
  for (int i = 0; i < samples; ++i) {
    const double shift = i == 0 || i == samples - 1 ? 0 : sample.uniform(-uneven, uneven);
    const double t = end * (i + shift) / (samples - 1);
    const Pose<double> X = swell(t);
    log.times.push_back(t);
    log.attitudes.emplace_back(X.rotation);
    if (sample.once_in(2)) log.attitudes.back().coeffs() *= -1;  // as real loggers do
    log.positions.push_back(X.translation);
  }
  return log;
}

/// The greatest true errors over the table.
InterpolationError<> errors(const TabulatedFrame<>& frame) {
  InterpolationError<> e{};
  const auto exact = posed(swell);
  for (int i = 0; i <= 4000; ++i) {
    const double t = frame.begin() + (frame.end() - frame.begin()) * i / 4000;
    const auto a = frame(t);
    const auto b = exact(t);
    const Matrix3<double> off = a.X.value.rotation.transpose() * b.X.value.rotation;
    const auto note = [](double& most, double x) { most = test::worst_of(most, x); };
    note(e.attitude, log(Pose<double>{off}).resultant.norm());
    note(e.angular_velocity, (a.V.value - b.V.value).resultant.norm());
    note(e.angular_acceleration, (a.dV.value - b.dV.value).resultant.norm());
    note(e.position, (a.X.value.translation - b.X.value.translation).norm());
    note(e.velocity,
         (a.X.value.rotation * a.V.value.moment - b.X.value.rotation * b.V.value.moment).norm());
    note(e.acceleration, (a.X.value.rotation * a.origin_acceleration() -
                          b.X.value.rotation * b.origin_acceleration())
                             .norm());
  }
  return e;
}

const std::pair<const char*, double InterpolationError<>::*> parts[] = {
    {"attitude", &InterpolationError<>::attitude},
    {"angular velocity", &InterpolationError<>::angular_velocity},
    {"angular acceleration", &InterpolationError<>::angular_acceleration},
    {"position", &InterpolationError<>::position},
    {"velocity", &InterpolationError<>::velocity},
    {"acceleration", &InterpolationError<>::acceleration}};

}  // namespace

BOOST_AUTO_TEST_SUITE(a_logged_motion)

BOOST_DATA_TEST_CASE(is_followed_to_the_sixth_order, data::make({0.0, 0.3}), uneven) {
  const auto coarse = errors(TabulatedFrame<>(logged(20, 101, uneven)));
  const auto fine = errors(TabulatedFrame<>(logged(20, 201, uneven)));
  // Two uneven grids are no refinements of each other: half an order is left to chance.
  const double chance = uneven > 0 ? 0.5 : 0;
  const double least[] = {5.5, 4.5, 3.5, 5.5, 4.5, 3.5};
  for (int i = 0; i < 6; ++i) {
    const auto& [name, part] = parts[i];
    const double order = std::log2(coarse.*part / (fine.*part));
    BOOST_TEST_MESSAGE(name << ": " << fine.*part << ", order " << order);
    BOOST_TEST(order > least[i] - chance);
  }
  BOOST_TEST(fine.attitude < 1e-7);
}

// Reliable: never below the true error, and at most fifteen times as large.
BOOST_DATA_TEST_CASE(reports_its_interpolation_error,
                     data::make({41, 101, 401, 1001}) * data::make({0.0, 0.3}), samples, uneven) {
  const TabulatedFrame<> frame(logged(20, samples, uneven));
  const auto truth = errors(frame);
  const auto told = frame.interpolation_error();
  for (const auto& [name, part] : parts) {
    const double ratio = told.*part / (truth.*part);
    BOOST_TEST_MESSAGE(name << ": true " << truth.*part << ", told " << told.*part << ", ratio "
                            << ratio);
    BOOST_TEST(ratio > 1);
    BOOST_TEST(ratio < 15);
  }
}

BOOST_AUTO_TEST_CASE(passes_through_its_samples) {
  const MotionLog<> log = logged(20, 60, 0.4);
  const TabulatedFrame<> frame(log);
  for (std::size_t i = 0; i < log.times.size(); ++i) {
    const Pose<double> X = frame(log.times[i]).X.value;
    BOOST_TEST(near(X.rotation, Pose<double>::from(log.attitudes[i]).rotation, 1.0, 32));
    BOOST_TEST(near(X.translation, log.positions[i], 100.0, 16));
  }
}

// The same motion seen from other axes, and written on other axes of the guide.
BOOST_AUTO_TEST_CASE(does_not_depend_on_its_axes) {
  test::Sample sample(3);
  const Eigen::Quaterniond outer(sample.rotation());
  const Eigen::Quaterniond inner(sample.rotation());
  MotionLog<> log = logged(5, 26);
  const TabulatedFrame<> one(log);
  for (auto& q : log.attitudes) q = outer * q * inner;
  for (auto& x : log.positions) x = outer * x;
  const TabulatedFrame<> other(log);
  const Matrix3<double> axes = Pose<double>::from(inner).rotation;
  for (const double t : {0.0, 0.7, 2.501, 4.9}) {
    const auto a = one(t);
    const auto b = other(t);
    BOOST_TEST(near(Vector3<double>(axes * b.V.value.resultant), a.V.value.resultant, 10.0, 200));
    BOOST_TEST(
        near(Vector3<double>(axes * b.dV.value.resultant), a.dV.value.resultant, 100.0, 400));
    BOOST_TEST(near(Vector3<double>(axes * b.dV.value.moment), a.dV.value.moment, 1000.0, 400));
  }
}

// Angular velocity and acceleration are derivatives of the returned attitude, at the knots too.
BOOST_AUTO_TEST_CASE(has_the_rates_of_its_attitude) {
  const TabulatedFrame<> frame(logged(20, 41));
  constexpr double h = 1e-5;
  for (const double t : {0.5, 1.0, 7.77, 19.0}) {  // 0.5, 1 and 19 are knots
    const auto R = [&](double time) { return frame(time).X.value.rotation; };
    const Matrix3<double> turn = R(t - h).transpose() * R(t + h);
    const Vector3<double> u = log(Pose<double>{turn}).resultant / (2 * h);
    BOOST_TEST(near(u, frame(t).V.value.resultant, 1.0, 1e-9 / test::u<>));
    const Vector3<double> du =
        (frame(t + h).V.value.resultant - frame(t - h).V.value.resultant) / (2 * h);
    BOOST_TEST(near(du, frame(t).dV.value.resultant, 1.0, 1e-8 / test::u<>));
  }
}

BOOST_AUTO_TEST_CASE(at_rest_is_exactly_at_rest) {
  test::Sample sample(5);
  const Eigen::Quaterniond q(sample.rotation());
  MotionLog<> log;
  for (int i = 0; i < 30; ++i) {
    log.times.push_back(0.1 * i);
    log.attitudes.push_back(q);
    log.positions.emplace_back(1e6, 2, 3);
  }
  const auto motion = TabulatedFrame<>(log)(1.234);
  BOOST_TEST(motion.V.value.resultant == Vector3<double>(0, 0, 0));
  BOOST_TEST(motion.V.value.moment == Vector3<double>(0, 0, 0));
  BOOST_TEST(motion.dV.value.resultant == Vector3<double>(0, 0, 0));
  BOOST_TEST(motion.X.value.translation == Vector3<double>(1e6, 2, 3));
}

BOOST_AUTO_TEST_CASE(may_be_as_short_as_four_samples) {
  for (const int samples : {4, 5, 6, 7, 11, 23}) {
    const TabulatedFrame<> frame(logged(0.5, samples));
    BOOST_TEST(errors(frame).attitude < 1e-3);
    BOOST_TEST(frame.interpolation_error().attitude < 1e-2);
  }
}

BOOST_AUTO_TEST_CASE(is_not_continued_beyond_its_ends) {
  const TabulatedFrame<> frame(logged(20, 41));
  BOOST_CHECK_EXCEPTION((void)frame(20.000001), InvalidInput, [](const InvalidInput& e) {
    return std::string(e.what()) ==
           "motion log: t = 20.000001 s lies outside [0, 20] s, for which the motion is known";
  });
  BOOST_CHECK_THROW((void)frame(-1e-12), InvalidInput);
  BOOST_CHECK_THROW((void)frame(std::numeric_limits<double>::quiet_NaN()), InvalidInput);
}

namespace {

void refused(const std::string& why, const std::function<void(MotionLog<>&)>& spoil) {
  MotionLog<> log = logged(20, 41);
  spoil(log);
  BOOST_CHECK_EXCEPTION(TabulatedFrame<>{log}, InvalidInput, [&](const InvalidInput& e) {
    BOOST_TEST_MESSAGE(e.what());
    return std::string(e.what()).find(why) != std::string::npos;
  });
}

}  // namespace

BOOST_AUTO_TEST_CASE(is_refused_if_invalid) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  refused("3 samples", [](MotionLog<>& log) { log.times.resize(3); });
  refused("41 times, 40 attitudes", [](MotionLog<>& log) { log.attitudes.pop_back(); });
  refused("41 attitudes, 40 positions", [](MotionLog<>& log) { log.positions.pop_back(); });
  refused("sample 6, t = 2.5 s: not a finite",
          [&](MotionLog<>& log) { log.positions[5].y() = nan; });
  refused("not a finite", [&](MotionLog<>& log) { log.attitudes[5].w() = nan; });
  refused("not a finite", [&](MotionLog<>& log) { log.times[5] = nan; });
  refused("must be later", [](MotionLog<>& log) { log.times[5] = log.times[4]; });
  refused("norm 0", [](MotionLog<>& log) { log.attitudes[5].coeffs().setZero(); });
  refused("norm 2", [](MotionLog<>& log) { log.attitudes[5].coeffs() *= 2; });
  refused("more than 90 degrees", [](MotionLog<>& log) {
    log.attitudes[5] = log.attitudes[5] * Eigen::Quaterniond(0, 1, 0, 0);
  });
}

BOOST_AUTO_TEST_SUITE_END()
