#pragma once

#include <cstddef>
#include <string>
#include <variant>
#include <vector>

#include <dynamics/tree/constraint/joint.hpp>
#include <dynamics/tree/constraint/point.hpp>
#include <dynamics/tree/constraint/rolling.hpp>
#include <motor/api.hpp>

namespace kreisel {

namespace constraint {

/// A gear between two joints with single coordinates:  q_first = ratio q_second + offset.
///
/// Units  : rad, or m for a slide; ratio in their quotient
struct Gear {
  double ratio = 1;
  double offset = 0;

  void list(detail::ConstraintNumbers& numbers) const;
};

using Kind =
    std::variant<Point, Distance, Revolute, Universal, Fixed, Prismatic, Gear, Rolling, Blade>;

}  // namespace constraint

/// A condition between the motions of two bodies of a tree: the ideal part of a bearing, a loop's
/// joint, a gear or a contact. It does no work.
///
/// Source : paper 002 section 6, conditions between the motors of motion (Zusatzbedingungen)
struct Constraint {
  std::string name;
  std::string first = "guide";  ///< a body's name; of a gear that of the body after the joint
  std::string second;
  constraint::Kind kind = constraint::Point{};
};

/// The force and torque by which the first body of a constraint holds the second.
///
/// Frame  : the first body's axes, about the point `at` of the second body: the constraint's own
///          point, of a wheel the contact. Of a gear: on the body after the second joint
/// Units  : N, N m; metre (at: the second body's axes)
struct ConstraintReaction {
  std::string name;
  Motor<> on_second = {};
  Vector3<double> at = Vector3<double>::Zero();
};

/// How far a state is from the conditions of one constraint; not a number where it has no direction.
struct ConstraintGap {
  std::string name;
  double position = 0;  ///< m or rad: the greatest of its conditions
  double rate = 0;      ///< m/s or rad/s
  double relative = 0;  ///< position, as a part of the lengths in it
};

/// A constraint of which some conditions follow from those of earlier ones.
struct RedundantConstraint {
  std::string name;
  int redundant;  ///< of its conditions
  int conditions;
};

namespace detail {

/// A constraint between the links of a tree.
struct ConstraintLink {
  Constraint constraint;
  std::size_t first = 0;  ///< links
  std::size_t second = 0;
  int q_first = 0;  ///< coordinates and rates of a gear
  int q_second = 0;
  int v_first = 0;
  int v_second = 0;

  [[nodiscard]] bool is_gear() const {
    return std::holds_alternative<constraint::Gear>(constraint.kind);
  }
};

}  // namespace detail

}  // namespace kreisel
