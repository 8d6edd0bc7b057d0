#pragma once

#include <string>
#include <type_traits>
#include <variant>

#include <dynamics/tree/element/coupling.hpp>
#include <dynamics/tree/element/mount.hpp>
#include <dynamics/tree/element/rope.hpp>
#include <dynamics/tree/element/spring.hpp>

namespace kreisel {

/// A force between two bodies, between the guide and a body, or between two joints. It acts on both
/// with opposite signs.
using Element = std::variant<SpringElement, MountElement, CouplingElement, RopeElement>;

[[nodiscard]] KREISEL_API const std::string& name(const Element& element);

/// The names of an element's first and second body; "guide" for the guide.
[[nodiscard]] KREISEL_API const std::string& first_of(const Element& element);
[[nodiscard]] KREISEL_API const std::string& second_of(const Element& element);

/// True if the forces on bodies at rest have a potential.
[[nodiscard]] KREISEL_API bool has_potential(const Element& element);

/// True if the work of an element is that of its potential alone.
[[nodiscard]] KREISEL_API bool keeps_energy(const Element& element);

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
