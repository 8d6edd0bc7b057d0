// A force added to a momentum.
// refused: all else adds to its own kind|invalid operands
// refused: Force<(kreisel::)?Body
// refused: Momentum<(kreisel::)?Body
#include <motor/frame.hpp>

using namespace kreisel;

#ifdef MISUSE
using Second = Momentum<Body>;
#else
using Second = Force<Body>;
#endif

auto sum(const Force<Body>& P, const Second& Q) { return P + Q; }
