#include <boost/test/unit_test.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <type_traits>
#include <vector>

#include <dynamics/exact/free_top.hpp>
#include <dynamics/exact/gyrostat.hpp>
#include <dynamics/exact/lagrange_top.hpp>
#include <dynamics/guide/posed.hpp>
#include <dynamics/guide/resting.hpp>
#include <dynamics/scene/euler_top.hpp>
#include <dynamics/scene/held_body.hpp>
#include <dynamics/solve/solve.hpp>
#include <motor/attitude.hpp>

#include <support/near.hpp>
#include <support/sample.hpp>

using namespace kreisel;

namespace {

const Eigen::Quaterniond tilted(std::cos(0.25), std::sin(0.25), 0, 0);

std::vector<double> every(double step, double end) {
  std::vector<double> times;
  for (int i = 1; i * step < end + step / 2; ++i) times.push_back(i * step);
  return times;
}

/// The true error of a trajectory by the measure that solve() reports in.
template <class Truth>
double true_error(const Trajectory<EulerTop::State>& found, const Truth& truth) {
  detail::ErrorMeasure<EulerTop> distance(1e-3);
  double worst = 0;
  for (std::size_t i = 0; i < found.times.size(); ++i) {
    const exact::TopMotion exact = truth.at(found.times[i]);
    const EulerTop::State state{exact.attitude, exact.angular_velocity};
    worst =
        std::max(worst, distance(EulerTop::to_vector(found.states[i]), EulerTop::to_vector(state)));
  }
  return worst;
}

/// Counts how honest estimates are.
struct Honesty {
  int runs = 0;
  int within = 0;  ///< true / estimate in [0.1, 1]
  double greatest = 0;
  bool promises_kept = true;

  void note(const RunReport& report, double error) {
    const double ratio = error / report.error_estimate;
    runs += 1;
    within += ratio >= 0.1 && ratio <= 1 ? 1 : 0;
    greatest = std::max(greatest, ratio);
    if (report.tolerance_kept && error > report.tolerance) promises_kept = false;
  }
};

}  // namespace

BOOST_AUTO_TEST_SUITE(solve_)

// Against closed forms: free tops of all kinds and Lagrange's tops, from loose to the tightest.
BOOST_AUTO_TEST_CASE(tells_its_error_honestly) {
  Honesty honesty;
  for (unsigned seed = 0; seed < 20; ++seed) {
    test::Sample sample(seed);
    const double A = sample.uniform(1, 2);
    const double B = sample.uniform(1, 2);
    const double C = sample.uniform(std::abs(A - B) + 0.1, A + B - 0.1);
    const Vector3<double> w = sample.uniform(0.5, 5) * sample.direction();
    const double k = sample.uniform(0.5, 10);
    for (const double tolerance : {1e-4, 1e-7, 1e-10, 1e-12, 1e-14}) {
      const Task task{.times = every(1, 10), .tolerance = tolerance, .method = Method::steps};
      const EulerTop free({A, B, C});
      const auto run = solve(free, {tilted, w}, task);
      honesty.note(run.report, true_error(run, exact::FreeTop({A, B, C}, w, tilted)));
      const EulerTop heavy({A, A, C}, {0, 0, k});
      if (C > 2 * A) continue;
      const auto spun = solve(heavy, {tilted, w}, task);
      honesty.note(spun.report, true_error(spun, exact::LagrangeTop(A, C, k, w, tilted)));
    }
  }
  BOOST_TEST_MESSAGE(honesty.within << " of " << honesty.runs << " in [0.1, 1], greatest "
                                    << honesty.greatest);
  BOOST_TEST(honesty.within >= 0.95 * honesty.runs);
  BOOST_TEST(honesty.greatest <= 3);
  BOOST_TEST(honesty.promises_kept);
}

