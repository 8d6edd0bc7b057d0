#pragma once

#include <dynamics/guide/motion.hpp>
#include <dynamics/guide/rotating.hpp>

namespace kreisel {

/// The steady motion that approximates a guide's motion between two times. u and the inertial
/// acceleration of the origin, on the guide's own axes, are means over 256 times. Position,
/// attitude and velocity are those at the middle.
///
/// Units  : second
/// Error  : the variation of the motion is left out; prune() reports the effect on a scene
template <class M>
[[nodiscard]] RotatingFrame<> mean_motion(const M& guide, double begin, double end) {
  constexpr int moments = 256;
  Vector3<double> u = Vector3<double>::Zero();
  Vector3<double> a = Vector3<double>::Zero();
  for (int i = 0; i < moments; ++i) {
    const FrameMotion<Guide, Inertial> now = guide(begin + (end - begin) * (i + 0.5) / moments);
    u += now.V.value.resultant / moments;
    a += now.origin_acceleration() / moments;
  }
  const double middle = (begin + end) / 2;
  const auto from_inertial = [](const FrameMotion<Guide, Inertial>& motion) -> Vector3<double> {
    return motion.X.value.rotation * motion.V.value.moment;
  };
  // From the middle back to t = 0, where a RotatingFrame starts.
  const FrameMotion<Guide, Inertial> now = guide(middle);
  const RotatingFrame<> from_middle{u, a, now.X, from_inertial(now)};
  const FrameMotion<Guide, Inertial> at_zero = from_middle(-middle);
  return {u, a, at_zero.X, from_inertial(at_zero)};
}

}  // namespace kreisel
