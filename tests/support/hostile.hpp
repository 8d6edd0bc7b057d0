#pragma once

#include <algorithm>
#include <string>
#include <vector>

/// Texts that a program may only print.

namespace kreisel::test {

/// The text as one word of the shell.
[[nodiscard]] inline std::string word(const std::string& text) {
  std::string result = "'";
  for (const char c : text) result += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return result + "'";
}

/// Number of lines in a text.
[[nodiscard]] inline long lines(const std::string& text) {
  return std::count(text.begin(), text.end(), '\n');
}

/// Names with a special meaning to a shell, to gnuplot, to a terminal or to a reader of lines.
[[nodiscard]] inline std::vector<std::string> hostile_names() {
  return {"'",
          "'quoted'",
          "it''s",
          "\"double\"",
          "`touch hit`",
          "$(touch hit)",
          "|touch hit; #",
          "; touch hit",
          "> hit",
          "~",
          "-rf",
          "--help",
          "@macro",
          "a\nb: is no key",
          "tab\there",
          "\x1b]0;title\x07",
          "\u009b31m",
          "back\\slash",
          "%s%n {} {0}",
          "#comment",
          "END",
          "\u00e4\u00f6\u00fc \u2713 \U0001f600",
          "</script><!--",
          "=1+1",
          std::string(5000, 'x')};
}

}  // namespace kreisel::test
