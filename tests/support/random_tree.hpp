#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <dynamics/tree/description.hpp>
#include <dynamics/tree/joint/list.hpp>

#include <support/sample.hpp>

namespace kreisel::test {

inline InertiaTensor<Body> random_inertia(Sample& sample) {
  const Vector3<double> moments(sample.uniform(0.3, 0.5), sample.uniform(0.3, 0.5),
                                sample.uniform(0.3, 0.5));
  const Matrix3<double> R = sample.rotation();
  return InertiaTensor<Body>::about_centre(sample.uniform(0.5, 2), 0.3 * sample.direction(),
                                           R * moments.asDiagonal() * R.transpose());
}

inline Joint random_joint(Sample& sample, JointKind kind) {
  return {kind,
          sample.direction(),
          sample.direction(),
          0.5 * sample.direction(),
          Eigen::Quaterniond(sample.rotation()),
          sample.uniform(-0.5, 0.5)};
}

inline JointKind random_kind(Sample& sample) {
  return static_cast<JointKind>(int(sample.uniform(0, double(joint_types().size()))));
}

inline std::vector<JointForce> random_forces(Sample& sample, JointKind kind) {
  const JointType& type = joint_type(kind);
  const bool springs = type.has_single_coordinates();
  std::vector<JointForce> forces;
  for (int i = 0; i < type.rate_count(); ++i) {
    forces.push_back({springs ? sample.uniform(0, 2) : 0, springs ? sample.uniform(-1, 1) : 0,
                      sample.uniform(0, 0.5), sample.uniform(-1, 1)});
  }
  return forces;
}

/// A tree with all combinations of joint kinds, some of them locked and some at a constant rate,
/// and rotors of all modes. All its loads have series.
inline std::vector<BodyDescription> random_tree(std::uint64_t seed) {
  Sample sample(seed);
  std::vector<BodyDescription> bodies;
  const std::vector<JointType>& types = joint_types();
  const int count = 2 + int(seed % 4);
  for (int i = 0; i < count; ++i) {
    BodyDescription b;
    b.name = "body " + std::to_string(i);
    JointKind kind = types[seed % types.size()].kind;
    while (i > 0 && (kind = random_kind(sample)) == JointKind::free) {
    }
    if (i > 0) b.parent = "body " + std::to_string(int(sample.uniform(0, i)));
    b.joint = random_joint(sample, kind);
    b.inertia = random_inertia(sample);
    if (sample.once_in(2)) b.forces = random_forces(sample, kind);
    if (i > 0 && sample.once_in(6)) b.rule = JointRule::held;
    if (kind == JointKind::revolute && sample.once_in(6)) b.rule = JointRule::driven;
    bodies.push_back(b);
  }
  for (const RotorMode mode : {RotorMode::free, RotorMode::regulated, RotorMode::torque}) {
    if (!sample.once_in(2)) continue;
    BodyDescription b;
    b.name = "rotor " + std::to_string(int(mode));
    b.parent = "body " + std::to_string(int(sample.uniform(0, count)));
    b.joint = random_joint(sample, JointKind::revolute);
    b.joint.orientation.setIdentity();
    const Vector3<double> e = b.joint.axis.normalized();
    b.inertia = InertiaTensor<Body>::about_centre(
        0.4, 0.1 * e, 0.05 * Matrix3<double>::Identity() + 0.04 * e * e.transpose());
    b.rotor = {.mode = mode, .torque = mode == RotorMode::torque ? 0.3 : 0};
    if (mode == RotorMode::torque) b.forces = {{0, 0, 0.02, 0}};
    bodies.push_back(b);
  }
  return bodies;
}

}  // namespace kreisel::test
