// Tops under weight and with rotors.

#include <fmt/core.h>

#include <cmath>
#include <cstddef>
#include <limits>

#include <dynamics/exact/gyrostat.hpp>
#include <dynamics/exact/lagrange_top.hpp>

#include "top_trial.hpp"
#include "truth.hpp"

namespace stability {

namespace {

using kreisel::EulerTop;
using kreisel::Method;
using kreisel::Vector3;
using State = EulerTop::State;

Eigen::Quaterniond tilted_by(double angle) {
  return {std::cos(angle / 2), std::sin(angle / 2), 0, 0};
}

constexpr double A = 3e-4;
constexpr double C = 1e-4;
constexpr double k = 0.1 * 9.81 * 0.05;

/// Lagrange's top: the closed form against 50 digits, the steps against the closed form.
void lagrange(const Recorder& out, const std::string& variant, double moment, const State& start,
              kreisel::SolveOptions options, bool in_50_digits = true,
              const std::string& picture = "") {
  const EulerTop top({A, A, C}, {0, 0, moment});
  const kreisel::exact::LagrangeTop motion(A, C, moment, start.angular_velocity, start.attitude);
  Trial<EulerTop> trial{variant, top, start, options, [&](double t) {
                          const auto m = motion.at(t - options.begin);
                          return State{m.attitude, m.angular_velocity};
                        }};
  trial.picture = picture;
  if (in_50_digits) {
    const auto states = top_in_50_digits(top, start, options.output_times);
    Trial<EulerTop> closed = trial;
    closed.truth = [&, at = std::size_t(0)](double) mutable { return states.at(at++); };
    attempt(out, closed, Method::automatic);
  }
  attempt_all(out, trial, {Method::verner98, Method::gauss16, Method::radau13, Method::splitting});
}

void sleeping_top(const Recorder& out) {
  const double limit = std::sqrt(4 * A * k) / C;
  for (const double off : {0.0, 1e-12, -1e-12, 1e-3, -1e-3}) {
    for (const double tilt : {0.0, 1e-8}) {
      if (out.quick() && std::abs(off) == 1e-12 && tilt == 0) continue;
      lagrange(out, fmt::format("C^2 w^2/4Ak = 1 + {:g}, tilt {:g}", off, tilt), k,
               {tilted_by(tilt), {0, 0, limit * std::sqrt(1 + off)}},
               {.output_times = every(0.1, 1), .tolerance = 1e-8});
    }
  }
}

/// Over the top: no spin, thrown up through the vertical and down again.
void through_the_vertical(const Recorder& out) {
  for (const double up : {1.0, 1.0 - 1e-14, 1.0 + 1e-14, 1.0 + 1e-6}) {
    const double rate = up * std::sqrt(2 * k * (1 - std::cos(2.0)) / A);  // just to the top
    lagrange(out, fmt::format("thrown from 2 rad with {:.15g} of what takes it up", up), k,
             {tilted_by(2), {-rate, 0, 0}}, {.output_times = every(0.05, 0.5), .tolerance = 1e-8});
  }
  lagrange(out, "hanging, at rest", k, {tilted_by(std::acos(-1.0)), {0, 0, 0}},
           {.output_times = every(0.1, 1), .tolerance = 1e-10}, false);
}

void fast_lagrange(const Recorder& out) {
  for (const double spin : {1e3, 1e5, 1e6}) {
    const double end = out.quick() ? 100 / spin : 1e4 / spin;
    lagrange(out, fmt::format("{:g} rad/s", spin), k, {tilted_by(0.5), {0, 0, spin}},
             {.output_times = every(end / 10, end), .tolerance = 1e-10});
  }
}

/// A fast top without a closed form: the weight pulls across the axis too, and splitting is chosen.
void endless_splitting(const Recorder& out) {
  const EulerTop top({A, A, C}, {0.1 * k, 0, k});
  const State start{tilted_by(0.5), {0, 0, 1e6}};
  Trial<EulerTop> trial{"1e6 rad/s for 1e4 s with a budget of 1e6 evaluations",
                        top,
                        start,
                        {.output_times = {1e4}, .tolerance = 1e-6, .max_evaluations = 1e6},
                        [&](double) { return start; }};
  trial.must_answer = false;
  attempt(out, trial, Method::automatic);
}

/// A transverse weight: chaotic except for special bodies.
void kovalevskaya(const Recorder& out) {
  // Body x, where the weight pulls, is z of the truth: x, y, z -> z, x, y.
  const Eigen::Quaterniond p(0.5, 0.5, 0.5, 0.5);  // takes truth's axes to the body's
  const double end = out.quick() ? 20 : 1000;
  const EulerTop top({2, 2, 1}, {3, 0, 0});
  const EulerTop same({2, 1, 2}, {0, 0, 3});
  const State start{tilted_by(0.7), {0.5, -0.4, 1.2}};
  // Components of a body vector (x, y, z) are (y, z, x) on the truth's axes.
  const auto cycled = [](const Vector3<double>& v) { return Vector3<double>(v.y(), v.z(), v.x()); };
  const kreisel::SolveOptions options{.output_times = every(2, out.quick() ? 20 : 60),
                                      .tolerance = 1e-9};
  const State start_of_same{start.attitude * p, cycled(start.angular_velocity)};
  const auto states = top_in_50_digits(same, start_of_same, options.output_times);
  for (const Method method :
       {Method::automatic, Method::verner98, Method::gauss16, Method::radau13, Method::splitting}) {
    const Trial<EulerTop> trial{"A = B = 2C", top, start, options,
                                [&, at = std::size_t(0)](double) mutable {
                                  const State& s = states.at(at++);
                                  const Vector3<double>& w = s.angular_velocity;
                                  return State{s.attitude * p.conjugate(), {w.z(), w.x(), w.y()}};
                                }};
    attempt(out, trial, method);
  }
  const auto run = kreisel::solve(
      top, start,
      {.output_times = every(end / 100, end), .tolerance = 1e-12, .method = Method::gauss16});
  for (const auto& d : run.report.invariants) {
    expect_below(out, fmt::format("drift of {} over {:g} s", d.name, end), "gauss16",
                 d.largest / std::abs(d.start), 1e-11, run.report.message);
  }
}

void gyrostat(const Recorder& out) {
  for (const double rotor : {1e-300, 1e-12, 1.0, 1e6}) {
    for (const Vector3<double>& along :
         {Vector3<double>(0, 0, rotor), Vector3<double>(0, rotor, 0)}) {
      const EulerTop top({1, 2, 2.5}, {0, 0, 0}, along);
      const State start{tilted_by(0.5), {0.1, 2, 0.3}};
      const double end = 10 / std::max(1.0, rotor / 100);
      const kreisel::SolveOptions options{.output_times = every(end / 10, end), .tolerance = 1e-9};
      const auto states = top_in_50_digits(top, start, options.output_times);
      for (const Method method : {Method::automatic, Method::verner98, Method::gauss16}) {
        const Trial<EulerTop> trial{
            fmt::format("rotor {:g} N m s about axis {}", rotor, along.z() == 0 ? 2 : 3), top,
            start, options, [&, at = std::size_t(0)](double) mutable { return states.at(at++); }};
        attempt(out, trial, method);
      }
    }
  }
}

void tight_and_loose(const Recorder& out) {
  for (int i = 2; i <= 15; i += out.quick() ? 4 : 1) {
    lagrange(out, fmt::format("tolerance 1e-{}", i), k, {tilted_by(0.5), {1, -2, 300}},
             {.output_times = every(0.1, 1), .tolerance = std::pow(10.0, -i)});
  }
}

void weak_weight(const Recorder& out) {
  for (const double weak : {1e-320, 1e-200, 1e-16, 1e-8}) {
    lagrange(out, fmt::format("{:g} N m", weak), weak, {tilted_by(0.5), {1, -2, 300}},
             {.output_times = every(0.1, 1), .tolerance = 1e-10}, weak > 1e-30);
  }
}

void long_heavy_run(const Recorder& out) {
  const double end = out.quick() ? 10 : 1000;
  std::vector<double> times;
  for (double t = 0.1; t < end; t *= 1.5) times.push_back(t);
  times.push_back(end);
  lagrange(out, fmt::format("{:g} s", end), k, {tilted_by(0.5), {1, -2, 300}},
           {.output_times = times, .tolerance = 1e-12}, false, "Lagrange's top");
}

}  // namespace

void heavy_tops(std::vector<Case>& cases) {
  cases.push_back({"sleeping-top", "at the limit of stability, 1e-12 beside it, 1e-8 off upright",
                   &sleeping_top});
  cases.push_back({"through-the-vertical", "the axis passes the vertical", &through_the_vertical});
  cases.push_back({"fast-top", "spin that commands the weight", &fast_lagrange});
  cases.push_back(
      {"endless-splitting", "more steps than anybody waits for", &endless_splitting, 5});
  cases.push_back({"kovalevskaya", "her top and her invariant", &kovalevskaya});
  cases.push_back({"gyrostat", "rotors from 1e-300 to 1e6 N m s", &gyrostat});
  cases.push_back(
      {"tolerances-heavy", "tolerances from 1e-2 to 1e-15 under weight", &tight_and_loose});
  cases.push_back({"weak-weight", "weights down to denormal", &weak_weight});
  cases.push_back({"long-heavy-run", "drift of Lagrange's top", &long_heavy_run});
}

}  // namespace stability
