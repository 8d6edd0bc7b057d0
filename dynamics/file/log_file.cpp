#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <sstream>
#include <utility>

#include <dynamics/file/log_file.hpp>
#include <dynamics/file/log_layout.hpp>
#include <dynamics/file/log_stamps.hpp>
#include <dynamics/file/log_text.hpp>

namespace kreisel {

namespace {

using detail::ExactDecimal;
using detail::PlacedColumn;
using detail::WrittenNumber;

constexpr double degree = std::numbers::pi / 180;

/// Rows kept before and after the run: a sample this far away changes a quintic spline by 0.43^64 =
/// 4e-24 of its value.
constexpr std::size_t margin = 64;
constexpr std::size_t most_rows = 10'000'000;

int decimal_power(LogTimeUnit unit) {
  switch (unit) {
    case LogTimeUnit::s: return 0;
    case LogTimeUnit::ms: return -3;
    case LogTimeUnit::us: return -6;
    case LogTimeUnit::ns: return -9;
  }
  return 0;
}

bool turns(LogQuantity quantity) {
  return quantity == LogQuantity::angle || quantity == LogQuantity::angular_rate;
}

std::string shown(double value) {
  std::ostringstream text;
  text.precision(10);
  text << value;
  return text.str();
}

/// The value rounded up to two digits.
std::string rounded_up(double value) {
  const double unit = std::pow(10, std::floor(std::log10(value)) - 1);
  return shown(std::ceil(value / unit * (1 - 1e-12)) * unit);
}

/// The resolution with which the numbers of a column were written.
class Spacing {
 public:
  void take(const WrittenNumber& number) {
    decimals_ = std::max(decimals_, number.decimals);
    digits_ = std::max(digits_, number.digits);
    least_ = std::min(least_, number.value);
    most_ = std::max(most_, number.value);
  }

  /// The value of LogColumn::resolution, in the unit of the file.
  [[nodiscard]] double value() const {
    if (!(least_ < most_) && decimals_ <= 0) return 0;
    const double greatest = std::max(std::abs(least_), std::abs(most_));
    const double by_decimals = std::pow(10, -decimals_);
    if (greatest == 0 || digits_ == 0) return by_decimals;
    return std::max(by_decimals, std::pow(10, std::floor(std::log10(greatest)) + 1 - digits_));
  }

 private:
  int decimals_ = std::numeric_limits<int>::min();
  int digits_ = 0;
  double least_ = std::numeric_limits<double>::infinity();
  double most_ = -std::numeric_limits<double>::infinity();
};

class LogReader {
 public:
  LogReader(const std::filesystem::path& path, const std::vector<LogRequest>& requests,
            const LogOptions& options)
      : options_(options),
        lines_(path),
        layout_(detail::find_layout(lines_, path.string(), requests, options)),
        spacing_(layout_.columns.size()),
        values_(layout_.columns.size()) {
    log_.path = path;
    for (const PlacedColumn& column : layout_.columns) log_.columns.push_back({column.name, {}, 0});
    if (options.time_zero == "first") return;
    if (!detail::written_number(options.time_zero, '.')) {
      throw InvalidInput("time_zero = '" + options.time_zero + "' is neither a number nor 'first'");
    }
    time_zero_ = detail::exact_decimal(options.time_zero, '.');
  }

  Log read() {
    while (lines_.next()) {
      if (lines_.number() < layout_.first_row) continue;
      const std::string_view text = detail::trimmed(lines_.text());
      if (!text.empty() && !detail::is_comment(text)) take_row();
    }
    refuse_if_empty();
    check_gaps();
    set_resolutions();
    correct_times();
    return std::move(log_);
  }

 private:
  [[noreturn]] void refuse(const std::string& reason) const {
    throw InvalidInput(log_.path.string() + ":" + std::to_string(lines_.number()) + ": " + reason);
  }

  [[nodiscard]] std::vector<double>& times() { return log_.columns.front().values; }

