#pragma once

#include <type_traits>

#include <dynamics/guide/normal_gravity.hpp>
#include <dynamics/load/load.hpp>
#include <motor/lanes.hpp>

namespace kreisel {

/// The gravitation of the WGS84 ellipsoid (closed form) at the body's centre of mass, at any
/// height.
///
/// Inertial is the frame at the earth's centre with z to the pole, as in earth_frame(). The earth's
/// rotation angle does not matter, because the ellipsoid is a body of revolution. The centrifugal
/// part of gravity is not included: it comes from the guide's motion. The field's gradient over the
/// body is left out (see OblateGravitation).
///
/// Error  : in dual numbers the field's gradient is a difference: 2e-12 of it
struct EarthGravitation {
  static constexpr const char* kind = "gravitation of the earth";
  static constexpr bool ignores_spin = true;

  template <class N>
  requires(!detail::is_pack<N>) [[nodiscard]] Force<Body, N> operator()(
      const LoadContext<N>& s) const {
    const Vector3<N> centre = s.centre();
    const Vector3<N> g =
        s.template on_body_axes<Inertial>(field(Vector3<N>(s.template position<Inertial>(centre))));
    const Vector3<N> weight = s.inertia.value.mass * g;
    return {{weight, centre.cross(weight)}};
  }

  [[nodiscard]] double potential(const LoadContext<>& s) const {
    const Vector3<double> p = s.position<Inertial>(s.centre());
    Vector3<double> g;
    const auto& field = GeographicLib::NormalGravity::WGS84();
    return -s.inertia.value.mass * field.V0(p.x(), p.y(), p.z(), g.x(), g.y(), g.z());
  }

 private:
  template <class N>
  [[nodiscard]] static Vector3<N> field(const Vector3<N>& p) {
    if constexpr (std::is_same_v<N, double>) {
      return detail::gravitation(p);
    } else {
      const Vector3<double> at(p.x().value(), p.y().value(), p.z().value());
      const Matrix3<double> gradient =
          detail::gravitation_gradient(at, Matrix3<double>::Identity());
      return detail::gravitation(at).template cast<N>() +
             gradient.template cast<N>() * (p - at.template cast<N>());
    }
  }
};

}  // namespace kreisel
