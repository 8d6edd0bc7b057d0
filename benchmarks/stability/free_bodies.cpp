// Free bodies on guides with extreme motions, by FreeBody.

#include <fmt/core.h>

#include <cmath>

#include <dynamics/exact/free_top.hpp>
#include <dynamics/guide/resting.hpp>
#include <dynamics/guide/rotating.hpp>
#include <dynamics/rigid/free_body.hpp>

#include "any.hpp"
#include "trial.hpp"

namespace stability {

namespace {

using namespace kreisel;
using Free = FreeBody<AnyGuide, AnyLoad>;
using State = Free::State;

const Eigen::Quaterniond tilted(std::cos(0.25), std::sin(0.25), 0, 0);
const Vector3<double> moments(1, 2, 2.5);

constexpr Methods by_steps = {Method::automatic, Method::verner98, Method::gauss16,
                              Method::radau13};

Eigen::Quaterniond about_z(double angle) {
  return {std::cos(angle / 2), 0, 0, std::sin(angle / 2)};
}

/// A body thrown with v from x0, which turns freely, seen from a guide that turns about z with
/// `rate`. Its origin O' lies at -centre from the centre of mass, on body axes.
struct Thrown {
  exact::FreeTop turning;
  Vector3<double> x0;
  Vector3<double> v;
  Vector3<double> centre;
  double rate;