  /// "line 5 (t = 0.1 s)"
  [[nodiscard]] std::string line_of(std::size_t row) const {
    return "line " + std::to_string(log_.lines[row]) +
           " (t = " + shown(log_.columns.front().values[row]) + " s)";
  }

  void take_row() {
    if (!detail::split_fields(lines_.text(), layout_.separator, fields_)) {
      refuse("a quote is not closed, or text follows a closed one");
    }
    const detail::FieldCount count = detail::count_fields(fields_);
    if (!agree(count, layout_.fields)) {
      refuse(std::to_string(count.all) + " fields where line " + std::to_string(layout_.first_row) +
             " has " + std::to_string(layout_.fields.all));
    }
    const double t = take_time();
    if (!is_wanted(t)) return;
    values_[0] = t;
    for (std::size_t i = 1; i < values_.size(); ++i) take_value(i);
    check_quaternions();
    if (!times().empty() && !(t > times().back())) return take_late_row(t);
    if (log_.size() == most_rows) {
      refuse("the log has more than ten million rows; read a part of it by  window = [from, to]");
    }
    append();
  }

  [[nodiscard]] WrittenNumber number(std::size_t i) {
    const PlacedColumn& column = layout_.columns[i];
    const std::string_view field =
        column.position < fields_.size() ? fields_[column.position] : std::string_view{};
    const auto written = detail::written_number(field, options_.decimal);
    if (!written) refuse(detail::why_no_number(field, column.name, options_));
    return *written;
  }

  /// The time in seconds after time_zero, rounded once.
  double take_time() {
    const WrittenNumber written = number(0);
    const ExactDecimal exact =
        detail::exact_decimal(fields_[layout_.columns[0].position], options_.decimal);
    const bool is_first = !has_rows_;
    if (is_first && options_.time_zero == "first") time_zero_ = exact;
    const int power = decimal_power(options_.time_unit.value_or(LogTimeUnit::s));
    const double t = detail::nearest_double(detail::difference(exact, time_zero_), power);
    if (!std::isfinite(t)) refuse("t is not a finite number");
    if (is_first || t < log_.first_time) log_.first_time = t;
    if (is_first || t > log_.last_time) log_.last_time = t;
    has_rows_ = true;
    spacing_[0].take(written);
    return t;
  }

  /// True if the row lies in the window, or in the run and its margins.
  bool is_wanted(double t) {
    if (options_.window) return t >= (*options_.window)[0] && t <= (*options_.window)[1];
    if (!options_.run) return true;
    if (t < (*options_.run)[0] && log_.size() >= 2 * margin && times().back() < t) {
      forget_first(margin);
    }
    const bool after = !times().empty() && t > times().back() && t > (*options_.run)[1];
    return !after || ++rows_after_ <= margin;
  }

  void take_value(std::size_t i) {
    const PlacedColumn& column = layout_.columns[i];
    const WrittenNumber written = number(i);
    spacing_[i].take(written);
    values_[i] = written.value;
    if (!turns(column.quantity)) return;
    if (options_.degrees.value_or(false)) {
      values_[i] *= degree;
    } else if (!options_.degrees && !column.has_unit && column.name == "pitch" &&
               std::abs(written.value) > std::numbers::pi / 2 + 0.01) {
      refuse(
          "pitch = " + shown(written.value) +
          " is more than a right angle in radian: give  angles = \"deg\"  (or \"rad\" if it is)");
    }
  }

  /// Calls f(i) with the first column of each quaternion.
  template <class F>
  void for_quaternions(const F& f) const {
    for (std::size_t i = 1; i + 3 < values_.size(); ++i) {
      if (layout_.columns[i].quantity != LogQuantity::quaternion) continue;
      f(i);
      i += 3;
    }
  }

