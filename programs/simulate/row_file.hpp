#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "../shared/hash.hpp"

/// A CSV file that grows row by row and holds whole rows at any time: when the program is killed at
/// most the row being written is cut off, when the disk is full the last whole row is the last of
/// the file. A pipe, a device or standard output, called "-", gets all rows at once in the end.
class RowFile {
 public:
  /// The end of a row, or of the head, in the file.
  struct Mark {
    long long bytes = 0;  ///< up to there
    Hash hash;            ///< of these

    void advance(std::string_view text);

    friend bool operator==(const Mark&, const Mark&) = default;
  };

  struct Row {
    std::vector<double> values;
    Mark end;
  };

  /// Nothing is opened or written before the first row.
  RowFile(std::filesystem::path place, std::vector<std::string> columns);
  RowFile(const RowFile&) = delete;
  RowFile& operator=(const RowFile&) = delete;
  ~RowFile();

  [[nodiscard]] const std::filesystem::path& place() const { return place_; }

  /// The rows that are there, but for a last one cut off.
  ///
  /// Throws : kreisel::InvalidInput where the file cannot be read, is in use, has other columns, a
  ///          damaged row, or times that do not increase
  std::vector<Row> read_rows();

  /// Has rows written behind `begin`; begin_again() goes back to `kept`. Without a mark: behind the
  /// head.
  void go_on(const std::optional<Mark>& kept, const std::optional<Mark>& begin);

  /// The end of the rows that have been written; nothing where the file is none that grows.
  [[nodiscard]] std::optional<Mark> end() const;

  /// Throws : kreisel::InvalidInput where the file cannot be opened or is in use,
  ///          kreisel::ComputationFailed where a value is not finite or the file does not take it
  void write(const std::vector<double>& row);

  /// Takes back all rows but those kept.
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
  std::string held_;  ///< where all is written in the end
  int file_ = -1;
  bool is_ready_ = false;    ///< to be written to
  bool is_regular_ = false;  ///< and grows row by row
  Mark kept_;                ///< these rows stay
  Mark written_;             ///< whole rows; before the first one those to go on behind
};
