// The steppers alone: events, number types, attitudes step by step, refusals.

#include <fmt/core.h>

#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include <dynamics/exact/pendulum_motion.hpp>
#include <dynamics/gsl/steps.hpp>
#include <dynamics/step/events.hpp>
#include <dynamics/step/explicit.hpp>
#include <dynamics/step/gauss.hpp>
#include <dynamics/step/radau.hpp>
#include <dynamics/step/splitting.hpp>
#include <motor/attitude.hpp>

#include "trial.hpp"
#include <tests/support/worst.hpp>

namespace stability {

namespace {

using namespace kreisel;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double inf = std::numeric_limits<double>::infinity();

/// y'' = -y, which cos t solves.
template <class S>
struct Circle {
  template <class N>
  [[nodiscard]] Eigen::Matrix<N, 2, 1> operator()(const S&, const Eigen::Matrix<N, 2, 1>& y) const {
    return {y[1], -y[0]};
  }
};
using CircleSteps = ExplicitRungeKutta<Eigen::Vector2d, Circle<double>>;

/// The number of sign changes of g up to `end`.
template <class G>
std::vector<double> crossings(const G& g, double end, Crossing wanted = Crossing::any) {
  CircleSteps steps({}, 0.0, {1, 0}, {.relative = 1e-13});
  std::vector<double> times;
  while (true) {
    const auto t = advance_to_event(steps, g, end, wanted);
    if (!t) return times;
    times.push_back(*t);
    if (times.size() > 1000) return times;
  }
}

void events(const Recorder& out) {
  const double pi = std::acos(-1.0);
  const auto expect = [&](const std::string& what, const std::vector<double>& found,
                          const std::vector<double>& truth) {
    out.begin(what, "advance_to_event");
    double worst = found.size() == truth.size() ? 0 : inf;
    for (std::size_t i = 0; i < truth.size() && i < found.size(); ++i) {
      worst = test::worst_of(worst, std::abs(found[i] - truth[i]));
    }
    expect_below(out, what, "advance_to_event", worst, 1e-11,
                 fmt::format("{} of {} crossings", found.size(), truth.size()));
  };
  const auto y0 = [](double, const Eigen::Vector2d& y) { return y[0]; };
  expect("y = 0", crossings(y0, 10), {pi / 2, 3 * pi / 2, 5 * pi / 2});
  expect("y = 0, rising", crossings(y0, 10, Crossing::rising), {3 * pi / 2});
  expect("g = 0 at the start, not again",
         crossings([](double, const Eigen::Vector2d& y) { return y[1]; }, 10),
         {pi, 2 * pi, 3 * pi});
  expect("g touches 0 and turns back: no event",
         crossings([](double, const Eigen::Vector2d& y) { return y[0] * y[0]; }, 10), {});
  expect("g and g' zero where it crosses",
         crossings([](double, const Eigen::Vector2d& y) { return y[0] * y[0] * y[0]; }, 4),
         {pi / 2});
  expect("two crossings 1e-2 s apart",
         crossings([=](double t, const Eigen::Vector2d&) { return (t - 1) * (t - 1.2); }, 2),
         {1, 1.2});
  expect("g that jumps through 0",
         crossings([](double t, const Eigen::Vector2d&) { return t < 1.2345 ? -1.0 : 1.0; }, 2),
         {1.2345});
  expect("g of 1e-300",
         crossings([](double, const Eigen::Vector2d& y) { return 1e-300 * y[0]; }, 4), {pi / 2});
  // At the singular point of an angle atan2 jumps by 2 pi, which is no zero of the motion.
  expect("an angle that leaps from pi to -pi",
         crossings([](double, const Eigen::Vector2d& y) { return std::atan2(y[1], y[0]); }, 5),
         {pi});
  // A pendulum that nearly comes to rest upright.
  const exact::PendulumMotion motion(1, 0, 2 * (1 - 1e-10));
  const auto pendulum = [](double, const Eigen::Vector2d& y) {
    return Eigen::Vector2d(y[1], -std::sin(y[0]));
  };
  ExplicitRungeKutta<Eigen::Vector2d, decltype(pendulum)> steps(pendulum, 0.0, {0, 2 * (1 - 1e-10)},
                                                                {.relative = 1e-15});
  const auto turned = advance_to_event(
      steps, [](double, const Eigen::Vector2d& y) { return y[1]; }, 100.0);
  // A quarter of its period; the start's last digit moves it by 1e-16/1e-10 s.
  expect_below(out, "turning point 2e-5 rad from upright", "advance_to_event",
               std::abs(turned.value_or(inf) - motion.period() / 4), 3e-5, "conditioned by 1e10");
  expect_refusal(out, "a g that is NaN", "advance_to_event",
                 [&] { crossings([](double, const Eigen::Vector2d&) { return nan; }, 2); },
                 {"t = "});
}

/// The circle in the number type S, to the accuracy of its digits.
template <class S>
void circle_in(const Recorder& out, const char* what, double accuracy, double bound) {
  using Vector = Eigen::Matrix<S, 2, 1>;
  out.begin(what, "verner98");
  Row row;
  row.variant = fmt::format("{}, accuracy {:g}", what, accuracy);
  row.method = "ExplicitRungeKutta";
  row.estimate = bound;
  try {
    ExplicitRungeKutta<Vector, Circle<S>> steps(Circle<S>{}, S(0), Vector(S(1), S(0)),
                                                {.relative = accuracy, .max_evaluations = 1e6});
    const Vector y = steps.advance_to(S(10));
    const double error = test::worst_of(std::abs(static_cast<double>(y[0]) - std::cos(10.0)),
                                        std::abs(static_cast<double>(y[1]) + std::sin(10.0)));
    row.error = error;
    row.steps = steps.effort().steps;
    row.evaluations = steps.effort().evaluations;
    row.verdict = error <= bound ? Verdict::accurate : Verdict::failed;
  } catch (const Error& error) {
    row.note = error.what();
    row.verdict = says_something(row.note) ? Verdict::refused : Verdict::failed;
  }
  out.add(row);
}

void number_types(const Recorder& out) {
  circle_in<float>(out, "float", 1e-4, 1e-3);
  circle_in<float>(out, "float", 1e-6, 2e-5);
  circle_in<float>(out, "float", 1e-14, 2e-5);
  circle_in<double>(out, "double", 1e-14, 1e-12);
  circle_in<double>(out, "double", 1e-16, 1e-13);
  circle_in<long double>(out, "long double", 1e-16, 3e-15);
  // Attitudes in float, a million steps: each rounds to 6e-8.
  Eigen::Quaternionf q = Eigen::Quaternionf::Identity();
  const Vector3<float> step(1e-3f, 2e-3f, -1e-3f);
  const int n = 1'000'000;
  out.begin("float, 1e6 turns", "turned");
  for (int i = 0; i < n; ++i) q = rotated(q, step);
  const Vector3<double> all = step.cast<double>() * n;
  const double half = all.norm() / 2;
  const Vector3<double> along = all.normalized() * std::sin(half);
  const Eigen::Quaterniond truth(std::cos(half), along.x(), along.y(), along.z());
  expect_below(out, "float, 1e6 turns", "turned",
               q.cast<double>().normalized().angularDistance(truth), 2e-3);
}

void many_attitudes(const Recorder& out) {
  const std::int64_t n = out.quick() ? 10'000'000 : 1'000'000'000;
  const Vector3<double> step(1e-3, 2e-3, -1e-3);
  Eigen::Quaterniond q = Eigen::Quaterniond::Identity();
  out.begin(fmt::format("{} steps", n), "turned");
  for (std::int64_t i = 0; i < n; ++i) q = rotated(q, step);
  const Vector3<long double> all = step.cast<long double>() * static_cast<long double>(n);
  const long double half = all.norm() / 2;
  const Vector3<long double> along = all.normalized() * std::sin(half);
  const Eigen::Quaternion<long double> truth(std::cos(half), along.x(), along.y(), along.z());
  expect_below(out, fmt::format("attitude after {:g} steps", double(n)), "turned",
               static_cast<double>(q.cast<long double>().normalized().angularDistance(truth)),
               1e-11);
  expect_below(out, fmt::format("norm after {:g} steps", double(n)), "turned",
               std::abs(q.norm() - 1), 1e-7);
}

using Field = Eigen::Vector2d (*)(double, const Eigen::Vector2d&);
struct AnyField {
  Field field;
  [[nodiscard]] Eigen::Vector2d operator()(double t, const Eigen::Vector2d& y) const {
    return field(t, y);
  }
};

void refusals(const Recorder& out) {
  const AnyField good{
      [](double, const Eigen::Vector2d& y) { return Eigen::Vector2d(y[1], -y[0]); }};
  const AnyField bad{[](double t, const Eigen::Vector2d& y) {
    return Eigen::Vector2d(t > 1 ? nan : y[1], -y[0]);
  }};
  const Eigen::Vector2d start(1, 0);
  using Explicit = ExplicitRungeKutta<Eigen::Vector2d, AnyField>;
  using Gauss = GaussIRK<Eigen::Vector2d, AnyField>;
  const auto jacobian = difference_jacobian<2>(good);
  using Radau = RadauSteps<Eigen::Vector2d, AnyField, std::decay_t<decltype(jacobian)>>;
  static constexpr std::array<int, 1> blocks = {2};

  for (const double x : {nan, inf, -inf}) {
    const std::string what = fmt::format("{}", x);
    expect_refusal(out, "start time " + what, "ExplicitRungeKutta",
                   [&] { Explicit(good, x, start); });
    expect_refusal(out, "start time " + what, "GaussIRK",
                   [&] { Gauss(good, x, start, 0.1, blocks); });
    expect_refusal(out, "start time " + what, "RadauSteps",
                   [&] { Radau(good, jacobian, x, start, {}, blocks); });
    const Eigen::Vector2d off(x, 0);
    expect_refusal(out, "state " + what, "ExplicitRungeKutta", [&] { Explicit(good, 0, off); });
    expect_refusal(out, "state " + what, "GaussIRK", [&] { Gauss(good, 0, off, 0.1, blocks); });
    expect_refusal(out, "state " + what, "RadauSteps",
                   [&] { Radau(good, jacobian, 0, off, {}, blocks); });
    expect_refusal(out, "end " + what, "ExplicitRungeKutta",
                   [&] { Explicit(good, 0, start).advance_to(x); });
    expect_refusal(out, "end " + what, "GaussIRK",
                   [&] { Gauss(good, 0, start, 0.1, blocks).advance_to(x); });
    expect_refusal(out, "end " + what, "RadauSteps",
                   [&] { Radau(good, jacobian, 0, start, {}, blocks).advance_to(x); });
    expect_refusal(out, "accuracy " + what, "ExplicitRungeKutta",
                   [&] { Explicit(good, 0, start, {.relative = x}); });
    expect_refusal(out, "accuracy " + what, "RadauSteps",
                   [&] { Radau(good, jacobian, 0, start, {.relative = x}, blocks); });
    if (x != inf) {
      expect_refusal(out, "smallest " + what, "ExplicitRungeKutta",
                     [&] { Explicit(good, 0, start, {.absolute_scale = x}); });
      expect_refusal(out, "budget " + what, "ExplicitRungeKutta",
                     [&] { Explicit(good, 0, start, {.max_evaluations = x}).advance_to(1); });
      expect_refusal(out, "budget " + what, "RadauSteps", [&] {
        Radau(good, jacobian, 0, start, {.max_evaluations = x}, blocks).advance_to(1);
      });
    }
    expect_refusal(out, "step " + what, "GaussIRK", [&] { Gauss(good, 0, start, x, blocks); });
  }
  for (const double x : {0.0, -1.0, 1e-21, 1e-320, 0.5}) {
    expect_refusal(out, fmt::format("accuracy {:g}", x), "ExplicitRungeKutta",
                   [&] { Explicit(good, 0, start, {.relative = x}); });
  }
  for (const double x : {0.0, -0.1}) {
    expect_refusal(out, fmt::format("step {:g}", x), "GaussIRK",
                   [&] { Gauss(good, 0, start, x, blocks); });
  }
  expect_refusal(out, "step 1e-300", "GaussIRK",
                 [&] { Gauss(good, 1, start, 1e-300, blocks).advance_to(2); }, {"t = "});
  expect_refusal(out, "NaN from t = 1 on", "ExplicitRungeKutta",
                 [&] { Explicit(bad, 0, start).advance_to(2); }, {"t = "});
  expect_refusal(out, "NaN from t = 1 on", "GaussIRK",
                 [&] { Gauss(bad, 0, start, 0.1, blocks).advance_to(2); }, {"t = "});
  expect_refusal(out, "NaN from t = 1 on", "RadauSteps",
                 [&] {
                   const auto j = difference_jacobian<2>(bad);
                   RadauSteps<Eigen::Vector2d, AnyField, std::decay_t<decltype(j)>>(
                       bad, j, 0, start, {}, blocks)
                       .advance_to(2);
                 },
                 {"t = "});
  for (const GslMethod method : {GslMethod::rkf45, GslMethod::rk8pd, GslMethod::bsimp}) {
    const auto j = difference_jacobian<2>(bad);
    expect_refusal(out, "NaN from t = 1 on", fmt::format("GSL {}", int(method)),
                   [&] { GslSteps(method, bad, j, 0.0, start, {}, blocks).advance_to(2); },
                   {"t = "});
  }
  const auto torque = [](double t, const Eigen::Quaterniond&) {
    return Vector3<double>(t > 1 ? nan : 0.0, 0, 0);
  };
  expect_refusal(out, "NaN from t = 1 on", "SplittingSteps",
                 [&] {
                   SplittingSteps<SymmetricFreeFlow, std::decay_t<decltype(torque)>>(
                       SymmetricFreeFlow(1, 2), torque, 0, Eigen::Quaterniond::Identity(),
                       {0, 0, 1}, 0.1)
                       .advance_to(2);
                 },
                 {"t = "});
}

}  // namespace

void steppers(std::vector<Case>& cases) {
  cases.push_back({"events", "events that touch, at the start, at a singular point", &events});
  cases.push_back({"number-types", "float, double and long double", &number_types});
  cases.push_back({"many-attitudes", "1e9 attitude steps", &many_attitudes});
  cases.push_back({"stepper-refusals", "NaN, infinities and nonsense at the steppers", &refusals});
}

}  // namespace stability
