#include <boost/multiprecision/cpp_bin_float.hpp>
#include <boost/test/data/monomorphic.hpp>
#include <boost/test/data/test_case.hpp>
#include <boost/test/unit_test.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <dynamics/exact/pendulum_motion.hpp>
#include <dynamics/pendulum/physical_pendulum.hpp>
#include <dynamics/solve/solve.hpp>

#include <support/json.hpp>
#include <support/near.hpp>
#include <support/worst.hpp>

using namespace kreisel;

namespace {

using Digits50 = boost::multiprecision::cpp_bin_float_50;

constexpr double u = 0x1p-53;
constexpr double earth_rate = 7.292115e-5;

/// phi.. = -19.62 sin phi, on a guide at rest.
const PendulumBody<> rod{.mass = 1, .arm = 0.5, .theta_b = 1, .theta_c = 1};
const RestingPendulumGuide<> room{39.24};

/// The same in the meridian of 45 degrees on the turning earth.
PendulumGuide<> meridian() {
  const double across = earth_rate * std::sqrt(0.5);
  return {.angular_velocity = {across, across, 0}, .effective_gravity = {39.24, 0, 0}};
}

struct Series {
  std::array<Digits50, 42> terms = {};

  Digits50& operator[](std::size_t i) { return terms[i]; }
};

/// phi.. = -(E sin phi + F cos phi + H cos 2 phi + K sin 2 phi) by Taylor series in 50 digits.
std::array<Digits50, 2> by_series(const PendulumCoefficients<>& c, double angle, double rate,
                                  double end, int steps) {
  constexpr std::size_t order = 40;
  const Digits50 h = Digits50(end) / steps;
  std::array<Digits50, 2> state{angle, rate};
  const Digits50 e = Digits50(c.weight) + c.delta_e;
  for (int step = 0; step < steps; ++step) {
    Series y, s, co, s2, c2;
    y[0] = state[0];
    y[1] = state[1];
    s[0] = sin(y[0]);
    co[0] = cos(y[0]);
    s2[0] = 2 * s[0] * co[0];
    c2[0] = co[0] * co[0] - s[0] * s[0];
    for (std::size_t n = 0; n < order; ++n) {
      for (std::size_t j = 1; j <= n; ++j) {
        const Digits50 slope = y[j] * Digits50(j) / Digits50(n);
        s[n] += slope * co[n - j];
        co[n] -= slope * s[n - j];
        s2[n] += 2 * slope * c2[n - j];
        c2[n] -= 2 * slope * s2[n - j];
      }
      const Digits50 pull = e * s[n] + c.f * co[n] + c.h * c2[n] + c.k * s2[n];
      y[n + 2] = -pull / Digits50((n + 1) * (n + 2));
    }
    state = {0, 0};
    for (std::size_t n = order + 2; n-- > 0;) {
      state[1] = state[1] * h + state[0];
      state[0] = state[0] * h + y[n];
    }
  }
  return state;
}

}  // namespace

BOOST_AUTO_TEST_SUITE(physical_pendulum)

// 1000 periods in 25 digits, in closed form and by the series.
BOOST_DATA_TEST_CASE(on_the_earth_reaches_the_reference,
                     boost::unit_test::data::make({false, true}), by_series) {
  const auto reference = test::reference_file("ode-scenes.json").at("scenes").at("S3_earthpend");
  const PhysicalPendulum pendulum(rod, meridian());
  SolveOptions options{.output_times = {}, .tolerance = 1e-14};
  if (by_series) options.method = Method::taylor;
  for (const auto& t : reference["times"]) options.output_times.push_back(t.get<double>());
  const auto run = solve(pendulum, {.angle = 0.1}, options);
  BOOST_TEST(run.report.method == (by_series ? "taylor" : "energy integral, Fourier series"));
  BOOST_TEST(run.report.tolerance_kept != by_series);
  BOOST_TEST(run.report.error_estimate <= (by_series ? 1e-12 : 1e-14));
  BOOST_REQUIRE(run.states.size() == options.output_times.size());
  double worst = 0;
  for (std::size_t i = 0; i < run.states.size(); ++i) {
    const auto& truth = reference["states"][i];
    const double angle = test::number(truth[0]);
    const double rate = test::number(truth[1]);
    const double off = test::worst_of(std::abs(run.states[i].angle - angle) / 0.1,
                                      std::abs(run.states[i].rate - rate) / 0.443);
    worst = test::worst_of(worst, off);
    BOOST_TEST(off <= run.errors[i]);
  }
  BOOST_TEST_MESSAGE("1000 periods on the earth, " << run.report.method << ": off by " << worst
                                                   << ", told " << run.report.error_estimate);
  BOOST_REQUIRE(run.report.invariants.size() == 1U);
  // A random walk: each step of the series rounds the amplitude by 1 u or 2, the energy by twice as much.
  const double drift = (by_series ? 4 * std::sqrt(run.report.effort.steps) : 16) * u;
  BOOST_TEST(run.report.invariants[0].largest <= drift * run.report.invariants[0].start);
}

