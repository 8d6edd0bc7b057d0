#pragma once

#include <dynamics/tree/description.hpp>
#include <dynamics/tree/joint/type.hpp>
#include <motor/static_zero.hpp>

namespace kreisel {

namespace detail {

/// One motion of a body's joint. The last link of a joint has the body's inertia, those before it
/// have none. Link 0 is the guide.
struct Link {
  LinkKind kind = LinkKind::fixed;
  JointRule rule = JointRule::forces;
  int parent = 0;
  int body = -1;  ///< to which it belongs; -1 for the guide
  int q = 0;      ///< index of the first coordinate; v: of the first rate
  int v = 0;
  int factor = 0;  ///< of spherical and free links: index of the workspace's factors
  Vector3<double> position = Vector3<double>::Zero();  ///< on the parent's axes, as `axis` is
  Vector3<double> axis = Vector3<double>::Zero();
  double pitch = 0;  ///< displacement per unit of the coordinate: prismatic 1, screw its pitch
  /// Rotation from body to parent at the coordinate q:  still + cos(q) cosine + sin(q) sine. Only
  /// `still` if the link does not rotate by a single angle.
  Matrix3<double> still = Matrix3<double>::Identity();
  Matrix3<double> cosine = Matrix3<double>::Zero();
  Matrix3<double> sine = Matrix3<double>::Zero();
  Inertia<double> inertia = {};  ///< with the rotors that are welded to it

  [[nodiscard]] bool has_one_rate() const {
    return kind == LinkKind::revolute || kind == LinkKind::prismatic || kind == LinkKind::screw;
  }
  [[nodiscard]] bool turns_by_angle() const {
    return kind == LinkKind::revolute || kind == LinkKind::screw;
  }
  [[nodiscard]] bool moved_by_forces() const {
    return rule == JointRule::forces && kind != LinkKind::fixed;
  }
  [[nodiscard]] bool moves() const { return rule != JointRule::held && kind != LinkKind::fixed; }
};

/// A rotor. It is stored beside the links, and no pass over the tree visits it.
struct RotorLink {
  Link link = {};  ///< as of any revolute joint, for output; link.parent is the carrier
  RotorMode mode = RotorMode::free;
  double mass = 0;
  double first_moment = 0;  ///< along the axis
  double about = 0;         ///< C, the moment of inertia about the axis
  double across = 0;        ///< A, about any normal axis through the origin

  [[nodiscard]] bool regulated() const { return mode == RotorMode::regulated; }

  /// The inertia on axes on which the rotor's axis is e, with the given moment of inertia about it.
  [[nodiscard]] Inertia<> inertia(const Vector3<double>& e, double moment) const {
    return {mass, first_moment * e,
            Symmetric3<>{across, across, across} + square(e, moment - across)};
  }
};

[[nodiscard]] inline int coordinate_count(LinkKind kind) {
  switch (kind) {
    case LinkKind::fixed: return 0;
    case LinkKind::spherical: return 4;
    case LinkKind::free: return 7;
    default: return 1;
  }
}

[[nodiscard]] inline int rate_count(LinkKind kind) {
  switch (kind) {
    case LinkKind::fixed: return 0;
    case LinkKind::spherical: return 3;
    case LinkKind::free: return 6;
    default: return 1;
  }
}

}  // namespace detail

}  // namespace kreisel
