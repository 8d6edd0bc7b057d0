#pragma once

#include <cmath>

#include <dynamics/load/load.hpp>

namespace kreisel {

/// The gravitation of a planet at the body's centre of mass, with the first term of the flattening.
///
///   g = -(GM / r^2) [ (1 + k (1 - 5 s^2)) e_r + 2 k s e_z ],   k = (3/2) J2 (R / r)^2,  s = z / r
///
/// Inertial is the frame at the planet's centre, z to the pole. The field's gradient over the body
/// is left out; its torque is at most (3/2) (GM / r^3) (the greatest difference of moments of
/// inertia).
///
/// Units  : m^3/s^2, metre; the defaults are WGS84's
/// Source : the potential GM/r [1 - J2 (R/r)^2 P2(s)], differentiated
template <class S = double>
struct OblateGravitation {
  static constexpr const char* kind = "gravitation of a planet";
  static constexpr bool ignores_spin = true;

  S parameter = S(3986004418LL) * S(100000);  ///< GM
  S radius = S(6378137);                      ///< R, equatorial
  S j2 = S(1.08262982131e-3);                 ///< 0: a sphere

  [[nodiscard]] Vector3<S> operator()(const Vector3<S>& p_Inertial) const {
    const S r2 = p_Inertial.squaredNorm();
    using std::sqrt;
    const S r = sqrt(r2);
    const S s = p_Inertial.z() / r;
    const S k = S(1.5) * j2 * radius * radius / r2;
    Vector3<S> g = (S(1) + k * (S(1) - S(5) * s * s)) * p_Inertial;
    g.z() += S(2) * k * s * r;
    return -(parameter / (r2 * r)) * g;
  }

  [[nodiscard]] Force<Body, S> operator()(const LoadContext<S>& s) const {
    const Vector3<S> centre = s.centre();
    const Vector3<S> g =
        s.template on_body_axes<Inertial>((*this)(s.template position<Inertial>(centre)));
    const Vector3<S> weight = s.inertia.value.mass * g;
    return {{weight, centre.cross(weight)}};
  }

  [[nodiscard]] S potential(const LoadContext<S>& s) const {
    const Vector3<S> p = s.template position<Inertial>(s.centre());
    const S r = p.norm();
    const S sine = p.z() / r;
    const S flattened = j2 * radius * radius / (r * r) * (S(1.5) * sine * sine - S(0.5));
    return -s.inertia.value.mass * parameter / r * (S(1) - flattened);
  }
};

}  // namespace kreisel
