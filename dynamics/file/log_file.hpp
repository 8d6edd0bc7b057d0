#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include <dynamics/file/unit.hpp>
#include <motor/error.hpp>

namespace kreisel {

/// The physical quantity in a column of a log. It determines the unit of the values that are read.
enum class LogQuantity {
  length,        ///< metre
  quaternion,    ///< the four columns of a group are one quaternion, w first
  angle,         ///< radian
  angular_rate,  ///< rad/s
  acceleration,  ///< m/s^2
  number         ///< as written
};

/// Columns that belong together, for example x, y and z.
struct LogColumnGroup {
  LogQuantity quantity = LogQuantity::number;
  /// The names in `LogOptions::columns` and in `Log`; a header with these names matches.
  std::vector<std::string> names;
  /// Other usual headers, each with as many names.
  std::vector<std::vector<std::string>> other_headers = {};
  /// The dimension of LogQuantity::number, which units in a header must have; nothing: any.
  std::optional<detail::Dimension> dimension = {};
};

/// Columns besides the time `t` that a reader needs or can use: one of several groups.
struct LogRequest {
  std::string title;                   ///< used in messages: "attitude"
  std::vector<LogColumnGroup> one_of;  ///< the first one in the log is used
  bool required = true;
};

enum class LogTimeUnit { s, ms, us, ns };
enum class LogDuplicates { error, first, last, mean };

/// Time stamps that are rounded from those of a regular rate: replaced by that rate's, or used as
/// they are.
enum class LogTimeStamps { automatic, exact };

/// The layout of a log's text: the keys of "Logs" in docs/scene_files.md.
struct LogOptions {
  /// The header's name of a column, or its number from 1.
  std::map<std::string, std::variant<std::string, std::size_t>, std::less<>> columns = {};
  std::optional<bool> degrees = {};  ///< angles and angular rates; nothing: radian
  char separator = 0;                ///< ',', ';', tab, blank; 0: found from the text
  char decimal = '.';                ///< ',', ';', tab, blank; 0: detected from the text
  std::size_t skip = 0;              ///< lines before the header
  bool header = true;                ///< false: columns are given by number
  std::size_t skip_after_header = 0;
  std::optional<LogTimeUnit> time_unit = {};  ///< nothing: seconds
  std::string time_zero = "0";                ///< a decimal number in `time_unit`, or "first"
  /// [from, to] in seconds after `time_zero`: rows outside are not read.
  std::optional<std::array<double, 2>> window = {};
  /// [from, to] of the run. Without `window`, rows outside are read only as far as the spline
  /// within depends on them.
  std::optional<std::array<double, 2>> run = {};
  std::optional<double> longest_gap = {};  ///< s; infinity: any; nothing: 10 times the median step
  LogDuplicates duplicates = LogDuplicates::error;
  LogTimeStamps time_stamps = LogTimeStamps::automatic;
};

/// One column of a log.
struct LogColumn {
  std::string name;
  std::vector<double> values;
  /// The spacing of the numbers as written, in the unit of `values`: 1e-4 for 4 decimals of metres.
  /// For columns with a fixed number of digits it is the spacing at the greatest value. It is 0 if
  /// all values are the same integer.
  double resolution = 0;
};

/// The rows of a log in the order of time, t in seconds.
///
/// The times increase, all numbers are finite, and each quaternion has norm 1 within 1 %.
struct Log {
  std::filesystem::path path;
  std::vector<LogColumn> columns;  ///< t, then the groups that were found
  std::vector<std::size_t> lines;  ///< the line of each row, from 1
  double first_time = 0;           ///< of all rows in the file, including rows that were skipped
  double last_time = 0;
  double late = 0;  ///< s, as MotionLog::late

  [[nodiscard]] std::size_t size() const { return lines.size(); }
  [[nodiscard]] bool has(std::string_view column) const;
  /// Throws : InvalidInput if the log has no such column
  [[nodiscard]] const LogColumn& column(std::string_view name) const;
  /// "file:line" of a row, for messages.
  [[nodiscard]] std::string where(std::size_t row) const;
};

/// Reads a log: numbers in columns, in any of the usual layouts.
///
/// Cost   : one pass over the file in blocks; 8 bytes for each number and line that is kept
/// Throws : InvalidInput naming file, line, the text found and the option that helps: not a regular
///          file or pipe, not text, no header that matches, two columns that match, a unit in the
///          header that differs from the option's, a row too short or too long, a number that is
///          not finite, times that do not increase, a gap, a quaternion whose norm is not 1 within
///          1 %, no row, over ten million rows
[[nodiscard]] Log read_log(const std::filesystem::path& path,
                           const std::vector<LogRequest>& requests, const LogOptions& options = {});

}  // namespace kreisel
