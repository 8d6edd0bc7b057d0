// Trees of bodies: masses of very different size, bodies without mass, coinciding axes, stiff
// joints.

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include <dynamics/exact/pendulum_motion.hpp>
#include <dynamics/guide/resting.hpp>
#include <dynamics/tree/body_system.hpp>

#include "platform.hpp"
#include "trial.hpp"
#include <tests/support/worst.hpp>

namespace stability {

namespace {

using namespace kreisel;
using System = BodySystem<RestingFrame<>>;
using State = System::State;

/// A point of mass m at the end of a rod of length l in a joint about y below `parent`.
BodyDescription bob(const std::string& name, const std::string& parent, double mass, double length,
                    double above = 0) {
  return {
      .name = name,
      .parent = parent,
      .joint = {.kind = JointKind::revolute, .axis = {0, 1, 0}, .position = {0, 0, -above}},
      .inertia = InertiaTensor<Body>::about_centre(mass, {0, 0, -length}, Matrix3<double>::Zero())};
}

const UniformGravity<Guide> gravity{{0, 0, -9.81}};

/// A pendulum whose bob carries another of nearly no mass. The light one must not affect the heavy
/// one.
void mass_ratios(const Recorder& out) {
  const exact::PendulumMotion motion(9.81, 0.5, 0);
  for (const double mass : {1e-6, 1e-9, 1e-12, 1e-15}) {
    const System system({}, {bob("heavy", "guide", 1, 1), bob("light", "heavy", mass, 0.3, 1)},
                        gravity);
    State start = system.rest();
    start.coordinates << 0.5, 0.2;
    const std::string what = fmt::format("a bob of {:g} on one of 1 kg", mass);
    out.begin(what, "verner98");
    const auto run = solve(system, start, {.output_times = every(0.5, 5), .tolerance = 1e-9});
    double worst = 0;
    for (std::size_t i = 0; i < run.times.size(); ++i) {
      worst = test::worst_of(
          worst, std::abs(run.states[i].coordinates[0] - motion.at(run.times[i]).angle));
    }
    const bool done = run.report.status == RunStatus::complete;
    // The effect of the light one on the heavy one is of the order of its mass.
    expect_below(out, what, "verner98", done ? worst : double(NAN),
                 run.report.error_estimate + 50 * mass, run.report.message);
  }
}

void heavy_end(const Recorder& out) {
  // A heavy bob on a light one: in the limit two rods in line are one pendulum of their total
  // length.
  for (const double mass : {1e3, 1e6, 1e9}) {
    const System system(
        {}, {bob("light", "guide", 1e-3, 0.5), bob("heavy", "light", mass, 0.5, 0.5)}, gravity);
    State start = system.rest();
    start.coordinates << 0.3, 0;
    const std::string what = fmt::format("{:g} kg on 1e-3 kg", mass);
    out.begin(what, "verner98");
    const auto a =
        solve(system, start, {.output_times = {0.2}, .tolerance = 1e-6, .max_evaluations = 1e6});
    const auto b =
        solve(system, start, {.output_times = {0.2}, .tolerance = 1e-9, .max_evaluations = 1e6});
    if (a.states.empty() || b.states.empty()) {
      add_refusal(out, what, "verner98", a.report.message);
      continue;
    }
    kreisel::ErrorMeasure<System> distance(system, 1e-3);
    expect_below(out, what, "verner98",
                 distance(System::to_vector(a.states[0]), System::to_vector(b.states[0])),
                 a.report.error_estimate + b.report.error_estimate, "against a run at 1e-9");
  }
}

void singular_trees(const Recorder& out) {
  const auto rates = [](const System& system, const State& state) {
    (void)system.rates(0, System::to_vector(state));
  };
  BodyDescription massless{.name = "ghost",
                           .parent = "guide",
                           .joint = {.kind = JointKind::revolute, .axis = {0, 1, 0}}};
  expect_refusal(out, "an end body without mass", "BodySystem",
                 [&] {
                   const System system({}, {massless}, gravity);
                   rates(system, system.rest());
                 },
                 {"ghost"});
  // A body without mass in the middle is legal, because its child has mass.
  {
    const System system({}, {massless, bob("bob", "ghost", 1, 1)}, gravity);
    State start = system.rest();
    start.coordinates << 0.2, 0.3;
    expect_refusal(out, "two joints of one axis through one point, nothing between", "BodySystem",
                   [&] { rates(system, start); });
  }
  {
    BodyDescription crossed = massless;
    crossed.joint.axis = {1, 0, 0};
    const System system({}, {crossed, bob("bob", "ghost", 1, 1)}, gravity);
    State start = system.rest();
    start.coordinates << 0.2, 0.3;
    out.begin("a ring without mass", "BodySystem");
    const Eigen::VectorXd rate = system.rates(0, System::to_vector(start));
    // A point on a sphere:
    //   alpha'' = -g sin(alpha)/(l cos(beta)),  beta'' = -g cos(alpha) sin(beta)/l
    const double alpha = -9.81 * std::sin(0.2) / std::cos(0.3);
    const double beta = -9.81 * std::cos(0.2) * std::sin(0.3);
    expect_below(out, "a ring without mass", "BodySystem",
                 test::worst_of(std::abs(rate[2] - alpha), std::abs(rate[3] - beta)), 1e-13);
    start.coordinates << 0.2, std::acos(-1.0) / 2;
    expect_refusal(out, "a ring without mass at gimbal lock", "BodySystem",
                   [&] { rates(system, start); });
  }
  // A system without degrees of freedom.
  {
    const System system({}, {}, gravity);
    out.begin("no bodies", "BodySystem");
    const auto run = solve(system, system.rest(), {.output_times = {1.0}});
    expect_below(out, "no bodies", "verner98", double(run.states.size() == 1 ? 0 : 1), 0.5,
                 run.report.message);
  }
  {
    BodyDescription fixed = bob("block", "guide", 1, 1);
    fixed.joint.kind = JointKind::fixed;
    const System system({}, {fixed}, gravity);
    out.begin("a body that cannot move", "BodySystem");
    const auto run = solve(system, system.rest(), {.output_times = {1.0}});
    expect_below(out, "a body that cannot move", "verner98", double(run.states.size() == 1 ? 0 : 1),
                 0.5, run.report.message);
  }
}

/// The difference of a pendulum with a stiff joint from one with a locked joint: 1/k.
void rigid_limit(const Recorder& out) {
  const auto swing = [&](double stiffness) {
    std::vector<BodyDescription> bodies{bob("upper", "guide", 1, 1),
                                        bob("lower", "upper", 0.5, 1, 1)};
    if (stiffness == 0) {
      bodies[1].rule = JointRule::held;
    } else {
      bodies[1].forces = {{stiffness, 0, 2 * std::sqrt(stiffness), 0}};
    }
    const System system({}, bodies, gravity);
    State start = system.rest();
    start.coordinates << 0.5, 0;
    return solve(system, start, {.output_times = {1.0}, .tolerance = 1e-9, .max_evaluations = 3e6});
  };
  out.begin("held", "verner98");
  const auto held = swing(0);
  for (const double stiffness : {1e3, 1e4, 1e6, 1e9}) {
    const std::string what = fmt::format("{:g} N m/rad against held", stiffness);
    out.begin(what, "automatic");
    const auto elastic = swing(stiffness);
    if (elastic.states.empty()) {
      add_refusal(out, what, "automatic", elastic.report.message);
      continue;
    }
    expect_below(out, what, "automatic",
                 std::abs(elastic.states[0].coordinates[0] - held.states[0].coordinates[0]),
                 30 / stiffness + held.report.error_estimate + elastic.report.error_estimate);
  }
}

/// Couplings by momenta that dominate everything else, in a fixed frame and in a free one.
void platform_motions(const Recorder& out) {
  using Angles = GyroPlatform::Angles;
  constexpr std::array<int, 5> angles = {0, 1, 3, 5, 6};  // among the coordinates behind the base
  constexpr std::array<int, 3> spins = {2, 4, 7};
  for (const double speed : {0.0, 1e-300, 1.0, 1e6, 1e12}) {
    const GyroPlatform p = platform(speed);
    const System held({}, p.bodies({.kind = JointKind::fixed}, RotorMode::regulated));
    const Angles q = 1e-5 * (Angles() << 0.7, -0.4, 0.9, 0.3, -0.8).finished();
    const Angles dq = 1e-5 * (Angles() << -0.3, 0.5, 0.2, -0.9, 0.6).finished();
    State state = held.rest();
    for (int i = 0; i < 5; ++i) {
      state.coordinates[angles[std::size_t(i)]] = q[i];
      state.rates[angles[std::size_t(i)]] = dq[i];
    }
    for (const int i : spins) state.rates[i] = speed;
    const std::string what = fmt::format("{:g} rad/s, platform held", speed);
    out.begin(what, "BodySystem");
    const Eigen::VectorXd rates = held.rates(0, System::to_vector(state));
    const Angles linear =
        p.linear_accelerations(PlatformEquations::complete, Vector3<double>::Zero(),
                               Vector3<double>::Zero(), q, dq, Angles::Zero());
    double worst = 0;
    for (int i = 0; i < 5; ++i) {
      worst = test::worst_of(worst, std::abs(rates[8 + angles[std::size_t(i)]] - linear[i]));
    }
    expect_below(out, what + ", against the linear equations", "BodySystem", worst,
                 q.squaredNorm() * linear.cwiseAbs().maxCoeff() + 1e-15,
                 "angles and rates of 1e-5");
  }
  for (const double speed : {1.0, 1e3, 1e6}) {
    const System free({},
                      platform(speed).bodies({.kind = JointKind::spherical}, RotorMode::regulated));
    State start = free.rest();
    start.rates.setConstant(0.1);
    for (const int i : spins) start.rates[3 + i] = speed;
    const std::string what = fmt::format("{:g} rad/s, platform free", speed);
    const auto run = [&](Method method) {
      out.begin(what, name(method));
      return solve(free, start,
                   {.output_times = {std::min(300 / speed, 3.0)},
                    .tolerance = 1e-9,
                    .method = method,
                    .max_evaluations = 1e5});
    };
    const auto a = run(Method::verner98);
    const auto b = run(Method::gauss16);
    if (a.states.empty() || b.states.empty()) {
      add_refusal(out, what, "verner98", a.report.message + b.report.message);
      continue;
    }
    kreisel::ErrorMeasure<System> distance(free, 1e-3);
    distance.note_sizes(a.report.sizes);
    expect_below(out, what, "verner98",
                 distance(System::to_vector(a.states[0]), System::to_vector(b.states[0])),
                 a.report.error_estimate + b.report.error_estimate, "against gauss16");
  }
}

}  // namespace

void systems(std::vector<Case>& cases) {
  cases.push_back({"mass-ratios", "bobs of 1e-15 of the mass of what carries them", &mass_ratios});
  cases.push_back({"heavy-end", "1e12 of the mass at the end", &heavy_end});
  cases.push_back(
      {"singular-trees", "bodies without mass, no freedom, gimbal lock", &singular_trees});
  cases.push_back(
      {"platform-motions", "momenta of gyros from 1e-300 to 1e12 rad/s", &platform_motions});
  cases.push_back({"rigid-limit", "stiff joints against joints that are held", &rigid_limit});
}

}  // namespace stability
