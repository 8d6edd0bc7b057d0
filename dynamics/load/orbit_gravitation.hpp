#pragma once

#include <dynamics/guide/orbit.hpp>
#include <dynamics/load/load.hpp>
#include <dynamics/load/planet_field.hpp>
#include <motor/lanes.hpp>

namespace kreisel {

/// The gravitation of a planet on bodies near an orbiting point, less the acceleration of this
/// point. It is the load for guides of type OrbitAxes, whose origin does not accelerate.
///
///   force = m [g(r + d) - g(r) + (g(r) - a)],   d from the orbit's origin to the centre of mass
///
/// g(r + d) - g(r) is computed from d, not as a difference (PlanetField::tide). g(r) - a is 0 on a
/// Kepler orbit. With j2 only the mean rates of node and perigee are modelled, so the orbit's
/// origin is not in free fall. Then g(r) - a is the field of J2 at r less OrbitPoint::precession,
/// about 1e-3 of g, and bodies move in the full field of J2. With `gradient` the force and torque
/// of second order in the body's size are added: see PlanetField::size_terms.
///
/// Frame  : Inertial of the situation has the orbit's origin as its origin, as in OrbitAxes
/// Units  : SI
/// Error  : force on a mass at 1 mm to 1e6 m from the origin <= 16u of it
///                                              (tests/dynamics/load/orbit_gravitation.cpp)
template <class S = double>
class OrbitGravitation {
 public:
  static constexpr const char* kind = "gravitation on an orbit";
  static constexpr bool ignores_spin = true;

  explicit OrbitGravitation(const OrbitElements<S>& elements, bool gradient = true)
      : orbit_(elements), gradient_(gradient) {}

  template <class N>
  requires(!detail::is_pack<N>) [[nodiscard]] Force<Body, N> operator()(
      const LoadContext<N>& s) const {
    const Near<N> at(*this, s);
    const Vector3<N> g = at.field.tide(at.r, at.d) + at.rest;
    return detail::gravitation_on(s, at.on_body(g), gradient_, at.field_on_body(),
                                  at.on_body(at.r + at.d));
  }

  /// The potential energy relative to the orbit's origin. It depends on time if the orbit is not a
  /// circle or precesses.
  [[nodiscard]] S potential(const LoadContext<S>& s) const {
    const Near<S> at(*this, s);
    const Inertia<S>& T = s.inertia.value;
    const S of_mass = -T.mass * (at.field.tidal_potential(at.r, at.d) + at.rest.dot(at.d));
    if (!gradient_) return of_mass;
    return of_mass -
           at.field_on_body().size_terms(at.on_body(at.r + at.d), detail::central_tensor(T)).energy;
  }

 private:
  /// A body near the orbit's origin, on the orbit's axes.
  template <class N>
  struct Near {
    Near(const OrbitGravitation& load, const LoadContext<N>& s) : situation(s) {
      const OrbitElements<S>& orbit = load.orbit_.elements();
      const OrbitPoint<N> point = load.orbit_.at(s.t);
      axes = point.axes;
      field = {N(orbit.parameter),
               N(S(1.5) * orbit.parameter * orbit.j2 * orbit.radius * orbit.radius), point.pole,
               load.orbit_.precesses()};
      r = Vector3<N>(point.radius, N(0), N(0));
      d = axes.transpose() * s.template position<Inertial>(s.centre());
      rest = field.is_oblate ? Vector3<N>(field.flattening(r) - point.precession)
                             : Vector3<N>(N(0), N(0), N(0));
    }

    [[nodiscard]] Vector3<N> on_body(const Vector3<N>& v) const {
      return situation.template on_body_axes<Inertial>(Vector3<N>(axes * v));
    }
    [[nodiscard]] PlanetField<N> field_on_body() const {
      return {field.parameter, field.oblateness, on_body(field.pole), field.is_oblate};
    }

    const LoadContext<N>& situation;
    Matrix3<N> axes;
    PlanetField<N> field;
    Vector3<N> r, d;
    Vector3<N> rest;  ///< g(r) - a
  };

  Orbit<S> orbit_;
  bool gradient_;
};

}  // namespace kreisel
