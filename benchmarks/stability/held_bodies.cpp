// Fixed-point bodies on guides with extreme motions, by FixedPointBody.

#include <Eigen/LU>
#include <fmt/core.h>

#include <cmath>
#include <cstddef>

#include <dynamics/exact/free_top.hpp>
#include <dynamics/exact/lagrange_top.hpp>
#include <dynamics/guide/resting.hpp>
#include <dynamics/guide/rotating.hpp>
#include <dynamics/rigid/fixed_point_body.hpp>
#include <dynamics/step/explicit.hpp>

#include "any.hpp"
#include "trial.hpp"

namespace stability {

namespace {

using namespace kreisel;
using Held = FixedPointBody<AnyGuide, AnyLoad>;
using State = Held::State;

const Eigen::Quaterniond tilted(std::cos(0.25), std::sin(0.25), 0, 0);

constexpr Methods by_steps = {Method::automatic, Method::verner98, Method::gauss16,
                              Method::radau13};

Matrix3<double> diagonal(double a, double b, double c) {
  return Vector3<double>(a, b, c).asDiagonal();
}

Eigen::Quaterniond about(const Vector3<double>& v, double t) {
  const double rate = v.stableNorm();
  const double half = rate * t / 2;
  if (half == 0) return Eigen::Quaterniond::Identity();
  const Vector3<double> along = v / rate * std::sin(half);
  return {std::cos(half), along.x(), along.y(), along.z()};
}

/// A free top seen from a guide: attitude and rate against the guide, from its own ones. The guide
/// is rotated by `turn` and turns with u.
State seen(const exact::TopMotion& m, const Eigen::Quaterniond& turn, const Vector3<double>& u) {
  const Eigen::Quaterniond q = turn.conjugate() * m.attitude;
  return {q, m.angular_velocity - q.conjugate() * u};
}

/// Without torque the motion of the guide has no effect.
void turning_guides(const Recorder& out) {
  for (const double rate : {0.0, 1e-320, 1e-300, 1e-170, 1e-12, 7.292115e-5, 1.0, 1e3}) {
    if (out.quick() && (rate == 1e-300 || rate == 1e-12)) continue;
    const Vector3<double> u = rate * Vector3<double>(0.6, 0, 0.8);
    const RotatingFrame<> guide{u};
    const Held body(InertiaTensor<Body>::about_origin(1, {0, 0, 0}, diagonal(1, 2, 2.5)), {0, 0, 0},
                    {guide}, no_load());
    const Vector3<double> w(0.3, -0.4, 2);
    const exact::FreeTop motion({1, 2, 2.5}, w, tilted);
    const double end = rate > 10 ? 0.1 : 10;
    const Trial<Held> trial{fmt::format("guide turns with {:g} rad/s", rate),
                            body,
                            seen(motion.at(0), Eigen::Quaterniond::Identity(), u),
                            {.output_times = every(end / 10, end), .tolerance = 1e-9},
                            [&](double t) { return seen(motion.at(t), about(u, t), u); },
                            rounding_of_angle * rate * end};
    attempt_all(out, trial, by_steps);
  }
}

/// A turntable about the vertical does not change the weight.
void turntables(const Recorder& out) {
  for (const double rate : {1e-320, 1.0, 1e3}) {
    const Vector3<double> u(0, 0, rate);
    const Held body(InertiaTensor<Body>::about_origin(1, {0, 0, 0.5}, diagonal(1, 1, 0.6)),
                    {0, 0, 0}, {RotatingFrame<>{u}}, {UniformGravity<Inertial>{{0, 0, -9.81}}});
    const Vector3<double> w(0.3, -0.4, 8);
    const exact::LagrangeTop motion(1, 0.6, 0.5 * 9.81, w, tilted);
    const double end = rate > 10 ? 0.1 : 2;
    const Trial<Held> trial{fmt::format("turntable of {:g} rad/s", rate),
                            body,
                            seen(motion.at(0), Eigen::Quaterniond::Identity(), u),
                            {.output_times = every(end / 10, end), .tolerance = 1e-9},
                            [&](double t) { return seen(motion.at(t), about(u, t), u); },
                            rounding_of_angle * rate * end};
    attempt_all(out, trial, by_steps);
  }
}

/// A guide whose rate jumps from 0 to 20 rad/s at t = 0.7314: the body keeps its own rate.
void jumps_of_the_rate(const Recorder& out) {
  const double jump = 0.7314;
  const Vector3<double> u(0, 0, 20);
  // Seen from the guide the body's rate jumps: one run to the jump, another from there.
  const AnyGuide guide{[=](double t) {
    RotatingFrame<> turning{u};
    if (t < jump) return FrameMotion<Guide, Inertial>{};
    return turning(t - jump);
  }};
  const Held body(InertiaTensor<Body>::about_origin(1, {0, 0, 0}, diagonal(1, 2, 2.5)), {0, 0, 0},
                  guide, no_load());
  const Vector3<double> w(0.3, -0.4, 2);
  const exact::FreeTop motion({1, 2, 2.5}, w, tilted);
  const Trial<Held> trial{"a run from just behind the jump",
                          body,
                          seen(motion.at(jump), Eigen::Quaterniond::Identity(), u),
                          {.begin = jump, .output_times = every(0.2, 2, jump), .tolerance = 1e-9},
                          [&](double t) { return seen(motion.at(t), about(u, t - jump), u); }};
  attempt_all(out, trial, by_steps);
}

/// The guide is jerked: 9.81 m/s^2 more from t = 0.7314 on, so Lagrange's top weighs twice as much.
void jumps_of_the_acceleration(const Recorder& out) {
  const double jump = 0.7314;
  const AnyGuide guide{[=](double t) {
    FrameMotion<Guide, Inertial> m;
    if (t >= jump) m.dV.value.moment = {0, 0, 9.81};  // position and velocity do not matter here
    return m;
  }};
  const Held body(InertiaTensor<Body>::about_origin(1, {0, 0, 0.5}, diagonal(1, 1, 0.6)), {0, 0, 0},
                  guide, {UniformGravity<Inertial>{{0, 0, -9.81}}});
  const Vector3<double> w(0.3, -0.4, 8);
  const exact::LagrangeTop before(1, 0.6, 0.5 * 9.81, w, tilted);
  const exact::TopMotion middle = before.at(jump);
  const exact::LagrangeTop after(1, 0.6, 0.5 * 2 * 9.81, middle.angular_velocity, middle.attitude);
  Trial<Held> trial{"declared",
                    body,
                    {tilted, w},
                    {.output_times = every(0.2, 2), .discontinuities = {jump}, .tolerance = 1e-9},
                    [&](double t) {
                      const exact::TopMotion m = t < jump ? before.at(t) : after.at(t - jump);
                      return State{m.attitude, m.angular_velocity};
                    }};
  const Row declared = attempt(out, trial, Method::automatic);
  attempt_all(out, trial, {Method::verner98, Method::radau13});
  trial.variant = "not declared";
  trial.options.discontinuities.clear();
  attempt_all(out, trial, by_steps);
  trial.variant = "no jump";
  trial.options.output_times = every(0.07, 0.7);
  trial.options.begin = 0;
  const Row smooth = attempt(out, trial, Method::verner98);
  expect_below(out, "evaluations per second, declared over smooth", "verner98",
               declared.evaluations / 2 / (smooth.evaluations / 0.7), 2.1,
               "the top weighs twice as much behind the jump");
}

/// A pulse of a thousandth of a second within a hundred seconds.
void pulse(const Recorder& out) {
  const double begin = 41.0371;
  const double end = begin + 1e-3;
  const AnyLoad kick{[=](const LoadContext<>& s) {
    const bool on = s.t >= begin && s.t < end;
    return Force<Body>{{{0, 0, 0}, {0, 0, on ? 1e3 : 0.0}}};
  }};
  const Held body(InertiaTensor<Body>::about_origin(1, {0, 0, 0}, diagonal(1, 1, 1)), {0, 0, 0},
                  {RestingFrame<>{}}, kick);
  const auto truth = [=](double t) {
    const double on = std::min(std::max(t - begin, 0.0), end - begin);
    const double rate = 1 + 1e3 * on;
    const double angle = t + 0.5e3 * on * on + (t > end ? (t - end) * 1e3 * on : 0);
    return State{{std::cos(angle / 2), 0, 0, std::sin(angle / 2)}, {0, 0, rate}};
  };
  Trial<Held> trial{
      "declared",
      body,
      {Eigen::Quaterniond::Identity(), {0, 0, 1}},
      {.output_times = every(10, 100), .discontinuities = {begin, end}, .tolerance = 1e-9},
      truth};
  // The times of the jumps are known only to an ulp, in which the torque is 1e3.
  trial.truth_error = 2e3 * 60 * 7e-15;
  attempt_all(out, trial, {Method::automatic, Method::verner98, Method::radau13});
}

/// Guides far away and fixed points far from the guide's origin.
void far_guides(const Recorder& out) {
  const Vector3<double> w(0.3, -0.4, 8);
  const exact::LagrangeTop motion(1, 0.6, 0.5 * 9.81, w, tilted);
  for (const double away : {1e3, 1e6, 1e9}) {
    RestingFrame<> far_guide;
    far_guide.X.value.translation = {away, -away, away};
    const auto inertia = InertiaTensor<Body>::about_origin(1, {0, 0, 0.5}, diagonal(1, 1, 0.6));
    const AnyLoad weight{UniformGravity<Inertial>{{0, 0, -9.81}}};
    const Held guide_away(inertia, {0, 0, 0}, {far_guide}, weight);
    const Held point_away(inertia, {away, away, -away}, {RestingFrame<>{}}, weight);
    for (const auto* body : {&guide_away, &point_away}) {
      const Trial<Held> trial{
          fmt::format("{} is {:g} m away", body == &guide_away ? "the guide" : "the fixed point",
                      away),
          *body,
          {tilted, w},
          {.output_times = every(0.2, 2), .tolerance = 1e-9},
          [&](double t) {
            const exact::TopMotion m = motion.at(t);
            return State{m.attitude, m.angular_velocity};
          }};
      attempt_all(out, trial, {Method::automatic, Method::verner98, Method::gauss16});
    }
    // On a guide that turns, the distant fixed point moves in a circle with u^2 r. A body whose
    // mass is in the fixed point is not affected.
    const Vector3<double> u(0, 0, 0.5);
    const Held carried(InertiaTensor<Body>::about_origin(1, {0, 0, 0}, diagonal(1, 2, 2.5)),
                       {away, away, -away}, {RotatingFrame<>{u}}, no_load());
    const exact::FreeTop free({1, 2, 2.5}, w, tilted);
    const Trial<Held> trial{fmt::format("carried round {:g} m away", away),
                            carried,
                            seen(free.at(0), Eigen::Quaterniond::Identity(), u),
                            {.output_times = every(0.2, 2), .tolerance = 1e-9},
                            [&](double t) { return seen(free.at(t), about(u, t), u); }};
    attempt_all(out, trial, {Method::automatic, Method::gauss16});
  }
}

/// A free body with any tensor, in 64 bits.
State in_long_double(const Matrix3<double>& tensor, const State& start, double end) {
  using Real = long double;
  using LongVector = Eigen::Matrix<Real, 7, 1>;
  const Matrix3<Real> Theta = tensor.cast<Real>();
  const Matrix3<Real> inverse = Theta.inverse();
  const auto field = [&](const Real&, const LongVector& y) {
    const Vector3<Real> w = y.tail<3>();
    const Eigen::Quaternion<Real> q(y[3], y[0], y[1], y[2]);
    LongVector rate;
    rate << (q * Eigen::Quaternion<Real>(0, w.x() / 2, w.y() / 2, w.z() / 2)).coeffs(),
        inverse * Vector3<Real>(Theta * w).cross(w);
    return rate;
  };
  ExplicitRungeKutta<LongVector, decltype(field)> steps(
      field, 0.0L, Held::to_vector(start).cast<Real>(), {.relative = 1e-16, .max_evaluations = 1e6},
      Held::blocks);
  return Held::from_vector(steps.advance_to(end).cast<double>());
}

/// Nearly singular tensors, on axes that are not principal. The truth uses them as the doubles that
/// they are.
void nearly_singular(const Recorder& out) {
  for (const double least : {1e-2, 1e-4, 1e-6, 1e-8, 1e-10, 1e-12, 1e-15}) {
    const Eigen::Quaterniond turn = Eigen::Quaterniond(0.7, 0.3, -0.5, 0.4).normalized();
    const Matrix3<double> R = turn.toRotationMatrix();
    Matrix3<double> tensor = R * diagonal(1, 1 + least / 2, least) * R.transpose();
    tensor = (tensor + tensor.transpose().eval()) / 2;
    const State start{tilted, R * Vector3<double>(0.3, -0.4, 2)};
    const std::string what = fmt::format("least moment {:g} of the greatest", least);
    try {
      const Held body(InertiaTensor<Body>::about_origin(1, {0, 0, 0}, tensor), {0, 0, 0},
                      {RestingFrame<>{}}, no_load());
      Trial<Held> trial{what,
                        body,
                        start,
                        {.output_times = every(0.2, 2), .tolerance = 1e-9, .max_evaluations = 1e5},
                        [&](double t) { return in_long_double(tensor, start, t); }};
      trial.truth_error = 1e-15 + 1e-18 / least;
      trial.must_answer = least >= 1e-8;
      attempt_all(out, trial, {Method::automatic, Method::gauss16, Method::radau13});
    } catch (const kreisel::Error& error) {
      add_refusal(out, what, "FixedPointBody", error.what());
    }
  }
}

/// Springs and dampers on a fixed-point body, from soft to 1e12 N m/rad: about z, in closed form.
void stiff_springs(const Recorder& out) {
  double evaluations = 0;
  for (const double stiffness : {1e3, 1e6, 1e9, 1e12}) {
    const double damping = 3e-3 * stiffness;
    const AnyLoad spring{[=](const LoadContext<>& s) {
      const Matrix3<double>& R = s.X.value.rotation;
      const double angle = std::atan2(R(1, 0), R(0, 0));
      return Force<Body>{
          {{0, 0, 0}, {0, 0, -stiffness * angle - damping * s.V_rel.value.resultant.z() + 1}}};
    }};
    const Held body(InertiaTensor<Body>::about_origin(1, {0, 0, 0}, diagonal(1, 1, 1)), {0, 0, 0},
                    {RestingFrame<>{}}, spring);
    // z'' + d z' + k (z - 1/k) = 0: overdamped from 2 N m s/rad on.
    const double root = std::sqrt(std::max(0.0, damping * damping / 4 - stiffness));
    const double fast = damping / 2 + root;
    const double slow = stiffness / fast;
    const double rest = 1 / stiffness;
    const bool over = root > 0;
    const double beat = std::sqrt(std::max(0.0, stiffness - damping * damping / 4));
    const auto truth = [=](double t) {
      const double z0 = -rest + 0.3;
      double z = 0;
      double dz = 0;
      if (over) {
        const double a = z0 * fast / (fast - slow);
        const double b = -z0 * slow / (fast - slow);
        z = a * std::exp(-slow * t) + b * std::exp(-fast * t);
        dz = -a * slow * std::exp(-slow * t) - b * fast * std::exp(-fast * t);
      } else {
        const double d = damping / 2;
        z = std::exp(-d * t) * z0 * (std::cos(beat * t) + d / beat * std::sin(beat * t));
        dz = -std::exp(-d * t) * z0 * stiffness / beat * std::sin(beat * t);
      }
      z += rest;
      return State{{std::cos(z / 2), 0, 0, std::sin(z / 2)}, {0, 0, dz}};
    };
    // The load's angle is rounded to 1e-16, and the spring makes a torque of 1e-16 k of it.
    const Trial<Held> trial{
        fmt::format("{:g} N m/rad, damped", stiffness),
        body,
        {{std::cos(0.15), 0, 0, std::sin(0.15)}, {0, 0, 0}},
        {.output_times = every(0.001, 0.02), .tolerance = 1e-8, .max_evaluations = 1e6},
        truth};
    const Row row = attempt(out, trial, Method::automatic);
    attempt(out, trial, Method::radau13);
    if (stiffness == 1e6) evaluations = row.evaluations;
    if (stiffness > 1e6) {
      expect_below(out, fmt::format("cost at {:g} over that at 1e6 N m/rad", stiffness),
                   "automatic", row.evaluations / evaluations, 1.5);
    }
  }
}

}  // namespace

void held_bodies(std::vector<Case>& cases) {
  cases.push_back(
      {"guide-rates", "guides that turn with 0, denormal and 1e3 rad/s", &turning_guides});
  cases.push_back({"turntables", "weight on turntables to 1e3 rad/s", &turntables});
  cases.push_back({"rate-jumps", "the guide's rate jumps", &jumps_of_the_rate});
  cases.push_back(
      {"acceleration-jumps", "the guide's acceleration jumps", &jumps_of_the_acceleration});
  cases.push_back({"pulse", "a torque of 1e-3 s in 100 s", &pulse});
  cases.push_back({"far-guides", "reference points 1e9 m away", &far_guides});
  cases.push_back({"nearly-singular", "tensors singular but for 1e-2 to 1e-15", &nearly_singular});
  cases.push_back(
      {"stiff-springs", "damped springs to 1e12 N m/rad on a fixed-point body", &stiff_springs});
}

}  // namespace stability
