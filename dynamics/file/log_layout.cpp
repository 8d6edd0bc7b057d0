#include <algorithm>
#include <cstdint>
#include <utility>

#include <dynamics/file/log_layout.hpp>
#include <dynamics/file/quoted.hpp>

namespace kreisel::detail {

namespace {

[[noreturn]] void refuse(const std::string& where, const std::string& reason) {
  throw InvalidInput(where + ": " + reason);
}

/// A line at the beginning of the file that is neither empty nor skipped.
struct HeadLine {
  std::size_t number;
  std::string_view text;
  bool comment;
};

/// The first lines of a log, among which the header is searched.
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

/// The separator in the name of a single column, in words; nothing if there is none.
std::optional<std::string> other_separator(const HeaderNames& names) {
  if (names.size() != 1) return std::nullopt;
  const std::string& name = names.front().as_written;
  if (name.find(',') != std::string::npos) return "commas";
  if (name.find(';') != std::string::npos) return "semicolons";
  if (name.find('\t') != std::string::npos) return "tabs";
  return std::nullopt;
}

/// The first lines read with one separator: the layout, or a complaint.
struct Attempt {
  std::optional<LogLayout> layout;
  std::size_t line = 1;  ///< of the complaint
  std::string complaint;
  std::size_t found = 0;   ///< number of wanted columns found
  std::size_t fields = 0;  ///< number of fields in the line of the complaint
};

constexpr std::size_t fits_as_header = 1000;  ///< for Attempt::found

class LayoutSearch {
 public:
  LayoutSearch(const std::vector<HeadLine>& lines, const std::vector<WantedGroup>& wanted,
               const LogOptions& options, char separator)
      : lines_(&lines), wanted_(&wanted), options_(&options), separator_(separator) {}