  [[nodiscard]] State at(double t) const {
    const exact::TopMotion m = turning.at(t);
    const Eigen::Quaterniond back = about_z(-rate * t);
    const Vector3<double> u(0, 0, rate);
    const Eigen::Quaterniond q = back * m.attitude;
    const Vector3<double> w = m.angular_velocity;
    const Vector3<double> place = x0 + v * t - m.attitude * centre;
    const Vector3<double> velocity = m.attitude.conjugate() * v - w.cross(centre);
    const Vector3<double> u_body = q.conjugate() * u;
    const Vector3<double> place_G = back * place;
    return {
        q, place_G, {{w - u_body, velocity - q.conjugate() * Vector3<double>(u.cross(place_G))}}};
  }
};

InertiaTensor<Body> inertia(const Vector3<double>& centre) {
  return InertiaTensor<Body>::about_centre(2, centre, moments.asDiagonal().toDenseMatrix());
}

void thrown(const Recorder& out) {
  for (const double rate : {0.0, 1e-320, 1e-300, 7.292115e-5, 1.0, 1e3}) {
    const Vector3<double> centre(0.1, -0.2, 0.3);
    const Free body(inertia(centre), {RotatingFrame<>{{0, 0, rate}}}, no_load());
    const Thrown truth{{moments, {0.3, -0.4, 2}, tilted}, {1, 2, 3}, {3, -2, 1}, centre, rate};
    const double end = rate > 10 ? 0.1 : 5;
    const Trial<Free> trial{fmt::format("guide turns with {:g} rad/s", rate),
                            body,
                            truth.at(0),
                            {.output_times = every(end / 5, end), .tolerance = 1e-9},
                            [&](double t) { return truth.at(t); },
                            rounding_of_angle * rate * end};
    attempt_all(out, trial, by_steps);
  }
}

/// The state's origin far from the centre of mass: the rounding error of the tensor about it.
void far_origins(const Recorder& out) {
  for (const double away : {1e1, 1e3, 1e5, 1e7, 1e9}) {
    const Vector3<double> centre(away, -away, away);
    const std::string what = fmt::format("O' {:g} m from the centre of mass", away);
    out.begin(what, "FreeBody");
    try {
      const Free body(inertia(centre), {RestingFrame<>{}}, no_load());
      const Thrown truth{{moments, {0.3, -0.4, 2}, tilted}, {1, 2, 3}, {3, -2, 1}, centre, 0};
      Trial<Free> trial{what,
                        body,
                        truth.at(0),
                        {.output_times = every(1, 5), .tolerance = 1e-9, .max_evaluations = 1e5},
                        [&](double t) { return truth.at(t); }};
      // Position and velocity of O' are rounded to 1e-16 relative at the start already. The digits
      // that the tensor about O' lacks were lost before the start.
      trial.truth_error = 4e-16 * away * away;
      trial.must_answer = away < 1e5;
      attempt_all(out, trial, {Method::automatic, Method::gauss16, Method::radau13});
    } catch (const kreisel::Error& error) {
      add_refusal(out, what, "FreeBody", error.what());
    }
  }
}

void far_places(const Recorder& out) {
  for (const double away : {1e6, 1e9, 1e12}) {
    const Free body(inertia({0, 0, 0}), {RestingFrame<>{}}, no_load());
    const Thrown truth{
        {moments, {0.3, -0.4, 2}, tilted}, {away, -away, away}, {3, -2, 1}, {0, 0, 0}, 0};
    Trial<Free> trial{fmt::format("{:g} m from the guide's origin", away),
                      body,
                      truth.at(0),
                      {.output_times = every(1, 5), .tolerance = 1e-9},
                      [&](double t) { return truth.at(t); }};
    attempt_all(out, trial, by_steps);
    // The same body, carried round there.
    const Free seen(inertia({0, 0, 0}), {RotatingFrame<>{{0, 0, 0.5}}}, no_load());
    const Thrown turned{truth.turning, truth.x0, truth.v, {0, 0, 0}, 0.5};
    const Trial<Free> round{fmt::format("{:g} m from the axis of a guide of 0.5 rad/s", away),
                            seen,
                            turned.at(0),
                            {.output_times = every(1, 5), .tolerance = 1e-8},
                            [&](double t) { return turned.at(t); }};
    attempt_all(out, round, {Method::automatic, Method::gauss16});
  }
}

void disappearing_mass(const Recorder& out) {
  for (const double mass : {1e-12, 1e-300, 1e12}) {
    const Free body(InertiaTensor<Body>::about_centre(mass, {0, 0, 0},
                                                      mass * moments.asDiagonal().toDenseMatrix()),
                    {RotatingFrame<>{{0, 0, 1}}}, no_load());
    const Thrown truth{{moments, {0.3, -0.4, 2}, tilted}, {1, 2, 3}, {3, -2, 1}, {0, 0, 0}, 1};
    const Trial<Free> trial{fmt::format("{:g} kg", mass),
                            body,
                            truth.at(0),
                            {.output_times = every(1, 5), .tolerance = 1e-9},
                            [&](double t) { return truth.at(t); }};
    attempt_all(out, trial, {Method::automatic, Method::radau13});
  }
  const auto needle = Vector3<double>(0, 1, 1).asDiagonal().toDenseMatrix();
  expect_refusal(out, "needle", "FreeBody",
                 [&] {
                   Free(InertiaTensor<Body>::about_centre(1, {0, 0, 0}, needle), {RestingFrame<>{}},
                        no_load());
                 },
                 {"needle"});
  expect_refusal(out, "point", "FreeBody",
                 [&] {
                   Free(InertiaTensor<Body>::about_centre(1, {0, 0, 0}, 0 * needle),
                        {RestingFrame<>{}}, no_load());
                 },
                 {"point"});
  expect_refusal(out, "no mass", "FreeBody", [&] { Free({}, {RestingFrame<>{}}, no_load()); },
                 {"mass"});
}

}  // namespace

void free_bodies(std::vector<Case>& cases) {
  cases.push_back({"thrown", "a thrown body on guides that turn with 0 to 1e3 rad/s", &thrown});
  cases.push_back({"far-origins", "reference point of the body up to 1e9 m off", &far_origins});
  cases.push_back({"far-places", "a body up to 1e12 m away", &far_places});
  cases.push_back(
      {"masses", "masses from 1e-300 to 1e12 kg, needles and points", &disappearing_mass});
}

}  // namespace stability
