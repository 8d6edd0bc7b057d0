#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include <dynamics/file/log_file.hpp>
#include <dynamics/file/log_header.hpp>
#include <dynamics/file/log_text.hpp>

namespace kreisel::detail {

/// The layout of a log's text.
struct LogLayout {
  char separator = ',';
  std::vector<PlacedColumn> columns;  ///< t first
  std::size_t first_row = 1;          ///< the number of the line at which the rows begin, from 1
  FieldCount fields;                  ///< of each row
};

/// Finds header, separator and first row in the first lines of a log.
///
/// Throws : InvalidInput naming file and line if nothing, or more than one column, matches the
///          options
[[nodiscard]] LogLayout find_layout(const LogLines& lines, const std::string& path,
                                    const std::vector<LogRequest>& requests,
                                    const LogOptions& options);

/// The reason why a field is not the number that is expected, and the key that may help.
[[nodiscard]] std::string why_no_number(std::string_view field, const std::string& column,
                                        const LogOptions& options);

}  // namespace kreisel::detail
