#pragma once

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <initializer_list>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include <dynamics/file/printable.hpp>
#include <dynamics/file/text_file.hpp>
#include <motor/error.hpp>

namespace kreisel {

/// A table of comma-separated values whose first row names the columns.
///
/// Blank lines and lines that begin with # are skipped. A field may be in double quotes, within
/// which two quotes mean one. Spaces around a field are ignored. A line may end in CR LF, and the
/// file may begin with a byte-order mark. A quoted field must end on its line.
class CsvTable {
 public:
  /// Reads the whole table and checks that every row is complete.
  ///
  /// Throws : InvalidInput naming file and line: unreadable, longer than 64 MB, a column of
  ///          `required` missing or twice, a row too long or too short, an open quote, no rows
  [[nodiscard]] static CsvTable read(const std::filesystem::path& path,
                                     std::initializer_list<std::string_view> required) {
    CsvTable table(path.string());
    const std::string text = read_text(path, std::size_t(64) << 20U);
    std::size_t begin = 0;
    for (std::size_t line = 1; begin < text.size(); ++line) {
      const std::size_t end = std::min(text.find('\n', begin), text.size());
      std::string_view rest = std::string_view(text).substr(begin, end - begin);
      begin = end + 1;
      if (line == 1 && rest.starts_with("\xEF\xBB\xBF")) rest.remove_prefix(3);
      rest = trimmed(rest);
      if (rest.empty() || rest.front() == '#') continue;
      table.take(line, rest, required);
    }
    if (table.columns_.empty()) throw InvalidInput(table.path_ + ": no row that names the columns");
    if (table.rows_.empty()) throw InvalidInput(table.path_ + ": no rows");
    return table;
  }

  [[nodiscard]] std::size_t size() const { return rows_.size(); }

  [[nodiscard]] bool has(std::string_view column) const {
    return position(column) != columns_.size();
  }

  [[nodiscard]] const std::string& text(std::size_t row, std::string_view column) const {
    return rows_[row].fields[position(column)];
  }

  /// The field as a finite number.
  ///
  /// Throws : InvalidInput naming file, line and column
  [[nodiscard]] double number(std::size_t row, std::string_view column) const {
    const std::string& field = text(row, column);
    double value = 0;
    const char* end = field.data() + field.size();
    const auto [stop, error] = std::from_chars(field.data(), end, value);
    if (error != std::errc{} || stop != end || !std::isfinite(value)) {
      throw InvalidInput(where(row) + ": " + std::string(column) + " = '" + printable(field, 100) +
                         "' is not a finite number");
    }
    return value;
  }

  /// "file:line" of a row, for messages.
  [[nodiscard]] std::string where(std::size_t row) const { return where_line(rows_[row].line); }

 private:
  struct Row {
    std::size_t line;
    std::vector<std::string> fields;
  };

  explicit CsvTable(std::string path) : path_(std::move(path)) {}

  [[nodiscard]] std::string where_line(std::size_t line) const {
    return path_ + ":" + std::to_string(line);
  }

  [[nodiscard]] static std::string_view trimmed(std::string_view s) {
    constexpr std::string_view blank = " \t\r";
    const std::size_t first = s.find_first_not_of(blank);
    if (first == std::string_view::npos) return {};
    return s.substr(first, s.find_last_not_of(blank) - first + 1);
  }

  [[nodiscard]] std::size_t position(std::string_view column) const {
    std::size_t i = 0;
    while (i < columns_.size() && columns_[i] != column) ++i;
    return i;
  }

  void take(std::size_t line, std::string_view rest,
            std::initializer_list<std::string_view> required) {
    std::vector<std::string> fields = split(line, rest);
    if (!columns_.empty()) {
      if (fields.size() != columns_.size()) {
        throw InvalidInput(where_line(line) + ": " + std::to_string(fields.size()) +
                           " fields where the first row names " + std::to_string(columns_.size()));
      }
      rows_.push_back({line, std::move(fields)});
      return;
    }
    columns_ = std::move(fields);
    for (const std::string_view name : required) {
      if (!has(name)) {
        throw InvalidInput(where_line(line) + ": no column '" + std::string(name) + "'");
      }
    }
    for (std::size_t i = 0; i < columns_.size(); ++i) {
      if (position(columns_[i]) != i) {
        throw InvalidInput(where_line(line) + ": two columns '" + printable(columns_[i], 100) +
                           "'");
      }
    }
  }

  [[nodiscard]] std::vector<std::string> split(std::size_t line, std::string_view rest) const {
    std::vector<std::string> fields;
    while (true) {
      rest = trimmed(rest);
      std::string field;
      if (!rest.empty() && rest.front() == '"') {
        std::size_t i = 1;
        for (; i < rest.size(); ++i) {
          if (rest[i] == '"') {
            if (i + 1 == rest.size() || rest[i + 1] != '"') break;
            ++i;
          }
          field += rest[i];
        }
        if (i >= rest.size()) throw InvalidInput(where_line(line) + ": a quote is not closed");
        rest = trimmed(rest.substr(i + 1));
        if (!rest.empty() && rest.front() != ',') {
          throw InvalidInput(where_line(line) + ": text after a closing quote");
        }
      } else {
        const std::size_t comma = rest.find(',');
        field = trimmed(rest.substr(0, comma));
        rest = comma == std::string_view::npos ? std::string_view{} : rest.substr(comma);
      }
      fields.push_back(std::move(field));
      if (rest.empty()) return fields;
      rest.remove_prefix(1);
    }
  }

  std::string path_;
  std::vector<std::string> columns_;
  std::vector<Row> rows_;
};

/// The text as one field of a CSV row, in quotes if it needs them.
[[nodiscard]] inline std::string csv_field(std::string_view text) {
  if (text.find_first_of(",\"\n\r#") == std::string_view::npos) return std::string(text);
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"') quoted += '"';
    quoted += c;
  }
  return quoted + '"';
}

}  // namespace kreisel
