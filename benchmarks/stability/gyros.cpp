// The Cardan gyro: stiff bearings, gimbal lock, rings without mass.

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <cstddef>
#include <fstream>
#include <numbers>
#include <stdexcept>

#include <dynamics/exact/free_top.hpp>
#include <dynamics/gimbal/cardan_gyro.hpp>
#include <dynamics/guide/resting.hpp>

#include "../work_precision/references.hpp"
#include "trial.hpp"
#include <tests/support/worst.hpp>

namespace stability {

namespace {

using namespace kreisel;
using Gyro = CardanGyro<RestingFrame<>>;
using State = Gyro::State;
using LongVector = Eigen::Matrix<long double, 6, 1>;

constexpr Methods by_steps = {Method::automatic, Method::verner98, Method::gauss16,
                              Method::radau13};

const CardanMoments heavy_rings{{5e-4, 5e-4, 8e-4}, {2e-4, 3e-4, 2.5e-4}, {4e-4, 4e-4, 4e-4}};
constexpr double reference_angle = 0.3;

/// Gyros against references of 25 digits, whose beta counts from 0.
void bearing(const Recorder& out, const std::string& name, const std::string& variant,
             double stiffness, double damping, double budget, Methods methods,
             double& evaluations) {
  const work_precision::Reference all = work_precision::reference(name);
  const Gyro gyro(heavy_rings, {{0.5, 1e-3}, {stiffness, damping, reference_angle}}, {});
  const Trial<Gyro> trial{variant,
                          gyro,
                          {.alpha_rate = 0.5, .phi_rate = 500},
                          {.output_times = all.times, .tolerance = 1e-9, .max_evaluations = budget},
                          [&](double t) {
                            for (std::size_t i = 0; i < all.times.size(); ++i) {
                              if (all.times[i] != t) continue;
                              const auto& s = all.states[i];
                              return State{s[0], s[1] - reference_angle, s[2], s[3], s[4], s[5]};
                            }
                            throw std::logic_error("no reference at this time");
                          }};
  for (const Method method : methods) {
    const Row row = attempt(out, trial, method);
    if (method == Method::automatic) evaluations = row.evaluations;
  }
}

void damped_bearings(const Recorder& out) {
  double first = 0;
  double now = 0;
  const Methods methods = {Method::automatic, Method::radau13, Method::verner98};
  const double budget = out.quick() ? 3e6 : 1e8;
  bearing(out, "S4a_cardan_k1e3_d2", "1e3 N m/rad", 1e3, 2, budget, methods, first);
  bearing(out, "S4b_cardan_k1e6_d2e3", "1e6 N m/rad", 1e6, 2e3, budget, methods, now);
  expect_below(out, "cost at 1e6 over that at 1e3 N m/rad", "automatic", now / first, 1.5);
  bearing(out, "S4c_cardan_k1e9_d2e6", "1e9 N m/rad", 1e9, 2e6, budget, methods, now);
  expect_below(out, "cost at 1e9 over that at 1e3 N m/rad", "automatic", now / first, 1.5);
  bearing(out, "S4e_cardan_k1e12_d2e9", "1e12 N m/rad", 1e12, 2e9, budget, methods, now);
  expect_below(out, "cost at 1e12 over that at 1e3 N m/rad", "automatic", now / first, 1.5);
}

void undamped_bearings(const Recorder& out) {
  double evaluations = 0;
  const std::string variant = "1e6 N m/rad, 1e4 oscillations";
  // Other codes of order 8 need 3e6 for an error of 4e-9 there (GSL's rk8pd, odeint's rkf78).
  bearing(out, "S4d_cardan_k1e6_d0", variant, 1e6, 0, out.quick() ? 3e7 : 1e8, {Method::automatic},
          evaluations);
  bearing(out, "S4d_cardan_k1e6_d0", variant, 1e6, 0, out.quick() ? 3e6 : 1e8,
          {Method::radau13, Method::gauss16}, evaluations);
}

/// 1e11 oscillations: no method resolves them, and none may report a result.
void unresolved_bearing(const Recorder& out, Methods methods) {
  const Gyro gyro(heavy_rings, {{0.5, 1e-3}, {1e12, 0, reference_angle}}, {});
  Trial<Gyro> trial{"1e12 N m/rad without damping, a budget of 1e6",
                    gyro,
                    {.beta = 1e-6, .alpha_rate = 0.5, .phi_rate = 500},
                    {.output_times = {2.0}, .tolerance = 1e-9, .max_evaluations = 1e6},
                    [](double) { return State{}; }};
  trial.must_answer = false;
  attempt_all(out, trial, methods);
}

void hopeless_bearing(const Recorder& out) {
  unresolved_bearing(out, {Method::automatic, Method::radau13});
}

/// The same bearing with Gauss's equal steps, of which there would be 1e7.
void endless_bearing(const Recorder& out) { unresolved_bearing(out, {Method::gauss16}); }

/// The trajectories of tests/data/cardan-gyro.json on a guide at rest.
void through_gimbal_lock(const Recorder& out) {
  std::ifstream file(std::string(KREISEL_TEST_DATA) + "/cardan-gyro.json");
  const nlohmann::json all = nlohmann::json::parse(file);
  for (const auto& scene : all.at("trajectories")) {
    const std::string name = scene.at("name").get<std::string>();
    if (name != "T7b_through_lock" && name != "T1_free_symmetric") continue;
    const auto& p = scene.at("parameters");
    const auto number = [&p](const char* key) { return std::stod(p.at(key).get<std::string>()); };
    const Gyro gyro({{number("A1"), number("B1"), number("C1")},
                     {number("A2"), number("B2"), number("C2")},
                     {number("A3"), number("B3"), number("C3")}},
                    {}, {});
    std::vector<double> times;
    std::vector<State> states;
    for (const auto& point : scene.at("points")) {
      const auto of = [&point](const char* key, std::size_t i) {
        return std::stod(point.at(key).at(i).get<std::string>());
      };
      times.push_back(std::stod(point.at("t").get<std::string>()));
      states.push_back({of("q", 0), of("q", 1), of("q", 2), of("qd", 0), of("qd", 1), of("qd", 2)});
    }
    const State start = states.front();
    times.erase(times.begin());
    for (const Method method : by_steps) {
      const Trial<Gyro> trial{name,
                              gyro,
                              start,
                              {.output_times = times, .tolerance = 1e-9},
                              [&, at = std::size_t(0)](double) mutable { return states.at(++at); }};
      attempt(out, trial, method);
    }
  }
}

/// The same equations in 64 bits.
State in_long_double(const Gyro& gyro, const State& start, double end) {
  const auto field = [&gyro](const long double& t, const LongVector& y) {
    return gyro.rates<long double>(t, y);
  };
  ExplicitRungeKutta<LongVector, decltype(field)> steps(
      field, 0.0L, Gyro::to_vector(start).cast<long double>(),
      {.relative = 1e-16, .max_evaluations = 1e6}, Gyro::blocks);
  return Gyro::from_vector(steps.advance_to(end).cast<double>());
}

void near_gimbal_lock(const Recorder& out) {
  for (const double off : {1e-2, 1e-4, 1e-6, 1e-8, 0.0}) {
    for (const double rings : {1.0, 1e-4, 1e-8, 0.0}) {
      if (out.quick() && (off == 1e-4 || rings == 1e-4)) continue;
      const CardanMoments moments{heavy_rings.rotor, rings * heavy_rings.inner_ring,
                                  rings * heavy_rings.outer_ring};
      const Gyro gyro(moments, {}, {});
      // The motion is along the lock, not through it.
      const State start{.beta = std::numbers::pi / 2 - off, .alpha_rate = 0.3, .phi_rate = 100};
      const double end = 0.05;
      Trial<Gyro> trial{
          fmt::format("90 deg - {:g}, rings of {:g} of the mass", off, rings),
          gyro,
          start,
          {.output_times = {end}, .tolerance = 1e-8, .max_evaluations = out.quick() ? 3e5 : 1e7},
          [&](double t) { return in_long_double(gyro, start, t); }};
      trial.must_answer = rings >= 1e-4;
      // Near the lock the error of the start's last digit grows; two runs in 64 bits measure by how
      // much.
      State moved = start;
      moved.beta = std::nextafter(moved.beta, 0.0);
      try {
        const auto a = Gyro::to_vector(in_long_double(gyro, start, end));
        const auto b = Gyro::to_vector(in_long_double(gyro, moved, end));
        kreisel::ErrorMeasure<Gyro> distance(1e-3);
        trial.truth_error = 1e-4 * distance(a, b) + 1e-14;
      } catch (const kreisel::Error&) {
        // Then there is no truth, and the trials below must refuse.
        trial.truth = [](double) { return State{.alpha = double(NAN)}; };
        trial.must_answer = false;
      }
      attempt_all(out, trial, {Method::automatic, Method::radau13});
    }
  }
}

/// Rings without mass: the rotor is a free top, and the angles are its Cardan angles.
void massless_rings(const Recorder& out) {
  const Vector3<double> rotor(5e-4, 4e-4, 6e-4);
  for (const double beta : {0.3, 1.2, 1.5}) {
    const Gyro gyro({rotor}, {}, {});
    const State start{.alpha = 0.1,
                      .beta = beta,
                      .phi = 0.2,
                      .alpha_rate = 0.4,
                      .beta_rate = 0.1,
                      .phi_rate = 50};
    const auto turn = [](int axis, double angle) {
      return Eigen::Quaterniond(Eigen::AngleAxisd(angle, Vector3<double>::Unit(axis)));
    };
    const Eigen::Quaterniond q = turn(0, start.alpha) * turn(1, start.beta) * turn(2, start.phi);
    const Vector3<double> on_inner(start.alpha_rate * std::cos(beta), start.beta_rate,
                                   start.alpha_rate * std::sin(beta) + start.phi_rate);
    const Vector3<double> w = turn(2, start.phi).conjugate() * on_inner;
    const exact::FreeTop motion(rotor, w, q);
    double turns = 0;  // of phi, whole ones
    double phi_before = start.phi;
    const auto truth = [&](double t) {
      // Integrated in steps so small that phi is known except for whole turns.
      State s;
      const int n = 400;
      for (int i = 1; i <= n; ++i) {
        const double now = t * i / n;
        const exact::TopMotion m = motion.at(now);
        const Matrix3<double> R = m.attitude.normalized().toRotationMatrix();
        s.beta = std::asin(std::clamp(R(0, 2), -1.0, 1.0));
        s.alpha = std::atan2(-R(1, 2), R(2, 2));
        s.phi = std::atan2(-R(0, 1), R(0, 0));
        if (i == 1) {
          turns = 0;
          phi_before = start.phi;
        }
        const double whole = std::round((phi_before - s.phi - turns) / (2 * std::numbers::pi));
        if (whole != 0) turns += 2 * std::numbers::pi * whole;
        s.phi += turns;
        phi_before = s.phi;
        const Vector3<double> v = turn(2, s.phi) * m.angular_velocity;
        s.beta_rate = v.y();
        s.alpha_rate = v.x() / std::cos(s.beta);
        s.phi_rate = v.z() - s.alpha_rate * std::sin(s.beta);
      }
      return s;
    };
    Trial<Gyro> trial{fmt::format("from beta = {:g}", beta),
                      gyro,
                      start,
                      {.output_times = every(0.1, 1), .tolerance = 1e-8},
                      truth};
    trial.truth_error = beta > 1.4 ? 1e-11 : 1e-13;  // of the angles, by 1/cos^2 beta
    attempt_all(out, trial, by_steps);
  }
  const Gyro gyro({{5e-4, 5e-4, 8e-4}}, {}, {});
  expect_refusal(out, "accelerations at 90 degrees", "rates",
                 [&] {
                   (void)gyro.rates(0, Gyro::to_vector({.beta = std::numbers::pi / 2,
                                                        .alpha_rate = 1,
                                                        .beta_rate = 1,
                                                        .phi_rate = 50}));
                 },
                 {"gimbal lock", "alpha"});
  Trial<Gyro> into{"into 90 degrees",
                   gyro,
                   {.beta = 1.4, .beta_rate = 2},
                   {.output_times = {1.0}, .tolerance = 1e-8, .max_evaluations = 1e6},
                   [](double t) { return State{.beta = 1.4 + 2 * t, .beta_rate = 2}; }};
  into.must_answer = false;
  attempt_all(out, into, by_steps);
}

void fast_rotor(const Recorder& out) {
  for (const double spin : {1e4, 1e6}) {
    const Gyro gyro(heavy_rings, {{0.5, 1e-3}, {0.5, 1e-3}}, {});
    const State start{.alpha = 0.1, .beta = 0.2, .alpha_rate = 0.5, .phi_rate = spin};
    const double end = 1e2 / spin;
    Trial<Gyro> trial{fmt::format("{:g} rad/s", spin),
                      gyro,
                      start,
                      {.output_times = {end}, .tolerance = 1e-9, .max_evaluations = 1e6},
                      [&](double t) { return in_long_double(gyro, start, t); }};
    trial.truth_error = 1e-14;
    attempt_all(out, trial, by_steps);
  }
}

void drift_of_gyro(const Recorder& out) {
  const Gyro gyro(heavy_rings, {}, {});
  const State start{.alpha = 0.1, .beta = 0.5, .beta_rate = 1, .phi_rate = 50};
  const double end = out.quick() ? 10 : 1000;
  std::vector<double> times;
  for (double t = 0.1; t < end; t *= 2) times.push_back(t);
  times.push_back(end);
  for (const Method method : {Method::verner98, Method::gauss16, Method::radau13}) {
    out.begin("conservative", name(method));
    const auto run =
        solve(gyro, start, {.output_times = times, .tolerance = 1e-11, .method = method});
    const double first = gyro.conserved(0, start).front().second;
    double worst = 0;
    for (std::size_t i = 0; i < run.times.size(); ++i) {
      const double off = gyro.conserved(0, run.states[i]).front().second / first - 1;
      worst = test::worst_of(worst, std::abs(off));
      out.drift(fmt::format("energy, {}", name(method)), run.times[i], off);
    }
    // An energy has two parts of the state: twice their error, and one rounding.
    expect_below(out, fmt::format("energy over {:g} s", end), name(method), worst,
                 4 * run.report.error_estimate + 4e-16, run.report.message);
  }
}

}  // namespace

void gyros(std::vector<Case>& cases) {
  cases.push_back(
      {"damped-bearings", "bearings of 1e3 to 1e12 N m/rad, overdamped", &damped_bearings});
  cases.push_back({"undamped-bearing", "a stiff spring is an oscillation", &undamped_bearings, 60});
  cases.push_back({"hopeless-bearing", "1e11 oscillations", &hopeless_bearing});
  cases.push_back({"endless-bearing", "1e11 oscillations in equal steps", &endless_bearing, 5});
  cases.push_back({"gimbal-lock", "through 90 degrees", &through_gimbal_lock});
  cases.push_back(
      {"near-gimbal-lock", "90 deg - 1e-2 to 1e-8, rings to no mass", &near_gimbal_lock});
  cases.push_back({"massless-rings", "rings without mass, into gimbal lock", &massless_rings});
  cases.push_back({"fast-rotor", "rotors to 1e6 rad/s", &fast_rotor});
  cases.push_back({"gyro-drift", "energy of a Cardan gyro", &drift_of_gyro});
}

}  // namespace stability
