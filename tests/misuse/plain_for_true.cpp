// The plain derivative of the guide velocity at the moving point, taken for the motor's.
// refused: PlainRate
// refused: (class .|.)(kreisel::)?Rate
#include <dynamics/law/relative.hpp>

using namespace kreisel;
using V = Velocity<Body, Guide, Body>;
using F = Velocity<Guide, Inertial, Body>;

auto force(const InertiaTensor<Body>& T, const V& v, const F& f, const Rate<Body, V>& dv,
           const PlainRate<Guide, F>& df) {
#ifdef MISUSE
  return equation_of_motion(T, v, f, dv, df);
#else
  return equation_of_motion(T, v, f, dv, true_rate(df, v, f));
#endif
}
