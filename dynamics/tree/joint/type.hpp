#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <initializer_list>
#include <string>
#include <vector>

#include <dynamics/tree/joint/joint.hpp>

namespace kreisel {

/// A quantity of a joint, of one or more numbers: an angle, a displacement, an attitude.
struct JointQuantity {
  enum class Meaning {
    plain,     ///< coordinates or rates themselves
    attitude,  ///< quaternion: shown relative to the parent, `orientation` of the joint included
    place      ///< position: shown from the parent's origin, `position` of the joint included
  };

  std::string key;                   ///< in `initial` of scene files
  std::string unit;                  ///< "rad", "m", "1"; of a rate "rad/s", "m/s"
  std::vector<std::string> columns;  ///< names of the numbers in tables
  std::string title;                 ///< of the plot
  std::vector<std::string> curves;   ///< names of the numbers in the plot
  Meaning meaning = Meaning::plain;

  [[nodiscard]] int count() const { return static_cast<int>(columns.size()); }
};

namespace detail {

/// The motion of a link relative to its parent: all joints consist of these.
///
/// Their equations are in motion.hpp (pose, motion subspace, bias acceleration), passes.hpp (rates
/// of the coordinates), elimination.hpp and series.cpp.
enum class LinkKind { fixed, revolute, prismatic, screw, spherical, free };

/// One motion of a joint. The motions follow each other outwards, without mass between them. Each
/// one moves the axes of those after it.
struct JointPart {
  LinkKind kind = LinkKind::fixed;
  Vector3<double> axis = Vector3<double>::Zero();  ///< on the parent's axes at zero coordinates
  double pitch = 0;  ///< metres along the axis per unit of the coordinate; prismatic: 1
};

/// The motions of a joint, from its parent outwards: one to three.
class JointParts {
 public:
  JointParts(std::initializer_list<JointPart> parts) : count_(parts.size()) {
    std::copy(parts.begin(), parts.end(), parts_.begin());
  }

  [[nodiscard]] const JointPart* begin() const { return parts_.data(); }
  [[nodiscard]] const JointPart* end() const { return parts_.data() + count_; }
  [[nodiscard]] const JointPart& back() const { return parts_[count_ - 1]; }

 private:
  std::array<JointPart, 3> parts_;
  std::size_t count_;
};

}  // namespace detail

/// A kind of joint: all data needed to compute, read and show it.
///
/// Coordinates and rates have the order of the parts, in the state and in tables. A quaternion is
/// (x, y, z, w) in the state, but (w, x, y, z) in tables.
struct JointType {
  enum class Axis { none, optional, required };

  JointKind kind = JointKind::fixed;
  std::string name;  ///< `kind` in scene files
  Axis axis = Axis::none;
  Axis second_axis = Axis::none;  ///< not parallel to the first
  bool has_pitch = false;         ///< not 0
  std::vector<JointQuantity> coordinates = {};
  std::vector<JointQuantity> rates = {};
  detail::JointParts (*parts)(const Joint& joint) = nullptr;

  [[nodiscard]] int coordinate_count() const { return count(coordinates); }
  [[nodiscard]] int rate_count() const { return count(rates); }

  /// True if a quaternion is among the coordinates.
  [[nodiscard]] bool has_attitude() const {
    return !coordinates.empty() && coordinates.front().meaning == JointQuantity::Meaning::attitude;
  }

  /// True if a motor can prescribe the motion: the joint has one coordinate.
  [[nodiscard]] bool can_be_driven() const { return coordinate_count() == 1; }

  /// True if each rate is the derivative of one coordinate, so springs and potentials are possible.
  [[nodiscard]] bool has_single_coordinates() const {
    return !coordinates.empty() && !has_attitude();
  }

 private:
  [[nodiscard]] static int count(const std::vector<JointQuantity>& quantities) {
    int sum = 0;
    for (const JointQuantity& quantity : quantities) sum += quantity.count();
    return sum;
  }
};

}  // namespace kreisel
