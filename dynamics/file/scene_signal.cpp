#include <algorithm>
#include <array>
#include <cstddef>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <dynamics/file/log_file.hpp>
#include <dynamics/file/log_options.hpp>
#include <dynamics/file/scene_signal.hpp>
#include <dynamics/file/signal_log.hpp>
#include <dynamics/guide/log_noise.hpp>
#include <dynamics/guide/value_log.hpp>

namespace kreisel::detail {

namespace {

template <class Value>
constexpr std::size_t width = std::is_same_v<Value, double> ? 1 : 3;

/// The value whose numbers begin at index `begin`.
template <class Value>
[[nodiscard]] Value value_at(const std::vector<double>& numbers, std::size_t begin) {
  if constexpr (std::is_same_v<Value, double>) {
    return numbers[begin];
  } else {
    return {numbers[begin], numbers[begin + 1], numbers[begin + 2]};
  }
}

template <class Value>
[[nodiscard]] Value value_of(Section& table, std::string_view key, const KeyDimension& of) {
  const auto numbers =
      width<Value> == 1 ? table.single(key, of) : table.numbers(key, width<Value>, of);
  return value_at<Value>(numbers.value_or(std::vector<double>(width<Value>, 0)), 0);
}

template <class Value>
[[nodiscard]] Signal<Value> read_sum(Section& table, const KeyDimension& of) {
  const auto constant = value_of<Value>(table, "constant", of);
  const auto rate = value_of<Value>(table, "rate", per_second(of));
  std::vector<typename Signal<Value>::Term> terms;
  for (Section& term : table.sections("terms")) {
    for (const char* const key : {"amplitude", "frequency"}) {
      if (!term.has(key) && !term.has(std::string(key) + "_deg")) term.refuse_missing(key);
    }
    const auto amplitude = value_of<Value>(term, "amplitude", of);
    const double frequency = term.angle("frequency", dimension::angular_rate).value_or(1);
    if (frequency < 0) {
      term.refuse(term.has("frequency") ? "frequency" : "frequency_deg",
                  "must not be below 0; the other direction is an 'amplitude' of the other sign");
    }
    if (SignalLogs* const signals = table.signal_logs()) signals->add_frequency(frequency);
    terms.push_back({amplitude, frequency, term.angle("phase", dimension::angle).value_or(0)});
    term.finish();
  }
  return Signal<Value>(constant, rate, std::move(terms));
}

template <class Value>
[[nodiscard]] Signal<Value> read_points(Section& table, const char* key, const KeyDimension& of) {
  const auto rows = table.timed_rows(key, width<Value>, of);
  if (!rows) return {};
  typename Signal<Value>::Points points;
  for (const std::vector<double>& row : *rows) {
    points.emplace_back(row.front(), value_at<Value>(row, 1));
  }
  return std::string_view(key) == "steps" ? Signal<Value>::steps(points)
                                          : Signal<Value>::broken_line(points);
}

/// The quantity of a log's column. A header with another unit is refused.
LogQuantity quantity(const KeyDimension& of) {
  if (of == dimension::length) return LogQuantity::length;
  if (of == dimension::angle) return LogQuantity::angle;
  if (of == dimension::angular_rate) return LogQuantity::angular_rate;
  if (of == dimension::acceleration) return LogQuantity::acceleration;
  return LogQuantity::number;
}

/// The samples of a log of one or three columns.
ValueLog samples(const Log& log, const std::vector<std::string>& names) {
  ValueLog result{log.column("t").values, {}, log.late};
  result.values.assign(log.size(), Vector3<double>::Zero());
  for (std::size_t k = 0; k < names.size(); ++k) {
    const std::vector<double>& column = log.column(names[k]).values;
    for (std::size_t i = 0; i < log.size(); ++i) {
      result.values[i][static_cast<Eigen::Index>(k)] = column[i];
    }
  }
  return result;
}

/// The smoothing spline of a log. Without `sigma` the noise is estimated from the log.
template <class Value>
[[nodiscard]] LogSpline read_smoothing(Section& table, const ValueLog& log,
                                       const KeyDimension& of) {
  const auto given = table.number("sigma", of, Range::not_negative);
  LogNoise::Components sigma = smoothing_sigma(noise_of(log));
  if (given) sigma.segment<width<Value>>(4).setConstant(*given);
  return smoothing(log, sigma);
}

/// The signal of a log: columns t and value, or t, x, y, z.
template <class Value>
[[nodiscard]] Signal<Value> read_log(Section& table, const KeyDimension& of) {
  (void)table.has("sigma");  // read with the log; a known key also if that fails
  SignalLogs& logs = *table.signal_logs();
  const std::vector<std::string> names = width<Value> == 1
                                             ? std::vector<std::string>{"value"}
                                             : std::vector<std::string>{"x", "y", "z"};
  const std::size_t before = table.mistakes();
  const std::string name = table.required_text("file");
  const std::vector<LogRequest> requests{{"value", {{quantity(of), names, {}, of}}, true}};
  const LogOptions options = read_log_options(table, requests, logs.run());
  if (name.empty() && table.find("file")->is_string()) table.refuse("file", "is empty");
  if (table.mistakes() > before) return {};
  try {
    SceneSignalLog entry;
    if (const SceneSignalLog* const other = logs.replacement()) {
      entry = *other;
    } else {
      entry.file = logs.place(name);
      entry.log = samples(kreisel::read_log(entry.file, requests, options), names);
      entry.spline = read_smoothing<Value>(table, entry.log, of);
      check_covers_run(table, name, options, entry.log.times, logs.run());
    }
    auto signal = logged_signal<Value>(entry.log, entry.spline);
    logs.add(std::move(entry));
    return signal;
  } catch (const InvalidInput& error) {
    table.refuse("file", error.what());
    return {};
  }
}

}  // namespace

template <class Value>
Signal<Value> read_signal_table(Section table, const KeyDimension& of) {
  std::vector<std::string> given;
  for (const char* const key : {"steps", "points", "file", "constant", "rate", "terms"}) {
    if (table.has(key)) given.emplace_back(key);
  }
  Signal<Value> signal;
  if (given.empty()) {
    table.refuse_all(
        "is a function of time: give 'constant', 'rate' and 'terms', or 'steps', 'points' or "
        "'file'");
    table.ignore_rest();
  } else if (const std::string& key = given[0];
             key == "constant" || key == "rate" || key == "terms") {
    signal = read_sum<Value>(table, of);
  } else if (given.size() > 1) {
    table.refuse(key, "is given beside '" + given[1] + "'; one of them says what the signal is");
    table.ignore_rest();
  } else {
    signal =
        key == "file" ? read_log<Value>(table, of) : read_points<Value>(table, key.c_str(), of);
  }
  table.finish();
  return signal;
}

template <class Value>
std::optional<Signal<Value>> read_signal(Section& section, std::string_view key,
                                         const KeyDimension& of) {
  if (!section.has(key)) return std::nullopt;
  if (section.find(key)->is_table()) return read_signal_table<Value>(*section.section(key), of);
  const auto numbers =
      width<Value> == 1 ? section.single(key, of) : section.numbers(key, width<Value>, of);
  if (!numbers) return std::nullopt;
  return Signal<Value>(value_at<Value>(*numbers, 0));
}

std::vector<Signal<double>> read_signals(Section& section, std::string_view key,
                                         const std::vector<Dimension>& each) {
  const std::size_t count = each.size();
  const toml::node* const node = section.find(key);
  const toml::array* const list = node == nullptr ? nullptr : node->as_array();
  std::vector<Signal<double>> signals;
  if (node != nullptr && node->is_table()) {
    for (const Dimension& of : each) signals.push_back(*read_signal<double>(section, key, of));
    return signals;
  }
  const auto is_table = [](const toml::node& item) { return item.is_table(); };
  if (list == nullptr || count == 1 || std::none_of(list->begin(), list->end(), is_table)) {
    const auto numbers = section.number_or_list(key, each);
    if (numbers) signals.assign(numbers->begin(), numbers->end());
    return signals;
  }
  if (list->size() != count) {
    section.refuse(key, "must be " + std::to_string(count) + " numbers or functions of time");
    return {};
  }
  for (std::size_t i = 0; i < count; ++i) {
    const toml::node& item = *list->get(i);
    if (const toml::table* const table = item.as_table()) {
      signals.push_back(read_signal_table<double>(section.element(key, i, *table), each[i]));
    } else {
      signals.emplace_back(section.number_at(key, i, item, each[i]).value_or(0));
    }
  }
  return signals;
}

std::optional<Signal<double>> read_angle_signal(Section& section, const std::string& key,
                                                const Dimension& of) {
  const std::string in_degrees = key + "_deg";
  if (!section.has(in_degrees)) return read_signal<double>(section, key, of);
  if (section.has(key)) section.refuse(in_degrees, "is given in radian too, as '" + key + "'");
  const auto signal = read_signal<double>(section, in_degrees, std::nullopt);
  return signal ? std::optional(signal->scaled(radian_per_degree)) : std::nullopt;
}

template std::optional<Signal<double>> read_signal(Section&, std::string_view, const KeyDimension&);
template std::optional<Signal<Vector3<double>>> read_signal(Section&, std::string_view,
                                                            const KeyDimension&);

}  // namespace kreisel::detail
