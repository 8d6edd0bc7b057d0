#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include <dynamics/tree/element/motion.hpp>
#include <motor/api.hpp>
#include <motor/error.hpp>

namespace kreisel {

/// A spring with a damper along the straight line between two points. Its force on the second body
/// is, with the length L and the unit vector e from the first end to the second:
///
///   F = -(k (L - length) + d L') e
///
/// A table replaces k (L - length) by a polyline of the pull over the length. Before its first and
/// after its last point the polyline goes on straight.
///
/// Units  : N/m, metre, N s/m; table: metre, N
/// Error  : 8u of the terms' sizes, and u |x|/L for ends at the distance |x| from the guide's origin
/// Throws : ComputationFailed where both ends meet, unless `length` is 0 and there is no table
struct SpringElement {
  static constexpr const char* kind = "spring";

  /// A point of the table.
  struct Point {
    double length;
    double pull;
  };

  std::string name = {};
  std::array<ElementEnd, 2> ends = {};
  double stiffness = 0;
  double length = 0;  ///< unloaded
  double damping = 0;
  std::vector<Point> table = {};  ///< at least two points of increasing length, or none

  /// Force and torque on the second body, about its end, on the first body's axes.
  template <class S>
  [[nodiscard]] Motor<S> force(const ElementMotion<S>& m) const {
    using std::sqrt;
    const bool has_direction_at_0 = table.empty() && length == 0;
    const S squared = m.reach.squaredNorm();
    if (squared == S(0)) {
      if (!has_direction_at_0) {
        throw ComputationFailed("element '" + name +
                                "': both ends of the spring meet, its force has no direction");
      }
      return {S(-stiffness) * m.reach - S(damping) * m.velocity, Vector3<S>::Zero()};
    }
    const S distance = sqrt(squared);
    const Vector3<S> along = m.reach / distance;
    const S rate = along.dot(m.velocity);
    const S tension = S(pull(distance)) + S(damping) * rate;
    return {S(-tension) * along, Vector3<S>::Zero()};
  }

  /// The pull at a length, without that of the damper.
  template <class S>
  [[nodiscard]] S pull(const S& distance) const {
    if (table.empty()) return S(stiffness) * S(distance - S(length));
    std::size_t piece = 0;
    while (piece + 2 < table.size() && distance > S(table[piece + 1].length)) ++piece;
    return S(table[piece].pull) + S(slope(piece)) * S(distance - S(table[piece].length));
  }

  /// Zero at the unloaded length, or at the first point of the table.
  [[nodiscard]] KREISEL_API double potential(const ElementMotion<>& m) const;

  [[nodiscard]] bool keeps_energy() const { return damping == 0; }

 private:
  [[nodiscard]] double slope(std::size_t piece) const {
    const auto& [from, low] = table[piece];
    const auto& [to, high] = table[piece + 1];
    return (high - low) / (to - from);
  }
};

}  // namespace kreisel