BOOST_AUTO_TEST_CASE(errs_at_the_start_by_rounding_only) {
  const PhysicalPendulum pendulum(rod, room);
  const SteadyPendulumMotion<exact::Real> motion(rod.cast<exact::Real>(),
                                                 pendulum.coefficients<exact::Real>(), 0.1, 0.1);
  const double told = detail::SteadyPendulumMotionError(motion, 3)(3, 0);
  // Half a last digit of each, twice, and the error of the phase at time 0.
  const auto per_phase = std::max(motion.angle_per_phase(), motion.rate_per_phase()) / 0.1;
  BOOST_TEST(test::near(told, 2 * u + double(motion.phase_error(0) * per_phase), told, 4));
  BOOST_TEST(told < 2.2 * u);
}

BOOST_AUTO_TEST_CASE(begins_at_the_given_time) {
  const PhysicalPendulum pendulum(rod, room);
  const auto start = decltype(pendulum)::State{1.5, 0.5};
  const auto now = solve(pendulum, start, {.output_times = {0.25, 7}, .tolerance = 1e-13});
  const auto later =
      solve(pendulum, start, {.begin = 3, .output_times = {3.25, 10}, .tolerance = 1e-13});
  BOOST_TEST(later.report.method == "energy integral, Fourier series");
  for (std::size_t i = 0; i < 2; ++i) {
    BOOST_TEST(std::abs(later.states[i].angle - now.states[i].angle) <= 16 * u);
    BOOST_TEST(std::abs(later.states[i].rate - now.states[i].rate) <= 64 * u);
  }
}

// Elliptic functions, independent of phases and series: swings of 1e-9 to 3 rad, and rotation.
BOOST_AUTO_TEST_CASE(agrees_with_elliptic_functions_at_rest) {
  const PhysicalPendulum pendulum(rod, room);
  using State = decltype(pendulum)::State;
  double worst = 0;
  for (const State start :
       {State{1e-9, 0}, State{0, 1e-7}, State{0.1, 1e-12}, State{-1, 0.5}, State{2, 0},
        State{2.9, 0}, State{0.5, 9.5}, State{-4, -20}, State{1, 100}, State{7, -0.25}}) {
    const exact::PendulumMotion truth(19.62, start.angle, start.rate);
    const double period = truth.period();
    const auto run =
        solve(pendulum, start,
              {.output_times = {0.01 * period, 0.25 * period, 10.7 * period, 12345.6 * period},
               .tolerance = 1e-12,
               .absolute_scale = 0});
    BOOST_TEST(run.report.method == "energy integral, Fourier series");
    double greatest_angle = 0;
    double greatest_rate = 0;
    for (std::size_t i = 0; i < run.times.size(); ++i) {
      const auto [angle, rate] = truth.at(run.times[i]);
      greatest_angle = std::max(greatest_angle, std::abs(angle));
      greatest_rate = std::max(greatest_rate, std::abs(rate));
      const double off = test::worst_of(std::abs(run.states[i].angle - angle) / greatest_angle,
                                        std::abs(run.states[i].rate - rate) / greatest_rate);
      // The elliptic functions themselves err by 1.5u.
      worst = test::worst_of(worst, off / (run.errors[i] + 4 * u));
      BOOST_TEST(off <= run.errors[i] + 4 * u);
    }
  }
  BOOST_TEST_MESSAGE("against elliptic functions: at most " << worst << " of what is told");
}

