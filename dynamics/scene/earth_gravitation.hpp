#pragma once

#include <dynamics/guide/normal_gravity.hpp>
#include <dynamics/scene/load.hpp>

namespace kreisel {

/// The gravitation of the WGS84 ellipsoid (closed form) at the body's centre of mass, wherever it
/// is.
///
/// Inertial is the frame at the earth's centre, z to the pole, as earth_frame() has it; how far the
/// earth has turned does not matter to a body of revolution. The centrifugal part of gravity is not
/// in it: that is the guide's motion. The field's gradient over the body is left out (see
/// OblateGravitation).
struct EarthGravitation {
  static constexpr const char* kind = "gravitation of the earth";
  static constexpr bool ignores_spin = true;

  [[nodiscard]] Force<Body> operator()(const Situation<>& s) const {
    const Vector3<double> centre = s.centre();
    const Vector3<double> g =
        s.on_body_axes<Inertial>(detail::gravitation(s.place<Inertial>(centre)));
    const Vector3<double> weight = s.inertia.value.mass * g;
    return {{weight, centre.cross(weight)}};
  }

  [[nodiscard]] double potential(const Situation<>& s) const {
    const Vector3<double> p = s.place<Inertial>(s.centre());
    Vector3<double> g;
    const auto& field = GeographicLib::NormalGravity::WGS84();
    return -s.inertia.value.mass * field.V0(p.x(), p.y(), p.z(), g.x(), g.y(), g.z());
  }
};

}  // namespace kreisel
