#include <boost/test/unit_test.hpp>

#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <type_traits>

#include <dynamics/guide/posed.hpp>
#include <dynamics/guide/rates.hpp>
#include <motor/attitude.hpp>

#include <support/worst.hpp>

using namespace kreisel;

namespace {

const Vector3<double> gravity(0, 0, -9.81);

/// The log of gyros and accelerometers in a moving frame.
template <class Motion>
RatesLog logged(const Motion& motion, double end, int steps) {
  RatesLog log;
  for (int i = 0; i <= steps; ++i) {
    const double t = i < steps ? end * i / steps : end;
    const auto now = motion(t);
    log.times.push_back(t);
    log.angular_velocities.push_back(now.V.value.resultant);
    log.accelerations.push_back(now.origin_acceleration() -
                                now.X.value.rotation.transpose() * gravity);
  }
  return log;
}

template <class Motion>
RatesStart start_of(const Motion& motion) {
  const auto now = motion(0.0);
  return {Eigen::Quaterniond(now.X.value.rotation), now.X.value.rotation * now.V.value.moment,
          gravity};
}

/// Coning: an axis tilted by `tilt` against z rotates about z at `rate`, without spin about itself.
struct Coning {
  double tilt;
  double rate;

  [[nodiscard]] Eigen::Quaterniond attitude(double t) const {
    return {std::cos(tilt / 2), std::sin(tilt / 2) * std::cos(rate * t),
            std::sin(tilt / 2) * std::sin(rate * t), 0};
  }
  [[nodiscard]] Vector3<double> angular_velocity(double t) const {
    return {-rate * std::sin(tilt) * std::sin(rate * t), rate * std::sin(tilt) * std::cos(rate * t),
            rate * (std::cos(tilt) - 1)};
  }
};

constexpr auto swell = [](const auto& t) {
  using std::sin;
  using T = std::decay_t<decltype(t)>;
  return Pose<T>{
      YawPitchRoll<T>{T(0.1 * t), T(0.1 * sin(1.3 * t + 0.4)), T(0.3 * sin(0.9 * t))}.rotation(),
      Vector3<T>(5 * t, sin(0.7 * t), 0.5 * sin(1.1 * t))};
};

double angle(const Eigen::Quaterniond& a, const Eigen::Quaterniond& b) {
  return 2 * (a.conjugate() * b).vec().norm();
}

}  // namespace

BOOST_AUTO_TEST_SUITE(logged_rates)

// Coning at 50 rad/s for 4 s, logged at 10 kHz, which reduces the spline's error to rounding.
BOOST_AUTO_TEST_CASE(give_coning_in_closed_form) {
  const Coning coning{0.1, 50};
  RatesLog log;
  constexpr int steps = 40'000;
  for (int i = 0; i <= steps; ++i) {
    log.times.push_back(4.0 * i / steps);
    log.angular_velocities.push_back(coning.angular_velocity(log.times.back()));
  }
  const RatesFrame<> frame(log, {coning.attitude(0)});
  double worst = 0;
  for (int i = 0; i <= 1000; ++i) {
    const double t = i < 1000 ? 4.0 * i / 1000 : frame.end();
    const auto now = frame(t);
    worst =
        test::worst_of(worst, angle(Eigen::Quaterniond(now.X.value.rotation), coning.attitude(t)));
    BOOST_TEST((now.V.value.resultant - coning.angular_velocity(t)).norm() < 1e-11);
  }
  BOOST_TEST_MESSAGE("coning: off by " << worst << " rad");
  BOOST_TEST(worst < 1e-12);
}

// A constant rate has a closed form too; 1e4 rad in pieces of 2 rad.
BOOST_AUTO_TEST_CASE(give_many_turns_to_rounding) {
  const Vector3<double> u(12, -16, 0);
  RatesLog log;
  for (int i = 0; i <= 5000; ++i) {
    log.times.push_back(0.1 * i);
    log.angular_velocities.push_back(u);
  }
  const RatesFrame<> frame(log);
  const double t = frame.end();
  const Eigen::Quaterniond turned(Eigen::AngleAxisd(std::fmod(20 * t, 2 * M_PI), u / 20));
  BOOST_TEST(angle(Eigen::Quaterniond(frame(t).X.value.rotation), turned) < 3e-12);
}

