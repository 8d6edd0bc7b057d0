#include <fmt/core.h>

#include "toml.hpp"

namespace differential {

namespace {

std::string pair_of(const std::string& first, const std::string& second) {
  return fmt::format("[{}, {}]", first, second);
}

/// The names of two bodies or joints.
std::string names_of(const Constraint& c) {
  return pair_of(fmt::format("\"{}\"", body_name(c.bodies[0])),
                 fmt::format("\"{}\"", body_name(c.bodies[1])));
}

void add_rolling(const Constraint& c, Keys& keys) {
  keys.emplace_back("body", fmt::format("\"{}\"", body_name(c.bodies[1])));
  if (c.bodies[0] >= 0) keys.emplace_back("on", fmt::format("\"{}\"", body_name(c.bodies[0])));
  if (!c.at[1].isZero(0)) keys.emplace_back("at", list(c.at[1]));
  keys.emplace_back("radius", text(c.radius));
  if (!c.is_ball) keys.emplace_back("axis", list(c.axis));
  if (c.tube != 0) keys.emplace_back("tube", text(c.tube));
  keys.emplace_back("plane",
                    fmt::format("{{ point = {}, normal = {} }}", list(c.at[0]), list(c.normal)));
}

/// The keys of a constraint between points of two bodies.
void add_joint(const Constraint& c, Keys& keys) {
  keys.emplace_back("between", names_of(c));
  keys.emplace_back("at", pair_of(list(c.at[0]), list(c.at[1])));
  const bool has_axis = c.kind == ConstraintKind::revolute || c.kind == ConstraintKind::prismatic;
  if (has_axis) keys.emplace_back("axis", list(c.axis));
  if (c.kind == ConstraintKind::universal) {
    keys.emplace_back("axis", pair_of(list(c.axis), list(c.second_axis)));
  }
  if (c.kind == ConstraintKind::distance) keys.emplace_back("length", text(c.length));
}

}  // namespace

std::string constraint(const Constraint& c, std::size_t index) {
  static const char* const kinds[] = {"point",    "revolute", "universal", "fixed", "prismatic",
                                      "distance", "gear",     "rolling",   "blade"};
  Keys keys{{"name", fmt::format("\"k{}\"", index)},
            {"kind", fmt::format("\"{}\"", kinds[static_cast<int>(c.kind)])}};
  if (c.kind == ConstraintKind::gear) {
    keys.emplace_back("joints", names_of(c));
    keys.emplace_back("ratio", text(c.ratio));
    if (c.offset != 0) keys.emplace_back("offset", text(c.offset));
  } else if (c.kind == ConstraintKind::rolling) {
    add_rolling(c, keys);
  } else if (c.kind == ConstraintKind::blade) {
    keys.emplace_back("body", fmt::format("\"{}\"", body_name(c.bodies[1])));
    if (!c.at[1].isZero(0)) keys.emplace_back("at", list(c.at[1]));
    keys.emplace_back("direction", list(c.axis));
  } else {
    add_joint(c, keys);
  }
  std::string result = "[[constraint]]\n";
  for (const auto& [key, value] : keys) result += key + " = " + value + "\n";
  return result;
}

std::string constraint(const Body& b, int index) {
  const char* const kind = b.kind == JointKind::spherical ? "point" : nullptr;
  const std::string name = kind ? kind : kreisel::joint_type(b.kind).name;
  std::string result = fmt::format("[[constraint]]\nname = \"c{}\"\nkind = \"{}\"\n", index, name);
  result += "between = [\"" + (b.parent < 0 ? "guide" : body_name(b.parent)) + "\", \"" +
            body_name(index) + "\"]\nat = [" + list(b.position) + ", [0, 0, 0]]\n";
  if (b.kind == JointKind::revolute || b.kind == JointKind::prismatic) {
    result += "axis = " + list(b.axis) + "\n";
  }
  if (b.kind == JointKind::universal) {
    result += "axis = " + pair_of(list(b.axis), list(b.second_axis)) + "\n";
  }
  return result;
}

}  // namespace differential
