#include <boost/test/unit_test.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <type_traits>

#include <dynamics/guide/log_noise.hpp>
#include <dynamics/guide/posed.hpp>
#include <motor/attitude.hpp>

#include <support/sample.hpp>
#include <support/worst.hpp>

using namespace kreisel;

namespace {

/// A vehicle that rolls, pitches, yaws, surges, sways and heaves, each with a frequency of its own.
struct Swell {
  std::array<double, 6> amplitude;
  std::array<double, 6> frequency;
  std::array<double, 6> phase;

  template <class T>
  [[nodiscard]] Pose<T> operator()(const T& t) const {
    using std::sin;
    const auto part = [&](std::size_t k) {
      return T(amplitude[k] * sin(frequency[k] * t + phase[k]));
    };
    return {YawPitchRoll<T>{part(0), part(1), part(2)}.rotation(),
            Vector3<T>(part(3), part(4), part(5))};
  }

  explicit Swell(test::Sample& sample) {
    for (std::size_t k = 0; k < 6; ++k) {
      amplitude[k] = sample.uniform(0.05, 0.4);
      frequency[k] = sample.uniform(0.4, 2.5);
      phase[k] = sample.uniform(0, 6.28);
    }
  }
};

double rounded(double x, int decimals) {
  if (decimals > 15) return x;
  const double scale = std::pow(10.0, decimals);
  return std::round(x * scale) / scale;
}

double normal(test::Sample& sample) {
  double sum = 0;
  for (int i = 0; i < 12; ++i) sum += sample.uniform(-0.5, 0.5);
  return sum;
}

/// Sampling of a log.
struct Logger {
  double end = 10;
  double rate = 100;       ///< Hz
  int decimals = 17;       ///< of quaternion and position
  double white = 0;        ///< standard deviation
  double jitter = 0;       ///< of the times, part of the step; the written times contain it
  double dropped = 0;      ///< part of the samples that are missing
  double gap_begin = 1e9;  ///< s
  double gap = 0;          ///< s
  double late = 0;         ///< s, limit of a delay

  [[nodiscard]] std::string text() const {
    return std::to_string(rate) + " Hz, " + std::to_string(decimals) + " decimals, noise " +
           std::to_string(white * 1e6) + "e-6, jitter " + std::to_string(jitter) + ", dropped " +
           std::to_string(dropped) + ", gap " + std::to_string(gap) + " s, late " +
           std::to_string(late) + " s";
  }

