// NaN, infinities and nonsense at every input of every scene.

#include <fmt/core.h>

#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>

#include <dynamics/exact/free_top.hpp>
#include <dynamics/exact/gyrostat.hpp>
#include <dynamics/exact/lagrange_top.hpp>
#include <dynamics/exact/pendulum_motion.hpp>
#include <dynamics/gimbal/cardan_gyro.hpp>
#include <dynamics/guide/resting.hpp>
#include <dynamics/guide/rotating.hpp>
#include <dynamics/pendulum/pendulum_deviation.hpp>
#include <dynamics/rigid/axisymmetric_body.hpp>
#include <dynamics/rigid/fixed_point_body.hpp>
#include <dynamics/rigid/free_body.hpp>
#include <dynamics/tree/body_system.hpp>

#include "top_trial.hpp"

namespace stability {

namespace {

using namespace kreisel;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double inf = std::numeric_limits<double>::infinity();
constexpr std::array<double, 3> no_numbers = {nan, inf, -inf};

/// One input number with its name, and the call that uses it.
struct Input {
  const char* name;
  std::function<void(double)> with;
};

void each(const Recorder& out, const std::string& scene, const std::vector<Input>& inputs) {
  for (const Input& input : inputs) {
    for (const double x : no_numbers) {
      expect_refusal(out, fmt::format("{} = {}", input.name, x), scene, [&] { input.with(x); });
    }
  }
}

using Held = FixedPointBody<RestingFrame<>, UniformGravity<Guide>>;
using Free = FreeBody<RestingFrame<>, UniformGravity<Guide>>;

Inertia<double> inertia() { return {2, {0.1, 0.2, 0.3}, {3, 3, 3, 0, 0, 0}}; }

template <class Scene>
Scene with(const std::function<void(Inertia<double>&)>& spoil) {
  InertiaTensor<Body> T{inertia()};
  spoil(T.value);
  if constexpr (std::is_same_v<Scene, Held>) {
    return Scene(T, {0, 0, 0}, {}, {{0, 0, -9.81}});
  } else {
    return Scene(T, {}, {{0, 0, -9.81}});
  }
}

template <class Scene>
void bodies(const Recorder& out, const std::string& name) {
  each(out, name,
       {{"mass", [](double x) { with<Scene>([x](auto& T) { T.mass = x; }); }},
        {"first moment", [](double x) { with<Scene>([x](auto& T) { T.first_moment.y() = x; }); }},
        {"moment", [](double x) { with<Scene>([x](auto& T) { T.tensor.yy = x; }); }},
        {"product", [](double x) { with<Scene>([x](auto& T) { T.tensor.xz = x; }); }}});
  expect_refusal(out, "mass = -1", name, [] { with<Scene>([](auto& T) { T.mass = -1; }); });
  expect_refusal(out, "moment = -1", name, [] { with<Scene>([](auto& T) { T.tensor.zz = -1; }); });
  expect_refusal(out, "triangle inequality", name,
                 [] { with<Scene>([](auto& T) { T.tensor.zz = 9; }); }, {"triangle"});
}

void scenes(const Recorder& out) {
  each(out, "EulerTop",
       {{"moment",
         [](double x) {
           EulerTop({1, x, 1});
         }},
        {"weight moment",
         [](double x) {
           EulerTop({1, 1, 1}, {0, x, 0});
         }},
        {"rotor momentum", [](double x) {
           EulerTop({1, 1, 1}, {0, 0, 0}, {0, 0, x});
         }}});
  bodies<Held>(out, "FixedPointBody");
  bodies<Free>(out, "FreeBody");
  each(out, "FixedPointBody", {{"point", [](double x) {
                                  Held({inertia()}, {0, x, 0}, {}, {{0, 0, -9.81}});
                                }}});
  using Axial = AxisymmetricBody<RestingFrame<>>;
  each(out, "AxisymmetricBody",
       {{"mass",
         [](double x) {
           Axial(x, 0, 1, 1, {0, 0, 0}, {});
         }},
        {"arm",
         [](double x) {
           Axial(1, x, 1, 1, {0, 0, 0}, {});
         }},
        {"A",
         [](double x) {
           Axial(1, 0, x, 1, {0, 0, 0}, {});
         }},
        {"C",
         [](double x) {
           Axial(1, 0, 1, x, {0, 0, 0}, {});
         }},
        {"point", [](double x) {
           Axial(1, 0, 1, 1, {x, 0, 0}, {});
         }}});
  using Gyro = CardanGyro<RestingFrame<>>;
  const Vector3<double> one(1, 1, 1);
  each(out, "CardanGyro",
       {{"rotor",
         [&](double x) {
           Gyro({{1, x, 1}}, {}, {});
         }},
        {"inner ring",
         [&](double x) {
           Gyro({one, {1, 1, x}}, {}, {});
         }},
        {"outer ring",
         [&](double x) {
           Gyro({one, one, {x, 1, 1}}, {}, {});
         }},
        {"stiffness",
         [&](double x) {
           Gyro({one, one, one}, {{x, 0, 0}, {}}, {});
         }},
        {"damping",
         [&](double x) {
           Gyro({one, one, one}, {{}, {0, x, 0}}, {});
         }},
        {"reference",
         [&](double x) {
           Gyro({one, one, one}, {{}, {0, 0, x}}, {});
         }},
        {"friction",
         [&](double x) {
           Gyro({one, one, one}, {}, {}, {x});
         }},
        {"drive", [&](double x) {
           CardanGyro<RestingFrame<>, DrivenRotor<double>>({one, one, one}, {}, {}, {x});
         }}});
  const auto system = [](const std::function<void(BodyDescription&)>& spoil) {
    BodyDescription body{.name = "arm",
                         .joint = {.kind = JointKind::revolute, .axis = {0, 0, 1}},
                         .inertia = {inertia()},
                         .forces = {{1, 0, 0.1, 0}}};
    spoil(body);
    BodySystem<RestingFrame<>>({}, {body});
  };
  each(out, "BodySystem",
       {{"mass", [&](double x) { system([x](auto& b) { b.inertia.value.mass = x; }); }},
        {"moment", [&](double x) { system([x](auto& b) { b.inertia.value.tensor.xx = x; }); }},
        {"axis", [&](double x) { system([x](auto& b) { b.joint.axis.x() = x; }); }},
        {"position", [&](double x) { system([x](auto& b) { b.joint.position.x() = x; }); }},
        {"orientation", [&](double x) { system([x](auto& b) { b.joint.orientation.x() = x; }); }},
        {"stiffness", [&](double x) { system([x](auto& b) { b.forces[0].stiffness = x; }); }},
        {"rest", [&](double x) { system([x](auto& b) { b.forces[0].rest = x; }); }},
        {"damping", [&](double x) { system([x](auto& b) { b.forces[0].damping = x; }); }},
        {"constant", [&](double x) { system([x](auto& b) { b.forces[0].constant = x; }); }},
        {"gravity", [](double x) {
           BodySystem<RestingFrame<>>({}, {}, UniformGravity<Guide>{{x, 0, 0}});
         }}});
  expect_refusal(out, "axis of zeros", "BodySystem",
                 [&] { system([](auto& b) { b.joint.axis.setZero(); }); });
  expect_refusal(out, "orientation of zeros", "BodySystem",
                 [&] { system([](auto& b) { b.joint.orientation.coeffs().setZero(); }); });
  each(
      out, "check(PendulumBody)",
      {{"mass", [](double x) { check(PendulumBody<>{.mass = x, .theta_b = 1, .theta_c = 1}); }},
       {"arm", [](double x) { check(PendulumBody<>{.arm = x, .theta_b = 1, .theta_c = 1}); }},
       {"theta_a", [](double x) { check(PendulumBody<>{.theta_a = x, .theta_c = 1}); }},
       {"theta_c", [](double x) { check(PendulumBody<>{.theta_b = 1, .theta_c = x}); }},
       {"phi_c", [](double x) { check(PendulumBody<>{.theta_b = 1, .theta_c = 1, .phi_c = x}); }}});
}

void closed_forms(const Recorder& out) {
  const Eigen::Quaterniond q = Eigen::Quaterniond::Identity();
  const auto spoiled = [&](double x) { return Eigen::Quaterniond(1, x, 0, 0); };
  const exact::FreeTop good({1, 2, 3}, {1, 2, 3}, q);
  each(out, "exact::FreeTop",
       {{"moment",
         [&](double x) {
           exact::FreeTop({1, x, 3}, {1, 2, 3}, q);
         }},
        {"rate",
         [&](double x) {
           exact::FreeTop({1, 2, 3}, {1, x, 3}, q);
         }},
        {"attitude",
         [&](double x) {
           exact::FreeTop({1, 2, 3}, {1, 2, 3}, spoiled(x));
         }},
        {"time", [&](double x) { (void)good.at(x); }}});
  const exact::LagrangeTop heavy(1, 2, 1, {1, 2, 3}, q);
  each(out, "exact::LagrangeTop",
       {{"A",
         [&](double x) {
           exact::LagrangeTop(x, 1, 1, {1, 2, 3}, q);
         }},
        {"C",
         [&](double x) {
           exact::LagrangeTop(1, x, 1, {1, 2, 3}, q);
         }},
        {"weight",
         [&](double x) {
           exact::LagrangeTop(1, 1, x, {1, 2, 3}, q);
         }},
        {"rate",
         [&](double x) {
           exact::LagrangeTop(1, 1, 1, {1, x, 3}, q);
         }},
        {"attitude",
         [&](double x) {
           exact::LagrangeTop(1, 1, 1, {1, 2, 3}, spoiled(x));
         }},
        {"time", [&](double x) { (void)heavy.at(x); }}});
  each(out, "exact::Gyrostat",
       {{"moment",
         [&](double x) {
           exact::Gyrostat({1, 2, x}, {0, 0, 1}, {1, 2, 3}, q);
         }},
        {"rotor",
         [&](double x) {
           exact::Gyrostat({1, 2, 3}, {0, 0, x}, {1, 2, 3}, q);
         }},
        {"rate", [&](double x) {
           exact::Gyrostat({1, 2, 3}, {0, 0, 1}, {1, 2, x}, q);
         }}});
  each(out, "exact::PendulumMotion",
       {{"k", [](double x) { exact::PendulumMotion(x, 1, 0); }},
        {"angle", [](double x) { exact::PendulumMotion(1, x, 0); }},
        {"rate", [](double x) { exact::PendulumMotion(1, 1, x); }}});
}

/// A run refuses, or reports its failure.
void tasks(const Recorder& out) {
  const EulerTop top({1, 2, 3}, {0.1, 0, 1});
  const EulerTop::State start{Eigen::Quaterniond::Identity(), {1, 2, 3}};
  const auto solve_with = [&](const std::function<void(SolveOptions&, EulerTop::State&)>& spoil) {
    SolveOptions options{.output_times = {0.1, 0.2}, .max_evaluations = 1e5};
    EulerTop::State state = start;
    spoil(options, state);
    const auto found = solve(top, state, options);
    if (found.report.status == RunStatus::failed) throw ComputationFailed(found.report.message);
  };
  for (const Method method :
       {Method::automatic, Method::verner98, Method::gauss16, Method::radau13}) {
    std::vector<Input> inputs{
        {"begin",
         [&](double x) { solve_with([&](auto& t, auto&) { t.method = method, t.begin = x; }); }},
        {"time",
         [&](double x) {
           solve_with([&](auto& t, auto&) { t.method = method, t.output_times[0] = x; });
         }},
        {"end",
         [&](double x) {
           solve_with([&](auto& t, auto&) { t.method = method, t.output_times[1] = x; });
         }},
        {"tolerance",
         [&](double x) {
           solve_with([&](auto& t, auto&) { t.method = method, t.tolerance = x; });
         }},
        {"smallest",
         [&](double x) {
           solve_with([&](auto& t, auto&) { t.method = method, t.absolute_scale = x; });
         }},
        {"attitude",
         [&](double x) {
           solve_with([&](auto& t, auto& s) { t.method = method, s.attitude.x() = x; });
         }},
        {"rate", [&](double x) {
           solve_with([&](auto& t, auto& s) { t.method = method, s.angular_velocity.x() = x; });
         }}};
    if (method != Method::gauss16) {
      inputs.push_back({"jump", [&](double x) {
                          solve_with(
                              [&](auto& t, auto&) { t.method = method, t.discontinuities = {x}; });
                        }});
    }
    each(out, name(method), inputs);
  }
  for (const double tolerance : {0.0, -1e-9, 1e-16, 0.1}) {
    expect_refusal(out, fmt::format("tolerance = {:g}", tolerance), "solve",
                   [&] { solve_with([&](auto& t, auto&) { t.tolerance = tolerance; }); });
  }
  expect_refusal(out, "no times", "solve",
                 [&] { solve_with([&](auto& t, auto&) { t.output_times.clear(); }); });
  expect_refusal(out, "times that turn round", "solve", [&] {
    solve_with([&](auto& t, auto&) { t.output_times = {1, 0.5}; });
  });
  for (const double budget : {0.0, -1.0, nan}) {
    expect_refusal(out, fmt::format("max_evaluations = {:g}", budget), "solve",
                   [&] { solve_with([&](auto& t, auto&) { t.max_evaluations = budget; }); });
  }
}

}  // namespace

void inputs(std::vector<Case>& cases) {
  cases.push_back(
      {"inputs-of-scenes", "NaN and infinities at every input of every scene", &scenes});
  cases.push_back(
      {"inputs-of-closed-forms", "NaN and infinities at the closed forms", &closed_forms});
  cases.push_back({"inputs-of-tasks", "NaN and infinities in the options of solve()", &tasks});
}

}  // namespace stability
