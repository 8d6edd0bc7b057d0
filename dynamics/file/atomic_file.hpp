#pragma once

#include <array>
#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <ostream>
#include <sstream>
#include <streambuf>
#include <string>
#include <sys/file.h>
#include <sys/stat.h>
#include <system_error>
#include <unistd.h>
#include <utility>

#include <motor/error.hpp>

namespace kreisel {

namespace detail {

/// Stream buffer that owns a file descriptor and writes to it. Nothing is written after the first
/// failure.
class DescriptorBuffer : public std::streambuf {
 public:
  DescriptorBuffer() = default;
  DescriptorBuffer(const DescriptorBuffer&) = delete;
  DescriptorBuffer& operator=(const DescriptorBuffer&) = delete;
  ~DescriptorBuffer() override { close(); }

  void open(int file) {
    file_ = file;
    setp(buffer_.data(), buffer_.data() + buffer_.size());
  }

  /// Writes the remaining bytes and closes the file. Returns the errno of the first failure, or 0.
  int close() {
    if (file_ < 0) return error_;
    sync();
    if (::close(std::exchange(file_, -1)) != 0) note(errno);
    return error_;
  }

 protected:
  int overflow(int character) override {
    if (sync() != 0) return traits_type::eof();
    if (character != traits_type::eof()) sputc(static_cast<char>(character));
    return traits_type::not_eof(character);
  }

  int sync() override {
    const char* at = pbase();
    while (at != pptr() && error_ == 0) {
      const ssize_t written = ::write(file_, at, static_cast<std::size_t>(pptr() - at));
      if (written < 0) note(errno);
      if (written > 0) at += written;
    }
    setp(buffer_.data(), buffer_.data() + buffer_.size());
    return error_ == 0 ? 0 : -1;
  }

 private:
  void note(int error) {
    if (error_ == 0) error_ = error;
  }

  int file_ = -1;
  int error_ = 0;
  std::array<char, 65536> buffer_{};
};

/// The file at the end of a chain of symbolic links, existing or not; `place` if it is no link.
///
/// Throws : InvalidInput if the links form a loop
[[nodiscard]] inline std::filesystem::path end_of_links(const std::filesystem::path& place) {
  std::filesystem::path end = place;
  std::error_code error;
  for (int links = 0; std::filesystem::is_symlink(end, error); ++links) {
    if (links == 40) throw InvalidInput(place.string() + ": " + std::strerror(ELOOP));
    const std::filesystem::path next = std::filesystem::read_symlink(end, error);
    if (error) throw InvalidInput(place.string() + ": " + error.message());
    end = next.is_absolute() ? next : end.parent_path() / next;
  }
  return end;
}

}  // namespace detail

/// A file that appears whole or not at all. It is written to PLACE.part, and commit() moves it to
/// PLACE. Without commit(), or if writing fails, PLACE stays unchanged.
///
/// A symbolic link stays, and the linked file is replaced. A device, a pipe or standard output,
/// called "-", is not replaced: commit() writes everything to it.
class AtomicFile {
 public:
  /// Throws : InvalidInput if the file cannot be written, or if another process is writing it
  explicit AtomicFile(std::filesystem::path place) : place_(std::move(place)) {
    struct stat status = {};
    const bool is_there = ::stat(place_.c_str(), &status) == 0;
    if (is_there && S_ISDIR(status.st_mode)) refuse(place_, std::strerror(EISDIR));
    if (place_ == "-" || (is_there && !S_ISREG(status.st_mode))) {
      stream_.rdbuf(&held_);
      return;
    }
    target_ = detail::end_of_links(place_);
    draft_ = target_.string() + ".part";
    const int file = create_draft();
    if (is_there) (void)::fchmod(file, status.st_mode & 07777U);
    buffer_.open(file);
    stream_.rdbuf(&buffer_);
  }
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;
  ~AtomicFile() {
    if (committed_ || draft_.empty()) return;
    std::error_code ignored;  // another error is already being handled
    std::filesystem::remove(draft_, ignored);
  }

  [[nodiscard]] std::ostream& stream() { return stream_; }

  /// Moves the file to its final path.
  ///
  /// Throws : ComputationFailed if the disk, device or reader did not take all bytes; a file at the
  ///          final path is then unchanged
  void commit() {
    if (draft_.empty()) {
      write_through();
      return;
    }
    const int failure = buffer_.close();
    if (failure != 0) fail(failure);
    std::error_code error;
    std::filesystem::rename(draft_, target_, error);
    if (error) fail(error.value());
    committed_ = true;
  }

 private:
  [[noreturn]] static void refuse(const std::filesystem::path& place, const std::string& why) {
    throw InvalidInput(place.string() + ": " + why);
  }
  [[noreturn]] void fail(int error) const {
    throw ComputationFailed(place_.string() + ": not written, " + std::strerror(error));
  }

  /// Creates a file and locks it for this process. Removes the draft of a killed process first.
  [[nodiscard]] int create_draft() const {
    constexpr int flags = O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC;
    int file = ::open(draft_.c_str(), flags, 0666);  // NOLINT: variadic in POSIX
    if (file < 0 && errno == EEXIST) {
      remove_abandoned_draft();
      file = ::open(draft_.c_str(), flags, 0666);  // NOLINT: variadic in POSIX
    }
    if (file < 0) refuse(place_, std::strerror(errno));
    (void)::flock(file, LOCK_EX | LOCK_NB);
    return file;
  }

  void remove_abandoned_draft() const {
    struct stat status = {};
    if (::lstat(draft_.c_str(), &status) != 0) return;
    if (!S_ISREG(status.st_mode)) refuse(draft_, "is in the way and no file: remove it");
    const int file = ::open(draft_.c_str(), O_WRONLY | O_NOFOLLOW | O_CLOEXEC);  // NOLINT: variadic
    if (file < 0) refuse(draft_, std::strerror(errno));
    const bool is_in_use = ::flock(file, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK;
    ::close(file);
    if (is_in_use) refuse(place_, "another process is writing this file");
    ::unlink(draft_.c_str());
  }

  void write_through() {
    const int file = place_ == "-" ? ::dup(STDOUT_FILENO)
                                   : ::open(place_.c_str(),  // NOLINT: variadic in POSIX
                                            O_WRONLY | O_CLOEXEC | O_NOCTTY);
    if (file < 0) fail(errno);
    buffer_.open(file);
    const std::string text = held_.str();
    buffer_.sputn(text.data(), static_cast<std::streamsize>(text.size()));
    const int failure = buffer_.close();
    if (failure != 0) fail(failure);
    committed_ = true;
  }

  std::filesystem::path place_;
  std::filesystem::path target_;
  std::filesystem::path draft_;  ///< empty if nothing is replaced
  detail::DescriptorBuffer buffer_;
  std::stringbuf held_;  ///< used if nothing is replaced
  std::ostream stream_{nullptr};
  bool committed_ = false;
};

}  // namespace kreisel
