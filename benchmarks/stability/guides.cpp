// Guides at extreme rates and times, and their own events: the end of a log, a rotation that is too
// fast.

#include <fmt/core.h>

#include <cmath>
#include <limits>

#include <dynamics/guide/harmonic.hpp>
#include <dynamics/guide/posed.hpp>
#include <dynamics/guide/resting.hpp>
#include <dynamics/guide/rotating.hpp>
#include <dynamics/guide/steady.hpp>
#include <dynamics/guide/tabulated.hpp>
#include <motor/attitude.hpp>

#include "trial.hpp"
#include <tests/support/worst.hpp>

namespace stability {

namespace {

using namespace kreisel;
using Motion = FrameMotion<Guide, Inertial>;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double inf = std::numeric_limits<double>::infinity();

/// The greatest difference of two motions of a guide, relative to 1 and to v.
double distance(const Motion& a, const Motion& b) {
  const double size = std::max(
      1.0, b.V.value.moment.norm() + b.X.value.translation.norm() + b.dV.value.moment.norm());
  return test::worst_of(
      (a.X.value.rotation - b.X.value.rotation).cwiseAbs().maxCoeff<Eigen::PropagateNaN>(),
      (a.X.value.translation - b.X.value.translation).norm() / size,
      (a.V.value.resultant - b.V.value.resultant).norm(),
      (a.V.value.moment - b.V.value.moment).norm() / size,
      (a.dV.value.resultant - b.dV.value.resultant).norm(),
      (a.dV.value.moment - b.dV.value.moment).norm() / size);
}

/// Rates so small that they have no visible effect.
void slow_guides(const Recorder& out) {
  const Motion rest = RestingFrame<>{}(1.0);
  const auto expect = [&](const std::string& what, const std::string& kind, const Motion& m) {
    const bool finite = (m.X.value.rotation - m.X.value.rotation).isZero(0);
    expect_below(out, what, kind, finite ? distance(m, rest) : inf, 1e-15);
  };
  for (const double rate : {0.0, 1e-320, 1e-308, 1e-300, 1e-170, 1e-160, 1e-100, 1e-20}) {
    const std::string what = fmt::format("{:g} rad/s", rate);
    const Vector3<double> u = rate * Vector3<double>(0.6, -0.3, 0.8);
    for (const double t : {1.0, 1e3}) {
      const std::string when = fmt::format("{} after {:g} s", what, t);
      expect(when, "rotating", RotatingFrame<>{u}(t));
      SteadyFrame<> steady;
      steady.V.value.resultant = u;
      expect(when, "steady", steady(t));
      const HarmonicFrame<> harmonic({u, {{u, 1.3, 0.2}}}, {}, 0, 1e3);
      expect(when, "harmonic", harmonic(t));
      const auto turning = posed([u](const auto& time) {
        using T = std::decay_t<decltype(time)>;
        return Pose<T>{YawPitchRoll<T>{T(u.z() * time), T(0.0 * time), T(0.0 * time)}.rotation(),
                       Vector3<T>::Zero()};
      });
      expect(when, "posed", turning(t));
    }
  }
}

/// Rates and times so great that the angle loses digits: only the product of rate and time is
/// known.
void fast_guides(const Recorder& out) {
  for (const double rate : {1e3, 1e6, 1e9}) {
    for (const double t : {1.0, 1e3, 1e9}) {
      const Motion m = RotatingFrame<>{{0, 0, rate}}(t);
      SteadyFrame<> steady;
      steady.V.value.resultant = {0, 0, rate};
      const double angle = rate * t;
      Motion truth;
      truth.X.value.rotation << std::cos(angle), -std::sin(angle), 0, std::sin(angle),
          std::cos(angle), 0, 0, 0, 1;
      truth.V.value.resultant = {0, 0, rate};
      const std::string what = fmt::format("{:g} rad/s at t = {:g} s", rate, t);
      // Half an ulp of the angle, from the product; and as much from halving it.
      const double bound = 4e-16 * (1 + angle);
      expect_below(out, what, "rotating", distance(m, truth), bound, "an ulp of the angle");
      expect_below(out, what, "steady", distance(steady(t), truth), bound, "an ulp of the angle");
    }
  }
  for (const double rate : {1e154, 1e160, 1e300}) {
    const auto is_number = [&](const Motion& m) {
      return (m.X.value.rotation - m.X.value.rotation).isZero(0);
    };
    const std::string what = fmt::format("{:g} rad/s at t = 1e-160 s", rate);
    // Squares overflow; the angle itself may be small.
    const Motion m = RotatingFrame<>{{0, 0, rate}}(1e-160);
    const double angle = rate * 1e-160;
    const double off = is_number(m) ? std::abs(m.X.value.rotation(1, 0) - std::sin(angle)) : inf;
    expect_below(out, what, "rotating", off, 1e-15 * (1 + angle));
  }
}

/// Sampled logs at their ends, and logs with invalid contents.
void logs(const Recorder& out) {
  MotionLog<> log;
  for (int i = 0; i <= 50; ++i) {
    const double t = 0.1 * i;
    log.times.push_back(t);
    log.attitudes.emplace_back(std::cos(0.2 * t), 0, 0, std::sin(0.2 * t));
    log.positions.emplace_back(t, 0, 0);
  }
  const TabulatedFrame<> good(log);
  for (const double t : {-1e-9, 5 + 1e-9, nan, inf, -inf}) {
    expect_refusal(out, fmt::format("asked for t = {}", t), "tabulated", [&] { (void)good(t); });
  }
  expect_refusal(out, "no samples", "tabulated", [] { TabulatedFrame<>(MotionLog<>{}); });
  const auto spoiled = [&](const char* what, const auto& spoil) {
    MotionLog<> copy = log;
    spoil(copy);
    expect_refusal(out, what, "tabulated", [&] { TabulatedFrame<> frame(copy); });
  };
  spoiled("a time twice", [](auto& l) { l.times[3] = l.times[2]; });
  spoiled("times that turn round", [](auto& l) { std::swap(l.times[3], l.times[4]); });
  spoiled("a time that is NaN", [](auto& l) { l.times[3] = nan; });
  spoiled("an infinite time", [](auto& l) { l.times.back() = inf; });
  spoiled("an attitude of zeros", [](auto& l) { l.attitudes[3] = {0, 0, 0, 0}; });
  spoiled("an attitude that is NaN", [](auto& l) { l.attitudes[3].w() = nan; });
  spoiled("a place that is NaN", [](auto& l) { l.positions[3].x() = nan; });
  spoiled("a half turn from one sample to the next", [](auto& l) {
    l.attitudes[3] = {0, 1, 0, 0};
  });
  spoiled("lengths that differ", [](auto& l) { l.positions.pop_back(); });
  const HarmonicFrame<> short_one({{0, 0, 1}, {}}, {}, 0, 1);
  for (const double t : {-1e-9, 1 + 1e-9, nan}) {
    expect_refusal(out, fmt::format("asked for t = {}", t), "harmonic",
                   [&] { (void)short_one(t); });
  }
  // Unevenly sampled to 1e-9 s and far from 0.
  for (const double begin : {0.0, 1e9}) {
    MotionLog<> uneven;
    for (int i = 0; i <= 50; ++i) {
      const double t = begin + 0.1 * i + (i % 7 == 3 ? 1e-6 : 0);
      uneven.times.push_back(t);
      const double angle = 0.4 * (t - begin);
      uneven.attitudes.emplace_back(std::cos(angle / 2), 0, 0, std::sin(angle / 2));
    }
    const TabulatedFrame<> frame(uneven);
    const double t = begin + 2.5123;
    const double angle = 0.4 * (t - begin);
    const Matrix3<double> R = frame(t).X.value.rotation;
    expect_below(
        out, fmt::format("uneven samples from t = {:g} s on", begin), "tabulated",
        std::abs(std::remainder(std::atan2(R(1, 0), R(0, 0)) - angle, 2 * std::acos(-1.0))),
        frame.interpolation_error().attitude + 4e-16 + 1e-7 * 1e-9, "bound: its own estimate");
  }
}

}  // namespace

void guides(std::vector<Case>& cases) {
  cases.push_back(
      {"slow-guides", "guide rates 0, denormal, where squares underflow", &slow_guides});
  cases.push_back(
      {"fast-guides", "guide rates and times whose product loses its digits", &fast_guides});
  cases.push_back({"logs", "logged guides past their ends, spoiled and uneven", &logs});
}

}  // namespace stability
