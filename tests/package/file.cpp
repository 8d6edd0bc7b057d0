// A scene file, read and run: a pendulum that hangs at rest stays there.
#include <cmath>
#include <iostream>

#include <dynamics/file/model.hpp>

int main() {
  const auto run = kreisel::run_scene(kreisel::parse_scene(R"(
[gravity]
kind = "uniform"
vector = [0, 0, -9.81]

[[body]]
name = "rod"
mass = 1
inertia = [0.1, 0.1, 0.01]
centre = [0, 0, -0.5]
joint = { kind = "revolute", axis = [0, 1, 0] }

[solve]
t_end = 1
)",
                                                           "rod.toml"));
  const double angle = run.states.back().coordinates[0];
  std::cout << angle << " rad, error " << run.report.error_estimate << '\n';
  return std::abs(angle) <= run.report.error_estimate ? 0 : 1;
}
