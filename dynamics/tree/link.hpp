#pragma once

#include <dynamics/tree/description.hpp>
#include <dynamics/tree/joint/type.hpp>
#include <motor/static_zero.hpp>

namespace kreisel {

namespace detail {

/// One motion of a body's joint: the last has the body, those before it nothing. Link 0 is the guide.
struct Link {
  LinkKind kind = LinkKind::fixed;
  JointRule rule = JointRule::forces;
  int parent = 0;
  int body = -1;  ///< to which it belongs; the guide belongs to none
  int q = 0;      ///< where its coordinates and its rates begin
  int v = 0;
  int factor = 0;  ///< of spherical and free links: which of the workspace's factors is its own
  Vector3<double> position = Vector3<double>::Zero();  ///< on the parent's axes, as the axis
  Vector3<double> axis = Vector3<double>::Zero();
  double pitch = 0;  ///< along the axis by one of the coordinate: prismatic 1, screw its pitch
  /// Body to parent at the coordinate q:  still + cos(q) cosine + sin(q) sine. Only `still` where
  /// nothing turns by a single angle.
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

/// A rotor beside the links: no pass over the tree comes across it.
struct RotorLink {
  Link link = {};  ///< as of any revolute joint, for what is read out; link.parent is the carrier
  RotorMode mode = RotorMode::free;
  double mass = 0;
  double first_moment = 0;  ///< along the axis
  double about = 0;         ///< C, the moment of inertia about the axis
  double across = 0;        ///< A, about any other through the origin

  [[nodiscard]] bool regulated() const { return mode == RotorMode::regulated; }

  /// On axes on which the rotor's is e: with the moment of inertia C about it, or with another.
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
