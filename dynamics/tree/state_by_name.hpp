#pragma once

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include <dynamics/tree/joint/list.hpp>
#include <dynamics/tree/tree.hpp>
#include <motor/error.hpp>

namespace kreisel {

/// The index of the body with that name.
///
/// Throws : InvalidInput with the names of all bodies
[[nodiscard]] inline int index_of(const BodyTree& tree, std::string_view name) {
  const std::vector<BodyDescription>& bodies = tree.bodies();
  const auto found =
      std::find_if(bodies.begin(), bodies.end(), [name](const auto& b) { return b.name == name; });
  if (found != bodies.end()) return static_cast<int>(found - bodies.begin());
  std::string text = "no body is named '" + std::string(name) + "'; there are";
  constexpr std::size_t most = 20;
  for (std::size_t i = 0; i < std::min(most, bodies.size()); ++i) {
    text += (i > 0 ? ", '" : " '") + bodies[i].name + "'";
  }
  if (bodies.size() > most) text += " and " + std::to_string(bodies.size() - most) + " more";
  throw InvalidInput(bodies.empty() ? text + " none" : text);
}

namespace detail {

/// A letter for each coordinate of a joint: a for an angle, d for a displacement. Quaternions have one
/// letter q and positions one letter p.
[[nodiscard]] inline std::string coordinates_of(JointKind kind) {
  std::string letters;
  for (const JointQuantity& quantity : joint_type(kind).coordinates) {
    switch (quantity.meaning) {
      case JointQuantity::Meaning::attitude: letters += 'q'; break;
      case JointQuantity::Meaning::place: letters += 'p'; break;
      case JointQuantity::Meaning::plain:
        letters.append(quantity.columns.size(), quantity.unit == "rad" ? 'a' : 'd');
    }
  }
  return letters;
}

}  // namespace detail

/// A state of a BodySystem, read and written by the names of its bodies.
///
///   auto start = system.rest();
///   StateByName state(system.tree(), start);
///   state.set_angle("ring", 0.1);
///   state.set_rate("rotor", 300);
///   state.set_attitude("bus", Eigen::Quaterniond(w, x, y, z));
///   const auto run = solve(system, start, options);
///   StateByName(system.tree(), run.states.back()).angle("ring");
///
/// State  : has coordinates and rates; const, if it is only read. Tree and state are kept by reference
/// Frames : attitudes, positions and rates are relative to the parent. Attitudes take components on
///          the body's axes to the parent's axes; angular velocities are on the body's axes,
///          positions and velocities on the parent's
/// Units  : rad, m, rad/s, m/s
/// Throws : InvalidInput for an unknown name, for a coordinate that the joint does not have, and for
///          values that are not finite. The message lists the names or coordinates that exist
template <class State>
class StateByName {
 public:
  StateByName(const BodyTree& tree, State& state) : tree_(tree), state_(state) {
    if (state.coordinates.size() != tree.coordinates() || state.rates.size() != tree.rates()) {
      throw InvalidInput("the state has " + std::to_string(state.coordinates.size()) +
                         " coordinates and " + std::to_string(state.rates.size()) +
                         " rates, the tree " + std::to_string(tree.coordinates()) + " and " +
                         std::to_string(tree.rates()));
    }
  }

  /// An angle of the joint. A universal joint has two, 0 and 1.
  [[nodiscard]] double angle(std::string_view body, int which = 0) const {
    return state_.coordinates[coordinate(body, 'a', which)];
  }
  void set_angle(std::string_view body, double value, int which = 0) {
    state_.coordinates[coordinate(body, 'a', which)] = finite(value, body);
  }

  [[nodiscard]] double displacement(std::string_view body, int which = 0) const {
    return state_.coordinates[coordinate(body, 'd', which)];
  }
  void set_displacement(std::string_view body, double value, int which = 0) {
    state_.coordinates[coordinate(body, 'd', which)] = finite(value, body);
  }

  /// The rate of an angle or a displacement, counted in the order of the joint's coordinates.
  [[nodiscard]] double rate(std::string_view body, int which = 0) const {
    return state_.rates[single_rate(body, which)];
  }
  void set_rate(std::string_view body, double value, int which = 0) {
    state_.rates[single_rate(body, which)] = finite(value, body);
  }