  void check_quaternions() const {
    for_quaternions([this](std::size_t i) {
      double square = 0;
      for (std::size_t k = i; k < i + 4; ++k) square += values_[k] * values_[k];
      const double norm = std::sqrt(square);
      if (std::abs(norm - 1) <= 0.01) return;
      refuse("the quaternion has norm " + shown(norm) + " and not 1 (t = " + shown(values_[0]) +
             " s): check  columns, or leave such rows out by  window = [from, to]");
    });
  }

  void append() {
    for (std::size_t i = 0; i < values_.size(); ++i) log_.columns[i].values.push_back(values_[i]);
    log_.lines.push_back(lines_.number());
    merged_ = 1;
  }

  /// Handles a row whose time is not later than that of the row before.
  void take_late_row(double t) {
    const std::size_t last = log_.size() - 1;
    if (t < times().back()) {
      refuse("t = " + shown(t) + " s is earlier than in " + line_of(last));
    }
    for (std::size_t i = 1; i < values_.size(); ++i) {
      differs_ = differs_ || values_[i] != log_.columns[i].values[last];
    }
    switch (options_.duplicates) {
      case LogDuplicates::error:
        refuse("t = " + shown(t) + " s is the same as in " + line_of(last) +
               ": give  duplicates = \"first\"  (or \"last\" or \"mean\")");
      case LogDuplicates::first: return;
      case LogDuplicates::last:
        for (std::size_t i = 0; i < values_.size(); ++i) log_.columns[i].values[last] = values_[i];
        log_.lines[last] = lines_.number();
        return;
      case LogDuplicates::mean: return take_mean(last);
    }
  }

  void take_mean(std::size_t last) {
    for_quaternions([&](std::size_t i) {
      double cosine = 0;
      for (std::size_t k = i; k < i + 4; ++k) cosine += values_[k] * log_.columns[k].values[last];
      if (cosine >= 0) return;
      for (std::size_t k = i; k < i + 4; ++k) values_[k] = -values_[k];
    });
    ++merged_;
    for (std::size_t i = 1; i < values_.size(); ++i) {
      double& mean = log_.columns[i].values[last];
      double change = values_[i] - mean;
      if (layout_.columns[i].quantity == LogQuantity::angle) {
        change = std::remainder(change, 2 * std::numbers::pi);
      }
      mean += change / static_cast<double>(merged_);
    }
  }

  void forget_first(std::size_t count) {
    const auto n = static_cast<std::ptrdiff_t>(count);
    for (LogColumn& column : log_.columns) {
      column.values.erase(column.values.begin(), column.values.begin() + n);
    }
    log_.lines.erase(log_.lines.begin(), log_.lines.begin() + n);
  }

  void forget_after(std::size_t last) {
    for (LogColumn& column : log_.columns) column.values.resize(last + 1);
    log_.lines.resize(last + 1);
  }

  void refuse_if_empty() const {
    if (log_.size() > 0) return;
    std::string reason = log_.path.string() + ": no rows";
    if (has_rows_) {
      reason += " between " + shown((*options_.window)[0]) + " and " +
                shown((*options_.window)[1]) +
                " s, the window; the log goes from t = " + shown(log_.first_time) + " s to " +
                shown(log_.last_time) + " s";
    }
    throw InvalidInput(reason);
  }

  [[nodiscard]] double step(std::size_t row) { return times()[row + 1] - times()[row]; }

  [[nodiscard]] double median_step() {
    std::vector<double> steps(log_.size());
    std::adjacent_difference(times().begin(), times().end(), steps.begin());
    const auto middle = steps.begin() + 1 + (std::ssize(steps) - 1) / 2;
    std::nth_element(steps.begin() + 1, middle, steps.end());
    return *middle;
  }