  Attempt by_name() {
    std::optional<std::size_t> header;
    HeaderMatch best;
    std::size_t fields_of_row = 0;
    std::optional<std::size_t> comment;  // the last one
    for (std::size_t i = 0; i < lines_->size(); ++i) {
      const HeadLine& line = (*lines_)[i];
      const HeaderMatch match = match_line(i);
      if (match.fits()) {
        header = i;
        best = match;
      } else if (line.comment) {
        comment = i;
      } else if (header) {
        break;
      } else if (const std::size_t numbers = count_numbers(line); numbers > 1) {
        fields_of_row = fields_.size();
        if (comment) note_comment(*comment, fields_of_row);
        if (numbers == fields_of_row) break;
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
        columns.push_back({name, name == "t", only.quantity, number - 1, false});
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

  HeaderMatch match_line(std::size_t index) {
    std::string_view text = (*lines_)[index].text;
    if ((*lines_)[index].comment) {
      text = trimmed(text);
      while (is_comment(text)) text = trimmed(text.substr(1));
    }
    names_.clear();
    if (!split(text)) fields_.clear();
    counts_ = count_fields(fields_);
    for (const std::string_view field : fields_) {
      const bool is_unit = field.starts_with('[') || field.starts_with('(');
      // With blanks as separators a unit is a field of its own.
      if (separator_ == ' ' && is_unit && !names_.empty()) {
        const std::string with_unit = names_.back().as_written + " " + std::string(field);
        names_.back() = HeaderName(with_unit);
      } else {
        names_.emplace_back(field);
      }
    }
    if (names_.size() < counts_.all) counts_ = {names_.size(), names_.size()};
    if (options_->skip_after_header > 0) take_units(index + 1);
    return match_header(names_, *wanted_, *options_);
  }

  /// Takes units from a skipped line below the header, for names without a unit.
  void take_units(std::size_t index) {
    if (index >= lines_->size() || !split((*lines_)[index].text)) return;
    if (fields_.size() != names_.size()) return;
    for (std::size_t i = 0; i < names_.size(); ++i) {
      std::string_view unit = fields_[i];
      if (unit.starts_with('[') || unit.starts_with('(')) unit = unit.substr(1, unit.size() - 2);
      if (!names_[i].unit.empty()) continue;
      const HeaderName own(unit);
      names_[i].unit = own.any_case;
      names_[i].unit_as_written = own.as_written;
    }
  }

  /// The number of fields that are numbers or empty; 0 if most fields are text.
  std::size_t count_numbers(const HeadLine& line) {
    if (!split(line.text)) return 0;
    const auto is_number = [this](std::string_view field) {
      return field.empty() || written_number(field, options_->decimal);
    };
    const auto numbers =
        static_cast<std::size_t>(std::count_if(fields_.begin(), fields_.end(), is_number));
    return 2 * numbers > fields_.size() && !fields_.front().empty() ? numbers : 0;
  }

  /// Notes a comment with as many fields as the rows below it: it may be meant as a header.
  void note_comment(std::size_t comment, std::size_t fields_of_row) {
    const HeaderMatch match = match_line(comment);
    if (names_.size() == fields_of_row) note_missing((*lines_)[comment], match);
  }

  /// Notes the line that lacks the fewest columns, for the complaint.
  void note_missing(const HeadLine& line, const HeaderMatch& match) {
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
    const std::size_t missing = nearest_names_.empty()
                                    ? match_header({}, *wanted_, *options_).missing.size()
                                    : nearest_.missing.size();
    attempt.found = 100 - std::min<std::size_t>(missing, 100);
    if (nearest_names_.empty()) {
      attempt.line = lines_->empty() ? 1 : lines_->front().number;
      attempt.complaint = "no line names the columns: give their numbers from 1, for example  " +
                          columns_key({}, {}, *wanted_);
      return attempt;
    }
    attempt.line = nearest_line_;
    std::vector<std::string> found;
    for (std::size_t i = 0; i < nearest_names_.size() && i < 20; ++i) {
      found.push_back(in_quotes(nearest_names_[i].as_written));
    }
    if (found.size() < nearest_names_.size()) found.emplace_back("..");
    if (const auto other = other_separator(nearest_names_)) {
      attempt.complaint = "the line holds " + *other +
                          ", but is not split there: leave out "
                          "separator and decimal, or give those of the file";
      return attempt;
    }
    attempt.complaint = "no column for " + listed(nearest_.missing) + " among " + listed(found) +
                        ": name the columns, or give their numbers from 1, for example  " +
                        columns_key(nearest_, nearest_names_, *wanted_);
    return attempt;
  }

  [[nodiscard]] Attempt failed(const HeadLine& line, std::string complaint,
                               std::size_t found = fits_as_header) const {
    return {std::nullopt, line.number, std::move(complaint), found, fields_.size()};
  }

  /// The index of the first line after a header and the skipped lines below it.
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
    (void)match_line(header);
    return counts_;
  }

  [[nodiscard]] bool is_number(const PlacedColumn& column, char decimal) const {
    return column.position < fields_.size() &&
           written_number(fields_[column.position], decimal).has_value();
  }

  /// The number of columns whose field is a number.
  [[nodiscard]] std::size_t numbers_in(const std::vector<PlacedColumn>& columns) const {
    return static_cast<std::size_t>(
        std::count_if(columns.begin(), columns.end(),
                      [this](const PlacedColumn& c) { return is_number(c, options_->decimal); }));
  }

  /// The number of columns whose field is a number with either decimal mark.
  [[nodiscard]] std::size_t likely_numbers_in(const std::vector<PlacedColumn>& columns) const {
    return static_cast<std::size_t>(std::count_if(
        columns.begin(), columns.end(),
        [this](const PlacedColumn& c) { return is_number(c, '.') || is_number(c, ','); }));
  }

  /// Searches for the first row; text may precede it only if `passes_text`.
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
          Attempt attempt = partly_numbers(*partial, columns);
          if (passes_text) {
            attempt.complaint +=
                "; if it is above the rows, give  skip = " + std::to_string(line.number - 1);
          }
          return attempt;
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
    if (text != nullptr) return no_numbers(begin, columns);
    return {std::nullopt, lines_->empty() ? 1 : lines_->back().number,
            "the log has no rows below this line", columns.size(), 0};
  }

  Attempt partly_numbers(const HeadLine& line, const std::vector<PlacedColumn>& columns) {
    if (!split(line.text)) return failed(line, "a quote is not closed", 1);
    const std::size_t numbers = likely_numbers_in(columns);
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

  /// The complaint about the line, from `begin` on, that most resembles a row of numbers.
  Attempt no_numbers(std::size_t begin, const std::vector<PlacedColumn>& columns) {
    const HeadLine* likeliest = nullptr;
    std::size_t most = 0;
    for (std::size_t i = begin; i < lines_->size(); ++i) {
      const HeadLine& line = (*lines_)[i];
      if (line.comment || !split(line.text)) continue;
      const std::size_t numbers = likely_numbers_in(columns);
      if (likeliest == nullptr || numbers > most) likeliest = &line;
      most = std::max(most, numbers);
    }
    if (likeliest == nullptr) return failed((*lines_)[begin], "a quote is not closed", 0);
    (void)split(likeliest->text);
    for (const PlacedColumn& column : columns) {
      if (column.position >= fields_.size()) continue;
      return failed(*likeliest, why_no_number(fields_[column.position], column.name, *options_),
                    most);
    }
    return failed(*likeliest,
                  "the row has " + std::to_string(fields_.size()) +
                      " fields, and none is a column that is wanted",
                  0);
  }

  const std::vector<HeadLine>* lines_;
  const std::vector<WantedGroup>* wanted_;
  const LogOptions* options_;
  char separator_;
  std::vector<std::string_view> fields_;
  HeaderNames names_;    ///< of the line that was matched last
  FieldCount counts_;    ///< the same
  HeaderMatch nearest_;  ///< the best match, if no line matches
  HeaderNames nearest_names_;
  std::size_t nearest_line_ = 1;
  std::size_t header_line_ = 0;
};

}  // namespace

std::string why_no_number(std::string_view field, const std::string& column,
                          const LogOptions& options) {
  const std::string found = column + " = " + in_quotes(field);
  const std::string leave_out = "leave such rows out by  window = [from, to]";
  if (field.empty()) return column + " is empty: " + leave_out;
  const char other = options.decimal == '.' ? ',' : '.';
  if (field.find(other) != std::string_view::npos && written_number(field, other)) {
    return found + " is a number with a decimal " + (other == ',' ? "comma" : "point") +
           ": give  decimal = \"" + other + "\"  if all rows have it, else correct this one";
  }
  if (column == "t" && field.find(':') != std::string_view::npos) {
    return found + " is a time of the clock: convert the column to seconds, or name another";
  }
  const bool is_infinite = field.find_first_of("nN") != std::string_view::npos;  // nan, inf
  return found + " is not a finite number" + (is_infinite ? ": " + leave_out : "");
}

LogLayout find_layout(const LogLines& lines, const std::string& path,
                      const std::vector<LogRequest>& requests, const LogOptions& options) {
  const std::vector<WantedGroup> wanted = wanted_groups(path, requests, options);
  const std::vector<HeadLine> head = head_lines(lines, options.skip);
  if (head.empty()) {
    refuse(path, !lines.head_is_all()
                     ? "skip leads beyond the first megabyte, where rows must begin"
                 : options.skip == 0 ? "is empty"
                                     : "has no lines after the skipped ones");
  }
  const bool by_number = all_by_number(wanted, options);
  if (!by_number && !options.header) {
    refuse(path, "header = \"none\" needs the number of every column,  columns = { t = 1, .. }");
  }
  std::vector<char> separators{'\t', ';', ',', ' '};
  if (options.decimal == ',') separators = {'\t', ';', ' '};
  if (options.separator != 0) separators = {options.separator};
  Attempt best;
  for (const char separator : separators) {
    LayoutSearch search(head, wanted, options, separator);
    Attempt attempt = by_number ? search.by_number() : search.by_name();
    if (attempt.layout) return std::move(*attempt.layout);
    if (best.complaint.empty() ||
        std::pair(attempt.found, attempt.fields) > std::pair(best.found, best.fields)) {
      best = std::move(attempt);
    }
  }
  refuse(path + ":" + std::to_string(best.line), best.complaint);
}

}  // namespace kreisel::detail