  /// The attitude with norm 1.
  [[nodiscard]] Eigen::Quaterniond attitude(std::string_view body) const {
    const JointPlace place = with(body, 'q');
    const Eigen::Quaterniond q(Eigen::Vector4d(state_.coordinates.template segment<4>(place.q)));
    return (joint(body).orientation * q).normalized();
  }
  /// value : any norm except 0
  void set_attitude(std::string_view body, const Eigen::Quaterniond& value) {
    const JointPlace place = with(body, 'q');
    const double norm = value.norm();
    if (finite(norm, body) == 0) {
      throw InvalidInput("body '" + std::string(body) + "': an attitude of norm 0 turns nothing");
    }
    state_.coordinates.template segment<4>(place.q) =
        (joint(body).orientation.conjugate() * value).normalized().coeffs();
  }

  [[nodiscard]] Vector3<double> angular_velocity(std::string_view body) const {
    return state_.rates.template segment<3>(with(body, 'q').v);
  }
  void set_angular_velocity(std::string_view body, const Vector3<double>& value) {
    state_.rates.template segment<3>(with(body, 'q').v) = finite(value, body);
  }

  /// The position of a free body's origin.
  [[nodiscard]] Vector3<double> position(std::string_view body) const {
    const JointPlace place = with(body, 'p');
    return joint(body).position + state_.coordinates.template segment<3>(place.q + 4);
  }
  void set_position(std::string_view body, const Vector3<double>& value) {
    const JointPlace place = with(body, 'p');
    state_.coordinates.template segment<3>(place.q + 4) =
        finite(value, body) - joint(body).position;
  }

  [[nodiscard]] Vector3<double> velocity(std::string_view body) const {
    return state_.rates.template segment<3>(with(body, 'p').v + 3);
  }
  void set_velocity(std::string_view body, const Vector3<double>& value) {
    state_.rates.template segment<3>(with(body, 'p').v + 3) = finite(value, body);
  }

 private:
  [[nodiscard]] const Joint& joint(std::string_view body) const {
    return tree_.body(index_of(tree_, body)).joint;
  }

  /// The place in the state of a joint that has such a part.
  [[nodiscard]] JointPlace with(std::string_view body, char part) const {
    const int i = index_of(tree_, body);
    if (detail::coordinates_of(joint(body).kind).find(part) == std::string::npos) {
      refuse(body, part, 0);
    }
    return tree_.place(i);
  }

  [[nodiscard]] int coordinate(std::string_view body, char part, int which) const {
    const JointPlace place = with(body, part);
    const std::string parts = detail::coordinates_of(joint(body).kind);
    for (std::size_t k = 0, seen = 0; which >= 0 && k < parts.size(); ++k) {
      if (parts[k] != part) continue;
      if (seen++ == static_cast<std::size_t>(which)) return place.q + static_cast<int>(k);
    }
    refuse(body, part, which);
  }

  [[nodiscard]] int single_rate(std::string_view body, int which) const {
    const JointPlace place = tree_.place(index_of(tree_, body));
    if (which < 0 || which >= place.v_count || place.q_count >= 4) refuse(body, 'r', which);
    return place.v + which;
  }

  /// The text for a letter of detail::coordinates_of, and for r, a rate.
  [[nodiscard]] static std::string words(char part) {
    switch (part) {
      case 'a': return "angle";
      case 'd': return "displacement";
      case 'q': return "attitude and angular velocity";
      case 'p': return "position and velocity";
      default: return "rate of a single coordinate";
    }
  }

  [[noreturn]] void refuse(std::string_view body, char part, int which) const {
    const std::string parts = detail::coordinates_of(joint(body).kind);
    std::string text = "body '" + std::string(body) + "' has no " + words(part);
    if (which != 0) text += " of index " + std::to_string(which);
    text += parts.empty() ? "; its joint has no coordinates" : "; its joint has";
    for (std::size_t k = 0; k < parts.size(); ++k) text += (k > 0 ? ", " : " ") + words(parts[k]);
    throw InvalidInput(text);
  }

  template <class Value>
  [[nodiscard]] static const Value& finite(const Value& value, std::string_view body) {
    bool is_finite = false;
    if constexpr (std::is_same_v<Value, double>) {
      is_finite = std::isfinite(value);
    } else {
      is_finite = value.allFinite();
    }
    if (is_finite) return value;
    throw InvalidInput("body '" + std::string(body) + "': the value to be set is not finite");
  }

  const BodyTree& tree_;
  State& state_;
};

}  // namespace kreisel
