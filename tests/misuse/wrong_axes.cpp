// Guide data written in the guide's axes, added to a motor written in the body's.
// refused: both are written in one frame|invalid operands
// refused: Velocity<(kreisel::)?Guide, (kreisel::)?Inertial, (kreisel::)?Guide
#include <motor/frame.hpp>

using namespace kreisel;

auto absolute(const Velocity<Body, Guide, Body>& V_rel, const Velocity<Guide, Inertial, Guide>& F,
              const Displacement<Body, Guide>& X_BG) {
#ifdef MISUSE
  (void)X_BG;
  return V_rel + F;
#else
  return V_rel + X_BG * F;
#endif
}
