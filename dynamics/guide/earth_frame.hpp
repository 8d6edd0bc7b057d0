#pragma once

#include <dynamics/guide/normal_gravity.hpp>
#include <dynamics/guide/steady.hpp>

namespace kreisel {

/// The frame fixed to the rotating earth at a site: x down along the effective vertical, z
/// horizontal with the site's azimuth, y = z x x, as EarthGuide has it.
///
/// I is the frame at the earth's centre that does not turn, z to the north pole, x through the
/// site's meridian at t = 0. Gravitation is a load (EarthGravitation); the centrifugal part comes
/// from this motion, so it must not be put in again with the effective gravity.
///
/// Source : paper 002 section 5, the guide on the earth
/// Throws : InvalidInput as normal_gravity() does
template <class G = Guide, class I = Inertial>
[[nodiscard]] SteadyFrame<G, I> earth_frame(const EarthSite<double>& site) {
  const Vector3<double> axis(0, 0, site.rotation_rate);
  return {{normal_gravity(site).site}, {{axis, Vector3<double>::Zero()}}};
}

}  // namespace kreisel