// Before the phase has advanced far, the error is half a unit in the last digit of each answer.
BOOST_AUTO_TEST_CASE(reports_its_rounding) {
  const PhysicalPendulum pendulum(rod, room);
  std::vector<double> times;
  for (int i = 1; i <= 40; ++i) times.push_back(0.02 * i);
  const auto run = solve(pendulum, {.angle = 0.1}, {.output_times = times, .tolerance = 1e-14});
  BOOST_TEST(run.report.method == "energy integral, Fourier series");
  double worst = 0;
  double greatest_rate = 0;
  for (std::size_t i = 0; i < times.size(); ++i) {
    const auto truth = by_series({19.62, 0, 0, 0, 0}, 0.1, 0, times[i], 4);
    const auto [angle, rate] = run.states[i];
    greatest_rate = std::max(greatest_rate, std::abs(rate));
    const double off =
        test::worst_of(std::abs(static_cast<double>(Digits50(angle - truth[0]))) / 0.1,
                       std::abs(static_cast<double>(Digits50(rate - truth[1]))) / greatest_rate);
    BOOST_TEST(off <= run.errors[i]);
    worst = test::worst_of(worst, off);
  }
  BOOST_TEST(worst >= u / 2);

  // Time counts from the beginning, whenever that is.
  constexpr double begin = 0x1p20;
  for (double& t : times) t += begin;
  const auto later =
      solve(pendulum, {.angle = 0.1}, {.begin = begin, .output_times = times, .tolerance = 1e-14});
  BOOST_TEST(later.errors.back() <= 1.01 * run.errors.back());
}

// Angles count from the nearest of two wells: 1e-9 rad near 0 has all its digits.
BOOST_AUTO_TEST_CASE(counts_from_the_nearest_well) {
  const PendulumCoefficients<> c{1, 0, 0.1, -0.1, 0.9};  // the other one is at -3.0 rad
  for (const double angle : {1e-9, -1e-9}) {
    const SteadyPendulumMotion<double> motion({.arm = 1, .theta_c = 1}, c, angle, 0);
    const auto truth = by_series(c, angle, 0, 12, 100);
    const double off = std::abs(motion.at(12).angle / static_cast<double>(truth[0]) - 1);
    BOOST_TEST(off <= 1e-13);
  }
}

// A barrier at -2.04 rad separates it from the nearest well, at -2.29 rad: it swings in the other.
BOOST_AUTO_TEST_CASE(stays_in_its_well) {
  const PendulumCoefficients<> c{1, 0, -0.7, -0.7, 0.2};
  const double angle = -2;
  const SteadyPendulumMotion<double> motion({.arm = 1, .theta_c = 1}, c, angle, 0);
  for (const double t : {3.0, 12.0}) {
    const auto truth = by_series(c, angle, 0, t, 100);
    BOOST_TEST(std::abs(motion.at(t).angle - static_cast<double>(truth[0])) <= 1e-13);
  }
}

// After eight turns in either direction it swings as before; 16 pi is rounded by 7e-15.
BOOST_AUTO_TEST_CASE(does_not_depend_on_whole_turns) {
  const PendulumCoefficients<> c{1, 0, 0.1, -0.2, -0.9};
  const double turns = 32 * std::acos(0.0);
  for (const double angle : {2.5, -0.4, 0.3}) {
    const SteadyPendulumMotion<double> here({.arm = 1, .theta_c = 1}, c, angle, 0);
    for (const double away : {turns, -turns}) {
      const SteadyPendulumMotion<double> there({.arm = 1, .theta_c = 1}, c, angle + away, 0);
      BOOST_TEST(std::abs(there.period() - here.period()) <= 1e-13);
      BOOST_TEST(std::abs(there.at(2).angle - away - here.at(2).angle) <= 1e-13);
      BOOST_TEST(std::abs(there.at(2).rate - here.at(2).rate) <= 1e-13);
    }
  }
}

// Just above the barrier its phase runs so unevenly that Newton's steps for it leave their bracket.
BOOST_AUTO_TEST_CASE(agrees_near_the_unstable_rest) {
  const PhysicalPendulum pendulum(rod, room);
  for (const double over : {1.001, 1.003, 1.01}) {
    const double rate = over * 2 * std::sqrt(19.62);
    const exact::PendulumMotion truth(19.62, 0, rate);
    std::vector<double> times;
    for (int i = 1; i < 400; ++i) times.push_back(0.00713 * i);
    const auto run = solve(pendulum, {.rate = rate}, {.output_times = times, .tolerance = 1e-9});
    BOOST_TEST(run.report.method == "energy integral, Fourier series");
    double worst = 0;
    for (std::size_t i = 0; i < times.size(); ++i) {
      worst = test::worst_of(worst, std::abs(run.states[i].angle - truth.at(times[i]).angle));
    }
    BOOST_TEST(worst <= 1e-11, "thrown with " << over << ": off by " << worst);
  }
}

