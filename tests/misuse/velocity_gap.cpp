// A chain of velocities with a gap: device against earth, then ship against inertial.
// refused: no such sum: velocities join as V_AB \+ V_BC|invalid operands
// refused: Velocity<Device, Earth, Device
// refused: Velocity<Ship, (kreisel::)?Inertial, Device
#include <motor/frame.hpp>

struct Earth {};
struct Ship {};
struct Device {};

#ifdef MISUSE
using Next = kreisel::Velocity<Ship, kreisel::Inertial, Device>;
#else
using Next = kreisel::Velocity<Earth, kreisel::Inertial, Device>;
#endif

auto absolute(const kreisel::Velocity<Device, Earth, Device>& device, const Next& next) {
  return device + next;
}
