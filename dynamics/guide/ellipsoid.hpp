#pragma once

#include <cmath>

#include <motor/motor.hpp>

/// The WGS84 ellipsoid and its normal gravitation, for any number type: double, dual numbers,
/// PowerSeries. No formula has a singularity at the poles.

namespace kreisel {

/// The constants of WGS84.
///
/// Units  : metre, m^3/s^2, rad/s
/// Source : NGA.STND.0036; j2 follows from the other four
struct Wgs84 {
  static constexpr double radius = 6378137;  ///< of the equator
  static constexpr double flattening = 1 / 298.257223563;
  static constexpr double e2 = flattening * (2 - flattening);  ///< squared eccentricity
  static constexpr double parameter = 3.986004418e14;          ///< GM
  static constexpr double rotation_rate = 7.292115e-5;
  static constexpr double j2 = 1.08262982131e-3;
};

/// The point at a height above the ellipsoid where its normal is n.
///
///   p = N (n_x, n_y, (1 - e^2) n_z) + h n,   N = a/sqrt(1 - e^2 n_z^2)
///
/// Frame  : the earth's centre and axes, z to the north pole
/// Error  : <= 4u of |p|
template <class N>
[[nodiscard]] Vector3<N> point_above(const Vector3<N>& n, const N& height) {
  using std::sqrt;
  const N radius = N(Wgs84::radius) / sqrt(N(N(1) - N(Wgs84::e2) * n.z() * n.z()));
  const N out = radius + height;
  return {out * n.x(), out * n.y(), (N(1 - Wgs84::e2) * radius + height) * n.z()};
}

/// The angular velocity against the earth of level axes that move along z: x down along the
/// normal, z horizontal.
///
///   u = (turn_rate, s (1/(N+h) + k e_z^2), -s k e_y e_z),   e the unit vector to the pole,
///   k = [1/(M+h) - 1/(N+h)]/cos^2(latitude) = e^2 N/[(1 - e^2 e_x^2)(M+h)(N+h)]
///
/// M and N are the radii of curvature of the meridian and of the prime vertical. turn_rate is the
/// rate about x. If it is 0, z is carried parallel along the surface, and the path is a geodesic.
///
/// Frame  : all vectors on the level axes
/// Units  : metre, m/s, rad/s
/// Source : Weingarten's equations, n' = W v, with the shape operator W of the surface at height h
/// Error  : <= 8u of each component
template <class N>
[[nodiscard]] Vector3<N> level_turning(const Vector3<N>& pole, const N& height, const N& speed,
                                       const N& turn_rate) {
  using std::sqrt;
  const N w = N(1) - N(Wgs84::e2) * pole.x() * pole.x();
  const N radius = N(Wgs84::radius) / sqrt(w);
  const N across = N(1) / (radius + height);
  const N along = N(1) / (N(1 - Wgs84::e2) * radius / w + height);
  const N k = N(Wgs84::e2) * radius / w * across * along;
  return {turn_rate, speed * (across + k * pole.z() * pole.z()),
          N(0) - speed * k * pole.y() * pole.z()};
}

/// The gravitation of the ellipsoid, as a sum of zonal harmonics up to degree 12.
///
///   J_2n = (-1)^(n+1) 3 e^2n/[(2n+1)(2n+3)] (1 - n + 5 n J_2/e^2)
///
/// Frame  : the earth's centre and axes; centrifugal acceleration is not included
/// Units  : metre, m/s^2
/// Source : W. Heiskanen, H. Moritz, Physical Geodesy, (2-92)
/// Error  : <= 1.1e-13 m/s^2, from 12 digits of J2             (tests/dynamics/guide/course.cpp)
template <class N>
[[nodiscard]] Vector3<N> normal_gravitation(const Vector3<N>& p) {
  using std::sqrt;
  const N r2 = p.dot(p);
  const N r = sqrt(r2);
  const N s = p.z() / r;
  const N shrink = N(Wgs84::radius * Wgs84::radius) / r2;
  N P(1), P_next = s;  // Legendre polynomials of degree l and l + 1
  N D(0), D_next(1);   // their derivatives
  N outwards(1), polewards(0), power(1);
  double of_e = -3;  // (-1)^(n+1) 3 e^2n
  int l = 0;
  for (int n = 1; n <= 6; ++n) {
    for (int twice = 0; twice < 2; ++twice, ++l) {
      const N P_then = (N(2 * l + 3) * s * P_next - N(l + 1) * P) / N(l + 2);
      const N D_then = D + N(2 * l + 3) * P_next;
      P = P_next;
      P_next = P_then;
      D = D_next;
      D_next = D_then;
    }
    power *= shrink;
    of_e *= -Wgs84::e2;
    const double J = of_e / ((2 * n + 1) * (2 * n + 3)) * (1 - n + 5 * n * Wgs84::j2 / Wgs84::e2);
    outwards -= N((2 * n + 1) * J) * power * P;
    polewards += N(J) * power * D;
  }
  const N size = N(-Wgs84::parameter) / r2;
  const N along = size * (outwards - s * polewards) / r;
  return {along * p.x(), along * p.y(), along * p.z() + size * polewards};
}

}  // namespace kreisel
