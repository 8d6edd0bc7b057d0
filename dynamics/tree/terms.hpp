#pragma once

#include <algorithm>
#include <string>
#include <variant>

#include <dynamics/model/terms.hpp>
#include <dynamics/tree/tree.hpp>

namespace kreisel::detail {

/// The terms of paper 002 (26) that the forward dynamics of a tree computes or leaves out.
[[nodiscard]] inline Terms equation_terms(const BodyTree& tree, bool guide_rests,
                                          const Gravity& gravity) {
  std::string ruled;
  for (const BodyDescription& body : tree.bodies()) {
    if (body.rule == JointRule::forces) continue;
    ruled += ruled.empty() ? "held or driven: '" : ", '";
    ruled += body.name;
    ruled += "'";
  }
  const auto any_force = [&tree](double JointForce::*number) {
    return std::any_of(tree.forces().begin(), tree.forces().end(),
                       [number](const JointForce& force) { return force.*number != 0; });
  };
  const std::string of_guide = guide_rests ? "the guide rests" : "";
  const bool has_rotors = !tree.rotors().empty();
  const bool has_loads = !tree.loaded().empty();
  const bool has_elements = !tree.elements().empty();
  const bool falls = !std::holds_alternative<std::monostate>(gravity);
  const char* const field = std::holds_alternative<UniformGravity<Inertial>>(gravity)
                                ? UniformGravity<Inertial>::kind
                                : UniformGravity<Guide>::kind;
  Terms list;
  list.add("relative", "T_i V'*_i + V'_i x (T_i V'_i)");
  if (!ruled.empty()) list.add("relative", "accelerations in joints", true, "not where " + ruled);
  list.add("relative", "w x l e of rotors", has_rotors, has_rotors ? "" : "no body is a rotor");
  if (has_rotors) {
    list.add("relative", "angles of rotors", false,
             "balanced and symmetric about their axes, they are not felt");
  }
  list.add("guide", "T_i *F + F x (T_i F)", !guide_rests, of_guide);
  list.add("Coriolis", "V'_i x (T_i F) + F x (T_i V'_i) + T_i (F x V'_i)", !guide_rests, of_guide);
  list.add("load", falls ? field : "uniform gravity", falls, falls ? "" : "none is given");
  const auto in_joints = [&](const char* name, double JointForce::*number) {
    const bool given = any_force(number);
    list.add("load", name, given, given ? "" : "none is given");
  };
  in_joints("springs in joints", &JointForce::stiffness);
  in_joints("dampers in joints", &JointForce::damping);
  in_joints("constant forces in joints", &JointForce::constant);
  if (!tree.timed_forces().empty()) list.add("load", "forces in joints that change with time");
  list.add("load", "loads on bodies", has_loads, has_loads ? "" : "none is given");
  list.add("load", "elements between bodies", has_elements, has_elements ? "" : "none is given");
  const bool is_held = !tree.constraints().empty();
  list.add("constraint", "reactions of constraints", is_held, is_held ? "" : "none is given");
  list.add("load", "R_ij of the joints", false, "eliminated; reactions() has them");
  return list;
}

}  // namespace kreisel::detail
