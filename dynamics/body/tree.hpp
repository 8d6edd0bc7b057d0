#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include <dynamics/body/check.hpp>
#include <dynamics/body/link.hpp>
#include <motor/displacement.hpp>
#include <motor/error.hpp>

namespace kreisel {

/// Where the coordinates and the rates of a body's joint lie.
struct JointPlace {
  int q;
  int q_count;
  int v;
  int v_count;
};

/// The structure of a system of bodies: checked descriptions, made into links.
///
/// Throws : InvalidInput naming body and reason: no, reserved or repeated name; parent unknown,
///          later in the list or closing a loop; inertia that no mass can have; axis 0, parallel
///          axes of a universal joint; forces that do not fit the joint; a number that is not
///          finite; a rotor that is none
class BodyTree {
 public:
  explicit BodyTree(std::vector<BodyDescription> bodies) : bodies_(std::move(bodies)) {
    links_.emplace_back();
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      const std::string& name = bodies_[i].name;
      if (name.empty() || name == "guide") {
        detail::refuse_body(name, "number " + std::to_string(i + 1) +
                                      " of the list needs a name other than 'guide'");
      }
      if (!index_.emplace(name, static_cast<int>(i)).second) {
        detail::refuse_body(name, "the name is used twice; a body has one joint to one parent");
      }
    }
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      check_parent(static_cast<int>(i));
      detail::check_numbers(bodies_[i]);
      append(static_cast<int>(i));
    }
    for (std::size_t k = 0; k < rotors_.size(); ++k) {
      last_link_[static_cast<std::size_t>(rotors_[k].link.body)] = rotor_slot(k);
    }
  }

  [[nodiscard]] const std::vector<BodyDescription>& bodies() const { return bodies_; }
  [[nodiscard]] const std::vector<detail::Link>& links() const { return links_; }
  [[nodiscard]] const std::vector<detail::RotorLink>& rotors() const { return rotors_; }
  [[nodiscard]] const std::vector<JointForce>& forces() const { return forces_; }
  /// The coordinate that the spring of each joint force follows.
  [[nodiscard]] const std::vector<int>& coordinate_of() const { return coordinate_of_; }
  [[nodiscard]] int coordinates() const { return coordinates_; }
  [[nodiscard]] int rates() const { return rates_; }
  [[nodiscard]] int balls() const { return balls_; }  ///< spherical and free links

  /// Throws : InvalidInput where no body has that name
  [[nodiscard]] int index(const std::string& name) const {
    const auto found = index_.find(name);
    if (found == index_.end()) throw InvalidInput("body '" + name + "' does not exist");
    return found->second;
  }

  [[nodiscard]] const BodyDescription& body(int i) const {
    return bodies_[static_cast<std::size_t>(i)];
  }

  /// The bodies that have loads.
  [[nodiscard]] const std::vector<int>& loaded() const { return loaded_; }

  /// Links and, after them, rotors: for how many things a workspace has room.
  [[nodiscard]] std::size_t slots() const { return links_.size() + rotors_.size(); }
  [[nodiscard]] std::size_t rotor_slot(std::size_t rotor) const { return links_.size() + rotor; }

  /// The link, or the slot of the rotor, that is a body.
  [[nodiscard]] std::size_t link(int body) const {
    return last_link_[static_cast<std::size_t>(body)];
  }

  [[nodiscard]] JointPlace place(int body) const {
    const std::size_t slot = link(body);
    const detail::Link& last =
        slot < links_.size() ? links_[slot] : rotors_[slot - links_.size()].link;
    const bool universal = this->body(body).joint.kind == JointKind::universal;
    if (universal) return {last.q - 1, 2, last.v - 1, 2};
    return {last.q, detail::coordinate_count(last.kind), last.v, detail::rate_count(last.kind)};
  }

  /// Components of the coordinates, then of the rates, that share unit and size.
  [[nodiscard]] std::vector<int> blocks() const {
    std::vector<int> blocks = coordinate_blocks_;
    blocks.insert(blocks.end(), rate_blocks_.begin(), rate_blocks_.end());
    return blocks;
  }

 private:
  void check_parent(int body) const {
    const std::string& name = this->body(body).name;
    const std::string& parent = this->body(body).parent;
    if (parent == "guide") return;
    const auto found = index_.find(parent);
    if (found == index_.end()) detail::refuse_body(name, "its parent '" + parent + "' is unknown");
    if (this->body(found->second).rotor) {
      detail::refuse_body(name, "its parent '" + parent + "' is a rotor, which can carry nothing");
    }
    if (found->second < body) return;
    // Up from the parent, to tell a loop from a list in the wrong order.
    std::string path = name + " -> " + parent;
    auto above = found;
    for (std::size_t step = 0; step < bodies_.size(); ++step) {
      if (above->second == body) {
        detail::refuse_body(name, "closed loop " + path + "; only trees are computed");
      }
      const std::string& next = this->body(above->second).parent;
      above = index_.find(next);
      if (above == index_.end()) break;
      path += " -> " + next;
    }
    detail::refuse_body(name, "its parent '" + parent + "' comes later; parents come first");
  }

  void append(int body) {
    using detail::LinkKind;
    const BodyDescription& b = this->body(body);
    detail::Link link;
    link.body = body;
    link.rule = b.rule;
    link.position = b.joint.position;
    link.parent = b.parent == "guide" ? 0 : static_cast<int>(this->link(index_.at(b.parent)));
    link.still = detail::Turn<double>::from(b.joint.orientation).matrix();
    switch (b.joint.kind) {
      case JointKind::fixed: break;
      case JointKind::revolute: detail::turn_about(link, b.joint.axis); break;
      case JointKind::prismatic:
        link.kind = LinkKind::prismatic;
        link.axis = detail::normalized(b.joint.axis);
        break;
      case JointKind::universal: {
        detail::Link cross = link;
        cross.still = Matrix3<double>::Identity();
        detail::turn_about(cross, b.joint.axis);
        cross.is_cross = true;
        push(cross);
        link.position = Vector3<double>::Zero();
        link.parent = static_cast<int>(links_.size()) - 1;
        detail::turn_about(link, b.joint.second_axis);
        break;
      }
      case JointKind::spherical: link.kind = LinkKind::spherical; break;
      case JointKind::free: link.kind = LinkKind::free; break;
    }
    if (link.kind == LinkKind::spherical || link.kind == LinkKind::free) link.factor = balls_++;
    if (b.rotor) {
      weld(link);
    } else {
      link.inertia = b.inertia.value;
      push(link);
    }
    last_link_.push_back(links_.size() - 1);
    if (!b.loads.empty()) loaded_.push_back(body);
    const std::size_t before = forces_.size();
    forces_.resize(static_cast<std::size_t>(rates_));
    std::copy(b.forces.begin(), b.forces.end(),
              forces_.begin() + static_cast<std::ptrdiff_t>(before));
    if (b.rotor) forces_.back().constant += b.rotor->torque;
  }

  /// The inertia of a rotor goes to its carrier: whole, if its relative rate is given, else without
  /// that about its axis, about which it does not turn along.
  void weld(detail::Link& link) {
    const BodyDescription& b = body(link.body);
    number(link);
    detail::RotorLink rotor;
    rotor.link = link;
    rotor.mode = b.rotor->mode;
    const Inertia<>& T = b.inertia.value;
    const Vector3<double> e = detail::axis_on_body(b.joint);
    rotor.mass = T.mass;
    rotor.first_moment = detail::dot(T.first_moment, e);
    rotor.about = detail::dot(e, T.tensor * e);
    rotor.across = (T.tensor.xx + T.tensor.yy + T.tensor.zz - rotor.about) / 2;
    Inertia<>& carrier = links_[static_cast<std::size_t>(link.parent)].inertia;
    const Pose<> place{Matrix3<double>::Identity(), link.position};
    carrier = carrier + place * rotor.inertia(link.axis, rotor.regulated() ? rotor.about : 0);
    rotors_.push_back(rotor);
  }

  void push(detail::Link& link) {
    number(link);
    links_.push_back(link);
  }

  /// Gives a link its coordinates and rates.
  void number(detail::Link& link) {
    using detail::LinkKind;
    link.q = coordinates_;
    link.v = rates_;
    coordinates_ += detail::coordinate_count(link.kind);
    rates_ += detail::rate_count(link.kind);
    coordinate_of_.resize(static_cast<std::size_t>(rates_), link.q);
    const auto add_blocks = [&link](std::vector<int>& blocks, int ball) {
      if (link.kind == LinkKind::revolute || link.kind == LinkKind::prismatic) blocks.push_back(1);
      if (link.kind == LinkKind::spherical || link.kind == LinkKind::free) blocks.push_back(ball);
      if (link.kind == LinkKind::free) blocks.push_back(3);
    };
    add_blocks(coordinate_blocks_, 4);
    add_blocks(rate_blocks_, 3);
  }

  std::vector<BodyDescription> bodies_;
  std::unordered_map<std::string, int> index_;
  std::vector<detail::Link> links_;
  std::vector<detail::RotorLink> rotors_;
  std::vector<std::size_t> last_link_;
  std::vector<int> loaded_;
  std::vector<JointForce> forces_;
  std::vector<int> coordinate_of_;
  std::vector<int> coordinate_blocks_;
  std::vector<int> rate_blocks_;
  int coordinates_ = 0;
  int rates_ = 0;
  int balls_ = 0;
};

}  // namespace kreisel
