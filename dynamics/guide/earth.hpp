#pragma once

#include <cmath>
#include <limits>
#include <sstream>
#include <string_view>
#include <type_traits>

#include <motor/error.hpp>
#include <motor/motor.hpp>

namespace kreisel {

template <class S>
struct SineCosine {
  S sine;
  S cosine;
};

/// Sine and cosine of an angle in degrees, exact where the values are: multiples of 90 give 0 and
/// 1, of 45 give the same number twice, of 30 give 1/2.
///
/// The reduction to |rest| <= 45 is exact (fmod, then a difference within a factor of two), so that
/// latitude 90 has cosine 0 and not 6e-17.
///
/// Units  : degrees
/// Error  : <= 3u relative at every finite angle   (tests/dynamics/guide/earth.cpp, 1e5 angles)
template <class S>
[[nodiscard]] SineCosine<S> sine_cosine_degrees(const S& angle) {
  using std::abs, std::acos, std::cos, std::fmod, std::round, std::sin, std::sqrt;
  const S turned = fmod(angle, S(360));
  const S quarters = round(S(turned / S(90)));
  const S rest = turned - S(90) * quarters;
  S s;
  S c;
  if (abs(rest) == S(45)) {
    c = sqrt(S(0.5));
    s = rest < S(0) ? S(-c) : c;
  } else if (abs(rest) == S(30)) {
    c = sqrt(S(0.75));
    s = rest < S(0) ? S(-0.5) : S(0.5);
  } else {
    const S radians = rest * (acos(S(-1)) / S(180));
    s = sin(radians);
    c = cos(radians);
  }
  switch ((static_cast<int>(quarters) + 4) % 4) {  // 0 - x, because -x makes -0 of 0
    case 1: return {c, S(0) - s};
    case 2: return {S(0) - s, S(0) - c};
    case 3: return {S(0) - c, s};
    default: return {s, c};
  }
}

/// The site of an instrument on the rotating earth, and the direction of its horizontal axis.
///
/// Units  : degrees for latitude and azimuth, metre, radian per second
template <class S = double>
struct EarthSite {
  S latitude = S(0);  ///< theta, positive in the north
  S azimuth = S(0);   ///< alpha, of the z axis, counted from north through east
  S height = S(0);    ///< above the ellipsoid (the mean sphere, where the earth is taken as one)
  S rotation_rate = S(7292115) / S(100000000000LL);  ///< u; the earth's by default

  /// The same site in another scalar.
  template <class T>
  [[nodiscard]] EarthSite<T> cast() const {
    return {T(latitude), T(azimuth), T(height), T(rotation_rate)};
  }
};

namespace detail {

/// Throws : InvalidInput  "latitude = 91 degrees lies outside [-90, 90] degrees", also for NaN
template <class S>
void require_within(std::string_view key, const S& value, const S& least, const S& greatest,
                    std::string_view unit) {
  if (value >= least && value <= greatest) return;
  std::ostringstream text;
  text.precision(10);
  text << key << " = " << value << ' ' << unit << " lies outside [" << least << ", " << greatest
       << "] " << unit;
  throw InvalidInput(text.str());
}

/// Throws : InvalidInput  "gravity = -9.81 m/s^2 must be a finite number above 0"
template <class S>
void require_positive(std::string_view key, const S& value, std::string_view unit) {
  if (value > S(0) && value <= std::numeric_limits<S>::max()) return;
  std::ostringstream text;
  text.precision(10);
  text << key << " = " << value << ' ' << unit << " must be a finite number above 0";
  throw InvalidInput(text.str());
}

}  // namespace detail

/// Refuses a site that is not on (or near) the earth.
///
/// Throws : InvalidInput, naming key, value and range. Latitude [-90, 90], azimuth [-360, 360],
///          height [-11000, 1e7], rotation_rate [-1000, 1000] (a turntable may stand in for the
///          earth)
template <class S>
void check(const EarthSite<S>& site) {
  detail::require_within("latitude", site.latitude, S(-90), S(90), "degrees");
  detail::require_within("azimuth", site.azimuth, S(-360), S(360), "degrees");
  detail::require_within("height", site.height, S(-11000), S(10000000), "m");
  detail::require_within("rotation_rate", site.rotation_rate, S(-1000), S(1000), "rad/s");
}

/// The angular velocity and gravity of a guide frame fixed to the earth, for a pendulum suspended
/// at the frame's origin.
///
/// Frame  : x down along the effective gravity, z horizontal with the site's azimuth, y = z x x
///          (azimuth 90: z east, y north)
/// Units  : rad/s, m/s^2, 1/s^2
template <class S = double>
struct EarthGuide {
  Vector3<S> angular_velocity = Vector3<S>::Zero();
  Vector3<S> effective_gravity = Vector3<S>::Zero();  ///< gravitation and centrifugal part
  Matrix3<S> gravity_gradient = Matrix3<S>::Zero();   ///< of the gravitation alone

