#include "log.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iterator>

namespace differential {

namespace {

constexpr double degree = 3.14159265358979323846 / 180;
constexpr long rows_outside = 16;  // on either side, so that no end of the spline lies within the
                                   // run
constexpr double window_outside = 8.5;  // rows

std::string quoted(const std::string& word) { return fmt::format("\"{}\"", word); }

int decimals_of(const std::string& unit) {
  return unit == "ns" ? 0 : unit == "us" ? 3 : unit == "ms" ? 6 : 9;
}

double in_seconds(const std::string& unit) { return std::pow(10, decimals_of(unit) - 9); }

/// A time in the unit, to its last nanosecond.
std::string stamp(std::int64_t ns, const std::string& unit) {
  const int decimals = decimals_of(unit);
  if (decimals == 0) return std::to_string(ns);
  const auto whole = static_cast<std::int64_t>(std::llround(std::pow(10, decimals)));
  return fmt::format("{}.{:0{}}", ns / whole, ns % whole, decimals);
}

using Columns = std::vector<std::pair<std::string, double>>;

/// The numbers of a row except its time.
Columns columns(const Log& log, const Log::Sample& s, bool of_rates) {
  const double angle = log.spelling.in_degrees ? degree : 1;
  Columns result;
  const auto add = [&result](std::initializer_list<const char*> names, const auto& values) {
    Eigen::Index i = 0;
    for (const char* const name : names) result.emplace_back(name, values[i++]);
  };
  if (of_rates) {
    add({"wx", "wy", "wz"}, Vector(s.angular_velocity / angle));
    if (!log.shift.isZero(0)) add({"ax", "ay", "az"}, s.acceleration);
  } else {
    const Eigen::Matrix3d R = s.attitude.toRotationMatrix();
    const Vector turns(std::atan2(R(1, 0), R(0, 0)), std::asin(-R(2, 0)),
                       std::atan2(R(2, 1), R(2, 2)));
    if (log.spelling.has_angles) {
      add({"yaw", "pitch", "roll"}, Vector(turns / angle));
    } else {
      const Eigen::Quaterniond& q = s.attitude;
      add({"qw", "qx", "qy", "qz"}, Eigen::Vector4d(q.w(), q.x(), q.y(), q.z()));
    }
    add({"x", "y", "z"}, s.place);
  }
  if (log.spelling.has_other_column) result.emplace_back("battery", 12.5);
  if (log.spelling.columns_reversed) std::reverse(result.begin(), result.end());
  return result;
}

std::string header_name(const Spelling& spelling, const std::string& column) {
  return spelling.header == LogHeader::usual ? column : fmt::format("k_{}", column);
}

class Writer {
 public:
  explicit Writer(const Log& log, bool of_rates)
      : log_(log), how_(log.spelling), rates_(of_rates) {}

  std::string all(double t_end) {
    for (int i = 0; i < how_.lines_before; ++i) add("a line before the header");
    if (how_.header != LogHeader::none) add_header();
    const long before = how_.begins_at_zero ? 0 : rows_outside;
    const long rows = static_cast<long>(std::ceil(t_end / log_.step)) + before + rows_outside;
    for (long i = -before; i <= rows - before; ++i) add_row(i);
    return std::move(text_);
  }

 private:
  void add(const std::string& line) { text_ += line + (how_.ends_with_cr ? "\r\n" : "\n"); }

  void add_fields(const std::string& begin, const std::vector<std::string>& fields) {
    std::string line = begin;
    for (std::size_t i = 0; i < fields.size(); ++i) {
      if (i > 0) line += how_.separator;
      line += fields[i];
    }
    add(line);
  }

  void add_header() {
    std::vector<std::string> names{header_name(how_, "t")};
    for (const auto& [name, value] : columns(log_, log_.at(0), rates_)) {
      names.push_back(header_name(how_, name));
    }
    add_fields(how_.header_is_comment ? "# " : "", names);
    for (int i = 0; i < how_.lines_after; ++i) add("a line after the header");
  }

  [[nodiscard]] std::string with_mark(std::string digits) const {
    if (how_.decimal_comma) std::replace(digits.begin(), digits.end(), '.', ',');
    return digits;
  }

  void add_values(const std::string& time, double t) {
    std::vector<std::string> fields{with_mark(time)};
    for (const auto& [name, value] : columns(log_, log_.at(t), rates_)) {
      fields.push_back(with_mark(text(value)));
    }
    add_fields("", fields);
  }

  /// Some rows occur twice. One of the two is then wrong, unless their mean is requested.
  void add_row(long i) {
    const std::int64_t ns = std::llround(static_cast<double>(i) * log_.step * 1e9);
    const bool is_stamped = how_.time_zero != 0;
    const double t =
        is_stamped ? static_cast<double>(ns) * 1e-9 : static_cast<double>(i) * log_.step;
    const std::string time = is_stamped ? stamp(how_.time_zero + ns, how_.time_unit)
                                        : text(t / in_seconds(how_.time_unit));
    const bool twice = !how_.duplicates.empty() && i % 7 == 3;
    const double wrong = how_.duplicates == "mean" ? t : t + log_.step;
    if (twice && how_.duplicates == "last") add_values(time, wrong);
    add_values(time, t);
    if (twice && how_.duplicates != "last") add_values(time, wrong);
  }

