#pragma once

#include <cstddef>
#include <cstdio>
#include <string>
#include <string_view>

namespace kreisel {

/// A text for one line of a message. Control characters, which could begin a line or control a
/// terminal, become escapes such as \n and \x1b. Text beyond `most` bytes is cut.
[[nodiscard]] inline std::string printable(std::string_view text, std::size_t most = 600) {
  const auto byte = [&text](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  std::string result;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool begins_character = (byte(i) & 0xC0U) != 0x80U;
    if (begins_character && result.size() >= most) return result + " ...";
    // U+0080 to U+009F are control characters too: two bytes of UTF-8.
    const bool high = byte(i) == 0xC2U && i + 1 < text.size() && byte(i + 1) < 0xA0U;
    if (high || byte(i) < 0x20U || byte(i) == 0x7FU) {
      if (high) ++i;
      char escape[5];
      std::snprintf(escape, sizeof escape, "\\x%02x", byte(i));
      result += text[i] == '\n' ? "\\n" : text[i] == '\t' ? "\\t" : escape;
    } else {
      result += text[i];
    }
  }
  return result;
}

}  // namespace kreisel
