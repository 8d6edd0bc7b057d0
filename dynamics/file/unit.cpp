#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include <dynamics/file/did_you_mean.hpp>
#include <dynamics/file/quoted.hpp>
#include <dynamics/file/unit.hpp>

namespace kreisel::detail {

namespace {

/// The size of a unit:  numerator/denominator 10^decimal (pi/180)^degrees Hz^hertz.
struct Unit {
  double numerator = 1;
  double denominator = 1;
  double decimal = 0;
  double degrees = 0;
  double hertz = 0;
  Dimension dimension = {};  ///< without Hz
};

Unit operator*(const Unit& a, const Unit& b) {
  return {a.numerator * b.numerator, a.denominator * b.denominator,
          a.decimal + b.decimal,     a.degrees + b.degrees,
          a.hertz + b.hertz,         a.dimension * b.dimension};
}

Unit to_power(Unit a, double n) {
  if (n < 0) std::swap(a.numerator, a.denominator);
  return {std::pow(a.numerator, std::abs(n)),
          std::pow(a.denominator, std::abs(n)),
          n * a.decimal,
          n * a.degrees,
          n * a.hertz,
          to_power(a.dimension, n)};
}

struct NamedUnit {
  const char* name;
  Unit unit;
};

const std::vector<NamedUnit>& units() {
  using namespace dimension;
  const auto decimal = [](int n, const Dimension& of) { return Unit{1, 1, double(n), 0, 0, of}; };
  const auto angular = [](double numerator, double denominator, const Dimension& of) {
    return Unit{numerator, denominator, 0, 1, 0, of};
  };
  static const std::vector<NamedUnit> all{{"m", decimal(0, length)},
                                          {"mm", decimal(-3, length)},
                                          {"cm", decimal(-2, length)},
                                          {"km", decimal(3, length)},
                                          {"um", decimal(-6, length)},
                                          {"in", {254, 1e4, 0, 0, 0, length}},
                                          {"ft", {3048, 1e4, 0, 0, 0, length}},
                                          {"nmi", {1852, 1, 0, 0, 0, length}},
                                          {"s", decimal(0, time)},
                                          {"ms", decimal(-3, time)},
                                          {"us", decimal(-6, time)},
                                          {"min", {60, 1, 0, 0, 0, time}},
                                          {"h", {3600, 1, 0, 0, 0, time}},
                                          {"d", {86400, 1, 0, 0, 0, time}},
                                          {"kg", decimal(0, mass)},
                                          {"g", decimal(-3, mass)},
                                          {"t", decimal(3, mass)},
                                          {"lb", {45359237, 1e8, 0, 0, 0, mass}},
                                          {"rad", decimal(0, angle)},
                                          {"mrad", decimal(-3, angle)},
                                          {"deg", angular(1, 1, angle)},
                                          {"arcmin", angular(1, 60, angle)},
                                          {"arcsec", angular(1, 3600, angle)},
                                          {"rev", angular(360, 1, angle)},
                                          {"rpm", angular(6, 1, angular_rate)},
                                          {"Hz", {1, 1, 0, 0, 1, number}},
                                          {"kn", {1852, 3600, 0, 0, 0, velocity}},
                                          {"N", decimal(0, force)},
                                          {"kN", decimal(3, force)},
                                          {"mN", decimal(-3, force)},
                                          {"Nm", decimal(0, torque)},
                                          {"Nms", decimal(0, torque * time)},
                                          {"J", decimal(0, torque)},
                                          {"W", decimal(0, torque / time)},
                                          {"Pa", decimal(0, force / (length * length))},
                                          {"A", decimal(0, current)},
                                          {"T", decimal(0, flux_density)},
                                          {"uT", decimal(-6, flux_density)},
                                          {"nT", decimal(-9, flux_density)},
                                          {"%", decimal(-2, number)},
                                          {"ppm", decimal(-6, number)}};
  return all;
}

struct NamedDimension {
  Dimension dimension;
  const char* name;
};

/// A dimension in words, with its SI unit.
std::string described(const Dimension& of) {
  using namespace dimension;
  static const std::vector<NamedDimension> names{
      {number, "a plain number"},
      {length, "a length (m)"},
      {mass, "a mass (kg)"},
      {time, "a time (s)"},
      {angle, "an angle (rad)"},
      {velocity, "a velocity (m/s)"},
      {acceleration, "an acceleration (m/s^2)"},
      {number / time, "a rate (1/s)"},
      {angular_rate, "an angular rate (rad/s)"},
      {angular_rate / time, "an angular acceleration (rad/s^2)"},
      {force, "a force (N)"},
      {torque, "a torque (N m)"},
      {inertia, "a moment of inertia (kg m^2)"},
      {force / length, "a stiffness (N/m)"},
      {torque / angle, "a stiffness (N m/rad)"},
      {force / velocity, "a damping (N s/m)"},
      {torque / angular_rate, "a damping (N m s/rad)"},
      {force / (velocity * velocity), "a quadratic drag (N s^2/m^2)"},
      {length / angle, "a pitch (m/rad)"},
      {gravitation, "a gravitational parameter (m^3/s^2)"},
      {flux_density, "a flux density (T)"},
      {magnetic_moment, "a magnetic moment (A m^2)"}};
  for (const NamedDimension& known : names) {
    if (known.dimension == of) return known.name;
  }
  std::string text = "a quantity in";
  const std::pair<const char*, double> parts[] = {
      {"kg", of.mass}, {"m", of.length}, {"s", of.time}, {"A", of.current}, {"rad", of.angle}};
  for (const auto& [name, exponent] : parts) {
    if (exponent == 0) continue;
    std::array<char, 32> digits{};
    const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), exponent).ptr;
    text += std::string(" ") + name;
    if (exponent != 1) text.append("^").append(digits.data(), end);
  }
  return text;
}

