#pragma once

#include <cstddef>
#include <string>
#include <unordered_map>
#include <vector>

#include <dynamics/tree/link.hpp>
#include <motor/api.hpp>

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
class KREISEL_API BodyTree {
 public:
  explicit BodyTree(std::vector<BodyDescription> bodies);

  [[nodiscard]] const std::vector<BodyDescription>& bodies() const { return bodies_; }
  [[nodiscard]] const std::vector<detail::Link>& links() const { return links_; }
  [[nodiscard]] const std::vector<detail::RotorLink>& rotors() const { return rotors_; }
  [[nodiscard]] const std::vector<JointForce>& forces() const { return forces_; }
  /// The part of a joint force that changes with time.
  struct TimedForce {
    int rate;
    Signal<double> signal;
  };
  [[nodiscard]] const std::vector<TimedForce>& timed_forces() const { return timed_forces_; }
  /// The coordinate that the spring of each joint force follows.
  [[nodiscard]] const std::vector<int>& coordinate_of() const { return coordinate_of_; }
  [[nodiscard]] int coordinates() const { return coordinates_; }
  [[nodiscard]] int rates() const { return rates_; }
  [[nodiscard]] int balls() const { return balls_; }  ///< spherical and free links

  /// Throws : InvalidInput where no body has that name
  [[nodiscard]] int index(const std::string& name) const;

  [[nodiscard]] const BodyDescription& body(int i) const {
    return bodies_[static_cast<std::size_t>(i)];
  }

  /// The bodies that have loads.
  [[nodiscard]] const std::vector<int>& loaded() const { return loaded_; }

  /// Whether there are loads or joint forces that change with time.
  [[nodiscard]] bool is_acted_on() const { return is_acted_on_; }

  /// Links and, after them, rotors: for how many things a workspace has room.
  [[nodiscard]] std::size_t slots() const { return links_.size() + rotors_.size(); }
  [[nodiscard]] std::size_t rotor_slot(std::size_t rotor) const { return links_.size() + rotor; }

  /// The link, or the slot of the rotor, that is a body.
  [[nodiscard]] std::size_t link(int body) const {
    return last_link_[static_cast<std::size_t>(body)];
  }

  [[nodiscard]] JointPlace place(int body) const;

  /// Components of the coordinates, then of the rates, that share unit and size.
  [[nodiscard]] std::vector<int> blocks() const;

 private:
  void check_parent(int body) const;
  void append(int body);

  /// The inertia of a rotor goes to its carrier: whole, if its relative rate is given, else without
  /// that about its axis, about which it does not turn along.
  void weld(detail::Link& link);
  void push(detail::Link& link);

  /// Gives a link its coordinates and rates.
  void number(detail::Link& link);

  std::vector<BodyDescription> bodies_;
  std::unordered_map<std::string, int> index_;
  std::vector<detail::Link> links_;
  std::vector<detail::RotorLink> rotors_;
  std::vector<std::size_t> last_link_;
  std::vector<int> loaded_;
  std::vector<JointForce> forces_;
  std::vector<TimedForce> timed_forces_;
  std::vector<int> coordinate_of_;
  std::vector<int> coordinate_blocks_;
  std::vector<int> rate_blocks_;
  int coordinates_ = 0;
  int rates_ = 0;
  int balls_ = 0;
  bool is_acted_on_ = false;
};

}  // namespace kreisel
