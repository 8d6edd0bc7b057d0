#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "../shared/hash.hpp"

/// A CSV file that grows row by row and contains whole rows at any time. If the program is killed,
/// at most the current row is cut off. If the disk is full, the last whole row is the end of the
/// file. A pipe, a device or standard output, called "-", receives all rows at the end.
class RowFile {
 public:
  /// The end of a row, or of the header, in the file.
  struct Mark {
    long long bytes = 0;  ///< up to the mark
    Hash hash;            ///< of these bytes

    void advance(std::string_view text);

    friend bool operator==(const Mark&, const Mark&) = default;
  };

  struct Row {
    std::vector<double> values;
    Mark end;
  };

  /// The file is opened and written at the first row, not earlier.
  RowFile(std::filesystem::path place, std::vector<std::string> columns);
  RowFile(const RowFile&) = delete;
  RowFile& operator=(const RowFile&) = delete;
  ~RowFile();

  [[nodiscard]] const std::filesystem::path& place() const { return place_; }

  /// The rows in the file, without an incomplete last one.
  ///
  /// Throws : kreisel::InvalidInput if the file cannot be read, is in use, has other columns, a
  ///          damaged row, or times that do not increase
  std::vector<Row> read_rows();

  /// Starts writing rows after `begin`; begin_again() goes back to `kept`. Without a mark rows
  /// follow the header.
  void go_on(const std::optional<Mark>& kept, const std::optional<Mark>& begin);

  /// The end of the written rows; nothing if the file does not grow row by row.
  [[nodiscard]] std::optional<Mark> end() const;

  /// Throws : kreisel::InvalidInput if the file cannot be opened or is in use,
  ///          kreisel::ComputationFailed if a value is not finite or cannot be written
  void write(const std::vector<double>& row);

  /// Removes all rows except the kept ones.
  void begin_again();

  /// Throws : kreisel::ComputationFailed
  void close();

 private:
  void open();
  void lock() const;
  void put(const std::string& text);
  void write_held();
  [[nodiscard]] Row parsed(std::string_view line, std::size_t number) const;
  [[noreturn]] void refuse(const std::string& why) const;
  [[noreturn]] void fail(const std::string& why) const;

  std::filesystem::path place_;
  std::vector<std::string> columns_;
  std::string head_;
  std::string held_;  ///< if everything is written at the end
  int file_ = -1;
  bool is_ready_ = false;    ///< ready for writing
  bool is_regular_ = false;  ///< it grows row by row
  Mark kept_;                ///< rows up to here stay
  Mark written_;             ///< whole rows; before the first one the rows to continue
};
