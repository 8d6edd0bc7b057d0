#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include <dynamics/tree/constraint/constraint.hpp>
#include <dynamics/tree/element/element.hpp>
#include <dynamics/tree/link.hpp>
#include <motor/api.hpp>

namespace kreisel {

/// First index and count of the coordinates and the rates of a body's joint.
struct JointPlace {
  int q;
  int q_count;
  int v;
  int v_count;
};

/// The positions of an element's two bodies or joints in a tree.
struct ElementPlace {
  std::array<int, 2> body = {-1, -1};        ///< -1: the guide
  std::array<std::size_t, 2> slot = {0, 0};  ///< of the bodies' last links
  std::array<int, 2> q = {0, 0};             ///< of joints: their coordinates
  std::array<int, 2> v = {0, 0};             ///< and rates
  std::array<bool, 2> moves = {true, true};  ///< false: locked, its rate counts as 0
};

/// The structure of a system of bodies: checked descriptions and the links made from them.
///
/// Throws : InvalidInput, naming body and reason: no, reserved or repeated name; parent unknown,
///          later in the list or closing a loop; physically impossible inertia; axis 0; parallel
///          axes of a joint; forces that do not fit the joint; a number that is not finite; an
///          invalid rotor. Naming element and reason: no or repeated name; unknown body; both ends
///          on one body; an end on a rotor; a joint without or with several coordinates; numbers
///          that are no element. Naming constraint and reason: the same
class KREISEL_API BodyTree {
 public:
  explicit BodyTree(std::vector<BodyDescription> bodies);
  BodyTree(std::vector<BodyDescription> bodies, std::vector<Element> elements,
           const std::vector<Constraint>& constraints = {});
  // Compiled once, in libkreisel: programs would instantiate the vectors' own.
  BodyTree(const BodyTree& other);
  BodyTree(BodyTree&& other) noexcept;
  BodyTree& operator=(const BodyTree& other);
  BodyTree& operator=(BodyTree&& other) noexcept;
  ~BodyTree();

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
  /// A rate whose derivative is prescribed.
  struct Drive {
    int rate;
    TimeFunction acceleration;
  };
  [[nodiscard]] const std::vector<Drive>& drives() const { return drives_; }
  [[nodiscard]] const std::vector<detail::ConstraintLink>& constraints() const {
    return constraints_;
  }
  /// True if there are drives or constraints.
  [[nodiscard]] bool is_prescribed() const { return is_prescribed_; }
  /// The forces between bodies and between joints, and their positions, in the same order.
  [[nodiscard]] const std::vector<Element>& elements() const { return elements_; }
  [[nodiscard]] const std::vector<ElementPlace>& element_places() const { return element_places_; }
  /// The coordinate of each joint force's spring.
  [[nodiscard]] const std::vector<int>& coordinate_of() const { return coordinate_of_; }
  [[nodiscard]] int coordinates() const { return coordinates_; }
  [[nodiscard]] int rates() const { return rates_; }
  [[nodiscard]] int balls() const { return balls_; }  ///< spherical and free links

  /// The index of the body with this name.
  ///
  /// Throws : InvalidInput if there is none
  [[nodiscard]] int index(const std::string& name) const;

  [[nodiscard]] const BodyDescription& body(int i) const {
    return bodies_[static_cast<std::size_t>(i)];
  }

  /// The bodies that have loads.
  [[nodiscard]] const std::vector<int>& loaded() const { return loaded_; }

  /// True if there are loads, elements, or joint forces that change with time.
  [[nodiscard]] bool is_acted_on() const { return is_acted_on_; }

  /// The number of links and rotors: the slots of a workspace, links first.
  [[nodiscard]] std::size_t slots() const { return links_.size() + rotors_.size(); }
  [[nodiscard]] std::size_t rotor_slot(std::size_t rotor) const { return links_.size() + rotor; }

  /// The slot of a body's last link, or of its rotor.
  [[nodiscard]] std::size_t link(int body) const {
    return last_link_[static_cast<std::size_t>(body)];
  }

  [[nodiscard]] JointPlace place(int body) const;

  /// The state with all coordinates and rates 0 and all quaternions 1.
  [[nodiscard]] Eigen::VectorXd rest() const;

  /// Lengths of the blocks of coordinates, then of rates, whose components share unit and size.
  [[nodiscard]] std::vector<int> blocks() const;

 private:
  void check_parent(int body) const;
  void connect(const Element& element);
  /// The body with this name; -1 if there is none.
  [[nodiscard]] int find(const std::string& name) const;
  [[nodiscard]] int body_of_element(const std::string& element, const std::string& body) const;
  void set_joint(const CouplingElement& coupling, std::size_t end, ElementPlace& place) const;
  void append(int body);

  /// Adds a rotor, and its inertia to its carrier's. The moment about its axis is added only if the
  /// relative rate is given: another rotor does not follow the carrier's rotation about this axis.
  void weld(detail::Link& link);
  void push(detail::Link& link);

  /// Gives a link its coordinates and rates.
  void number(detail::Link& link);

  std::vector<BodyDescription> bodies_;
  std::vector<Element> elements_;
  std::vector<ElementPlace> element_places_;
  std::vector<int> by_name_;  ///< bodies in the order of their names
  std::vector<detail::Link> links_;
  std::vector<detail::RotorLink> rotors_;
  std::vector<std::size_t> last_link_;
  std::vector<int> loaded_;
  std::vector<JointForce> forces_;
  std::vector<TimedForce> timed_forces_;
  std::vector<Drive> drives_;
  std::vector<detail::ConstraintLink> constraints_;
  std::vector<int> coordinate_of_;
  std::vector<int> coordinate_blocks_;
  std::vector<int> rate_blocks_;
  int coordinates_ = 0;
  int rates_ = 0;
  int balls_ = 0;
  bool is_acted_on_ = false;
  bool is_prescribed_ = false;
};

}  // namespace kreisel
