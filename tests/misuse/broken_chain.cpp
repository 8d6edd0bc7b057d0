// The device moves against the ship, but the chain goes from the earth to it: the ship's motion would
// be left out.
// refused: each link of a chain moves against the frame of the link before
#include <dynamics/guide/chain.hpp>
#include <dynamics/guide/resting.hpp>

struct Earth {};
struct Ship {};

const kreisel::RestingFrame<Earth, kreisel::Inertial> earth;
const kreisel::RestingFrame<Ship, Earth> ship;
const kreisel::RestingFrame<kreisel::Guide, Ship> device;

#ifdef MISUSE
const kreisel::Chain guide(earth, device);
#else
const kreisel::Chain guide(earth, ship, device);
#endif
