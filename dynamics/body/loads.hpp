#pragma once

#include <variant>

#include <dynamics/body/workspace.hpp>

/// Where the bodies of a tree are, and what acts on them from outside.

namespace kreisel::detail {

using GuideNow = FrameMotion<Guide, Inertial>;

/// The uniform field of gravity on guide axes.
[[nodiscard]] inline Vector3<double> field(const Gravity& gravity, const GuideNow& guide) {
  if (const auto* on_guide = std::get_if<UniformGravity<Guide>>(&gravity)) return on_guide->g;
  if (const auto* inertial = std::get_if<UniformGravity<Inertial>>(&gravity)) {
    return guide.X.value.rotation.transpose() * inertial->g;
  }
  return Vector3<double>::Zero();
}

/// Places in the guide and velocity motors V' against it.
inline void set_places(const BodyTree& tree, const double* v, BodyWorkspace& w) {
  for (std::size_t i = 1; i < tree.links().size(); ++i) {
    const Link& link = tree.links()[i];
    const auto parent = static_cast<std::size_t>(link.parent);
    w.place[i] = place(link, w.pose[i], w.pose[parent], w.place[parent], v);
  }
}

/// Needs poses and places in w.
[[nodiscard]] inline Situation<> situation(const BodyTree& tree, double t, const GuideNow& guide,
                                           int body, const BodyWorkspace& w) {
  const std::size_t link = tree.link(body);
  const auto& [x, V] = w.place[link];
  const Matrix3<double>& R = w.pose[link].R;
  return {t,
          {{R, x}},
          {{R.transpose() * V.resultant, R.transpose() * V.moment}},
          guide,
          tree.body(body).inertia};
}

/// Takes the loads off the forces in w, which the joints have to bring up.
inline void take_off_loads(const BodyTree& tree, double t, const GuideNow& guide, const double* v,
                           BodyWorkspace& w) {
  if (tree.loaded().empty()) return;
  set_places(tree, v, w);
  for (const int body : tree.loaded()) {
    const std::size_t link = tree.link(body);
    const Situation<> s = situation(tree, t, guide, body, w);
    for (const BodyLoad& load : tree.body(body).loads) {
      const Motor<> P = load(s).value;
      w.force[link] -= {w.pose[link].R * P.resultant, w.pose[link].R * P.moment};
    }
  }
}

/// The energy of weight and loads of one body.
[[nodiscard]] inline double potential(const Situation<>& s, const Gravity& gravity,
                                      const BodyDescription& body) {
  double sum = 0;
  if (body.inertia.value.mass > 0) {
    if (const auto* g = std::get_if<UniformGravity<Guide>>(&gravity)) sum += g->potential(s);
    if (const auto* g = std::get_if<UniformGravity<Inertial>>(&gravity)) sum += g->potential(s);
  }
  for (const BodyLoad& load : body.loads) sum += load.potential(s);
  return sum;
}

}  // namespace kreisel::detail
