#include <algorithm>
#include <string>
#include <type_traits>
#include <variant>

#include <dynamics/tree/joint/list.hpp>
#include <dynamics/tree/tree.hpp>

/// The connection of elements to the bodies and joints of their tree.

namespace kreisel {

using detail::refuse_element;

void BodyTree::connect(const Element& element) {
  detail::check_element(element);
  const std::string& own = name(element);
  const auto is_named = [&own](const Element& other) { return name(other) == own; };
  if (std::count_if(elements_.begin(), elements_.end(), is_named) > 1) {
    refuse_element(own, "the name is used twice");
  }
  ElementPlace place;
  const auto put = [&](std::size_t end, int body) {
    place.body[end] = body;
    place.slot[end] = body < 0 ? 0 : link(body);
  };
  std::visit(
      [&](const auto& kind) {
        using Kind = std::decay_t<decltype(kind)>;
        for (const std::size_t end : {std::size_t(0), std::size_t(1)}) {
          if constexpr (detail::joins_joints<Kind>) {
            put(end, body_of_element(own, kind.joints[end]));
            set_joint(kind, end, place);
          } else {
            put(end, body_of_element(own, kind.ends[end].body));
          }
        }
      },
      element);
  element_places_.push_back(place);
  is_acted_on_ = true;
}

int BodyTree::body_of_element(const std::string& element, const std::string& body) const {
  if (body == "guide") return -1;
  const int found = find(body);
  if (found < 0) refuse_element(element, "its body '" + body + "' does not exist");
  if (this->body(found).rotor) {
    refuse_element(element, "'" + body +
                                "' is a rotor, whose angle no force may depend on; leave `rotor` "
                                "out and it is an ordinary body");
  }
  return found;
}

void BodyTree::set_joint(const CouplingElement& coupling, std::size_t end,
                         ElementPlace& place) const {
  const int body = place.body[end];
  if (body < 0) refuse_element(coupling.name, "it couples joints, and the guide has none");
  const BodyDescription& described = this->body(body);
  const JointType& type = joint_type(described.joint.kind);
  if (type.rate_count() != 1) {
    refuse_element(coupling.name, "the joint of '" + described.name + "' is " + type.name +
                                      " and has not exactly one coordinate; take a revolute, "
                                      "prismatic or screw joint");
  }
  const JointPlace joint = this->place(body);
  place.q[end] = joint.q;
  place.v[end] = joint.v;
  place.moves[end] = described.rule != JointRule::held;
}

}  // namespace kreisel
