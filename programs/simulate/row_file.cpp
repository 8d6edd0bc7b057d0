#include "row_file.hpp"

#include <fmt/core.h>

#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <fcntl.h>
#include <iterator>
#include <string_view>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>
#include <utility>

#include <dynamics/file/csv.hpp>
#include <dynamics/file/text_file.hpp>
#include <motor/error.hpp>

#include "../shared/signals.hpp"

namespace {

/// Maximum size of a file of rows to continue: the rows must fit in memory.
constexpr std::size_t largest_table = std::size_t(4) << 30U;

std::string line(const std::vector<std::string>& fields) {
  std::string text;
  for (const std::string& field : fields) {
    text += text.empty() ? "" : ",";
    text += kreisel::csv_field(field);
  }
  return text + '\n';
}

}  // namespace

void RowFile::Mark::advance(std::string_view text) {
  bytes += static_cast<long long>(text.size());
  hash.add(text);
}

RowFile::RowFile(std::filesystem::path place, std::vector<std::string> columns)
    : place_(std::move(place)), columns_(std::move(columns)), head_(line(columns_)) {
  if (place_ == "-") file_ = ::dup(STDOUT_FILENO);
}

RowFile::~RowFile() {
  if (file_ >= 0) ::close(file_);
}

void RowFile::refuse(const std::string& why) const {
  throw kreisel::InvalidInput(place_.string() + ": " + why);
}

void RowFile::fail(const std::string& why) const {
  throw kreisel::ComputationFailed(place_.string() + ": " + why);
}

void RowFile::lock() const {
  if (::flock(file_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
    refuse("another process is writing this file");
  }
}

RowFile::Row RowFile::parsed(std::string_view text, std::size_t number) const {
  Row row;
  const char* at = text.data();
  const char* const stop = at + text.size();
  while (at < stop) {
    double value = 0;
    const auto [next, error] = std::from_chars(at, stop, value);
    if (error != std::errc{} || !std::isfinite(value) || (next != stop && *next != ',')) break;
    row.values.push_back(value);
    at = next == stop ? stop : next + 1;
  }
  if (at != stop || row.values.size() != columns_.size()) {
    refuse(fmt::format("--resume: row {} is damaged: take it and those behind it away", number));
  }
  return row;
}

std::vector<RowFile::Row> RowFile::read_rows() {
  const std::string text = kreisel::read_text(place_, largest_table);
  if (!std::filesystem::is_regular_file(place_)) refuse("--resume: is no file that holds rows");
  file_ = ::open(place_.c_str(), O_RDWR | O_CLOEXEC);  // NOLINT: how POSIX has it
  if (file_ < 0) refuse(std::strerror(errno));
  lock();
  if (text.empty()) return {};
  std::string_view rest = text;
  if (!rest.starts_with(head_)) refuse("--resume: its columns are not those of this scene");
  Mark mark;
  mark.advance(head_);
  rest.remove_prefix(head_.size());
  std::vector<Row> rows;
  for (std::size_t end = rest.find('\n'); end != std::string_view::npos; end = rest.find('\n')) {
    Row row = parsed(rest.substr(0, end), rows.size() + 1);
    if (!rows.empty() && !(row.values.front() > rows.back().values.front())) {
      refuse(fmt::format("--resume: the time of row {} does not increase", rows.size() + 1));
    }
    mark.advance(rest.substr(0, end + 1));
    row.end = mark;
    rows.push_back(std::move(row));
    rest.remove_prefix(end + 1);
  }
  return rows;
}

void RowFile::go_on(const std::optional<Mark>& kept, const std::optional<Mark>& begin) {
  Mark head;
  head.advance(head_);
  kept_ = kept.value_or(head);
  written_ = begin.value_or(head);
}

std::optional<RowFile::Mark> RowFile::end() const {
  if (!is_ready_ || !is_regular_) return std::nullopt;
  return written_;
}

void RowFile::open() {
  struct stat status = {};
  const bool is_other = ::stat(place_.c_str(), &status) == 0 && !S_ISREG(status.st_mode);
  if (file_ < 0 && is_other) {  // not opened for reading too: a writer alone sees readers go
    file_ = ::open(place_.c_str(), O_WRONLY | O_CLOEXEC | O_NOCTTY);  // NOLINT: how POSIX has it
  } else if (file_ < 0) {
    file_ = ::open(place_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);  // NOLINT: the same
  }
  if (file_ < 0) refuse(std::strerror(errno));
  is_regular_ = place_ != "-" && ::fstat(file_, &status) == 0 && S_ISREG(status.st_mode);
  is_ready_ = true;
  if (is_regular_) {
    lock();
    if (::ftruncate(file_, written_.bytes) != 0) fail(std::strerror(errno));
    ::lseek(file_, written_.bytes, SEEK_SET);
  }
  if (kept_.bytes > 0) return;
  put(head_);
  kept_ = written_;
}

void RowFile::put(const std::string& text) {
  if (!is_regular_) {
    held_ += text;
    written_.advance(text);
    return;
  }
  for (std::size_t done = 0; done < text.size();) {
    const ssize_t n = ::write(file_, text.data() + done, text.size() - done);
    if (n < 0) {
      const std::string why = std::strerror(errno);
      if (::ftruncate(file_, written_.bytes) != 0) fail(why + ", and its last row is cut off");
      fail(why + "; it holds the rows up to there");
    }
    done += static_cast<std::size_t>(n);
  }
  written_.advance(text);
}

void RowFile::write(const std::vector<double>& row) {
  for (std::size_t i = 0; i < row.size(); ++i) {
    if (!std::isfinite(row[i])) {
      fail(fmt::format("{} = {} is not finite at t = {:.9g} s", columns_[i], row[i], row.front()));
    }
  }
  if (!is_ready_) open();
  std::string text;
  for (const double value : row) {
    fmt::format_to(std::back_inserter(text), "{}{:.17g}", text.empty() ? "" : ",", value);
  }
  put(text + '\n');
}

void RowFile::begin_again() {
  written_ = kept_;
  if (!is_ready_) return;
  if (!is_regular_) {
    held_.resize(static_cast<std::size_t>(kept_.bytes));
    return;
  }
  if (::ftruncate(file_, kept_.bytes) != 0) fail(std::strerror(errno));
  ::lseek(file_, kept_.bytes, SEEK_SET);
}

void RowFile::write_held() {
  // After a signal the program does not wait for a reader that has stopped reading.
  if (signals::caught() != 0) ::fcntl(file_, F_SETFL, O_WRONLY | O_NONBLOCK);  // NOLINT: variadic
  for (std::size_t done = 0; done < held_.size();) {
    const ssize_t n = ::write(file_, held_.data() + done, held_.size() - done);
    if (n < 0) fail(std::strerror(errno));
    done += static_cast<std::size_t>(n);
  }
}

void RowFile::close() {
  if (file_ < 0) return;
  write_held();
  is_ready_ = false;
  if (::close(std::exchange(file_, -1)) != 0) fail(std::strerror(errno));
}
