#pragma once

#include <string>
#include <variant>
#include <vector>

#include <dynamics/control/controller.hpp>
#include <dynamics/tree/disturbance.hpp>
#include <dynamics/tree/tree.hpp>
#include <motor/api.hpp>
#include <motor/motor.hpp>

namespace kreisel {

/// A number by which a controller acts on a system of bodies. There are forces at the rates of a
/// joint or rotor, components of the force on a body, and lengths of ropes.
///
/// Frame : forces on bodies on the body's axes, about its origin
/// Units : N or N m; m
struct Actuator {
  struct JointForce {
    int rate = 0;
  };
  struct BodyForce {
    int body = 0;
    Motor<> unit = {};  ///< the load if the force is 1
  };
  /// A length that is added to RopeElement::length.
  struct Winch {
    int element = 0;
  };
  /// "joint.BODY" of a joint with one rate, "joint.BODY.2" of one with several, from 1;
  /// "load.BODY.force.x", "load.BODY.torque.x"; "winch.ROPE".
  std::string name = {};
  std::string unit = {};
  std::variant<JointForce, BodyForce, Winch> kind = JointForce{};
};

namespace detail {

/// Makes a rope longer by `length`, and by what other winches pay out.
template <class N>
void pay_out(int rope, const N& length, OutsideForces<N>& forces) {
  for (auto& [of, paid_out] : forces.winches) {
    if (of != rope) continue;
    paid_out += length;
    return;
  }
  forces.winches.emplace_back(rope, length);
}

/// Adds an action of the size u. There is a joint force for each rate.
template <class N>
void add(const Actuator& actuator, const N& u, OutsideForces<N>& forces) {
  if (const auto* const joint = std::get_if<Actuator::JointForce>(&actuator.kind)) {
    forces.joint_force[joint->rate] += u;
    return;
  }
  if (const auto* const winch = std::get_if<Actuator::Winch>(&actuator.kind)) {
    pay_out(winch->element, u, forces);
    return;
  }
  const auto& load = std::get<Actuator::BodyForce>(actuator.kind);
  forces.on_bodies.emplace_back(load.body, Motor<N>{load.unit.resultant.template cast<N>() * u,
                                                    load.unit.moment.template cast<N>() * u});
}

}  // namespace detail

/// The name without "joint.", "load." or "winch.": BODY, BODY.2, BODY.force.x, ROPE.
[[nodiscard]] KREISEL_API std::string short_name(const Actuator& actuator);

/// The joint forces of a body that are free: none if its joint or rotor has a given motion.
[[nodiscard]] KREISEL_API std::vector<Actuator> joint_actuators(const BodyTree& tree, int body);

/// The loads on a body; none on a rotor.
[[nodiscard]] KREISEL_API std::vector<Actuator> load_actuators(const BodyTree& tree, int body);

/// The winches of a system's ropes.
[[nodiscard]] KREISEL_API std::vector<Actuator> winches(const BodyTree& tree);

/// All actuators of a system.
[[nodiscard]] KREISEL_API std::vector<Actuator> actuators(const BodyTree& tree);

/// The actuators of a controller's outputs, in their order.
///
/// Throws : InvalidInput, naming the controller and the reason
[[nodiscard]] KREISEL_API std::vector<Actuator> actuators(const Controller& controller,
                                                          const BodyTree& tree);

}  // namespace kreisel
