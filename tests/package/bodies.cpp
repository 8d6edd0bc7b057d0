// A rod, released beside its bearing, swings down: bodies and solve() are compiled into libkreisel.
#include <cmath>
#include <iostream>

#include <dynamics/solve/solve.hpp>
#include <dynamics/tree/body_system.hpp>

using namespace kreisel;

int main() {
  BodyDescription rod;
  rod.name = "rod";
  rod.joint = {.kind = JointKind::revolute, .axis = {0, 1, 0}};
  rod.inertia =
      InertiaTensor<Body>::about_origin(1, {1.5, 0, 0}, Vector3<double>(0, 3, 3).asDiagonal());
  const BodySystem system(RestingFrame<>{}, {rod}, UniformGravity<Guide>{{0, 0, -10}});
  const auto run = solve(system, system.rest(), {.output_times = {0.1}});
  const double angle = run.states[0].coordinates[0];
  std::cout << angle << " rad\n";
  return std::abs(angle - 0.025) < 1e-4 && run.report.tolerance_kept ? 0 : 1;
}
