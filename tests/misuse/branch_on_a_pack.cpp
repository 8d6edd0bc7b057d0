// A brake that acts in one direction only needs the sign of a speed; a pack has one for each lane.
// refused: this code branches on a number, but a pack has several
#include <dynamics/ensemble/pack.hpp>

using kreisel::Pack;

Pack brake(const Pack& speed) {
#ifdef MISUSE
  return speed < Pack(0) ? Pack(0) : -speed;
#else
  return select(speed < Pack(0), Pack(0), -speed);
#endif
}