  /// Refuses gaps within the run, and drops the rows beyond gaps outside the run.
  void check_gaps() {
    if (log_.size() < 2) return;
    std::size_t first = 0;
    std::size_t last = log_.size() - 1;
    if (!options_.window && options_.run) {
      while (first + 1 < log_.size() && times()[first + 1] <= (*options_.run)[0]) ++first;
      while (last > first + 1 && times()[last - 1] >= (*options_.run)[1]) --last;
    }
    const double median = median_step();
    const double allowed = options_.longest_gap.value_or(10 * median) * (1 + 1e-9);
    refuse_gap(first, last, allowed, median);
    while (last + 1 < log_.size() && step(last) <= allowed) ++last;
    forget_after(last);
    while (first > 0 && step(first - 1) <= allowed) --first;
    forget_first(first);
  }

  void refuse_gap(std::size_t first, std::size_t last, double allowed, double median) {
    std::size_t longest = first;
    std::size_t gaps = 0;
    for (std::size_t i = first; i < last; ++i) {
      if (step(i) > allowed) ++gaps;
      if (step(i) > step(longest)) longest = i;
    }
    if (gaps == 0) return;
    const double gap = step(longest);
    throw InvalidInput(
        log_.where(longest + 1) + ": a gap of " + shown(gap) + " s between " + line_of(longest) +
        " and " + line_of(longest + 1) +
        (gaps > 1 ? ", the longest of " + std::to_string(gaps) : "") + "; allowed are " +
        shown(allowed / (1 + 1e-9)) + " s" +
        (options_.longest_gap ? "" : ", 10 times the median step of " + shown(median) + " s") +
        ": give  longest_gap = " + rounded_up(gap) + "  to interpolate across, or  window = [" +
        shown(times()[first]) + ", " + shown(times()[longest]) + "]  to read one side of it");
  }

  void set_resolutions() {
    for (std::size_t i = 0; i < log_.columns.size(); ++i) {
      double unit = 1;
      if (i == 0) unit = std::pow(10, decimal_power(options_.time_unit.value_or(LogTimeUnit::s)));
      if (turns(layout_.columns[i].quantity) && options_.degrees.value_or(false)) unit = degree;
      log_.columns[i].resolution = spacing_[i].value() * unit;
    }
  }

  /// Finds how far the time stamps may be wrong. Stamps that several rows shared are so coarse that
  /// all may be off by their unit. Rounded stamps of a regular rate are replaced by its times.
  void correct_times() {
    const double unit = log_.columns[0].resolution;
    if (differs_) {
      log_.late = unit;
    } else if (options_.time_stamps == LogTimeStamps::automatic) {
      auto regular = detail::regular_times(log_.columns, unit);
      if (!regular) return;
      times() = std::move(*regular);
      log_.late = unit / 2;
    }
  }

  const LogOptions& options_;
  detail::LogLines lines_;
  detail::LogLayout layout_;
  ExactDecimal time_zero_;
  std::vector<std::string_view> fields_;
  std::vector<Spacing> spacing_;
  std::vector<double> values_;  ///< of the current row
  Log log_;
  bool has_rows_ = false;
  bool differs_ = false;        ///< rows of the same time had different values
  std::size_t rows_after_ = 0;  ///< within the run
  std::size_t merged_ = 1;      ///< rows of the file in the last row of the log
};

}  // namespace

bool Log::has(std::string_view name) const {
  return std::any_of(columns.begin(), columns.end(),
                     [name](const LogColumn& column) { return column.name == name; });
}

const LogColumn& Log::column(std::string_view name) const {
  const auto found = std::find_if(columns.begin(), columns.end(),
                                  [name](const LogColumn& column) { return column.name == name; });
  if (found == columns.end()) {
    throw InvalidInput(path.string() + ": the log has no column '" + std::string(name) + "'");
  }
  return *found;
}

std::string Log::where(std::size_t row) const {
  return path.string() + ":" + std::to_string(lines[row]);
}

Log read_log(const std::filesystem::path& path, const std::vector<LogRequest>& requests,
             const LogOptions& options) {
  return LogReader(path, requests, options).read();
}

}  // namespace kreisel