// Attitude and position against the differentiated pose, to the order of the spline.
BOOST_AUTO_TEST_CASE(give_the_motion_to_the_sixth_order) {
  const auto motion = posed(swell);
  const auto off = [&](int steps) {
    const RatesFrame<> frame(logged(motion, 20, steps), start_of(motion));
    const auto place_at_start = motion(0.0).X.value.translation;
    double worst = 0;
    for (int i = 0; i <= 400; ++i) {
      const double t = 20.0 * i / 400;
      const auto a = frame(t);
      const auto b = motion(t);
      const Matrix3<double> turn = a.X.value.rotation.transpose() * b.X.value.rotation;
      worst =
          test::worst_of(worst, log(Pose<double>{turn}).resultant.norm(),
                         (a.X.value.translation + place_at_start - b.X.value.translation).norm());
    }
    return worst;
  };
  const double coarse = off(100);
  const double fine = off(200);
  BOOST_TEST_MESSAGE("swell: off by " << fine << ", order " << std::log2(coarse / fine));
  BOOST_TEST(std::log2(coarse / fine) > 5);
  BOOST_TEST(off(2000) < 1e-10);
}

// Kutta's steps, written here, along the same spline of few samples.
BOOST_AUTO_TEST_CASE(agree_with_another_integrator) {
  const auto motion = posed(swell);
  const RatesLog log = logged(motion, 6, 30);
  const RatesFrame<> frame(log, start_of(motion));
  Eigen::Quaterniond q = start_of(motion).attitude;
  const auto rate = [&](double t, const Eigen::Quaterniond& at) {
    const Vector3<double> u = frame(std::min(t, frame.end())).V.value.resultant;
    return Eigen::Vector4d((at * Eigen::Quaterniond(0, u.x() / 2, u.y() / 2, u.z() / 2)).coeffs());
  };
  constexpr int steps = 6000;
  const double h = 6.0 / steps;
  for (int i = 0; i < steps; ++i) {
    const double t = i * h;
    const auto moved = [&](const Eigen::Vector4d& by) {
      return Eigen::Quaterniond(Eigen::Vector4d(q.coeffs() + by));
    };
    const Eigen::Vector4d a = rate(t, q);
    const Eigen::Vector4d b = rate(t + h / 2, moved(h / 2 * a));
    const Eigen::Vector4d c = rate(t + h / 2, moved(h / 2 * b));
    const Eigen::Vector4d d = rate(t + h, moved(h * c));
    q = moved(h / 6 * (a + 2 * b + 2 * c + d));
  }
  const double off = angle(Eigen::Quaterniond(frame(frame.end()).X.value.rotation), q.normalized());
  BOOST_TEST(off < 1e-12);
}

BOOST_AUTO_TEST_CASE(are_refused_if_invalid) {
  const auto motion = posed(swell);
  const auto refused = [&](const std::string& why, const std::function<void(RatesLog&)>& spoil) {
    RatesLog log = logged(motion, 2, 20);
    spoil(log);
    BOOST_CHECK_EXCEPTION((RatesFrame<>(log)), InvalidInput, [&](const InvalidInput& e) {
      return std::string(e.what()).find(why) != std::string::npos;
    });
  };
  refused("3 samples", [](RatesLog& log) { log.times.resize(3); });
  refused("20 accelerations", [](RatesLog& log) { log.accelerations.pop_back(); });
  refused("sample 6: not a finite", [](RatesLog& log) {
    log.angular_velocities[5].x() = std::numeric_limits<double>::quiet_NaN();
  });
  refused("must be later", [](RatesLog& log) { log.times[5] = log.times[4]; });
  refused("turns by more", [](RatesLog& log) { log.angular_velocities[5].x() = 1e9; });
  RatesStart start;
  start.attitude.coeffs() *= 2;
  BOOST_CHECK_THROW((RatesFrame<>(logged(motion, 2, 20), start)), InvalidInput);
}

BOOST_AUTO_TEST_SUITE_END()