// Any E, F, H and K: one well or two, swings over one or both, and rotation, against Taylor series.
BOOST_AUTO_TEST_CASE(agrees_with_taylor_series) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> any(-1, 1);
  double worst = 0;
  int swings = 0;
  for (int i = 0; i < 12; ++i) {
    const double e = any(random);
    const PendulumCoefficients<> c{std::abs(e), e - std::abs(e), any(random), 2 * any(random),
                                   2 * any(random)};
    const double angle = 3 * any(random);
    const double rate = (i % 3) * 1.5 * any(random);
    const SteadyPendulumMotion<exact::Real> motion(
        {.arm = 1, .theta_c = 1},
        {exact::Real(c.weight), exact::Real(c.delta_e), exact::Real(c.f), exact::Real(c.h),
         exact::Real(c.k)},
        angle, rate);
    constexpr double end = 12;
    const auto truth = by_series(c, angle, rate, end, 100);
    const auto point = motion.at(end);
    const auto truth_in_reals = [](const auto& x) {
      const auto leading = static_cast<double>(x);
      return exact::Real(leading) + static_cast<double>(x - leading);
    };
    const exact::Real off =
        test::worst_of(abs(point.angle - truth_in_reals(truth[0])) / motion.angle_per_phase(),
                       abs(point.rate - truth_in_reals(truth[1])) / motion.rate_per_phase());
    const double told = double(motion.phase_error(end));
    worst = test::worst_of(worst, double(off) / told);
    BOOST_TEST(double(off) <= told);
    BOOST_TEST(told <= 1e-14);
    const exact::Real off_at_once = abs(motion.at(0).angle - exact::Real(angle));
    BOOST_TEST(double(off_at_once / motion.angle_per_phase()) <= double(motion.phase_error(0)));
    if (motion.angle_per_phase() != 1) ++swings;
  }
  BOOST_TEST(swings >= 6);
  BOOST_TEST(swings <= 11);
  BOOST_TEST_MESSAGE("against Taylor series: at most " << worst << " of what is told");
}

// phi = a cos theta, phi. = -a sin theta for E = Theta_C = 1.
BOOST_AUTO_TEST_CASE(reports_the_angle_of_a_phase) {
  const double amplitude = 1e-3;
  const SteadyPendulumMotion<double> motion({.arm = 1, .theta_c = 1}, {1, 0, 0, 0, 0}, amplitude,
                                            0);
  BOOST_TEST(std::abs(motion.angle_per_phase() - amplitude) <= 1e-6 * amplitude);
  BOOST_TEST(std::abs(motion.rate_per_phase() - amplitude) <= 0.05 * amplitude);
}

// Near a barrier the Fourier series is too long, and steps are used instead. The same holds at rest
// and in an endless fall.
BOOST_AUTO_TEST_CASE(is_solved_by_steps_beyond_the_series) {
  const PhysicalPendulum pendulum(rod, room);
  for (const double rate : {2 * std::sqrt(19.62), 2 * std::sqrt(19.62) * (1 + 1e-9), 0.0}) {
    const auto run = solve(pendulum, {.rate = rate}, {.output_times = {0.1, 3}, .tolerance = 1e-8});
    BOOST_TEST(run.report.method == "taylor");
    BOOST_TEST(run.report.tolerance_kept);
    const auto truth = exact::PendulumMotion(19.62, 0, rate).at(3);
    BOOST_TEST(std::abs(run.states[1].angle - truth.angle) <= 1e-8 * std::abs(truth.angle));
  }
}

