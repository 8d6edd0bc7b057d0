// An equation of motion given a rate that a stranger sees: no form of it exists.
// refused: a rate is seen neither from the body, the guide nor the inertial frame
// refused: Stranger
#include <dynamics/law/relative.hpp>

using namespace kreisel;
struct Stranger {};

#ifdef MISUSE
using Observer = Stranger;
#else
using Observer = Guide;
#endif

auto force(const InertiaTensor<Body>& T, const Velocity<Body, Guide, Body>& V_rel,
           const Velocity<Guide, Inertial, Body>& F,
           const Rate<Body, Velocity<Body, Guide, Body>>& dV_rel,
           const Rate<Observer, Velocity<Guide, Inertial, Body>>& dF) {
  return equation_of_motion(T, V_rel, F, dV_rel, dF);
}
