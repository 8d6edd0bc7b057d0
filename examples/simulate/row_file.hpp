#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

/// A CSV file that grows row by row and holds whole rows whenever one looks at it: when the program
/// is killed at most the row being written is cut off, when the disk is full the last whole row is
/// the last of the file. What is no file (a pipe, a device) gets all rows at once in the end.
class RowFile {
 public:
  /// Nothing is opened or written before the first row.
  RowFile(std::filesystem::path place, std::vector<std::string> columns);
  RowFile(const RowFile&) = delete;
  RowFile& operator=(const RowFile&) = delete;
  ~RowFile();

  [[nodiscard]] const std::filesystem::path& place() const { return place_; }

  /// Keeps the rows that are there, but for a last one cut off, and returns them.
  ///
  /// Throws : kreisel::InvalidInput where the file cannot be read, has other columns, or times that
  ///          do not increase
  std::vector<std::vector<double>> keep_rows();

  /// Of the rows that are kept only the first so many bytes, and those not for good: begin_again()
  /// takes them back. Says whether there are so many.
  [[nodiscard]] bool go_on_behind(long long bytes);

  /// Of head and rows that have been written; nothing where the file is none that grows.
  [[nodiscard]] std::optional<long long> bytes() const;

  /// Throws : kreisel::InvalidInput where the file cannot be opened, kreisel::ComputationFailed
  ///          where it does not take the row
  void write(const std::vector<double>& row);

  /// Takes back all rows but those kept.
  void begin_again();

  /// Throws : kreisel::ComputationFailed
  void close();

 private:
  void open();
  void put(const std::string& text);
  [[noreturn]] void fail(const std::string& why) const;

  std::filesystem::path place_;
  std::vector<std::string> columns_;
  std::string held_;  ///< where all is written in the end
  int file_ = -1;
  bool is_regular_ = true;
  long long head_ = 0;     ///< bytes of the head that was found
  long long begin_ = 0;    ///< bytes of head and rows behind which the first one is written
  long long kept_ = 0;     ///< of these the bytes that stay
  long long written_ = 0;  ///< bytes of whole rows
  bool keeps_ = false;
};