  template <class Motion>
  [[nodiscard]] MotionLog<> operator()(const Motion& motion, test::Sample& sample) const {
    MotionLog<> log;
    log.late = late;
    const double first_late = late > 0 ? sample.uniform(-late, late) : 0;
    const double last_late = late > 0 ? sample.uniform(-late, late) : 0;
    const int steps = static_cast<int>(end * rate);
    for (int i = 0; i <= steps; ++i) {
      const bool inner = i > 0 && i < steps;
      const double shift = inner ? sample.uniform(-jitter, jitter) : 0;
      const double t = i < steps ? end * (i + shift) / steps : end;
      if (inner && (sample.uniform(0, 1) < dropped || (t > gap_begin && t < gap_begin + gap))) {
        continue;
      }
      const Pose<double> X = motion(t + first_late + (last_late - first_late) * t / end);
      Eigen::Quaterniond q(X.rotation);
      for (double& c : q.coeffs()) c = rounded(c + white * normal(sample), decimals);
      if (sample.once_in(9)) q.coeffs() *= -1;
      Vector3<double> x = X.translation;
      for (double& c : x) c = rounded(c + white * normal(sample), decimals);
      log.times.push_back(t);
      log.attitudes.push_back(q);
      log.positions.push_back(x);
    }
    return log;
  }
};

/// Position and velocity at the end, on guide axes, of a mass on springs in the guide, from rest. 3
/// rad/s, with a damping ratio of 0.2: the guide's whole motion excites it. Equal steps (Kutta),
/// whose error is the same on all guides.
template <class Guide>
Eigen::VectorXd end_of_mass(const Guide& guide, double end, int steps) {
  using State = Eigen::Matrix<double, 6, 1>;
  const Vector3<double> gravity(0, 0, -9.81);
  const auto rates = [&](double t, const State& y) {
    const auto motion = guide(std::min(t, end));
    const Vector3<double> u = motion.V.value.resultant;
    const Vector3<double> x = y.head<3>();
    const Vector3<double> v = y.tail<3>();
    const Vector3<double> a = -9 * x - 1.2 * v + motion.X.value.rotation.transpose() * gravity -
                              motion.origin_acceleration() - u.cross(u.cross(x)) -
                              motion.dV.value.resultant.cross(x) - 2 * u.cross(v);
    return State((State() << v, a).finished());
  };
  State y = State::Zero();
  const double h = end / steps;
  for (int i = 0; i < steps; ++i) {
    const double t = i * h;
    const State a = rates(t, y);
    const State b = rates(t + h / 2, y + h / 2 * a);
    const State c = rates(t + h / 2, y + h / 2 * b);
    const State d = rates(t + h, y + h * c);
    y += h / 6 * (a + 2 * b + 2 * c + d);
  }
  return y;
}

/// True and estimated error of the end.
struct Held {
  double truth;
  double told;
  LogSpline spline;
};

Held held(const Swell& swell, const Logger& logger, test::Sample& sample) {
  constexpr int steps = 400;
  const MotionLog<> log = logger(swell, sample);
  const LogSpline spline = smoothing(log, smoothing_sigma(noise_of(log)));
  const Eigen::VectorXd end = end_of_mass(TabulatedFrame<>(log, spline), logger.end, steps);
  const Eigen::VectorXd truth = end_of_mass(posed(swell), logger.end, steps);
  const auto told = error_of_log(
      log, spline, end,
      [&](const MotionLog<>& other, const LogSpline& how) {
        return end_of_mass(TabulatedFrame<>(other, how), logger.end, steps);
      },
      [](const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
        return Eigen::VectorXd(Eigen::VectorXd::Constant(1, (a - b).lpNorm<Eigen::Infinity>()));
      });
  return {(truth - end).lpNorm<Eigen::Infinity>(), told[0], spline};
}

Logger any_logger(test::Sample& sample) {
  Logger logger;
  logger.end = sample.uniform(4, 8);
  logger.rate = sample.magnitude(0.7, 3);
  logger.decimals = static_cast<int>(sample.uniform(2, 18));
  if (sample.once_in(3)) logger.white = sample.magnitude(-6, -3);
  if (sample.once_in(3)) logger.jitter = sample.uniform(0, 0.4);
  if (sample.once_in(3)) logger.dropped = sample.uniform(0, 0.2);
  if (sample.once_in(4)) {
    logger.gap_begin = sample.uniform(1, 3);
    logger.gap = sample.uniform(0.05, 1);
  }
  return logger;
}

/// Checks that in nine of ten logs the true error is at most 1.2 of the told one, and this is below
/// `over` times the true one.
template <class Set>
void count_contained(unsigned seed, double over, const Set& set) {
  test::Sample sample(seed);
  constexpr int logs = 200;
  int within = 0;
  for (int i = 0; i < logs; ++i) {
    const Swell swell(sample);
    Logger logger;
    set(logger, sample, i);
    const Held one = held(swell, logger, sample);
    const bool good = one.truth <= 1.2 * one.told && one.told < over * one.truth;
    within += good ? 1 : 0;
    if (!good) {
      BOOST_TEST_MESSAGE(logger.text() << ": true " << one.truth << ", told " << one.told);
    }
  }
  BOOST_TEST_MESSAGE(within << " of " << logs << " within " << 1 / over << " to 1.2");
  BOOST_TEST(within >= 0.9 * logs);
}

}  // namespace

BOOST_AUTO_TEST_SUITE(the_noise_of_a_log)

// 300 logs of all kinds, against the logged motion.
BOOST_AUTO_TEST_CASE(has_the_estimated_effect_on_the_end) {
  test::Sample sample(11);
  constexpr int logs = 300;
  int within = 0;
  for (int i = 0; i < logs; ++i) {
    const Swell swell(sample);
    const Logger logger = any_logger(sample);
    const Held one = held(swell, logger, sample);
    const double ratio = one.truth / one.told;
    const bool good = ratio >= 0.1 && ratio <= 1.2;
    within += good ? 1 : 0;
    if (!good) {
      BOOST_TEST_MESSAGE(logger.text()
                         << ": true " << one.truth << ", told " << one.told << ", ratio " << ratio
                         << ", knots " << one.spline.attitude_every << ' '
                         << one.spline.position_every);
    }
  }
  BOOST_TEST_MESSAGE(within << " of " << logs << " within 0.1 to 1.2");
  BOOST_TEST(within >= 0.95 * logs);
}

// The logger's clock is late or early, by at most as much as it says.
BOOST_AUTO_TEST_CASE(contains_a_delay) {
  count_contained(12, 20, [](Logger& logger, test::Sample& sample, int) {
    logger.end = sample.uniform(4, 8);
    logger.rate = sample.magnitude(1.3, 2.5);
    logger.late = sample.magnitude(-3, -1.5);
  });
}

// 4 to 7 rows, too few for a spline of a higher degree.
BOOST_AUTO_TEST_CASE(contains_the_error_of_a_short_log) {
  count_contained(13, 100, [](Logger& logger, test::Sample& sample, int i) {
    logger.end = sample.uniform(0.5, 2);
    logger.rate = (3.5 + i % 4) / logger.end;
  });
}

BOOST_AUTO_TEST_SUITE_END()
