// Tops without torque.

#include <fmt/core.h>

#include <cmath>

#include <dynamics/exact/free_top.hpp>
#include <dynamics/rigid/euler_top.hpp>

#include "top_trial.hpp"
#include "truth.hpp"

namespace kreisel {

template Trajectory<EulerTop::State> solve(const EulerTop& scene, const EulerTop::State& start,
                                           const SolveOptions& options);

}  // namespace kreisel

namespace stability {

template Row attempt(const Recorder& out, const Trial<kreisel::EulerTop>& trial,
                     kreisel::Method method);

namespace {

using kreisel::EulerTop;
using kreisel::Method;
using kreisel::Vector3;
using State = EulerTop::State;

const Eigen::Quaterniond tilted(std::cos(0.25), std::sin(0.25), 0, 0);

/// A free top: the truth is in 50 digits for the closed form, and the closed form for the steps.
void free_top(const Recorder& out, const std::string& variant, const Vector3<double>& moments,
              const State& start, kreisel::SolveOptions options, bool in_50_digits = true,
              const std::string& picture = "") {
  const EulerTop top(moments);
  const kreisel::exact::FreeTop motion(moments, start.angular_velocity, start.attitude);
  const double begin = options.begin;
  Trial<EulerTop> trial{variant, top, start, options, [&](double t) {
                          const auto m = motion.at(t - begin);
                          return State{m.attitude, m.angular_velocity};
                        }};
  trial.picture = picture;
  if (in_50_digits) {
    const auto states = top_in_50_digits(top, start, options.output_times);
    Trial<EulerTop> closed = trial;
    closed.truth = [&, at = std::size_t(0)](double) mutable { return states.at(at++); };
    attempt(out, closed, Method::automatic);
  }
  attempt_all(out, trial, {Method::verner98, Method::gauss16, Method::radau13});
}

void dzhanibekov(const Recorder& out) {
  for (const double eps : {1e-3, 1e-5, 1e-8}) {
    if (out.quick() && eps == 1e-5) continue;
    free_top(out, fmt::format("w = (eps, 2, eps), eps = {:g}", eps), {1, 2, 3},
             {Eigen::Quaterniond::Identity(), {eps, 2, eps}},
             {.output_times = every(10, 100), .tolerance = eps == 1e-3 ? 1e-8 : 1e-6});
  }
}

/// On the separatrix L^2 = 2 E B:  A (B - A) w1^2 = C (C - B) w3^2, which these numbers meet
/// exactly.
void separatrix(const Recorder& out) {
  const Vector3<double> moments(2, 3, 4);  // 2 w1^2 = 4 w3^2 . 1, so w1^2 = 2 w3^2
  const double root = std::sqrt(2.0);
  const double off[] = {0, 1e-14, -1e-14, 1e-10};
  for (const double e : off) {
    free_top(out, fmt::format("L^2/2EB - 1 = {:g}", e), moments, {tilted, {root * (1 + e), 1.5, 1}},
             {.output_times = every(2, 20), .tolerance = 1e-8});
  }
}

void principal_axes(const Recorder& out) {
  for (int i = 0; i < 3; ++i) {
    State start{tilted, Vector3<double>::Zero()};
    start.angular_velocity[i] = 7;
    free_top(out, fmt::format("exactly about axis {}", i + 1), {1, 2, 3}, start,
             {.output_times = every(10, 100), .tolerance = i == 1 ? 1e-8 : 1e-11}, i != 1);
  }
}

void equal_moments(const Recorder& out) {
  const State start{tilted, {0.3, -0.4, 2}};
  const kreisel::SolveOptions options{.output_times = every(10, 100), .tolerance = 1e-11};
  free_top(out, "I1 = I2", {2, 2, 3}, start, options);
  free_top(out, "I1 = I2 (1 + 1e-15)", {2 * (1 + 1e-15), 2, 3}, start, options);
  free_top(out, "I1 = I2 (1 - 1e-15)", {2 * (1 - 1e-15), 2, 3}, start, options);
  free_top(out, "sphere", {2, 2, 2}, start, options);
  free_top(out, "sphere but for 1e-15", {2, 2 * (1 + 1e-15), 2 * (1 - 1e-15)}, start, options);
  // Both branches must have the same result.
  const kreisel::exact::FreeTop round({2, 2, 3}, start.angular_velocity, tilted);
  const kreisel::exact::FreeTop general({2 * (1 + 1e-15), 2, 3}, start.angular_velocity, tilted);
  expect_below(out, "I1 = I2 against I1 = I2 (1 + 1e-15)", "closed form",
               round.at(100).attitude.angularDistance(general.at(100).attitude), 1e-12);
}

void inertia_ratios(const Recorder& out) {
  double evaluations = 0;
  for (const double ratio : {1e3, 1e6, 1e9, 1e12}) {
    const Vector3<double> moments(1, 1.2, 1 / ratio + 0.2);
    const State start{tilted, {0.3, 0.2, 2}};
    const std::string what = fmt::format("1 : 1.2 : 0.2 + 1/{:g}, a disc or a plate", ratio);
    free_top(out, what, moments, start, {.output_times = every(10, 100), .tolerance = 1e-10});
    const EulerTop needle({1, 1 + 0.5 / ratio, 1 / ratio});
    const kreisel::exact::FreeTop motion(needle.moments(), start.angular_velocity, tilted);
    const Trial<EulerTop> trial{fmt::format("needle 1 : 1/{:g}", ratio),
                                needle,
                                start,
                                {.output_times = every(10, 100), .tolerance = 1e-10},
                                [&](double t) {
                                  const auto m = motion.at(t);
                                  return State{m.attitude, m.angular_velocity};
                                }};
    attempt_all(out, trial, {Method::automatic, Method::gauss16, Method::radau13});
    const Row row = attempt(out, trial, Method::verner98);
    if (evaluations == 0) evaluations = row.evaluations;
    expect_below(out, fmt::format("cost at 1/{:g} over that at 1/1000", ratio), "verner98",
                 row.evaluations / evaluations, 2);
  }
  expect_refusal(out, "needle: C = 0", "EulerTop", [] { EulerTop({1, 1, 0}); }, {"axis"});
  expect_refusal(out, "point", "EulerTop", [] { EulerTop({0, 0, 0}); });
  expect_refusal(out, "triangle inequality off by 1e-9", "EulerTop",
                 [] {
                   EulerTop({1, 1, 2 + 1e-8});
                 },
                 {"triangle"});
  const EulerTop disc({1, 1, 2 * (1 + 1e-13)});
  expect_below(out, "disc, beyond the triangle inequality by 1e-13", "EulerTop",
               disc.moments().z() - 2, 1e-12);
}

void fast_spin(const Recorder& out) {
  const Vector3<double> moments(3e-4, 3e-4, 1e-4);
  const EulerTop top(moments);
  for (const bool about_axis : {true, false}) {
    const State start{tilted,
                      about_axis ? Vector3<double>(0, 0, 1e6) : Vector3<double>(3, -4, 1e6)};
    Trial<EulerTop> trial{about_axis ? "about its axis, 1e10 rad" : "nutating, 1e10 rad",
                          top,
                          start,
                          {.output_times = every(1e3, 1e4), .tolerance = 1e-9},
                          [&](double t) { return symmetric_in_50_digits(top, start, t); }};
    trial.picture = about_axis ? "" : "spin 1e6 rad/s";
    attempt(out, trial, Method::automatic);
    trial.variant = about_axis ? "about its axis, 1e4 rad" : "nutating, 1e4 rad";
    trial.options.output_times = every(1e-3, 1e-2);
    trial.picture.clear();
    attempt_all(out, trial, {Method::verner98, Method::gauss16, Method::radau13});
  }
}

void horizons(const Recorder& out) {
  for (const double end : {1e-9, 1e-3, 1.0, 1e3, 1e6, 1e9}) {
    const State start{tilted, {0.5, 2, -0.3}};
    const EulerTop top({1, 2, 3});
    const kreisel::exact::FreeTop motion({1, 2, 3}, start.angular_velocity, tilted);
    const Trial<EulerTop> trial{fmt::format("{:g} s", end),
                                top,
                                start,
                                {.output_times = every(end / 10, end),
                                 .tolerance = 1e-9,
                                 .max_evaluations = out.quick() ? 1e6 : 1e8},
                                [&](double t) {
                                  const auto m = motion.at(t);
                                  return State{m.attitude, m.angular_velocity};
                                }};
    attempt_all(out, trial, {Method::automatic, Method::verner98, Method::radau13});
    if (end <= 1e3) attempt(out, trial, Method::gauss16);
  }
}

/// Equal steps have no limit beforehand: the steps for 1e9 s would take too long.
void endless(const Recorder& out) {
  const State start{tilted, {0.5, 2, -0.3}};
  const EulerTop top({1, 2, 3});
  const kreisel::exact::FreeTop motion({1, 2, 3}, start.angular_velocity, tilted);
  const Trial<EulerTop> trial{"1e9 s with a budget of 1e6 evaluations",
                              top,
                              start,
                              {.output_times = {1e9}, .tolerance = 1e-6, .max_evaluations = 1e6},
                              [&](double t) {
                                const auto m = motion.at(t);
                                return State{m.attitude, m.angular_velocity};
                              }};
  attempt(out, trial, Method::gauss16);
}

void far_from_zero(const Recorder& out) {
  for (const double begin : {1e9, -1e9, 1e12, 1e15, 1e16}) {
    kreisel::SolveOptions options{
        .begin = begin, .output_times = every(1, 10, 0), .tolerance = 1e-9};
    for (double& t : options.output_times) t += begin;
    const EulerTop top({1, 2, 3});
    const State start{tilted, {0.5, 2, -0.3}};
    const kreisel::exact::FreeTop motion({1, 2, 3}, start.angular_velocity, tilted);
    Trial<EulerTop> trial{fmt::format("t0 = {:g} s", begin), top, start, options, [&](double t) {
                            const auto m = motion.at(t - begin);
                            return State{m.attitude, m.angular_velocity};
                          }};
    trial.must_answer = std::abs(begin) < 1e15;
    attempt_all(out, trial);
  }
}

void backwards(const Recorder& out) {
  free_top(out, "to t = -100 s", {1, 2, 3}, {tilted, {0.5, 2, -0.3}},
           {.output_times = every(-10, -100), .tolerance = 1e-10}, false);
  const EulerTop top({1, 2, 3});
  const State start{tilted, {0.5, 2, -0.3}};
  const auto there = kreisel::solve(
      top, start, {.output_times = {50}, .tolerance = 1e-13, .method = Method::verner98});
  const auto back = kreisel::solve(
      top, there.states[0],
      {.begin = 50, .output_times = {0}, .tolerance = 1e-13, .method = Method::verner98});
  kreisel::ErrorMeasure<EulerTop> distance(1e-3);
  expect_below(out, "there and back", "verner98",
               distance(EulerTop::to_vector(back.states[0]), EulerTop::to_vector(start)),
               // The error of the rate at the reversal makes the attitude wrong on the whole way
               // back.
               3 * (there.report.error_estimate + back.report.error_estimate));
  free_top(out, "t1 = t0", {1, 2, 3}, start, {.output_times = {0}}, false);
}

void denormal_and_huge_rates(const Recorder& out) {
  for (const double rate : {0.0, 1e-320, 1e-300, 1e-170, 1e-100, 1e100, 1e154, 1e160, 1e300}) {
    const State start{tilted, rate * Vector3<double>(1, 2, 0.5)};
    const double unit = rate >= 1e-300 ? 1 / rate : 1;
    const EulerTop top({2, 2, 3});
    Trial<EulerTop> trial{fmt::format("{:g} rad/s", rate),
                          top,
                          start,
                          {.output_times = {unit, 2 * unit, 10 * unit},
                           .tolerance = 1e-9,
                           .absolute_scale = rate < 1 ? 0 : 1e-3},
                          [&](double t) { return symmetric_in_50_digits(top, start, t); }};
    trial.must_answer = rate <= 1e100 && rate > 1e-154;
    attempt_all(out, trial,
                {Method::automatic, Method::verner98, Method::gauss16, Method::radau13});
  }
}

void norms(const Recorder& out) {
  for (const double norm : {1e-300, 1e-170, 1e-100, 1e100, 1e170, 1e300, 0.0}) {
    const EulerTop top({2, 2, 3});
    const State start{Eigen::Quaterniond(norm * tilted.coeffs()), {0.1, 0.2, 1}};
    const State unit{tilted, start.angular_velocity};
    Trial<EulerTop> trial{fmt::format("|q| = {:g}", norm),
                          top,
                          start,
                          {.output_times = every(1, 10), .tolerance = 1e-9},
                          [&](double t) { return symmetric_in_50_digits(top, unit, t); }};
    trial.must_answer = norm >= 1e-100 && norm <= 1e100;
    attempt_all(out, trial,
                {Method::automatic, Method::verner98, Method::gauss16, Method::radau13});
  }
}

void tolerances(const Recorder& out) {
  for (int k = 2; k <= 15; k += out.quick() ? 4 : 1) {
    free_top(out, fmt::format("tolerance 1e-{}", k), {1, 2, 2.5}, {tilted, {1, -2, 3}},
             {.output_times = every(1, 10), .tolerance = std::pow(10.0, -k)});
  }
  free_top(out, "tolerance 1e-15", {1, 2, 2.5}, {tilted, {1, -2, 3}},
           {.output_times = every(1, 10), .tolerance = 1e-15});
}

void long_free_run(const Recorder& out) {
  const double end = out.quick() ? 1e3 : 1e5;
  std::vector<double> times;
  for (double t = 1; t < end; t *= 1.5) times.push_back(t);
  times.push_back(end);
  free_top(out, fmt::format("{:g} s", end), {1, 2, 3}, {tilted, {0.5, 2, -0.3}},
           {.output_times = times, .tolerance = 1e-12}, false, "free top");
}

}  // namespace

void tops(std::vector<Case>& cases) {
  cases.push_back(
      {"dzhanibekov", "rotation about the middle axis but for 1e-3 to 1e-8", &dzhanibekov});
  cases.push_back({"separatrix", "on the separatrix and 1e-14 beside it", &separatrix});
  cases.push_back({"principal-axes", "rotation exactly about a principal axis", &principal_axes});
  cases.push_back({"equal-moments", "I1 = I2, I1 = I2 (1 +- 1e-15), sphere", &equal_moments});
  cases.push_back(
      {"inertia-ratio", "inertia ratios to 1e12: needles, discs, points", &inertia_ratios});
  cases.push_back({"spin-1e6", "spin of 1e6 rad/s over 1e4 s: 1e10 rad", &fast_spin});
  cases.push_back({"horizons", "from 1e-9 s to 1e9 s", &horizons, 15});
  cases.push_back({"endless", "equal steps over 1e9 s", &endless, 5});
  cases.push_back({"far-from-zero", "time far from 0", &far_from_zero});
  cases.push_back({"backwards", "t1 < t0 and t1 = t0", &backwards});
  cases.push_back(
      {"rates", "rates from denormals to where squares overflow", &denormal_and_huge_rates});
  cases.push_back({"norms", "quaternions of any norm at the start", &norms});
  cases.push_back({"tolerances", "tolerances from 1e-2 to 1e-15", &tolerances});
  cases.push_back({"long-free-run", "drift of a free top", &long_free_run});
}

}  // namespace stability
