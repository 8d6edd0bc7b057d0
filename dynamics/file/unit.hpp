#pragma once

#include <optional>
#include <string>
#include <string_view>

#include <motor/error.hpp>

/// Numbers with a unit, in the texts of scene files: "5 mm", "9.81 m/s^2", "0.1 deg/sqrt(h)".

namespace kreisel::detail {

inline constexpr double radian_per_degree = 0.017453292519943295;  ///< rad

/// The exponents of metre, kilogram, second, ampere and radian in a unit.
struct Dimension {
  double length = 0;
  double mass = 0;
  double time = 0;
  double current = 0;
  double angle = 0;

  [[nodiscard]] friend constexpr bool operator==(const Dimension&, const Dimension&) = default;
};

[[nodiscard]] constexpr Dimension operator*(const Dimension& a, const Dimension& b) {
  return {a.length + b.length, a.mass + b.mass, a.time + b.time, a.current + b.current,
          a.angle + b.angle};
}

[[nodiscard]] constexpr Dimension to_power(const Dimension& a, double n) {
  return {n * a.length, n * a.mass, n * a.time, n * a.current, n * a.angle};
}

[[nodiscard]] constexpr Dimension operator/(const Dimension& a, const Dimension& b) {
  return a * to_power(b, -1);
}

namespace dimension {

inline constexpr Dimension number{};
inline constexpr Dimension length{.length = 1};
inline constexpr Dimension mass{.mass = 1};
inline constexpr Dimension time{.time = 1};
inline constexpr Dimension current{.current = 1};
inline constexpr Dimension angle{.angle = 1};
inline constexpr Dimension velocity = length / time;
inline constexpr Dimension acceleration = velocity / time;
inline constexpr Dimension angular_rate = angle / time;
inline constexpr Dimension force = mass * acceleration;
inline constexpr Dimension torque = force * length;
inline constexpr Dimension inertia = mass * length * length;
/// That of mu = G M of a planet.
inline constexpr Dimension gravitation = length * length * acceleration;
inline constexpr Dimension flux_density = force / (current * length);
inline constexpr Dimension magnetic_moment = current * length * length;

}  // namespace dimension

/// The dimension of the joint force that moves a coordinate of this dimension.
[[nodiscard]] constexpr Dimension joint_force(const Dimension& moved) {
  return moved.angle == 0 ? dimension::force : dimension::torque;
}

/// The dimension of the numbers at a key. It is nothing for a key in degrees, whose numbers take no
/// unit.
using KeyDimension = std::optional<Dimension>;

/// The dimension of the derivative with respect to time.
[[nodiscard]] constexpr KeyDimension per_second(const KeyDimension& of) {
  return of ? KeyDimension(*of / dimension::time) : std::nullopt;
}

/// True if the text begins with a number.
[[nodiscard]] bool begins_with_number(std::string_view text);

/// The value in SI units and radian of a number with a unit.
///
/// A product is written by a blank, `*` or `.`, a quotient by `/`, a power by `^`, a root by
/// sqrt(..). Radian may be left out. Hz is one revolution per second, and 1/s in powers other than
/// the first.
///
/// Error  : <= u for units that are powers of ten of SI units: "5 mm" is the double 0.005. Degrees
///          are multiplied as in keys that end in _deg.
/// Throws : InvalidInput with the reason: no number, no unit, an unknown unit, another dimension
[[nodiscard]] double value_with_unit(std::string_view text, const KeyDimension& wanted);

/// The dimension of a unit such as "m/s".
///
/// Throws : InvalidInput as above
[[nodiscard]] Dimension dimension_of(std::string_view unit);

/// The value of a number with a unit of any dimension.
///
/// Throws : InvalidInput as above
[[nodiscard]] double value_with_unit(std::string_view text);

}  // namespace kreisel::detail
