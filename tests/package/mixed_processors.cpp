// A pendulum of two rods on a turntable, solved by objects compiled for this processor and for any: they
// share one libkreisel, agree on the layout of what they hand over, and on the motion.
#include <cmath>
#include <iostream>

#include <dynamics/guide/rotating.hpp>
#include <dynamics/solve/solve.hpp>
#include <dynamics/tree/body_system.hpp>

using namespace kreisel;

struct Angles {
  Eigen::VectorXd at_end;
  double error;
};

Angles RUN(const BodyDescription& rod) {
  BodyDescription second = rod;
  second.name = "second";
  second.parent = 0;
  const BodySystem system(RotatingFrame<>{{0, 0, 0.1}}, {rod, second},
                          UniformGravity<Guide>{{0, 0, -9.81}});
  const auto motion = solve(system, system.rest(), {.output_times = {1, 2, 3}});
  return {motion.states.back().coordinates, motion.report.error_estimate};
}

#ifdef WITH_MAIN
Angles run_native(const BodyDescription& rod);

int main() {
  BodyDescription rod;
  rod.name = "first";
  rod.joint = {.kind = JointKind::revolute, .axis = {0, 1, 0}};
  rod.inertia = InertiaTensor<Body>::about_centre(1, {0.5, 0, 0}, Matrix3<double>::Identity());
  const Angles generic = run_generic(rod);
  const Angles native = run_native(rod);
  const double apart = (generic.at_end - native.at_end).cwiseAbs().maxCoeff();
  std::cout << generic.at_end.transpose() << " rad, apart " << apart << " rad\n";
  return apart <= generic.error + native.error ? 0 : 1;
}
#endif
