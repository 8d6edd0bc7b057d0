// A platform turns with its table at 1 rad/s. A gyro on it turns at 2 rad/s about a horizontal
// axis. This angular velocity is constant for the platform, but changes for an observer in the
// room.

#include <iostream>

#include <motor/print.hpp>
#include <motor/rate.hpp>

using namespace kreisel;

int main() {
  const Velocity<Guide, Inertial, Guide> F{{{0, 0, 1}, {0, 0, 0}}};  // platform against the room
  const Velocity<Body, Guide, Guide> V_rel{{{2, 0, 0}, {0, 0, 0}}};  // gyro against the platform
  const Rate<Guide, Velocity<Body, Guide, Guide>> seen_from_platform{};  // constant there

  // The platform moves with F against the room, so the room moves with -F against the platform.
  const auto seen_from_room = seen_from<Inertial>(seen_from_platform, -F, V_rel);
  std::cout << "seen from the platform " << seen_from_platform << "\nseen from the room     "
            << seen_from_room << '\n';

  // The sign cannot be wrong, because +F is the velocity of another frame:
  //   seen_from<Inertial>(seen_from_platform, F, V_rel);      does not compile
  const auto back = seen_from<Guide>(seen_from_room, F, V_rel);
  std::cout << "and back               " << back << '\n';
}
