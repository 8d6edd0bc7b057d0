#pragma once

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <utility>

#include <motor/error.hpp>

namespace kreisel {

/// A file that appears whole or not at all: it is written beside its place and
/// put there by commit().
///
/// Without commit(), or when writing fails, what stood at the place before
/// stays as it was.
class AtomicFile {
 public:
  /// Throws : InvalidInput when no file can be written in that folder
  explicit AtomicFile(std::filesystem::path place)
      : place_(std::move(place)), draft_(place_.string() + ".part") {
    stream_.open(draft_);
    if (!stream_) throw InvalidInput(draft_.string() + ": " + std::strerror(errno));
  }
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;
  ~AtomicFile() {
    if (committed_) return;
    stream_.close();
    std::error_code ignored;  // nothing better can be done while another error is on its way
    std::filesystem::remove(draft_, ignored);
  }

  [[nodiscard]] std::ostream& stream() { return stream_; }

  /// Where the draft lies, for a program of another's that writes it.
  [[nodiscard]] const std::filesystem::path& draft() const { return draft_; }

  /// Puts the file in its place.
  ///
  /// Throws : ComputationFailed when the disk did not take it all; the place is
  /// then untouched
  void commit() {
    stream_.close();
    if (!stream_)
      throw ComputationFailed(place_.string() + ": not written, " + std::strerror(errno));
    std::error_code error;
    std::filesystem::rename(draft_, place_, error);
    if (error) throw ComputationFailed(place_.string() + ": " + error.message());
    committed_ = true;
  }

 private:
  std::filesystem::path place_;
  std::filesystem::path draft_;
  std::ofstream stream_;
  bool committed_ = false;
};

}  // namespace kreisel