/// Radian may be left out.
bool fits(const Dimension& found, const Dimension& wanted) {
  Dimension with_angle = found;
  if (found.angle == 0) with_angle.angle = wanted.angle;
  return with_angle == wanted;
}

/// The digits of a number and its exponent of ten.
struct Decimal {
  std::string digits;
  int exponent = 0;
};

class Parser {
 public:
  explicit Parser(std::string_view text) : whole_(text), rest_(text) {
    constexpr std::size_t longest = 60;
    if (text.size() > longest) refuse("is too long for a number with a unit");
  }

  Decimal number() {
    Decimal result;
    skip_blanks();
    const bool negative = next() == '-';
    if (negative || next() == '+') rest_.remove_prefix(1);
    if (negative) result.digits.push_back('-');
    result.digits += digits();
    if (take('.')) result.digits.append(".").append(digits());
    if (result.digits.find_first_of("0123456789") == std::string::npos) refuse("is no number");
    result.exponent = exponent_of_ten();
    return result;
  }

  Unit unit() {
    skip_blanks();
    if (rest_.empty()) refuse("has no unit; write the number without quotes");
    const Unit result = take('/') ? to_power(factor(), -1) : product();
    if (!rest_.empty()) refuse("has a bracket too many");
    return result;
  }

  [[noreturn]] void refuse(const std::string& reason) const {
    throw InvalidInput(in_quotes(whole_) + " " + reason);
  }

 private:
  [[nodiscard]] char next() const { return rest_.empty() ? '\0' : rest_.front(); }

  bool take(char c) {
    if (next() != c || rest_.empty()) return false;
    rest_.remove_prefix(1);
    return true;
  }

  bool skip_blanks() {
    bool any = false;
    while (take(' ')) any = true;
    return any;
  }

  std::string digits() {
    const std::size_t count = std::min(rest_.find_first_not_of("0123456789"), rest_.size());
    std::string result(rest_.substr(0, count));
    rest_.remove_prefix(count);
    return result;
  }

  int exponent_of_ten() {
    const std::string_view before = rest_;
    if (!take('e') && !take('E')) return 0;
    const bool negative = next() == '-';
    if (negative || next() == '+') rest_.remove_prefix(1);
    const std::string power = digits();
    constexpr std::size_t longest = 3;
    if (power.size() > longest) refuse("is no number that a computer holds");
    if (power.empty()) {  // a unit that begins with e
      rest_ = before;
      return 0;
    }
    return (negative ? -1 : 1) * std::stoi(power);
  }

