// The velocity of a body that spins on a turntable, observed from the room.
#include <iostream>

#include <motor/frame.hpp>
#include <motor/print.hpp>

using namespace kreisel;

int main() {
  const Velocity<Body, Guide, Body> V_rel{{{0, 0, 3}, {0, 0, 0}}};
  const Velocity<Guide, Inertial, Body> F{{{0, 0, 4}, {0, 0, 0}}};
  const auto V = V_rel + F;
  std::cout << V << '\n';
  return untagged(V).resultant.z() == 7 ? 0 : 1;
}
