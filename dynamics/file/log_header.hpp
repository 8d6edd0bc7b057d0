#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <dynamics/file/log_file.hpp>
#include <dynamics/file/log_text.hpp>

/// The header of a log: its columns, matched against the columns that are wanted.

namespace kreisel::detail {

/// A column's name in three degrees of normalization, and its unit.
struct HeaderName {
  /// The text may begin with # or %, as in a comment that serves as the header.
  explicit HeaderName(std::string_view text);

  std::string as_written;
  std::string any_case;  ///< in lower case
  std::string plain;     ///< in lower case, without the unit in brackets
  std::string
      unit;  ///< in lower case, without brackets: "speed [mm/s]", also of "x_mm" and "yaw/deg"
  std::string unit_as_written;
};

using HeaderNames = std::vector<HeaderName>;

/// One column that is read, and its position in the rows.
struct PlacedColumn {
  std::string name;
  bool is_time = false;
  LogQuantity quantity = LogQuantity::number;
  std::size_t position = 0;
  bool has_unit = false;                    ///< the header gives the unit that is read
  std::optional<Dimension> dimension = {};  ///< of LogQuantity::number, if it is known
};

/// Columns that are wanted together: those that the options name, or those with the usual names.
struct WantedGroup {
  std::string title;
  std::vector<const LogColumnGroup*> one_of;  ///< a single one if the options name it
  bool by_option = false;
  bool required = true;
};

/// The groups that are wanted, the time first. If the options name the columns of a group, optional
/// groups are wanted only if the options name them too.
///
/// Throws : InvalidInput if the options name a part of a group, or two groups of one request
[[nodiscard]] std::vector<WantedGroup> wanted_groups(const std::string& path,
                                                     const std::vector<LogRequest>& requests,
                                                     const LogOptions& options);

/// True if the options give the number of every column, so that no header is needed.
[[nodiscard]] bool all_by_number(const std::vector<WantedGroup>& wanted, const LogOptions& options);

/// A line interpreted as a header.
struct HeaderMatch {
  std::vector<PlacedColumn> columns;
  std::vector<std::string> missing;  ///< names of wanted columns that are missing
  std::string ambiguous;             ///< the reason why two of its columns match
  std::string wrong_unit;            ///< the reason why a unit in it cannot be read

  [[nodiscard]] bool fits() const { return missing.empty(); }
};

[[nodiscard]] HeaderMatch match_header(const HeaderNames& header,
                                       const std::vector<WantedGroup>& wanted,
                                       const LogOptions& options);

/// The key `columns` with the names that were found or are likely; the other columns are numbers.
[[nodiscard]] std::string columns_key(const HeaderMatch& match, const HeaderNames& headers,
                                      const std::vector<WantedGroup>& wanted);

/// The words, separated by commas.
[[nodiscard]] std::string listed(const std::vector<std::string>& words);

}  // namespace kreisel::detail