// Near the separatrix an error grows by 1e3 and more; the promise is on the whole run all the same.
BOOST_AUTO_TEST_CASE(keeps_its_promise_where_errors_grow) {
  const Vector3<double> w(1e-3, 2, 1e-3);
  const EulerTop top({1, 2, 3});
  const auto run =
      solve(top, {tilted, w}, {.times = every(5, 100), .tolerance = 1e-8, .method = Method::steps});
  const double error = true_error(run, exact::FreeTop({1, 2, 3}, w, tilted));
  BOOST_TEST_MESSAGE("estimate " << run.report.error_estimate << ", true " << error << ", "
                                 << run.report.effort.evaluations << " of "
                                 << run.report.all_evaluations << " evaluations");
  BOOST_TEST(run.report.tolerance_kept);
  BOOST_TEST(error <= run.report.error_estimate);
  BOOST_TEST(run.report.error_estimate <= 1e-8);
}

// The same by the closed form, which is what is taken unless steps are asked for: no evaluations, and
// the last digits.
BOOST_AUTO_TEST_CASE(takes_the_closed_form_where_there_is_one) {
  const Vector3<double> w(1e-3, 2, 1e-3);
  const auto check = [](const EulerTop& top, const Vector3<double>& start, const auto& truth) {
    const auto run = solve(top, {tilted, start}, {.times = every(5, 100), .tolerance = 1e-14});
    BOOST_TEST(run.report.effort.evaluations == 0);
    BOOST_TEST(run.report.tolerance_kept, run.report.method);
    BOOST_TEST(true_error(run, truth) <= run.report.error_estimate);
  };
  check(EulerTop({1, 2, 3}), w, exact::FreeTop({1, 2, 3}, w, tilted));
  check(EulerTop({2, 2, 3}, {0, 0, 5}), w, exact::LagrangeTop(2, 3, 5, w, tilted));
  check(EulerTop({2, 2, 3}, {0, 0, 0}, {0, 0, 0.5}), w,
        exact::SymmetricGyrostat(2, 3, 0.5, w, tilted));
  check(EulerTop({1, 2, 2.5}, {0, 0, 0}, {0, 0.5, 0}), w,
        exact::Gyrostat({1, 2, 2.5}, {0, 0.5, 0}, w, tilted));
  // Begun at another time, the same motion later.
  const EulerTop top({1, 2, 3});
  const auto later = solve(top, {tilted, w}, {.begin = 1000, .times = {1010}});
  const auto now = solve(top, {tilted, w}, {.times = {10}});
  BOOST_TEST(later.states[0].angular_velocity == now.states[0].angular_velocity);
}

// Where double precision ends, the best there is comes back, and says that it is not what was asked.
BOOST_AUTO_TEST_CASE(says_when_a_tolerance_cannot_be_kept) {
  const Vector3<double> w(1e-5, 2, 1e-5);
  const EulerTop top({1, 2, 3});
  const auto run = solve(top, {tilted, w},
                         {.times = every(5, 100), .tolerance = 1e-13, .method = Method::steps});
  BOOST_TEST(!run.report.tolerance_kept);
  const double error = true_error(run, exact::FreeTop({1, 2, 3}, w, tilted));
  BOOST_TEST_MESSAGE("estimate " << run.report.error_estimate << ", true " << error);
  BOOST_TEST(error <= 3 * run.report.error_estimate);
  BOOST_TEST(run.states.size() == 20U);
}

BOOST_AUTO_TEST_CASE(watches_what_is_conserved) {
  const EulerTop kovalevskaya({2, 2, 1}, {0.7, -0.3, 0});
  const auto run = solve(kovalevskaya, {tilted, {0.5, 1, 2}}, {.times = every(1, 20)});
  std::string names;
  for (const auto& drift : run.report.invariants) {
    names += drift.name + ",";
    BOOST_TEST(drift.largest < 1e-8);
  }
  BOOST_TEST(names == "energy,vertical momentum,kovalevskaya,");
}

