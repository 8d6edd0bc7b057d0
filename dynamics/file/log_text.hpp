#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <motor/error.hpp>

/// The text of a log: its lines, their fields, and the numbers in them.

namespace kreisel::detail {

/// The lines of a text file, read in blocks of a megabyte. Line ends are LF or CR LF.
class LogLines {
 public:
  /// Opens the file and reads the first block.
  ///
  /// Throws : InvalidInput if the path is no regular file, or if its bytes are not lines of text
  explicit LogLines(const std::filesystem::path& path);

  /// The first block, from the beginning of the file. Valid before the first call of next().
  [[nodiscard]] std::string_view head() const { return {buffer_.data(), filled_}; }
  /// True if the first block holds the whole file.
  [[nodiscard]] bool head_is_all() const { return at_end_; }

  /// Advances to the next line; false at the end of the file.
  ///
  /// Throws : InvalidInput if the line is longer than a megabyte or is not text
  [[nodiscard]] bool next();
  /// The line without its end. Valid until the next call of next().
  [[nodiscard]] std::string_view text() const { return text_; }
  /// The number of the line, from 1.
  [[nodiscard]] std::size_t number() const { return number_; }

 private:
  void fill();
  void refuse_other_text() const;
  [[noreturn]] void refuse_zero_byte(std::size_t line) const;

  std::string path_;
  std::ifstream file_;
  std::string buffer_;
  std::size_t begin_ = 0;
  std::size_t filled_ = 0;
  bool at_end_ = false;
  std::string_view text_;
  std::size_t number_ = 0;
};

/// The text without blanks, tabs and carriage returns at both ends.
[[nodiscard]] std::string_view trimmed(std::string_view text);

/// True if the line begins with # or %.
[[nodiscard]] bool is_comment(std::string_view line);

/// Splits a line into fields without surrounding blanks. A field may be in double quotes.
///
/// `separator` is ',', ';', tab, or blank for any run of blanks and tabs. Returns false if a quote
/// is not closed or text follows a closing quote.
[[nodiscard]] bool split_fields(std::string_view line, char separator,
                                std::vector<std::string_view>& fields);

/// Numbers of fields in a line: all fields, and all but the empty ones at the end.
struct FieldCount {
  std::size_t without_empty = 0;
  std::size_t all = 0;
};
[[nodiscard]] FieldCount count_fields(const std::vector<std::string_view>& fields);
/// True if lines with these counts have the same columns: empty fields at the end may be missing.
[[nodiscard]] bool agree(const FieldCount& a, const FieldCount& b);

/// A number as it is written in the file.
struct WrittenNumber {
  double value = 0;
  int decimals = 0;  ///< the last digit stands for 10^-decimals
  int digits = 0;    ///< significant digits, zeros at the end included
};

/// The finite number in a field, or nothing. A leading plus sign is allowed.
[[nodiscard]] std::optional<WrittenNumber> written_number(std::string_view field, char decimal);

// ISO C++ has no integer of 128 bits.
__extension__ typedef __int128 Integer128;

/// The number  mantissa 10^exponent  without rounding, to 37 digits.
struct ExactDecimal {
  Integer128 mantissa = 0;
  int exponent = 0;
};

/// The number in a field that written_number() accepts, without rounding.
[[nodiscard]] ExactDecimal exact_decimal(std::string_view field, char decimal);
/// The difference a - b. Error: exact, unless the digits of both together span more than 37 places.
[[nodiscard]] ExactDecimal difference(const ExactDecimal& a, const ExactDecimal& b);
/// The double nearest to  value 10^shift;  infinite on overflow.
[[nodiscard]] double nearest_double(const ExactDecimal& value, int shift);

}  // namespace kreisel::detail
