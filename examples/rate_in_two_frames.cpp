// A platform turns with the table it stands on, at 1 rad/s. A gyro on it is turned at 2 rad/s about
// an axis across. What the platform calls a constant angular velocity changes, seen from the room.

#include <iostream>

#include <motor/print.hpp>
#include <motor/rate.hpp>

using namespace kreisel;

int main() {
  const Velocity<Guide, Inertial, Guide> F{{{0, 0, 1}, {0, 0, 0}}};  // platform against the room
  const Velocity<Body, Guide, Guide> V_rel{{{2, 0, 0}, {0, 0, 0}}};  // gyro against the platform
  const Rate<Guide, Velocity<Body, Guide, Guide>> seen_from_platform{};  // constant there

  // The room is an observer against whom the platform moves with F, so it moves with -F.
  const auto seen_from_room = seen_from<Inertial>(seen_from_platform, -F, V_rel);
  std::cout << "seen from the platform " << seen_from_platform << "\nseen from the room     "
            << seen_from_room << '\n';

  // The sign cannot be got wrong, because +F is the velocity of another frame:
  //   seen_from<Inertial>(seen_from_platform, F, V_rel);      does not compile
  const auto back = seen_from<Guide>(seen_from_room, F, V_rel);
  std::cout << "and back               " << back << '\n';
}
