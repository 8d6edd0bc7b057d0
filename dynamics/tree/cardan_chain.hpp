#pragma once

#include <array>
#include <string>
#include <variant>
#include <vector>

#include <dynamics/tree/description.hpp>
#include <motor/api.hpp>

namespace kreisel {

/// Three bodies as the gyro of CardanGyro: two rings and a rotor on three perpendicular axes
/// through one point.
///
/// The gimbal axes are x along the outer joint's axis, y along the inner one's, z = x x y along the
/// rotor's, all at zero angles. The rotor's joint counts its angle about sign z.
///
/// Frame : gimbal axes, reduced where the axes meet
struct CardanChain {
  Inertia<> outer_ring, inner_ring, rotor;
  Matrix3<double> axes;   ///< the gimbal axes x, y, z as columns, on guide axes
  Vector3<double> point;  ///< where the axes meet, on guide axes
  double sign;            ///< 1 or -1
};

/// The bodies of a system as a Cardan gyro, or the reason why they are none, which names the body.
[[nodiscard]] KREISEL_API std::variant<CardanChain, std::string> cardan_chain(
    const std::vector<BodyDescription>& bodies);

/// True if the off-diagonal entries of an inertia tensor are rounding.
[[nodiscard]] KREISEL_API bool is_principal(const Inertia<>& inertia);

/// True if the centre of mass lies at the origin, to rounding.
[[nodiscard]] KREISEL_API bool is_centred(const Inertia<>& inertia);

}  // namespace kreisel