  /// Factors, then divisors.
  Unit product() {
    Unit result = factor();
    bool is_divided = false;
    while (true) {
      const bool blank = skip_blanks();
      if (rest_.empty() || next() == ')') return result;
      if (take('/')) {
        result = result * to_power(factor(), -1);
        is_divided = true;
        continue;
      }
      if (!take('*') && !take('.') && !blank) {
        refuse("is unclear at " + in_quotes(rest_) + "; products are written 'N m', powers 's^2'");
      }
      if (is_divided) refuse("is unclear after '/'; write 'N s/m', or 'N/(m s)'");
      result = result * factor();
    }
  }

  Unit factor() {
    skip_blanks();
    Unit result;
    const std::string_view name = word();
    if (name == "sqrt" || name.empty()) {
      if (!take('(')) {
        if (name.empty() && take('1')) return result;
        refuse(rest_.empty() ? "ends without a unit"
                             : "has no unit at " + in_quotes(rest_) + ", but needs one");
      }
      result = to_power(product(), name.empty() ? 1 : 0.5);
      if (!take(')')) refuse("lacks a closing bracket");
    } else {
      result = named(name);
    }
    return take('^') ? to_power(result, exponent()) : result;
  }

  std::string_view word() {
    const auto is_letter = [](char c) {
      return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '%';
    };
    const auto* const end = std::find_if_not(rest_.begin(), rest_.end(), is_letter);
    const auto count = static_cast<std::size_t>(end - rest_.begin());
    const std::string_view result = rest_.substr(0, count);
    rest_.remove_prefix(count);
    return result;
  }

  Unit named(std::string_view name) const {
    std::vector<std::string> names;
    for (const NamedUnit& known : units()) {
      if (known.name == name) return known.unit;
      names.emplace_back(known.name);
    }
    refuse("has an unknown unit, " + in_quotes(name) + did_you_mean(name, names));
  }

  double exponent() {
    std::string text = take('-') ? "-" : "";
    text += digits();
    const bool has_fraction = next() == '.' && rest_.substr(1).find_first_of("0123456789") == 0;
    if (has_fraction && take('.')) text.append(".").append(digits());
    double n = 0;
    const auto read = std::from_chars(text.data(), text.data() + text.size(), n);
    constexpr double most = 9;
    if (read.ec != std::errc{} || !(std::abs(n) <= most) || 2 * n != std::round(2 * n)) {
      refuse("has a power that is none of 2, -1, 0.5 and the like");
    }
    return n;
  }

  std::string_view whole_;
  std::string_view rest_;
};

/// The value in SI units.
double scaled(const Decimal& number, const Unit& unit, const Parser& parser) {
  const double whole = std::floor(unit.decimal);
  const std::string text =
      number.digits + "e" + std::to_string(number.exponent + static_cast<int>(whole));
  double value = 0;
  const auto read = std::from_chars(text.data(), text.data() + text.size(), value);
  if (read.ec != std::errc{}) parser.refuse("is no number that a computer holds");
  value = value * (unit.numerator * std::pow(10, unit.decimal - whole)) / unit.denominator;
  return unit.degrees == 0 ? value : value * std::pow(radian_per_degree, unit.degrees);
}

/// The unit with Hz as a revolution per second, or in other powers as 1/s.
Unit without_hertz(Unit unit) {
  if (unit.hertz == 1) return unit * Unit{360, 1, 0, 1, -1, dimension::angular_rate};
  unit.dimension = unit.dimension * to_power(dimension::time, -unit.hertz);
  return unit;
}

}  // namespace

bool begins_with_number(std::string_view text) {
  text.remove_prefix(std::min(text.find_first_not_of(" +-."), text.size()));
  return !text.empty() && text.front() >= '0' && text.front() <= '9';
}

double value_with_unit(std::string_view text, const KeyDimension& wanted) {
  Parser parser(text);
  if (!wanted) {
    parser.refuse("must be a plain number: the key is in degrees; units go into keys without _deg");
  }
  const Decimal number = parser.number();
  const Unit unit = without_hertz(parser.unit());
  if (!fits(unit.dimension, *wanted)) {
    parser.refuse("is " + described(unit.dimension) + ", wanted " + described(*wanted));
  }
  return scaled(number, unit, parser);
}

Dimension dimension_of(std::string_view unit) {
  return without_hertz(Parser(unit).unit()).dimension;
}

double value_with_unit(std::string_view text) {
  Parser parser(text);
  const Decimal number = parser.number();
  return scaled(number, without_hertz(parser.unit()), parser);
}

}  // namespace kreisel::detail
