#include <charconv>
#include <cmath>
#include <limits>
#include <string>

#include <dynamics/file/log_header.hpp>
#include <dynamics/file/log_options.hpp>
#include <dynamics/file/log_text.hpp>

namespace kreisel::detail {

namespace {

/// The columns that a log may have, by name.
std::vector<std::string> column_names(const std::vector<LogRequest>& requests) {
  std::vector<std::string> names{"t"};
  for (const LogRequest& request : requests) {
    for (const LogColumnGroup& group : request.one_of) {
      names.insert(names.end(), group.names.begin(), group.names.end());
    }
  }
  return names;
}

void read_column(Section& columns, const std::string& name, LogOptions& options) {
  const toml::node* const node = columns.find(name);
  if (node == nullptr) return;
  constexpr std::int64_t most = 100'000;
  if (const auto* const text = node->as_string()) {
    if (text->get().empty()) columns.refuse(name, "is empty");
    options.columns[name] = text->get();
  } else if (const auto* const number = node->as_integer()) {
    if (number->get() < 1 || number->get() > most) {
      columns.refuse(name, "is no column: they are numbered from 1 to 100000");
      return;
    }
    options.columns[name] = static_cast<std::size_t>(number->get());
  } else {
    columns.refuse(name, "must be the name of a column, or its number from 1");
  }
}

void read_columns(Section& section, const std::vector<LogRequest>& requests, LogOptions& options) {
  auto columns = section.section("columns");
  if (!columns) return;
  for (const std::string& name : column_names(requests)) read_column(*columns, name, options);
  columns->finish();
}

/// Checks that `columns` names whole groups, and one group for each quantity.
void check_groups(Section& section, const std::vector<LogRequest>& requests,
                  const LogOptions& options) {
  for (const LogRequest& request : requests) {
    std::string given;
    for (const LogColumnGroup& group : request.one_of) {
      std::vector<std::string> missing;
      std::vector<std::string> present;
      for (const std::string& name : group.names) {
        (options.columns.contains(name) ? present : missing).push_back(name);
      }
      if (present.empty()) continue;
      if (!missing.empty()) {
        section.refuse("columns", "names " + listed(present) + " but not " + listed(missing));
      }
      if (!given.empty()) {
        section.refuse("columns", "gives the " + request.title + " twice, by " + given +
                                      " and by " + listed(present));
      }
      given = listed(present);
    }
  }
}

std::size_t read_count(Section& section, std::string_view key) {
  const toml::node* const node = section.find(key);
  if (node == nullptr) return 0;
  const auto* const number = node->as_integer();
  constexpr std::int64_t most = 1'000'000;
  if (number == nullptr || number->get() < 0 || number->get() > most) {
    section.refuse(key, "must be a whole number of lines, 0 to 1000000");
    return 0;
  }
  return static_cast<std::size_t>(number->get());
}

/// The digits of the number as in the file, up to 15 significant ones.
std::string shortest(double value) {
  char text[32];
  const auto [end, error] = std::to_chars(std::begin(text), std::end(text), value);
  return {std::begin(text), end};
}

void read_time_zero(Section& section, LogOptions& options) {
  const toml::node* const node = section.find("time_zero");
  if (node == nullptr) return;
  if (const auto* const text = node->as_string()) {
    if (text->get() == "first" || written_number(text->get(), '.')) {
      options.time_zero = text->get();
    } else {
      section.refuse("time_zero", "must be a number in time_unit, or \"first\"");
    }
  } else if (const auto* const whole = node->as_integer()) {
    options.time_zero = std::to_string(whole->get());
  } else if (const auto number = section.number("time_zero", dimension::time)) {
    options.time_zero = shortest(*number);
  }
}

void read_time(Section& section, LogOptions& options) {
  const bool has_unit = section.has("time_unit");
  const std::string unit = section.choice("time_unit", {"s", "ms", "us", "ns"});
  if (has_unit) {
    options.time_unit = unit == "ms"   ? LogTimeUnit::ms
                        : unit == "us" ? LogTimeUnit::us
                        : unit == "ns" ? LogTimeUnit::ns
                                       : LogTimeUnit::s;
  }
  read_time_zero(section, options);
  if (const auto window = section.numbers("window", 2, dimension::time)) {
    options.window = {(*window)[0], (*window)[1]};
    if (!((*window)[0] < (*window)[1])) section.refuse("window", "must increase: [from, to]");
  }
  const toml::node* const gap = section.find("longest_gap");
  if (gap != nullptr && gap->is_string() && !section.has_number("longest_gap")) {
    (void)section.choice("longest_gap", {"any"});
    options.longest_gap = std::numeric_limits<double>::infinity();
  } else {
    options.longest_gap = section.number("longest_gap", dimension::time, Range::positive);
  }
  const std::string duplicates = section.choice("duplicates", {"error", "first", "last", "mean"});
  options.duplicates = duplicates == "first"  ? LogDuplicates::first
                       : duplicates == "last" ? LogDuplicates::last
                       : duplicates == "mean" ? LogDuplicates::mean
                                              : LogDuplicates::error;
  if (section.choice("time_stamps", {"auto", "exact"}) == "exact") {
    options.time_stamps = LogTimeStamps::exact;
  }
}

void read_writing(Section& section, LogOptions& options) {
  const std::string separator = section.choice("separator", {"auto", ",", ";", "tab", "blanks"});
  options.separator = separator == "auto"     ? '\0'
                      : separator == "tab"    ? '\t'
                      : separator == "blanks" ? ' '
                                              : separator.front();
  options.decimal = section.choice("decimal", {".", ","}).front();
  if (options.separator == ',' && options.decimal == ',') {
    section.refuse("decimal", "',' is the separator too");
  }
  options.skip = read_count(section, "skip");
  options.header = section.choice("header", {"auto", "none"}) == "auto";
  options.skip_after_header = read_count(section, "skip_after_header");
  if (!options.header && options.skip_after_header > 0) {
    section.refuse("skip_after_header", "needs a header; without one give 'skip'");
  }
}

/// Suggests keys with which a log that begins late covers a run from t_begin on, as the end of a
/// message.
std::string begin_hint(const LogOptions& options, const std::vector<double>& times,
                       double t_begin) {
  const double begin = times.front();
  if (options.window) {
    return ": increase  time_zero  by " + shown_time(begin - t_begin) +
           " s and move  window  back by as much";
  }
  constexpr double since_1970 = 1e8;  // s; a log that is newer than 1973 and counts from 1970
  const double step = (times.back() - begin) / static_cast<double>(times.size() - 1);
  const char* unit = nullptr;
  if (begin > 1e3 * since_1970) unit = "ms";
  if (begin > 1e6 * since_1970 || step > 1e3) unit = "us";
  if (begin > 1e9 * since_1970 || step > 1e6) unit = "ns";
  const bool hint = unit != nullptr && !options.time_unit;
  return ": give  " + (hint ? "time_unit = \"" + std::string(unit) + "\"  and  " : "") +
         "time_zero = \"first\"";
}

}  // namespace

LogOptions read_log_options(Section& section, const std::vector<LogRequest>& requests,
                            const std::array<double, 2>& run) {
  LogOptions options;
  options.run = run;
  read_columns(section, requests, options);
  check_groups(section, requests, options);
  if (section.has("angles")) options.degrees = section.choice("angles", {"rad", "deg"}) == "deg";
  read_writing(section, options);
  read_time(section, options);
  return options;
}

void check_covers_run(Section& section, const std::string& name, const LogOptions& options,
                      const std::vector<double>& times, const std::array<double, 2>& run) {
  const std::string what = std::string(options.window ? "the window of '" : "'") + name + "' ";
  if (times.front() > run[0]) {
    section.refuse("file", what + "begins at t = " + shown_time(times.front()) +
                               " s, the run at t = " + shown_time(run[0]) + " s" +
                               begin_hint(options, times, run[0]));
  } else if (times.back() < run[1]) {
    section.refuse("file", what + "ends at t = " + shown_time(times.back()) +
                               " s, the run at t = " + shown_time(run[1]) +
                               " s: give  t_end = " + shown_time(times.back()) + "  in [solve]");
  }
}

}  // namespace kreisel::detail
