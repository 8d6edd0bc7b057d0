#pragma once

#include <string>
#include <string_view>

namespace kreisel::detail {

/// A text of a file in a message: in quotes, on one line, and at most 60 characters of it.
[[nodiscard]] inline std::string in_quotes(std::string_view text) {
  constexpr std::size_t longest = 60;
  std::string result = "'";
  for (const char c : text.substr(0, longest)) {
    const auto byte = static_cast<unsigned char>(c);
    result += byte < 0x20 || byte == 0x7f ? '?' : c;
  }
  return result + (text.size() > longest ? "...'" : "'");
}

}  // namespace kreisel::detail
