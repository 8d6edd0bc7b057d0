#include <algorithm>
#include <cstddef>
#include <string>
#include <variant>
#include <vector>

#include <dynamics/control/actuator.hpp>
#include <dynamics/tree/joint/list.hpp>
#include <motor/error.hpp>

namespace kreisel {

namespace {

void append(std::vector<Actuator> more, std::vector<Actuator>& to) {
  to.insert(to.end(), more.begin(), more.end());
}

/// The end of a message, why no force drives the joint of a body.
std::string obstacle_to_driving(const BodyDescription& body) {
  if (body.rotor && body.rotor->mode != RotorMode::torque) {
    return "the rotor '" + body.name +
           "', whose torque is not free: give the rotor the mode torque";
  }
  const bool is_fixed = joint_type(body.joint.kind).rate_count() == 0;
  return "the joint of '" + body.name +
         (is_fixed ? "', which is fixed" : "', whose motion is prescribed");
}

/// The actuators for which an entry of Controller::drives stands; empty if none has this name.
std::vector<Actuator> named(const Controller& controller, const std::string& word,
                            const BodyTree& tree) {
  for (int body = 0; body < static_cast<int>(tree.bodies().size()); ++body) {
    const std::string& name = tree.body(body).name;
    if (word != name && word != "joint." + name) continue;
    std::vector<Actuator> of_joint = joint_actuators(tree, body);
    if (!of_joint.empty()) return of_joint;
    throw InvalidInput("controller '" + controller.name + "': it drives " +
                       obstacle_to_driving(tree.body(body)));
  }
  for (const Actuator& one : actuators(tree)) {
    const bool is_winch = std::holds_alternative<Actuator::Winch>(one.kind);
    if (word == one.name || (is_winch && word == short_name(one))) return {one};
  }
  return {};
}

}  // namespace

std::string short_name(const Actuator& actuator) {
  return actuator.name.substr(actuator.name.find('.') + 1);
}

std::vector<Actuator> joint_actuators(const BodyTree& tree, int body) {
  const BodyDescription& of = tree.body(body);
  const bool is_given = of.rotor && of.rotor->mode != RotorMode::torque;
  if (of.rule != JointRule::forces || is_given) return {};
  const JointType& type = joint_type(of.joint.kind);
  const int first = tree.place(body).v;
  std::vector<Actuator> result;
  for (const JointQuantity& quantity : type.rates) {
    for (int i = 0; i < quantity.count(); ++i) {
      const int k = static_cast<int>(result.size());
      std::string name = "joint." + of.name;
      if (type.rate_count() > 1) name.append(".").append(std::to_string(k + 1));
      result.push_back(
          {name, quantity.unit == "m/s" ? "N" : "N m", Actuator::JointForce{first + k}});
    }
  }
  return result;
}

std::vector<Actuator> load_actuators(const BodyTree& tree, int body) {
  if (tree.body(body).rotor) return {};
  std::vector<Actuator> result;
  for (int k = 0; k < 6; ++k) {
    Motor<> unit;
    (k < 3 ? unit.resultant : unit.moment)[k % 3] = 1;
    const std::string axis(1, "xyz"[k % 3]);
    const std::string what = k < 3 ? ".force." : ".torque.";
    std::string name = "load.";
    name.append(tree.body(body).name).append(what).append(axis);
    result.push_back({name, k < 3 ? "N" : "N m", Actuator::BodyForce{body, unit}});
  }
  return result;
}

std::vector<Actuator> winches(const BodyTree& tree) {
  std::vector<Actuator> result;
  for (std::size_t k = 0; k < tree.elements().size(); ++k) {
    const auto* const rope = std::get_if<RopeElement>(&tree.elements()[k]);
    if (rope == nullptr) continue;
    result.push_back({"winch." + rope->name, "m", Actuator::Winch{static_cast<int>(k)}});
  }
  return result;
}

std::vector<Actuator> actuators(const BodyTree& tree) {
  std::vector<Actuator> result;
  const auto count = static_cast<int>(tree.bodies().size());
  for (int body = 0; body < count; ++body) append(joint_actuators(tree, body), result);
  for (int body = 0; body < count; ++body) append(load_actuators(tree, body), result);
  append(winches(tree), result);
  return result;
}

std::vector<Actuator> actuators(const Controller& controller, const BodyTree& tree) {
  std::vector<Actuator> result;
  for (const std::string& word : controller.drives) {
    const std::vector<Actuator> more = named(controller, word, tree);
    if (more.empty()) {
      throw InvalidInput("controller '" + controller.name + "': it drives '" + word +
                         "', but there is no such body, joint, load or rope");
    }
    for (const Actuator& one : more) {
      const auto is_it = [&one](const Actuator& other) { return other.name == one.name; };
      if (std::none_of(result.begin(), result.end(), is_it)) continue;
      throw InvalidInput("controller '" + controller.name + "': it drives '" + word + "' twice");
    }
    append(more, result);
  }
  return result;
}

}  // namespace kreisel
