// A rate handed from the guide to the body with the velocity of the guide against the body.
// refused: seen_from<New> takes the velocity of New|no matching function for call to .seen_from
// refused: Velocity<(kreisel::)?Guide, (kreisel::)?Body
#include <motor/rate.hpp>

using namespace kreisel;
using F = Velocity<Guide, Inertial, Body>;

auto seen_from_the_body(const Rate<Guide, F>& dF, const Velocity<Body, Guide, Body>& V_rel,
                        const F& f) {
#ifdef MISUSE
  return seen_from<Body>(dF, -V_rel, f);
#else
  return seen_from<Body>(dF, V_rel, f);
#endif
}
