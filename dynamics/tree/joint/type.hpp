#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <initializer_list>
#include <string>
#include <vector>

#include <dynamics/tree/joint/joint.hpp>

namespace kreisel {

/// A quantity that a joint has one or more numbers of: an angle, a displacement, an attitude.
struct JointQuantity {
  enum class Meaning {
    plain,     ///< coordinates or rates themselves
    attitude,  ///< quaternion: shown against the parent's axes, `orientation` of the joint included
    place      ///< shown from the parent's origin, `position` of the joint included
  };

  std::string key;                   ///< in `initial` of scene files
  std::string unit;                  ///< "rad", "m", "1"; of a rate "rad/s", "m/s"
  std::vector<std::string> columns;  ///< names of the numbers in tables
  std::string title;                 ///< heading of a picture
  std::vector<std::string> curves;   ///< names of the numbers in that picture
  Meaning meaning = Meaning::plain;

  [[nodiscard]] int count() const { return static_cast<int>(columns.size()); }
};

namespace detail {

/// How a link moves against the one before it: the motions that all joints are made of. The
/// equations of each are in motion.hpp (pose, motion subspace, bias acceleration), passes.hpp
/// (rates of the coordinates), elimination.hpp and series.cpp.
enum class LinkKind { fixed, revolute, prismatic, screw, spherical, free };

/// One motion of a joint. Several follow each other outwards, each on axes that the ones before it
/// move, with no mass between.
struct JointPart {
  LinkKind kind = LinkKind::fixed;
  Vector3<double> axis = Vector3<double>::Zero();  ///< on the parent's axes at zero coordinates
  double pitch = 0;  ///< metres along the axis by one of the coordinate; of a prismatic one 1
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

/// A kind of joint: all that the library needs in order to compute, read and show it.
///
/// Coordinates and rates stand in the state in the order of the parts, and in tables too; only a
/// quaternion, (x, y, z, w) in the state, is (w, x, y, z) in tables.
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

  /// Whether a quaternion is among the coordinates.
  [[nodiscard]] bool has_attitude() const {
    return !coordinates.empty() && coordinates.front().meaning == JointQuantity::Meaning::attitude;
  }

  /// Whether each rate is that of one coordinate, so that springs and potentials are possible.
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
