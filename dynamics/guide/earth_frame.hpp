#pragma once

#include <dynamics/guide/normal_gravity.hpp>
#include <dynamics/guide/steady.hpp>

namespace kreisel {

/// The frame fixed to the rotating earth at a site: x down along the effective vertical, z
/// horizontal with the site's azimuth, y = z x x, as in EarthGuide.
///
/// I is the non-rotating frame at the earth's centre, z to the north pole, x through the site's
/// meridian at t = 0. Gravitation is a load (EarthGravitation). The motion of this frame already
/// contains the centrifugal part, so do not add effective gravity as well.
///
/// Source : paper 002 section 5, the guide on the earth
/// Throws : InvalidInput as normal_gravity() does
template <class G = Guide, class I = Inertial>
[[nodiscard]] SteadyFrame<G, I> earth_frame(const EarthSite<double>& site) {
  const Vector3<double> axis(0, 0, site.rotation_rate);
  return {{normal_gravity(site).site}, {{axis, Vector3<double>::Zero()}}};
}

}  // namespace kreisel
