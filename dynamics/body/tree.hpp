#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <sstream>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include <dynamics/body/link.hpp>
#include <motor/displacement.hpp>
#include <motor/error.hpp>

namespace kreisel {

namespace detail {

template <class... Words>
[[noreturn]] void refuse_body(const std::string& name, const Words&... words) {
  std::ostringstream text;
  text.precision(10);
  text << "body '" << name << "': ";
  (text << ... << words);
  throw InvalidInput(text.str());
}

[[nodiscard]] inline bool is_finite(const Vector3<double>& a) { return (a - a).isZero(0); }

}  // namespace detail

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
        detail::refuse_body(name, "number ", i + 1, " of the list needs a name other than 'guide'");
      }
      if (!index_.emplace(name, static_cast<int>(i)).second) {
        detail::refuse_body(name, "the name is used twice; a body has one joint to one parent");
      }
    }
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      check_parent(static_cast<int>(i));
      check_numbers(bodies_[i]);
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
    if (found == index_.end()) detail::refuse_body(name, "its parent '", parent, "' is unknown");
    if (this->body(found->second).rotor) {
      detail::refuse_body(name, "its parent '", parent, "' is a rotor, which can carry nothing");
    }
    if (found->second < body) return;
    // Up from the parent, to tell a loop from a list in the wrong order.
    std::string path = name + " -> " + parent;
    auto above = found;
    for (std::size_t step = 0; step < bodies_.size(); ++step) {
      if (above->second == body) {
        detail::refuse_body(name, "closed loop ", path, "; only trees are computed");
      }
      const std::string& next = this->body(above->second).parent;
      above = index_.find(next);
      if (above == index_.end()) break;
      path += " -> " + next;
    }
    detail::refuse_body(name, "its parent '", parent, "' comes later; parents come first");
  }

  static void check_numbers(const BodyDescription& b) {
    const Joint& joint = b.joint;
    const auto check_axis = [&b](const Vector3<double>& axis, const char* which) {
      if (!detail::is_finite(axis)) detail::refuse_body(b.name, which, " is not finite");
      if (!(axis.norm() > 0)) detail::refuse_body(b.name, which, " is 0 and has no direction");
    };
    const bool has_axis = joint.kind == JointKind::revolute || joint.kind == JointKind::prismatic ||
                          joint.kind == JointKind::universal;
    if (has_axis) check_axis(joint.axis, "the axis of its joint");
    if (joint.kind == JointKind::universal) {
      check_axis(joint.second_axis, "the second axis of its joint");
      const double sine = joint.axis.normalized().cross(joint.second_axis.normalized()).norm();
      if (!(sine > 1e-12)) {
        detail::refuse_body(b.name, "both axes of its universal joint are parallel");
      }
    }
    if (!detail::is_finite(joint.position)) {
      detail::refuse_body(b.name, "the position of its joint is not finite");
    }
    const double norm2 = joint.orientation.squaredNorm();
    if (!(norm2 > 0 && norm2 - norm2 == 0)) {
      detail::refuse_body(b.name, "the orientation of its joint is no quaternion of finite norm");
    }
    check(b.inertia.value, Mass::zero_allowed, "body '" + b.name + "'");
    check_forces(b);
    if (b.rotor) check_rotor(b);
  }

  static void check_rotor(const BodyDescription& b) {
    const Rotor& rotor = *b.rotor;
    const auto refuse = [&b](const auto&... words) {
      detail::refuse_body(b.name, "is no rotor: ", words...,
                          "; leave `rotor` out and it is an ordinary body");
    };
    if (b.joint.kind != JointKind::revolute) refuse("it has no revolute joint");
    if (b.rule != JointRule::forces) refuse("its joint is held or driven besides");
    if (!std::isfinite(rotor.torque)) refuse("its torque is not finite");
    if (rotor.torque != 0 && rotor.mode != RotorMode::torque) {
      refuse("a torque is given, but not the mode torque");
    }
    if (rotor.acceleration && rotor.mode != RotorMode::regulated) {
      refuse("an acceleration is given, but it is not regulated");
    }
    for (const JointForce& f : b.forces) {
      if (f.stiffness != 0) refuse("a spring turns it by its angle");
      if (rotor.mode == RotorMode::free && (f.damping != 0 || f.constant != 0)) {
        refuse("a joint force changes the momentum of a free one, take the mode torque");
      }
    }
    for (const BodyLoad& load : b.loads) {
      if (!load.ignores_spin()) refuse("it has a load that may depend on its angle or spin");
    }
    check_symmetry(b, refuse);
  }

  /// Calls refuse where a body is not that of a rotor.
  template <class Refuse>
  static void check_symmetry(const BodyDescription& b, const Refuse& refuse) {
    constexpr double tolerance = 32 * std::numeric_limits<double>::epsilon();
    const Inertia<>& T = b.inertia.value;
    const Vector3<double> e = axis_on_body(b.joint);
    const Matrix3<double> tensor = T.tensor.matrix();
    const double trace = tensor.trace();
    const double about = e.dot(tensor * e);
    if (!(about > tolerance * trace)) refuse("it has no moment of inertia about its axis");
    const double off_axis = T.first_moment.cross(e).norm();
    if (off_axis > tolerance * std::sqrt(T.mass * trace)) {
      refuse("it is unbalanced, its centre of mass lies ", off_axis / T.mass, " m off the axis");
    }
    const double across = (trace - about) / 2;
    const Matrix3<double> symmetric =
        across * Matrix3<double>::Identity() + (about - across) * e * e.transpose();
    const double off = (tensor - symmetric).norm();
    if (off > tolerance * trace) {
      refuse("its tensor is not symmetric about its axis, by ", off, " kg m^2");
    }
  }

  [[nodiscard]] static Vector3<double> axis_on_body(const Joint& joint) {
    return Pose<>::from(joint.orientation).rotation.transpose() * joint.axis.normalized();
  }

  static void check_forces(const BodyDescription& b) {
    const JointKind kind = b.joint.kind;
    const std::size_t rates = kind == JointKind::fixed       ? 0
                              : kind == JointKind::universal ? 2
                              : kind == JointKind::spherical ? 3
                              : kind == JointKind::free      ? 6
                                                             : 1;
    if (!b.forces.empty() && b.forces.size() != rates) {
      detail::refuse_body(b.name, b.forces.size(), " joint forces for a joint of ", rates,
                          " degrees of freedom");
    }
    for (const JointForce& force : b.forces) {
      for (const double x : {force.stiffness, force.rest, force.damping, force.constant}) {
        if (x - x != 0) detail::refuse_body(b.name, "a number of its joint forces is not finite");
      }
      if (rates > 2 && force.stiffness != 0) {
        detail::refuse_body(b.name,
                            "a spring needs a single coordinate, which a spherical or free joint "
                            "has not; take a load");
      }
    }
    if (b.rule == JointRule::constant_rate && kind != JointKind::revolute) {
      detail::refuse_body(b.name, "only a revolute joint can be driven at a constant rate");
    }
  }

  void append(int body) {
    using detail::LinkKind;
    const BodyDescription& b = this->body(body);
    detail::Link link;
    link.body = body;
    link.rule = b.rule;
    link.position = b.joint.position;
    link.parent = b.parent == "guide" ? 0 : static_cast<int>(this->link(index_.at(b.parent)));
    link.still = Pose<>::from(b.joint.orientation).rotation;
    switch (b.joint.kind) {
      case JointKind::fixed: break;
      case JointKind::revolute: turn_about(link, b.joint.axis); break;
      case JointKind::prismatic:
        link.kind = LinkKind::prismatic;
        link.axis = b.joint.axis.normalized();
        break;
      case JointKind::universal: {
        detail::Link cross = link;
        cross.still = Matrix3<double>::Identity();
        turn_about(cross, b.joint.axis);
        cross.is_cross = true;
        push(cross);
        link.position = Vector3<double>::Zero();
        link.parent = static_cast<int>(links_.size()) - 1;
        turn_about(link, b.joint.second_axis);
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
    const Vector3<double> e = axis_on_body(b.joint);
    rotor.mass = T.mass;
    rotor.first_moment = T.first_moment.dot(e);
    rotor.about = e.dot(T.tensor * e);
    rotor.across = (T.tensor.xx + T.tensor.yy + T.tensor.zz - rotor.about) / 2;
    Inertia<>& carrier = links_[static_cast<std::size_t>(link.parent)].inertia;
    const Pose<> place{Matrix3<double>::Identity(), link.position};
    carrier = carrier + place * rotor.inertia(link.axis, rotor.regulated() ? rotor.about : 0);
    rotors_.push_back(rotor);
  }

  /// Rodrigues:  (a a^t + cos (1 - a a^t) + sin skew(a)) still.
  static void turn_about(detail::Link& link, const Vector3<double>& axis) {
    link.kind = detail::LinkKind::revolute;
    link.axis = axis.normalized();
    const Matrix3<double> orientation = link.still;
    const Matrix3<double> along = link.axis * link.axis.transpose();
    link.still = along * orientation;
    link.cosine = orientation - link.still;
    link.sine = skew(link.axis) * orientation;
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
