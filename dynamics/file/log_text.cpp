#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <system_error>

#include <dynamics/file/log_text.hpp>

namespace kreisel::detail {

namespace {

constexpr std::size_t block = 1U << 20U;
constexpr std::size_t smallest_block = 1U << 14U;

void refuse_what_is_no_file(const std::filesystem::path& path) {
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(path, error);
  const auto refuse = [&path](const char* reason) {
    throw InvalidInput(path.string() + ": cannot be read: " + reason);
  };
  if (!std::filesystem::exists(status)) refuse("there is no such file");
  if (std::filesystem::is_directory(status)) refuse("it is a folder, not a file");
  if (!std::filesystem::is_regular_file(status)) refuse("it is a device or a pipe, not a file");
}

constexpr bool is_digit(char c) { return c >= '0' && c <= '9'; }
constexpr bool is_blank(char c) { return c == ' ' || c == '\t'; }

/// The parts of a number that is written correctly: a sign, digits with a decimal mark, an
/// exponent.
struct Digits {
  bool negative = false;
  std::string_view mantissa;  ///< with the decimal mark
  int exponent = 0;
};

Digits digits_of(std::string_view field) {
  Digits result;
  if (!field.empty() && (field.front() == '+' || field.front() == '-')) {
    result.negative = field.front() == '-';
    field.remove_prefix(1);
  }
  std::size_t e = 0;
  while (e < field.size() && field[e] != 'e' && field[e] != 'E') ++e;
  result.mantissa = field.substr(0, e);
  if (e == field.size()) return result;
  std::string_view exponent = field.substr(e + 1);
  const bool below = !exponent.empty() && exponent.front() == '-';
  if (!exponent.empty() && !is_digit(exponent.front())) exponent.remove_prefix(1);
  for (const char c : exponent) {
    if (result.exponent < 100000) result.exponent = 10 * result.exponent + (c - '0');
  }
  if (below) result.exponent = -result.exponent;
  return result;
}

bool split_at_blanks(std::string_view line, std::vector<std::string_view>& fields) {
  std::size_t i = 0;
  while (i < line.size()) {
    if (is_blank(line[i])) {
      ++i;
    } else if (line[i] == '"') {
      const std::size_t end = line.find('"', i + 1);
      if (end == std::string_view::npos) return false;
      fields.push_back(trimmed(line.substr(i + 1, end - i - 1)));
      i = end + 1;
      if (i < line.size() && !is_blank(line[i])) return false;
    } else {
      std::size_t end = i;
      while (end < line.size() && !is_blank(line[end])) ++end;
      fields.push_back(line.substr(i, end - i));
      i = end;
    }
  }
  return true;
}

bool split_quoted(std::string_view line, char separator, std::vector<std::string_view>& fields) {
  while (true) {
    line = trimmed(line);
    if (line.empty() || line.front() != '"') {
      const std::size_t end = line.find(separator);
      fields.push_back(trimmed(line.substr(0, end)));
      if (end == std::string_view::npos) return true;
      line.remove_prefix(end + 1);
      continue;
    }
    std::size_t end = line.find('"', 1);
    while (end != std::string_view::npos && line.substr(end + 1).starts_with('"')) {
      end = line.find('"', end + 2);  // two quotes mean one
    }
    if (end == std::string_view::npos) return false;
    fields.push_back(trimmed(line.substr(1, end - 1)));
    line = trimmed(line.substr(end + 1));
    if (line.empty()) return true;
    if (line.front() != separator) return false;
    line.remove_prefix(1);
  }
}

}  // namespace

LogLines::LogLines(const std::filesystem::path& path) : path_(path.string()) {
  refuse_what_is_no_file(path);
  file_.open(path, std::ios::binary);
  if (!file_) throw InvalidInput(path_ + ": cannot be read");
  std::error_code unknown;
  const std::uintmax_t size = std::filesystem::file_size(path, unknown);
  buffer_.resize(unknown ? block : std::clamp<std::uintmax_t>(size + 1, smallest_block, block));
  fill();
  refuse_other_text();
}

void LogLines::refuse_other_text() const {
  if (head().starts_with("\xFF\xFE") || head().starts_with("\xFE\xFF")) {
    throw InvalidInput(path_ + ":1: the text is in UTF-16; save it as UTF-8 or ASCII");
  }
  const std::size_t zero = head().find('\0');
  if (zero != std::string_view::npos) {
    refuse_zero_byte(
        1 + static_cast<std::size_t>(std::count(
                head().begin(), head().begin() + static_cast<std::ptrdiff_t>(zero), '\n')));
  }
  if (head().find('\n') == std::string_view::npos &&
      trimmed(head()).find('\r') != std::string_view::npos) {
    throw InvalidInput(path_ + ":1: the lines end in CR alone; save the text with LF or CR LF");
  }
}

void LogLines::refuse_zero_byte(std::size_t line) const {
  throw InvalidInput(path_ + ":" + std::to_string(line) +
                     ": the file is not text: the line holds a zero byte");
}

void LogLines::fill() {
  std::copy(buffer_.begin() + static_cast<std::ptrdiff_t>(begin_),
            buffer_.begin() + static_cast<std::ptrdiff_t>(filled_), buffer_.begin());
  filled_ -= begin_;
  begin_ = 0;
  file_.read(buffer_.data() + filled_, static_cast<std::streamsize>(buffer_.size() - filled_));
  filled_ += static_cast<std::size_t>(file_.gcount());
  if (file_.bad()) throw InvalidInput(path_ + ": reading failed");
  at_end_ = !file_;
}

bool LogLines::next() {
  ++number_;
  const auto end_of_line = [this](std::size_t from) -> const char* {
    return static_cast<const char*>(std::memchr(buffer_.data() + from, '\n', filled_ - from));
  };
  const char* end = end_of_line(begin_);
  if (end == nullptr && !at_end_) {
    const std::size_t looked_at = filled_ - begin_;
    fill();
    end = end_of_line(looked_at);
  }
  const std::string where = end == nullptr ? path_ + ":" + std::to_string(number_) : std::string();
  if (end == nullptr && !at_end_) throw InvalidInput(where + ": the line is longer than 1 MB");
  const auto length =
      end == nullptr ? filled_ - begin_ : static_cast<std::size_t>(end - (buffer_.data() + begin_));
  if (end == nullptr && length == 0) return false;
  text_ = std::string_view(buffer_).substr(begin_, length);
  begin_ += length + (end == nullptr ? 0 : 1);
  if (number_ == 1 && text_.starts_with("\xEF\xBB\xBF")) text_.remove_prefix(3);
  if (text_.find('\0') != std::string_view::npos) refuse_zero_byte(number_);
  return true;
}

std::string_view trimmed(std::string_view text) {
  const auto passed_over = [](char c) { return is_blank(c) || c == '\r'; };
  while (!text.empty() && passed_over(text.front())) text.remove_prefix(1);
  while (!text.empty() && passed_over(text.back())) text.remove_suffix(1);
  return text;
}

bool is_comment(std::string_view line) {
  return !line.empty() && (line.front() == '#' || line.front() == '%');
}

bool split_fields(std::string_view line, char separator, std::vector<std::string_view>& fields) {
  fields.clear();
  if (separator == ' ') return split_at_blanks(trimmed(line), fields);
  if (line.find('"') != std::string_view::npos) return split_quoted(line, separator, fields);
  while (true) {
    const std::size_t end = line.find(separator);
    fields.push_back(trimmed(line.substr(0, end)));
    if (end == std::string_view::npos) return true;
    line.remove_prefix(end + 1);
  }
}

FieldCount count_fields(const std::vector<std::string_view>& fields) {
  FieldCount count{fields.size(), fields.size()};
  while (count.without_empty > 0 && fields[count.without_empty - 1].empty()) --count.without_empty;
  return count;
}

bool agree(const FieldCount& a, const FieldCount& b) {
  return a.without_empty <= b.all && b.without_empty <= a.all;
}

std::optional<WrittenNumber> written_number(std::string_view field, char decimal) {
  if (decimal != '.') {
    if (field.find('.') != std::string_view::npos) return std::nullopt;
    std::string with_point(field);
    std::replace(with_point.begin(), with_point.end(), decimal, '.');
    return written_number(with_point, '.');
  }
  std::string_view number = field;
  if (number.size() > 1 && number.front() == '+' && number[1] != '-') number.remove_prefix(1);
  WrittenNumber result;
  const auto [stop, error] =
      std::from_chars(number.data(), number.data() + number.size(), result.value);
  if (error != std::errc{} || stop != number.data() + number.size() ||
      !std::isfinite(result.value)) {
    return std::nullopt;
  }
  const Digits digits = digits_of(number);
  bool after_point = false;
  for (const char c : digits.mantissa) {
    if (c == '.') {
      after_point = true;
      continue;
    }
    if (result.digits > 0 || c != '0') ++result.digits;
    if (after_point) ++result.decimals;
  }
  result.decimals -= digits.exponent;
  return result;
}

ExactDecimal exact_decimal(std::string_view field, char decimal) {
  constexpr int most_digits = 37;
  const Digits digits = digits_of(field);
  ExactDecimal result{0, digits.exponent};
  int kept = 0;
  bool after_point = false;
  for (const char c : digits.mantissa) {
    if (c == decimal) {
      after_point = true;
    } else if (kept < most_digits) {
      result.mantissa = 10 * result.mantissa + (c - '0');
      if (result.mantissa != 0) ++kept;
      if (after_point) --result.exponent;
    } else if (!after_point) {
      ++result.exponent;
    }
  }
  if (digits.negative) result.mantissa = -result.mantissa;
  return result;
}

ExactDecimal difference(const ExactDecimal& a, const ExactDecimal& b) {
  if (b.mantissa == 0) return a;
  ExactDecimal x = a;
  ExactDecimal y{-b.mantissa, b.exponent};
  if (x.exponent < y.exponent) std::swap(x, y);
  Integer128 limit = 1;  // 10^37
  for (int i = 0; i < 37; ++i) limit *= 10;
  while (x.exponent > y.exponent && x.mantissa < limit / 10 && x.mantissa > -limit / 10) {
    if (x.mantissa == 0) return y;
    x.mantissa *= 10;
    --x.exponent;
  }
  while (x.exponent > y.exponent && y.mantissa != 0) {
    y.mantissa /= 10;
    ++y.exponent;
  }
  return {x.mantissa + y.mantissa, x.exponent};
}

double nearest_double(const ExactDecimal& value, int shift) {
  constexpr double powers[] = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,
                               1e8,  1e9,  1e10, 1e11, 1e12, 1e13, 1e14, 1e15,
                               1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};
  constexpr Integer128 exact_in_double = Integer128(1) << 53;
  const int exponent = value.exponent + shift;
  if (value.mantissa <= exact_in_double && value.mantissa >= -exact_in_double && exponent <= 0 &&
      exponent >= -22) {
    return static_cast<double>(value.mantissa) / powers[-exponent];  // both exact: rounded once
  }
  std::string text;
  Integer128 rest = value.mantissa < 0 ? -value.mantissa : value.mantissa;
  for (; rest != 0; rest /= 10) text += static_cast<char>('0' + static_cast<int>(rest % 10));
  if (text.empty()) return 0;
  std::reverse(text.begin(), text.end());
  text += 'e' + std::to_string(exponent);
  double result = 0;
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), result);
  if (error == std::errc::result_out_of_range) {
    result = exponent < 0 ? 0 : std::numeric_limits<double>::infinity();
  }
  return value.mantissa < 0 ? -result : result;
}

}  // namespace kreisel::detail