BOOST_AUTO_TEST_CASE(solves_bodies_on_moving_guides) {
  const auto rolling = posed([](const auto& t) {
    using std::sin;
    using T = std::decay_t<decltype(t)>;
    return Pose<T>{YawPitchRoll<T>{T(0.1 * t), T(0), T(0.2 * sin(0.9 * t))}.rotation(),
                   Vector3<T>(T(5.0 * t), T(0), T(0))};
  });
  Matrix3<double> Theta = Vector3<double>(0.25, 0.27, 0.06).asDiagonal();
  const HeldBody body(InertiaTensor<Body>::about_origin(2, {0, 0, -0.3}, Theta), {0, 0, 1}, rolling,
                      UniformGravity<Inertial>{{0, 0, -9.81}});
  const auto loose = solve(body, {tilted, {1, 0, 2}}, {.times = every(0.5, 10), .tolerance = 1e-6});
  const auto tight =
      solve(body, {tilted, {1, 0, 2}}, {.times = every(0.5, 10), .tolerance = 1e-12});
  detail::ErrorMeasure<std::remove_const_t<decltype(body)>> distance(1e-3);
  double off = 0;
  for (std::size_t i = 0; i < loose.states.size(); ++i) {
    off = std::max(off, distance(body.to_vector(loose.states[i]), body.to_vector(tight.states[i])));
  }
  BOOST_TEST(off <= loose.report.error_estimate);
  BOOST_TEST(off >= 0.1 * loose.report.error_estimate);
  BOOST_TEST(tight.report.tolerance_kept);
}

BOOST_AUTO_TEST_CASE(runs_backwards_too) {
  const EulerTop top({1, 2, 2.5});
  const auto there =
      solve(top, {tilted, {1, 2, 3}}, {.times = {10}, .tolerance = 1e-12, .method = Method::steps});
  const auto back = solve(top, there.states.back(),
                          {.begin = 10, .times = {0}, .tolerance = 1e-12, .method = Method::steps});
  BOOST_TEST((back.states.back().angular_velocity - Vector3<double>(1, 2, 3)).norm() < 1e-11);
}

BOOST_AUTO_TEST_CASE(stops_when_told_and_keeps_what_it_has) {
  const EulerTop top({1, 2, 2.5});
  Task task{.times = every(1, 100)};
  task.progress = [](double t) { return t < 30; };
  const auto run = solve(top, {tilted, {1, 2, 3}}, task);
  BOOST_TEST((run.report.status == RunStatus::cancelled));
  BOOST_TEST(run.times.back() == 30);
  BOOST_TEST(run.states.size() == 30U);
}

// A load that has no value after 3 s.
BOOST_AUTO_TEST_CASE(tells_where_it_failed_and_keeps_what_it_has) {
  const auto broken = [](const Situation<>& s) {
    const double none = std::numeric_limits<double>::quiet_NaN();
    return Force<Body>{{{0, 0, 0}, {s.t > 3.25 ? none : 0, 0, 0}}};
  };
  Matrix3<double> Theta = Vector3<double>(1, 2, 2.5).asDiagonal();
  const HeldBody body(InertiaTensor<Body>::about_origin(1, {0, 0, 0}, Theta), {0, 0, 0},
                      RestingFrame<>{}, broken);
  const auto run = solve(body, {tilted, {1, 2, 3}}, {.times = every(1, 10)});
  BOOST_TEST((run.report.status == RunStatus::failed));
  BOOST_TEST(run.report.message.find("integration stopped at t = 3.2") == 0U, run.report.message);
  BOOST_TEST(run.states.size() == 3U);
}

BOOST_AUTO_TEST_CASE(refuses_a_task_that_is_none) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  const EulerTop top({1, 2, 2.5});
  const auto with = [&](const Task& task) { return solve(top, {tilted, {1, 2, 3}}, task); };
  BOOST_CHECK_THROW((void)with({}), InvalidInput);
  BOOST_CHECK_THROW((void)with({.times = {1, 0.5}}), InvalidInput);
  BOOST_CHECK_THROW((void)with({.times = {1, -1}}), InvalidInput);
  BOOST_CHECK_THROW((void)with({.times = {nan}}), InvalidInput);
  BOOST_CHECK_THROW((void)with({.begin = nan, .times = {1}}), InvalidInput);
  BOOST_CHECK_THROW((void)with({.times = {1}, .tolerance = 1e-16}), InvalidInput);
  BOOST_CHECK_THROW((void)with({.times = {1}, .tolerance = 0}), InvalidInput);
  BOOST_CHECK_THROW((void)with({.times = {1}, .tolerance = nan}), InvalidInput);
  BOOST_CHECK_THROW((void)solve(top, {tilted, {nan, 2, 3}}, {.times = {1}}), InvalidInput);
}

BOOST_AUTO_TEST_SUITE_END()
