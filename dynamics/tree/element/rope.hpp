#pragma once

#include <array>
#include <cmath>
#include <string>

#include <dynamics/signal/signal.hpp>
#include <dynamics/tree/element/motion.hpp>
#include <motor/api.hpp>

namespace kreisel {

/// A rope between two points. It pulls, and never pushes. The force on the second body is
///
///   F = -max(0, k (L - l) + d (L' - l')) e   if L > l, else 0
///
/// L is the distance of its ends, e the unit vector from the first end to the second, and l(t) the
/// length of the rope without load. On a winch l changes with time.
///
/// Units  : N/m, metre, N s/m
/// Error  : as SpringElement
struct RopeElement {
  static constexpr const char* kind = "rope";

  std::string name = {};
  std::array<ElementEnd, 2> ends = {};
  double stiffness = 0;
  Signal<double> length = {};
  double damping = 0;

  /// Force and torque on the second body, about its end, on the first body's axes.
  template <class S>
  [[nodiscard]] Motor<S> force(const ElementMotion<S>& m) const {
    return force(m, length(m.t), length.derivative(m.t, 1));
  }

  /// The same for a given length of the rope without load, and its rate.
  template <class S>
  [[nodiscard]] Motor<S> force(const ElementMotion<S>& m, const S& l, const S& l_rate) const {
    using std::sqrt;
    const S squared = m.reach.squaredNorm();
    if (squared == S(0)) return {};
    const S distance = sqrt(squared);
    const S stretch = distance - l;
    if (!(stretch > S(0))) return {};
    const Vector3<S> along = m.reach / distance;
    const S rate = along.dot(m.velocity) - l_rate;
    const S pull = S(stiffness) * stretch + S(damping) * rate;
    if (!(pull > S(0))) return {};
    return {S(-pull) * along, Vector3<S>::Zero()};
  }

  /// Zero while the rope is slack. Only for a rope of constant length.
  [[nodiscard]] KREISEL_API double potential(const ElementMotion<>& m) const;

  [[nodiscard]] bool keeps_energy() const { return damping == 0 && length.is_constant(); }
};

}  // namespace kreisel
