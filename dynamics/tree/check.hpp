#pragma once

#include <cmath>
#include <cstddef>
#include <cstdio>
#include <limits>
#include <string>

#include <dynamics/tree/description.hpp>
#include <dynamics/tree/joint/list.hpp>
#include <motor/error.hpp>
#include <motor/static_zero.hpp>

/// Checks of a single body's description.

namespace kreisel::detail {

[[noreturn]] inline void refuse_body(const std::string& name, const std::string& why) {
  throw InvalidInput("body '" + name + "': " + why);
}

[[noreturn]] inline void refuse_rotor(const std::string& name, const std::string& why) {
  refuse_body(name, "is no rotor: " + why + "; leave `rotor` out and it is an ordinary body");
}

/// A number formatted for a message.
[[nodiscard]] inline std::string digits(double number) {
  char text[32];
  std::snprintf(text, sizeof text, "%.10g", number);
  return text;
}

[[nodiscard]] inline bool is_finite(const Vector3<double>& a) {
  const Vector3<double> none = a - a;
  return none.x() == 0 && none.y() == 0 && none.z() == 0;
}

[[nodiscard]] inline double length(const Vector3<double>& a) { return std::sqrt(dot(a, a)); }

[[nodiscard]] inline Vector3<double> normalized(const Vector3<double>& a) { return a / length(a); }

[[nodiscard]] inline Vector3<double> axis_on_body(const kreisel::Joint& joint) {
  return transposed_product(Rotation<double>::from(joint.orientation).matrix(),
                            normalized(joint.axis));
}

inline void check_axis(const BodyDescription& b, const Vector3<double>& axis, const char* which) {
  if (!is_finite(axis)) refuse_body(b.name, std::string(which) + " is not finite");
  if (!(length(axis) > 0)) refuse_body(b.name, std::string(which) + " is 0 and has no direction");
}

[[nodiscard]] inline bool has_second_axis(const kreisel::Joint& joint) {
  const JointType::Axis need = joint_type(joint.kind).second_axis;
  return need == JointType::Axis::required ||
         (need == JointType::Axis::optional && joint.second_axis != Vector3<double>::Zero());
}

inline void check_joint(const BodyDescription& b) {
  const kreisel::Joint& joint = b.joint;
  const JointType& type = joint_type(joint.kind);
  if (type.axis == JointType::Axis::required) check_axis(b, joint.axis, "the axis of its joint");
  if (has_second_axis(joint)) {
    check_axis(b, joint.second_axis, "the second axis of its joint");
    const double sine = length(cross(normalized(joint.axis), normalized(joint.second_axis)));
    if (!(sine > 1e-12)) {
      refuse_body(b.name, "both axes of its " + type.name + " joint are parallel");
    }
  }
  if (type.has_pitch && !(std::isfinite(joint.pitch) && joint.pitch != 0)) {
    refuse_body(b.name, "the pitch of its " + type.name + " joint must be finite and not 0");
  }
  if (!is_finite(joint.position)) {
    refuse_body(b.name, "the position of its joint is not finite");
  }
  const Eigen::Quaterniond& q = joint.orientation;
  const double norm2 = q.x() * q.x() + q.y() * q.y() + q.z() * q.z() + q.w() * q.w();
  if (!(norm2 > 0 && norm2 - norm2 == 0)) {
    refuse_body(b.name, "the orientation of its joint is no quaternion of finite norm");
  }
}

inline void check_forces(const BodyDescription& b) {
  const JointType& type = joint_type(b.joint.kind);
  const auto rates = static_cast<std::size_t>(type.rate_count());
  if (!b.forces.empty() && b.forces.size() != rates) {
    refuse_body(b.name, std::to_string(b.forces.size()) + " joint forces for a joint of " +
                            std::to_string(rates) + " degrees of freedom");
  }
  for (const JointForce& force : b.forces) {
    for (const double x : {force.stiffness, force.rest, force.damping, force.constant}) {
      if (x - x != 0) refuse_body(b.name, "a number of its joint forces is not finite");
    }
    if (type.has_attitude() && force.stiffness != 0) {
      refuse_body(b.name,
                  "a spring needs a single coordinate, which a spherical or free joint has not; "
                  "take a load");
    }
  }
  if (b.rule == JointRule::driven && !type.can_be_driven()) {
    refuse_body(b.name, "only a revolute, prismatic or screw joint can be driven");
  }
  if (b.acceleration && b.rule != JointRule::driven) {
    refuse_body(b.name, "an acceleration is given, but no drive");
  }
}

/// Checks that a body is balanced and symmetric about the axis of its joint, as a rotor must be.
inline void check_symmetry(const BodyDescription& b) {
  constexpr double tolerance = 32 * std::numeric_limits<double>::epsilon();
  const Inertia<>& T = b.inertia.value;
  const Symmetric3<>& t = T.tensor;
  const Vector3<double> e = axis_on_body(b.joint);
  const double trace = t.xx + t.yy + t.zz;
  const double about = dot(e, t * e);
  if (!(about > tolerance * trace)) {
    refuse_rotor(b.name, "it has no moment of inertia about its axis");
  }
  const double off_axis = length(cross(T.first_moment, e));
  if (off_axis > tolerance * std::sqrt(T.mass * trace)) {
    refuse_rotor(b.name, "it is unbalanced, its centre of mass lies " + digits(off_axis / T.mass) +
                             " m off the axis");
  }
  const double across = (trace - about) / 2;
  const Symmetric3<> off = t - (Symmetric3<>{across, across, across} + square(e, about - across));
  const double norm = std::sqrt(off.xx * off.xx + off.yy * off.yy + off.zz * off.zz +
                                2 * (off.xy * off.xy + off.xz * off.xz + off.yz * off.yz));
  if (norm > tolerance * trace) {
    refuse_rotor(b.name,
                 "its tensor is not symmetric about its axis, by " + digits(norm) + " kg m^2");
  }
}

inline void check_rotor(const BodyDescription& b) {
  const Rotor& rotor = *b.rotor;
  const auto refuse = [&b](const char* why) { refuse_rotor(b.name, why); };
  if (b.joint.kind != JointKind::revolute) refuse("it has no revolute joint");
  if (b.rule != JointRule::forces) refuse("its joint is held or driven besides");
  if (!std::isfinite(rotor.torque)) refuse("its torque is not finite");
  if (rotor.torque != 0 && rotor.mode != RotorMode::torque) {
    refuse("a torque is given, but not the mode torque");
  }
  if (rotor.acceleration && rotor.mode != RotorMode::regulated) {
    refuse("an acceleration is given, but it is not regulated");
  }
  for (const JointForce& f : b.forces) {
    if (f.stiffness != 0) refuse("a spring turns it by its angle");
    if (rotor.mode == RotorMode::free && (f.damping != 0 || f.constant != 0 || f.in_time)) {
      refuse("a joint force changes the momentum of a free one, take the mode torque");
    }
  }
  for (const BodyLoad& load : b.loads) {
    if (!load.ignores_spin()) refuse("it has a load that may depend on its angle or spin");
  }
  check_symmetry(b);
}

inline void check_numbers(const BodyDescription& b) {
  check_joint(b);
  check(b.inertia.value, Mass::zero_allowed, "body '" + b.name + "'");
  check_forces(b);
  if (b.rotor) check_rotor(b);
}

}  // namespace kreisel::detail
