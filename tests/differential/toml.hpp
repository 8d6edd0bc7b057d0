#pragma once

#include <string>
#include <vector>

#include "scene.hpp"

/// Pieces of a scene's text as a file.

namespace differential {

/// A single number, or a list of several.
[[nodiscard]] std::string one_or_list(const std::vector<double>& numbers);

/// A number as a text with a unit.
[[nodiscard]] std::string with_unit(double x, const std::string& unit);

template <class Numbers>
[[nodiscard]] std::string list_with_unit(const Numbers& numbers, const std::string& unit) {
  std::string result;
  for (const double x : numbers) result += (result.empty() ? "" : ", ") + with_unit(x, unit);
  return "[" + result + "]";
}

/// Writes `key = value` for values that exist, with commas between.
class Inline {
 public:
  void add(const std::string& key, const std::string& value) {
    inside_ += (inside_.empty() ? "" : ", ") + key + " = " + value;
  }
  void add_vector(const std::string& key, const Vector& v) {
    if (!v.isZero(0)) add(key, list(v));
  }
  [[nodiscard]] bool empty() const { return inside_.empty(); }
  [[nodiscard]] std::string text() const { return "{ " + inside_ + " }"; }

 private:
  std::string inside_;
};

/// The key of an angle in the file.
[[nodiscard]] std::string angle_key(const std::string& key, bool degrees);

void add_angles(Inline& table, const std::string& key, const std::vector<Angle>& angles);

[[nodiscard]] std::string series(const Series& s);
[[nodiscard]] std::string vector_signal(const Signal& s);
[[nodiscard]] std::string number_signal(const Signal& s);

[[nodiscard]] std::string body_name(int index);

// toml_guide.cpp
[[nodiscard]] std::string log_name(std::size_t link);
[[nodiscard]] std::string guide(const Scene& scene);
[[nodiscard]] std::string gravity(const Scene& scene);

// toml_body.cpp
[[nodiscard]] std::string body(const Scene& scene, int index);

// toml_parts.cpp
[[nodiscard]] std::string element(const Element& e, std::size_t index);
[[nodiscard]] std::string sensor(const Sensor& sensor, std::size_t index);
/// The sensor that a servo reads, and its controller.
[[nodiscard]] std::string servo(const Servo& servo, const Scene& scene, std::size_t index);

[[nodiscard]] std::string constraint(const Constraint& c, std::size_t index);

/// The joint of a loose body as a constraint.
[[nodiscard]] std::string constraint(const Body& b, int index);

}  // namespace differential
