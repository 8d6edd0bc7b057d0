#include <algorithm>
#include <iterator>
#include <utility>

#include <dynamics/file/log_header.hpp>
#include <dynamics/file/quoted.hpp>

namespace kreisel::detail {

namespace {

std::string lower_case(std::string_view text) {
  std::string result(text);
  for (char& c : result) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return result;
}

/// The unit of a name without brackets, "yaw_deg" or "Yaw/deg"; nothing if there is none. Short units
/// such as m and s also stand for other words.
std::string unit_at_end(std::string_view name) {
  for (const char* const unit :
       {"deg", "deg/s", "dps", "rpm", "mrad", "mm", "cm", "km", "ft", "ms", "us", "ns"}) {
    for (const char between : {'_', '/'}) {
      if (name.ends_with(between + std::string(unit))) return unit;
    }
  }
  return {};
}

/// The positions of the columns that best match a name. Exact matches come before names that differ
/// in capitals, and these before names that differ in a unit.
std::vector<std::size_t> positions(const HeaderNames& header, std::string_view wanted) {
  const HeaderName name(wanted);
  for (const auto part : {&HeaderName::as_written, &HeaderName::any_case, &HeaderName::plain}) {
    std::vector<std::size_t> found;
    for (std::size_t i = 0; i < header.size(); ++i) {
      if (!(header[i].*part).empty() && header[i].*part == name.*part) found.push_back(i);
    }
    if (!found.empty()) return found;
  }
  return {};
}

std::string in_toml(std::string_view name) {
  std::string result = "\"";
  for (const char c : name) {
    if (c == '"' || c == '\\') result += '\\';
    result += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
  }
  return result + '"';
}

const LogColumnGroup& time_group() {
  static const LogColumnGroup group{LogQuantity::number,
                                    {"t"},
                                    {{"time"},
                                     {"timestamp"},
                                     {"time stamp"},
                                     {"time_s"},
                                     {"t_s"},
                                     {"seconds"},
                                     {"sec"},
                                     {"zeit"}}};
  return group;
}

[[noreturn]] void refuse(const std::string& where, const std::string& reason) {
  throw InvalidInput(where + ": " + reason);
}

bool is_named(const LogColumnGroup& group, const LogOptions& options) {
  return std::any_of(group.names.begin(), group.names.end(),
                     [&](const std::string& name) { return options.columns.contains(name); });
}

void check_whole(const LogColumnGroup& group, const std::string& path, const LogOptions& options) {
  for (const std::string& name : group.names) {
    if (!options.columns.contains(name)) {
      refuse(path, "columns: " + listed(group.names) + " belong together, but '" + name +
                       "' is not given");
    }
  }
}

void check_once(const std::string& path, const LogOptions& options) {
  const auto& all = options.columns;
  for (auto one = all.begin(); one != all.end(); ++one) {
    const auto same = std::find_if(std::next(one), all.end(), [&one](const auto& other) {
      return other.second == one->second;
    });
    if (same == all.end()) continue;
    refuse(path, "columns: '" + one->first + "' and '" + same->first +
                     "' are the same column; give each its own");
  }
}

const char* name(LogTimeUnit unit) {
  switch (unit) {
    case LogTimeUnit::s: return "s";
    case LogTimeUnit::ms: return "ms";
    case LogTimeUnit::us: return "us";
    case LogTimeUnit::ns: return "ns";
  }
  return "s";
}

std::optional<LogTimeUnit> time_unit(const std::string& unit) {
  if (unit == "ms" || unit == "msec") return LogTimeUnit::ms;
  if (unit == "us" || unit == "usec" || unit == "\xC2\xB5s" || unit == "\xCE\xBCs") {
    return LogTimeUnit::us;
  }
  if (unit == "ns" || unit == "nsec") return LogTimeUnit::ns;
  return std::nullopt;
}

/// The units of a quantity in headers: the unit that is read, and others.
struct UnitNames {
  LogQuantity quantity;
  std::vector<std::string> read;
  std::vector<std::string> other;
};

const std::vector<UnitNames>& known_units() {
  static const std::vector<UnitNames> units{
      {LogQuantity::length, {"m"}, {"mm", "cm", "dm", "km", "ft", "in", "nm", "um"}},
      {LogQuantity::angle,
       {"rad"},
       {"deg", "degree", "degrees", "\xC2\xB0", "\xB0", "grad", "gon"}},
      {LogQuantity::angular_rate,
       {"rad/s", "rad s^-1", "rad*s^-1"},
       {"deg/s", "dps", "degree/s", "degrees/s", "\xC2\xB0/s", "\xB0/s", "deg s^-1", "deg/sec",
        "grad/s"}},
      {LogQuantity::acceleration,
       {"m/s^2", "m/s2", "m s^-2", "m/s\xC2\xB2", "m/s\xB2", "m/s/s"},
       {"g", "mg", "cm/s^2", "ft/s^2", "gal"}},
      {LogQuantity::number,
       {},
       {"m/s", "m s^-1", "km/h", "kn", "deg/h", "deg/hr", "\xC2\xB0/h", "\xB0/h"}}};
  return units;
}

bool holds(const std::vector<std::string>& words, const std::string& word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

const UnitNames* units_of(LogQuantity quantity) {
  if (quantity == LogQuantity::number || quantity == LogQuantity::quaternion) return nullptr;
  const auto& known = known_units();
  return &*std::find_if(known.begin(), known.end(),
                        [quantity](const UnitNames& units) { return units.quantity == quantity; });
}

/// The dimension of a column's numbers, if it is known.
std::optional<Dimension> own_dimension(const PlacedColumn& column) {
  if (column.is_time) return dimension::time;
  switch (column.quantity) {
    case LogQuantity::length: return dimension::length;
    case LogQuantity::angle: return dimension::angle;
    case LogQuantity::angular_rate: return dimension::angular_rate;
    case LogQuantity::acceleration: return dimension::acceleration;
    case LogQuantity::quaternion: return std::nullopt;
    case LogQuantity::number: return column.dimension;
  }
  return std::nullopt;
}

/// True if a header has a unit of scene files that is not the SI unit of the column's numbers.
bool has_other_unit(const PlacedColumn& column, const HeaderName& header) {
  const std::optional<Dimension> wanted = own_dimension(column);
  if (!wanted || header.unit.empty()) return false;
  for (const std::string& unit : {header.unit_as_written, header.unit}) {
    try {
      return !(dimension_of(unit) == *wanted && value_with_unit("1 " + unit, wanted) == 1);
    } catch (const InvalidInput&) {  // no unit that scene files know, perhaps in lower case
    }
  }
  return false;
}

/// The reason why the unit in a header does not match the options, or nothing.
std::string wrong_unit(const PlacedColumn& column, const HeaderName& header,
                       const LogOptions& options) {
  const std::string found = "column " + in_quotes(header.as_written) + " for '" + column.name +
                            "' is in " +
                            (is_utf8(header.unit_as_written) ? header.unit_as_written
                                                             : in_quotes(header.unit_as_written));
  const auto read_in = [&found](const std::string& unit) {
    return found + ", and is read in " + unit +
           ": name the right column in  columns, or convert the file";
  };
  const bool is_other = has_other_unit(column, header);
  if (column.is_time) {
    if (options.time_unit) return {};
    if (const auto unit = time_unit(header.unit)) {
      return found + ": give  time_unit = \"" + name(*unit) + "\"  (or the unit that is right)";
    }
    return is_other ? read_in("s") : "";
  }
  const UnitNames* const own = units_of(column.quantity);
  if (own == nullptr) return is_other ? read_in("SI units") : "";
  if (holds(own->read, header.unit)) return {};
  const auto& known = known_units();
  const bool is_known = std::any_of(known.begin(), known.end(), [&header](const UnitNames& units) {
    return holds(units.read, header.unit) || holds(units.other, header.unit);
  });
  if (!is_known && !is_other) return {};
  const bool in_degrees = holds(own->other, header.unit) &&
                          (header.unit.starts_with("d") || header.unit.ends_with("\xB0") ||
                           header.unit.ends_with("\xB0/s"));
  if (in_degrees && options.degrees) return {};
  if (in_degrees) return found + ": give  angles = \"deg\"  (or \"rad\" if the header is wrong)";
  return read_in(own->read.front());
}

class Matcher {
 public:
  Matcher(const HeaderNames& header, const LogOptions& options)
      : header_(&header), options_(&options) {}

  HeaderMatch match(const std::vector<WantedGroup>& wanted) {
    for (const WantedGroup& group : wanted) {
      if (group.by_option) {
        for (const std::string& name : group.one_of.front()->names) {
          place_by_option(*group.one_of.front(), name);
        }
      } else {
        place_by_usual_names(group);
      }
    }
    return std::move(match_);
  }

 private:
  void place(const LogColumnGroup& group, const std::string& name, std::size_t position) {
    PlacedColumn column{name, name == "t", group.quantity, position, false, group.dimension};
    if (position < header_->size()) {
      const HeaderName& header = (*header_)[position];
      const std::string wrong = wrong_unit(column, header, *options_);
      if (match_.wrong_unit.empty()) match_.wrong_unit = wrong;
      const UnitNames* const units = units_of(column.quantity);
      column.has_unit = units != nullptr && holds(units->read, header.unit);
    }
    match_.columns.push_back(std::move(column));
  }

  void note_several(const std::string& name, const std::vector<std::size_t>& found) {
    if (found.size() < 2 || !match_.ambiguous.empty()) return;
    std::vector<std::string> numbers;
    numbers.reserve(found.size());
    for (const std::size_t i : found) numbers.push_back(std::to_string(i + 1));
    match_.ambiguous = "columns " + listed(numbers) + " all fit '" + name +
                       "': give its number,  columns = { .., " + name + " = " + numbers.front() +
                       " }";
  }

  void place_by_option(const LogColumnGroup& group, const std::string& name) {
    const auto& given = options_->columns.find(name)->second;
    if (const auto* const number = std::get_if<std::size_t>(&given)) {
      if (*number > header_->size()) return match_.missing.push_back(name);
      return place(group, name, *number - 1);
    }
    const auto found = positions(*header_, std::get<std::string>(given));
    if (found.empty()) return match_.missing.push_back(name);
    note_several(name, found);
    place(group, name, found.front());
  }

  [[nodiscard]] std::size_t count_found(const std::vector<std::string>& names) const {
    return static_cast<std::size_t>(std::count_if(
        names.begin(), names.end(),
        [this](const std::string& name) { return !positions(*header_, name).empty(); }));
  }

  void place_all(const LogColumnGroup& group, const std::vector<std::string>& headers) {
    for (std::size_t i = 0; i < headers.size(); ++i) {
      const auto found = positions(*header_, headers[i]);
      note_several(group.names[i], found);
      place(group, group.names[i], found.front());
    }
  }

  /// Takes the first alternative whose columns are all in the header, by their own or other usual
  /// names.
  void place_by_usual_names(const WantedGroup& wanted) {
    bool has_some = false;
    for (const LogColumnGroup* const group : wanted.one_of) {
      std::vector<const std::vector<std::string>*> whole;
      std::vector<const std::vector<std::string>*> spellings{&group->names};
      for (const auto& names : group->other_headers) spellings.push_back(&names);
      for (const auto* const names : spellings) {
        const std::size_t found = count_found(*names);
        has_some = has_some || found > 0;
        if (found == names->size()) whole.push_back(names);
        if (found == names->size() && names == &group->names) break;
      }
      if (whole.empty()) continue;
      if (whole.size() > 1 && match_.ambiguous.empty()) {
        match_.ambiguous = "the " + wanted.title + " may be " + listed(*whole[0]) + " or " +
                           listed(*whole[1]) + ": name the columns,  columns = { .., " +
                           group->names.front() + " = " + in_toml(whole[0]->front()) + ", .. }";
      }
      return place_all(*group, *whole.front());
    }
    if (!wanted.required && !has_some) return;
    for (const std::string& name : wanted.one_of.front()->names) {
      if (positions(*header_, name).empty()) match_.missing.push_back(name);
    }
  }

  const HeaderNames* header_;
  const LogOptions* options_;
  HeaderMatch match_;
};

bool sounds_alike(const std::string& header, const std::string& column) {
  const auto has = [&header](const char* part) { return header.find(part) != std::string::npos; };
  if (header.empty()) return false;
  if (column.size() > 2) return header.find(column) != std::string::npos;
  if (header.back() != column.back()) return false;
  if (column.size() == 2) return header.front() == column.front() || has("orient");
  return header.starts_with("p_") || header.starts_with("pos");
}

/// The only header that resembles the column's name, or nothing.
std::string likely_header(const HeaderNames& headers, const std::string& column) {
  if (column == "t") {
    for (const char* const part : {"time", "stamp", "tow", "sec"}) {
      for (const HeaderName& header : headers) {
        if (header.plain.find(part) != std::string::npos) return header.as_written;
      }
    }
    return {};
  }
  std::string only;
  for (const HeaderName& header : headers) {
    if (!sounds_alike(header.plain, column)) continue;
    if (!only.empty()) return {};
    only = header.as_written;
  }
  return only;
}

/// The alternative whose columns were found, else one whose columns are likely, else the first one.
const LogColumnGroup& likeliest(const WantedGroup& wanted, const HeaderMatch& match,
                                const HeaderNames& headers) {
  for (const LogColumnGroup* const group : wanted.one_of) {
    for (const PlacedColumn& column : match.columns) {
      if (column.name == group->names.front()) return *group;
    }
  }
  for (const LogColumnGroup* const group : wanted.one_of) {
    const auto is_likely = [&headers](const std::string& name) {
      return !likely_header(headers, name).empty();
    };
    if (std::all_of(group->names.begin(), group->names.end(), is_likely)) return *group;
  }
  return *wanted.one_of.front();
}

/// The header as a value of the key `columns`, or its number if the name is ambiguous.
std::string column_value(const HeaderNames& headers, const std::string& name,
                         std::size_t position) {
  const bool is_clear = positions(headers, name).size() == 1 && is_utf8(name);
  return is_clear ? in_toml(name) : std::to_string(position + 1);
}

}  // namespace

HeaderName::HeaderName(std::string_view text) {
  text = trimmed(text);
  while (is_comment(text)) text = trimmed(text.substr(1));
  as_written = text;
  any_case = lower_case(text);
  const std::size_t open = text.find_first_of("[(");
  plain = trimmed(std::string_view(any_case).substr(0, open));
  if (open == std::string_view::npos) {
    unit_as_written = unit = unit_at_end(plain);
    return;
  }
  const std::size_t close = text.find_first_of("])", open);
  unit_as_written = trimmed(text.substr(open + 1, close - open - 1));
  unit = lower_case(unit_as_written);
}

std::string listed(const std::vector<std::string>& words) {
  std::string result;
  for (const std::string& word : words) result += (result.empty() ? "" : ", ") + word;
  return result;
}

std::vector<WantedGroup> wanted_groups(const std::string& path,
                                       const std::vector<LogRequest>& requests,
                                       const LogOptions& options) {
  std::vector<WantedGroup> wanted{{"time", {&time_group()}, options.columns.contains("t"), true}};
  check_once(path, options);
  bool names_a_group = false;
  for (const LogRequest& request : requests) {
    WantedGroup group{request.title, {}, false, request.required};
    for (const LogColumnGroup& columns : request.one_of) {
      if (!is_named(columns, options)) continue;
      check_whole(columns, path, options);
      if (group.by_option) {
        refuse(path, "columns: the " + request.title + " is given twice, by " +
                         listed(group.one_of.front()->names) + " and by " + listed(columns.names));
      }
      group.by_option = names_a_group = true;
      group.one_of = {&columns};
    }
    if (!group.by_option) {
      for (const LogColumnGroup& columns : request.one_of) group.one_of.push_back(&columns);
    }
    wanted.push_back(std::move(group));
  }
  // If the options name a group, optional groups that they do not name are left out.
  std::erase_if(wanted, [names_a_group](const WantedGroup& group) {
    return names_a_group && !group.required && !group.by_option;
  });
  return wanted;
}

bool all_by_number(const std::vector<WantedGroup>& wanted, const LogOptions& options) {
  return std::all_of(wanted.begin(), wanted.end(),
                     [](const WantedGroup& g) { return g.by_option; }) &&
         std::all_of(options.columns.begin(), options.columns.end(), [](const auto& column) {
           return std::holds_alternative<std::size_t>(column.second);
         });
}

HeaderMatch match_header(const HeaderNames& header, const std::vector<WantedGroup>& wanted,
                         const LogOptions& options) {
  return Matcher(header, options).match(wanted);
}

std::string columns_key(const HeaderMatch& match, const HeaderNames& headers,
                        const std::vector<WantedGroup>& wanted) {
  std::vector<std::string> entries;
  for (const WantedGroup& group : wanted) {
    std::vector<std::string> of_group;
    bool all_likely = true;
    for (const std::string& name : likeliest(group, match, headers).names) {
      std::size_t position = entries.size() + of_group.size();
      std::string header = likely_header(headers, name);
      for (std::size_t i = 0; i < headers.size(); ++i) {
        if (!header.empty() && headers[i].as_written == header) position = i;
      }
      for (const PlacedColumn& column : match.columns) {
        if (column.name != name || column.position >= headers.size()) continue;
        position = column.position;
        header = headers[position].as_written;
      }
      all_likely = all_likely && !header.empty();
      of_group.push_back(name + " = " + column_value(headers, header, position));
    }
    const bool needed = group.required || group.by_option || all_likely;
    if (needed) entries.insert(entries.end(), of_group.begin(), of_group.end());
  }
  return "columns = { " + listed(entries) + " }";
}

}  // namespace kreisel::detail
