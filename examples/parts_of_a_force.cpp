// A turntable turns at 1 rad/s. A body on it, 1 m from the axis, moves along the tangent at 1 m/s
// and turns at 2 rad/s against the table. Prints the force on the body by cause.

#include <iostream>

#include <dynamics/law/relative.hpp>
#include <motor/print.hpp>

using namespace kreisel;

int main() {
  const auto T = InertiaTensor<Body>::about_centre(1, {0, 0, 0}, Matrix3<double>::Identity());
  const Velocity<Body, Guide, Body> V_rel{{{0, 0, 2}, {0, 1, 0}}};  // body against table
  const Velocity<Guide, Inertial, Body> F{{{0, 0, 1}, {0, 1, 0}}};  // table against the room
  const Rate<Body, Velocity<Body, Guide, Body>> dV_rel{{{0, 0, 0}, {2, 0, 0}}};  // seen from body
  const Rate<Guide, Velocity<Guide, Inertial, Body>> dF{};  // the table turns steadily

  const auto parts = equation_of_motion(T, V_rel, F, dV_rel, dF);
  std::cout << "relative " << parts.relative << "\nguide    " << parts.guide << "\nCoriolis "
            << parts.coriolis << "\nforce    " << parts.total() << '\n';
}
