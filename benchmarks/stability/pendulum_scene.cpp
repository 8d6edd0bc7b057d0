// PhysicalPendulum, by closed form and by the steps that replace it where its series ends.

#include <fmt/core.h>

#include <cmath>
#include <string>

#include <dynamics/exact/pendulum_motion.hpp>
#include <dynamics/pendulum/physical_pendulum.hpp>

#include "trial.hpp"

namespace stability {

namespace {

using kreisel::Method;
using Scene = kreisel::PhysicalPendulum<kreisel::RestingPendulumGuide<>>;

/// phi'' = -19.62 sin phi.
const Scene pendulum({.mass = 1, .arm = 0.5, .theta_b = 1, .theta_c = 1}, {39.24});

void try_from(const Recorder& out, const std::string& variant, const Scene::State& start,
              const kreisel::SolveOptions& options) {
  const kreisel::exact::PendulumMotion motion(19.62, start.angle, start.rate);
  Trial<Scene> trial{variant, pendulum, start, options, [&](double t) {
                       const auto m = motion.at(t - options.begin);
                       return Scene::State{m.angle, m.rate};
                     }};
  trial.truth_error = 4e-16;
  attempt(out, trial, Method::automatic);
}

void near_the_barrier(const Recorder& out) {
  const double pi = std::acos(-1.0);
  for (const double off : {1e-1, 1e-3, 1e-6, 1e-14}) {
    try_from(out, fmt::format("at rest {:g} rad from the upper point", off), {pi - off, 0},
             {.output_times = every(1, 10), .tolerance = 1e-8});
  }
  const double up = 2 * std::sqrt(19.62);
  for (const double part : {0.0, 1e-14, -1e-14, 1e-9, -1e-6, 1e-3}) {
    try_from(out, fmt::format("thrown with 1 + {:g} of what takes it up", part),
             {0, up * (1 + part)}, {.output_times = every(0.5, 5), .tolerance = 1e-8});
  }
}

void of_all_sizes(const Recorder& out) {
  for (const double angle : {1e-300, 1e-100, 1e-10, 0.1, 3.0}) {
    try_from(out, fmt::format("amplitude {:g}", angle), {angle, 0},
             {.output_times = every(1, 10), .tolerance = 1e-12, .absolute_scale = 0});
  }
  for (const double rate : {1e3, 1e6}) {
    try_from(out, fmt::format("thrown with {:g} rad/s", rate), {0, rate},
             {.output_times = every(1, 10), .tolerance = 1e-12});
  }
}

void of_all_horizons(const Recorder& out) {
  for (const double end : {1e-9, 1.0, 1e5, 1e9}) {
    try_from(out, fmt::format("{:g} s", end), {0.1, 0},
             {.output_times = {end / 3, end}, .tolerance = 1e-7});
  }
  try_from(out, "from t = 1e9 s on", {0.1, 0},
           {.begin = 1e9, .output_times = every(1, 1e9 + 10, 1e9), .tolerance = 1e-12});
  try_from(out, "backwards", {0.1, 0}, {.output_times = {-1, -50, -100}, .tolerance = 1e-12});
}

}  // namespace

void pendulum_scene(std::vector<Case>& cases) {
  cases.push_back({"pendulum-barrier", "a PhysicalPendulum that comes near its upper point",
                   &near_the_barrier});
  cases.push_back(
      {"pendulum-sizes", "swings of 1e-300 to 3 rad, thrown with up to 1e6 rad/s", &of_all_sizes});
  cases.push_back(
      {"pendulum-horizons", "1e-9 to 1e9 s, far from zero, backwards", &of_all_horizons});
}

}  // namespace stability
