// A rod let go beside its bearing: what of kreisel is no template was compiled in this project.
#include <iostream>

#include <dynamics/scene/body_system.hpp>

#ifndef KREISEL_COMPILED
#error "kreisel::compiled is linked"
#endif

using namespace kreisel;

int main() {
  BodyDescription rod;
  rod.name = "rod";
  rod.joint = {.kind = JointKind::revolute, .axis = {0, 1, 0}};
  rod.inertia =
      InertiaTensor<Body>::about_origin(1, {1.5, 0, 0}, Vector3<double>(0, 3, 3).asDiagonal());
  const BodySystem system(RestingFrame<>{}, {rod}, UniformGravity<Guide>{{0, 0, -10}});
  const double acceleration = system.rates(0, system.to_vector(system.rest()))[1];
  std::cout << acceleration << '\n';
  return acceleration == 5 ? 0 : 1;
}
