#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <vector>

#include <dynamics/tree/workspace.hpp>

namespace kreisel::detail {

/// Computes the mass matrix by composite bodies: each joint accelerates all links outward of it as
/// one rigid body. Needs the inertias in w and replaces them by the composite ones.
inline void mass_matrix(const BodyTree& tree, BodyWorkspace& w, Eigen::MatrixXd& result) {
  const std::vector<Link>& links = tree.links();
  const auto parent_pose = [&](const Link& link) -> const LinkPose<>& {
    return w.pose[static_cast<std::size_t>(link.parent)];
  };
  result.setZero(tree.rates(), tree.rates());
  for (const RotorLink& rotor : tree.rotors()) {
    auto j = static_cast<std::size_t>(rotor.link.parent);
    const Vector3<double> e = w.pose[j].R * rotor.link.axis;
    if (!rotor.regulated()) {
      Symmetric3<>& tensor = w.inertia[j].tensor;
      tensor = tensor + square(e, rotor.about);
    }
    result(rotor.link.v, rotor.link.v) = rotor.about;
    const Motor<> P{Vector3<double>::Zero(), rotor.about * e};
    for (; j > 0; j = static_cast<std::size_t>(links[j].parent)) {
      for (int l = 0; l < rate_count(links[j].kind); ++l) {
        const double entry =
            reciprocal(P, direction(links[j], w.pose[j], parent_pose(links[j]), l));
        result(rotor.link.v, links[j].v + l) = entry;
        result(links[j].v + l, rotor.link.v) = entry;
      }
    }
  }
  for (std::size_t i = links.size() - 1; i > 0; --i) {
    const Link& link = links[i];
    const Inertia<>& composite = w.inertia[i];
    for (int k = 0; k < rate_count(link.kind); ++k) {
      Motor<> P = composite * direction(link, w.pose[i], parent_pose(link), k);
      for (std::size_t j = i; j > 0; j = static_cast<std::size_t>(links[j].parent)) {
        const Link& above = links[j];
        for (int l = 0; l < rate_count(above.kind); ++l) {
          const double entry = reciprocal(P, direction(above, w.pose[j], parent_pose(above), l));
          result(link.v + k, above.v + l) = entry;
          result(above.v + l, link.v + k) = entry;
        }
        P = carried(w.pose[j].r, P);
      }
    }
    if (link.parent != 0) {
      Inertia<>& above = w.inertia[static_cast<std::size_t>(link.parent)];
      above = above + shifted(w.pose[i].r, composite);
    }
  }
}

}  // namespace kreisel::detail
