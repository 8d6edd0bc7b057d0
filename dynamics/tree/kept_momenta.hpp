#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <dynamics/tree/loads.hpp>

/// The momenta that a tree on a guide at rest conserves.

namespace kreisel::detail {

/// A part of a tree that moves as one system: a link whose joint is at rest in the guide, and all
/// links outward of it. Its external forces are loads, gravity, elements and that joint's force.
/// Parts with an element between them are one part with several roots.
struct RootedPart {
  std::vector<std::size_t> roots = {};
  Motor<> momentum = {};  ///< on guide axes about the guide's origin
  bool is_loaded = false;
  bool has_weight = false;
};

/// The number of each link's part; -1 for links that do not move in the guide.
[[nodiscard]] inline std::vector<int> part_of_links(const BodyTree& tree,
                                                    std::vector<RootedPart>& parts) {
  std::vector<int> part(tree.links().size(), -1);
  for (std::size_t i = 1; i < part.size(); ++i) {
    const Link& link = tree.links()[i];
    part[i] = part[static_cast<std::size_t>(link.parent)];
    if (part[i] >= 0 || !link.moves()) continue;
    part[i] = static_cast<int>(parts.size());
    parts.push_back({.roots = {i}});
  }
  return part;
}

/// Joins the parts that have elements or constraints between them, and marks those with one to the
/// guide. A joined part has no roots.
inline void join_parts(const BodyTree& tree, std::vector<int>& part,
                       std::vector<RootedPart>& parts) {
  const auto mark_gear = [&](std::size_t slot) {
    const Link& link = tree.links()[slot];
    if (part[slot] >= 0 && part[static_cast<std::size_t>(link.parent)] < 0) {
      parts[static_cast<std::size_t>(part[slot])].is_loaded = true;
    }
  };
  const auto join = [&](std::size_t first_slot, std::size_t second_slot) {
    const int first = part[first_slot];
    const int second = part[second_slot];
    if (first == second) return;
    if (first < 0 || second < 0) {
      parts[static_cast<std::size_t>(std::max(first, second))].is_loaded = true;
      return;
    }
    RootedPart& whole = parts[static_cast<std::size_t>(first)];
    RootedPart& joined = parts[static_cast<std::size_t>(second)];
    whole.roots.insert(whole.roots.end(), joined.roots.begin(), joined.roots.end());
    whole.is_loaded = whole.is_loaded || joined.is_loaded;
    joined = {};
    std::replace(part.begin(), part.end(), second, first);
  };
  for (std::size_t k = 0; k < tree.elements().size(); ++k) {
    const auto& [first, second] = tree.element_places()[k].slot;
    if (std::holds_alternative<CouplingElement>(tree.elements()[k])) {
      mark_gear(first);
      mark_gear(second);
    } else {
      join(first, second);
    }
  }
  for (const ConstraintLink& link : tree.constraints()) {
    if (link.is_gear()) {
      mark_gear(link.first);
      mark_gear(link.second);
    } else {
      join(link.first, link.second);
    }
  }
}

/// The parts of a tree on a guide at rest, with their momenta. Needs poses and positions in w.
[[nodiscard]] inline std::vector<RootedPart> rooted_parts(const BodyTree& tree, const double* v,
                                                          const BodyWorkspace& w) {
  std::vector<RootedPart> parts;
  std::vector<int> part = part_of_links(tree, parts);
  join_parts(tree, part, parts);
  const auto with = [&](std::size_t link) {
    return part[link] < 0 ? nullptr : &parts[static_cast<std::size_t>(part[link])];
  };
  for (std::size_t i = 1; i < part.size(); ++i) {
    RootedPart* const own = with(i);
    if (own == nullptr) continue;
    const auto& [x, V] = w.place[i];
    own->momentum += carried(x, w.inertia[i] * V);
    own->has_weight = own->has_weight || w.inertia[i].mass != 0;
  }
  for (std::size_t k = 0; k < tree.rotors().size(); ++k) {
    const RotorLink& rotor = tree.rotors()[k];
    RootedPart* const own = with(carrier(rotor));
    if (own == nullptr) continue;
    const Vector3<double>& e = w.pose[tree.rotor_slot(k)].axis;
    const double turn = dot(e, w.place[carrier(rotor)].V.resultant);
    own->momentum.moment += momentum_weight(rotor, v[rotor.link.v], turn) * e;
  }
  for (const int body : tree.loaded()) {
    const std::size_t slot = tree.link(body);
    RootedPart* const own = with(is_rotor(tree, slot) ? carrier(rotor(tree, slot)) : slot);
    if (own != nullptr) own->is_loaded = true;
  }
  std::erase_if(parts, [](const RootedPart& own) { return own.roots.empty(); });
  return parts;
}

/// True if the joint of a link exerts no force along its own rates.
[[nodiscard]] inline bool moves_freely(const BodyTree& tree, const Link& link) {
  if (!link.moved_by_forces()) return false;
  const auto first = tree.forces().begin() + link.v;
  return std::all_of(first, first + rate_count(link.kind), [](const JointForce& f) {
    return f.stiffness == 0 && f.damping == 0 && f.constant == 0 && !f.in_time;
  });
}

/// True if the roots of a part move freely; several of them must be free joints.
[[nodiscard]] inline bool moves_freely(const BodyTree& tree, const RootedPart& part) {
  return std::all_of(part.roots.begin(), part.roots.end(), [&](std::size_t root) {
    const Link& link = tree.links()[root];
    return moves_freely(tree, link) && (part.roots.size() == 1 || link.kind == LinkKind::free);
  });
}

/// The bodies at the roots of a part:  'a' and 'b'
[[nodiscard]] inline std::string names(const BodyTree& tree, const RootedPart& part) {
  std::string result;
  for (const std::size_t root : part.roots) {
    result += result.empty() ? "'" : " and '";
    result += tree.body(tree.links()[root].body).name;
    result += "'";
  }
  return result;
}

using Invariants = std::vector<std::pair<std::string, double>>;

/// Adds the conserved momenta of a part of a tree on a guide at rest, by name. A momentum along a
/// rate of the root joint is conserved if neither that joint nor gravity acts along the rate.
///
///   free       linear momentum, angular momentum about the guide's origin
///   spherical  angular momentum about the joint
///   revolute, first axis of a universal joint   angular momentum about the axis
///   prismatic  linear momentum along the axis
///   screw      angular momentum about the axis and pitch times the linear momentum along it
///
/// With gravity only the linear momentum normal to it and the angular momentum along it. Several
/// roots have conserved momenta only if all are free.
///
/// gravity : on guide axes
/// only    : no other part moves, so names need not include the body
inline void add_kept_momenta(const BodyTree& tree, const RootedPart& part,
                             const Vector3<double>& gravity, bool only, const BodyWorkspace& w,
                             Invariants& result) {
  constexpr double rounding = 1e-15;  // of axes given in decimals
  const Link& link = tree.links()[part.roots.front()];
  if (part.is_loaded || !moves_freely(tree, part)) return;
  const Vector3<double> g = part.has_weight ? gravity : Vector3<double>(Vector3<double>::Zero());
  const double size = std::sqrt(dot(g, g));
  const std::string body = names(tree, part);
  const std::string whose = only ? "" : " of " + body;
  const Vector3<double>& p = part.momentum.resultant;
  Vector3<double> L = part.momentum.moment;
  if (link.kind != LinkKind::free) L -= cross(w.place[part.roots.front()].x, p);
  static constexpr const char* axes[] = {" x", " y", " z"};
  if (link.has_one_rate()) {
    const Vector3<double> axis =
        multiply(w.pose[static_cast<std::size_t>(link.parent)].R, link.axis);
    const Vector3<double> across = cross(axis, g);
    const bool turns = link.turns_by_angle();
    const double about = turns ? std::sqrt(dot(across, across)) : 0;
    const double along = std::abs(link.pitch * dot(axis, g));
    if (about > rounding * size || along > std::abs(link.pitch) * rounding * size) return;
    const char* const name = link.kind == LinkKind::screw ? "momentum along the screw of "
                             : turns                      ? "angular momentum about the axis of "
                                                          : "momentum along the axis of ";
    result.emplace_back(name + body, dot(axis, link.pitch * p) + (turns ? dot(axis, L) : 0));
    return;
  }
  for (int k = 0; k < 3 && link.kind == LinkKind::free; ++k) {
    if (std::abs(g[k]) > rounding * size) continue;
    result.emplace_back(std::string("momentum") + axes[k] + whose, p[k]);
  }
  if (size > 0) {
    result.emplace_back("angular momentum along gravity" + whose, dot(L, g) / size);
    return;
  }
  for (int k = 0; k < 3; ++k) {
    result.emplace_back(std::string("angular momentum") + axes[k] + whose, L[k]);
  }
}

/// Adds all conserved momenta on a guide at rest, by name. Needs poses and positions in w.
inline void add_kept_momenta(const BodyTree& tree, const GuideNow<>& guide, const Gravity& gravity,
                             const double* v, const BodyWorkspace& w, Invariants& result) {
  const std::vector<RootedPart> parts = rooted_parts(tree, v, w);
  for (const RootedPart& part : parts) {
    add_kept_momenta(tree, part, field(gravity, guide), parts.size() == 1, w, result);
  }
}

}  // namespace kreisel::detail
