#pragma once

#include <string>
#include <vector>

#include <dynamics/tree/joint/list.hpp>
#include <dynamics/tree/tree.hpp>

namespace kreisel {

/// The positions in a BodySystem's state at which a quaternion begins.
[[nodiscard]] inline std::vector<int> quaternions(const BodyTree& tree) {
  std::vector<int> positions;
  for (const detail::Link& link : tree.links()) {
    if (detail::coordinate_count(link.kind) >= 4) positions.push_back(link.q);
  }
  return positions;
}

/// The name of coordinate k of a joint, after a blank; empty if the joint has only one. Coordinates of one
/// quantity are numbered, others have the names of their columns.
[[nodiscard]] inline std::string direction_name(const JointType& type, int k) {
  if (type.coordinate_count() == 1) return "";
  if (type.coordinates.size() == 1) return " " + std::to_string(k + 1);
  for (const JointQuantity& quantity : type.coordinates) {
    if (k < quantity.count()) return " " + quantity.columns[static_cast<std::size_t>(k)];
    k -= quantity.count();
  }
  return "";
}

/// The names of the directions in which the state can move (study/tangent.hpp), from the bodies'
/// names. Examples: "rotor" and "rotor'" for an angle and its rate, "root about x" and "root' about
/// x" for an attitude. Further: "root x" for a position, "fork 1" and "fork 2" for both angles of a
/// universal joint.
[[nodiscard]] inline std::vector<std::string> direction_names(const BodyTree& tree) {
  const auto rates = static_cast<std::size_t>(tree.rates());
  std::vector<std::string> names(2 * rates);
  const auto name = [&](const detail::Link& link, int k, const std::string& what) {
    const auto at = static_cast<std::size_t>(link.v) + static_cast<std::size_t>(k);
    names[at] = tree.body(link.body).name + what;
    names[rates + at] = tree.body(link.body).name + "'" + what;
  };
  static constexpr const char* axes[] = {"x", "y", "z"};
  for (const detail::Link& link : tree.links()) {
    const int count = detail::rate_count(link.kind);
    if (count == 1) {
      const JointType& type = joint_type(tree.body(link.body).joint.kind);
      name(link, 0, direction_name(type, link.v - tree.place(link.body).v));
    }
    for (int k = 0; k < 3 && count >= 3; ++k) {
      name(link, k, std::string(" about ") + axes[k]);
      if (count == 6) name(link, 3 + k, std::string(" ") + axes[k]);
    }
  }
  for (const detail::RotorLink& rotor : tree.rotors()) name(rotor.link, 0, "");
  return names;
}

/// The directions of a BodySystem's state that are no unknowns in a search for a steady motion.
/// They are given as positions in eta (study/tangent.hpp): first those of the coordinates, then of
/// the rates.
struct RuledDirections {
  std::vector<int> given;      ///< coordinates and rates of drives, locks and regulated rotors
  std::vector<int> held;       ///< given ones, angles of all rotors, and speeds of free ones
  std::vector<int> running;    ///< coordinates that advance uniformly: of rotors and drives
  std::vector<int> attitudes;  ///< positions at which the three angles of an attitude begin

  [[nodiscard]] static RuledDirections of(const BodyTree& tree) {
    RuledDirections ruled;
    const auto note = [rates = tree.rates()](std::vector<int>& positions, int rate) {
      positions.insert(positions.end(), {rate, rates + rate});
    };
    for (const detail::Link& link : tree.links()) {
      const int count = detail::rate_count(link.kind);
      if (count >= 3) ruled.attitudes.push_back(link.v);
      if (link.rule == JointRule::forces) continue;
      for (int v = link.v; v < link.v + count; ++v) {
        note(ruled.given, v);
        note(ruled.held, v);
        ruled.running.push_back(v);
      }
    }
    for (const detail::RotorLink& rotor : tree.rotors()) {
      const int v = rotor.link.v;
      ruled.running.push_back(v);
      if (rotor.regulated()) note(ruled.given, v);
      if (rotor.mode != RotorMode::torque) {
        note(ruled.held, v);
      } else {
        ruled.held.push_back(v);
      }
    }
    return ruled;
  }
};

}  // namespace kreisel
