// A displacement from body to guide applied to a motor that is already written in the guide.
// refused: not written in the frame that this displacement takes from
// refused: Force<(kreisel::)?Guide
// refused: (From = |Displacement<|operator\*<.*)(kreisel::)?(Body|Guide, (kreisel::)?Body)
#include <motor/frame.hpp>

using namespace kreisel;

#ifdef MISUSE
using Given = Guide;
#else
using Given = Body;
#endif

auto in_guide(const Displacement<Guide, Body>& X_GB, const Force<Given>& P) { return X_GB * P; }
