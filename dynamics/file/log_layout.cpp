#include "log_layout.hpp"

#include <algorithm>
#include <cstdint>
#include <utility>

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

/// A column's name in three degrees of likeness, and its unit.
struct HeaderName {
  explicit HeaderName(std::string_view text) {
    text = trimmed(text);
    while (is_comment(text)) text = trimmed(text.substr(1));
    as_written = text;
    any_case = lower_case(text);
    const std::size_t open = text.find_first_of("[(");
    plain = trimmed(std::string_view(any_case).substr(0, open));
    if (open == std::string_view::npos) return;
    const std::size_t close = text.find_first_of("])", open);
    unit = trimmed(std::string_view(any_case).substr(open + 1, close - open - 1));
  }

  std::string as_written;
  std::string any_case;
  std::string plain;
  std::string unit;  ///< in lower case, without brackets
};

using Names = std::vector<HeaderName>;

/// The positions of the columns that fit a name best: those written alike, else those that differ
/// in capitals, else those that differ in a unit.
std::vector<std::size_t> positions(const Names& header, std::string_view wanted) {
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

std::string listed(const std::vector<std::string>& words) {
  std::string result;
  for (const std::string& word : words) result += (result.empty() ? "" : ", ") + word;
  return result;
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

/// A group of which columns are wanted: by the options, or by the usual names.
struct WantedGroup {
  std::string title;
  std::vector<const LogColumnGroup*> one_of;  ///< one where the options name it
  bool by_option = false;
  bool required = true;
};

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

std::vector<WantedGroup> wanted_groups(const std::string& path,
                                       const std::vector<LogRequest>& requests,
                                       const LogOptions& options) {
  std::vector<WantedGroup> wanted{{"time", {&time_group()}, options.columns.contains("t"), true}};
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
  // Who names the columns of one quantity does not want others without being asked.
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

/// The units of a quantity as headers have them: the one that is read, and others.
struct UnitNames {
  std::vector<std::string> read;
  std::vector<std::string> other;
};

UnitNames units_of(LogQuantity quantity) {
  switch (quantity) {
    case LogQuantity::length: return {{"m"}, {"mm", "cm", "km", "ft", "in", "nm", "um"}};
    case LogQuantity::angle:
      return {{"rad"}, {"deg", "degree", "degrees", "\xC2\xB0", "\xB0", "grad"}};
    case LogQuantity::angular_rate:
      return {{"rad/s"},
              {"deg/s", "dps", "degree/s", "degrees/s", "\xC2\xB0/s", "\xB0/s", "deg s^-1",
               "deg/sec", "deg/h", "deg/hr", "grad/s"}};
    case LogQuantity::acceleration: return {{"m/s^2"}, {"g", "mg", "cm/s^2", "ft/s^2", "gal"}};
    default: return {};
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

/// The reason why the unit in a header is not read as it stands, or nothing.
std::string wrong_unit(const PlacedColumn& column, const HeaderName& header,
                       const LogOptions& options) {
  const std::string found =
      "column " + in_quotes(header.as_written) + " for '" + column.name + "' is in " + header.unit;
  if (column.is_time) {
    const auto unit = time_unit(header.unit);
    if (!unit || options.time_unit) return {};
    return found + ": give  time_unit = \"" + name(*unit) + "\"  (or the unit that is right)";
  }
  const UnitNames units = units_of(column.quantity);
  if (std::find(units.other.begin(), units.other.end(), header.unit) == units.other.end()) {
    return {};
  }
  const bool turns =
      column.quantity == LogQuantity::angle || column.quantity == LogQuantity::angular_rate;
  if (!turns) return found + ", and is read in " + units.read.front() + ": convert the file";
  if (options.degrees) return {};
  return found + ": give  angles = \"deg\"  (or \"rad\" if the header is wrong)";
}

/// How a line fits as a header.
struct Match {
  std::vector<PlacedColumn> columns;
  std::vector<std::string> missing;  ///< names of wanted columns that it has not
  std::string ambiguous;             ///< the reason why two of its columns fit
  std::string wrong_unit;

  [[nodiscard]] bool fits() const { return missing.empty(); }
};

class Matcher {
 public:
  Matcher(const Names& header, const LogOptions& options) : header_(&header), options_(&options) {}

  Match match(const std::vector<WantedGroup>& wanted) {
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
    PlacedColumn column{name, &group == &time_group(), group.quantity, position, false};
    if (position < header_->size()) {
      const HeaderName& header = (*header_)[position];
      const std::string wrong = wrong_unit(column, header, *options_);
      if (match_.wrong_unit.empty()) match_.wrong_unit = wrong;
      const UnitNames units = units_of(column.quantity);
      column.has_unit =
          std::find(units.read.begin(), units.read.end(), header.unit) != units.read.end();
    }
    match_.columns.push_back(std::move(column));
  }

  void note_several(const std::string& name, const std::vector<std::size_t>& found) {
    if (found.size() < 2 || !match_.ambiguous.empty()) return;
    std::vector<std::string> numbers;
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

  /// Takes the first alternative that the header has whole, by its own names or by other usual ones.
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

  const Names* header_;
  const LogOptions* options_;
  Match match_;
};

/// A line of the file's beginning that is neither empty nor skipped.
struct HeadLine {
  std::size_t number;
  std::string_view text;
  bool comment;
};

/// The first lines of a log, as far as a header is looked for.
std::vector<HeadLine> head_lines(const LogLines& lines, std::size_t skip) {
  constexpr std::size_t most = 1000;
  std::string_view rest = lines.head();
  if (rest.starts_with("\xEF\xBB\xBF")) rest.remove_prefix(3);
  std::vector<HeadLine> result;
  for (std::size_t number = 1; !rest.empty() && number <= skip + most; ++number) {
    const std::size_t end = rest.find('\n');
    if (end == std::string_view::npos && !lines.head_is_all()) break;
    const std::string_view text = rest.substr(0, end);
    rest = end == std::string_view::npos ? std::string_view{} : rest.substr(end + 1);
    if (number <= skip || trimmed(text).empty()) continue;
    result.push_back({number, text, is_comment(trimmed(text))});
  }
  return result;
}

/// What one separator makes of the first lines.
struct Attempt {
  std::optional<LogLayout> layout;
  std::size_t line = 1;  ///< of the complaint
  std::string complaint;
  std::size_t found = 0;   ///< wanted columns that it has
  std::size_t fields = 0;  ///< of the line of the complaint
};

constexpr std::size_t fits_as_header = 1000;  ///< for Attempt::found

class LayoutSearch {
 public:
  LayoutSearch(const std::vector<HeadLine>& lines, const std::vector<WantedGroup>& wanted,
               const LogOptions& options, char separator)
      : lines_(&lines), wanted_(&wanted), options_(&options), separator_(separator) {}

  Attempt by_name() {
    std::optional<std::size_t> header;
    Match best;
    std::size_t fields_of_row = 0;
    std::optional<std::size_t> comment;  // the last one
    for (std::size_t i = 0; i < lines_->size(); ++i) {
      const HeadLine& line = (*lines_)[i];
      const Match match = match_header(line);
      if (match.fits()) {
        header = i;
        best = match;
      } else if (line.comment) {
        comment = i;
      } else if (header) {
        break;
      } else if (is_all_numbers(line)) {
        fields_of_row = fields_.size();
        if (comment) note_comment((*lines_)[*comment], fields_of_row);
        break;
      } else {
        note_missing(line, match);
      }
    }
    if (!header) return no_header(fields_of_row);
    const HeadLine& line = (*lines_)[*header];
    if (!best.ambiguous.empty()) return failed(line, best.ambiguous);
    if (!best.wrong_unit.empty()) return failed(line, best.wrong_unit);
    return first_row_below(*header, std::move(best.columns));
  }

  Attempt by_number() {
    std::vector<PlacedColumn> columns;
    for (const WantedGroup& group : *wanted_) {
      const LogColumnGroup& only = *group.one_of.front();
      for (const std::string& name : only.names) {
        const auto number = std::get<std::size_t>(options_->columns.find(name)->second);
        columns.push_back({name, &only == &time_group(), only.quantity, number - 1, false});
      }
    }
    std::size_t begin = 0;
    if (options_->header && options_->skip_after_header > 0 && !lines_->empty()) {
      begin = lines_below(0);
    }
    return first_row_from(begin, std::move(columns), options_->header);
  }

 private:
  [[nodiscard]] bool split(std::string_view line) {
    return split_fields(line, separator_, fields_) && !fields_.empty();
  }

  Match match_header(const HeadLine& line) {
    std::string_view text = line.text;
    if (line.comment) {
      text = trimmed(text);
      while (is_comment(text)) text = trimmed(text.substr(1));
    }
    Names names;
    if (split(text)) {
      for (const std::string_view field : fields_) {
        const bool is_unit = field.starts_with('[') || field.starts_with('(');
        // Between blanks a unit is a field of its own.
        if (separator_ == ' ' && is_unit && !names.empty()) {
          const std::string with_unit = names.back().as_written + " " + std::string(field);
          names.back() = HeaderName(with_unit);
        } else {
          names.emplace_back(field);
        }
      }
    }
    counts_ = count_fields(fields_);
    if (names.size() < counts_.all) counts_ = {names.size(), names.size()};
    names_.clear();
    for (const HeaderName& name : names) names_.push_back(name.as_written);
    return Matcher(names, *options_).match(*wanted_);
  }

  bool is_all_numbers(const HeadLine& line) {
    if (!split(line.text) || fields_.size() < 2) return false;
    return std::all_of(fields_.begin(), fields_.end(), [this](std::string_view field) {
      return field.empty() || written_number(field, options_->decimal);
    });
  }

  /// A comment with as many fields as the rows below it may have been meant as a header.
  void note_comment(const HeadLine& comment, std::size_t fields_of_row) {
    const Match match = match_header(comment);
    if (names_.size() == fields_of_row) note_missing(comment, match);
  }

  /// Remembers the line that lacks the fewest columns, for the complaint.
  void note_missing(const HeadLine& line, const Match& match) {
    const bool nearer =
        nearest_names_.empty() || match.missing.size() < nearest_.missing.size() ||
        (match.missing.size() == nearest_.missing.size() && names_.size() > nearest_names_.size());
    if (!nearer || names_.empty()) return;
    nearest_ = match;
    nearest_names_ = names_;
    nearest_line_ = line.number;
  }

  Attempt no_header(std::size_t fields_of_row) {
    Attempt attempt;
    attempt.fields = std::max(nearest_names_.size(), fields_of_row);
    if (nearest_names_.empty()) {
      attempt.line = lines_->empty() ? 1 : lines_->front().number;
      attempt.complaint =
          "no line names the columns: give their numbers from 1, for example  " + pasted({});
      return attempt;
    }
    attempt.found = 100 - std::min<std::size_t>(nearest_.missing.size(), 100);
    attempt.line = nearest_line_;
    std::vector<std::string> found;
    for (std::size_t i = 0; i < nearest_names_.size() && i < 20; ++i) {
      found.push_back(in_quotes(nearest_names_[i]));
    }
    if (found.size() < nearest_names_.size()) found.emplace_back("..");
    attempt.complaint = "no column for " + listed(nearest_.missing) + " among " + listed(found) +
                        ": name the columns, or give their numbers from 1, for example  " +
                        pasted(nearest_);
    return attempt;
  }

  /// The alternative whose columns were found, else the first.
  [[nodiscard]] static const LogColumnGroup& likeliest(const WantedGroup& wanted,
                                                       const Match& match) {
    for (const LogColumnGroup* const group : wanted.one_of) {
      for (const PlacedColumn& column : match.columns) {
        if (column.name == group->names.front()) return *group;
      }
    }
    return *wanted.one_of.front();
  }

  /// The key `columns` with the names that were found or are likely; numbers stand for the rest.
  [[nodiscard]] std::string pasted(const Match& match) const {
    std::vector<std::string> entries;
    for (const WantedGroup& group : *wanted_) {
      if (!group.required && !group.by_option) continue;
      for (const std::string& name : likeliest(group, match).names) {
        std::string value = likely_header(name);
        for (const PlacedColumn& column : match.columns) {
          if (column.name == name && column.position < nearest_names_.size()) {
            value = nearest_names_[column.position];
          }
        }
        value = value.empty() ? std::to_string(entries.size() + 1) : in_toml(value);
        entries.push_back(name + " = " + value);
      }
    }
    return "columns = { " + listed(entries) + " }";
  }

  /// The only header that sounds like the column, or nothing.
  [[nodiscard]] std::string likely_header(const std::string& column) const {
    std::string only;
    for (const std::string& header : nearest_names_) {
      const std::string plain = HeaderName(header).plain;
      if (plain.empty()) continue;
      const auto holds = [&plain](const std::string& part) {
        return plain.find(part) != std::string::npos;
      };
      const bool sounds_alike =
          column == "t"        ? holds("time") || holds("stamp") || holds("tow") || holds("sec")
          : column.size() == 2 ? (plain.front() == column.front() || holds("orient")) &&
                                     plain.back() == column.back()
                               : holds(column);
      if (!sounds_alike) continue;
      if (!only.empty()) return {};
      only = header;
    }
    return only;
  }

  [[nodiscard]] static Attempt failed(const HeadLine& line, std::string complaint,
                                      std::size_t found = fits_as_header) {
    return {std::nullopt, line.number, std::move(complaint), found, 0};
  }

  /// The index of the first line after a header and the lines that are skipped behind it.
  [[nodiscard]] std::size_t lines_below(std::size_t header) const {
    const std::size_t last = (*lines_)[header].number + options_->skip_after_header;
    std::size_t i = header + 1;
    while (i < lines_->size() && (*lines_)[i].number <= last) ++i;
    return i;
  }

  Attempt first_row_below(std::size_t header, std::vector<PlacedColumn> columns) {
    const FieldCount header_counts = counts_of_header(header);
    header_line_ = (*lines_)[header].number;
    Attempt attempt = first_row_from(lines_below(header), std::move(columns), false);
    attempt.found = fits_as_header;
    if (!attempt.layout) return attempt;
    const FieldCount& row = attempt.layout->fields;
    if (agree(header_counts, row)) return attempt;
    return failed((*lines_)[header], "the header names " + std::to_string(header_counts.all) +
                                         " columns, the row in line " +
                                         std::to_string(attempt.line) + " has " +
                                         std::to_string(row.all) +
                                         ": correct the header, or give the columns by "
                                         "number with  skip = " +
                                         std::to_string((*lines_)[header].number));
  }

  FieldCount counts_of_header(std::size_t header) {
    (void)match_header((*lines_)[header]);
    return counts_;
  }

  /// How many of the columns hold a number in the fields.
  [[nodiscard]] std::size_t numbers_in(const std::vector<PlacedColumn>& columns) const {
    return static_cast<std::size_t>(
        std::count_if(columns.begin(), columns.end(), [this](const PlacedColumn& column) {
          return column.position < fields_.size() &&
                 written_number(fields_[column.position], options_->decimal);
        }));
  }

  /// Looks for the first row; text may stand above it only where `passes_text`.
  Attempt first_row_from(std::size_t begin, std::vector<PlacedColumn> columns, bool passes_text) {
    const HeadLine* partial = nullptr;
    FieldCount partial_counts;
    const HeadLine* text = nullptr;
    for (std::size_t i = begin; i < lines_->size(); ++i) {
      const HeadLine& line = (*lines_)[i];
      if (line.comment) continue;
      const bool whole = split(line.text);
      const FieldCount counts = count_fields(fields_);
      const std::size_t numbers = whole ? numbers_in(columns) : 0;
      if (numbers == columns.size()) {
        if (partial != nullptr && (!passes_text || agree(partial_counts, counts))) {
          return partly_numbers(*partial, columns);
        }
        if (text != nullptr && !passes_text) return text_above(*text, line);
        LogLayout layout{separator_, std::move(columns), line.number, counts};
        return {std::move(layout), line.number, {}, numbers, counts.all};
      }
      if (numbers > 0 && partial == nullptr) {
        partial = &line;
        partial_counts = counts;
      }
      if (numbers == 0 && text == nullptr) text = &line;
    }
    if (partial != nullptr) return partly_numbers(*partial, columns);
    if (text != nullptr) return no_numbers(*text, columns);
    return {std::nullopt, lines_->empty() ? 1 : lines_->back().number,
            "the log has no rows below this line", columns.size(), 0};
  }

  Attempt partly_numbers(const HeadLine& line, const std::vector<PlacedColumn>& columns) {
    if (!split(line.text)) return failed(line, "a quote is not closed", 1);
    const std::size_t numbers = numbers_in(columns);
    for (const PlacedColumn& column : columns) {
      if (column.position >= fields_.size()) {
        return failed(line,
                      "column " + std::to_string(column.position + 1) + " for '" + column.name +
                          "' is missing: the row has " + std::to_string(fields_.size()) + " fields",
                      numbers);
      }
      const std::string_view field = fields_[column.position];
      if (written_number(field, options_->decimal)) continue;
      return failed(line, why_no_number(field, column.name, *options_), numbers);
    }
    return failed(line, "is not a row of numbers", numbers);
  }

  [[nodiscard]] Attempt text_above(const HeadLine& text, const HeadLine& row) const {
    if (!options_->header) {
      return failed(text,
                    "is not a row of numbers: give  skip = " + std::to_string(row.number - 1));
    }
    return failed(text,
                  "the line below the header is not a row of numbers: give  "
                  "skip_after_header = " +
                      std::to_string(row.number - 1 - header_line_));
  }

  Attempt no_numbers(const HeadLine& line, const std::vector<PlacedColumn>& columns) {
    if (!split(line.text)) return failed(line, "a quote is not closed", 0);
    std::string reason = "no row with a number in every column that is wanted";
    const HeadLine& last = lines_->back();
    if (!last.comment && split(last.text)) {
      for (const PlacedColumn& column : columns) {
        if (column.position < fields_.size()) {
          return failed(last, why_no_number(fields_[column.position], column.name, *options_), 0);
        }
      }
      reason += ": the line has " + std::to_string(fields_.size()) + " fields";
    }
    return failed(last, reason, 0);
  }

  const std::vector<HeadLine>* lines_;
  const std::vector<WantedGroup>* wanted_;
  const LogOptions* options_;
  char separator_;
  std::vector<std::string_view> fields_;
  std::vector<std::string> names_;  ///< of the line that was matched last
  FieldCount counts_;               ///< the same
  Match nearest_;                   ///< of the line that fits best, where none fits
  std::vector<std::string> nearest_names_;
  std::size_t nearest_line_ = 1;
  std::size_t header_line_ = 0;
};

/// True if a separator gives the row enough fields for all columns that are read.
bool could_separate(char separator, const std::vector<HeadLine>& lines, const LogLayout& layout) {
  std::vector<std::string_view> fields;
  return std::any_of(lines.begin(), lines.end(), [&](const HeadLine& line) {
    return line.number == layout.first_row && split_fields(line.text, separator, fields) &&
           std::all_of(layout.columns.begin(), layout.columns.end(),
                       [&](const PlacedColumn& c) { return c.position < fields.size(); });
  });
}

}  // namespace

std::string why_no_number(std::string_view field, const std::string& column,
                          const LogOptions& options) {
  const std::string found = column + " = " + in_quotes(field);
  if (field.empty()) return column + " is empty: leave such rows out by  window = [from, to]";
  const char other = options.decimal == '.' ? ',' : '.';
  if (field.find(other) != std::string_view::npos && written_number(field, other)) {
    return found + " is a number with a decimal " + (other == ',' ? "comma" : "point") +
           ": give  decimal = \"" + other + "\"  if all rows have it, else correct this one";
  }
  return found + " is not a finite number";
}

LogLayout find_layout(const LogLines& lines, const std::string& path,
                      const std::vector<LogRequest>& requests, const LogOptions& options) {
  const std::vector<WantedGroup> wanted = wanted_groups(path, requests, options);
  const std::vector<HeadLine> head = head_lines(lines, options.skip);
  if (head.empty()) {
    refuse(path, options.skip == 0 ? "is empty" : "has no lines after the skipped ones");
  }
  const bool by_number = all_by_number(wanted, options);
  if (!by_number && !options.header) {
    refuse(path, "header = \"none\" needs the number of every column,  columns = { t = 1, .. }");
  }
  std::vector<char> separators{'\t', ';', ',', ' '};
  if (options.decimal == ',') separators = {'\t', ';', ' '};
  if (options.separator != 0) separators = {options.separator};
  Attempt best;
  for (std::ptrdiff_t i = 0; i < std::ssize(separators); ++i) {
    LayoutSearch search(head, wanted, options, separators[static_cast<std::size_t>(i)]);
    Attempt attempt = by_number ? search.by_number() : search.by_name();
    const bool unsure = attempt.layout &&
                        std::any_of(separators.begin(), separators.begin() + i, [&](char earlier) {
                          return could_separate(earlier, head, *attempt.layout);
                        });
    if (unsure) break;
    if (attempt.layout) return std::move(*attempt.layout);
    if (i == 0 || std::pair(attempt.found, attempt.fields) > std::pair(best.found, best.fields)) {
      best = std::move(attempt);
    }
  }
  refuse(path + ":" + std::to_string(best.line), best.complaint);
}

}  // namespace kreisel::detail