  const Log& log_;
  const Spelling& how_;
  bool rates_;
  std::string text_;
};

void add_column_keys(const Log& log, bool of_rates, Keys& keys) {
  if (log.spelling.header == LogHeader::usual) return;
  std::string all;
  int number = 0;
  const auto add = [&](const std::string& name) {
    number += 1;
    if (name == "battery") return;
    const std::string value = log.spelling.header == LogHeader::named
                                  ? quoted(header_name(log.spelling, name))
                                  : std::to_string(number);
    all += (all.empty() ? "" : ", ") + name + " = " + value;
  };
  add("t");
  for (const auto& [name, value] : columns(log, log.at(0), of_rates)) add(name);
  keys.emplace_back("columns", fmt::format("{{ {} }}", all));
  if (log.spelling.header == LogHeader::none) keys.emplace_back("header", "\"none\"");
}

void add_time_keys(const Log& log, double t_end, Keys& keys) {
  const Spelling& how = log.spelling;
  if (how.time_unit != "s") keys.emplace_back("time_unit", quoted(how.time_unit));
  if (how.begins_at_zero) {
    keys.emplace_back("time_zero", "\"first\"");
  } else if (how.time_zero != 0) {
    const std::string zero = stamp(how.time_zero, how.time_unit);
    keys.emplace_back("time_zero", how.time_unit == "ns" ? zero : quoted(zero));
  }
  if (how.has_window) {
    const double outside = window_outside * log.step;
    keys.emplace_back("window", list(std::vector<double>{-outside, t_end + outside}));
  }
  if (!how.longest_gap.empty()) keys.emplace_back("longest_gap", how.longest_gap);
  if (!how.duplicates.empty()) keys.emplace_back("duplicates", quoted(how.duplicates));
}

/// Start values that a log of rates does not contain.
void add_start_keys(const Log& log, Keys& keys) {
  const Spelling& how = log.spelling;
  double rows = how.begins_at_zero ? 0 : how.has_window ? 8 : rows_outside;
  const Log::Sample start = log.at(-rows * log.step);
  const Eigen::Quaterniond& q = start.attitude;
  keys.emplace_back("attitude", list(std::vector<double>{q.w(), q.x(), q.y(), q.z()}));
  keys.emplace_back("origin_velocity", list(start.velocity));
  if (log.is_kinematic) keys.emplace_back("acceleration", "\"kinematic\"");
  if (log.says_gravity) keys.emplace_back("gravity", list(log.gravity));
}

}  // namespace

std::string text(double x) {
  char buffer[32];
  const auto end = std::to_chars(std::begin(buffer), std::end(buffer), x).ptr;
  return {std::begin(buffer), end};
}

Log::Sample Log::at(double t) const {
  const double s = std::sin(frequency * t + phase);
  const double ds = frequency * std::cos(frequency * t + phase);
  const Eigen::Vector4d f = from.value_or(Eigen::Vector4d(1, 0, 0, 0));
  const Eigen::Quaterniond q =
      Eigen::Quaterniond(f[0], f[1], f[2], f[3]) *
      Eigen::Quaterniond(Eigen::AngleAxisd(amplitude * s, axis.normalized()));
  const Vector inertial =
      -frequency * frequency * s * shift - (is_kinematic ? Vector(Vector::Zero()) : gravity);
  return {q, s * shift, amplitude * ds * axis.normalized(), ds * shift, q.conjugate() * inertial};
}

std::string Log::csv(double t_end, bool of_rates) const {
  return Writer(*this, of_rates).all(t_end);
}

Keys Log::keys(const std::string& file, double t_end, bool of_rates) const {
  Keys result{{"kind", of_rates ? "\"rates\"" : "\"table\""}, {"file", quoted(file)}};
  add_column_keys(*this, of_rates, result);
  const bool turns = of_rates || spelling.has_angles;
  if (turns && spelling.in_degrees) result.emplace_back("angles", "\"deg\"");
  if (spelling.says_separator) {
    const char s = spelling.separator;
    const std::string word = s == '\t' ? "tab" : s == ' ' ? "blanks" : std::string(1, s);
    result.emplace_back("separator", quoted(word));
  }
  if (spelling.decimal_comma) result.emplace_back("decimal", "\",\"");
  if (spelling.lines_before > 0) result.emplace_back("skip", std::to_string(spelling.lines_before));
  if (spelling.lines_after > 0 && spelling.header != LogHeader::none) {
    result.emplace_back("skip_after_header", std::to_string(spelling.lines_after));
  }
  add_time_keys(*this, t_end, result);
  if (!spelling.sigma.empty()) result.emplace_back("sigma", spelling.sigma);
  if (of_rates) add_start_keys(*this, result);
  return result;
}

}  // namespace differential
