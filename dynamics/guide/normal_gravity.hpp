#pragma once

#include <GeographicLib/Geocentric.hpp>
#include <GeographicLib/NormalGravity.hpp>

#include <cmath>

#include <dynamics/guide/earth.hpp>
#include <motor/displacement.hpp>

namespace kreisel {

/// Normal gravity at a site, with its gravitational and centrifugal parts.
///
/// Frame  : vectors are (north, east, up) of the ellipsoid's normal at the site
/// Units  : m/s^2, radian, degrees for the latitude
struct NormalGravity {
  Vector3<double> gravitation;
  Vector3<double> centrifugal;
  double magnitude;  ///< g' = |gravitation + centrifugal|
  double tilt;       ///< of the plumb line against the normal; > 0: its lower end lies north
  double latitude_of_vertical;  ///< latitude - tilt, as astronomers observe it
  EarthGuide<double> guide;     ///< on axes of the effective vertical
  Pose<double>
      site;  ///< the guide at the site against the earth: centre, pole z, site's meridian x

  [[nodiscard]] Vector3<double> effective() const { return gravitation + centrifugal; }
};

namespace detail {

/// The gravitation of the WGS84 ellipsoid at a geocentric point, its rotation left out.
inline Vector3<double> gravitation(const Vector3<double>& p) {
  Vector3<double> g;
  GeographicLib::NormalGravity::WGS84().V0(p.x(), p.y(), p.z(), g.x(), g.y(), g.z());
  return g;
}

/// d gravitation / d p on the axes given as columns, by central differences of fourth order.
///
/// Step   : relative truncation 12 (h/R)^4 and rounding 4u R/h are equal near h = 4 km; 2e-12
///          together
inline Matrix3<double> gravitation_gradient(const Vector3<double>& p, const Matrix3<double>& axes) {
  constexpr double step = 4096;
  Matrix3<double> gradient;
  for (int j = 0; j < 3; ++j) {
    const Vector3<double> h = step * axes.col(j);
    const Vector3<double> near = gravitation(p + h) - gravitation(p - h);
    const Vector3<double> far = gravitation(p + 2 * h) - gravitation(p - 2 * h);
    gradient.col(j) = axes.transpose() * (8 * near - far) / (12 * step);
  }
  return (gradient + gradient.transpose()) / 2;
}

}  // namespace detail

/// Gravity of the WGS84 ellipsoid at a site, and the guide frame along the effective vertical.
///
/// The gravitation is WGS84's in closed form. The centrifugal part follows from the site's rotation
/// rate, which may differ from WGS84's. The effective vertical is tilted against the ellipsoid's
/// normal at a height (1 km: 8e-7 rad at 45 degrees) and with another rotation rate. x, u and the
/// gradient refer to the effective vertical.
///
/// Source : H. Moritz, Geodetic Reference System 1980; GeographicLib::NormalGravity::V0
/// Error  : against WGS84 1e-15 relative in gravitation; gradient <= 2e-12 of its norm (measured
///          against 50 digits; trace 8e-13; tests/dynamics/guide/earth.cpp). The real earth differs
///          from normal gravity by up to 3e-3 m/s^2 and 3e-4 rad
/// Throws : InvalidInput as check() does, and if gravity does not point down: the site is in orbit
[[nodiscard]] inline NormalGravity normal_gravity(const EarthSite<double>& site) {
  check(site);
  const auto [sin_latitude, cos_latitude] = sine_cosine_degrees(site.latitude);
  const auto [sin_azimuth, cos_azimuth] = sine_cosine_degrees(site.azimuth);

  // Longitude 0: the meridian is the plane of X (away from the axis) and Z (towards the pole).
  Vector3<double> p;
  GeographicLib::Geocentric::WGS84().Forward(site.latitude, 0, site.height, p.x(), p.y(), p.z());
  Matrix3<double> local;                    // columns north, east, up
  local << -sin_latitude, 0, cos_latitude,  //
      0, 1, 0,                              //
      cos_latitude, 0, sin_latitude;

  NormalGravity result;
  const double u = site.rotation_rate;
  result.gravitation = local.transpose() * detail::gravitation(p);
  result.centrifugal = local.transpose() * Vector3<double>(u * u * p.x(), 0, 0);

  const Vector3<double> g = result.effective();
  if (!(g.z() < 0)) {
    std::ostringstream text;
    text.precision(10);
    text << "rotation_rate = " << u << " rad/s and height = " << site.height
         << " m: gravity does not point down, the site is in orbit";
    throw InvalidInput(text.str());
  }
  result.magnitude = std::hypot(g.x(), g.z());
  result.tilt = std::atan2(g.x(), -g.z());
  result.latitude_of_vertical = site.latitude - result.tilt * (180 / std::acos(-1.0));

  // Down, level north, and the guide's z and y, as components (north, east, up).
  const double sin_tilt = g.x() / result.magnitude;
  const double cos_tilt = -g.z() / result.magnitude;
  const Vector3<double> down(sin_tilt, 0, -cos_tilt);
  const Vector3<double> north(cos_tilt, 0, sin_tilt);
  const Vector3<double> east(0, 1, 0);
  Matrix3<double> axes;
  axes << down, sin_azimuth * north - cos_azimuth * east, cos_azimuth * north + sin_azimuth * east;

  const Vector3<double> rotation(u * cos_latitude, 0, u * sin_latitude);
  result.guide.angular_velocity = axes.transpose() * rotation;
  result.guide.effective_gravity = {result.magnitude, 0, 0};
  result.site = {local * axes, p};
  result.guide.gravity_gradient = detail::gravitation_gradient(p, result.site.rotation);
  return result;
}

}  // namespace kreisel
