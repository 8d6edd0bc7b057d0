#pragma once

#include <array>
#include <string>

namespace kreisel {

/// An elastic coupling or gear between two joints with one coordinate each. The joint forces are
///
///   Q_a = -(k (q_a - ratio q_b) + d (q_a' - ratio q_b')),   Q_b = -ratio Q_a
///
/// Each joint force acts between the joint's body and its parent, so momentum is conserved.
///
/// Units  : joint force of a per unit of q_a, and times s; q_a per unit of q_b
struct CouplingElement {
  static constexpr const char* kind = "coupling";

  std::string name = {};
  std::array<std::string, 2> joints = {};  ///< the bodies whose joints are a and b
  double ratio = 1;
  double stiffness = 0;
  double damping = 0;

  /// Q_a for the displacement q_a - ratio q_b and its rate.
  template <class S>
  [[nodiscard]] S force(const S& displacement, const S& rate) const {
    return -(stiffness * displacement + damping * rate);
  }

  [[nodiscard]] double potential(double displacement) const {
    return stiffness * displacement * displacement / 2;
  }

  [[nodiscard]] bool keeps_energy() const { return damping == 0; }
};

}  // namespace kreisel