  /// The same guide in another scalar.
  template <class T>
  [[nodiscard]] EarthGuide<T> cast() const {
    return {angular_velocity.template cast<T>(), effective_gravity.template cast<T>(),
            gravity_gradient.template cast<T>()};
  }
};

/// The earth's rotation on the guide's axes, for the latitude of the effective vertical:
///
///   u_x = -u sin(theta),  u_y = u cos(theta) sin(alpha),  u_z = u cos(theta) cos(alpha)
///
/// Source : paper 002 section 5, where sin and cos are printed as for the colatitude
/// Error  : <= 8u relative in each component; exact where a component is 0 or |u_x| = |u_y|
template <class S>
[[nodiscard]] Vector3<S> earth_rotation(const EarthSite<S>& site) {
  const auto [sin_latitude, cos_latitude] = sine_cosine_degrees(site.latitude);
  const auto [sin_azimuth, cos_azimuth] = sine_cosine_degrees(site.azimuth);
  const S level = site.rotation_rate * cos_latitude;
  return {S(0) - site.rotation_rate * sin_latitude, level * sin_azimuth, level * cos_azimuth};
}

/// The gradient of the gravitation GM/R^2 of a spherical earth:  diag(2, -1, -1) GM/R^3, x down.
///
/// Units  : height in metre above the sphere of mean radius 6371008.8 m; 1/s^2
/// Error  : <= 1.0 % against WGS84 normal gravity from -11 km to 20 km height (flattening, and the
///          tilt of the vertical); normal_gravity.hpp has the gradient of the ellipsoid
template <class S>
[[nodiscard]] Matrix3<S> spherical_gravity_gradient(const S& height) {
  const S parameter = S(3986004418LL) * S(100000);  // GM of WGS84, m^3/s^2
  const S radius = S(63710088) / S(10) + height;
  const S rate2 = parameter / (radius * radius * radius);
  Matrix3<S> gradient = Matrix3<S>::Zero();
  gradient(0, 0) = S(2) * rate2;
  gradient(1, 1) = -rate2;
  gradient(2, 2) = -rate2;
  return gradient;
}

/// The guide frame at a site whose effective gravity is known as a number, as from a gravimeter.
///
/// The site's latitude is then the angle of the effective vertical against the equatorial plane, as
/// astronomical observation gives it.
///
/// Frame  : effective_gravity = (gravity, 0, 0); gravity_gradient of the spherical earth
/// Throws : InvalidInput as check() does, and for a gravity that is not above 0
template <class S>
[[nodiscard]] EarthGuide<S> earth_guide(const EarthSite<S>& site,
                                        const std::type_identity_t<S>& gravity) {
  check(site);
  detail::require_positive("gravity", gravity, "m/s^2");
  return {earth_rotation(site), {gravity, S(0), S(0)}, spherical_gravity_gradient(site.height)};
}

}  // namespace kreisel
