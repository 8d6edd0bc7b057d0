#include <algorithm>
#include <cstddef>
#include <numeric>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <dynamics/tree/check.hpp>
#include <dynamics/tree/constraints.hpp>
#include <dynamics/tree/tree.hpp>
#include <motor/displacement.hpp>
#include <motor/error.hpp>

namespace kreisel {

namespace detail {

/// Sets the rotation of a link about its axis by Rodrigues' formula, from its rotation `still` at
/// angle 0:  (a a^t + cos (1 - a a^t) + sin skew(a)) still.
inline void turn_about_axis(Link& link) {
  const Vector3<double>& a = link.axis;
  for (int k = 0; k < 3; ++k) {
    const Vector3<double> o(link.still(0, k), link.still(1, k), link.still(2, k));
    const Vector3<double> along = dot(a, o) * a;
    const Vector3<double> across = o - along;
    const Vector3<double> turned = cross(a, o);
    for (int i = 0; i < 3; ++i) {
      link.still(i, k) = along[i];
      link.cosine(i, k) = across[i];
      link.sine(i, k) = turned[i];
    }
  }
}

/// Gives a link the motion of a part of a joint.
inline void set_motion(Link& link, const JointPart& part) {
  link.kind = part.kind;
  if (dot(part.axis, part.axis) > 0) link.axis = normalized(part.axis);
  link.pitch = part.pitch;
  if (link.turns_by_angle()) turn_about_axis(link);
}

}  // namespace detail

BodyTree::BodyTree(const BodyTree&) = default;
BodyTree::BodyTree(BodyTree&&) noexcept = default;
BodyTree& BodyTree::operator=(const BodyTree&) = default;
BodyTree& BodyTree::operator=(BodyTree&&) noexcept = default;
BodyTree::~BodyTree() = default;

BodyTree::BodyTree(std::vector<BodyDescription> bodies) : BodyTree(std::move(bodies), {}) {}

BodyTree::BodyTree(std::vector<BodyDescription> bodies, std::vector<Element> elements,
                   const std::vector<Constraint>& constraints)
    : bodies_(std::move(bodies)), elements_(std::move(elements)) {
  links_.emplace_back();
  by_name_.resize(bodies_.size());
  std::iota(by_name_.begin(), by_name_.end(), 0);
  std::sort(by_name_.begin(), by_name_.end(),
            [this](int a, int b) { return std::tie(body(a).name, a) < std::tie(body(b).name, b); });
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    const std::string& name = bodies_[i].name;
    if (name.empty() || name == "guide") {
      detail::refuse_body(
          name, "number " + std::to_string(i + 1) + " of the list needs a name other than 'guide'");
    }
    if (find(name) != static_cast<int>(i)) {
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
  for (const Element& element : elements_) connect(element);
  for (const Constraint& constraint : constraints) {
    const auto same = std::find_if(constraints_.begin(), constraints_.end(),
                                   [&](const detail::ConstraintLink& link) {
                                     return link.constraint.name == constraint.name;
                                   });
    if (same != constraints_.end()) {
      throw InvalidInput("constraint '" + constraint.name + "': the name is used twice");
    }
    constraints_.push_back(detail::linked(*this, constraint));
  }
  is_prescribed_ = !drives_.empty() || !constraints_.empty();
}

int BodyTree::find(const std::string& name) const {
  const auto found =
      std::lower_bound(by_name_.begin(), by_name_.end(), name,
                       [this](int i, const std::string& wanted) { return body(i).name < wanted; });
  return found != by_name_.end() && body(*found).name == name ? *found : -1;
}

int BodyTree::index(const std::string& name) const {
  const int found = find(name);
  if (found < 0) throw InvalidInput("body '" + name + "' does not exist");
  return found;
}

Eigen::VectorXd BodyTree::rest() const {
  Eigen::VectorXd y = Eigen::VectorXd::Zero(coordinates_ + rates_);
  for (const detail::Link& link : links_) {
    if (detail::coordinate_count(link.kind) >= 4) y[link.q + 3] = 1;
  }
  return y;
}

JointPlace BodyTree::place(int body) const {
  const std::size_t slot = link(body);
  const detail::Link& last =
      slot < links_.size() ? links_[slot] : rotors_[slot - links_.size()].link;
  const JointType& type = joint_type(this->body(body).joint.kind);
  const int q_count = type.coordinate_count();
  const int v_count = type.rate_count();
  return {last.q + detail::coordinate_count(last.kind) - q_count, q_count,
          last.v + detail::rate_count(last.kind) - v_count, v_count};
}

std::vector<int> BodyTree::blocks() const {
  std::vector<int> blocks = coordinate_blocks_;
  blocks.insert(blocks.end(), rate_blocks_.begin(), rate_blocks_.end());
  return blocks;
}

void BodyTree::check_parent(int body) const {
  const std::string& name = this->body(body).name;
  const std::string& parent = this->body(body).parent;
  if (parent == "guide") return;
  int above = find(parent);
  if (above < 0) detail::refuse_body(name, "its parent '" + parent + "' is unknown");
  if (this->body(above).rotor) {
    detail::refuse_body(name, "its parent '" + parent + "' is a rotor, which can carry nothing");
  }
  if (above < body) return;
  // Follows the parents to distinguish a loop from a list in the wrong order.
  std::string path = name + " -> " + parent;
  for (std::size_t step = 0; step < bodies_.size() && above >= 0; ++step) {
    if (above == body) {
      detail::refuse_body(name, "closed loop " + path +
                                    "; only trees are computed: cut a joint, and hold its bodies "
                                    "by a constraint");
    }
    const std::string& next = this->body(above).parent;
    above = find(next);
    if (above >= 0) path += " -> " + next;
  }
  detail::refuse_body(name, "its parent '" + parent + "' comes later; parents come first");
}

void BodyTree::append(int body) {
  using detail::LinkKind;
  const BodyDescription& b = this->body(body);
  const detail::JointParts parts = joint_type(b.joint.kind).parts(b.joint);
  detail::Link link;
  link.body = body;
  link.rule = b.rule;
  link.position = b.joint.position;
  link.parent = b.parent == "guide" ? 0 : static_cast<int>(this->link(find(b.parent)));
  for (const detail::JointPart* part = parts.begin(); part != &parts.back(); ++part) {
    detail::Link between = link;
    detail::set_motion(between, *part);
    push(between);
    link.position = Vector3<double>::Zero();
    link.parent = static_cast<int>(links_.size()) - 1;
  }
  link.still = detail::Rotation<double>::from(b.joint.orientation).matrix();
  detail::set_motion(link, parts.back());
  if (link.kind == LinkKind::spherical || link.kind == LinkKind::free) link.factor = balls_++;
  if (b.rotor) {
    weld(link);
  } else {
    link.inertia = b.inertia.value;
    push(link);
  }
  last_link_.push_back(links_.size() - 1);
  if (b.acceleration) drives_.push_back({link.v, b.acceleration});
  if (!b.loads.empty()) loaded_.push_back(body);
  const std::size_t before = forces_.size();
  forces_.resize(static_cast<std::size_t>(rates_));
  std::copy(b.forces.begin(), b.forces.end(),
            forces_.begin() + static_cast<std::ptrdiff_t>(before));
  if (b.rotor) forces_.back().constant += b.rotor->torque;
  for (std::size_t k = before; k < forces_.size(); ++k) {
    const auto& signal = forces_[k].in_time;
    if (signal) timed_forces_.push_back({static_cast<int>(k), *signal});
  }
  is_acted_on_ = is_acted_on_ || !b.loads.empty() || !timed_forces_.empty();
}

void BodyTree::weld(detail::Link& link) {
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

void BodyTree::push(detail::Link& link) {
  number(link);
  links_.push_back(link);
}

void BodyTree::number(detail::Link& link) {
  using detail::LinkKind;
  link.q = coordinates_;
  link.v = rates_;
  coordinates_ += detail::coordinate_count(link.kind);
  rates_ += detail::rate_count(link.kind);
  coordinate_of_.resize(static_cast<std::size_t>(rates_), link.q);
  const auto add_blocks = [&link](std::vector<int>& blocks, int ball) {
    if (link.has_one_rate()) blocks.push_back(1);
    if (link.kind == LinkKind::spherical || link.kind == LinkKind::free) blocks.push_back(ball);
    if (link.kind == LinkKind::free) blocks.push_back(3);
  };
  add_blocks(coordinate_blocks_, 4);
  add_blocks(rate_blocks_, 3);
}

}  // namespace kreisel
