#pragma once

#include <variant>

#include <dynamics/model/dual_numbers.hpp>
#include <dynamics/tree/disturbance.hpp>
#include <dynamics/tree/rotors.hpp>

/// Positions of the bodies of a tree, and the external loads on them.

namespace kreisel::detail {

template <class S = double>
using GuideNow = FrameMotion<Guide, Inertial, S>;

/// The uniform gravity on guide axes; 0 if there is none.
template <class S>
[[nodiscard]] Vector3<S> field(const Gravity& gravity, const GuideNow<S>& guide) {
  if (const auto* on_guide = std::get_if<UniformGravity<Guide>>(&gravity)) {
    return on_guide->g.template cast<S>();
  }
  if (const auto* inertial = std::get_if<UniformGravity<Inertial>>(&gravity)) {
    return transposed_product(guide.X.value.rotation, inertial->g.template cast<S>().eval());
  }
  return Vector3<S>::Zero();
}

/// The motion of the tree's root, the guide, with gravity subtracted: uniform gravity g acts on the
/// bodies like an acceleration -g of the guide.
template <class S>
[[nodiscard]] LinkMotion<S> root(const GuideNow<S>& guide, const Gravity& gravity, bool rests) {
  if (rests) return {Vector3<S>::Zero(), Vector3<S>::Zero(), -field(gravity, guide)};
  return {guide.V.value.resultant, guide.dV.value.resultant,
          guide.origin_acceleration() - field(gravity, guide)};
}

/// Sets the positions in the guide and the relative velocity motors V' of all links.
template <class S>
void set_places(const BodyTree& tree, const S* v, MotionSpace<S>& w) {
  for (std::size_t i = 1; i < tree.links().size(); ++i) {
    const Link& link = tree.links()[i];
    const auto parent = static_cast<std::size_t>(link.parent);
    w.place[i] = place(link, w.pose[i], w.pose[parent], w.place[parent], v);
  }
}

/// The situation of a body, as loads take it. Needs poses and positions in w.
template <class S>
[[nodiscard]] LoadContext<S> situation(const BodyTree& tree, const S& t, const GuideNow<S>& guide,
                                       int body, const MotionSpace<S>& w) {
  const std::size_t link = tree.link(body);
  const auto& [x, V] = w.place[link];
  const Matrix3<S>& R = w.pose[link].R;
  return {t,
          {{R, x}},
          {{transposed_product(R, V.resultant), transposed_product(R, V.moment)}},
          guide,
          {lifted<S>(tree.body(body).inertia.value)}};
}

/// The values of forces in dual numbers.
template <class S>
[[nodiscard]] OutsideForces<double> values(const OutsideForces<S>& forces) {
  OutsideForces<double> result;
  result.joint_force.resize(forces.joint_force.size());
  for (Eigen::Index i = 0; i < result.joint_force.size(); ++i) {
    result.joint_force[i] = forces.joint_force[i].value();
  }
  const auto value = [](const Vector3<S>& v) {
    return Vector3<double>(v[0].value(), v[1].value(), v[2].value());
  };
  for (const auto& [body, P] : forces.on_bodies) {
    result.on_bodies.emplace_back(body, Motor<>{value(P.resultant), value(P.moment)});
  }
  for (const auto& [rope, l] : forces.winches) result.winches.emplace_back(rope, l.value());
  return result;
}

/// Subtracts the loads from the forces in w, which the joints transmit.
template <class S>
void take_off_loads(const BodyTree& tree, const S& t, const GuideNow<S>& guide, const S* v,
                    MotionSpace<S>& w) {
  if (tree.loaded().empty()) return;
  set_places(tree, v, w);
  for (const int body : tree.loaded()) {
    const std::size_t link = tree.link(body);
    if (is_rotor(tree, link)) set_place_without_angle(tree, link, v, w);
    const LoadContext<S> s = situation(tree, t, guide, body, w);
    for (const BodyLoad& load : tree.body(body).loads) {
      const Motor<S> P = load(s).value;
      w.force[link] -= Motor<S>{w.pose[link].R * P.resultant, w.pose[link].R * P.moment};
    }
    if (is_rotor(tree, link)) {
      w.force[carrier(rotor(tree, link))] += carried(w.pose[link].r, w.force[link]);
    }
  }
}

}  // namespace kreisel::detail
