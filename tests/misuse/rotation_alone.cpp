// A velocity against the inertial frame taken for one against the guide after a change of axes.
// refused: Velocity<.*Inertial
// refused: Velocity<.*Guide
#include <motor/frame.hpp>

using namespace kreisel;

Velocity<Body, Guide, Guide> relative(const Displacement<Guide, Inertial>& X_GI,
                                      const Velocity<Body, Inertial, Inertial>& V,
                                      const Velocity<Guide, Inertial, Guide>& F) {
#ifdef MISUSE
  (void)F;
  return X_GI * V;
#else
  return X_GI * V - F;
#endif
}
