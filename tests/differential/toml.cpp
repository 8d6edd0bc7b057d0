#include "toml.hpp"

#include <fmt/core.h>

#include <functional>

namespace differential {

/// A single number, or a list of several.
std::string one_or_list(const std::vector<double>& numbers) {
  return numbers.size() == 1 ? text(numbers.front()) : list(numbers);
}

/// A number as a text with a unit.
std::string with_unit(double x, const std::string& unit) {
  return fmt::format("\"{} {}\"", text(x), unit);
}

/// The key of an angle in the file.
std::string angle_key(const std::string& key, bool degrees) { return degrees ? key + "_deg" : key; }

void add_angles(Inline& table, const std::string& key, const std::vector<Angle>& angles) {
  if (angles.empty()) return;
  std::vector<double> values;
  for (const Angle& angle : angles) {
    values.push_back(angles.front().degrees == angle.degrees ? angle.value : angle.radian());
  }
  table.add(angle_key(key, angles.front().degrees), one_or_list(values));
}

std::string series(const Series& s) {
  Inline table;
  table.add_vector("constant", s.constant);
  std::string terms;
  for (const Series::Term& term : s.terms) {
    Inline one;
    one.add("amplitude", list(term.amplitude));
    add_angles(one, "frequency", {term.frequency});
    add_angles(one, "phase", {term.phase});
    terms += (terms.empty() ? "" : ", ") + one.text();
  }
  if (!terms.empty() || table.empty()) table.add("terms", "[" + terms + "]");
  return table.text();
}

namespace {

/// Writes a signal; numbers for which the x component alone counts are written by `value`.
std::string signal(const Signal& s, const std::function<std::string(const Vector&)>& value) {
  Inline table;
  if (!s.file.empty()) {
    table.add("file", "\"" + s.file + "\"");
    return table.text();
  }
  std::string pairs;
  for (std::size_t i = 0; i < s.jumps.times.size(); ++i) {
    pairs += (pairs.empty() ? "[" : ", [") + text(s.jumps.times[i]) + ", " +
             value(s.jumps.values[i]) + "]";
  }
  if (!pairs.empty()) {
    table.add(s.jumps.is_broken_line ? "points" : "steps", "[" + pairs + "]");
    return table.text();
  }
  table.add("constant", value(s.series.constant));
  if (!s.rate.isZero(0)) table.add("rate", value(s.rate));
  std::string terms;
  for (const Series::Term& term : s.series.terms) {
    Inline one;
    one.add("amplitude", value(term.amplitude));
    add_angles(one, "frequency", {term.frequency});
    add_angles(one, "phase", {term.phase});
    terms += (terms.empty() ? "" : ", ") + one.text();
  }
  if (!terms.empty()) table.add("terms", "[" + terms + "]");
  return table.text();
}

}  // namespace

std::string vector_signal(const Signal& s) {
  return signal(s, [](const Vector& v) { return list(v); });
}

std::string number_signal(const Signal& s) {
  return signal(s, [](const Vector& v) { return text(v.x()); });
}

std::string body_name(int index) { return index < 0 ? "guide" : fmt::format("b{}", index); }

}  // namespace differential
