#pragma once

#include <type_traits>
#include <utility>
#include <vector>

#include <dynamics/gimbal/pendulous_gyro.hpp>
#include <dynamics/tree/body_system.hpp>

namespace kreisel::test {

/// A gyro in two rings as three bodies in three joints, whose equations are found in another way.
/// The joints count from zero, the gyro's angles from the references of its bearings.
template <class M, class Rotor, class... Loads>
BodySystem<M> as_bodies(const PendulousBodies& of, const CardanBearings& bearings, const M& guide,
                        const Rotor& rotor, const Loads&... loads) {
  const auto described = [](const char* name, const char* parent, int axis,
                            const Inertia<>& inertia, const JointForce& force) {
    return BodyDescription{
        .name = name,
        .parent = parent,
        .joint = {.kind = JointKind::revolute, .axis = Vector3<double>::Unit(axis)},
        .inertia = {inertia},
        .forces = {force}};
  };
  const auto spring = [](const CardanBearing& bearing) {
    return JointForce{bearing.stiffness, bearing.reference, bearing.damping, 0};
  };
  JointForce drive{0, 0, rotor.friction, 0};
  if constexpr (requires { rotor.torque; }) drive.constant = rotor.torque;
  std::vector<BodyDescription> all{
      described("outer ring", "guide", 0, of.outer_ring, spring(bearings.outer)),
      described("inner ring", "outer ring", 1, of.inner_ring, spring(bearings.inner)),
      described("rotor", "inner ring", 2, of.rotor, drive)};
  all[0].joint.position = of.point;
  if (std::is_same_v<Rotor, RegulatedRotor>) all[2].rule = JointRule::driven;
  return {guide, std::move(all), loads...};
}

}  // namespace kreisel::test
