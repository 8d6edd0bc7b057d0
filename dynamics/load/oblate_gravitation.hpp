#pragma once

#include <type_traits>

#include <dynamics/guide/ellipsoid.hpp>
#include <dynamics/load/load.hpp>
#include <dynamics/load/planet_field.hpp>
#include <motor/error.hpp>
#include <motor/lanes.hpp>

namespace kreisel {

/// The gravitation of a planet with the first term of its flattening, or of a point mass (j2 = 0).
///
///   g = -(GM / r^2) [ (1 + k (1 - 5 s^2)) e_r + 2 k s e_z ],   k = (3/2) J2 (R / r)^2,  s = z / r
///
/// The force is m g at the body's centre of mass. With `gradient` the force and torque of second
/// order in the body's size are added. PlanetField::size_terms has the bound of the neglected
/// terms.
///
/// Frame  : centre and pole on the axes of Inertial
/// Units  : m^3/s^2, metre; the defaults are WGS84's
/// Source : the potential GM/r [1 - J2 (R/r)^2 P2(s)], differentiated
/// Throws : ComputationFailed if the centre of mass is at the field's centre
template <class S = double>
struct OblateGravitation {
  static constexpr const char* kind = "gravitation of a planet";
  static constexpr bool ignores_spin = true;
  static constexpr bool rests_inertially = true;  ///< its potential does not move with the guide

  S parameter = S(Wgs84::parameter);  ///< GM
  S radius = S(Wgs84::radius);        ///< R, equatorial
  S j2 = S(Wgs84::j2);                ///< 0: a sphere
  Vector3<S> centre = Vector3<S>::Zero();
  Vector3<S> pole = Vector3<S>::UnitZ();  ///< of length 1
  bool gradient = false;

  [[nodiscard]] Vector3<S> operator()(const Vector3<S>& p_Inertial) const {
    return field(pole).acceleration(p_Inertial - centre);
  }

  template <class N>
  [[nodiscard]] Force<Body, N> operator()(const LoadContext<N>& s) const {
    const Vector3<N> p = position(s);
    const Vector3<N> k = s.template on_body_axes<Inertial>(pole.template cast<N>());
    const PlanetField<N> planet = field(k);
    return detail::gravitation_on(s, planet.acceleration(p), gradient, planet, p);
  }

  [[nodiscard]] bool keeps_energy() const { return true; }

  [[nodiscard]] S potential(const LoadContext<S>& s) const {
    const Vector3<S> p = position(s);
    const PlanetField<S> planet = field(s.template on_body_axes<Inertial>(pole));
    const Inertia<S>& T = s.inertia.value;
    const S of_mass = -T.mass * planet.potential(p);
    if (!gradient) return of_mass;
    return of_mass - planet.size_terms(p, detail::central_tensor(T)).energy;
  }

 private:
  template <class N>
  [[nodiscard]] PlanetField<N> field(const Vector3<N>& k) const {
    return {N(parameter), N(S(1.5) * parameter * j2 * radius * radius), k, j2 != S(0)};
  }

  /// The position of the centre of mass from the field's centre, on body axes.
  template <class N>
  [[nodiscard]] Vector3<N> position(const LoadContext<N>& s) const {
    const Vector3<N> p = s.template position<Inertial>(s.centre()) - centre.template cast<N>();
    if constexpr (std::is_floating_point_v<N>) {
      if (p.isZero(N(0))) {
        throw ComputationFailed(
            "gravitation: the centre of mass of a body is at the centre of the field");
      }
    }
    return s.template on_body_axes<Inertial>(p);
  }
};

}  // namespace kreisel