// With damping, and on a moving guide, steps are used; the equation is that of PendulumField.
BOOST_AUTO_TEST_CASE(is_solved_by_steps_without_energy) {
  const auto brake = [](const auto& rate) { return 0.1 * rate; };
  const PhysicalPendulum damped(rod, room, brake);
  const auto slow = solve(damped, {.angle = 1e-6},
                          {.output_times = {2}, .tolerance = 1e-10, .absolute_scale = 1e-12});
  // Small: a damped oscillation in closed form.
  const double w = std::sqrt(19.62 - 0.05 * 0.05);
  const double angle = 1e-6 * std::exp(-0.1) * (std::cos(2 * w) + 0.05 / w * std::sin(2 * w));
  BOOST_TEST(slow.report.tolerance_kept);
  BOOST_TEST(slow.report.invariants.empty());
  BOOST_TEST(std::abs(slow.states[0].angle - angle) <= 2e-16);

  // The guide turns about the pendulum's axis at any rate: relative to the room, phi + its angle
  // moves independently.
  const auto turning = [](double t) {
    return PendulumGuide<>{.angular_velocity = {0, 0, 0.3 * t},
                           .angular_acceleration = {0, 0, 0.3}};
  };
  const PhysicalPendulum carried(rod, turning);
  BOOST_TEST(carried.conserved(0, {.angle = 0.2}).empty());
  const auto run =
      solve(carried, {.angle = 0.2, .rate = 1}, {.output_times = {5}, .tolerance = 1e-12});
  BOOST_TEST(run.report.tolerance_kept);
  BOOST_TEST(std::abs(run.states[0].angle - (0.2 + 5 - 0.15 * 25)) <= 1e-11);

  // Gravity at right angles: the same swing, shifted by a quarter turn.
  const PhysicalPendulum across(rod, PendulumGuide<>{.effective_gravity = {0, 39.24, 0}});
  const double quarter = std::acos(-1.0) / 2;
  const auto turned =
      solve(across, {.angle = 0.4 + quarter}, {.output_times = {5}, .tolerance = 1e-12});
  const auto straight =
      solve(PhysicalPendulum(rod, room), {.angle = 0.4}, {.output_times = {5}, .tolerance = 1e-12});
  BOOST_TEST(turned.report.method == straight.report.method);
  BOOST_TEST(std::abs(turned.states[0].angle - quarter - straight.states[0].angle) <= 1e-14);
  // Rotation so fast that one sine or one cosine is left of its series.
  const SolveOptions soon{.output_times = {0.3, 0.5}, .tolerance = 1e-12};
  const auto whirled = solve(across, {.angle = 0.4 + quarter, .rate = 3e4}, soon);
  const auto upright = solve(PhysicalPendulum(rod, room), {.angle = 0.4, .rate = 3e4}, soon);
  for (std::size_t i = 0; i < 2; ++i) {
    const double apart = whirled.states[i].angle - quarter - upright.states[i].angle;
    BOOST_TEST(std::abs(apart) <= 2e-11);  // eleven last digits of 15000 rad
  }

  // Without torque it rotates uniformly, with a constant one it accelerates uniformly.
  const auto angle_at_5 = [](double push) {
    const PhysicalPendulum floating(rod, PendulumGuide<>{.angular_acceleration = {0, 0, push}});
    BOOST_TEST(floating.conserved(0, {}).empty() == (push != 0));
    const auto found = solve(floating, {.angle = 0.2, .rate = 1}, {.output_times = {5}});
    BOOST_TEST(found.report.tolerance_kept);
    return found.states[0].angle;
  };
  BOOST_TEST(std::abs(angle_at_5(0) - 5.2) <= 1e-11);
  BOOST_TEST(std::abs(angle_at_5(0.3) - (5.2 - 0.15 * 25)) <= 1e-11);
}

// Without gravity, on a guide that turns about a transverse axis, twice its angle is a pendulum's.
BOOST_AUTO_TEST_CASE(swings_on_a_guide_that_turns_across) {
  constexpr double u = 2;
  const exact::PendulumMotion truth(u * u, 0.8, 0);  // Theta_B = Theta_C, Theta_A = 0
  for (const double axis : {std::acos(0.0), std::acos(0.0) / 2}) {
    const PhysicalPendulum weightless(
        rod, PendulumGuide<>{.angular_velocity = {u * std::cos(axis), u * std::sin(axis), 0}});
    const double middle = axis - std::acos(0.0);
    const auto run =
        solve(weightless, {.angle = middle + 0.4}, {.output_times = {1, 20}, .tolerance = 1e-12});
    BOOST_TEST(run.report.method == "energy integral, Fourier series");
    for (std::size_t i = 0; i < 2; ++i) {
      const double found = 2 * (run.states[i].angle - middle);
      BOOST_TEST(std::abs(found - truth.at(run.times[i]).angle) <= 4e-15);
    }
  }
}

BOOST_AUTO_TEST_CASE(refuses_impossible_bodies) {
  BOOST_CHECK_THROW(PhysicalPendulum({.arm = -1}, room), InvalidInput);
  BOOST_CHECK_THROW(PhysicalPendulum({.arm = 1, .theta_c = 0.5}, room), InvalidInput);
  for (const auto& [angle, rate] : {std::pair(NAN, 0.0), {0.1, HUGE_VAL}}) {
    BOOST_CHECK_THROW(SteadyPendulumMotion<double>(rod, {19.62}, angle, rate), InvalidInput);
  }
  BOOST_CHECK_THROW((void)SteadyPendulumMotion<double>(rod, {19.62}, 0.1, 0.0).at(NAN),
                    InvalidInput);
  for (const PendulumState<>& start : {PendulumState<>(NAN, 0), PendulumState<>(0, HUGE_VAL)}) {
    BOOST_CHECK_THROW((void)solve(PhysicalPendulum(rod, room),
                                  {.angle = start[0], .rate = start[1]}, {.output_times = {1}}),
                      InvalidInput);
  }
}

BOOST_AUTO_TEST_SUITE_END()
