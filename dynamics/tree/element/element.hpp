#pragma once

#include <string>
#include <type_traits>
#include <variant>

#include <dynamics/tree/element/coupling.hpp>
#include <dynamics/tree/element/mount.hpp>
#include <dynamics/tree/element/spring.hpp>

namespace kreisel {

/// A force between two bodies, between the guide and a body, or between two joints. It acts on both
/// with opposite signs.
using Element = std::variant<SpringElement, MountElement, CouplingElement>;

[[nodiscard]] inline const std::string& name(const Element& element) {
  return std::visit([](const auto& kind) -> const std::string& { return kind.name; }, element);
}

/// The names of an element's first and second body; "guide" for the guide.
[[nodiscard]] KREISEL_API const std::string& first_of(const Element& element);
[[nodiscard]] KREISEL_API const std::string& second_of(const Element& element);

/// True if the forces on bodies at rest have a potential.
[[nodiscard]] inline bool has_potential(const Element& element) {
  const auto* const mount = std::get_if<MountElement>(&element);
  return mount == nullptr || mount->has_potential();
}

/// True if the work of an element is that of its potential alone.
[[nodiscard]] inline bool keeps_energy(const Element& element) {
  return std::visit([](const auto& kind) { return kind.keeps_energy(); }, element);
}

namespace detail {

/// True for kinds that act between joints, not between points.
template <class Kind>
inline constexpr bool joins_joints = std::is_same_v<Kind, CouplingElement>;

/// Checks an element by itself, without its bodies.
///
/// Throws : InvalidInput, naming the element, for an empty name, numbers that are not finite,
///          negative damping, an element without any force, and a table that is not in order
KREISEL_API void check_element(const Element& element);

[[noreturn]] void refuse_element(const std::string& name, const std::string& why);

}  // namespace detail

}  // namespace kreisel
