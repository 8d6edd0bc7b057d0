// A body that spins about its axis, observed from a turntable: prints its spin relative to the
// room.
#include <iostream>

#include <dynamics/inertia.hpp>
#include <motor/frame.hpp>
#include <motor/print.hpp>

using namespace kreisel;

int main() {
  const Velocity<Body, Guide, Body> V_rel{{{0, 0, 3}, {0, 0, 0}}};
  const Velocity<Guide, Inertial, Body> F{{{0, 0, 4}, {0, 0, 0}}};
  const auto T =
      InertiaTensor<Body>::about_origin(2, {0, 0, 0}, Vector3<double>(1, 1, 1).asDiagonal());
  const auto H = T * (V_rel + F);
  std::cout << H << '\n';
  return untagged(H).moment.z() == 7 ? 0 : 1;
}
