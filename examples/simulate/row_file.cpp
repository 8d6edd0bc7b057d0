#include "row_file.hpp"

#include <fmt/core.h>

#include <cerrno>
#include <charconv>
#include <cstring>
#include <fcntl.h>
#include <fstream>
#include <iterator>
#include <string_view>
#include <sys/stat.h>
#include <unistd.h>
#include <utility>

#include <dynamics/file/csv.hpp>
#include <motor/error.hpp>

namespace {

std::string line(const std::vector<std::string>& fields) {
  std::string text;
  for (const std::string& field : fields) {
    text += text.empty() ? "" : ",";
    text += kreisel::csv_field(field);
  }
  return text + '\n';
}

}  // namespace

RowFile::RowFile(std::filesystem::path place, std::vector<std::string> columns)
    : place_(std::move(place)), columns_(std::move(columns)) {}

RowFile::~RowFile() {
  if (file_ >= 0) ::close(file_);
}

void RowFile::fail(const std::string& why) const {
  throw kreisel::ComputationFailed(place_.string() + ": " + why);
}

std::vector<std::vector<double>> RowFile::keep_rows() {
  const auto refuse = [this](const std::string& why) {
    throw kreisel::InvalidInput("--resume: " + place_.string() + ": " + why);
  };
  std::ifstream file(place_, std::ios::binary);
  if (!file || std::filesystem::is_directory(place_)) refuse("cannot be read");
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  if (text.empty()) return {};
  std::string_view rest = text;
  const std::string head = line(columns_);
  if (!rest.starts_with(head)) refuse("its columns are not those of this scene");
  rest.remove_prefix(head.size());
  head_ = static_cast<long long>(head.size());
  kept_ = head_;
  std::vector<std::vector<double>> rows;
  for (std::size_t end = rest.find('\n'); end != std::string_view::npos; end = rest.find('\n')) {
    std::vector<double> row;
    const char* at = rest.data();
    const char* const stop = rest.data() + end;
    while (at < stop) {
      double value = 0;
      const auto [next, error] = std::from_chars(at, stop, value);
      if (error != std::errc{} || (next != stop && *next != ',')) break;
      row.push_back(value);
      at = next == stop ? stop : next + 1;
    }
    if (at != stop || row.size() != columns_.size()) {
      refuse(fmt::format("row {} is damaged", rows.size() + 1));
    }
    if (!rows.empty() && !(row.front() > rows.back().front())) {
      refuse(fmt::format("the time of row {} does not increase", rows.size() + 1));
    }
    rows.push_back(std::move(row));
    rest.remove_prefix(end + 1);
    kept_ += static_cast<long long>(end) + 1;
  }
  keeps_ = true;
  begin_ = kept_;
  return rows;
}

bool RowFile::go_on_behind(long long bytes) {
  if (!(bytes >= head_ && bytes <= kept_)) return false;
  begin_ = bytes;
  kept_ = head_;
  return true;
}

std::optional<long long> RowFile::bytes() const {
  if (file_ < 0 || !is_regular_) return std::nullopt;
  return written_;
}

void RowFile::open() {
  file_ = ::open(place_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);  // NOLINT: how POSIX has it
  if (file_ < 0 && errno != EISDIR) {
    file_ = ::open(place_.c_str(), O_WRONLY | O_CLOEXEC);  // NOLINT: a pipe
  }
  if (file_ < 0) throw kreisel::InvalidInput(place_.string() + ": " + std::strerror(errno));
  struct stat status = {};
  is_regular_ = ::fstat(file_, &status) == 0 && S_ISREG(status.st_mode);
  if (is_regular_) {
    if (::ftruncate(file_, begin_) != 0) fail(std::strerror(errno));
    ::lseek(file_, 0, SEEK_END);
    written_ = begin_;
  }
  if (keeps_) return;
  const std::string head = line(columns_);
  put(head);
  kept_ = static_cast<long long>(head.size());
}

void RowFile::put(const std::string& text) {
  if (!is_regular_) {
    held_ += text;
    return;
  }
  for (std::size_t done = 0; done < text.size();) {
    const ssize_t n = ::write(file_, text.data() + done, text.size() - done);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) {
      const std::string why = std::strerror(errno);
      if (::ftruncate(file_, written_) != 0) fail(why + ", and its last row is cut off");
      fail(why + "; it holds the rows up to there");
    }
    done += static_cast<std::size_t>(n);
  }
  written_ += static_cast<long long>(text.size());
}

void RowFile::write(const std::vector<double>& row) {
  if (file_ < 0) open();
  std::string text;
  for (const double value : row) {
    fmt::format_to(std::back_inserter(text), "{}{:.17g}", text.empty() ? "" : ",", value);
  }
  put(text + '\n');
}

void RowFile::begin_again() {
  begin_ = kept_;
  if (file_ < 0) return;
  if (!is_regular_) {
    held_.resize(static_cast<std::size_t>(kept_));
    return;
  }
  if (::ftruncate(file_, kept_) != 0) fail(std::strerror(errno));
  ::lseek(file_, kept_, SEEK_SET);
  written_ = kept_;
}

void RowFile::close() {
  if (file_ < 0) return;
  for (std::size_t done = 0; done < held_.size();) {
    const ssize_t n = ::write(file_, held_.data() + done, held_.size() - done);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) fail(std::strerror(errno));
    done += static_cast<std::size_t>(n);
  }
  const int file = std::exchange(file_, -1);
  if (::close(file) != 0) fail(std::strerror(errno));
}
