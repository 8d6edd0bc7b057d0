// The guide's motion is known against the earth; taken as one against the inertial frame it would
// silently leave out the earth's rotation.
// refused: the guide of a body must return a FrameMotion<Guide, Inertial>
#include <dynamics/guide/resting.hpp>
#include <dynamics/rigid/fixed_point_body.hpp>

struct Earth {};

#ifdef MISUSE
using Motion = kreisel::RestingFrame<kreisel::Guide, Earth>;
#else
using Motion = kreisel::RestingFrame<kreisel::Guide, kreisel::Inertial>;
#endif

const kreisel::FixedPointBody body(kreisel::InertiaTensor<kreisel::Body>{}, {0, 0, 0}, Motion{});
