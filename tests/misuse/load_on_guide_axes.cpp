// A user's load written in the guide: on other axes, its torque about another point than the body's.
// refused: a load must take a LoadContext and return a Force<Body>
#include <dynamics/guide/resting.hpp>
#include <dynamics/rigid/free_body.hpp>

#ifdef MISUSE
using Load = kreisel::Force<kreisel::Guide>;
#else
using Load = kreisel::Force<kreisel::Body>;
#endif

const auto wind = [](const kreisel::LoadContext<>&) { return Load{}; };
const kreisel::FreeBody body(kreisel::InertiaTensor<kreisel::Body>{}, kreisel::RestingFrame<>{},
                             wind);
