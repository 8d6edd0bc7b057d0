// Motions of one coordinate in arbitrary fields: pendulums, oscillators, and fields that fail.

#include <fmt/core.h>

#include <array>
#include <cmath>
#include <functional>
#include <limits>

#include <dynamics/exact/pendulum_motion.hpp>

#include "trial.hpp"

namespace stability {

namespace {

using kreisel::Method;

/// y'' or y' as any function, so that solve() is compiled once for all.
struct Plane {
  using Vector = Eigen::Vector2d;
  struct State {
    double angle = 0;
    double rate = 0;
  };

  std::function<Vector(double, const Vector&)> field;

  static constexpr std::array<int, 2> blocks = {1, 1};
  static Vector to_vector(const State& s) { return {s.angle, s.rate}; }
  static State from_vector(const Vector& y) { return {y[0], y[1]}; }
  [[nodiscard]] Vector rates(double t, const Vector& y) const { return field(t, y); }
};

using Vector = Plane::Vector;
using State = Plane::State;

constexpr Methods by_steps = {Method::automatic, Method::verner98, Method::gauss16,
                              Method::radau13};
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

const Plane pendulum{[](double, const Vector& y) { return Vector(y[1], -19.62 * std::sin(y[0])); }};

void swing(const Recorder& out, const std::string& variant, double angle, double rate,
           const kreisel::SolveOptions& options, const std::string& picture = "",
           bool must_answer = true) {
  const kreisel::exact::PendulumMotion motion(19.62, angle, rate);
  Trial<Plane> trial{variant, pendulum, {angle, rate}, options, [&](double t) {
                       const auto m = motion.at(t - options.begin);
                       return State{m.angle, m.rate};
                     }};
  trial.picture = picture;
  trial.must_answer = must_answer;
  attempt_all(out, trial, by_steps);
}

void near_the_top(const Recorder& out) {
  const double pi = std::acos(-1.0);
  for (const double off : {1e-2, 1e-8, 1e-14}) {
    swing(out, fmt::format("at rest {:g} rad from the upper point", off), pi - off, 0,
          {.output_times = every(1, 10), .tolerance = 1e-8});
  }
  const double up = 2 * std::sqrt(19.62);
  for (const double part : {0.0, 1e-14, -1e-14, 1e-6}) {
    swing(out, fmt::format("thrown with 1 + {:g} of what takes it up", part), 0, up * (1 + part),
          {.output_times = every(0.5, 5), .tolerance = 1e-8});
  }
}

void small_swings(const Recorder& out) {
  for (const double angle : {1e-320, 1e-300, 1e-170, 1e-30, 1e-10}) {
    for (const double smallest : {0.0, 1e-3}) {
      // This field has no squares, which underflow below 1e-146, but solve() must assume them.
      swing(out, fmt::format("amplitude {:g}, smallest = {:g}", angle, smallest), angle, 0,
            {.output_times = every(1, 5), .tolerance = 1e-9, .absolute_scale = smallest}, "",
            angle > 1e-146 || smallest > 0);
    }
  }
}

void many_swings(const Recorder& out) {
  const double period = kreisel::exact::PendulumMotion(19.62, 0.1, 0).period();
  const double end = (out.quick() ? 1e3 : 1e5) * period;
  std::vector<double> times;
  for (double t = period / 4; t < end; t *= 2) times.push_back(t);
  times.push_back(end);
  swing(out, fmt::format("{:.0g} periods", end / period), 0.1, 0,
        // Ten times the default budget: a hundred million evaluations are not enough.
        {.output_times = times, .tolerance = 1e-9, .max_evaluations = 1e9}, "pendulum");
}

/// y'' = -k (y - y0): 1e4 periods.
void undamped_spring(const Recorder& out) {
  for (const double stiffness : {1e6, 1e12}) {
    const double w = std::sqrt(stiffness);
    const Plane spring{[=](double, const Vector& y) { return Vector(y[1], -stiffness * y[0]); }};
    const double end = (out.quick() ? 1e3 : 1e4) * 6.283185307179586 / w;
    std::vector<double> times;
    for (double t = 1 / w; t < end; t *= 2) times.push_back(t);
    times.push_back(end);
    Trial<Plane> trial{fmt::format("{:g} N m/rad", stiffness),
                       spring,
                       {0.1, 0},
                       {.output_times = times, .tolerance = 1e-8},
                       [=](double t) {
                         return State{0.1 * std::cos(w * t), -0.1 * w * std::sin(w * t)};
                       }};
    trial.truth_error = rounding_of_angle * w * end;
    trial.picture = fmt::format("{:g} N m/rad", stiffness);
    attempt_all(out, trial, by_steps);
  }
}

/// A stiff relaxation to a slow motion:  y' = -k (y - cos t) - sin t.
void stiff_relaxation(const Recorder& out) {
  double first = 0;
  for (const double k : {1e3, 1e6, 1e9, 1e12}) {
    const Plane field{[=](double t, const Vector& y) {
      return Vector(-k * (y[0] - std::cos(t)) - std::sin(t),
                    -k * (y[1] - std::sin(t)) + std::cos(t));
    }};
    for (const double off : {0.0, 1.0}) {
      const Trial<Plane> trial{
          fmt::format("k = {:g}/s, begun {:g} off", k, off),
          field,
          {1 + off, -off},
          {.output_times = every(1, 10), .tolerance = 1e-9, .max_evaluations = 1e6},
          [=](double t) {
            const double rest = off * std::exp(-k * t);
            return State{std::cos(t) + rest, std::sin(t) - rest};
          }};
      const Row row = attempt(out, trial, Method::automatic);
      attempt_all(out, trial, {Method::verner98, Method::gauss16, Method::radau13});
      if (off != 0) continue;
      if (first == 0) first = row.evaluations;
      expect_below(out, fmt::format("cost at {:g} over that at 1e3", k), "automatic",
                   row.evaluations / first, 1.5);
    }
  }
}

/// Fields that are no numbers from t = 1 on; y = t until then.
void field_that_fails(const Recorder& out) {
  for (const double bad : {nan, std::numeric_limits<double>::infinity()}) {
    const Plane field{[=](double t, const Vector&) { return Vector(t > 1 ? bad : 1.0, 0); }};
    Trial<Plane> trial{fmt::format("{} from t = 1 on", bad),
                       field,
                       {0, 0},
                       {.output_times = {0.5, 0.99, 2}, .tolerance = 1e-9, .max_evaluations = 1e4},
                       [](double t) {
                         return State{t, 0};
                       }};
    trial.must_answer = false;
    attempt_all(out, trial, by_steps);
  }
  const Plane always{[](double, const Vector&) { return Vector(nan, nan); }};
  Trial<Plane> trial{
      "NaN at once", always, {0, 0}, {.output_times = {1}}, [](double) { return State{}; }};
  trial.must_answer = false;
  attempt_all(out, trial, by_steps);
}

/// Defined only for y <= 1, where the motion comes to rest:  y' = sqrt(1 - y).
void edge_of_the_domain(const Recorder& out) {
  const Plane field{[](double, const Vector& y) { return Vector(std::sqrt(1 - y[0]), -y[1]); }};
  const auto truth = [](double t) {
    const double left = 1 - t / 2;
    return State{1 - left * left, std::exp(-t)};
  };
  Trial<Plane> trial{
      "up to the edge but for 1e-3",
      field,
      {0, 1},
      {.output_times = {0.5, 1, 1.5, 1.94}, .tolerance = 1e-9, .max_evaluations = 1e6},
      truth};
  attempt_all(out, trial, by_steps);
  trial.variant = "onto the edge";
  trial.options.output_times = {1, 1.9, 2};
  trial.must_answer = false;
  attempt_all(out, trial, by_steps);
}

/// y' = y^2 is infinite at t = 1.
void blow_up(const Recorder& out) {
  const Plane field{[](double, const Vector& y) { return Vector(y[0] * y[0], 0); }};
  Trial<Plane> trial{"asked for t = 2",
                     field,
                     {1, 0},
                     {.output_times = {0.5, 0.9, 2}, .tolerance = 1e-9, .max_evaluations = 1e5},
                     [](double t) {
                       return State{1 / (1 - t), 0};
                     }};
  trial.must_answer = false;
  attempt_all(out, trial, by_steps);
}

/// Coulomb friction on a spring: the field jumps where the rate changes its sign, at times that are
/// not known beforehand.
void dry_friction(const Recorder& out) {
  const double friction = 0.1;
  const Plane field{[=](double, const Vector& y) {
    const double sign = y[1] > 0 ? 1 : y[1] < 0 ? -1 : 0;
    return Vector(y[1], -y[0] - friction * sign);
  }};
  // Half swings about +-friction, each 0.2 less wide, until |y| < friction holds it.
  const auto truth = [=](double t) {
    double y = 1;
    const double pi = std::acos(-1.0);
    while (true) {
      const double middle = y > 0 ? friction : -friction;
      if (std::abs(y) <= friction) return State{y, 0};
      if (t < pi) {
        return State{middle + (y - middle) * std::cos(t), -(y - middle) * std::sin(t)};
      }
      y = 2 * middle - y;
      t -= pi;
    }
  };
  Trial<Plane> trial{"5 half swings",
                     field,
                     {1, 0},
                     {.output_times = every(0.7, 9.8), .tolerance = 1e-6, .max_evaluations = 1e6},
                     truth};
  trial.must_answer = false;
  attempt_all(out, trial, by_steps);
}

/// A force that jumps at known times.
void square_wave(const Recorder& out) {
  const Plane field{
      [](double t, const Vector&) { return Vector(std::fmod(t, 1.0) < 0.5 ? 1.0 : -1.0, 1); }};
  const auto truth = [](double t) {
    const double part = t - std::floor(t);
    return State{part < 0.5 ? part : 1 - part, t};
  };
  std::vector<double> jumps;
  for (int i = 1; i < 20; ++i) jumps.push_back(0.5 * i);
  Trial<Plane> trial{"declared",
                     field,
                     {0, 0},
                     {.output_times = every(0.7, 9.8), .discontinuities = jumps, .tolerance = 1e-9},
                     truth};
  attempt_all(out, trial, {Method::automatic, Method::verner98, Method::radau13});
  trial.variant = "not declared";
  trial.options.discontinuities.clear();
  trial.must_answer = false;
  attempt_all(out, trial, by_steps);
}

void output_times(const Recorder& out) {
  std::vector<double> dense;
  const std::size_t n = out.quick() ? 100'000 : 10'000'000;
  for (std::size_t i = 1; i <= n; ++i) dense.push_back(10 * double(i) / double(n));
  const kreisel::exact::PendulumMotion motion(19.62, 0.5, 0);
  const auto truth = [&](double t) {
    const auto m = motion.at(t);
    return State{m.angle, m.rate};
  };
  const Trial<Plane> few{
      "10 outputs", pendulum, {0.5, 0}, {.output_times = every(1, 10), .tolerance = 1e-9}, truth};
  const Row sparse = attempt(out, few, Method::verner98);
  const Trial<Plane> many{fmt::format("{} outputs", n),
                          pendulum,
                          {0.5, 0},
                          {.output_times = dense, .tolerance = 1e-9},
                          truth};
  const Row row = attempt(out, many, Method::verner98);
  expect_below(out, "steps with many outputs over steps with few", "verner98",
               row.steps / sparse.steps, 1.0);
  std::vector<double> tight;
  for (int i = 1; i <= 1000; ++i) tight.push_back(1e-12 * i);
  tight.push_back(1);
  const Trial<Plane> close{"output every 1e-12 s",
                           pendulum,
                           {0.5, 0},
                           {.output_times = tight, .tolerance = 1e-9},
                           truth};
  attempt_all(out, close, by_steps);
  const Trial<Plane> same{"the same time again and again",
                          pendulum,
                          {0.5, 0},
                          {.output_times = {0, 0, 1, 1, 1, 2}, .tolerance = 1e-9},
                          truth};
  attempt_all(out, same, by_steps);
  const Trial<Plane> tiny{"to 1e-300 s",
                          pendulum,
                          {0.5, 0},
                          {.output_times = {1e-310, 1e-300}, .tolerance = 1e-9},
                          truth};
  attempt_all(out, tiny, by_steps);
}

/// A field that throws a foreign exception, and one that throws an Error of the library.
void field_that_throws(const Recorder& out) {
  const Plane foreign{[](double t, const Vector&) -> Vector {
    if (t > 1) throw std::runtime_error("the user's own");
    return {1, 0};
  }};
  const Plane ours{[](double t, const Vector&) -> Vector {
    if (t > 1)
      throw kreisel::ComputationFailed("Spring: both ends meet, its force has no direction");
    return {1, 0};
  }};
  const auto truth = [](double t) { return State{t, 0}; };
  Trial<Plane> trial{"ComputationFailed from t = 1 on",
                     ours,
                     {0, 0},
                     {.output_times = {0.5, 0.9, 2}, .tolerance = 1e-9},
                     truth};
  trial.must_answer = false;
  attempt_all(out, trial, by_steps);
  for (const Method method : by_steps) {
    Row row;
    row.variant = "std::runtime_error from t = 1 on";
    row.method = name(method);
    out.begin(row.variant, row.method);
    try {
      (void)kreisel::solve(foreign, {0, 0}, {.output_times = {0.5, 0.9, 2}, .method = method});
      row.note = "swallowed";
    } catch (const std::runtime_error& error) {
      row.note = error.what();
      row.verdict =
          row.note.find("the user's own") != std::string::npos ? Verdict::refused : Verdict::failed;
    }
    out.add(row);
  }
}

}  // namespace

void plane_motions(std::vector<Case>& cases) {
  cases.push_back({"upper-point", "a pendulum near its upper point", &near_the_top});
  cases.push_back({"small-swings", "amplitudes down to denormal", &small_swings});
  cases.push_back({"many-swings", "drift of a pendulum", &many_swings});
  cases.push_back({"undamped-spring", "undamped springs to 1e12 N m/rad", &undamped_spring});
  cases.push_back({"stiff-relaxation", "rates of decay to 1e12/s", &stiff_relaxation});
  cases.push_back(
      {"nan-from-field", "a field that is NaN or infinite from t = 1 on", &field_that_fails});
  cases.push_back({"edge-of-domain", "a field that is NaN in steps too long", &edge_of_the_domain});
  cases.push_back({"blow-up", "a motion that ends in the infinite", &blow_up});
  cases.push_back({"dry-friction", "a field that jumps at unknown times", &dry_friction});
  cases.push_back({"square-wave", "a force that jumps", &square_wave});
  cases.push_back(
      {"output-times", "outputs every 1e-12 s, 1e7 of them, 1e-300 s ahead", &output_times});
  cases.push_back({"throwing-field", "a field that throws", &field_that_throws});
}

}  // namespace stability
